/// A setting of a conversion, for reference in messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Setting {
    /// The input's projection.
    From,
    /// The output's projection.
    To,
    /// Size of the output in pixels.
    Size,
    /// Rotation of the output to the right.
    Yaw,
    /// Rotation of the output upwards.
    Pitch,
    /// Clockwise rotation of the output's camera.
    Roll,
    /// Filter.
    Filter,
    /// Kernel of the filter.
    Kernel,
    /// Whether pixels are clamped to their texels.
    AntiRinging,
    /// Transfer function of both sides.
    Transfer,
    /// Transfer function of the input.
    InTransfer,
    /// Transfer function of the output.
    OutTransfer,
    /// Primaries of the output.
    Primaries,
    /// Primaries of inputs that name none.
    InPrimaries,
    /// Whether ICC profiles of inputs are ignored.
    IgnoreProfile,
    /// Sample type of the output.
    Depth,
    /// Colour outside the lens.
    Background,
    /// Treatment of directions that no view covers.
    Missing,
    /// Frames of a sequence.
    Frames,
    /// Whether existing outputs are replaced.
    Overwrite,
    /// Whether complete outputs are kept.
    Resume,
    /// Whether mip levels are written.
    Mips,
    /// Number of levels in a chain of light.
    Levels,
    /// JPEG quality.
    Quality,
    /// Effort of lossless compression.
    Compression,
    /// Whether outputs get no metadata of inputs.
    Strip,
    /// Limit of memory.
    Memory,
    /// Whether an st map is written instead of a picture.
    StMap,
    /// Part of OpenEXR files.
    Part,
    /// Channels of OpenEXR files.
    Channels,
    /// Kind of the input's depth.
    DepthKind,
    /// Frame of normals.
    Normals,
}

impl Setting {
    /// All settings.
    pub const ALL: [Self; 32] = [
        Self::From,
        Self::To,
        Self::Size,
        Self::Yaw,
        Self::Pitch,
        Self::Roll,
        Self::Filter,
        Self::Kernel,
        Self::AntiRinging,
        Self::Transfer,
        Self::InTransfer,
        Self::OutTransfer,
        Self::Primaries,
        Self::InPrimaries,
        Self::IgnoreProfile,
        Self::Depth,
        Self::Background,
        Self::Missing,
        Self::Frames,
        Self::Overwrite,
        Self::Resume,
        Self::Mips,
        Self::Levels,
        Self::Quality,
        Self::Compression,
        Self::Strip,
        Self::Memory,
        Self::StMap,
        Self::Part,
        Self::Channels,
        Self::DepthKind,
        Self::Normals,
    ];

    /// Returns the plain name, with words joined by `-`.
    pub fn name(self) -> &'static str {
        match self {
            Self::From => "from",
            Self::To => "to",
            Self::Size => "size",
            Self::Yaw => "yaw",
            Self::Pitch => "pitch",
            Self::Roll => "roll",
            Self::Filter => "filter",
            Self::Kernel => "kernel",
            Self::AntiRinging => "anti-ringing",
            Self::Transfer => "transfer",
            Self::InTransfer => "in-transfer",
            Self::OutTransfer => "out-transfer",
            Self::Primaries => "primaries",
            Self::InPrimaries => "in-primaries",
            Self::IgnoreProfile => "ignore-profile",
            Self::Depth => "depth",
            Self::Background => "background",
            Self::Missing => "missing",
            Self::Frames => "frames",
            Self::Overwrite => "overwrite",
            Self::Resume => "resume",
            Self::Mips => "mips",
            Self::Levels => "levels",
            Self::Quality => "quality",
            Self::Compression => "compression",
            Self::Strip => "strip",
            Self::Memory => "memory",
            Self::StMap => "st-map",
            Self::Part => "part",
            Self::Channels => "channels",
            Self::DepthKind => "depth-kind",
            Self::Normals => "normals",
        }
    }
}
