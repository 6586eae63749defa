use std::fmt;
use std::str::FromStr;

/// Effort of lossless compression of an output, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompressionLevel {
    /// No compression.
    None,
    /// Compression for speed.
    Fast,
    /// Compression between speed and size.
    Balanced,
    /// Compression for size.
    High,
}

impl CompressionLevel {
    /// All levels, in the order of the help.
    pub const ALL: [Self; 4] = [Self::None, Self::Fast, Self::Balanced, Self::High];

    /// Returns the name that users type.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Fast => "fast",
            Self::Balanced => "balanced",
            Self::High => "high",
        }
    }

    /// Returns a line of help.
    pub fn about(self) -> &'static str {
        match self {
            Self::None => "Not at all",
            Self::Fast => "For speed; TIFF: as balanced",
            Self::Balanced => "Between the two",
            Self::High => "For size; OpenEXR: as balanced",
        }
    }
}

impl fmt::Display for CompressionLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for CompressionLevel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        let found = Self::ALL.into_iter().find(|level| level.name() == text);
        found.ok_or_else(|| format!("expected one of {}", names()))
    }
}
