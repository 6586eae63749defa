//! How far are two pictures apart, in decibels and in fractions of a pixel?
//!
//! `cargo run -p cosmorama-io --example compare -- a.png b.png`; without arguments it compares a filter with no filter.
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;
use std::path::Path;

use cosmorama::compare::{Mask, compare};
use cosmorama::prelude::*;
use cosmorama_io::{Limits, read};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let [first, second] = match (arguments.next(), arguments.next()) {
        (Some(first), Some(second)) => {
            let light = |path: String| read(Path::new(&path), &Limits::default()).map(|file| file.to_light());
            [light(first)?, light(second)?]
        }
        _ => by_two_filters()?,
    };
    let found = compare(&first, &second, &Mask::everything(first.width(), first.height()))?;
    println!("{found:?}");
    Ok(())
}

/// Makes one view of a checkered sky by EWA and by point sampling.
fn by_two_filters() -> Result<[Image<Rgba>; 2], Box<dyn Error>> {
    let sky =
        Image::from_fn(
            512,
            256,
            |i, j| if (i / 3 + j / 3) % 2 == 0 { Rgba::BLACK } else { Rgba::opaque(1.0, 1.0, 1.0) },
        );
    let (world, light) = World::from_panorama(sky)?;
    let target =
        CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(80.0)))).view(64, 48)?;
    let ewa = Resampler::new(&world, &target);
    let point = ewa.by(FilterSettings { kind: FilterKind::Point, ..FilterSettings::DEFAULT });
    Ok([ewa.render(light.texels()), point.render(light.texels())])
}
