use std::fmt;

/// Channels of a file beyond those of its picture, and its parts. Only OpenEXR files have them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    /// Names of the picture's own channels, in the order of a pixel's samples; empty in formats without names.
    pub picture: Vec<String>,
    /// Further channels of the part that is read, in the file's order.
    pub further: Vec<NamedChannel>,
    /// Parts of the file; empty where there is only one.
    pub parts: Vec<FilePart>,
    /// Index of the part that is read.
    pub part: usize,
    /// Reason why there is no picture, in words: what was found instead. Then all channels are further ones, and the
    /// pixels that are read stand for the picture's shape alone.
    pub no_picture: Option<String>,
}

/// A channel of a file, by its full name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedChannel {
    /// Name with its layer, such as `diffuse.R`.
    pub name: String,
    /// Sample type.
    pub kind: SampleKind,
    /// Whether the channel has one sample for each pixel; others are not read.
    pub is_full: bool,
}

/// One of several parts of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePart {
    /// Name, if it has one.
    pub name: Option<String>,
    /// Channels of the part.
    pub channels: Vec<NamedChannel>,
    /// Whether the part's pixels have several samples in depth, which are not read.
    pub is_deep: bool,
}

impl FilePart {
    /// Returns the part's number, with its name if it has one, as in `1 (depth)`.
    pub fn label(&self, index: usize) -> String {
        self.name.as_ref().map_or_else(|| index.to_string(), |name| format!("{index} ({name})"))
    }
}

/// Type of a named channel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SampleKind {
    /// Floats of 16 bits.
    Half,
    /// Floats of 32 bits.
    Float,
    /// Integers of 32 bits.
    Uint,
}

impl SampleKind {
    /// Returns the bytes of a sample.
    pub fn bytes(self) -> usize {
        match self {
            Self::Half => 2,
            Self::Float | Self::Uint => 4,
        }
    }
}

/// Writes the type as OpenEXR's own programs call it.
impl fmt::Display for SampleKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Half => "half",
            Self::Float => "float",
            Self::Uint => "uint",
        })
    }
}
