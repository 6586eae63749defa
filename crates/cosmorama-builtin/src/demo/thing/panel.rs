use glam::{DVec2, DVec3};

use crate::demo::hall;
use crate::demo::lettering::{self, Line};
use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};
use crate::demo::solid::{Cuboid, Drum};

/// The notice that hangs from the vault ahead of the viewer, lit like a lantern from within.
pub(in crate::demo) struct Panel;

const PLANE: f64 = -7.6;
const MIDDLE: DVec2 = DVec2::new(0.0, 3.55);
/// Half the panel's width and half its height.
const HALF: DVec2 = DVec2::new(2.45, 1.15);
/// Bounding box of the board and its hangers, for the many rays that miss them.
const BOUNDS: Cuboid = Cuboid {
    least: DVec3::new(-HALF.x, MIDDLE.y - HALF.y, PLANE - 0.02),
    greatest: DVec3::new(HALF.x, hall::SPRINGING + hall::HALF_WIDTH, PLANE + 0.02),
};
const HANGERS: [f64; 2] = [-1.9, 1.9];

/// Lines of text, placed from the panel's middle.
const LINES: [Line; 6] = [
    Line { text: "COSMORAMA", middle: DVec2::new(0.0, 0.66), height: 0.46 },
    Line { text: "1986", middle: DVec2::new(0.0, 0.20), height: 0.34 },
    Line { text: "THE WORLD SEEN FROM ONE POINT", middle: DVec2::new(0.0, -0.14), height: 0.140 },
    Line {
        text: "Omnimax & other world projections from perspective views",
        middle: DVec2::new(0.0, -0.37),
        height: 0.075,
    },
    Line { text: "front - right - back - left - up - down", middle: DVec2::new(0.0, -0.50), height: 0.060 },
    Line {
        text: "Admission: one ray. Children & shadows free. Please do not alias.",
        middle: DVec2::new(0.0, -0.62),
        height: 0.045,
    },
];

impl Part for Panel {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        BOUNDS.inside(ray)?;
        HANGERS.into_iter().fold(board(ray), |nearest, x| nearer(nearest, hanger(ray, x)))
    }
}

fn board(ray: &Ray) -> Option<Hit> {
    let distance = (PLANE - ray.origin.z) / ray.direction.z;
    if !ray.reaches(distance) {
        return None;
    }
    let point = ray.at(distance);
    let spot = DVec2::new(point.x, point.y) - MIDDLE;
    let to_rim = (HALF - spot.abs()).min_element();
    if to_rim < 0.0 {
        return None;
    }
    let seen_from_front = ray.direction.z < 0.0;
    let surface = if seen_from_front { face(spot, to_rim) } else { Surface::matte(DVec3::new(0.20, 0.12, 0.07)) };
    Some(Hit { distance, normal: DVec3::Z * -ray.direction.z.signum(), surface })
}

/// Returns the surface of the printed side: a gilt frame, a double rule, lines of text, and a chart of ever finer bars.
fn face(spot: DVec2, to_rim: f64) -> Surface {
    const GILT: DVec3 = DVec3::new(0.75, 0.52, 0.20);
    const INK: DVec3 = DVec3::new(0.05, 0.02, 0.02);
    if to_rim < 0.10 {
        let bevel = if to_rim < 0.05 { 0.10 } else { 0.28 };
        return Surface { glow: GILT * bevel, ..Surface::matte(GILT) };
    }
    let rule = (to_rim - 0.145).abs() < 0.010 || (to_rim - 0.170).abs() < 0.004;
    if rule || is_bar(spot) || LINES.iter().any(|line| lettering::covers(line, spot)) {
        return Surface::matte(INK);
    }
    // Brighter in the middle, where the lamp is.
    let lamp = 0.75 - 0.07 * spot.length_squared();
    Surface { albedo: DVec3::new(0.6, 0.55, 0.45), glow: DVec3::new(0.92, 0.72, 0.43) * lamp, mirror: 0.0 }
}

/// Returns whether a point is on an upright bar of the chart; bars become finer to the right.
fn is_bar(spot: DVec2) -> bool {
    if (spot.y + 0.80).abs() > 0.08 || spot.x.abs() > 2.1 {
        return false;
    }
    // A frequency that grows evenly from 5 to 45 bars a metre.
    let along = spot.x + 2.1;
    let phase = 5.0 * along + 0.5 * (40.0 / 4.2) * along * along;
    phase.fract() < 0.5
}

fn hanger(ray: &Ray, x: f64) -> Option<Hit> {
    let rod = Drum { axis: DVec2::new(x, PLANE), radius: 0.018, bottom: MIDDLE.y + HALF.y, top: hall::vault_height(x) };
    let (distance, normal) = rod.entry(ray)?;
    Some(Hit { distance, normal, surface: Surface::matte(DVec3::new(0.10, 0.09, 0.08)) })
}
