//! Light that things hide from what is matt.

use std::sync::Arc;

use cosmorama::camera::PixelPoint;
use cosmorama::filter::FilterSettings;
use cosmorama::prelude::*;
use cosmorama_scene::{
    Background, Camera, Face, LightMaps, Material, Mesh, Normals, Object, Part, Place, Scene, Shape, Sky, Sphere,
    Surroundings, picture,
};
use glam::DVec3;

const SIDE: usize = 96;

/// A matt plane at y = 0, and a ball of radius 1 whose centre is two above it.
fn scene() -> Scene {
    let corner = |x: f64, z: f64| DVec3::new(20.0 * x, 0.0, 20.0 * z);
    let face = |corners| Face { corners, normals: None, uvs: None, tangents: None, part: 0 };
    let [a, b, c, d] = [corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)];
    let normals = Normals { kept: false, crease: Angle::from_degrees(10.0) };
    let mesh = Mesh::new(vec![face([a, b, c]), face([a, c, d])], normals).unwrap();
    let part = Part { name: "plane".to_owned(), material: Material::MATTE, world: 0 };
    let plane = Object { shape: Shape::Mesh(Arc::new(mesh)), parts: vec![part] };
    Scene { objects: vec![plane, Object::sphere(Sphere::new(DVec3::new(0.0, 2.0, 0.0), 1.0), Material::MATTE)] }
}

fn camera() -> Camera {
    let place = Place { eye: DVec3::new(1.0, 4.0, 9.0), target: DVec3::new(0.0, 0.5, 0.0) };
    let lens = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(40.0)));
    Camera::lens(place, Placement::new(lens.into()).view(SIDE, SIDE).unwrap()).unwrap()
}

fn made(occlusion: bool) -> Image<Rgba> {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(1.0, 1.0, 1.0))).unwrap();
    let (scene, sky) = (scene(), Sky::new(&world, &light));
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap().with_occlusion(occlusion);
    picture(&scene, &camera(), &[surroundings], Background::Colour(Rgba::BLACK)).unwrap()
}

/// The part of the light that a ball hides from a plane that it stands above is (R/d)²·cos θ, at a distance d of its
/// centre, which is seen at an angle θ from the normal.
#[test]
fn a_ball_hides_its_part_of_the_light_from_a_plane() {
    let (image, camera) = (made(true), camera());
    let (mut squares, mut sum, mut count, mut darkest) = (0.0, 0.0, 0.0, 1.0f64);
    for (i, j) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j))) {
        let ray = camera.ray(PixelPoint::centre(i, j)).unwrap();
        let place = ray.at(-ray.origin.y / ray.direction.y);
        let towards_ball = (DVec3::Y * 2.0 - ray.origin).dot(ray.direction);
        // Pixels that show the ball, or its outline, and places from which the plane cuts it.
        if ray.at(towards_ball).distance(DVec3::Y * 2.0) < 1.15 || place.length() > 3.0 {
            continue;
        }
        let distance = place.distance(DVec3::Y * 2.0);
        let expected = 1.0 - 2.0 / distance.powi(3);
        let error = f64::from(image.get(i, j).0[0]) - expected;
        (squares, sum, count) = (squares + error * error, sum + error, count + 1.0);
        darkest = darkest.min(expected);
    }
    let (rms, mean) = ((squares / count).sqrt(), sum / count);
    println!("{count} pixels: {rms:.4} rms, {mean:.5} on average; the darkest is {darkest:.3}");
    assert!(count > 1000.0 && darkest < 0.8);
    // 64 rays, of which each counts for 1.6 %.
    assert!(rms < 0.016, "{rms}");
    assert!(mean.abs() < 0.001, "{mean}");
}

#[test]
fn nothing_is_hidden_unless_asked_for() {
    let image = made(false);
    let seen = image.get(SIDE / 2, SIDE - 8).0[0];
    assert!((seen - 1.0).abs() < 1e-3, "{seen}");
}

#[test]
fn a_ball_alone_hides_nothing_from_itself() {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(1.0, 1.0, 1.0))).unwrap();
    let (scene, sky) = (Scene::sphere(Material::MATTE), Sky::new(&world, &light));
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap().with_occlusion(true);
    let image = picture(&scene, &camera(), &[surroundings], Background::Colour(Rgba::BLACK)).unwrap();
    let middle = image.get(SIDE / 2, SIDE / 2).0[0];
    assert!((middle - 1.0).abs() < 1e-3, "{middle}");
}
