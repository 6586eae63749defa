//! Rough metal against many rays and sums over all texels.

use std::f64::consts::TAU;

use cosmorama::camera::PixelPoint;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::lighting::{AllTexels, Lobe, LobeAverages};
use cosmorama::prelude::*;
use cosmorama_scene::{
    Background, Camera, Finish, LightMaps, Material, Object, Ray, Scene, Sky, Sphere, Surroundings, picture,
};
use glam::DVec3;

use crate::meshes::{lens, light};

const ALPHA: f64 = 0.09;
const SIDE: usize = 24;

/// Rays along a side of a pixel.
const RAYS: usize = 4;

/// Texels of a panorama across, few enough to be summed for each ray.
const FEW: usize = 128;

/// Returns a panorama.
fn sky(width: usize) -> (World, Light) {
    let view = CameraModel::from(EquirectCamera::default()).view(width, width / 2).unwrap();
    let texel = |i, j| {
        let [red, green, blue] = light(view.direction(PixelPoint::centre(i, j)).unwrap().vector());
        Rgba::opaque(red, green, blue)
    };
    World::from_panorama(Image::from_fn(width, width / 2, texel)).unwrap()
}

/// Returns the normal where a ray meets the ball of radius 1.
fn met(ray: &Ray) -> Option<DVec3> {
    let (along, squared) = (ray.origin.dot(ray.direction), ray.origin.length_squared() - 1.0);
    let root = (along * along - squared).max(0.0).sqrt();
    (root > 0.0).then(|| ray.origin - ray.direction * (along + root))
}

/// Returns the mean of what the rays of a pixel see where they meet the ball, by their directions and its normals; `None` where not
/// all of them meet it.
fn by_rays(camera: &Camera, [i, j]: [usize; 2], seen: impl Fn(DVec3, DVec3) -> [f64; 3]) -> Option<[f64; 3]> {
    let mut sum = [0.0; 3];
    for k in 0..RAYS * RAYS {
        let part = |k: usize| (k as f64 + 0.5) / RAYS as f64;
        let ray = camera.ray(PixelPoint::new(i as f64 + part(k % RAYS), j as f64 + part(k / RAYS)))?;
        let light = seen(ray.direction, met(&ray)?);
        (0..3).for_each(|k| sum[k] += light[k]);
    }
    Some(sum.map(|sum| sum / (RAYS * RAYS) as f64))
}

/// Returns the dB between a ball's picture and what rays see.
fn decibels((world, light): &(World, Light), material: Material, seen: impl Fn(DVec3, DVec3) -> [f64; 3]) -> f64 {
    let (sky, camera) = (Sky::new(world, light), lens([0.4, 1.0, 4.0], 34.0, (SIDE, SIDE)));
    let scene = Scene { objects: vec![Object::sphere(Sphere::new(DVec3::ZERO, 1.0), material)] };
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
    let surroundings = Surroundings::new(sky, &maps, filter).unwrap();
    let made = picture(&scene, &camera, &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap();
    let (mut squares, mut count) = (0.0, 0);
    for at in (0..SIDE * SIDE).map(|k| [k % SIDE, k / SIDE]) {
        let Some(expected) = by_rays(&camera, at, &seen) else { continue };
        let found = made.get(at[0], at[1]);
        squares += (0..3).map(|k| (f64::from(found.0[k]) - expected[k]).powi(2)).sum::<f64>();
        count += 3;
    }
    assert!(count > 500, "{count} samples");
    -10.0 * (squares / f64::from(count)).log10()
}

/// Compares a rough reflection with rays that each see the sum over all texels under the lobe: the same model, in which the surface is
/// seen from the front, without maps and footprints.
#[test]
fn rough_reflections_are_what_rays_and_all_texels_make() {
    let sky = sky(FEW);
    let (all, lobe) = (AllTexels::new(&sky.0, &sky.1).unwrap(), Lobe::ggx(ALPHA).unwrap());
    let decibels = decibels(&sky, Material { alpha: ALPHA, ..Material::MIRROR }, |ray, normal| {
        let mirrored = Direction::new(ray - normal * (2.0 * normal.dot(ray))).unwrap();
        let Rgba([red, green, blue, _]) = all.average(mirrored, &lobe);
        [red, green, blue].map(f64::from)
    });
    println!("{decibels:.1} dB");
    assert!(decibels > 50.0, "{decibels:.1} dB");
}

/// Compares white metal with rays that each meet many facets: without maps, tables and footprints.
#[test]
fn rough_metal_is_what_rays_and_facets_make() {
    let metal = Material::of(Finish { metallic: 1.0, roughness: ALPHA.sqrt(), ..Finish::default() });
    let decibels = decibels(&sky(8 * FEW), metal, |ray, normal| by_facets(normal, -ray));
    println!("{decibels:.1} dB");
    assert!(decibels > 44.0, "{decibels:.1} dB");
}

/// Returns the light that white facets reflect to the eye, by samples of their normals h, of the distribution of Trowbridge and Reitz:
/// light comes from 2(v·h)h − v, and counts by G·(v·h)/((n·v)(n·h)) (Walter et al., *Microfacet models for refraction*, 2007, equations 35,
/// 36 and 41), with Smith's height-correlated masking G (Heitz 2014, equation 99).
fn by_facets(normal: DVec3, eye: DVec3) -> [f64; 3] {
    const SAMPLES: usize = 48;
    let smith = |cosine: f64| 0.5 * ((1.0 + ALPHA * ALPHA * (cosine.powi(-2) - 1.0)).sqrt() - 1.0);
    let ((right, up), facing) = (normal.any_orthonormal_pair(), normal.dot(eye));
    let mut sum = [0.0; 3];
    for k in 0..SAMPLES * SAMPLES {
        let [part, around] = [k % SAMPLES, k / SAMPLES].map(|k| (k as f64 + 0.5) / SAMPLES as f64);
        let (slope, (sin, cos)) = (ALPHA * (part / (1.0 - part)).sqrt(), (TAU * around).sin_cos());
        let half = (normal + (right * cos + up * sin) * slope).normalize();
        let towards = half * (2.0 * eye.dot(half)) - eye;
        let cosine = normal.dot(towards);
        if cosine > 0.0 {
            let weight = eye.dot(half) / ((1.0 + smith(cosine) + smith(facing)) * facing * normal.dot(half));
            let seen = light(towards);
            (0..3).for_each(|k| sum[k] += weight * f64::from(seen[k]));
        }
    }
    sum.map(|sum| sum / (SAMPLES * SAMPLES) as f64)
}
