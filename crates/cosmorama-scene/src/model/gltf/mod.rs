//! glTF 2.0, as text or binary.

mod accessor;
mod buffers;
mod camera;
mod material;
mod primitive;

use std::path::Path;

use cosmorama::sphere::Angle;
use glam::{DMat4, DVec4};
use gltf::mesh::Mode;
use gltf::{Document, Gltf, Node, Semantic};

use self::buffers::Buffers;
use self::material::{Materials, sets};
use super::{Contents, ModelFault, ModelSettings};
use crate::material::PictureReader;
use crate::scene::Part;

/// Extensions that a file may require.
const SUPPORTED: [&str; 1] = ["KHR_mesh_quantization"];

/// Reads the triangles and cameras of a file's scene, and its materials unless others are given.
pub(super) fn read(
    path: &Path,
    settings: &ModelSettings,
    pictures: &mut dyn PictureReader,
) -> Result<Contents, ModelFault> {
    let most = settings.most;
    let bytes = std::fs::read(path)?;
    let Gltf { document, blob } =
        Gltf::from_slice_without_validation(&bytes).map_err(|error| ModelFault::Format(error.to_string()))?;
    let is_unknown = |extension: &&str| !SUPPORTED.contains(extension);
    let required: Vec<String> = document.extensions_required().filter(is_unknown).map(str::to_owned).collect();
    if !required.is_empty() {
        return Err(ModelFault::Required(required.join(", ")));
    }
    check(&document)?;
    let nodes = nodes(&document)?;
    let count = nodes.iter().map(|(node, _)| triangles(node)).fold(0, usize::saturating_add);
    if count > most {
        return Err(ModelFault::TooLarge { count, most });
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = Buffers::read(&document, blob, folder, most)?;
    // Normals that the file lacks are flat: section 3.7.2.1 of the format.
    let notes = notes(&document, settings.material.is_none());
    let mut contents = Contents { notes, ..Contents::new(Angle::from_degrees(0.0)) };
    let mut materials = Materials::new(&buffers, folder, pictures);
    for (node, place) in &nodes {
        contents.cameras.extend(camera::camera(node, place));
        let Some(mesh) = node.mesh() else { continue };
        let is_one = mesh.primitives().len() == 1;
        for primitive in mesh.primitives() {
            let part = contents.parts.len();
            contents.faces.extend(primitive::faces(&primitive, (place, part), &buffers)?);
            let material = primitive.material().name().filter(|_| !is_one);
            let name = material
                .or(node.name())
                .or(mesh.name())
                .map_or_else(|| format!("node {}", node.index()), str::to_owned);
            let material = match &settings.material {
                Some(given) => given.clone(),
                None => materials.get(&primitive.material())?,
            };
            contents.parts.push(Part { name, material, world: 0 });
        }
    }
    Ok(contents)
}

/// Checks that all that the file's pieces name is there. Rules of other formats of vertices are not those of quantised ones.
fn check(document: &Document) -> Result<(), ModelFault> {
    use gltf::json::camera::Type;
    use gltf::json::validation::Checked::Valid;
    use gltf::json::validation::{Error, Validate};
    let json = document.as_json();
    // Rules that the crate's own checks take for granted, or leave out.
    let attributes = json.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|part| part.attributes.values());
    if attributes.clone().any(|index| index.value() >= json.accessors.len()) {
        return Err(ModelFault::Format("a primitive names an accessor that is not there".to_owned()));
    }
    if let Some(index) = json.cameras.iter().position(|camera| match camera.type_ {
        Valid(Type::Perspective) => camera.perspective.is_none(),
        Valid(Type::Orthographic) => camera.orthographic.is_none(),
        _ => true,
    }) {
        let why = "does not have the numbers of its type".to_owned();
        return Err(ModelFault::Piece { piece: format!("camera {index}"), why });
    }
    let is_bare = |image: &gltf::json::Image| {
        image.uri.is_none() && image.buffer_view.is_none() || image.buffer_view.is_some() && image.mime_type.is_none()
    };
    if let Some(index) = json.images.iter().position(is_bare) {
        let why = "has no picture; expected a uri, or a bufferView and its mimeType".to_owned();
        return Err(ModelFault::Piece { piece: format!("image {index}"), why });
    }
    let mut faults = Vec::new();
    json.validate(json, gltf::json::Path::new, &mut |path, error| {
        if error != Error::Unsupported {
            faults.push(format!("{} {error}", path()));
        }
    });
    match faults.into_iter().next() {
        Some(fault) => Err(ModelFault::Format(fault)),
        None => Ok(()),
    }
}

/// Lists the nodes of the file's scene, with their places in it.
fn nodes(document: &Document) -> Result<Vec<(Node<'_>, DMat4)>, ModelFault> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| ModelFault::Format("it has no scene".to_owned()))?;
    let mut waiting: Vec<(Node, DMat4)> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
    let (mut seen, mut nodes) = (vec![false; document.nodes().len()], Vec::new());
    while let Some((node, outer)) = waiting.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            let why = "is below itself, or has two parents; expected a tree of nodes".to_owned();
            return Err(ModelFault::Piece { piece: format!("node {}", node.index()), why });
        }
        let columns = node.transform().matrix().map(|column| DVec4::from_array(column.map(f64::from)));
        let place = outer * DMat4::from_cols(columns[0], columns[1], columns[2], columns[3]);
        waiting.extend(node.children().map(|child| (child, place)));
        nodes.push((node, place));
    }
    nodes.sort_by_key(|(node, _)| node.index());
    Ok(nodes)
}

/// Returns the number of triangles of a node.
fn triangles(node: &Node) -> usize {
    let count = |primitive: gltf::Primitive| {
        let positions = primitive.get(&Semantic::Positions).map_or(0, |accessor| accessor.count());
        let corners = primitive.indices().map_or(positions, |accessor| accessor.count());
        match primitive.mode() {
            Mode::Triangles => corners / 3,
            Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => 0,
        }
    };
    node.mesh().map_or(0, |mesh| mesh.primitives().map(count).fold(0, usize::saturating_add))
}

/// Lists what a file has that is not shown. Its materials may not be wanted.
fn notes(document: &Document, has_materials: bool) -> Vec<String> {
    let primitives = || document.meshes().flat_map(|mesh| mesh.primitives());
    let is_line = |primitive: gltf::Primitive| {
        !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
    };
    let is_clear = |primitive: gltf::Primitive| primitive.material().alpha_mode() != gltf::material::AlphaMode::Opaque;
    let is_occluded = |material: gltf::Material| material.occlusion_texture().is_some();
    let is_of_two = |material: gltf::Material| sets(&material).windows(2).any(|pair| pair[0] != pair[1]);
    let all = [
        (document.skins().len() > 0, "skins are not applied: things are as they rest"),
        (document.animations().len() > 0, "animations are not applied"),
        (primitives().any(is_line), "points and lines are left out"),
        (has_materials && document.materials().any(is_occluded), "pictures of ambient occlusion are not read"),
        (has_materials && document.materials().any(is_of_two), "pictures of one material go by one set of coordinates"),
        (has_materials && primitives().any(is_clear), "transparency of materials is not shown"),
        (primitives().any(|primitive| primitive.morph_targets().len() > 0), "morph targets are not applied"),
        (primitives().any(|part| part.get(&Semantic::Colors(0)).is_some()), "colours of vertices are not applied"),
    ];
    let unread = document.extensions_used().filter(|extension| !SUPPORTED.contains(extension));
    let unread = unread.map(|extension| format!("{extension} is not applied"));
    all.into_iter().filter(|(is_there, _)| *is_there).map(|(_, note)| note.to_owned()).chain(unread).collect()
}
