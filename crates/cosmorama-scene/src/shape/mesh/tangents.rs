use glam::{DVec2, DVec3, DVec4};

use super::build::{Face, Welded};
use super::map::Map;
use super::normals::angle;

/// Lists the texture coordinates and tangents of all triangles: tangents of the file, or means over the triangles around a point.
///
/// Such a mean is over those that share the texture coordinates, the normal and the side of the bitangent there, each by its angle
/// (M. Mikkelsen, *Simulation of wrinkled surfaces revisited*, 2008). None is listed if no triangle has coordinates.
pub(super) fn maps(faces: &[Face], welded: &Welded, normals: &[[DVec3; 3]]) -> Vec<Option<Map>> {
    if faces.iter().all(|face| face.uvs.is_none()) {
        return Vec::new();
    }
    let mut made: Vec<Option<[DVec4; 3]>> = faces.iter().map(|face| face.uvs.and(face.tangents)).collect();
    let alongs: Vec<(DVec3, f64)> = faces.iter().zip(normals).map(along).collect();
    let key = |index: u32| {
        let (face, corner) = (index as usize / 3, index as usize % 3);
        let uv = faces[face].uvs.map(|uvs| uvs[corner].to_array().map(f64::to_bits));
        let normal = normals[face][corner].to_array().map(f64::to_bits);
        (welded.corners[face][corner], uv, normal, alongs[face].1 > 0.0)
    };
    let is_bare = |index: &u32| {
        let face = &faces[*index as usize / 3];
        face.uvs.is_some() && face.tangents.is_none()
    };
    let mut bare: Vec<u32> = (0..3 * faces.len() as u32).filter(is_bare).collect();
    bare.sort_unstable_by_key(|index| (key(*index), *index));
    for group in bare.chunk_by(|a, b| key(*a) == key(*b)) {
        let part = |index: &u32| {
            alongs[*index as usize / 3].0 * angle(&faces[*index as usize / 3].corners, *index as usize % 3)
        };
        let mean = group.iter().map(part).sum::<DVec3>().normalize_or_zero();
        for index in group {
            let face = *index as usize / 3;
            made[face].get_or_insert_default()[*index as usize % 3] = mean.extend(alongs[face].1);
        }
    }
    faces.iter().zip(made).map(|(face, tangents)| Some(Map { uvs: face.uvs?, tangents: tangents? })).collect()
}

/// Returns the unit vector on a triangle along u, and the side of the bitangent, which points against v: 1 or −1. The vector is
/// zero where u does not change.
fn along((face, normals): (&Face, &[DVec3; 3])) -> (DVec3, f64) {
    let Some([a, b, c]) = face.uvs else { return (DVec3::ZERO, 1.0) };
    let sides = [face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]];
    let steps: [DVec2; 2] = [b - a, c - a];
    // With the sign of the determinant, which a division by it would have.
    let sign = steps[0].perp_dot(steps[1]).signum();
    let along = (sides[0] * steps[1].y - sides[1] * steps[0].y) * sign;
    // Of coordinates that go around as the corners do, v points up, to the left of u. Normals may be those of the other side.
    let facing = sides[0].cross(sides[1]).dot(normals[0] + normals[1] + normals[2]).signum();
    (along.normalize_or_zero(), -sign * facing)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns two triangles that meet in an edge along y with an angle, whose u goes along x, or against it.
    fn faces(mirrored: f64) -> [Face; 2] {
        let [low, high] = [DVec3::ZERO, DVec3::Y];
        let (left, right) = (DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.5));
        let face = |corners: [DVec3; 3], side: f64| {
            let uvs = corners.map(|corner| DVec2::new(corner.x * side, -corner.y));
            Face { corners, normals: None, uvs: Some(uvs), tangents: None, part: 0 }
        };
        [face([low, right, high], 1.0), face([low, high, left], mirrored)]
    }

    #[test]
    fn tangents_are_means_within_one_chart() {
        let of = |mirrored: f64| {
            let faces = faces(mirrored);
            let maps = maps(&faces, &Welded::new(&faces), &[[DVec3::Z; 3]; 2]);
            [0, 1].map(|k| maps[k].as_ref().expect("coordinates").tangents)
        };
        let [right, left] = of(1.0);
        // At the edge they are one, between the two slopes.
        assert!(right[0] == left[0] && right[2] == left[1] && right[0].w == 1.0, "{right:?} {left:?}");
        assert!(right[0].z > 0.05 && right[1].z > 1.5 * right[0].z && left[2].z == 0.0);
        // Mirrored coordinates are another chart.
        let [right, left] = of(-1.0);
        let along = (left[1].truncate() - DVec3::NEG_X).length();
        assert!((right[0].z - right[1].z).abs() < 1e-12 && along < 1e-12 && left[1].w == -1.0, "{left:?}");
    }
}
