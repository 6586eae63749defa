use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Rgba;

use super::Colour;

/// Treatment of directions that no view covers: an error, or filling with a [`Colour`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Missing {
    /// An error: every direction must be covered.
    Error,
    /// Filling with a colour, which may be transparent.
    Fill(Rgba),
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Error => f.write_str("error"),
            Self::Fill(colour) => Colour(*colour).fmt(f),
        }
    }
}

impl FromStr for Missing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "error" {
            return Ok(Self::Error);
        }
        let Colour(colour) = text.parse().map_err(|message: String| format!("{message}; or error, the default"))?;
        Ok(Self::Fill(colour))
    }
}
