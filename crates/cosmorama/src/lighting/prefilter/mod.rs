//! Averages of a world's light under lobes, exact and fast.

mod all_texels;
pub(super) mod averages;
mod light_tree;
mod lit_texels;
mod lobe;
mod prepared;
mod zonal;

pub use all_texels::AllTexels;
pub use averages::LobeAverages;
pub use light_tree::LightTree;
pub use lobe::{Lobe, LobeError, SHARPEST, SMOOTHEST};
pub use prepared::PreparedLight;

use lit_texels::{LitTexels, LitView};
