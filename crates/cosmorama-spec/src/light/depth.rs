use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Depth;

/// The sample type of an output, by name: `8`, `10`, `12`, `16`, `half` or `float`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthName(pub Depth);

impl DepthName {
    /// All sample types, in the order of the help.
    pub const ALL: [Self; 6] = [
        Self(Depth::Eight),
        Self(Depth::Ten),
        Self(Depth::Twelve),
        Self(Depth::Sixteen),
        Self(Depth::Half),
        Self(Depth::Float),
    ];

    /// Returns the name that users type.
    pub fn name(self) -> &'static str {
        match self.0 {
            Depth::Eight => "8",
            Depth::Ten => "10",
            Depth::Twelve => "12",
            Depth::Sixteen => "16",
            Depth::Half => "half",
            Depth::Float => "float",
        }
    }

    /// Returns a line of help.
    pub fn about(self) -> &'static str {
        match self.0 {
            Depth::Eight => "8-bit integers",
            Depth::Ten => "10 bits, spread over 16-bit integers",
            Depth::Twelve => "12 bits, spread over 16-bit integers",
            Depth::Sixteen => "16-bit integers",
            Depth::Half => "16-bit floats",
            Depth::Float => "32-bit floats",
        }
    }
}

impl fmt::Display for DepthName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for DepthName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = || Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|depth| depth.name() == text).ok_or_else(|| format!("expected one of {}", known()))
    }
}

impl From<DepthName> for Depth {
    fn from(depth: DepthName) -> Self {
        depth.0
    }
}
