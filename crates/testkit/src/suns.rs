use cosmorama::filter::{FilterSettings, Kernel};
use cosmorama::raster::Rgba;
use cosmorama::sphere::Direction;
use cosmorama::world::World;

use crate::light_by_direction;

/// The filter that keeps light.
pub const LIGHT: FilterSettings =
    FilterSettings { kernel: Kernel::LIGHT, anti_ringing: false, ..FilterSettings::DEFAULT };

/// Directions in which some form is singular: poles, the octahedron's vertices, an edge and a corner of the cube, the
/// seam behind and beside it, and the direction behind a mirror ball.
pub const HARD_PLACES: [[f64; 3]; 9] = [
    [0.0, 1.0, 0.001],
    [0.03, 1.0, 0.03],
    [1.0, 0.001, 0.0],
    [0.001, 0.001, 1.0],
    [0.001, 0.001, -1.0],
    [1.0, 0.2, 1.0],
    [1.0, 1.0, 1.0],
    [0.003, 0.5, 1.0],
    [-0.6, 0.35, -0.7],
];

/// Returns the mean number of pixels per steradian of a panorama so many columns wide.
pub fn equirect_density(width: usize) -> f64 {
    (width * width / 2) as f64 / (4.0 * std::f64::consts::PI)
}

/// Returns the light of a world with a sun of this width (σ, in radians) in a direction, and very little around it.
///
/// # Panics
/// When the direction is zero or not finite.
pub fn sun(world: &World, towards: [f64; 3], width: f64) -> Vec<Rgba> {
    let sun = Direction::new(towards.into()).expect("a direction").vector();
    light_by_direction(world, |direction| {
        let distance = direction.vector().distance(sun) / width;
        [(1e5 * (-0.5 * distance * distance).exp() + 1e-6) as f32; 3]
    })
}
