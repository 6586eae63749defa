use glam::{DVec2, DVec3};

use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};
use crate::demo::solid::{Ball, Cuboid, Drum};

/// A striped balloon with its car, over the country to the front right.
pub(in crate::demo) struct Balloon;

const ENVELOPE: Ball = Ball { centre: DVec3::new(49.0, 27.0, -45.0), radius: 8.5 };
/// Number of gores in the envelope.
const GORES: f64 = 16.0;
const CAR: Cuboid = Cuboid { least: DVec3::new(47.6, 10.6, -46.4), greatest: DVec3::new(50.4, 12.4, -43.6) };
/// Bounding box, for the many rays that miss it.
const BOUNDS: Cuboid = Cuboid { least: DVec3::new(40.0, 10.0, -54.0), greatest: DVec3::new(58.0, 36.0, -36.0) };
const ROPE_SPREAD: f64 = 1.25;

impl Part for Balloon {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        BOUNDS.inside(ray)?;
        let envelope = ENVELOPE.entry(ray).map(|(distance, normal)| Hit { distance, normal, surface: cloth(normal) });
        let wicker = Surface::matte(DVec3::new(0.34, 0.20, 0.09));
        let car = CAR.entry(ray).map(|(distance, normal)| Hit { distance, normal, surface: wicker });
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].into_iter().fold(
            nearer(envelope, car),
            |nearest, (x, z)| {
                let axis = DVec2::new(ENVELOPE.centre.x + x * ROPE_SPREAD, ENVELOPE.centre.z + z * ROPE_SPREAD);
                let rope = Drum { axis, radius: 0.06, bottom: CAR.greatest.y, top: ENVELOPE.centre.y };
                nearer(nearest, rope.entry(ray).map(|(distance, normal)| Hit { distance, normal, surface: wicker }))
            },
        )
    }
}

/// Paints red and cream gores, with a blue band and gilt edges round the middle.
fn cloth(normal: DVec3) -> Surface {
    let band = (normal.y + 0.12).abs();
    if band < 0.13 {
        return Surface::matte(if band > 0.10 { DVec3::new(0.75, 0.52, 0.15) } else { DVec3::new(0.06, 0.12, 0.34) });
    }
    let gore = (normal.z.atan2(normal.x) * GORES / std::f64::consts::TAU).floor();
    let even = gore.rem_euclid(2.0) < 0.5;
    Surface::matte(if even { DVec3::new(0.66, 0.09, 0.06) } else { DVec3::new(0.80, 0.72, 0.55) })
}
