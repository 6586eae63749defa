//! Spheres of a few pixels under a real sky, against thousands of samples a pixel.

use cosmorama::camera::PixelPoint;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::prelude::*;
use cosmorama_io::{Limits, read};
use cosmorama_scene::{
    Background, Camera, Finish, LightMaps, Material, Object, Orthographic, Paint, Place, Scene, SceneError, Sky,
    Sphere, Surroundings, picture,
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

/// Parts of a texel's tent along its sides.
const PARTS: usize = 6;

/// A camera of parallel rays, pixels of a size of 1.
fn camera() -> Camera {
    let place = Place { eye: DVec3::new(0.0, 0.0, 50.0), target: DVec3::ZERO };
    Camera::Orthographic(Orthographic::new(place, SIDE as f64, [SIDE, SIDE]).unwrap())
}

fn ball(diameter: f64, at: [f64; 2], material: Material) -> Scene {
    let sphere = Sphere::new(DVec3::new(at[0], at[1], 0.0), 0.5 * diameter);
    Scene { objects: vec![Object::sphere(sphere, material)] }
}

fn made(scene: &Scene, sky: Sky, filter: FilterSettings) -> Image<Rgba> {
    let maps = LightMaps::of(scene, 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, filter).unwrap();
    picture(scene, &camera(), &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap()
}

/// Computes what a mirror shows by throwing all texels, each in parts, to where it shows them: more than thousands of
/// samples a pixel, since none is missed. Seen from far away equal parts of the world have equal areas, a quarter of a
/// unit disc's for each steradian. Parts are those of a tent over the texel and its neighbours: bilinear interpolation.
fn brute(diameter: f64, at: [f64; 2], (world, light): (&World, &Light)) -> Image<Rgba> {
    let (half, radius) = (SIDE as f64 / 2.0, 0.5 * diameter);
    let mut sums = vec![[0.0; 4]; SIDE * SIDE];
    let angles: Vec<f32> = world.solid_angles().collect();
    let view = &world.sources()[0].view;
    let tent: Vec<(f64, f64)> = (0..PARTS)
        .map(|k| (2.0 * k as f64 + 1.0) / PARTS as f64 - 1.0)
        .map(|offset| (offset, (1.0 - offset.abs()) * 2.0 / PARTS as f64))
        .collect();
    for (texel, (light, angle)) in light.texels().iter().zip(angles).enumerate() {
        let [i, j] = [texel % view.width(), texel / view.width()];
        for (across, down) in tent.iter().flat_map(|across| tent.iter().map(move |down| (across, down))) {
            let place = PixelPoint::new(i as f64 + 0.5 + across.0, j as f64 + 0.5 + down.0);
            let Some(seen) = view.direction(place) else { continue };
            // The mirrored view −Z: 2 z n − Z.
            let normal = (seen.vector() + DVec3::Z).normalize();
            let (x, y) = (normal.x * radius + at[0] + half, half - normal.y * radius - at[1]);
            let weight = f64::from(angle) * across.1 * down.1 * 0.25 * radius * radius;
            let sum = &mut sums[y as usize * SIDE + x as usize];
            (0..4).for_each(|k| sum[k] += weight * f64::from(light.0[k]));
        }
    }
    Image::from_fn(SIDE, SIDE, |i, j| Rgba(sums[j * SIDE + i].map(|sum| sum as f32)))
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
    for (k, name) in SKIES.into_iter().enumerate() {
        let Some((world, light)) = sky(name) else { return };
        // All sizes under one sky; under the others the ends.
        for &diameter in if k == 0 { &[1.0, 2.0, 4.0, 8.0][..] } else { &[1.0, 8.0] } {
            let at = [0.3, -0.2];
            let expected = brute(diameter, at, (&world, &light));
            let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
            let found = made(&ball(diameter, at, Material::MIRROR), Sky::new(&world, &light), filter);
            let error = error(&found, &expected);
            println!("{name}, {diameter} px: {error:.4}");
            assert!(error < 0.008, "{name}, {diameter} px: {error:.4}");
        }
    }
}

#[test]
fn a_sphere_that_moves_by_parts_of_a_pixel_does_not_flicker() {
    for (k, name) in SKIES.into_iter().enumerate() {
        let Some((world, light)) = sky(name) else { return };
        for &diameter in if k == 0 { &[1.0, 2.0][..] } else { &[1.0] } {
            let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
            let total = |k: usize| -> f64 {
                let at = [0.23 * k as f64, -0.13 * k as f64];
                let made = made(&ball(diameter, at, Material::MIRROR), Sky::new(&world, &light), filter);
                made.pixels().iter().map(|pixel| f64::from(pixel.0[1])).sum()
            };
            let totals: Vec<f64> = (0..5).map(total).collect();
            let mean = totals.iter().sum::<f64>() / totals.len() as f64;
            let square = totals.iter().map(|total| (total / mean - 1.0).powi(2)).sum::<f64>() / totals.len() as f64;
            println!("{name}, {diameter} px: deviation {:.5}", square.sqrt());
            assert!(square.sqrt() < 0.001, "{name}, {diameter} px: {:.5}", square.sqrt());
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

#[test]
fn maps_of_another_scene_are_refused() {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::BLACK)).unwrap();
    let sky = Sky::new(&world, &light);
    let maps = LightMaps::of(&Scene::sphere(Material::MIRROR), 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap();
    for material in [Material::MATTE, Material { alpha: 0.3, ..Material::MIRROR }] {
        let made = picture(
            &Scene::sphere(material.clone()),
            &camera(),
            std::slice::from_ref(&surroundings),
            Background::World,
        );
        assert!(matches!(made, Err(SceneError::NoMap(_))), "{material:?}");
    }
}

/// A ball that sends out light of one colour, and reflects none.
fn lamp(centre: [f64; 3], radius: f64, colour: [f64; 3]) -> Object {
    let dark = Finish { base: Paint::plain([0.0; 3]), specular: 0.0, ..Finish::default() };
    let material = Material::of(Finish { emissive: Paint::plain(colour), ..dark });
    Object::sphere(Sphere::new(centre.into(), radius), material)
}

#[test]
fn the_nearer_of_two_surfaces_is_seen_even_where_balls_overlap() {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::BLACK)).unwrap();
    let made = |objects: Vec<Object>| made(&Scene { objects }, Sky::new(&world, &light), FilterSettings::DEFAULT);
    let whole = lamp([0.0; 3], 4.0, [1.0, 0.0, 0.0]);
    // Wholly inside, with its centre nearer to the eye.
    let hidden = lamp([0.5, 0.3, 2.0], 1.2, [0.0, 1.0, 0.0]);
    assert_eq!(made(vec![hidden, whole.clone()]).pixels(), made(vec![whole.clone()]).pixels());
    // A small ball that comes out of a large one, and whose centre is farther away.
    let (centre, radius) = (DVec3::new(2.0, 0.0, -0.2), 4.1);
    let image = made(vec![whole, lamp(centre.to_array(), radius, [0.0, 1.0, 0.0])]);
    let height = |x: f64, y: f64, centre: DVec3, radius: f64| {
        let square = radius * radius - (x - centre.x).powi(2) - (y - centre.y).powi(2);
        // Away from its outline.
        (square > 5.8).then(|| centre.z + square.sqrt())
    };
    let mut count = 0;
    for (i, j) in (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE)) {
        let (x, y) = (i as f64 + 0.5 - 6.0, 6.0 - j as f64 - 0.5);
        let Some((red, green)) = height(x, y, DVec3::ZERO, 4.0).zip(height(x, y, centre, radius)) else { continue };
        if (red - green).abs() > 0.3 {
            let expected = if red > green { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
            assert_eq!(image.get(i, j).0[..3], expected, "{i}, {j}");
            count += 1;
        }
    }
    assert!(count > 10, "{count} pixels");
}

#[test]
fn balls_that_are_none_are_refused() {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::BLACK)).unwrap();
    let sky = Sky::new(&world, &light);
    let maps = LightMaps::of(&Scene::sphere(Material::MIRROR), 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap();
    for (centre, radius) in [([0.0; 3], 0.0), ([0.0; 3], -1.0), ([0.0; 3], f64::NAN), ([f64::INFINITY, 0.0, 0.0], 1.0)]
    {
        let scene = Scene { objects: vec![Object::sphere(Sphere::new(centre.into(), radius), Material::MIRROR)] };
        let made = picture(&scene, &camera(), std::slice::from_ref(&surroundings), Background::World);
        assert!(matches!(made, Err(SceneError::Ball { .. })), "{centre:?}, {radius}");
    }
}
