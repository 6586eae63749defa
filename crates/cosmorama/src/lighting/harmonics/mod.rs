//! Light of a world as a few coefficients: real spherical harmonics.

mod accuracy;
mod basis;
mod code;
mod coefficients;
mod preset;
mod stored;
mod sum;
mod window;

pub use accuracy::{HarmonicAccuracy, SeriesAccuracy};
pub use basis::{HarmonicBasis, HarmonicFunctions};
pub use code::CodeLanguage;
pub use coefficients::{HIGHEST_ORDER, Harmonics, HarmonicsError};
pub use preset::{HarmonicKind, HarmonicPreset, PresetError};
pub use stored::StoredHarmonics;
pub use window::HarmonicWindow;
