//! Light of a world: averages under lobes, spherical harmonics, tables of colours, its energy balance and its suns; and how surfaces reflect it.

mod brdf;
pub(crate) mod bright_sources;
mod colour_table;
pub(crate) mod energy_balance;
mod figures;
mod harmonics;
mod map_difference;
mod prefilter;
mod roughness_map;
mod suns;
mod texel_angles;

pub use brdf::{Albedo, BrdfChannels, BrdfError, BrdfModel, LARGEST_BRDF_TABLE};
pub use colour_table::{ColourTable, ColourTableError, LARGEST_COLOUR_TABLE, TableAngle};
pub use energy_balance::LightBalance;
pub use figures::LightFigures;
pub use harmonics::{
    CodeLanguage, HIGHEST_ORDER, HarmonicAccuracy, HarmonicBasis, HarmonicFunctions, HarmonicKind, HarmonicPreset,
    HarmonicWindow, Harmonics, HarmonicsError, PresetError, SeriesAccuracy, StoredHarmonics,
};
pub use map_difference::MapDifference;
pub use prefilter::{AllTexels, LightTree, Lobe, LobeAverages, LobeError, PreparedLight, SHARPEST, SMOOTHEST};
pub use roughness_map::{ChainLevel, RoughnessMap};
pub use suns::{Sun, Suns};
