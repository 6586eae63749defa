use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

use super::accessor::{indices, numbers};
use super::buffers::Buffers;
use super::material::sets;
use crate::model::ModelFault;
use crate::shape::Face;

/// Reads the triangles of a primitive at a place in the scene, as a part of the model.
pub(super) fn faces(
    primitive: &Primitive,
    (place, part): (&DMat4, usize),
    buffers: &Buffers,
) -> Result<Vec<Face>, ModelFault> {
    let Some(accessor) = primitive.get(&Semantic::Positions) else { return Ok(Vec::new()) };
    let points: Vec<DVec3> =
        numbers(&accessor, buffers)?.into_iter().map(|point| place.transform_point3(point.into())).collect();
    let turn = DMat3::from_mat4(*place);
    // Normals keep their angles to the surface; a mirrored place turns triangles around.
    let (side, normal_turn) = (turn.determinant().signum(), turn.inverse().transpose() * turn.determinant().abs());
    let normals = attribute(primitive, &Semantic::Normals, buffers)?;
    let normals = normals.map(|normals| mapped(normals, |normal: [f64; 3]| normal_turn * DVec3::from(normal)));
    let tangents = attribute(primitive, &Semantic::Tangents, buffers)?;
    let tangents = tangents.map(|tangents| {
        mapped(tangents, |[x, y, z, w]: [f64; 4]| (turn * DVec3::new(x, y, z)).normalize_or_zero().extend(w * side))
    });
    // The set of the material's pictures; those of a scene file go by the first.
    let set = sets(&primitive.material()).first().copied().unwrap_or(0);
    let uvs = attribute(primitive, &Semantic::TexCoords(set), buffers)?;
    let uvs = uvs.map(|uvs| mapped(uvs, DVec2::from_array));
    for (name, count) in [
        ("normals", normals.as_ref().map(Vec::len)),
        ("tangents", tangents.as_ref().map(Vec::len)),
        ("texture coordinates", uvs.as_ref().map(Vec::len)),
    ] {
        if let Some(count) = count.filter(|count| *count != points.len()) {
            let why = format!("has {count} {name} for {} vertices", points.len());
            return Err(ModelFault::Piece { piece: format!("accessor {}", accessor.index()), why });
        }
    }
    let corners = match primitive.indices() {
        Some(accessor) => indices(&accessor, points.len(), buffers)?,
        None => (0..points.len()).collect(),
    };
    let face = |corners: [usize; 3]| {
        let [a, b, c] = corners;
        let corners = if side < 0.0 { [a, c, b] } else { corners };
        Face {
            corners: corners.map(|corner| points[corner]),
            normals: normals.as_ref().map(|normals| corners.map(|corner| normals[corner])),
            uvs: uvs.as_ref().map(|uvs: &Vec<DVec2>| corners.map(|corner| uvs[corner])),
            tangents: tangents.as_ref().map(|tangents: &Vec<DVec4>| corners.map(|corner| tangents[corner])),
            part,
        }
    };
    Ok(triangles(primitive.mode(), &corners).into_iter().map(face).collect())
}

fn attribute<const N: usize>(
    primitive: &Primitive,
    semantic: &Semantic,
    buffers: &Buffers,
) -> Result<Option<Vec<[f64; N]>>, ModelFault> {
    primitive.get(semantic).map(|accessor| numbers(&accessor, buffers)).transpose()
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
