use std::ffi::OsStr;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};
use cosmorama_io::Compression;

/// Parser of a compression level, whose error lists all levels and the formats that have them. Clap would take
/// `nonsense` for `none`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CompressionParser;

impl TypedValueParser for CompressionParser {
    type Value = Compression;

    fn parse_ref(&self, cmd: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<Self::Value, Error> {
        parse.parse_ref(cmd, arg, value)
    }

    // For help and completions.
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(LEVELS.into_iter().map(|(_, name, about)| PossibleValue::new(name).help(about))))
    }
}

/// All levels, with their names and a line of help.
const LEVELS: [(Compression, &str, &str); 4] = [
    (Compression::None, "none", "Not at all"),
    (Compression::Fast, "fast", "For speed; TIFF: as balanced"),
    (Compression::Balanced, "balanced", "Between the two"),
    (Compression::High, "high", "For size; OpenEXR: as balanced"),
];

fn parse(text: &str) -> Result<Compression, String> {
    let found = LEVELS.into_iter().find(|(_, name, _)| *name == text);
    let names = LEVELS.map(|(_, name, _)| name).join(", ");
    let why = format!("expected one of {names}, all without loss, for PNG, TIFF and OpenEXR; JPEG has --quality");
    found.map(|(level, ..)| level).ok_or(why)
}
