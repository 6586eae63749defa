use std::f64::consts::FRAC_PI_2;

use cosmorama::camera::{CameraModel, EquirectCamera, FieldOfView, PerspectiveCamera, Placement, View};
use cosmorama::filter::{Feline, Filter, FilterKind, FilterSettings, Kernel};
use cosmorama::lighting::{Lobe, LobeAverages, LobeError, PreparedLight};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use cosmorama::sphere::{Angle, CubeFace};
use cosmorama::world::{Light, World};

use super::Sky;
use super::albedo_table::AlbedoTable;
use super::facets::LobePart;
use super::rough::Alphas;
use crate::error::SceneError;
use crate::material::Material;
use crate::scene::Scene;

/// A world's light, filtered beforehand: a small panorama of what falls on matt surfaces, and cubes of what rough ones reflect
/// (Greene 1986, section 7).
#[derive(Debug)]
pub struct LightMaps {
    pub(super) diffuse: Option<LightMap>,
    /// Maps for the roughnesses of whole materials, and for those between which others lie.
    pub(super) exact: Vec<(f64, LightMap)>,
    pub(super) chain: Vec<(f64, LightMap)>,
    pub(super) cube: Option<LightMap>,
    /// Whether some of the world is reflected as it is.
    pub(super) mirror: bool,
    /// Albedo of microfacets, if there is metallic-roughness.
    pub(super) albedo: Option<AlbedoTable>,
    /// Bytes that it took to make the maps, beside their own.
    to_make: usize,
}

/// A map of a world's light.
#[derive(Debug)]
pub(super) struct LightMap {
    pub(super) world: World,
    pub(super) light: Light,
}

/// Width of the map of matt surfaces. Linear interpolation between its texels errs by less than 4·10⁻⁴.
const MATT: usize = 128;

/// Texels of a map of rough reflection across an angle of α in the middle of a face, and the least and greatest edge without margins.
const ACROSS_ALPHA: f64 = 2.5;
const EDGES: (usize, usize) = (32, 328);

impl LightMaps {
    /// Gathers the maps that the materials of a scene's things need, of those that stand under this world, by its number.
    ///
    /// # Errors
    /// When the light is not that of the world, or a material is out of range.
    pub fn of(scene: &Scene, number: usize, sky: Sky) -> Result<Self, SceneError> {
        let Sky { world, light, unseen } = sky;
        let unseen = unseen.unwrap_or(Rgba::TRANSPARENT);
        scene.check()?;
        let materials = || scene.materials_under(number);
        let alphas = Alphas::of(materials().flat_map(LobePart::ranges));
        let is_matt = materials().any(Material::is_matt);
        light.check(world)?;
        let cube = if alphas.mirror { LightMap::cube(&sky) } else { None };
        let finished = || materials().filter(|material| material.finish.is_some());
        let range = finished().filter_map(Material::alphas).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        let albedo = finished().next().map(|_| AlbedoTable::new(range.unwrap_or_default()));
        let (exact, chain, mirror) = (Vec::new(), Vec::new(), alphas.mirror);
        let empty = Self { diffuse: None, exact, chain, cube, mirror, albedo, to_make: 0 };
        if !is_matt && alphas.exact.is_empty() && alphas.chain.is_empty() {
            return Ok(empty);
        }
        let lobe = |alpha: &f64| Ok((*alpha, Lobe::ggx(*alpha)?));
        let lobes = |alphas: &[f64]| alphas.iter().map(lobe).collect::<Result<Vec<(f64, Lobe)>, LobeError>>();
        let (exact, chain) = (lobes(&alphas.exact)?, lobes(&alphas.chain)?);
        let rough = || exact.iter().chain(&chain).map(|(_, lobe)| *lobe);
        let all: Vec<Lobe> = is_matt.then_some(Lobe::LAMBERT).into_iter().chain(rough()).collect();
        let prepared = PreparedLight::new(world, light, &all)?;
        let map = |(alpha, lobe): &(f64, Lobe)| {
            // Squares of four texels have means.
            let edge = ((2.0 * ACROSS_ALPHA / alpha) as usize).next_multiple_of(4).clamp(EDGES.0, EDGES.1);
            (*alpha, LightMap::on_cube((edge, Feline::MARGIN), |view| prepared.picture(view, lobe, unseen)))
        };
        Ok(Self {
            diffuse: is_matt.then(|| LightMap::panorama(&prepared, unseen)),
            exact: exact.iter().map(map).collect(),
            chain: chain.iter().map(map).collect(),
            to_make: PreparedLight::bytes_for(world, &all),
            ..empty
        })
    }

    /// Returns the memory of the maps by roughness, and of their copies for look-ups, in bytes, and of the cube that mirrors look into,
    /// with the weights by which it was made.
    pub fn bytes(&self) -> usize {
        let of =
            |world: &World| world.texel_count() * (size_of::<Rgba>() + size_of::<f32>()) + Feline.setup(world).bytes;
        let cube = self.cube.as_ref().map_or(0, |cube| cube.world.texel_count() * CUBE_TEXEL);
        self.exact.iter().chain(&self.chain).map(|(_, map)| of(&map.world)).sum::<usize>() + cube
    }

    /// Returns about how many bytes it took to make the maps, beside their own.
    pub fn bytes_to_make(&self) -> usize {
        self.to_make
    }

    /// Returns the roughnesses that there are maps of.
    pub(super) fn alphas(&self) -> Alphas {
        let of = |maps: &[(f64, LightMap)]| maps.iter().map(|(alpha, _)| *alpha).collect();
        Alphas { exact: of(&self.exact), chain: of(&self.chain), mirror: true }
    }
}

/// Greatest edge of the faces of a cube of a world's light.
const EDGE: usize = 256;

/// Bytes of a texel of that cube: its light, its solid angle, and its part of the weights by which it is made.
const CUBE_TEXEL: usize = size_of::<Rgba>() + size_of::<f32>() + 22;

impl LightMap {
    /// Returns a world's light on the faces of a cube, for what sees much of it at once: there an ellipse is an ellipse,
    /// where in a panorama it is a region around a pole (Greene 1986, section 6). `None` if the world is of such faces,
    /// or does not show all.
    fn cube(sky: &Sky) -> Option<Self> {
        if sky.unseen.is_some() || sky.world.sources().iter().all(|source| source.view.is_pinhole()) {
            return None;
        }
        let fine = ((FRAC_PI_2 / sky.world.texel_pitch()).ceil() as usize).next_power_of_two();
        let edge = fine.min(EDGE);
        // Texels as fine as the world's own need no pyramid.
        let kind = if edge == fine { FilterKind::Ewa } else { FilterKind::EwaPyramid };
        let filter = FilterSettings { kind, kernel: Kernel::LIGHT, anti_ringing: false };
        let picture = |view: &View| Resampler { world: sky.world, target: view, filter }.render(sky.light.texels());
        Some(Self::on_cube((edge, 0), picture))
    }

    /// Makes a map on the faces of a cube, by the texels along their edges and the margin on each side.
    fn on_cube((edge, margin): (usize, usize), picture: impl Fn(&View) -> Image<Rgba>) -> Self {
        let face = |face: CubeFace| {
            let size = edge + 2 * margin;
            let field = Angle::from_radians(2.0 * (size as f64 / edge as f64).atan());
            let camera = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(field)));
            let placement = Placement { orientation: face.orientation(), ..Placement::new(camera) };
            let view = placement.view(size, size).expect("a face of more than no pixels");
            let picture = picture(&view);
            (face.name().to_owned(), view, picture)
        };
        let (world, light) = World::from_pictures(CubeFace::ALL.map(face)).expect("six faces");
        Self { world, light }
    }

    /// Makes a panorama of what falls on matt surfaces.
    fn panorama(light: &PreparedLight, unseen: Rgba) -> Self {
        let view = CameraModel::Equirect(EquirectCamera::default()).view(MATT, MATT / 2);
        let view = view.expect("a panorama of more than no pixels");
        let picture = light.picture(&view, &Lobe::LAMBERT, unseen);
        let (world, light) = World::from_pictures([("light".to_owned(), view, picture)]).expect("one view");
        Self { world, light }
    }
}
