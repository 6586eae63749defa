use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use cosmorama_spec::DepthName;

/// Returns the parser of a sample type, which lists all types in help.
pub(crate) fn depth_parser() -> impl TypedValueParser<Value = DepthName> {
    let value = |depth: DepthName| PossibleValue::new(depth.name()).help(depth.about());
    PossibleValuesParser::new(DepthName::ALL.map(value)).try_map(|name| name.parse::<DepthName>())
}
