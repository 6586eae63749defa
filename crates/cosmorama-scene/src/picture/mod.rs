//! Whole pictures of scenes.

mod cell;
mod marks;
mod sampled;
mod small;
mod tiles;

use cosmorama::camera::Footprint;
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use rayon::prelude::*;

use crate::camera::Camera;
use crate::error::SceneError;
use crate::scene::Scene;
use crate::shade::{Detail, Surroundings};

use cell::Pixel;
use marks::Marks;
use small::Reflection;
use tiles::Tile;

/// Middles of a square's quarters, in parts of its side.
const QUARTERS: [(f64, f64); 4] = [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)];

/// Light beside the things.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// The world.
    World,
    /// One colour, perhaps transparent, in linear light premultiplied by alpha.
    Colour(Rgba),
}

/// Makes the picture of a scene, in linear light premultiplied by alpha.
///
/// Each pixel sees one cell, or several where an outline crosses it or where curvature shows it much of the world at
/// once. Each cell is one average. Where edges of meshes cross a pixel, many rays tell what each surface covers of it. What balls of few pixels reflect is the sum over parts of the world. The result does
/// not depend on the number of threads.
///
/// # Errors
/// When the surroundings have no maps of light for the scene's materials.
pub fn picture(
    scene: &Scene,
    camera: &Camera,
    surroundings: &Surroundings,
    background: Background,
) -> Result<Image<Rgba>, SceneError> {
    surroundings.check(scene)?;
    let mut image = backdrop(camera, surroundings, background);
    let width = camera.width();
    let seen = Tile::all(camera).map(|tile| (tile, tile.things(scene, camera)));
    let seen: Vec<(Tile, Vec<usize>)> = seen.filter(|(_, things)| !things.is_empty()).collect();
    let reflection = |object| Reflection::of(object, camera, surroundings);
    let reflections: Vec<Option<Reflection>> = scene.objects.iter().map(reflection).collect();
    let marks = Marks::of(scene, camera);
    let pixel = Pixel { scene, camera, surroundings, reflections: &reflections, marks: &marks };
    let made: Vec<([usize; 2], Rgba)> =
        seen.par_iter().flat_map_iter(|(tile, things)| pixel.tile(tile, things)).collect();
    for ([i, j], thing) in made {
        let behind = &mut image.pixels_mut()[j * width + i];
        *behind = thing.over(*behind);
    }
    Ok(image)
}

/// Makes the picture without things.
fn backdrop(camera: &Camera, surroundings: &Surroundings, background: Background) -> Image<Rgba> {
    match (background, camera) {
        (Background::World, Camera::Lens { view, .. }) => {
            let sky = surroundings.sky;
            let resampler = Resampler { world: sky.world, target: view, filter: surroundings.filter };
            let mut image = resampler.render(sky.light.texels());
            if let Some(unseen) = sky.unseen {
                lay_within(camera, &mut image, unseen);
            }
            image
        }
        (Background::World, Camera::Orthographic(parallel)) => {
            let light = surroundings.world(&Footprint::point(parallel.direction()), Detail::Pixel);
            Image::filled(camera.width(), camera.height(), light)
        }
        (Background::Colour(colour), _) => {
            Image::from_fn(camera.width(), camera.height(), |i, j| colour * camera.coverage(i, j) as f32)
        }
    }
}

/// Lays a colour under a picture, inside the lens.
fn lay_within(camera: &Camera, image: &mut Image<Rgba>, colour: Rgba) {
    let width = camera.width().max(1);
    for (k, pixel) in image.pixels_mut().iter_mut().enumerate() {
        let shown = camera.coverage(k % width, k / width) as f32;
        if pixel.alpha() < shown {
            *pixel = pixel.over(colour * shown);
        }
    }
}
