//! A projection of your own: a formula from a place in a picture to a direction, and it is a camera like any other.
//!
//! `cargo run -p cosmorama --example own_projection`
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;

use cosmorama::camera::StMapCamera;
use cosmorama::prelude::*;
use cosmorama::projection::{StMap, StMapTable};
use glam::DVec3;

fn main() -> Result<(), Box<dyn Error>> {
    // Lambert's azimuthal equal-area map of the hemisphere ahead: r = √2 sin(φ/2).
    let (width, height) = (256, 256);
    let table = StMapTable::of_pixels(width, height, |i, j| {
        let (x, y) = ((i as f64 + 0.5) / 128.0 - 1.0, 1.0 - (j as f64 + 0.5) / 128.0);
        let r = x.hypot(y);
        let phi = 2.0 * (r * std::f64::consts::FRAC_1_SQRT_2).min(1.0).asin();
        let across = if r > 0.0 { phi.sin() / r } else { std::f64::consts::SQRT_2 };
        (r <= 1.0).then(|| Direction::new(DVec3::new(x * across, y * across, -phi.cos())))?
    })?;
    let camera = StMapCamera { map: StMap::new(table), natural_ratio: 1.0 };

    let sky = Image::from_fn(256, 128, |i, j| Rgba::opaque(i as f32 / 256.0, j as f32 / 128.0, 0.5));
    let (world, light) = World::from_panorama(sky)?;
    let target = CameraModel::from(camera).view(width, height)?;
    let picture = Resampler::new(&world, &target).render(light.texels());
    println!("the middle sees {:?}", picture.get(width / 2, height / 2));
    Ok(())
}
