//! Rough metal against many rays and sums over all texels.

use cosmorama::camera::PixelPoint;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::lighting::{AllTexels, BrdfModel, Lobe, LobeAverages};
use cosmorama::prelude::*;
use cosmorama_scene::{
    Background, Camera, Finish, LightMaps, Material, Object, Ray, Scene, Sky, Sphere, Surroundings, picture,
};
use glam::DVec3;

use crate::meshes::{lens, light};

const ROUGHNESS: f64 = 0.3;
const SIDE: usize = 24;

/// Rays along a side of a pixel.
const RAYS: usize = 4;

/// A panorama of few texels, all of which are summed for each ray.
fn sky() -> (World, Light) {
    let view = CameraModel::from(EquirectCamera::default()).view(128, 64).unwrap();
    let texel = |i, j| {
        let [red, green, blue] = light(view.direction(PixelPoint::centre(i, j)).unwrap().vector());
        Rgba::opaque(red, green, blue)
    };
    World::from_panorama(Image::from_fn(128, 64, texel)).unwrap()
}

/// Returns the normal where a ray meets the ball of radius 1.
fn met(ray: &Ray) -> Option<DVec3> {
    let (along, squared) = (ray.origin.dot(ray.direction), ray.origin.length_squared() - 1.0);
    let root = (along * along - squared).max(0.0).sqrt();
    (root > 0.0).then(|| ray.origin - ray.direction * (along + root))
}

/// Returns what a pixel shows; `None` where not all of its rays meet the ball.
fn by_rays(camera: &Camera, [i, j]: [usize; 2], all: &AllTexels) -> Option<[f64; 3]> {
    let (alpha, mut sum) = (ROUGHNESS * ROUGHNESS, [0.0; 3]);
    let lobe = Lobe::ggx(alpha).unwrap();
    for k in 0..RAYS * RAYS {
        let part = |k: usize| (k as f64 + 0.5) / RAYS as f64;
        let ray = camera.ray(PixelPoint::new(i as f64 + part(k % RAYS), j as f64 + part(k / RAYS)))?;
        let normal = met(&ray)?;
        let facing = -normal.dot(ray.direction);
        let albedo = BrdfModel::Ggx.albedo(facing, alpha);
        let mirrored = Direction::new(ray.direction + normal * (2.0 * facing)).unwrap();
        let Rgba(seen) = all.average(mirrored, &lobe);
        (0..3).for_each(|k| sum[k] += f64::from(seen[k]) * (albedo.scale + albedo.bias));
    }
    Some(sum.map(|sum| sum / (RAYS * RAYS) as f64))
}

/// Compares white metal with rays that each see the sum over all texels under the lobe: the same model, in which the surface is seen
/// from the front, without maps, tables and footprints.
#[test]
fn rough_metal_is_what_rays_and_all_texels_make() {
    let (world, light) = sky();
    let (sky, camera) = (Sky::new(&world, &light), lens([0.4, 1.0, 4.0], 34.0, (SIDE, SIDE)));
    let metal = Material::of(Finish { metallic: 1.0, roughness: ROUGHNESS, ..Finish::default() });
    let scene = Scene { objects: vec![Object::sphere(Sphere::new(DVec3::ZERO, 1.0), metal)] };
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
    let surroundings = Surroundings::new(sky, &maps, filter).unwrap();
    let made = picture(&scene, &camera, &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap();
    let all = AllTexels::new(&world, &light).unwrap();
    let (mut squares, mut count) = (0.0, 0);
    for at in (0..SIDE * SIDE).map(|k| [k % SIDE, k / SIDE]) {
        let Some(expected) = by_rays(&camera, at, &all) else { continue };
        let found = made.get(at[0], at[1]);
        squares += (0..3).map(|k| (f64::from(found.0[k]) - expected[k]).powi(2)).sum::<f64>();
        count += 3;
    }
    let decibels = -10.0 * (squares / f64::from(count)).log10();
    println!("{decibels:.1} dB of {count} samples");
    assert!(count > 500 && decibels > 50.0, "{decibels:.1} dB of {count} samples");
}
