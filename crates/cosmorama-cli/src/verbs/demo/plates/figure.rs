//! Figure 2: the directions that a reflection cone covers, on two maps of the environment.

use anyhow::Result;
use cosmorama::camera::{CameraModel, FieldOfView, PerspectiveCamera, View};
use cosmorama::explain::{Figures, Underlay};
use cosmorama::filter::FilterSettings;
use cosmorama::render::{Accuracy, Needs};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::World;

use super::studio::Studio;
use super::{MERCATOR, file_of};

/// Angle between opposite sides of the cone: a square one then covers 3/8 of the world.
const CONE: Angle = Angle::from_degrees(147.968_76);

/// Width of the map, in pixels where an edge has 768.
const MAP: usize = 768;

/// Draws the cone on Mercator's map.
pub(super) fn on_mercator(studio: &Studio) -> Result<String> {
    let world = World::new([("Mercator".to_owned(), studio.map(MAP)?)])?;
    drawn(studio, &world, &[Underlay { view: 0, href: MERCATOR.to_owned() }])
}

/// Draws the cone on the unfolded cube.
pub(super) fn on_cube(studio: &Studio) -> Result<String> {
    let world = studio.environment().world;
    let underlay = |view: usize, face: CubeFace| Underlay { view, href: file_of(face) };
    let underlays: Vec<Underlay> = studio.faces().enumerate().map(|(view, (face, _))| underlay(view, face)).collect();
    drawn(studio, world, &underlays)
}

fn drawn(studio: &Studio, world: &World, underlays: &[Underlay]) -> Result<String> {
    let target = &cone(studio)?;
    let needs = Needs::of(world, std::slice::from_ref(target), &FilterSettings::DEFAULT, Accuracy::Exact);
    Ok(Figures { world, target }.unfolded(&needs, underlays))
}

/// Returns the view whose sides are those of the cone.
fn cone(studio: &Studio) -> Result<View> {
    let camera = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(CONE)));
    let [yaw, pitch, roll] = [28.0, 24.0, 12.0].map(Angle::from_degrees);
    let side = studio.scaled(MAP);
    Ok(View { orientation: Orientation::from_yaw_pitch_roll(yaw, pitch, roll), ..camera.view(side, side)? })
}
