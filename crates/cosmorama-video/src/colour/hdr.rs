/// Tags of high dynamic range that do not change from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HdrTags {
    /// Display on which the video was graded (SMPTE ST 2086).
    pub mastering: Option<MasteringDisplay>,
    /// Light levels of the content (CTA-861.3).
    pub light: Option<ContentLight>,
}

/// Display on which a video was graded, in the units of H.265's message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MasteringDisplay {
    /// Chromaticity x and y of red, in units of 0.00002.
    pub red: [u16; 2],
    /// Chromaticity of green.
    pub green: [u16; 2],
    /// Chromaticity of blue.
    pub blue: [u16; 2],
    /// Chromaticity of white.
    pub white: [u16; 2],
    /// Greatest luminance, in units of 0.0001 cd/m².
    pub brightest: u32,
    /// Least luminance, in units of 0.0001 cd/m².
    pub darkest: u32,
}

/// Light levels of a video's content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContentLight {
    /// Light of the brightest pixel in cd/m² (MaxCLL).
    pub brightest: u16,
    /// Mean light of the brightest frame in cd/m² (MaxFALL).
    pub mean: u16,
}
