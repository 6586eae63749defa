use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Rgba;

use super::Colour;

/// What becomes of directions that no view covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Missing {
    /// They are an error.
    Error,
    /// They are filled, possibly with nothing.
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
        let Colour(colour) = text.parse().map_err(|message| format!("{message}, or error"))?;
        Ok(Self::Fill(colour))
    }
}
