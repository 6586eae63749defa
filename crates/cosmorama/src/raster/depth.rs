/// Sample type of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Depth {
    /// 8-bit integers.
    Eight,
    /// 10 significant bits, scaled to 16-bit integers.
    Ten,
    /// 12 significant bits, scaled to 16-bit integers.
    Twelve,
    /// 16-bit integers.
    Sixteen,
    /// 16-bit floats.
    Half,
    /// 32-bit floats.
    Float,
}

impl Depth {
    /// All six, coarsest first.
    pub const ALL: [Self; 6] = [Self::Eight, Self::Ten, Self::Twelve, Self::Sixteen, Self::Half, Self::Float];

    /// Returns the bytes per sample in memory.
    pub const fn bytes(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Ten | Self::Twelve | Self::Sixteen | Self::Half => 2,
            Self::Float => 4,
        }
    }

    /// Returns the significant bits of an integer sample; `None` for floats.
    pub const fn significant_bits(self) -> Option<u32> {
        match self {
            Self::Eight => Some(8),
            Self::Ten => Some(10),
            Self::Twelve => Some(12),
            Self::Sixteen => Some(16),
            Self::Half | Self::Float => None,
        }
    }

    /// Returns whether samples are floats, which can hold light beyond white.
    pub const fn is_float(self) -> bool {
        matches!(self, Self::Half | Self::Float)
    }

    /// Returns the largest light that samples hold; integers end at white, 1.
    pub const fn most(self) -> f32 {
        match self {
            Self::Float => f32::MAX,
            Self::Half => 65504.0,
            Self::Eight | Self::Ten | Self::Twelve | Self::Sixteen => 1.0,
        }
    }
}

impl std::fmt::Display for Depth {
    /// Prints the name in `--depth`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Eight => "8",
            Self::Ten => "10",
            Self::Twelve => "12",
            Self::Sixteen => "16",
            Self::Half => "half",
            Self::Float => "float",
        })
    }
}
