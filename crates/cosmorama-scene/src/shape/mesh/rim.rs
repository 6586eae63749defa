use glam::DVec3;

use super::body::Skin;
use super::build::{Half, Welded};

/// An edge at which the surface may end for an eye, or break off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rim {
    /// Its ends.
    pub(crate) ends: [DVec3; 2],
    /// Triangles on both sides, if it is smooth: it is then an outline where one of them is seen from behind. `None` at
    /// borders, creases and seams of parts, which are seen from anywhere.
    pub(crate) smooth: Option<[usize; 2]>,
}

/// All edges of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Rims {
    points: Vec<DVec3>,
    edges: Vec<Edge>,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [u32; 2],
    faces: [u32; 2],
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Smooth,
    /// A crease, or a seam of parts.
    Crease,
    /// An edge that triangles do not pass as often in one direction as in the other: the surface ends there, or turns inside out.
    Border,
}

/// Cosine of the angle between normals from which an edge is a crease: half a degree.
const CREASE: f64 = 0.99996;

impl Rims {
    pub(super) fn new(welded: &Welded, skins: &[Skin]) -> Self {
        let halves = welded.halves();
        let is_crease = |a: &Half, b: &Half| {
            let [one, other] = [a, b].map(|half| &skins[half.1 as usize]);
            let at = |half: &Half, end: u32| {
                let corner = welded.corners[half.1 as usize].iter().position(|point| *point == end);
                skins[half.1 as usize].normals[corner.unwrap_or(0)]
            };
            one.part != other.part || a.0.iter().any(|end| at(a, *end).dot(at(b, *end)) < CREASE)
        };
        let edge = |group: &[Half]| match group {
            [a, b] if a.2 != b.2 => {
                let kind = if is_crease(a, b) { Kind::Crease } else { Kind::Smooth };
                Edge { ends: a.0, faces: [a.1, b.1], kind }
            }
            // An end, two that face opposite ways, or sheets that touch along an edge.
            group => {
                let forwards = group.iter().filter(|half| half.2).count();
                let kind = if 2 * forwards == group.len() { Kind::Crease } else { Kind::Border };
                Edge { ends: group[0].0, faces: [group[0].1; 2], kind }
            }
        };
        let edges = halves.chunk_by(|a, b| a.0 == b.0).map(edge).collect();
        Self { points: welded.points.clone(), edges }
    }

    pub(super) fn hole(&self) -> Option<[DVec3; 2]> {
        let hole = self.edges.iter().find(|edge| edge.kind == Kind::Border);
        hole.map(|edge| edge.ends.map(|end| self.points[end as usize]))
    }

    pub(super) fn count(&self) -> usize {
        self.edges.len()
    }

    pub(super) fn get(&self, index: usize) -> Rim {
        let edge = &self.edges[index];
        Rim {
            ends: edge.ends.map(|end| self.points[end as usize]),
            smooth: (edge.kind == Kind::Smooth).then(|| edge.faces.map(|face| face as usize)),
        }
    }
}
