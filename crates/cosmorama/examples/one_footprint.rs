//! A world made by formula, and what a rough surface would see of it: its average over one wide footprint.
#![allow(clippy::print_stdout, reason = "a program prints")]

use cosmorama::camera::{CameraModel, Covariance, EquirectCamera, Footprint};
use cosmorama::filter::{EwaPyramid, Filter};
use cosmorama::raster::Rgba;
use cosmorama::sphere::{Angle, Direction};
use cosmorama::world::{Light, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A blue sky over a brown ground, in a panorama.
    let panorama = CameraModel::Equirect(EquirectCamera::default()).view(1024, 512)?;
    let world = World::new([("panorama".to_owned(), panorama)])?;
    let light = Light::by_direction(&world, |direction| {
        if direction.vector().y > 0.0 { Rgba::opaque(0.3, 0.5, 1.0) } else { Rgba::opaque(0.3, 0.2, 0.1) }
    });
    let prepared = EwaPyramid::default().prepare(&world, &light)?;

    // To the horizon, by lobes of more and more degrees: from a sharp line to the mean of both.
    for degrees in [0.01, 1.0, 5.0, 20.0] {
        let sigma = Angle::from_degrees(degrees).radians();
        let below = Direction::from_longitude_latitude(Angle::ZERO, Angle::from_degrees(-3.0));
        let footprint = Footprint::from_covariance(below, Covariance::round(below, sigma * sigma));
        let [red, green, blue, _] = prepared.average(&footprint).0;
        println!("3° below the horizon, standard deviation {degrees}°: {red:.3} {green:.3} {blue:.3}");
    }
    Ok(())
}
