use cosmorama::camera::Footprint;
use cosmorama::sphere::{Angle, Direction};

use crate::compass::Compass;
use crate::pixel_window::{part_within, spread};
use crate::{Average, Radiance};

/// Black and white checks of 10° of azimuth by 10° of elevation. Half of every part of the sphere is white.
#[derive(Clone, Copy, Debug, Default)]
pub struct Checker;

/// Side of a check.
const CHECK: Angle = Angle::from_degrees(10.0);

/// Last edge before the pole, in checks from the horizon; the checks beyond the pole have the same colours.
const LAST_EDGE: f64 = 8.0;

/// Blur, in checks, above which a pixel may see more than one edge.
const COARSE: f64 = 0.1;

impl Radiance for Checker {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        let Compass { azimuth, elevation, .. } = Compass::of(direction);
        [if is_even(azimuth) == is_even(elevation) { 1.0 } else { 0.0 }; 3]
    }

    fn average(&self, pixel: &Footprint) -> Average {
        white_part(pixel).map_or(Average::Intricate, |white| Average::Known([white as f32; 3]))
    }
}

/// Returns the white fraction of a pixel that contains at most one edge; `None` for others.
fn white_part(pixel: &Footprint) -> Option<f64> {
    let compass = Compass::of(pixel.direction);
    let along_azimuth = even_part(compass.azimuth, f64::INFINITY, spread(pixel, compass.azimuth_gradient()?))?;
    let along_elevation = even_part(compass.elevation, LAST_EDGE, spread(pixel, compass.elevation_gradient()?))?;
    // Where two edges cross, how much they have in common matters.
    let is_edge = |part: f64| part > 0.0 && part < 1.0;
    let white = along_azimuth * along_elevation + (1.0 - along_azimuth) * (1.0 - along_elevation);
    (!(is_edge(along_azimuth) && is_edge(along_elevation))).then_some(white)
}

fn is_even(angle: Angle) -> bool {
    (angle.radians() / CHECK.radians()).floor().rem_euclid(2.0) == 0.0
}

/// Returns the fraction of a window that even stripes cover; `None` if it contains more than one edge.
fn even_part(angle: Angle, last_edge: f64, spread: f64) -> Option<f64> {
    let (stripes, spread) = (angle.radians() / CHECK.radians(), spread / CHECK.radians());
    if spread > COARSE {
        return None;
    }
    // The nearest edge is the lower one of the stripe that begins there.
    let edge = stripes.round().clamp(-last_edge, last_edge);
    let above = part_within(stripes - edge, spread);
    Some(if edge.rem_euclid(2.0) == 0.0 { above } else { 1.0 - above })
}
