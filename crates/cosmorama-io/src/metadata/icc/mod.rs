//! ICC profiles: reading them, and making them for colours that a format cannot name otherwise.

mod made;
mod read;

use cosmorama::raster::{ColourMatrix, Primaries};

pub(crate) use made::{made, made_grey};
pub(crate) use read::{Profile, read};

/// Chromaticity of the white of all profiles (ICC.1:2022, 7.2.16: 0.9642, 1, 0.8249).
const D50: [f64; 2] = [0.9642 / 2.7891, 1.0 / 2.7891];

/// Returns the colorants of primaries: their conversion to XYZ, adapted to D50.
fn colorants_of(primaries: &Primaries) -> ColourMatrix {
    ColourMatrix::to_xyz(primaries).then(&ColourMatrix::adaptation(primaries.white, D50))
}
