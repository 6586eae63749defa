use std::sync::OnceLock;

use super::zonal::ZonalLight;
use super::{LightTree, LitTexels, Lobe, LobeAverages};
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Light, LightError, World};

/// The light of a world, prepared to be averaged under some lobes, fast and close to the sum over all texels.
///
/// Wide lobes are convolved with spherical harmonics, narrow ones summed by a [`LightTree`]. [`AllTexels`](super::AllTexels) is exact.
///
/// ```
/// use cosmorama::lighting::{Lobe, LobeAverages, PreparedLight};
/// use cosmorama::prelude::*;
///
/// let sky = Image::filled(64, 32, Rgba::opaque(1.0, 1.0, 1.0));
/// let (world, light) = World::from_panorama(sky)?;
/// let rough = Lobe::ggx(0.25)?;
/// let prepared = PreparedLight::new(&world, &light, &[Lobe::LAMBERT, rough])?;
/// assert!((prepared.average(Direction::UP, &rough).0[0] - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PreparedLight<'w> {
    world: &'w World,
    texels: &'w [Rgba],
    zonal: Option<ZonalLight>,
    /// For lobes that are too narrow, and those that were not named.
    tree: OnceLock<LightTree<'w>>,
}

impl<'w> PreparedLight<'w> {
    /// Prepares a world's light for some lobes. Others work, too, but slower.
    ///
    /// # Errors
    /// When the light is not that of the world.
    pub fn new(world: &'w World, light: &'w Light, lobes: &[Lobe]) -> Result<Self, LightError> {
        light.check(world)?;
        Ok(Self::of_texels(world, light.texels(), lobes))
    }

    /// Prepares the light of a world's texels.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of_texels(world: &'w World, texels: &'w [Rgba], lobes: &[Lobe]) -> Self {
        let zonal = ZonalLight::of(&LitTexels::of_texels(world, texels), lobes);
        Self { world, texels, zonal, tree: OnceLock::new() }
    }

    /// Returns about how many bytes a world's light takes for some lobes, beside those of blocks of texels.
    pub fn bytes_for(world: &World, lobes: &[Lobe]) -> usize {
        ZonalLight::bytes_for(world, lobes)
    }

    /// Returns whether some of these lobes are so narrow that blocks of texels are gathered for them.
    pub fn has_narrow(lobes: &[Lobe]) -> bool {
        !ZonalLight::takes_all(lobes)
    }

    fn tree(&self) -> &LightTree<'w> {
        self.tree.get_or_init(|| LightTree::of_texels(self.world, self.texels))
    }
}

impl LobeAverages for PreparedLight<'_> {
    fn shown(&self) -> f64 {
        self.zonal.as_ref().map_or_else(|| self.tree().shown(), ZonalLight::shown)
    }

    fn averages(&self, axes: &[Direction], lobe: &Lobe) -> Vec<Rgba> {
        let by_bands = self.zonal.as_ref().and_then(|zonal| zonal.averages(axes, lobe));
        by_bands.unwrap_or_else(|| self.tree().averages(axes, lobe))
    }
}
