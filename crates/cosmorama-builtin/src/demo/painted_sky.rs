use cosmorama::sphere::Direction;
use glam::{DVec2, DVec3};

use super::noise::{noise, octaves};
use crate::Radiance;

/// A sky as a painter of posters has it: flat bands of colour, a great sun with rays, and clouds of two tones.
#[derive(Clone, Copy, Debug, Default)]
pub struct PaintedSky;

/// Direction of the sun, a unit vector: 38° right of the front, 14° high.
const SUN: DVec3 = DVec3::new(0.597_373_728, 0.241_921_896, -0.764_605_181);

/// Angular radius of the sun, of the ring around it, and reach of the rays, in radians.
const DISC: f64 = 0.11;
const RING: f64 = 0.15;
const RAYS: f64 = 1.3;

/// Bands of the sky, from the horizon up.
const BANDS: [DVec3; 6] = [
    DVec3::new(0.98, 0.62, 0.22),
    DVec3::new(0.91, 0.38, 0.16),
    DVec3::new(0.66, 0.17, 0.17),
    DVec3::new(0.33, 0.09, 0.22),
    DVec3::new(0.13, 0.06, 0.22),
    DVec3::new(0.04, 0.05, 0.17),
];
const SUNLIT: DVec3 = DVec3::new(1.0, 0.87, 0.50);
const CLOUD: DVec3 = DVec3::new(0.95, 0.66, 0.42);
const SHADE: DVec3 = DVec3::new(0.60, 0.22, 0.22);

impl Radiance for PaintedSky {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        let towards = direction.vector();
        // Strokes of a brush, along the horizon.
        let stroke = DVec2::new(4.0 * towards.x.atan2(-towards.z), 60.0 * towards.y);
        (paint(towards) * (0.92 + 0.16 * noise(stroke))).as_vec3().to_array()
    }
}

fn paint(towards: DVec3) -> DVec3 {
    let from_sun = towards.dot(SUN).clamp(-1.0, 1.0).acos();
    if from_sun < DISC {
        return SUNLIT;
    }
    let ceiling = DVec2::new(towards.x, towards.z) / (towards.y.max(0.0) + 0.25);
    let thickness = octaves(ceiling * DVec2::new(1.1, 2.4) + DVec2::new(2.9, 8.3), 4) - 0.1 * (1.0 - towards.y);
    if thickness > 0.5 {
        return if thickness > 0.57 { SHADE } else { CLOUD };
    }
    let wave = 0.5 * noise(ceiling * 1.7) - 0.25;
    let level = (BANDS.len() as f64 * towards.y.max(0.0).sqrt() + wave) as usize;
    let band = BANDS[level.min(BANDS.len() - 1)];
    let is_lit = from_sun < RING || (from_sun < RAYS && is_ray(towards));
    if is_lit { band.lerp(SUNLIT, 0.35 * (1.0 - from_sun / RAYS)) } else { band }
}

/// Returns whether a direction lies on one of the sun's rays, 20 around it.
fn is_ray(towards: DVec3) -> bool {
    let right = SUN.cross(DVec3::Y).normalize();
    let up = right.cross(SUN);
    let turn = towards.dot(up).atan2(towards.dot(right));
    (10.0 * turn / std::f64::consts::PI).rem_euclid(1.0) < 0.5
}
