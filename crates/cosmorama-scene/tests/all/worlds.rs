//! Several worlds, near worlds, and things that are turned: against closed forms.

use cosmorama::prelude::*;
use cosmorama_scene::{
    Background, Camera, LightMaps, Material, Object, Orthographic, Place, Proxy, Scene, SceneError, Sky, Sphere,
    Surroundings, Walls, picture,
};
use glam::DVec3;

const SIDE: usize = 96;

/// A camera of parallel rays along −Z, two units wide.
fn camera() -> Camera {
    let place = Place { eye: DVec3::Z * 50.0, target: DVec3::ZERO };
    Camera::Orthographic(Orthographic::new(place, 2.0, [SIDE, SIDE]).unwrap())
}

/// A panorama whose colours are a formula of the direction.
fn world(colour: impl Fn(DVec3) -> DVec3 + Sync) -> (World, Light) {
    let view = CameraModel::from(EquirectCamera::default()).view(512, 256).unwrap();
    let world = World::new([("sky".to_owned(), view)]).unwrap();
    let light = Light::by_direction(&world, |direction| {
        let [red, green, blue] = colour(direction.vector()).to_array().map(|part| part as f32);
        Rgba::opaque(red, green, blue)
    });
    (world, light)
}

fn ball(centre: DVec3, radius: f64, world: usize) -> Object {
    let mut object = Object::sphere(Sphere::new(centre, radius), Material::MIRROR);
    object.parts[0].world = world;
    object
}

fn under<'a>(scene: &Scene, number: usize, sky: Sky<'a>, maps: &'a LightMaps) -> Surroundings<'a> {
    assert_eq!(scene.objects[0].parts[0].material, Material::MIRROR, "world {number} needs no other maps");
    Surroundings::new(sky, maps, FilterSettings::DEFAULT).unwrap()
}

/// Parts of a pixel along its sides.
const PARTS: usize = 8;

/// Size of the room.
const ROOM: DVec3 = DVec3::new(8.0, 3.0, 6.0);

/// Returns the place on the room's walls from a point inside.
fn on_wall(from: DVec3, towards: DVec3) -> DVec3 {
    let distances = (0.5 * ROOM * towards.signum() - from) / towards;
    from + towards * distances.min_element()
}

/// Colour of the walls.
fn paint(place: DVec3) -> DVec3 {
    DVec3::splat(0.5) + place * 0.1
}

#[test]
fn a_ball_reflects_the_walls_of_a_room_where_they_are() {
    let (room, light) = world(|direction| paint(on_wall(DVec3::ZERO, direction)));
    let (centre, radius) = (DVec3::new(0.2, -0.1, -1.5), 0.7);
    let scene = Scene { objects: vec![ball(centre, radius, 0)] };
    let sky = Sky::new(&room, &light);
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let made = |proxy| {
        let surroundings = under(&scene, 0, sky, &maps).with_proxy(proxy);
        picture(&scene, &camera(), &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap()
    };
    let (near, far) = (made(Some(Proxy { centre: DVec3::ZERO, walls: Walls::Box(ROOM) })), made(None));
    let (mut worst, mut count, mut parallax) = (0.0f64, 0, 0.0f64);
    // The formula's mean over a pixel: the room's corners are seen as edges.
    let formula = |i: usize, j: usize| {
        let at = |k: usize, part: usize| (k as f64 + (part as f64 + 0.5) / PARTS as f64) / SIDE as f64 * 2.0 - 1.0;
        let parts = (0..PARTS * PARTS).map(|part| {
            let aside = DVec3::new(at(i, part % PARTS) - centre.x, -at(j, part / PARTS) - centre.y, 0.0);
            let normal = (aside + DVec3::Z * (radius * radius - aside.length_squared()).sqrt()) / radius;
            paint(on_wall(centre + normal * radius, normal * (2.0 * normal.z) - DVec3::Z))
        });
        parts.sum::<DVec3>() / (PARTS * PARTS) as f64
    };
    for (i, j) in (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE)) {
        let place = |k: usize| (k as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0;
        let aside = DVec3::new(place(i), -place(j), 0.0) - DVec3::new(centre.x, centre.y, 0.0);
        // Towards the outline a pixel sees much of the room.
        if aside.length() > 0.7 * radius {
            continue;
        }
        let expected = formula(i, j);
        let found = |image: &Image<Rgba>| DVec3::from_array(std::array::from_fn(|k| f64::from(image.get(i, j).0[k])));
        worst = worst.max((found(&near) - expected).abs().max_element());
        parallax = parallax.max((found(&far) - expected).abs().max_element());
        count += 1;
    }
    println!("{count} pixels: {worst:.4} from the formula, {parallax:.4} without walls");
    assert!(count > 1000 && worst < 4e-3 && parallax > 0.1, "{count}, {worst}, {parallax}");
}

#[test]
fn each_thing_reflects_its_own_world() {
    let (worlds, half) = ([DVec3::X, DVec3::Y].map(|colour| world(move |_| colour)), 0.4);
    let balls = [ball(DVec3::X * -0.5, half, 0), ball(DVec3::X * 0.5, half, 1)];
    let scene = Scene { objects: balls.to_vec() };
    let skies = [0, 1].map(|k| Sky::new(&worlds[k].0, &worlds[k].1));
    let maps = [0, 1].map(|k| LightMaps::of(&scene, k, skies[k]).unwrap());
    let surroundings = [0, 1].map(|k| under(&scene, k, skies[k], &maps[k]));
    let made = picture(&scene, &camera(), &surroundings, Background::World).unwrap();
    let at = |x: f64| made.get(((x + 1.0) * 0.5 * SIDE as f64) as usize, SIDE / 2).0;
    for (x, expected) in [(-0.5, [1.0, 0.0]), (0.5, [0.0, 1.0]), (-0.98, [1.0, 0.0]), (0.98, [1.0, 0.0])] {
        let found = at(x);
        assert!((found[0] - expected[0]).abs() < 1e-4 && (found[1] - expected[1]).abs() < 1e-4, "{x}: {found:?}");
    }
    let missing = picture(&scene, &camera(), &surroundings[..1], Background::World);
    assert_eq!(missing.unwrap_err(), SceneError::NoWorld { number: 1, count: 1 });
}

#[test]
fn turned_things_go_around_and_their_world_stays() {
    let (world, light) = world(|direction| DVec3::splat(0.5) + 0.5 * direction);
    let scene = Scene { objects: vec![ball(DVec3::new(0.6, 0.2, 0.0), 0.3, 0)] };
    let sky = Sky::new(&world, &light);
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let mut surroundings = [under(&scene, 0, sky, &maps)];
    for (degrees, x) in [(0.0, 0.6), (90.0, 0.0), (120.0, -0.3), (180.0, -0.6)] {
        surroundings[0].turn_things(Angle::from_degrees(degrees));
        let made = picture(&scene, &camera(), &surroundings, Background::Colour(Rgba::TRANSPARENT)).unwrap();
        let sums = made.pixels().iter().enumerate().fold([0.0; 3], |[x, y, area], (k, pixel)| {
            let (alpha, [i, j]) =
                (f64::from(pixel.alpha()), [k % SIDE, k / SIDE].map(|k| (k as f64 + 0.5) / SIDE as f64));
            [x + alpha * (2.0 * i - 1.0), y + alpha * (1.0 - 2.0 * j), area + alpha]
        });
        let (found, height) = (sums[0] / sums[2], sums[1] / sums[2]);
        assert!((found - x).abs() < 2e-3 && (height - 0.2).abs() < 2e-3, "{degrees}°: {found}, {height} for {x}");
        // In its middle a ball shows what is behind the eye: +Z.
        let middle = [x + 1.0, 0.8].map(|place| (place * 0.5 * SIDE as f64) as usize);
        let seen = made.get(middle[0], middle[1]).0;
        let expected = [0.5, 0.5, 1.0];
        assert!((0..3).all(|k| (seen[k] - expected[k]).abs() < 0.05), "{degrees}°: {seen:?}");
    }
}
