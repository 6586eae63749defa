/// Channels of a pixel in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channels {
    /// Grey.
    Grey,
    /// Grey and alpha.
    GreyAlpha,
    /// Red, green, blue.
    Rgb,
    /// Red, green, blue, alpha.
    Rgba,
}

impl Channels {
    /// All combinations of channels.
    pub const ALL: [Self; 4] = [Self::Grey, Self::GreyAlpha, Self::Rgb, Self::Rgba];

    /// Returns the number of samples in a pixel.
    pub const fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::GreyAlpha => 2,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }

    /// Returns whether there is an alpha channel.
    pub const fn has_alpha(self) -> bool {
        matches!(self, Self::GreyAlpha | Self::Rgba)
    }

    /// Returns whether there are three colours.
    pub const fn is_colour(self) -> bool {
        matches!(self, Self::Rgb | Self::Rgba)
    }

    /// Returns these channels with alpha added.
    #[must_use]
    pub const fn with_alpha(self) -> Self {
        if self.is_colour() { Self::Rgba } else { Self::GreyAlpha }
    }

    /// Returns these channels with alpha removed.
    #[must_use]
    pub const fn without_alpha(self) -> Self {
        if self.is_colour() { Self::Rgb } else { Self::Grey }
    }
}

impl std::fmt::Display for Channels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Grey => "grey",
            Self::GreyAlpha => "grey and alpha",
            Self::Rgb => "RGB",
            Self::Rgba => "RGBA",
        })
    }
}
