use glam::{DVec2, DVec3, DVec4};

use super::super::Chart;
use crate::ray::Normal;

/// Texture coordinates at the corners of a triangle, and tangents if the file has them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    pub(super) uvs: [DVec2; 3],
    /// Unit vectors along u; w is the side of the bitangent.
    pub(super) tangents: Option<[DVec4; 3]>,
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
    /// Returns the texture coordinates at a place of a triangle with these sides and this normal.
    pub(super) fn chart(&self, place: &Place, sides: [DVec3; 2], normal: DVec3) -> Chart {
        let steps = [self.uvs[1] - self.uvs[0], self.uvs[2] - self.uvs[0]];
        let between = |[v, w]: [f64; 2]| steps[0] * v + steps[1] * w;
        let (along, side) = match self.tangents {
            Some([a, b, c]) => {
                let [v, w] = place.weights;
                let sum = a * (1.0 - v - w) + b * v + c * w;
                (sum.truncate(), sum.w)
            }
            None => along(sides, steps, normal),
        };
        let tangent = (along - normal * normal.dot(along)).try_normalize();
        let tangent = tangent.unwrap_or_else(|| normal.any_orthonormal_vector());
        let bitangent = normal.cross(tangent) * side.signum();
        let [dx, dy] = place.turns.map(between);
        Chart { at: self.uvs[0] + between(place.weights), dx, dy, nearing: place.nearing, tangent, bitangent }
    }
}

/// Returns the vector on a triangle along u, and the side of the bitangent, which points against v.
fn along(sides: [DVec3; 2], steps: [DVec2; 2], normal: DVec3) -> (DVec3, f64) {
    // With the sign of the determinant, which a division by it would have.
    let sign = steps[0].perp_dot(steps[1]).signum();
    let along = (sides[0] * steps[1].y - sides[1] * steps[0].y) * sign;
    let down = (sides[1] * steps[0].x - sides[0] * steps[1].x) * sign;
    (along, -normal.cross(along).dot(down))
}
