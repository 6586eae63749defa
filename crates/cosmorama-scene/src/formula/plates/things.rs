//! Plates with things under the environment.

use cosmorama::camera::{CameraModel, FieldOfView, PerspectiveCamera, Placement, View};
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::{Angle, Orientation};

use super::{Plates, Result};
use crate::camera::{Camera, Place};
use crate::material::{Finish, Material, Paint};
use crate::picture::{Background, picture};
use crate::scene::Scene;
use crate::shade::{LightMaps, Surroundings};
use crate::shape::Placing;

/// Paper of the figures.
const PAPER: Rgba = Rgba::opaque(0.9, 0.9, 0.88);

/// Makes Plate 1. The camera stands where the environment is seen from, so that its background is in place.
pub(super) fn lizard(plates: &Plates) -> Result<Image<Rgba>> {
    let stone = Material::of(Finish::matt(Paint::plain([0.42, 0.38, 0.33])));
    let turn = Orientation::from_yaw_pitch_roll(Angle::from_degrees(24.0), Angle::ZERO, Angle::ZERO);
    let placing = Placing { scale: 0.9, turn, origin: [0.1, -1.4, -3.2].into() };
    let scene = Scene::lizard(Material::MIRROR, stone, &placing);
    let place = Place { eye: [0.0; 3].into(), target: [0.05, -0.98, -3.2].into() };
    let camera = Camera::lens(place, perspective(plates, 50.0)?)?;
    // The lizard keeps light from the stone that it stands on.
    shaded(plates, &scene, &camera, (Background::World, true))
}

/// Makes Plate 4: three spheres.
pub(super) fn spheres(plates: &Plates) -> Result<Image<Rgba>> {
    let scene = Scene::plate4();
    let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(30.0)));
    let view = Placement::new(CameraModel::from(camera)).view(plates.scaled(1024), plates.scaled(400))?;
    let camera = Camera::lens(scene.place_before(&view), view)?;
    shaded(plates, &scene, &camera, (Background::Colour(Rgba::BLACK), false))
}

/// Makes Figure 1: the rays of a pixel.
pub(super) fn reflection_cone(plates: &Plates) -> Result<Image<Rgba>> {
    let place = Place { eye: [-1.6, 3.4, 9.0].into(), target: [-0.9, 0.75, 0.0].into() };
    let camera = Camera::lens(place, perspective(plates, 36.0)?)?;
    shaded(plates, &Scene::reflection_cone(), &camera, (Background::Colour(PAPER), false))
}

fn perspective(plates: &Plates, field: f64) -> Result<View> {
    let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(field)));
    plates.frame(camera, Orientation::IDENTITY)
}

/// Makes a picture of things before a background, which hide light from one another or do not.
fn shaded(
    plates: &Plates,
    scene: &Scene,
    camera: &Camera,
    (background, occlusion): (Background, bool),
) -> Result<Image<Rgba>> {
    let sky = plates.environment();
    let maps = LightMaps::of(scene, 0, sky)?;
    let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
    let surroundings = Surroundings::new(sky, &maps, filter)?.with_occlusion(occlusion);
    picture(scene, camera, &[surroundings], background)
}
