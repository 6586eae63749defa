//! Six faces of a cube become a domemaster, tilted as a theatre's dome is.
//!
//! `cargo run -p cosmorama-io --example cube_to_dome -- 'faces/{face}.png' dome.png`; without arguments it makes faces of its own.
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;
use std::path::Path;

use cosmorama::prelude::*;
use cosmorama_io::{FaceSet, Limits, WriteOptions, write};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    if let (Some(pattern), Some(dome)) = (arguments.next(), arguments.next()) {
        return cube_to_dome(&pattern, Path::new(&dome));
    }
    let folder = tempfile::tempdir()?;
    let pattern = write_faces(folder.path())?;
    let dome = folder.path().join("dome.png");
    cube_to_dome(&pattern, &dome)?;
    println!("{} bytes of dome", std::fs::metadata(&dome)?.len());
    Ok(())
}

/// Reads faces by pattern, whatever tool named and turned them, and writes a dome of 1024 × 1024 pixels.
fn cube_to_dome(pattern: &str, dome: &Path) -> Result<(), Box<dyn Error>> {
    let faces = FaceSet::find(pattern, None)?.read_all(&Limits::default())?;
    let (world, light) = World::from_cube(faces.to_light(), faces.samples)?;
    let camera = FulldomeCamera { tilt: Angle::from_degrees(20.0), ..FulldomeCamera::default() };
    let target = CameraModel::from(camera).view(1024, 1024)?;
    world.require(&target)?;
    let image = Resampler::new(&world, &target).render(light.texels());
    write(dome, &image.to_codes(Depth::Eight, &Transfer::Srgb), &WriteOptions::default())?;
    Ok(())
}

/// Writes six faces whose colours are their directions; returns their pattern.
fn write_faces(folder: &Path) -> Result<String, Box<dyn Error>> {
    for face in CubeFace::ALL {
        let camera = Placement { orientation: face.orientation(), ..Placement::new(CameraModel::from(CubeFaceCamera)) };
        let view = camera.view(128, 128)?;
        let light = Image::from_fn(128, 128, |i, j| {
            let seen = view.direction(PixelPoint::centre(i, j)).map_or([0.0; 3], |d| d.vector().to_array());
            Rgba::opaque(seen[0] as f32 * 0.5 + 0.5, seen[1] as f32 * 0.5 + 0.5, seen[2] as f32 * 0.5 + 0.5)
        });
        let file = folder.join(format!("{}.png", face.name()));
        write(&file, &light.to_codes(Depth::Eight, &Transfer::Srgb), &WriteOptions::default())?;
    }
    Ok(format!("{}/{{face}}.png", folder.display()))
}
