use std::f64::consts::FRAC_PI_2;

use cosmorama::camera::{CameraModel, EquirectCamera, FieldOfView, PerspectiveCamera, Placement};
use cosmorama::filter::{FilterKind, FilterSettings, Kernel};
use cosmorama::lighting::{Lobe, LobeAverages, LobeError, PreparedLight};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use cosmorama::sphere::{Angle, CubeFace};
use cosmorama::world::{Light, World};

use super::Sky;
use super::albedo_table::AlbedoTable;
use super::rough::Alphas;
use crate::error::SceneError;
use crate::material::Material;
use crate::scene::Scene;

/// Small panoramas of a world's light, filtered beforehand: what falls on matt surfaces, and what rough ones reflect
/// (Greene 1986, section 7).
#[derive(Debug)]
pub struct LightMaps {
    pub(super) diffuse: Option<LightMap>,
    /// Maps for the roughnesses of whole materials, and for those between which others lie.
    pub(super) exact: Vec<(f64, LightMap)>,
    pub(super) chain: Vec<(f64, LightMap)>,
    pub(super) cube: Option<LightMap>,
    /// Albedo of microfacets, if there is metallic-roughness.
    pub(super) albedo: Option<AlbedoTable>,
}

/// A panorama of a world's light.
#[derive(Debug)]
pub(super) struct LightMap {
    pub(super) world: World,
    pub(super) light: Light,
}

/// Width of the map of matt surfaces. Linear interpolation between its texels errs by less than 4·10⁻⁴.
const MATT: usize = 128;

/// Texels of a map of rough reflection across an angle of α, and the least and greatest width.
const ACROSS_ALPHA: f64 = 2.5;
const WIDTHS: (usize, usize) = (96, 1024);

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
        let alphas = Alphas::of(materials().filter_map(Material::alphas));
        let is_matt = materials().any(Material::is_matt);
        light.check(world)?;
        let cube = if alphas.mirror { LightMap::cube(&sky) } else { None };
        let albedo = materials().any(|material| material.finish.is_some()).then(AlbedoTable::new);
        let empty = Self { diffuse: None, exact: Vec::new(), chain: Vec::new(), cube, albedo };
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
            let width = (ACROSS_ALPHA * std::f64::consts::TAU / alpha) as usize;
            (*alpha, LightMap::of(&prepared, (lobe, unseen), width.clamp(WIDTHS.0, WIDTHS.1)))
        };
        Ok(Self {
            diffuse: is_matt.then(|| LightMap::of(&prepared, (&Lobe::LAMBERT, unseen), MATT)),
            exact: exact.iter().map(map).collect(),
            chain: chain.iter().map(map).collect(),
            ..empty
        })
    }

    /// Returns the roughnesses that there are maps of.
    pub(super) fn alphas(&self) -> Alphas {
        let of = |maps: &[(f64, LightMap)]| maps.iter().map(|(alpha, _)| *alpha).collect();
        Alphas { exact: of(&self.exact), chain: of(&self.chain), mirror: true }
    }
}

/// Greatest edge of the faces of a cube of a world's light.
const EDGE: usize = 256;

impl LightMap {
    /// Returns a world's light on the faces of a cube, for what sees much of it at once: there an ellipse is an ellipse,
    /// where in a panorama it is a region around a pole (Greene 1986, section 6). `None` if the world is of such faces,
    /// or does not show all.
    fn cube(sky: &Sky) -> Option<Self> {
        if sky.unseen.is_some() || sky.world.sources().iter().all(|source| source.view.is_pinhole()) {
            return None;
        }
        let edge = ((FRAC_PI_2 / sky.world.texel_pitch()).ceil() as usize).next_power_of_two().min(EDGE);
        let filter = FilterSettings { kind: FilterKind::EwaPyramid, kernel: Kernel::LIGHT, anti_ringing: false };
        let face = |face: CubeFace| {
            let camera = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(90.0))));
            let placement = Placement { orientation: face.orientation(), ..Placement::new(camera) };
            let view = placement.view(edge, edge).expect("a face of more than no pixels");
            let resampler = Resampler { world: sky.world, target: &view, filter };
            let picture = resampler.render(sky.light.texels());
            (face.name().to_owned(), view, picture)
        };
        let (world, light) = World::from_pictures(CubeFace::ALL.map(face)).ok()?;
        Some(Self { world, light })
    }

    fn of(light: &PreparedLight, (lobe, unseen): (&Lobe, Rgba), width: usize) -> Self {
        let view = CameraModel::Equirect(EquirectCamera::default()).view(width, width / 2);
        let view = view.expect("a panorama of more than no pixels");
        let picture: Image<Rgba> = light.picture(&view, lobe, unseen);
        let world = World::new([("light".to_owned(), view)]).expect("one view");
        let light = Light::new(&world, picture.into_pixels()).expect("light of this view");
        Self { world, light }
    }
}
