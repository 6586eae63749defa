use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Rgba;
use cosmorama::render::Beyond;

use super::Colour;

/// Treatment of directions that no view covers: an error, filling with a [`Colour`], or the world itself, mirrored or
/// stretched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Missing {
    /// An error: every direction must be covered.
    Error,
    /// Filling with a colour, which may be transparent.
    Fill(Rgba),
    /// Filling with what stands beyond the edge of the world: `mirror` or `stretch`.
    Continue(Beyond),
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Error => f.write_str("error"),
            Self::Fill(colour) => Colour(*colour).fmt(f),
            Self::Continue(Beyond::Mirror) => f.write_str("mirror"),
            Self::Continue(Beyond::Stretch) => f.write_str("stretch"),
        }
    }
}

impl FromStr for Missing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "error" => Ok(Self::Error),
            "mirror" => Ok(Self::Continue(Beyond::Mirror)),
            "stretch" => Ok(Self::Continue(Beyond::Stretch)),
            _ => {
                let colour = text.parse::<Colour>();
                let colour =
                    colour.map_err(|message| format!("{message}; or mirror, stretch, or error, the default"))?;
                Ok(Self::Fill(colour.0))
            }
        }
    }
}
