//! Pictures of the papers, made anew.

pub(super) mod figures;
pub(super) mod plates;

use cosmorama::laboratory;
use cosmorama::sphere::{Angle, Direction, Orientation};
use cosmorama::world::World;

/// Angle between the axis of a cone and its sides. It covers 3/8 of the world, as the papers' does.
const HALF_ANGLE: Angle = Angle::from_degrees(75.522);

/// Noun by which progress counts what is made.
const NOUN: &str = "picture";

/// Draws Figure 2 of Greene's World Projections (1986): the part of a world's images that lies in a reflection cone, about an axis
/// so many degrees to the right and up.
fn reflection_cone(world: &World, (yaw, pitch): (f64, f64)) -> String {
    let [yaw, pitch] = [yaw, pitch].map(Angle::from_degrees);
    let axis = Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::ZERO).to_world(Direction::FRONT);
    laboratory::figures::cone(world, axis, HALF_ANGLE).0
}
