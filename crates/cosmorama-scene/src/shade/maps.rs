use std::f64::consts::FRAC_PI_2;

use cosmorama::camera::{CameraModel, EquirectCamera, FieldOfView, PerspectiveCamera, Placement};
use cosmorama::filter::{FilterKind, FilterSettings, Kernel};
use cosmorama::lighting::{Lobe, LobeAverages, PreparedLight, SMOOTHEST};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use cosmorama::sphere::{Angle, CubeFace};
use cosmorama::world::{Light, World};

use super::Sky;
use crate::error::SceneError;
use crate::material::Material;
use crate::scene::Scene;

/// Small panoramas of a world's light, filtered beforehand: what falls on matt surfaces, and what rough ones reflect
/// (Greene 1986, section 7).
#[derive(Debug)]
pub struct LightMaps {
    pub(super) diffuse: Option<LightMap>,
    pub(super) rough: Vec<(f64, LightMap)>,
    pub(super) cube: Option<LightMap>,
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
    /// Gathers the maps that a scene's materials need.
    ///
    /// # Errors
    /// When the light is not that of the world, or a material is out of range.
    pub fn of(scene: &Scene, sky: Sky) -> Result<Self, SceneError> {
        let Sky { world, light, unseen } = sky;
        let unseen = unseen.unwrap_or(Rgba::TRANSPARENT);
        scene.check()?;
        let mut alphas: Vec<f64> = scene.materials().filter_map(rough_alpha).collect();
        alphas.sort_by(f64::total_cmp);
        alphas.dedup();
        let is_matt = scene.materials().any(|material| material.diffuse > 0.0);
        light.check(world)?;
        let mirrors =
            |material: &Material| material.specular > 0.0 && !material.chrome && rough_alpha(material).is_none();
        let cube = scene.materials().any(mirrors).then(|| LightMap::cube(&sky)).flatten();
        if !is_matt && alphas.is_empty() {
            return Ok(Self { diffuse: None, rough: Vec::new(), cube });
        }
        let lobes = alphas.iter().map(|alpha| Lobe::ggx(*alpha)).collect::<Result<Vec<_>, _>>()?;
        let all: Vec<Lobe> = is_matt.then_some(Lobe::LAMBERT).into_iter().chain(lobes.iter().copied()).collect();
        let prepared = PreparedLight::new(world, light, &all)?;
        let rough = |(alpha, lobe): (f64, Lobe)| {
            let width = (ACROSS_ALPHA * std::f64::consts::TAU / alpha) as usize;
            (alpha, LightMap::of(&prepared, (&lobe, unseen), width.clamp(WIDTHS.0, WIDTHS.1)))
        };
        Ok(Self {
            diffuse: is_matt.then(|| LightMap::of(&prepared, (&Lobe::LAMBERT, unseen), MATT)),
            rough: alphas.into_iter().zip(lobes).map(rough).collect(),
            cube,
        })
    }
}

/// Returns the roughness of a material whose reflection a map holds; `None` for mirrors and for what reflects nothing.
pub(super) fn rough_alpha(material: &Material) -> Option<f64> {
    (material.specular > 0.0 && material.alpha >= SMOOTHEST && !material.chrome).then_some(material.alpha)
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
