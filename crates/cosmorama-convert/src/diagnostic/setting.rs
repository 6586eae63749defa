/// A setting of a conversion, as messages refer to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Setting {
    /// The input's projection.
    From,
    /// The output's projection.
    To,
    /// Pixels of the output.
    Size,
    /// Turn of the output to the right.
    Yaw,
    /// Turn of the output upwards.
    Pitch,
    /// Turn of the output's camera, clockwise.
    Roll,
    /// What pixels average.
    Filter,
    /// The weights of that average.
    Kernel,
    /// Whether pixels are clamped to their texels.
    AntiRinging,
    /// How code values relate to light, on both sides.
    Transfer,
    /// How the input's code values relate to light.
    InTransfer,
    /// How the output's code values relate to light.
    OutTransfer,
    /// Sample type of the output.
    Depth,
    /// Colour outside the lens.
    Background,
    /// What becomes of directions that no view covers.
    Missing,
    /// Frames of a sequence.
    Frames,
    /// Whether existing outputs are replaced.
    Overwrite,
    /// Whether complete outputs are kept.
    Resume,
    /// Whether smaller copies are added.
    Mips,
    /// JPEG quality.
    Quality,
    /// How hard files are pressed.
    Compression,
    /// Memory to use at most.
    Memory,
    /// Whether places in the input are written instead of light.
    StMap,
}

impl Setting {
    /// All settings.
    pub const ALL: [Self; 23] = [
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
        Self::Depth,
        Self::Background,
        Self::Missing,
        Self::Frames,
        Self::Overwrite,
        Self::Resume,
        Self::Mips,
        Self::Quality,
        Self::Compression,
        Self::Memory,
        Self::StMap,
    ];

    /// Returns the plain name, words joined by `-`.
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
            Self::Depth => "depth",
            Self::Background => "background",
            Self::Missing => "missing",
            Self::Frames => "frames",
            Self::Overwrite => "overwrite",
            Self::Resume => "resume",
            Self::Mips => "mips",
            Self::Quality => "quality",
            Self::Compression => "compression",
            Self::Memory => "memory",
            Self::StMap => "st-map",
        }
    }
}
