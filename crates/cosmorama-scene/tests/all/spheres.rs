//! Spheres of a few pixels under a real sky, against thousands of samples a pixel.

use cosmorama::filter::{Bilinear, Filter, FilterKind, FilterSettings};
use cosmorama::prelude::*;
use cosmorama_io::{Limits, read};
use cosmorama_scene::{
    Background, Camera, LightMaps, Material, Object, Orthographic, Place, Scene, Sky, Sphere, Surroundings, picture,
};
use glam::DVec3;

const SKIES: [&str; 3] = ["polyhaven_adams_place_bridge_1k.hdr", "polyhaven_noon_grass_1k.hdr", "blender_sunset.exr"];

fn sky(name: &str) -> Option<(World, Light)> {
    let path = testkit::shared("data/equirect_hdr")?.join(name);
    let image = read(path, &Limits::NONE).unwrap().image.to_light(&Transfer::Linear);
    Some(World::from_panorama(image).unwrap())
}

/// Side of the pictures, in pixels.
const SIDE: usize = 12;

/// A camera of parallel rays, pixels of a size of 1.
fn camera() -> Camera {
    let place = Place { eye: DVec3::new(0.0, 0.0, 50.0), target: DVec3::ZERO };
    Camera::Orthographic(Orthographic::new(place, SIDE as f64, [SIDE, SIDE]).unwrap())
}

fn ball(diameter: f64, at: [f64; 2], material: Material) -> Scene {
    let sphere = Sphere::new(DVec3::new(at[0], at[1], 0.0), 0.5 * diameter);
    Scene { objects: vec![Object { sphere, material }] }
}

fn made(scene: &Scene, sky: Sky, filter: FilterSettings) -> Image<Rgba> {
    let maps = LightMaps::of(scene, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, filter).unwrap();
    picture(scene, &camera(), &surroundings, Background::Colour(Rgba::TRANSPARENT))
}

/// The mean of so many samples along a pixel's side, each a texel that a mirror shows.
fn brute(diameter: f64, at: [f64; 2], (world, light): (&World, &Light), samples: usize) -> Image<Rgba> {
    let texels = Bilinear.prepare(world, light).unwrap();
    Image::from_fn(SIDE, SIDE, |i, j| {
        let mut sum = [0.0; 4];
        for k in 0..samples * samples {
            let within = |k: usize| (k as f64 + 0.5) / samples as f64;
            let half = SIDE as f64 / 2.0;
            let x = (i as f64 + within(k % samples) - half - at[0]) / (0.5 * diameter);
            let y = (half - j as f64 - within(k / samples) - at[1]) / (0.5 * diameter);
            let square = 1.0 - x * x - y * y;
            if square <= 0.0 {
                continue;
            }
            // The mirrored view −Z: 2 z n − Z.
            let normal = DVec3::new(x, y, square.sqrt());
            let seen = Direction::new(2.0 * normal.z * normal - DVec3::Z).unwrap();
            let light = texels.average(&Footprint::point(seen)).0;
            (0..4).for_each(|k| sum[k] += f64::from(light[k]));
        }
        Rgba(sum.map(|sum| (sum / (samples * samples) as f64) as f32))
    })
}

/// Root mean square of the differences of all pixels, as a part of the root mean square light.
fn error(found: &Image<Rgba>, expected: &Image<Rgba>) -> f64 {
    let pairs = || {
        found
            .pixels()
            .iter()
            .zip(expected.pixels())
            .flat_map(|(a, b)| (0..3).map(|k| (f64::from(a.0[k]), f64::from(b.0[k]))))
    };
    let squares: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
    (squares / pairs().map(|(_, b)| b * b).sum::<f64>()).sqrt()
}

#[test]
fn spheres_of_a_few_pixels_match_many_samples() {
    for name in SKIES {
        let Some((world, light)) = sky(name) else { return };
        for diameter in [1.0, 2.0, 4.0, 8.0] {
            let at = [0.3, -0.2];
            // So many that they meet each texel: of a sky with a sun, 64 of them err by several per cent themselves.
            let samples = if diameter < 3.0 { 512 } else { 128 };
            let expected = brute(diameter, at, (&world, &light), samples);
            let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
            let found = made(&ball(diameter, at, Material::MIRROR), Sky::new(&world, &light), filter);
            let error = error(&found, &expected);
            println!("{name}, {diameter} px: {error:.4}");
            assert!(error < 0.01, "{name}, {diameter} px: {error:.4}");
        }
    }
}

#[test]
fn a_sphere_that_moves_by_parts_of_a_pixel_does_not_flicker() {
    for name in SKIES {
        let Some((world, light)) = sky(name) else { return };
        for diameter in [1.0, 2.0, 4.0] {
            let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
            let total = |k: usize| -> f64 {
                let at = [0.13 * k as f64, -0.07 * k as f64];
                let made = made(&ball(diameter, at, Material::MIRROR), Sky::new(&world, &light), filter);
                made.pixels().iter().map(|pixel| f64::from(pixel.0[1])).sum()
            };
            let totals: Vec<f64> = (0..8).map(total).collect();
            let mean = totals.iter().sum::<f64>() / totals.len() as f64;
            let square = totals.iter().map(|total| (total / mean - 1.0).powi(2)).sum::<f64>() / totals.len() as f64;
            println!("{name}, {diameter} px: deviation {:.5}", square.sqrt());
            assert!(square.sqrt() < 0.01, "{name}, {diameter} px: {:.5}", square.sqrt());
        }
    }
}

#[test]
fn glass_in_a_world_of_one_colour_is_not_seen() {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.25, 0.5, 1.0))).unwrap();
    for diameter in [2.0, 9.0] {
        let scene = ball(diameter, [0.2, 0.1], Material::GLASS);
        let found = made(&scene, Sky::new(&world, &light), FilterSettings::DEFAULT);
        for Rgba([red, _, blue, alpha]) in found.pixels() {
            assert!((red - 0.25 * alpha).abs() < 1e-4 && (blue - alpha).abs() < 1e-4, "{red}, {blue} of {alpha}");
        }
        let area: f64 = found.pixels().iter().map(|pixel| f64::from(pixel.alpha())).sum();
        let expected = std::f64::consts::PI * (0.5 * diameter).powi(2);
        assert!((area / expected - 1.0).abs() < 2e-3, "{area} for {expected}");
    }
}
