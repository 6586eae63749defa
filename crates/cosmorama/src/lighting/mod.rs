//! Light of a world: averages under lobes, its energy balance and its bright sources.

mod all_texels;
mod averages;
pub(crate) mod bright_sources;
pub(crate) mod energy_balance;
mod figures;
mod light_tree;
mod lobe;
mod texel_angles;

pub use all_texels::AllTexels;
pub use averages::LobeAverages;
pub use energy_balance::LightBalance;
pub use figures::LightFigures;
pub use light_tree::LightTree;
pub use lobe::{Lobe, LobeError, SHARPEST, SMOOTHEST};

use texel_angles::texel_angles;
