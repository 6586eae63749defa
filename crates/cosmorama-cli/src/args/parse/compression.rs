use std::ffi::OsStr;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};
use cosmorama_spec::CompressionLevel;

/// Parser of a compression level, whose error lists all levels and the formats that have them. Clap would take
/// `nonsense` for `none`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CompressionParser;

impl TypedValueParser for CompressionParser {
    type Value = CompressionLevel;

    fn parse_ref(&self, cmd: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<Self::Value, Error> {
        parse.parse_ref(cmd, arg, value)
    }

    // For help and completions.
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let value = |level: CompressionLevel| PossibleValue::new(level.name()).help(level.about());
        Some(Box::new(CompressionLevel::ALL.into_iter().map(value)))
    }
}

fn parse(text: &str) -> Result<CompressionLevel, String> {
    text.parse()
        .map_err(|expected| format!("{expected}, all without loss, for PNG, TIFF and OpenEXR; JPEG has --quality"))
}
