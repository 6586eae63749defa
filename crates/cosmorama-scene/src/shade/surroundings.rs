use cosmorama::camera::Footprint;
use cosmorama::filter::{
    Bilinear, CrossSection, EwaPyramid, Feline, Filter, FilterKind, FilterSettings, Kernel, Prepared,
};
use cosmorama::raster::Rgba;
use cosmorama::sphere::{Angle, Direction, DirectionJacobian};
use glam::{DMat3, DVec3, Vec3};

use super::facets::LobePart;
use super::maps::LightMap;
use super::rough::RoughLight;
use super::{Beam, Gloss, LightMaps, Proxy, Sky, Surface};
use crate::error::SceneError;
use crate::material::Material;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shape::Wall;

/// A world and its maps of light, ready to be asked by footprints from any number of threads.
pub struct Surroundings<'a> {
    mirror: Box<dyn Prepared + 'a>,
    /// Filter of parts of pixels, if it is another: what lies side by side adds to the whole.
    parts: Option<Box<dyn Prepared + 'a>>,
    /// Filter of what sees much of the world.
    wide: Option<Box<dyn Prepared + 'a>>,
    diffuse: Option<Box<dyn Prepared + 'a>>,
    rough: RoughLight<'a>,
    maps: &'a LightMaps,
    pub(crate) sky: Sky<'a>,
    pub(crate) filter: FilterSettings,
    /// Mean of the world's light, of all channels.
    pub(crate) mean: f64,
    proxy: Option<Proxy>,
    /// Rotation from the things to the world.
    turn: DMat3,
    /// Whether things hide light from what is matt.
    occlusion: bool,
}

/// Kernel of parts of pixels: a B-spline as wide as [`Kernel::LIGHT`], whose weights all but add to one over parts side by
/// side. Where parts are less than a texel it interpolates, about as sharply as a tent. Rows of texels are averaged at
/// once by it, since it is a cubic.
const SIDE_BY_SIDE: Kernel =
    Kernel { scale: 1.245, floor: 0.8, ..Kernel::uniform(CrossSection::Cubic { b: 1.0, c: 0.0 }) };

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
        let one = |(alpha, map): &'a (f64, LightMap)| Ok((*alpha, Feline.prepare(&map.world, &map.light)?));
        let prepared = |maps: &'a [(f64, LightMap)]| maps.iter().map(one).collect::<Result<Vec<_>, SceneError>>();
        let rough = RoughLight { exact: prepared(&maps.exact)?, chain: prepared(&maps.chain)? };
        let diffuse = maps.diffuse.as_ref().map(|map| Bilinear.prepare(&map.world, &map.light)).transpose()?;
        let wide = maps.cube.as_ref().filter(|_| filter.kind == FilterKind::EwaPyramid);
        let side_by_side = EwaPyramid { kernel: SIDE_BY_SIDE, anti_ringing: false };
        let wide = wide.map(|cube| side_by_side.prepare(&cube.world, &cube.light)).transpose()?;
        let parts = match filter.kind {
            FilterKind::Ewa | FilterKind::EwaPyramid if maps.mirror => {
                let settings = FilterSettings { kernel: SIDE_BY_SIDE, anti_ringing: false, ..filter };
                Some(settings.prepare(sky.world, sky.light)?)
            }
            FilterKind::Ewa
            | FilterKind::EwaPyramid
            | FilterKind::Point
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
            rough,
            maps,
            sky,
            filter,
            proxy: None,
            turn: DMat3::IDENTITY,
            occlusion: false,
        })
    }

    /// Returns the surroundings with walls that stand for a near world; otherwise it is far away.
    #[must_use]
    pub fn with_proxy(self, proxy: Option<Proxy>) -> Self {
        Self { proxy, ..self }
    }

    /// Returns the surroundings in which things hide light from what is matt, or do not, as by default.
    #[must_use]
    pub fn with_occlusion(self, occlusion: bool) -> Self {
        Self { occlusion, ..self }
    }

    /// Returns whether things hide light from what is matt.
    pub(crate) fn has_occlusion(&self) -> bool {
        self.occlusion
    }

    /// Turns the things about the y axis, anticlockwise as seen from above, and not the world.
    pub fn turn_things(&mut self, angle: Angle) {
        self.turn = DMat3::from_rotation_y(angle.radians());
    }

    /// Returns the rotation from the things to the world.
    pub(crate) fn turn(&self) -> &DMat3 {
        &self.turn
    }

    /// Returns the world, prepared by the filter of mirrors.
    pub(crate) fn prepared(&self) -> &dyn Prepared {
        &*self.mirror
    }

    /// Returns whether the world is far away.
    pub(crate) fn is_far(&self) -> bool {
        self.proxy.is_none()
    }

    /// Checks that there are maps for all that the materials of a scene's things under this world ask for.
    pub(crate) fn check(&self, scene: &Scene, number: usize) -> Result<(), SceneError> {
        let held = self.maps.alphas();
        for material in scene.materials_under(number) {
            if material.is_matt() && self.diffuse.is_none() {
                return Err(SceneError::NoMap("matt things"));
            }
            if LobePart::ranges(material).any(|range| !held.hold(range)) {
                return Err(SceneError::NoMap("a roughness"));
            }
            let albedo = self.maps.albedo.as_ref();
            let is_held = albedo.is_some_and(|albedo| material.alphas().is_none_or(|range| albedo.holds(range)));
            if material.finish.is_some() && !is_held {
                return Err(SceneError::NoMap("metallic-roughness"));
            }
        }
        Ok(())
    }

    /// Returns what a ray of the camera sees of the world itself.
    pub(crate) fn seen(&self, ray: &Ray) -> Rgba {
        let footprint = self.proxy.map_or_else(|| ray.footprint(), |proxy| proxy.footprint(ray));
        self.world(&footprint, Detail::Pixel)
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

    /// Returns a material where a ray meets it.
    pub(crate) fn surface<'m>(&self, wall: &Wall, material: &'m Material) -> Surface<'m> {
        Surface::of(wall, material, self.maps.albedo.as_ref())
    }

    /// Returns the light that a surface sends to the eye: emissive + kd·D + ks·S, of which S is given.
    pub(crate) fn shade(&self, surface: &Surface, reflected: Rgba) -> Rgba {
        let light = |Rgba([red, green, blue, _]): Rgba| Vec3::new(red, green, blue);
        let mut sum = surface.emissive.as_vec3() + light(reflected) * surface.specular.as_vec3();
        if let (true, Some(diffuse)) = (surface.diffuse != DVec3::ZERO, &self.diffuse) {
            sum += light(diffuse.average(&turned(&surface.normal.footprint(), &self.turn))) * surface.diffuse.as_vec3();
        }
        Rgba::opaque(sum.x, sum.y, sum.z)
    }

    /// Returns what a surface reflects of beams, weighed by colour: S.
    pub(crate) fn reflected(&self, beams: &[Beam], gloss: Gloss, detail: Detail) -> Rgba {
        let mut sum = [0.0; 3];
        for beam in beams {
            let light = match &self.proxy {
                Some(proxy) => self.near(proxy, gloss, &beam.ray, detail),
                None => self.reflection(gloss, &beam.footprint(), detail),
            };
            (0..3).for_each(|k| sum[k] += light.0[k] * beam.weight[k] as f32);
        }
        Rgba::opaque(sum[0], sum[1], sum[2])
    }

    /// Returns what a surface reflects of a footprint in the things' frame.
    pub(crate) fn reflection(&self, gloss: Gloss, footprint: &Footprint, detail: Detail) -> Rgba {
        let look = |gloss: Gloss, seen: &Footprint| self.look(gloss, &turned(seen, &self.turn), detail);
        match gloss {
            Gloss::Facets(alpha, normal) => LobePart::sum(alpha, normal, footprint.direction.vector(), |part| {
                look(Gloss::World(part.alpha), &part.footprint(footprint))
            }),
            Gloss::Chrome(_) | Gloss::World(_) => look(gloss, footprint),
        }
    }

    /// Returns what a surface reflects of a ray, in the things' frame, under walls that stand for a near world.
    fn near(&self, proxy: &Proxy, gloss: Gloss, ray: &Ray, detail: Detail) -> Rgba {
        let look = |gloss: Gloss, ray: &Ray| self.look(gloss, &proxy.footprint(&ray.turned(&self.turn)), detail);
        match gloss {
            Gloss::Facets(alpha, normal) => {
                LobePart::sum(alpha, normal, ray.direction, |part| look(Gloss::World(part.alpha), &part.ray(ray)))
            }
            Gloss::Chrome(_) | Gloss::World(_) => look(gloss, ray),
        }
    }

    /// Returns what a surface reflects of a footprint in the world's frame, by the lobe of a map.
    fn look(&self, gloss: Gloss, footprint: &Footprint, detail: Detail) -> Rgba {
        match gloss {
            Gloss::Chrome(chrome) => chrome.average(footprint),
            Gloss::World(alpha) | Gloss::Facets(alpha, _) => {
                self.rough.average(alpha, footprint, || self.world(footprint, detail))
            }
        }
    }
}

/// Returns a footprint in another frame.
fn turned(footprint: &Footprint, turn: &DMat3) -> Footprint {
    let Footprint { direction, jacobian: DirectionJacobian { dx, dy } } = *footprint;
    Footprint {
        direction: Direction::from_unit(*turn * direction.vector()),
        jacobian: DirectionJacobian { dx: *turn * dx, dy: *turn * dy },
    }
}

/// Returns the longest derivative of a footprint.
fn widest(footprint: &Footprint) -> f64 {
    footprint.jacobian.dx.length_squared().max(footprint.jacobian.dy.length_squared()).sqrt()
}
