//! Light of a world: averages under lobes, spherical harmonics, its energy balance and its bright sources.

pub(crate) mod bright_sources;
pub(crate) mod energy_balance;
mod figures;
mod harmonics;
mod lobes;
mod roughness_map;
mod texel_angles;

pub use energy_balance::LightBalance;
pub use figures::LightFigures;
pub use harmonics::{HIGHEST_ORDER, HarmonicBasis, HarmonicFunctions, HarmonicWindow, Harmonics, HarmonicsError};
pub use lobes::{AllTexels, LightTree, Lobe, LobeAverages, LobeError, PreparedLight, SHARPEST, SMOOTHEST};
pub use roughness_map::{ChainLevel, RoughnessMap};
