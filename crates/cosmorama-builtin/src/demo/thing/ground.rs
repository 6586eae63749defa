use std::f64::consts::FRAC_PI_4;

use glam::{DVec2, DVec3};

use crate::demo::hall;
use crate::demo::noise::noise;
use crate::demo::ray::{Hit, Part, Ray, Surface};

/// The floor, which extends to the horizon: polished marble in the arcade, paving outside, and a compass rose under the
/// viewer.
pub(in crate::demo) struct Ground;

const IVORY: DVec3 = DVec3::new(0.78, 0.72, 0.62);
const OXBLOOD: DVec3 = DVec3::new(0.22, 0.07, 0.05);
const SLATE: DVec3 = DVec3::new(0.10, 0.11, 0.13);
const BRASS: DVec3 = DVec3::new(0.62, 0.43, 0.14);

impl Part for Ground {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        if ray.direction.y >= 0.0 {
            return None;
        }
        let distance = -ray.origin.y / ray.direction.y;
        if !ray.reaches(distance) {
            return None;
        }
        let point = ray.at(distance);
        Some(Hit { distance, normal: DVec3::Y, surface: surface(DVec2::new(point.x, point.z)) })
    }
}

fn surface(point: DVec2) -> Surface {
    let radius = point.length();
    if radius < ROSE {
        return Surface { mirror: 0.05, ..Surface::matte(rose(point, radius)) };
    }
    let indoors = point.x.abs() < hall::HALF_WIDTH + 0.8 && point.y > hall::FRONT - 1.0 && point.y < hall::BACK + 1.0;
    if indoors { marble(point) } else { Surface::matte(paving(point)) }
}

/// Checkers of a metre, bordered along the columns by a brass line and a dark band.
fn marble(point: DVec2) -> Surface {
    let across = point.x.abs();
    let colour = if across > 3.06 {
        SLATE
    } else if across > 3.0 {
        BRASS
    } else {
        let tile = if is_even(point) { IVORY } else { OXBLOOD };
        tile * (0.8 + 0.3 * noise(point * DVec2::new(5.0, 2.0) + DVec2::splat(noise(point * 2.0) * 4.0)))
    };
    Surface { mirror: 0.07, ..Surface::matte(colour) }
}

/// Checkers of two metres, with a dark joint round each slab.
fn paving(point: DVec2) -> DVec3 {
    let slab = point / 2.0;
    let to_joint = (slab - slab.round()).abs().min_element();
    if to_joint < 0.012 {
        return DVec3::new(0.12, 0.11, 0.08);
    }
    if is_even(slab) { DVec3::new(0.58, 0.50, 0.38) } else { DVec3::new(0.25, 0.26, 0.18) }
}

fn is_even(point: DVec2) -> bool {
    (point.x.floor() + point.y.floor()).rem_euclid(2.0) < 0.5
}

/// Radius of the compass rose.
const ROSE: f64 = 1.55;

/// Paints a star of eight points, each half light and half dark, in brass rings.
fn rose(point: DVec2, radius: f64) -> DVec3 {
    if radius > ROSE - 0.06 || (radius - 0.55).abs() < 0.012 || (radius - 1.30).abs() < 0.008 {
        return BRASS;
    }
    // In eighths of a turn from the front, clockwise.
    let eighths = point.x.atan2(-point.y) / FRAC_PI_4;
    let point_of_star = eighths.round();
    let aside = eighths - point_of_star;
    let tip = if point_of_star.rem_euclid(2.0) < 0.5 { 1.42 } else { 0.95 };
    // The star's edge, straight from the tip to the notch between two points.
    let (notch, half_turn) = (0.38, FRAC_PI_4 / 2.0);
    let angle = aside.abs() * FRAC_PI_4;
    let edge = tip * notch * half_turn.sin() / (tip * angle.sin() + notch * (half_turn - angle).sin());
    if radius > edge {
        return if radius > 1.30 { SLATE } else { IVORY };
    }
    if aside > 0.0 { OXBLOOD } else { DVec3::new(0.66, 0.52, 0.34) }
}
