//! Forms in which glTF may say the same, and what is seen of them.

use cosmorama_scene::{Material, Model, ModelSettings, Shape};

use crate::meshes::{light, made, parallel};
use crate::models::{File, Files, SETTINGS, base64, name_of, two_texels};
use glam::DVec3;

/// Corners of a square from 0 to 1, normals that lean towards x, two sets of texture coordinates, and indices.
fn bytes() -> Vec<u8> {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let (sin, cos) = 0.2f32.sin_cos();
    let (normals, left, right) = ([[sin, 0.0, cos]; 4], [[0.25f32, 0.5]; 4], [[0.75f32, 0.5]; 4]);
    let numbers = corners.iter().chain(&normals).flatten().chain(left.iter().chain(&right).flatten());
    numbers.flat_map(|number| number.to_le_bytes()).chain([0, 1, 2, 3, 3, 0, 0, 0]).collect()
}

/// A square; its material glows by the second set of coordinates.
const SQUARE: &str = r#"{
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TEXCOORD_1": 3}, "indices": 4, "mode": 5,
    "material": 0}]}],
  "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "texCoord": 1},
    "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 1}}],
  "textures": [{"source": 0}], "images": [{"uri": "PICTURE"}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
    {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC2"},
    {"bufferView": 0, "byteOffset": 128, "componentType": 5126, "count": 4, "type": "VEC2"},
    {"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"}
  ],
  "bufferViews": [{"buffer": 0, "byteLength": 160}, {"buffer": 0, "byteOffset": 160, "byteLength": 8}],
  "buffers": [{"uri": "DATA", "byteLength": 168}]
}"#;

fn text(from: &str, to: &str, picture: &File) -> String {
    let data = format!("data:application/octet-stream;base64,{}", base64(&bytes()));
    let changed = SQUARE.replacen(from, to, 1);
    assert!(changed != SQUARE || from == to, "{from}");
    changed.replace("DATA", &data).replace("PICTURE", &name_of(picture))
}

/// Middle and radius of the ball around a model.
fn ball(model: &Model) -> ([f64; 3], f64) {
    let Shape::Mesh(mesh) = &model.object.shape else { panic!("a mesh") };
    assert_eq!(mesh.count(), 2);
    (mesh.ball().centre.to_array(), mesh.ball().radius)
}

#[test]
fn places_are_those_of_their_variant() {
    let picture = two_texels("variant.png", false);
    let sparse = r#""count": 4, "type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 1, "byteOffset": 4, "componentType": 5121},
        "values": {"bufferView": 0, "byteOffset": 48}}, "min""#;
    let half = 0.5f64.sqrt();
    for (k, (from, to, centre, radius)) in [
        ("", "", [0.5, 0.5, 0.0], half),
        (
            r#""nodes": [{"mesh": 0}]"#,
            r#""nodes": [{"mesh": 0, "scale": [-2, 1, 1]}]"#,
            [-1.0, 0.5, 0.0],
            1.25f64.sqrt(),
        ),
        // The corner at (1, 1, 0) is where the first normal points.
        (r#""count": 4, "type": "VEC3", "min""#, sparse, [0.5, 0.5, 0.5 * f64::from(0.2f32.cos())], 0.0),
        // Skins place their meshes, and not the node's own place.
        (
            r#""nodes": [{"mesh": 0}]"#,
            r#""nodes": [{"mesh": 0, "skin": 0, "translation": [9, 0, 0]}], "skins": [{"joints": [0]}]"#,
            [0.5, 0.5, 0.0],
            half,
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let found = ball(&File::new(&format!("variant{k}.gltf"), &text(from, to, &picture)).read().unwrap());
        let error = DVec3::from(found.0).distance(centre.into());
        assert!(error < 1e-6 && (radius == 0.0 || (found.1 - radius).abs() < 1e-6), "{to}: {found:?}");
    }
}

#[test]
fn binary_files_are_read() {
    let picture = two_texels("binary.png", false);
    let mut json = text(r#""uri": "DATA", "#, "", &picture).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let bytes = bytes();
    let number = |number: usize| (number as u32).to_le_bytes();
    let chunk = |kind: &[u8], data: &[u8]| [&number(data.len()), kind, data].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &bytes)].concat();
    let header = [&b"glTF"[..], &number(2), &number(12 + chunks.len())].concat();
    let model = File::write("binary.glb", &[header, chunks].concat()).read().unwrap();
    assert_eq!(ball(&model).0, [0.5, 0.5, 0.0]);
}

#[test]
fn mirrored_normals_lean_the_other_way() {
    let picture = two_texels("mirrored.png", false);
    let (mirrored, sin_cos) =
        (r#""nodes": [{"mesh": 0, "translation": [0.5, -0.5, 0], "scale": [-1, 1, 1]}]"#, 0.2f64.sin_cos());
    for (to, side) in [(r#""nodes": [{"mesh": 0, "translation": [-0.5, -0.5, 0]}]"#, 1.0), (mirrored, -1.0)] {
        let file = File::new("mirrored.gltf", &text(r#""nodes": [{"mesh": 0}]"#, to, &picture));
        let settings = ModelSettings { material: Some(Material::MIRROR), ..SETTINGS };
        let model = Model::read(&file.0, &settings, &mut Files).unwrap();
        let found = made(vec![model.object], &parallel(0.8, [16, 16])).get(8, 8).0;
        let normal = DVec3::new(side * sin_cos.0, 0.0, sin_cos.1);
        let expected = light(DVec3::NEG_Z + 2.0 * normal.z * normal);
        assert!((0..3).all(|k| (found[k] - expected[k]).abs() < 0.02), "{side}: {found:?} for {expected:?}");
    }
}

#[test]
fn pictures_go_by_their_set_of_coordinates() {
    let picture = two_texels("sets.png", false);
    let centred = r#""nodes": [{"mesh": 0, "translation": [-0.5, -0.5, 0]}]"#;
    for (set, is_green) in [(1, true), (0, false)] {
        let text = text(r#""nodes": [{"mesh": 0}]"#, centred, &picture);
        let file = File::new("sets.gltf", &text.replace(r#""texCoord": 1"#, &format!(r#""texCoord": {set}"#)));
        let found = made(vec![file.read().unwrap().object], &parallel(0.8, [16, 16])).get(8, 8).0;
        let (red, green) = (found[0], found[1]);
        assert!((green > red) == is_green && red.max(green) > 0.8, "{set}: {found:?}");
    }
}
