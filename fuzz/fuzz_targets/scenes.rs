//! Scene files, with the materials, worlds and things in them.
#![no_main]

use std::path::Path;

use cosmorama::raster::{Image, Rgba};
use cosmorama_fuzz::prepare;
use cosmorama_scene::{ModelSettings, Object, PictureKind, PictureReader, PictureSource, SceneFile, SceneReader};
use libfuzzer_sys::fuzz_target;

/// A reader that finds small pictures everywhere, and models nowhere.
struct Small;

impl PictureReader for Small {
    fn picture(&mut self, _: PictureSource, _: PictureKind) -> Result<Image<Rgba>, String> {
        Ok(Image::filled(2, 2, Rgba::BLACK))
    }
}

impl SceneReader for Small {
    fn model(&mut self, path: &Path, _: ModelSettings) -> Result<Object, String> {
        Err(format!("{}: no model", path.display()))
    }

    fn tell(&mut self, _: &Path, _: &str) {}
}

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    let Ok(text) = str::from_utf8(bytes) else { return };
    let Ok(file) = SceneFile::parse("scene.toml", text) else { return };
    file.camera();
    let _ = (file.worlds().is_ok(), file.scene(&mut Small).is_ok());
});
