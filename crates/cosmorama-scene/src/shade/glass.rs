//! Glass: a beam that is split at each surface into a reflected and a refracted part.

use super::Beam;
use crate::camera::{Normal, Ray};
use crate::material::{Glass, Refraction};
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
    if glass.index.iter().all(|index| *index == glass.index[0]) {
        return trace(beams, outside, solid, glass, (glass.index[0], [1.0; 3]));
    }
    for channel in 0..3 {
        let part = std::array::from_fn(|k| if k == channel { 1.0 } else { 0.0 });
        trace(beams, outside, solid, glass, (glass.index[channel], part));
    }
}

/// Follows the light of some colours, all of one index.
fn trace(
    beams: &mut Vec<Beam>,
    (met, outward): (&Ray, &Normal),
    solid: &dyn Solid,
    glass: &Glass,
    (index, colours): (f64, [f64; 3]),
) {
    let normal = outward.facing(met);
    let reflected = fresnel(-met.direction.dot(normal.unit), 1.0 / index);
    let part = |weight: [f64; 3], part: f64| weight.map(|weight| weight * part);
    beams.push(Beam { weight: part(colours, reflected), ray: met.reflected(&normal) });
    let Some(mut ray) = met.refracted(&normal, 1.0 / index) else { return };
    let mut weight = part(colours, 1.0 - reflected);
    if glass.refraction == Refraction::Bent {
        beams.push(Beam { weight, ray });
        return;
    }
    for surface in 2..=glass.surfaces.max(2) {
        let Some(wall) = solid.next(&ray) else { return };
        for (weight, absorption) in weight.iter_mut().zip(glass.absorption) {
            *weight *= (-absorption * wall.distance).exp();
        }
        let normal = wall.normal.facing(&wall.met);
        let inside = fresnel(-wall.met.direction.dot(normal.unit), index);
        let is_last = surface >= glass.surfaces || weight.iter().all(|weight| weight * inside < glass.least);
        let kept = if is_last { 0.0 } else { inside };
        match wall.met.refracted(&normal, index) {
            Some(out) => beams.push(Beam { weight: part(weight, 1.0 - kept), ray: out }),
            // All is reflected, for ever in a ball: the world is seen as through the surface.
            None if is_last => beams.push(Beam { weight, ray: wall.met }),
            None => {}
        }
        if is_last {
            return;
        }
        weight = part(weight, inside);
        ray = wall.met.reflected(&normal);
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
