use clap::ValueEnum;
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
