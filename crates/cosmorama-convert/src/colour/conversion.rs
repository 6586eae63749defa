use std::sync::Arc;

use cosmorama::raster::{ColourMatrix, Rgba, Threads};
use rayon::prelude::*;

use super::ocio::SpaceConversion;

/// Conversion of light from one colour space to another.
#[derive(Clone, Debug)]
pub(crate) enum LightConversion {
    /// Between primaries.
    Matrix(ColourMatrix),
    /// Between spaces of an OpenColorIO config.
    Spaces(Arc<SpaceConversion>),
}

/// Number of pixels that a thread converts at once.
const PIECE: usize = 1 << 14;

impl LightConversion {
    /// Converts light in place. Returns the number of pixels that lie outside of the primaries, where these are known.
    pub(crate) fn convert(&self, light: &mut [Rgba]) -> usize {
        match self {
            Self::Matrix(matrix) => matrix.convert(light),
            Self::Spaces(spaces) => {
                spaces.convert(light);
                0
            }
        }
    }

    /// Converts the light of a picture in place.
    pub(crate) fn convert_all(&self, light: &mut [Rgba], threads: Threads) {
        match threads {
            Threads::One => {
                self.convert(light);
            }
            Threads::All => light.par_chunks_mut(PIECE).for_each(|piece| {
                self.convert(piece);
            }),
        }
    }
}

/// Returns whether they are the same conversion. Those of configs are compared by identity, since a job has one of each.
impl PartialEq for LightConversion {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Matrix(one), Self::Matrix(other)) => one == other,
            (Self::Spaces(one), Self::Spaces(other)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }
}
