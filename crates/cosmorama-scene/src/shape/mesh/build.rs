use cosmorama::sphere::Angle;
use glam::{DVec2, DVec3, DVec4};
use thiserror::Error;

use super::Mesh;
use super::body::{Body, Skin};
use super::normals::made;
use super::rim::Rims;
use super::tangents::maps;
use super::tree::{Corners, Tree};
use super::winding::wrongly_wound;

/// A triangle, as files have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Its corners, anticlockwise from outside.
    pub corners: [DVec3; 3],
    /// Normals at the corners.
    pub normals: Option<[DVec3; 3]>,
    /// Texture coordinates at the corners.
    pub uvs: Option<[DVec2; 3]>,
    /// Tangents at the corners, along u; w is 1 or −1, the side of the bitangent, which points against v.
    pub tangents: Option<[DVec4; 3]>,
    /// Index of the part of the object.
    pub part: usize,
}

/// Origin of a mesh's normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normals {
    /// Whether those of the file are kept.
    pub kept: bool,
    /// Greatest angle between faces over which others are smooth; 0 makes all flat.
    pub crease: Angle,
}

/// Reason why there is no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MeshError {
    /// Nothing is left.
    #[error("it has no triangle with an area ({skipped} without)")]
    Empty {
        /// Number of triangles without area.
        skipped: usize,
    },
    /// A corner is nowhere.
    #[error("corner {corner} of triangle {face} is not a point: its coordinates are not finite numbers")]
    NotFinite {
        /// Number of the triangle, from 0.
        face: usize,
        /// Number of the corner, from 0.
        corner: usize,
    },
    /// More than can be numbered.
    #[error("it has {0} triangles; expected at most {most}", most = Mesh::MOST)]
    TooMany(usize),
}

impl Face {
    /// Turns it round: its corners go around the other way.
    fn turn(&mut self) {
        self.corners.swap(1, 2);
        self.normals.iter_mut().for_each(|all| all.swap(1, 2));
        self.uvs.iter_mut().for_each(|all| all.swap(1, 2));
        self.tangents.iter_mut().for_each(|all| all.swap(1, 2));
    }
}

impl Body {
    /// Returns the surface of some triangles, perhaps with those turned that are wound the wrong way.
    pub(super) fn new(mut faces: Vec<Face>, normals: Normals, is_mended: bool) -> Result<Self, MeshError> {
        if faces.len() > Mesh::MOST {
            return Err(MeshError::TooMany(faces.len()));
        }
        for (face, Face { corners, .. }) in faces.iter().enumerate() {
            if let Some(corner) = corners.iter().position(|corner| !is_place(*corner)) {
                return Err(MeshError::NotFinite { face, corner });
            }
        }
        let whole = faces.len();
        faces.retain(|face| has_area(&face.corners));
        let skipped = whole - faces.len();
        if faces.is_empty() {
            return Err(MeshError::Empty { skipped });
        }
        let corners: Vec<Corners> = faces.iter().map(|face| face.corners).collect();
        let (mut tree, order) = Tree::new(&corners);
        let mut faces: Vec<Face> = order.iter().map(|k| faces[*k as usize]).collect();
        let mut welded = Welded::new(&faces);
        let wrong = if is_mended { wrongly_wound(&welded, &tree) } else { Vec::new() };
        for face in &wrong {
            tree.turn(*face);
            faces[*face].turn();
            welded.corners[*face].swap(1, 2);
        }
        let normals = made(&faces, &welded, normals);
        let maps = maps(&faces, &welded, &normals);
        let pieces = welded.pieces();
        let skin =
            |((face, normals), piece): ((&Face, [DVec3; 3]), u32)| Skin { normals, part: face.part as u32, piece };
        let skins: Vec<Skin> = faces.iter().zip(normals).zip(pieces).map(skin).collect();
        let rims = Rims::new(&welded, &skins);
        let apex = tree.ball().centre;
        let volume = |[a, b, c]: &Corners| (a - apex).dot((b - apex).cross(c - apex)) / 6.0;
        let volume = faces.iter().map(|face| volume(&face.corners)).sum();
        Ok(Self { tree, skins, maps, rims, skipped, turned: wrong.len(), volume })
    }
}

/// Returns whether a point can be computed with: far ones have no finite area.
fn is_place(point: DVec3) -> bool {
    const FAR: f64 = 1e60;
    point.is_finite() && point.abs().max_element() < FAR
}

fn has_area([a, b, c]: &Corners) -> bool {
    (b - a).cross(c - a).length_squared() > 0.0
}

/// An edge of one triangle: its ends, the lower number first, the triangle, and whether it runs from the lower to the higher.
pub(super) type Half = ([u32; 2], u32, bool);

/// Triangles whose corners are numbered: those at one place have one number.
pub(super) struct Welded {
    pub(super) points: Vec<DVec3>,
    pub(super) corners: Vec<[u32; 3]>,
}

impl Welded {
    pub(super) fn new(faces: &[Face]) -> Self {
        let place = |index: u32| faces[index as usize / 3].corners[index as usize % 3];
        // Zero has one sign, so that equal places have equal bits.
        let key = |index: u32| (place(index) + DVec3::ZERO).to_array().map(f64::to_bits);
        let mut sorted: Vec<u32> = (0..3 * faces.len() as u32).collect();
        sorted.sort_unstable_by_key(|index| (key(*index), *index));
        let (mut points, mut corners) = (Vec::new(), vec![[0; 3]; faces.len()]);
        for (k, index) in sorted.iter().enumerate() {
            if k == 0 || key(sorted[k - 1]) != key(*index) {
                points.push(place(*index));
            }
            corners[*index as usize / 3][*index as usize % 3] = points.len() as u32 - 1;
        }
        Self { points, corners }
    }

    /// Lists the edges of all triangles, those at one place side by side.
    pub(super) fn halves(&self) -> Vec<Half> {
        let half = |(face, corners): (usize, &[u32; 3])| {
            [0, 1, 2].map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                ([a.min(b), a.max(b)], face as u32, a < b)
            })
        };
        let mut halves: Vec<Half> = self.corners.iter().enumerate().flat_map(half).collect();
        halves.sort_unstable();
        halves
    }

    /// Numbers the pieces that hang together, for each triangle.
    fn pieces(&self) -> Vec<u32> {
        let mut roots: Vec<u32> = (0..self.points.len() as u32).collect();
        fn root(roots: &mut [u32], mut point: u32) -> u32 {
            while roots[point as usize] != point {
                roots[point as usize] = roots[roots[point as usize] as usize];
                point = roots[point as usize];
            }
            point
        }
        for corners in &self.corners {
            let [a, b, c] = corners.map(|point| root(&mut roots, point));
            let first = a.min(b).min(c);
            [a, b, c].into_iter().for_each(|point| roots[point as usize] = first);
        }
        self.corners.iter().map(|corners| root(&mut roots, corners[0])).collect()
    }
}
