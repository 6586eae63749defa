//! Light of a world: averages under lobes, spherical harmonics, its energy balance and its bright sources.

mod all_texels;
mod averages;
pub(crate) mod bright_sources;
pub(crate) mod energy_balance;
mod figures;
mod harmonics;
mod light_tree;
mod lobe;
mod texel_angles;

pub use all_texels::AllTexels;
pub use averages::LobeAverages;
pub use energy_balance::LightBalance;
pub use figures::LightFigures;
pub use harmonics::{HIGHEST_ORDER, HarmonicBasis, HarmonicFunctions, HarmonicWindow, Harmonics, HarmonicsError};
pub use light_tree::LightTree;
pub use lobe::{Lobe, LobeError, SHARPEST, SMOOTHEST};

use texel_angles::texel_angles;
