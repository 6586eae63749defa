use std::ffi::OsStr;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error, ValueEnum};
use cosmorama_io::Compression;

/// How hard to press an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CompressionArg {
    /// Not at all
    None,
    /// For speed; TIFF: as balanced
    Fast,
    /// Between the two
    Balanced,
    /// For size; OpenEXR: as balanced
    High,
}

impl From<CompressionArg> for Compression {
    fn from(compression: CompressionArg) -> Self {
        match compression {
            CompressionArg::None => Self::None,
            CompressionArg::Fast => Self::Fast,
            CompressionArg::Balanced => Self::Balanced,
            CompressionArg::High => Self::High,
        }
    }
}

/// Reads one, and says of others what there is and what for: clap would take `nonsense` for `none`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CompressionParser;

impl TypedValueParser for CompressionParser {
    type Value = CompressionArg;

    fn parse_ref(&self, cmd: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<Self::Value, Error> {
        parse.parse_ref(cmd, arg, value)
    }

    // For help and completions.
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(CompressionArg::value_variants().iter().filter_map(CompressionArg::to_possible_value)))
    }
}

fn parse(text: &str) -> Result<CompressionArg, String> {
    CompressionArg::from_str(text, false).map_err(|_| {
        let values = CompressionArg::value_variants().iter().filter_map(CompressionArg::to_possible_value);
        let names: Vec<String> = values.map(|value| value.get_name().to_owned()).collect();
        format!("expected one of {}, all without loss, for PNG, TIFF and OpenEXR; JPEG has --quality", names.join(", "))
    })
}
