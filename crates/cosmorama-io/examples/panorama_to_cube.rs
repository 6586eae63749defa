//! A panorama becomes the six faces of a cube.
//!
//! `cargo run -p cosmorama-io --example panorama_to_cube -- sky.png faces`; without arguments it makes a panorama of its own.
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;
use std::path::Path;

use cosmorama::prelude::*;
use cosmorama_io::{Limits, WriteOptions, read, write};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    if let (Some(panorama), Some(folder)) = (arguments.next(), arguments.next()) {
        return panorama_to_cube(Path::new(&panorama), Path::new(&folder));
    }
    let folder = tempfile::tempdir()?;
    let panorama = folder.path().join("sky.png");
    let sky = Image::from_fn(256, 128, |i, j| Rgba::opaque(i as f32 / 256.0, j as f32 / 128.0, 0.5));
    write(&panorama, &sky.to_codes(Depth::Eight, &Transfer::Srgb), &WriteOptions::default())?;
    panorama_to_cube(&panorama, folder.path())?;
    println!("front.png and five more");
    Ok(())
}

/// Reads a panorama and writes its six faces, as fine as it is itself, into a folder.
fn panorama_to_cube(panorama: &Path, folder: &Path) -> Result<(), Box<dyn Error>> {
    let file = read(panorama, &Limits::default())?;
    let edge = file.image.width() / 4;
    let (world, light) = World::from_panorama(file.to_light())?;
    for face in CubeFace::ALL {
        let camera = Placement { orientation: face.orientation(), ..Placement::new(CameraModel::from(CubeFaceCamera)) };
        let target = camera.view(edge, edge)?;
        let image = Resampler::new(&world, &target).render(light.texels());
        let path = folder.join(format!("{}.png", face.name()));
        write(&path, &image.to_codes(file.image.depth(), &Transfer::Srgb), &WriteOptions::default())?;
    }
    Ok(())
}
