use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

use super::accessor::{indices, numbers};
use super::buffers::Buffers;
use super::material::sets;
use crate::model::ModelFault;
use crate::shape::Face;

/// Triangles of a primitive, in its own frame.
pub(super) struct Triangles {
    points: Vec<DVec3>,
    normals: Option<Vec<DVec3>>,
    tangents: Option<Vec<DVec4>>,
    uvs: Option<Vec<DVec2>>,
    /// Vertices at the corners of each.
    corners: Vec<[usize; 3]>,
}

/// Returns whether a primitive has triangles: not points or lines.
pub(super) fn has_triangles(primitive: &Primitive) -> bool {
    matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

impl Triangles {
    /// Reads the triangles of a primitive.
    pub(super) fn read(primitive: &Primitive, buffers: &Buffers) -> Result<Self, ModelFault> {
        let positions = primitive.get(&Semantic::Positions).filter(|_| has_triangles(primitive));
        let points = positions.map(|accessor| numbers(&accessor, buffers)).transpose()?.unwrap_or_default();
        let points = mapped(points, DVec3::from_array);
        let count = points.len();
        let normals = attribute(primitive, (&Semantic::Normals, "normals"), count, buffers)?;
        let normals = normals.map(|normals| mapped(normals, DVec3::from_array));
        let tangents = attribute(primitive, (&Semantic::Tangents, "tangents"), count, buffers)?;
        // Tangents without normals do not count: section 3.7.2.1 of the format.
        let tangents = tangents.filter(|_| normals.is_some()).map(|tangents| mapped(tangents, DVec4::from_array));
        // The set of the material's pictures; those of a scene file go by the first.
        let set = sets(&primitive.material()).first().copied().unwrap_or(0);
        let uvs = attribute(primitive, (&Semantic::TexCoords(set), "texture coordinates"), count, buffers)?;
        let uvs = uvs.map(|uvs| mapped(uvs, DVec2::from_array));
        let corners = match primitive.indices() {
            _ if count == 0 => Vec::new(),
            Some(accessor) => indices(&accessor, count, buffers)?,
            None => (0..count).collect(),
        };
        Ok(Self { points, normals, tangents, uvs, corners: triangles(primitive.mode(), &corners) })
    }

    /// Lists the triangles at a place in the scene, as a part of the model.
    pub(super) fn faces(&self, place: &DMat4, part: usize) -> impl Iterator<Item = Face> {
        let turn = DMat3::from_mat4(*place);
        // Normals keep their angles to the surface; a mirrored place turns triangles around.
        let (side, normal_turn) = (turn.determinant().signum(), turn.inverse().transpose() * turn.determinant().abs());
        let tangent = move |tangent: DVec4| (turn * tangent.truncate()).normalize_or_zero().extend(tangent.w * side);
        self.corners.iter().map(move |[a, b, c]| {
            let corners = if side < 0.0 { [*a, *c, *b] } else { [*a, *b, *c] };
            Face {
                corners: corners.map(|corner| place.transform_point3(self.points[corner])),
                normals: self.normals.as_ref().map(|normals| corners.map(|corner| normal_turn * normals[corner])),
                uvs: self.uvs.as_ref().map(|uvs| corners.map(|corner| uvs[corner])),
                tangents: self.tangents.as_ref().map(|tangents| corners.map(|corner| tangent(tangents[corner]))),
                part,
            }
        })
    }
}

/// Reads an attribute of a number of vertices; `None` if the primitive has no such.
fn attribute<const N: usize>(
    primitive: &Primitive,
    (semantic, name): (&Semantic, &str),
    count: usize,
    buffers: &Buffers,
) -> Result<Option<Vec<[f64; N]>>, ModelFault> {
    let Some(accessor) = primitive.get(semantic).filter(|_| has_triangles(primitive)) else { return Ok(None) };
    if accessor.count() != count {
        let why = format!("has {} {name} for {count} vertices", accessor.count());
        return Err(ModelFault::Piece { piece: format!("accessor {}", accessor.index()), why });
    }
    let all = numbers(&accessor, buffers)?;
    if let Some(vertex) = all.iter().position(|numbers| !numbers.iter().all(|number| number.is_finite())) {
        let why = format!("has {name} of vertex {vertex} that are no numbers");
        return Err(ModelFault::Piece { piece: format!("accessor {}", accessor.index()), why });
    }
    Ok(Some(all))
}

fn mapped<T, U>(values: Vec<T>, map: impl Fn(T) -> U) -> Vec<U> {
    values.into_iter().map(map).collect()
}

/// Lists the triangles of a row of corners.
fn triangles(mode: Mode, corners: &[usize]) -> Vec<[usize; 3]> {
    match mode {
        Mode::Triangles => corners.chunks_exact(3).map(|face| [face[0], face[1], face[2]]).collect(),
        // Each second triangle of a strip goes the other way round.
        Mode::TriangleStrip => {
            let face = |(k, face): (usize, &[usize])| [face[0], face[1 + k % 2], face[2 - k % 2]];
            corners.windows(3).enumerate().map(face).collect()
        }
        Mode::TriangleFan => {
            let first = corners.first().copied().unwrap_or(0);
            corners.get(1..).unwrap_or_default().windows(2).map(|pair| [first, pair[0], pair[1]]).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}
