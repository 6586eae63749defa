//! Glass: a beam that is split at each surface into a reflected and a refracted part.

use super::Beam;
use crate::material::{Glass, Refraction};
use crate::ray::{Normal, Ray};
use crate::shape::Solid;

/// Returns the part of unpolarised light that a smooth surface of an insulator reflects (Fresnel).
///
/// `incident` is the cosine before the surface, `ratio` the index before it over that behind.
fn fresnel(incident: f64, ratio: f64) -> f64 {
    let square = 1.0 - ratio * ratio * (1.0 - incident * incident);
    if square <= 0.0 {
        return 1.0;
    }
    let transmitted = square.sqrt();
    let parallel = (incident - ratio * transmitted) / (incident + ratio * transmitted);
    let perpendicular = (ratio * incident - transmitted) / (ratio * incident + transmitted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Adds what a beam that meets glass from outside sees of the world, as parts of one.
///
/// Of the light that is still inside after the last surface nothing is lost: all that can leaves there.
pub(super) fn split(beams: &mut Vec<Beam>, outside: (&Ray, &Normal), solid: &dyn Solid, glass: &Glass) {
    let tracer = |index: f64| Tracer { solid, glass, index };
    if glass.index.iter().all(|index| *index == glass.index[0]) {
        return tracer(glass.index[0]).trace(beams, outside, [1.0; 3]);
    }
    for channel in 0..3 {
        let part = std::array::from_fn(|k| if k == channel { 1.0 } else { 0.0 });
        tracer(glass.index[channel]).trace(beams, outside, part);
    }
}

/// Follower of the light of some colours, all of one index.
struct Tracer<'a> {
    solid: &'a dyn Solid,
    glass: &'a Glass,
    index: f64,
}

/// Light on its way from one surface to the next.
struct Path {
    weight: [f64; 3],
    ray: Ray,
    /// Surfaces that it has met.
    met: usize,
    is_inside: bool,
}

impl Tracer<'_> {
    fn trace(&self, beams: &mut Vec<Beam>, (met, outward): (&Ray, &Normal), weight: [f64; 3]) {
        let normal = outward.facing(met);
        let reflected = fresnel(-met.direction.dot(normal.unit), 1.0 / self.index);
        let path = |part: f64, ray: Ray, is_inside: bool| Path {
            weight: weight.map(|weight| weight * part),
            ray,
            met: 1,
            is_inside,
        };
        let mut paths = Vec::new();
        if let Some(ray) = met.refracted(&normal, 1.0 / self.index) {
            paths.push(path(1.0 - reflected, ray, true));
        }
        paths.push(path(reflected, met.reflected(&normal), false));
        if self.glass.refraction == Refraction::Bent {
            return beams.extend(paths.into_iter().map(|Path { weight, ray, .. }| Beam { weight, ray }));
        }
        while let Some(path) = paths.pop() {
            self.follow(path, beams, &mut paths);
        }
    }

    /// Follows light to the next surface, and splits it there; what meets none sees the world.
    fn follow(&self, path: Path, beams: &mut Vec<Beam>, paths: &mut Vec<Path>) {
        let Path { mut weight, ray, met, is_inside } = path;
        // The last surface is one by which light leaves.
        let may_enter = met + 1 < self.glass.surfaces && weight.iter().any(|weight| *weight >= self.glass.least);
        let wall = match is_inside {
            true => self.solid.next(&ray),
            false if may_enter => self.solid.again(&ray),
            false => None,
        };
        let Some(wall) = wall else { return beams.push(Beam { weight, ray }) };
        if is_inside {
            for (weight, absorption) in weight.iter_mut().zip(self.glass.absorption) {
                *weight *= (-absorption * wall.distance).exp();
            }
        }
        let normal = wall.normal.facing(&wall.met);
        let ratio = if is_inside { self.index } else { 1.0 / self.index };
        let back = fresnel(-wall.met.direction.dot(normal.unit), ratio);
        let met = met + 1;
        let is_last = met >= self.glass.surfaces || weight.iter().all(|weight| weight * back < self.glass.least);
        let kept = if is_last { 0.0 } else { back };
        let part = |part: f64, ray: Ray, is_inside: bool| Path {
            weight: weight.map(|weight| weight * part),
            ray,
            met,
            is_inside,
        };
        match wall.met.refracted(&normal, ratio) {
            Some(ray) => paths.push(part(1.0 - kept, ray, !is_inside)),
            // All is reflected, for ever in a ball: the world is seen as through the surface.
            None if is_last => beams.push(Beam { weight, ray: wall.met }),
            None => {}
        }
        if !is_last {
            paths.push(part(back, wall.met.reflected(&normal), is_inside));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fresnel_is_that_of_textbooks() {
        // Straight on, ((n − 1)/(n + 1))² of both sides; grazing, all; at Brewster's angle, one polarisation is gone.
        for ratio in [1.0 / 1.5, 1.5] {
            assert!((fresnel(1.0, ratio) - 0.04).abs() < 1e-12);
        }
        assert!((fresnel(0.0, 1.0 / 1.5) - 1.0).abs() < 1e-12);
        assert_eq!(fresnel(0.7, 1.5), 1.0);
        let brewster = 1.5f64.atan().cos();
        let parallel_gone = 0.5 * ((1.0 - 1.5 * 1.5) / (1.0 + 1.5f64 * 1.5)).powi(2);
        assert!((fresnel(brewster, 1.0 / 1.5) - parallel_gone).abs() < 1e-12);
    }
}
