use clap::ValueEnum;
use cosmorama::raster::Depth;

/// Sample type of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DepthArg {
    /// 8-bit integers
    #[value(name = "8")]
    Eight,
    /// 10 bits, spread over 16-bit integers
    #[value(name = "10")]
    Ten,
    /// 12 bits, spread over 16-bit integers
    #[value(name = "12")]
    Twelve,
    /// 16-bit integers
    #[value(name = "16")]
    Sixteen,
    /// 16-bit floats
    Half,
    /// 32-bit floats
    Float,
}

impl From<DepthArg> for Depth {
    fn from(depth: DepthArg) -> Self {
        match depth {
            DepthArg::Eight => Self::Eight,
            DepthArg::Ten => Self::Ten,
            DepthArg::Twelve => Self::Twelve,
            DepthArg::Sixteen => Self::Sixteen,
            DepthArg::Half => Self::Half,
            DepthArg::Float => Self::Float,
        }
    }
}
