//! Models: Wavefront's OBJ and MTL, glTF as text and in one file.
#![no_main]

use cosmorama::raster::{Image, Rgba};
use cosmorama_fuzz::{prepare, written};
use cosmorama_scene::{Model, ModelSettings, PictureKind, PictureReader, PictureSource};
use libfuzzer_sys::fuzz_target;

const SETTINGS: ModelSettings = ModelSettings { crease: None, material: None, most: 100_000, placing: None };

/// A surface that names the materials beside it.
const TRIANGLE: &[u8] = b"mtllib beside.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";

/// A reader that finds small pictures everywhere.
struct Small;

impl PictureReader for Small {
    fn picture(&mut self, _: PictureSource, _: PictureKind) -> Result<Image<Rgba>, String> {
        Ok(Image::filled(2, 2, Rgba::BLACK))
    }
}

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    let model = match bytes {
        [b'{', ..] => written("a.gltf", bytes),
        [b'g', b'l', b'T', b'F', ..] => written("a.glb", bytes),
        _ if bytes.starts_with(b"newmtl") => {
            written("beside.mtl", bytes);
            written("a.obj", TRIANGLE)
        }
        _ => written("b.obj", bytes),
    };
    let _ = Model::read(&model, &SETTINGS, &mut Small);
});

/// A model in one file: its text alone (glTF 2.0, section 4).
fn seeds() -> Vec<(String, Vec<u8>)> {
    let mut text = include_bytes!("../seeds/models/a.gltf").to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = text.len() as u32;
    let numbers = [2, 20 + length, length].map(u32::to_le_bytes).concat();
    vec![("a.glb".to_owned(), [b"glTF", &numbers[..], b"JSON", &text].concat())]
}
