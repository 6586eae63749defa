//! Names of inputs and outputs.

use clap::builder::{PathBufValueParser, TypedValueParser};
use cosmorama_convert::Name;

/// Reads a name: any that a file can have, whether it is text or not.
pub(crate) fn name() -> impl TypedValueParser<Value = Name> {
    PathBufValueParser::new().map(Name::from)
}
