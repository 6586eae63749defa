use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::demo::hall;
use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};

/// The barrel vault: an iron lattice without glass on the beams, and a fan of bars across each of its ends.
pub(in crate::demo) struct Vault;

const IRON: DVec3 = DVec3::new(0.12, 0.23, 0.20);
const GILT: DVec3 = DVec3::new(0.72, 0.50, 0.18);

impl Part for Vault {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        // Nothing of it is lower than its springing.
        if ray.origin.y < hall::SPRINGING && ray.direction.y <= 0.0 {
            return None;
        }
        let ends = [hall::FRONT, hall::BACK].into_iter().fold(None, |nearest, z| nearer(nearest, fan(ray, z)));
        nearer(shell(ray), ends)
    }
}

/// Returns the nearest bar that the ray hits, at the one or two places where it pierces the half cylinder.
fn shell(ray: &Ray) -> Option<Hit> {
    let from_axis = DVec2::new(ray.origin.x, ray.origin.y - hall::SPRINGING);
    let across = DVec2::new(ray.direction.x, ray.direction.y);
    let a = across.length_squared().max(1e-24);
    let half_b = from_axis.dot(across);
    let discriminant = half_b * half_b - a * (from_axis.length_squared() - hall::HALF_WIDTH * hall::HALF_WIDTH);
    if discriminant <= 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    [(-half_b - root) / a, (-half_b + root) / a].into_iter().find_map(|distance| pierced(ray, distance))
}

fn pierced(ray: &Ray, distance: f64) -> Option<Hit> {
    let point = ray.at(distance);
    if !ray.reaches(distance) || point.y < hall::SPRINGING || point.z < hall::FRONT || point.z > hall::BACK {
        return None;
    }
    let outward = DVec3::new(point.x, point.y - hall::SPRINGING, 0.0) / hall::HALF_WIDTH;
    // Round the vault from right to left, in metres.
    let arc = outward.y.atan2(outward.x) * hall::HALF_WIDTH;
    let (colour, lean) = bar(arc, point.z)?;
    // Flat iron would shade flatly: lean the normal over the bar's width as if it were round.
    let around = DVec3::new(-outward.y, outward.x, 0.0);
    let normal = (outward + around * lean.x + DVec3::Z * lean.y).normalize();
    let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
    Some(Hit { distance, normal, surface: Surface::matte(colour) })
}

/// Returns the bar at a point of the unrolled vault: its colour, and the position across its width (along the arc and
/// along z, up to ±1).
fn bar(arc: f64, z: f64) -> Option<(DVec3, DVec2)> {
    let length = PI * hall::HALF_WIDTH;
    let across_arch = stripe(z - hall::FIRST_COLUMN, hall::BAY, 0.26);
    if let Some(at) = across_arch {
        return Some((if at.abs() > 0.72 { GILT } else { IRON }, DVec2::new(0.0, at)));
    }
    if let Some(at) = stripe(arc, length / 12.0, 0.11) {
        return Some((IRON, DVec2::new(at, 0.0)));
    }
    if let Some(at) = stripe(z, 1.0, 0.06) {
        return Some((IRON, DVec2::new(0.0, at)));
    }
    let pitch = length / 24.0;
    stripe(arc + z * (pitch / 0.5), 2.0 * pitch, 0.05)
        .or_else(|| stripe(arc - z * (pitch / 0.5), 2.0 * pitch, 0.05))
        .map(|at| (IRON, DVec2::splat(0.5 * at)))
}

/// Returns the hit with a fan of spokes and rings in the half disc at an end of the vault.
fn fan(ray: &Ray, z: f64) -> Option<Hit> {
    let distance = (z - ray.origin.z) / ray.direction.z;
    if !ray.reaches(distance) {
        return None;
    }
    let point = ray.at(distance);
    let spot = DVec2::new(point.x, point.y - hall::SPRINGING);
    let radius = spot.length();
    if spot.y < 0.0 || radius > hall::HALF_WIDTH {
        return None;
    }
    let colour = fan_bar(spot, radius)?;
    Some(Hit { distance, normal: DVec3::Z * -ray.direction.z.signum(), surface: Surface::matte(colour) })
}

fn fan_bar(spot: DVec2, radius: f64) -> Option<DVec3> {
    if radius < 0.5 || (radius - 1.6).abs() < 0.04 {
        return Some(GILT);
    }
    let ring = spot.y < 0.1 || radius > 3.8 || (radius - 2.8).abs() < 0.04;
    let spokes = if radius > 1.6 { 24.0 } else { 12.0 };
    let spoke = spot.y.atan2(spot.x) * spokes / PI;
    let aside = (spoke - spoke.round()).abs() * PI / spokes * radius;
    (ring || aside < 0.03).then_some(IRON)
}

/// Returns the position across a stripe, −1 to 1, for stripes centred on multiples of a period; `None` between them.
fn stripe(position: f64, period: f64, width: f64) -> Option<f64> {
    let aside = position - (position / period).round() * period;
    (aside.abs() < width / 2.0).then(|| aside * 2.0 / width)
}
