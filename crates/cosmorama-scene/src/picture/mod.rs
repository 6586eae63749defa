//! Whole pictures of scenes.

mod cell;
mod marks;
mod occlusion;
mod sampled;
mod small;
mod tiles;

use cosmorama::camera::{Footprint, PixelPoint};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use rayon::prelude::*;

use crate::camera::Camera;
use crate::error::SceneError;
use crate::scene::{Object, Scene};
use crate::shade::{Detail, Surroundings};

use cell::Pixel;
use marks::Marks;
use occlusion::grain;
use small::Reflection;
use tiles::{SIDE, Tile};

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

/// Makes the picture of a scene, in linear light premultiplied by alpha. The first world is seen behind the things.
///
/// Each pixel sees one cell, or several where an outline crosses it or where curvature shows it much of the world at
/// once. Each cell is one average. Where edges of meshes cross a pixel, many rays tell what each surface covers of it.
/// What balls of few pixels reflect is the sum over parts of the world. The result does not depend on the number of
/// threads.
///
/// # Errors
/// When the scene is out of range, a world is missing, or has no maps of light for the materials under it.
pub fn picture(
    scene: &Scene,
    camera: &Camera,
    worlds: &[Surroundings],
    background: Background,
) -> Result<Image<Rgba>, SceneError> {
    let behind = worlds.first().ok_or(SceneError::NoWorld { number: 0, count: 0 })?;
    picture_over(scene, camera, worlds, backdrop(camera, behind, background))
}

/// Makes the picture of a scene as [`picture`] does, over a [`backdrop`] of the same camera. Of things that are turned it is the
/// same for all pictures.
///
/// # Errors
/// When the scene is out of range, a world is missing, or has no maps of light for the materials under it.
///
/// # Panics
/// When the backdrop has not the size of the camera's picture.
pub fn picture_over(
    scene: &Scene,
    camera: &Camera,
    worlds: &[Surroundings],
    mut image: Image<Rgba>,
) -> Result<Image<Rgba>, SceneError> {
    assert_eq!((image.width(), image.height()), (camera.width(), camera.height()), "a backdrop of the camera");
    scene.check()?;
    let most = scene.parts().map(|part| part.world).max().unwrap_or(0);
    let (Some(behind), true) = (worlds.first(), most < worlds.len()) else {
        return Err(SceneError::NoWorld { number: most, count: worlds.len() });
    };
    worlds.iter().enumerate().try_for_each(|(number, world)| world.check(scene, number))?;
    // Things stay, and the camera turns the other way.
    let camera = &camera.turned(&behind.turn().transpose());
    let width = camera.width();
    let reflection = |object: &Object| Reflection::of(object, camera, &worlds[object.parts.first()?.world]);
    let reflections: Vec<Option<Reflection>> = scene.objects.iter().map(reflection).collect();
    let marks = Marks::of(scene, camera);
    let pixel = Pixel { scene, camera, worlds, reflections: &reflections, marks: &marks, grain: grain(scene) };
    let rows = image.pixels_mut().par_chunks_mut((width * SIDE).max(1));
    rows.enumerate().for_each(|(row, pixels)| {
        let top = row * SIDE;
        let tiles: Vec<Tile> = Tile::row(camera, top).collect();
        let seen = |tile: &Tile| {
            let things = tile.things(scene, camera);
            if things.is_empty() { Vec::new() } else { pixel.tile(tile, &things) }
        };
        let made: Vec<([usize; 2], Rgba)> = tiles.par_iter().flat_map_iter(seen).collect();
        for ([i, j], thing) in made {
            let behind = &mut pixels[(j - top) * width + i];
            *behind = thing.over(*behind);
        }
    });
    Ok(image)
}

/// Makes the picture without things.
pub fn backdrop(camera: &Camera, surroundings: &Surroundings, background: Background) -> Image<Rgba> {
    match (background, camera) {
        (Background::World, Camera::Lens { .. }) if !surroundings.is_far() => near_world(camera, surroundings),
        (Background::World, Camera::Lens { view, .. }) => {
            let sky = surroundings.sky;
            let resampler = Resampler { world: sky.world, target: view, filter: surroundings.filter };
            let mut image = match surroundings.filter.has_tables() {
                true => cosmorama::render::picture(surroundings.prepared(), view),
                false => resampler.render(sky.light.texels()),
            };
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

/// Makes the picture of a world whose walls are near.
fn near_world(camera: &Camera, surroundings: &Surroundings) -> Image<Rgba> {
    let width = camera.width();
    let mut image = Image::filled(width, camera.height(), Rgba::TRANSPARENT);
    image.pixels_mut().par_chunks_mut(width).enumerate().for_each(|(j, row)| {
        for (i, pixel) in row.iter_mut().enumerate() {
            if let Some(ray) = camera.ray(PixelPoint::centre(i, j)) {
                *pixel = surroundings.seen(&ray) * camera.coverage(i, j) as f32;
            }
        }
    });
    image
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
