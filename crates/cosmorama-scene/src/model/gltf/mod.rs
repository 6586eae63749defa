//! glTF 2.0, as text or binary.

mod accessor;
mod buffers;
mod camera;
mod material;
mod primitive;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;

use cosmorama::sphere::Angle;
use glam::{DMat4, DVec4};
use gltf::mesh::Mode;
use gltf::{Document, Gltf, Node, Semantic};

use self::buffers::Buffers;
use self::material::{Materials, sets};
use self::primitive::{Triangles, has_triangles};
use super::file;
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
    let bytes = file::read(path, settings.most_bytes())?;
    check_bytes(&bytes, settings)?;
    let Gltf { document, blob } = Gltf::from_slice_without_validation(&bytes)
        .map_err(|error| ModelFault::Format(format!("it is no glTF: {error}")))?;
    check_version(&document)?;
    let is_unknown = |extension: &&str| !SUPPORTED.contains(extension);
    let required: Vec<String> = document.extensions_required().filter(is_unknown).map(str::to_owned).collect();
    if !required.is_empty() {
        return Err(ModelFault::Required(required.join(", ")));
    }
    check(&document)?;
    let nodes = nodes(&document)?;
    let all = |count: fn(&Node) -> usize| nodes.iter().map(|(node, _)| count(node)).fold(0, usize::saturating_add);
    settings.check_counts(all(triangles), all(vertices))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = Buffers::read(&document, blob, folder, settings.most)?;
    // Normals that the file lacks are flat: section 3.7.2.1 of the format.
    let notes = notes(&document, settings.material.is_none());
    let mut contents = Contents { notes, ..Contents::new(Angle::from_degrees(0.0)) };
    let mut materials = Materials::new(&buffers, folder, pictures);
    // Of meshes that stand in several places.
    let mut read: HashMap<[usize; 2], Triangles> = HashMap::new();
    for (node, place) in &nodes {
        contents.cameras.extend(camera::camera(node, place));
        let Some(mesh) = node.mesh() else { continue };
        // Skins place their meshes; the node's own place does not count.
        let place = if node.skin().is_some() { &DMat4::IDENTITY } else { place };
        let is_one = mesh.primitives().len() == 1;
        for primitive in mesh.primitives() {
            let part = contents.parts.len();
            let triangles = match read.entry([mesh.index(), primitive.index()]) {
                Entry::Occupied(read) => read.into_mut(),
                Entry::Vacant(unread) => unread.insert(Triangles::read(&primitive, &buffers)?),
            };
            contents.faces.extend(triangles.faces(place, part));
            contents.is_one_sided |= !primitive.material().double_sided();
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

/// Checks the parts of a file that its format's reader takes for granted.
fn check_bytes(bytes: &[u8], settings: &ModelSettings) -> Result<(), ModelFault> {
    /// Bytes of memory that a byte of JSON takes at most.
    const PIECES: u64 = 32;
    /// Bytes of a binary file's header.
    const HEADER: u32 = 12;
    let number = |at: usize| bytes.get(at..at + 4).and_then(|part| part.try_into().ok()).map(u32::from_le_bytes);
    let is_binary = bytes.starts_with(b"glTF");
    if let Some(length) = number(8).filter(|length| is_binary && *length < HEADER) {
        let why = format!("its header says that it has {length} bytes; expected at least {HEADER}");
        return Err(ModelFault::Format(why));
    }
    let json = if is_binary { number(HEADER as usize).unwrap_or(0).into() } else { bytes.len() as u64 };
    let most = settings.most_bytes() / PIECES;
    if json > most { Err(ModelFault::TooLong { bytes: json, most }) } else { Ok(()) }
}

/// Checks that the file is of glTF 2: others have other meanings.
fn check_version(document: &Document) -> Result<(), ModelFault> {
    let asset = &document.as_json().asset;
    let wanted = asset.min_version.as_ref().unwrap_or(&asset.version);
    let is_known =
        asset.version.split('.').next() == Some("2") && asset.min_version.as_ref().is_none_or(|least| least == "2.0");
    if is_known { Ok(()) } else { Err(ModelFault::Version(wanted.clone())) }
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

/// Returns the number of vertices of a primitive's triangles.
fn positions(primitive: &gltf::Primitive) -> usize {
    let positions = primitive.get(&Semantic::Positions).filter(|_| has_triangles(primitive));
    positions.map_or(0, |accessor| accessor.count())
}

/// Returns the number of vertices of a node.
fn vertices(node: &Node) -> usize {
    node.mesh().map_or(0, |mesh| mesh.primitives().map(|part| positions(&part)).fold(0, usize::saturating_add))
}

/// Returns the number of triangles of a node; at least one for each of its primitives, which are parts even without any.
fn triangles(node: &Node) -> usize {
    let count = |primitive: gltf::Primitive| {
        let corners = primitive.indices().map_or_else(|| positions(&primitive), |accessor| accessor.count());
        match primitive.mode() {
            Mode::Triangles => corners / 3,
            Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => 0,
        }
    };
    let of_part = |primitive: gltf::Primitive| count(primitive).max(1);
    node.mesh().map_or(0, |mesh| mesh.primitives().map(of_part).fold(0, usize::saturating_add))
}

fn is_nearest(sampler: &gltf::texture::Sampler) -> bool {
    sampler.mag_filter() == Some(gltf::texture::MagFilter::Nearest)
}

/// Lists what a file has that is not shown. Its materials may not be wanted.
fn notes(document: &Document, has_materials: bool) -> Vec<String> {
    let primitives = || document.meshes().flat_map(|mesh| mesh.primitives());
    let is_line = |primitive: gltf::Primitive| !has_triangles(&primitive);
    let is_clear = |primitive: gltf::Primitive| primitive.material().alpha_mode() != gltf::material::AlphaMode::Opaque;
    let is_occluded = |material: gltf::Material| material.occlusion_texture().is_some();
    let is_of_two = |material: gltf::Material| sets(&material).windows(2).any(|pair| pair[0] != pair[1]);
    let all = [
        (
            has_materials && document.samplers().any(|sampler| is_nearest(&sampler)),
            "pictures are averaged where samplers ask for the nearest texel",
        ),
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
