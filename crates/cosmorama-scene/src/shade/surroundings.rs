use cosmorama::camera::Footprint;
use cosmorama::filter::{Bilinear, EwaPyramid, Filter, FilterKind, FilterSettings, Kernel, Prepared};
use cosmorama::raster::Rgba;

use super::maps::rough_alpha;
use super::{Beam, Chrome, LightMaps, Sky};
use crate::camera::Normal;
use crate::error::SceneError;
use crate::material::Material;
use crate::scene::{Object, Scene};

/// A world and its maps of light, ready to be asked by footprints from any number of threads.
pub struct Surroundings<'a> {
    mirror: Box<dyn Prepared + 'a>,
    /// Filter of parts of pixels, if it is another: what lies side by side adds to the whole.
    parts: Option<Box<dyn Prepared + 'a>>,
    /// Filter of what sees much of the world.
    wide: Option<Box<dyn Prepared + 'a>>,
    diffuse: Option<Box<dyn Prepared + 'a>>,
    rough: Vec<(f64, Box<dyn Prepared + 'a>)>,
    pub(crate) sky: Sky<'a>,
    pub(crate) filter: FilterSettings,
    /// Mean of the world's light, of all channels.
    pub(crate) mean: f64,
    chrome: Chrome,
}

/// Kernel of parts of pixels: [`Kernel::LIGHT`], whose weights add to one over parts side by side. Where parts are less
/// than a texel it interpolates, about as sharply as a tent.
const SIDE_BY_SIDE: Kernel = Kernel { floor: 0.9, ..Kernel::LIGHT };

/// Change of direction over a pixel, in radians, from which a footprint is looked up on a cube, five texels of it.
const WIDE: f64 = 0.03;

/// Extent of what is averaged at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Detail {
    /// A pixel, or the quarter of one.
    Pixel,
    /// A small part of one, beside others.
    Part,
}

impl<'a> Surroundings<'a> {
    /// Prepares a world, by a filter for what mirrors reflect, with its maps.
    ///
    /// # Errors
    /// When the light is not that of the world.
    pub fn new(sky: Sky<'a>, maps: &'a LightMaps, filter: FilterSettings) -> Result<Self, SceneError> {
        let smooth = EwaPyramid { kernel: Kernel::ADAPTIVE, anti_ringing: true };
        let rough = maps.rough.iter().map(|(alpha, map)| Ok((*alpha, smooth.prepare(&map.world, &map.light)?)));
        let diffuse = maps.diffuse.as_ref().map(|map| Bilinear.prepare(&map.world, &map.light)).transpose()?;
        let wide = maps.cube.as_ref().filter(|_| filter.kind == FilterKind::EwaPyramid);
        let side_by_side = EwaPyramid { kernel: SIDE_BY_SIDE, anti_ringing: false };
        let wide = wide.map(|cube| side_by_side.prepare(&cube.world, &cube.light)).transpose()?;
        let parts = match filter.kind {
            FilterKind::Ewa | FilterKind::EwaPyramid => {
                let settings = FilterSettings { kernel: SIDE_BY_SIDE, anti_ringing: false, ..filter };
                Some(settings.prepare(sky.world, sky.light)?)
            }
            FilterKind::Point
            | FilterKind::Bilinear
            | FilterKind::Labels(_)
            | FilterKind::Classic(_)
            | FilterKind::Reference { .. } => None,
        };
        Ok(Self {
            parts,
            mean: sky.mean(),
            mirror: filter.prepare(sky.world, sky.light)?,
            wide,
            diffuse,
            rough: rough.collect::<Result<_, SceneError>>()?,
            sky,
            filter,
            chrome: Chrome::earth_and_sky(),
        })
    }

    /// Returns the surroundings with another table for what is of chrome; otherwise that is [`Chrome::earth_and_sky`].
    #[must_use]
    pub fn with_chrome(self, chrome: Chrome) -> Self {
        Self { chrome, ..self }
    }

    /// Checks that there are maps for all that a scene's materials ask for.
    pub(crate) fn check(&self, scene: &Scene) -> Result<(), SceneError> {
        for Object { material, .. } in &scene.objects {
            if material.diffuse > 0.0 && self.diffuse.is_none() {
                return Err(SceneError::NoMap("matt things"));
            }
            if rough_alpha(material).is_some_and(|wanted| self.rough.iter().all(|(alpha, _)| *alpha != wanted)) {
                return Err(SceneError::NoMap("a roughness"));
            }
        }
        Ok(())
    }

    /// Averages the world itself.
    pub(crate) fn world(&self, footprint: &Footprint, detail: Detail) -> Rgba {
        let seen = match (&self.wide, &self.parts, detail) {
            (Some(wide), ..) if widest(footprint) > WIDE => wide.average(footprint),
            (_, Some(parts), Detail::Part) => parts.average(footprint),
            _ => self.mirror.average(footprint),
        };
        match self.sky.unseen {
            None => seen,
            Some(unseen) => {
                let covered = self.mirror.covered(footprint);
                let behind = unseen * (1.0 - covered);
                Rgba(std::array::from_fn(|k| seen.0[k] * covered + behind.0[k]))
            }
        }
    }

    /// Returns the light that a surface sends back: dc·D + sc·S, of which S is given.
    pub(crate) fn shade(&self, normal: &Normal, reflected: Rgba, material: &Material) -> Rgba {
        let mut sum = reflected * material.specular as f32;
        if let (true, Some(diffuse)) = (material.diffuse > 0.0, &self.diffuse) {
            sum += diffuse.average(&normal.footprint()) * material.diffuse as f32;
        }
        Rgba::opaque(sum.0[0], sum.0[1], sum.0[2])
    }

    /// Returns what a material reflects of beams, weighed by colour: S.
    pub(crate) fn reflected(&self, beams: &[Beam], material: &Material, detail: Detail) -> Rgba {
        let mut sum = [0.0; 3];
        for beam in beams {
            let light = self.reflection(material, &beam.footprint(), detail);
            (0..3).for_each(|k| sum[k] += light.0[k] * beam.weight[k] as f32);
        }
        Rgba::opaque(sum[0], sum[1], sum[2])
    }

    /// Returns what a material reflects of a footprint.
    pub(crate) fn reflection(&self, material: &Material, footprint: &Footprint, detail: Detail) -> Rgba {
        if material.chrome {
            return self.chrome.average(footprint);
        }
        let wanted = rough_alpha(material);
        let rough = self.rough.iter().find(|(alpha, _)| Some(*alpha) == wanted);
        rough.map_or_else(|| self.world(footprint, detail), |(_, map)| map.average(footprint))
    }
}

/// Returns the longest derivative of a footprint.
fn widest(footprint: &Footprint) -> f64 {
    footprint.jacobian.dx.length_squared().max(footprint.jacobian.dy.length_squared()).sqrt()
}
