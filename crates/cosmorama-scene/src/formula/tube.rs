use std::f64::consts::TAU;

use glam::DVec3;

use crate::shape::Face;

/// A cross-section of a tube: an ellipse around a point of its axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    pub(super) at: DVec3,
    /// Half of its extent sideways, and upward.
    pub(super) radii: [f64; 2],
}

/// Smooth skin around an axis, closed at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tube<'a> {
    /// Rings that the skin goes through, at equal steps of its length from 0 to 1; at least two.
    pub(super) rings: &'a [Ring],
    /// A direction that the axis is never along: the tube's upper side.
    pub(super) up: DVec3,
    /// Number of steps along it, and around.
    pub(super) steps: [usize; 2],
}

impl Ring {
    /// Returns a ring that is round.
    pub(super) fn round(at: DVec3, radius: f64) -> Self {
        Self { at, radii: [radius; 2] }
    }
}

impl Tube<'_> {
    /// Lists its triangles, as a part of an object. `swelling` is added to the radii, as a part of them, by the place
    /// along the tube and the turn around it, which is a quarter at the upper side.
    pub(super) fn faces(&self, part: usize, swelling: impl Fn(f64, f64) -> f64) -> Vec<Face> {
        let [along, around] = self.steps;
        let point = |i: usize, k: usize| self.point(i, (k % around) as f64 / around as f64, &swelling);
        let points: Vec<Vec<DVec3>> = (0..=along).map(|i| (0..=around).map(|k| point(i, k)).collect()).collect();
        let squares = (0..along).flat_map(|i| (0..around).map(move |k| (i, k)));
        let triangles = squares.flat_map(|(i, k)| {
            let [a, b] = [points[i][k], points[i][k + 1]];
            let [c, d] = [points[i + 1][k + 1], points[i + 1][k]];
            [[a, b, c], [a, c, d]]
        });
        let face = |corners| Face { corners, normals: None, uvs: None, tangents: None, part };
        triangles.map(face).collect()
    }

    fn point(&self, i: usize, turn: f64, swelling: &impl Fn(f64, f64) -> f64) -> DVec3 {
        let place = i as f64 / self.steps[0] as f64;
        let Ring { at, radii } = self.ring(place);
        if i == 0 || i == self.steps[0] {
            return at;
        }
        const STEP: f64 = 1e-3;
        let ahead = self.ring((place + STEP).min(1.0)).at - self.ring((place - STEP).max(0.0)).at;
        let right = self.up.cross(ahead).normalize_or_zero();
        let up = ahead.cross(right).normalize_or_zero();
        let (upward, sideways) = (TAU * turn).sin_cos();
        at + (right * (sideways * radii[0]) + up * (upward * radii[1])) * (1.0 + swelling(place, turn))
    }

    /// Returns the cross-section at a place from 0 to 1: a curve through the rings (E. Catmull and R. Rom, 1974).
    pub(super) fn ring(&self, place: f64) -> Ring {
        let last = self.rings.len() - 1;
        let place = place * last as f64;
        let first = (place as usize).min(last - 1);
        let t = place - first as f64;
        let ring = |offset: usize| self.rings[(first + offset).saturating_sub(1).min(last)];
        let weights = [
            t * (-0.5 + t * (1.0 - 0.5 * t)),
            1.0 + t * t * (-2.5 + 1.5 * t),
            t * (0.5 + t * (2.0 - 1.5 * t)),
            t * t * (-0.5 + 0.5 * t),
        ];
        let mut sum = Ring { at: DVec3::ZERO, radii: [0.0; 2] };
        for (offset, weight) in weights.into_iter().enumerate() {
            let Ring { at, radii } = ring(offset);
            sum.at += at * weight;
            (0..2).for_each(|axis| sum.radii[axis] += radii[axis] * weight);
        }
        Ring { radii: sum.radii.map(|radius| radius.max(0.0)), ..sum }
    }
}
