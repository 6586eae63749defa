use glam::DVec3;

use super::build::{Face, Normals, Welded};

/// Returns the unit normals at the corners of all triangles: those of the file, or means of the planes that meet there.
///
/// A corner's mean is over the triangles around the point whose planes are within the crease's angle of its own, each by its
/// angle there. Where more than [`MOST_AROUND`] meet, corners keep their planes.
pub(super) fn made(faces: &[Face], welded: &Welded, how: Normals) -> Vec<[DVec3; 3]> {
    let given = |face: &Face| {
        let normals = face.normals.filter(|_| how.kept)?.map(|normal| normal.try_normalize());
        Some([normals[0]?, normals[1]?, normals[2]?])
    };
    let given: Vec<Option<[DVec3; 3]>> = faces.iter().map(given).collect();
    let planes: Vec<DVec3> =
        faces.iter().map(|Face { corners: [a, b, c], .. }| (b - a).cross(c - a).normalize()).collect();
    if how.crease.radians() <= 0.0 || given.iter().all(Option::is_some) {
        return given.into_iter().zip(planes).map(|(given, plane)| given.unwrap_or([plane; 3])).collect();
    }
    let around = Around::new(welded);
    let least = how.crease.radians().cos();
    let smooth = |face: usize, corner: usize| {
        let around = around.faces(welded.corners[face][corner]);
        if around.len() > MOST_AROUND {
            return planes[face];
        }
        let near = around.iter().map(|index| (*index as usize / 3, *index as usize % 3));
        let near = near.filter(|(other, _)| *other == face || planes[*other].dot(planes[face]) >= least);
        let sum: DVec3 = near.map(|(other, corner)| planes[other] * angle(&faces[other].corners, corner)).sum();
        sum.try_normalize().unwrap_or(planes[face])
    };
    let normals = |(face, given): (usize, Option<[DVec3; 3]>)| {
        given.unwrap_or_else(|| std::array::from_fn(|corner| smooth(face, corner)))
    };
    given.into_iter().enumerate().map(normals).collect()
}

/// Triangles around a point at most of which means are taken: each corner looks at all of them, so that time goes with their square.
const MOST_AROUND: usize = 1024;

/// Returns the angle of a triangle at a corner.
pub(super) fn angle(corners: &[DVec3; 3], at: usize) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|k| corners[(at + k) % 3]);
    (b - a).angle_between(c - a)
}

/// Corners of triangles at each point.
struct Around {
    starts: Vec<u32>,
    /// Three times the triangle's number, and the corner's.
    corners: Vec<u32>,
}

impl Around {
    fn new(welded: &Welded) -> Self {
        let mut starts = vec![0; welded.points.len() + 1];
        let all = || welded.corners.iter().flatten().map(|point| *point as usize);
        all().for_each(|point| starts[point + 1] += 1);
        (1..starts.len()).for_each(|k| starts[k] += starts[k - 1]);
        let (mut next, mut corners) = (starts.clone(), vec![0; 3 * welded.corners.len()]);
        for (index, point) in all().enumerate() {
            corners[next[point] as usize] = index as u32;
            next[point] += 1;
        }
        Self { starts, corners }
    }

    fn faces(&self, point: u32) -> &[u32] {
        let [from, to] = [0, 1].map(|k| self.starts[point as usize + k] as usize);
        &self.corners[from..to]
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::sphere::Angle;

    use super::*;

    // A file of strangers may have all of its triangles at one point, which would take hours.
    #[test]
    fn points_of_many_triangles_take_no_squared_time() {
        let at = |k: usize| DVec3::new((k as f64 * 1e-4).cos(), (k as f64 * 1e-4).sin(), 0.1);
        let face = |k| {
            let corners = [DVec3::ZERO, at(k), at(k + 1)];
            Face { corners, normals: None, uvs: None, tangents: None, part: 0 }
        };
        let faces: Vec<Face> = (0..60_000).map(face).collect();
        let how = Normals { kept: true, crease: Angle::from_degrees(60.0) };
        let made = made(&faces, &Welded::new(&faces), how);
        let plane = |face: &Face| (face.corners[1]).cross(face.corners[2]).normalize();
        assert!(faces.iter().zip(&made).all(|(face, made)| (made[0] - plane(face)).length() < 1e-12));
        // Elsewhere they are smooth, as ever.
        assert!((made[5][2] - made[6][1]).length() < 1e-12);
    }

    #[test]
    fn normals_are_smooth_up_to_the_crease() {
        // Two triangles with an angle of 22.6° between them.
        let [low, high, right, left] =
            [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.2], [-1.0, 0.0, 0.2]].map(DVec3::from);
        let face = |corners| Face { corners, normals: None, uvs: None, tangents: None, part: 0 };
        let faces = [face([low, right, high]), face([low, high, left])];
        let welded = Welded::new(&faces);
        for (degrees, smooth) in [(0.0, false), (22.0, false), (23.0, true)] {
            let how = Normals { kept: true, crease: Angle::from_degrees(degrees) };
            let [one, other] = <[_; 2]>::try_from(made(&faces, &welded, how)).unwrap();
            assert_eq!(one[0] == other[0] && one[2] == other[1], smooth, "{degrees}");
            assert!(one[1].x < -0.1 && other[2].x > 0.1);
            assert!(!smooth || (one[0] - DVec3::Z).length() < 1e-12);
        }
    }
}
