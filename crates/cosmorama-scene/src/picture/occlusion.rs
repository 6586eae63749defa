//! The part of the light on a place that things do not hide.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::ray::{Ray, RayChange};
use crate::scene::Scene;
use crate::shape::Wall;

/// Rays for each place, and the turn from each to the next, the golden angle: together they fill a disc evenly (H. Vogel, *A
/// better way to construct the sunflower head*, 1979).
const RAYS: usize = 64;
const TURN: f64 = 2.399_963_229_728_653;

/// Factors on places by whose fractional parts the rays of neighbours differ: powers of 1/x with x⁴ = x + 1, which fill cubes
/// evenly (M. Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018).
const STEPS: [DVec3; 2] = [
    DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3),
    DVec3::new(0.671_043_606_703_789_2, 0.549_700_477_901_970_3, 0.819_172_513_396_164_4),
];

/// Finest difference of places, as a part of a thing's radius, that has other rays.
const GRAIN: f64 = 1e-3;

/// Returns the finest difference of places in a scene that has other rays.
pub(super) fn grain(scene: &Scene) -> f64 {
    GRAIN * scene.objects.iter().map(|object| object.shape.ball().radius).fold(f64::INFINITY, f64::min)
}

/// Returns the part of the light from all sides, weighed by the cosine, that reaches a place: 1 if no thing hides any.
///
/// The rays of a place are those of its coordinates, by the scene's grain, so that pictures do not depend on threads.
pub(super) fn openness(scene: &Scene, wall: &Wall, grain: f64) -> f64 {
    // On the side that is seen, even where smooth normals lean away from the eye.
    let normal = wall.normal.unit;
    let (right, up) = normal.any_orthonormal_pair();
    let place = (wall.met.origin / grain).floor();
    let [around, outward] = STEPS.map(|step| place.dot(step).rem_euclid(1.0));
    let is_open = |k: usize| {
        // Equal parts of the disc under the hemisphere are equal parts of the light (Malley's method).
        let radius = ((k as f64 + outward) / RAYS as f64).sqrt();
        let (y, x) = (TURN * k as f64 + TAU * around).sin_cos();
        let direction = (right * x + up * y) * radius + normal * (1.0 - radius * radius).max(0.0).sqrt();
        !is_hidden(scene, wall.met.origin, direction)
    };
    (0..RAYS).filter(|k| is_open(*k)).count() as f64 / RAYS as f64
}

/// Returns whether something is met on the way from a place.
fn is_hidden(scene: &Scene, origin: DVec3, direction: DVec3) -> bool {
    let still = RayChange { origin: DVec3::ZERO, direction: DVec3::ZERO };
    let ray = Ray { origin, direction, dx: still, dy: still };
    scene.objects.iter().any(|object| object.shape.is_met(&ray))
}
