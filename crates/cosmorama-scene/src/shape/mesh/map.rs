use glam::{DVec2, DVec3, DVec4};

use super::super::Chart;
use crate::ray::Normal;

/// Texture coordinates and tangents at the corners of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    pub(super) uvs: [DVec2; 3],
    /// Unit vectors along u; w is the side of the bitangent.
    pub(super) tangents: [DVec4; 3],
}

/// A place in a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Weights of the second and the third corner.
    pub(super) weights: [f64; 2],
    /// Their changes for one pixel to the right, and down.
    pub(super) turns: [[f64; 2]; 2],
    /// Change of nearness for one pixel to the right and down, as a part of it.
    pub(super) nearing: DVec2,
}

impl Place {
    /// Returns the unit normal between those of the corners, with its changes.
    pub(super) fn normal(&self, normals: &[DVec3; 3]) -> Normal {
        let sides = [normals[1] - normals[0], normals[2] - normals[0]];
        let between = |[v, w]: [f64; 2]| sides[0] * v + sides[1] * w;
        let sum = normals[0] + between(self.weights);
        let length = sum.length();
        let unit = sum / length;
        let [dx, dy] = self.turns.map(between).map(|change| (change - unit * unit.dot(change)) / length);
        Normal { unit, dx, dy }
    }
}

impl Map {
    /// Returns the texture coordinates at a place of a triangle, about a normal.
    pub(super) fn chart(&self, place: &Place, normal: DVec3) -> Chart {
        let steps = [self.uvs[1] - self.uvs[0], self.uvs[2] - self.uvs[0]];
        let between = |[v, w]: [f64; 2]| steps[0] * v + steps[1] * w;
        let ([a, b, c], [v, w]) = (self.tangents, place.weights);
        let sum = a * (1.0 - v - w) + b * v + c * w;
        let along = sum.truncate();
        let tangent = (along - normal * normal.dot(along)).try_normalize();
        let tangent = tangent.unwrap_or_else(|| normal.any_orthonormal_vector());
        let bitangent = normal.cross(tangent) * sum.w.signum();
        let [dx, dy] = place.turns.map(between);
        Chart { at: self.uvs[0] + between(place.weights), dx, dy, nearing: place.nearing, tangent, bitangent }
    }
}
