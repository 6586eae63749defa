//! Renders the demo world's six cube faces, a panorama and a fulldome picture into a folder.
//!
//! `cargo run --release -p cosmorama-builtin --example faces -- FOLDER`

use std::path::{Path, PathBuf};
use std::time::Instant;

use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::{Angle, CubeFace, Direction};
use cosmorama_builtin::{DemoWorld, Supersampling, render};
use glam::DVec3;

const FACE: usize = 1024;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "cosmorama-demo".into()));
    std::fs::create_dir_all(&folder)?;
    for face in CubeFace::ALL {
        let unproject = move |x: f64, y: f64| on_face(face, x, y);
        picture(&folder, face.name(), FACE, FACE, unproject)?;
    }
    picture(&folder, "panorama", 2 * FACE, FACE, on_panorama)?;
    picture(&folder, "dome", FACE, FACE, on_dome)
}

fn picture(
    folder: &Path,
    name: &str,
    width: usize,
    height: usize,
    unproject: impl Fn(f64, f64) -> Option<Direction> + Sync,
) -> Result<(), Box<dyn std::error::Error>> {
    let start = Instant::now();
    let image = render(&DemoWorld, width, height, unproject, Supersampling::default());
    let seconds = start.elapsed().as_secs_f64();
    let path = folder.join(name).with_extension("png");
    save(&image, &path)?;
    // An example may talk; the library may not.
    #[allow(clippy::print_stdout)]
    {
        println!("{} in {seconds:.2} s", path.display());
    }
    Ok(())
}

fn on_face(face: CubeFace, x: f64, y: f64) -> Option<Direction> {
    let (right, up) = (2.0 * x / FACE as f64 - 1.0, 1.0 - 2.0 * y / FACE as f64);
    Direction::new(DVec3::new(right, up, -1.0)).map(|direction| face.orientation().to_world(direction))
}

fn on_panorama(x: f64, y: f64) -> Option<Direction> {
    let longitude = Angle::HALF_TURN * (x / FACE as f64 - 1.0);
    let latitude = Angle::HALF_TURN * (0.5 - y / FACE as f64);
    Some(Direction::from_longitude_latitude(longitude, latitude))
}

/// An equidistant fisheye of 180° that looks 30° above the front.
fn on_dome(x: f64, y: f64) -> Option<Direction> {
    let (right, up) = (2.0 * x / FACE as f64 - 1.0, 1.0 - 2.0 * y / FACE as f64);
    let radius = right.hypot(up);
    if radius > 1.0 {
        return None;
    }
    let (sine, cosine) = (radius * std::f64::consts::FRAC_PI_2).sin_cos();
    let scale = if radius > 0.0 { sine / radius } else { 0.0 };
    let tilt = cosmorama::sphere::Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::from_degrees(30.0), Angle::ZERO);
    Direction::new(DVec3::new(right * scale, up * scale, -cosine)).map(|direction| tilt.to_world(direction))
}

fn save(image: &Image<Rgba>, path: &Path) -> Result<(), image::ImageError> {
    let bytes: Vec<u8> = image
        .pixels()
        .iter()
        .flat_map(|pixel| {
            let [red, green, blue] = pixel.unpremultiplied().map(srgb);
            [red, green, blue, (pixel.alpha() * 255.0).round() as u8]
        })
        .collect();
    image::save_buffer(path, &bytes, image.width() as u32, image.height() as u32, image::ColorType::Rgba8)
}

fn srgb(light: f32) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let code = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (code * 255.0).round() as u8
}
