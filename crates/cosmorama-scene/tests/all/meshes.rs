//! Meshes whose pictures are known.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use cosmorama::camera::PixelPoint;
use cosmorama::filter::{FilterKind, FilterSettings, Texture, Wrap};
use cosmorama::prelude::*;
use cosmorama_scene::{
    Background, Camera, Face, Finish, Glass, LightMaps, Material, Mesh, MeshError, NormalMap, Normals, Object,
    Orthographic, Paint, Part, Place, Scene, SceneError, Shape, Sky, Sphere, Surroundings, picture,
};
use glam::{DMat3, DVec2, DVec3};

pub(crate) const MADE: Normals = Normals { kept: true, crease: Angle::from_degrees(40.0) };

/// A smooth sky: light by direction.
pub(crate) fn light(direction: DVec3) -> [f32; 3] {
    let wave =
        |a: f64, b: f64, c: f64| (0.5 + 0.35 * (a * direction.x + b * direction.y + c * direction.z).sin()) as f32;
    [wave(5.0, 1.5, -1.0), wave(1.0, 6.0, 2.0), wave(-2.0, 3.0, 7.0)]
}

pub(crate) fn sky() -> (World, Light) {
    let view = CameraModel::from(EquirectCamera::default()).view(1024, 512).unwrap();
    let texel = |i, j| {
        let [red, green, blue] = light(view.direction(PixelPoint::centre(i, j)).unwrap().vector());
        Rgba::opaque(red, green, blue)
    };
    World::from_panorama(Image::from_fn(1024, 512, texel)).unwrap()
}

pub(crate) fn face(corners: [DVec3; 3]) -> Face {
    Face { corners, normals: None, uvs: None, tangents: None, part: 0 }
}

/// A grid of points, joined to triangles, over u and v from 0 to 1.
pub(crate) fn grid(columns: usize, rows: usize, point: impl Fn(f64, f64) -> DVec3) -> Vec<Face> {
    let at = |i: usize, j: usize| point((i % columns) as f64 / columns as f64, j as f64 / rows as f64);
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [face([a, b, c]), face([a, c, d])]
    });
    faces.collect()
}

/// A ball of radius 1.
pub(crate) fn ball(columns: usize) -> Vec<Face> {
    let point = |u: f64, v: f64| {
        let (sin, cos) = if v == 0.0 || v == 1.0 { (0.0, 1.0 - 2.0 * v) } else { (PI * v).sin_cos() };
        DVec3::new(sin * (TAU * u).sin(), cos, sin * (TAU * u).cos())
    };
    grid(columns, columns / 2, point)
}

/// A cube of side 2, turned.
fn cube(turn: DMat3) -> Vec<Face> {
    let side = |axis: usize, sign: f64| {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let (out, right) = (axes[axis] * sign, axes[(axis + 1) % 3]);
        let up = out.cross(right);
        let corner = |x: f64, y: f64| turn * (out + right * x + up * y);
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        [face([corners[0], corners[1], corners[2]]), face([corners[0], corners[2], corners[3]])]
    };
    (0..3).flat_map(|axis| [side(axis, 1.0), side(axis, -1.0)]).flatten().collect()
}

pub(crate) fn object(faces: Vec<Face>, material: Material) -> Object {
    let mesh = Mesh::new(faces, MADE).unwrap();
    Object { shape: Shape::Mesh(Arc::new(mesh)), parts: vec![Part { name: "mesh".to_owned(), material, world: 0 }] }
}

pub(crate) fn lens(eye: [f64; 3], degrees: f64, size: (usize, usize)) -> Camera {
    let model = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(degrees))));
    let place = Place { eye: eye.into(), target: DVec3::ZERO };
    Camera::lens(place, Placement::new(model).view(size.0, size.1).unwrap()).unwrap()
}

pub(crate) fn parallel(height: f64, size: [usize; 2]) -> Camera {
    let place = Place { eye: DVec3::Z * 9.0, target: DVec3::ZERO };
    Camera::Orthographic(Orthographic::new(place, height, size).unwrap())
}

pub(crate) fn made(objects: Vec<Object>, camera: &Camera) -> Image<Rgba> {
    let (world, light) = sky();
    let scene = Scene { objects };
    let sky = Sky::new(&world, &light);
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let filter = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };
    let surroundings = Surroundings::new(sky, &maps, filter).unwrap();
    picture(&scene, camera, std::slice::from_ref(&surroundings), Background::Colour(Rgba::TRANSPARENT)).unwrap()
}

/// Decibels of the differences of all channels, of light of 1.
pub(crate) fn decibels(a: &Image<Rgba>, b: &Image<Rgba>) -> f64 {
    let pairs = a.pixels().iter().zip(b.pixels()).flat_map(|(a, b)| a.0.into_iter().zip(b.0));
    let squares: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    -10.0 * (squares / (4 * a.pixels().len()) as f64).log10()
}

#[test]
fn a_ball_of_triangles_looks_as_the_ball_does() {
    let sphere = Sphere::new(DVec3::ZERO, 1.0);
    let (perspective, parallel) = (lens([0.4, 1.0, 4.0], 34.0, (160, 120)), parallel(2.4, [120, 120]));
    for (camera, material, least) in [(&perspective, Material::MIRROR, 53.0), (&parallel, Material::MATTE, 55.0)] {
        let found = made(vec![object(ball(256), material.clone())], camera);
        let expected = made(vec![Object::sphere(sphere, material.clone())], camera);
        let decibels = decibels(&found, &expected);
        println!("{decibels:.1} dB");
        assert!(decibels > least, "{material:?}: {decibels:.1} dB");
    }
}

#[test]
fn glass_of_triangles_looks_as_a_ball_of_glass_does() {
    let camera = lens([0.4, 1.0, 4.0], 34.0, (48, 48));
    let found = made(vec![object(ball(256), Material::GLASS)], &camera);
    let expected = made(vec![Object::sphere(Sphere::new(DVec3::ZERO, 1.0), Material::GLASS)], &camera);
    let decibels = decibels(&found, &expected);
    println!("{decibels:.1} dB");
    assert!(decibels > 47.0, "{decibels:.1} dB");
}

#[test]
fn faces_of_a_mirror_cube_are_plane_mirrors() {
    let turn = DMat3::from_euler(glam::EulerRot::YXZ, 0.6, 0.5, 0.1);
    let camera = lens([0.0, 0.0, 6.0], 34.0, (120, 120));
    let image = made(vec![object(cube(turn), Material::MIRROR)], &camera);
    let mut count = 0;
    for (k, pixel) in image.pixels().iter().enumerate() {
        let ray = camera.ray(PixelPoint::centre(k % 120, k / 120)).unwrap();
        // The face that is met first, by slabs, away from its sides.
        let (origin, direction) = (turn.transpose() * ray.origin, turn.transpose() * ray.direction);
        let nears = (-direction.signum() - origin) / direction;
        let near = nears.max_element();
        let inner = (origin + direction * near).abs();
        if pixel.alpha() < 1.0 || inner.to_array().iter().filter(|side| **side > 0.93).count() > 1 {
            continue;
        }
        let axis = nears.to_array().iter().position(|distance| *distance == near).unwrap();
        let mut mirrored = direction;
        mirrored[axis] = -mirrored[axis];
        let expected = light(turn * mirrored);
        (0..3).for_each(|k| assert!((pixel.0[k] - expected[k]).abs() < 2e-3, "{pixel:?} for {expected:?}"));
        count += 1;
    }
    assert!(count > 1500, "{count} pixels");
}

/// Area and middle of what a picture covers, in pixels.
fn covered(image: &Image<Rgba>) -> (f64, [f64; 2]) {
    let width = image.width();
    let (mut area, mut sums) = (0.0, [0.0; 2]);
    for (k, pixel) in image.pixels().iter().enumerate() {
        let alpha = f64::from(pixel.alpha());
        area += alpha;
        sums[0] += alpha * ((k % width) as f64 + 0.5);
        sums[1] += alpha * ((k / width) as f64 + 0.5);
    }
    (area, sums.map(|sum| sum / area))
}

#[test]
fn outlines_cover_their_exact_area() {
    // Pixels of a size of 1, whatever the slopes of the sides; the square's sides are upright and level.
    let camera = parallel(64.0, [64, 64]);
    let triangle =
        |x: f64| [DVec3::new(-21.3 + x, -17.8, 0.0), DVec3::new(19.1 + x, -3.4, 2.0), DVec3::new(-2.2 + x, 22.7, 1.0)];
    for x in [0.0, 0.21, 0.43, 0.77] {
        let corners = triangle(x);
        let [a, b, c] = corners.map(|corner| corner.truncate());
        let (area, [x, y]) = covered(&made(vec![object(vec![face(corners)], Material::MATTE)], &camera));
        let (expected, middle) = (0.5 * (b - a).perp_dot(c - a), (a + b + c) / 3.0);
        // A thousandth of a pixel along its outline.
        assert!((area - expected).abs() < 0.1, "{area} for {expected}");
        assert!((x - 32.0 - middle.x).abs() < 2e-3 && (32.0 - y - middle.y).abs() < 2e-3, "{x}, {y}");
    }
    for side in [9.0, 9.3, 9.5, 9.77] {
        let square: Vec<Face> = cube(DMat3::from_diagonal(DVec3::splat(side)));
        let (area, _) = covered(&made(vec![object(square, Material::MATTE)], &camera));
        // A 128th of a pixel at most along each side.
        assert!((area - 4.0 * side * side).abs() < 8.0 * side / 128.0 + 1e-3, "{area} for {}", 4.0 * side * side);
    }
}

#[test]
fn things_thinner_than_a_pixel_are_not_missed() {
    let camera = parallel(64.0, [64, 64]);
    for width in [0.05, 0.2, 0.5] {
        let corners = [[-20.0, 3.1], [20.0, 3.1], [20.0, 3.1 + width], [-20.0, 3.1 + width]];
        let [a, b, c, d] = corners.map(|[x, y]| DMat3::from_rotation_z(0.4) * DVec3::new(x, y, 0.0));
        let (area, _) = covered(&made(vec![object(vec![face([a, b, c]), face([a, c, d])], Material::MATTE)], &camera));
        assert!((area / (40.0 * width) - 1.0).abs() < 0.05, "{area} for {}", 40.0 * width);
    }
}

#[test]
fn nearer_things_hide_others() {
    let camera = parallel(3.0, [60, 60]);
    let square = |z: f64, material: Material| {
        let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, z));
        object(vec![face([a, b, c]), face([a, c, d])], material)
    };
    let black = Material { diffuse: 0.0, specular: 0.0, ..Material::MATTE };
    let behind = Object::sphere(Sphere::new(DVec3::ZERO, 1.2), Material::MATTE);
    let image = made(vec![behind, square(2.0, black.clone()), square(-3.0, Material::MATTE)], &camera);
    let (inside, beside) = (image.get(30, 30), image.get(30, 7));
    assert_eq!(*inside, Rgba::opaque(0.0, 0.0, 0.0));
    assert!(beside.alpha() == 1.0 && beside.0[0] > 0.1, "{beside:?}");
    // Along the border of the black square no background shines through.
    let row: Vec<f32> = (20..40).map(|i| image.get(i, 9).alpha().min(image.get(i, 10).alpha())).collect();
    assert!(row.iter().all(|alpha| (alpha - 1.0).abs() < 1e-6), "{row:?}");
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let camera = lens([1.0, 2.0, 5.0], 30.0, (90, 70));
    let render = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            made(vec![object(ball(40), Material::MIXED), object(cube(DMat3::IDENTITY), Material::GLASS)], &camera)
        })
    };
    assert_eq!(render(1).pixels(), render(3).pixels());
}

#[test]
fn what_is_no_surface_is_refused() {
    let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    assert_eq!(Mesh::new(vec![], MADE).unwrap_err(), MeshError::Empty { skipped: 0 });
    let flat = face([a, b, b * 3.0]);
    assert_eq!(Mesh::new(vec![flat, flat], MADE).unwrap_err(), MeshError::Empty { skipped: 2 });
    let good = face([a, b, c]);
    assert_eq!(Mesh::new(vec![good, flat], MADE).unwrap().skipped(), 1);
    let nowhere = face([a, b, DVec3::new(0.0, f64::NAN, 0.0)]);
    assert_eq!(Mesh::new(vec![good, nowhere], MADE).unwrap_err(), MeshError::NotFinite { face: 1, corner: 2 });
    // Normals that are none are made.
    let wrong = Face { normals: Some([DVec3::ZERO, DVec3::NAN, DVec3::Z]), ..good };
    let image = made(vec![object(vec![wrong], Material::MATTE)], &parallel(3.0, [16, 16]));
    assert!(image.pixels().iter().all(|pixel| pixel.0.iter().all(|channel| channel.is_finite())));
}

#[test]
fn glass_with_a_hole_is_refused() {
    let mut faces = cube(DMat3::IDENTITY);
    assert_eq!(Mesh::new(faces.clone(), MADE).unwrap().hole(), None);
    faces.pop();
    let (world, light) = sky();
    let scene = Scene { objects: vec![object(faces, Material::GLASS)] };
    let refused = LightMaps::of(&scene, 0, Sky::new(&world, &light)).unwrap_err();
    let SceneError::Open(edge) = refused else { panic!("{refused}") };
    assert!(edge.iter().flatten().all(|part| part.abs() == 1.0), "{edge:?}");
    // A triangle that is turned round bounds nothing, either.
    let mut turned = cube(DMat3::IDENTITY);
    turned[0].corners.swap(1, 2);
    assert!(Mesh::new(turned, MADE).unwrap().hole().is_some());
}

/// A ring around the y axis, of radii 1 and 0.4.
fn torus(columns: usize, rows: usize) -> Vec<Face> {
    let at = |i: usize, j: usize| {
        let [around, across] = [(i, columns), (j, rows)].map(|(k, count)| TAU * (k % count) as f64 / count as f64);
        let radius = 1.0 + 0.4 * across.cos();
        DVec3::new(radius * around.sin(), 0.4 * across.sin(), radius * around.cos())
    };
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [face([a, b, c]), face([a, c, d])]
    });
    faces.collect()
}

/// Glass of many surfaces.
pub(crate) fn deep_glass() -> Material {
    let glass = Material::GLASS.glass.map(|glass| Glass { surfaces: 8, ..glass });
    Material { glass, ..Material::GLASS }
}

#[test]
fn a_ring_of_glass_loses_no_light() {
    let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.25, 0.5, 1.0))).unwrap();
    let sky = Sky::new(&world, &light);
    for columns in [24, 96] {
        let scene = Scene { objects: vec![object(torus(columns, columns / 2), deep_glass())] };
        let maps = LightMaps::of(&scene, 0, sky).unwrap();
        let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap();
        let camera = lens([1.0, 2.0, 3.5], 44.0, (48, 48));
        let image = picture(&scene, &camera, &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap();
        for Rgba([red, _, blue, alpha]) in image.pixels() {
            assert!((red - 0.25 * alpha).abs() < 1e-4 && (blue - alpha).abs() < 1e-4, "{red}, {blue} of {alpha}");
        }
    }
}

/// Few triangles with smooth normals refract nearly as many do.
#[test]
fn a_coarse_ring_of_glass_is_nearly_a_fine_one() {
    let camera = lens([1.0, 2.0, 3.5], 44.0, (64, 64));
    let [coarse, fine] =
        [64, 256].map(|columns| made(vec![object(torus(columns, columns / 2), deep_glass())], &camera));
    let decibels = decibels(&coarse, &fine);
    println!("{decibels:.1} dB");
    assert!(decibels > 43.0, "{decibels:.1} dB");
}

#[test]
fn a_ball_looks_the_same_beside_a_mesh() {
    let camera = lens([0.0, 0.0, 6.0], 40.0, (96, 72));
    let ball = || Object::sphere(Sphere::new(DVec3::new(-0.4, 0.1, 0.0), 1.0), Material::MIRROR);
    let post = cube(DMat3::from_diagonal(DVec3::new(0.1, 2.0, 0.1)));
    let post =
        post.into_iter().map(|face| Face { corners: face.corners.map(|corner| corner + DVec3::X * 0.95), ..face });
    let (alone, beside) =
        (made(vec![ball()], &camera), made(vec![ball(), object(post.collect(), Material::MATTE)], &camera));
    // The post begins three pixels beside the ball.
    let left = (0..96).find(|i| beside.get(*i, 2).alpha() > 0.0).unwrap();
    let is_ball = |i: usize| (0..72).any(|j| alone.get(i, j).alpha() > 0.0);
    assert!(!is_ball(left - 2) && is_ball(left - 7), "{left}");
    for (i, j) in (0..left - 1).flat_map(|i| (0..72).map(move |j| (i, j))) {
        assert_eq!(alone.get(i, j), beside.get(i, j), "{i}, {j}");
    }
}

/// A square of side 2 about the origin that faces +Z, with a picture whose top is at +Y.
fn square() -> Vec<Face> {
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let uv = |corner: DVec3| DVec2::new(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y);
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let half = |corners: [DVec3; 3]| Face { uvs: Some(corners.map(uv)), ..face(corners) };
    vec![half([corners[0], corners[1], corners[2]]), half([corners[0], corners[2], corners[3]])]
}

#[test]
fn pictures_on_meshes_stand_upright() {
    // Red above on the left, green above on the right, blue below.
    let painted = Image::from_fn(64, 64, |i, j| match (i < 32, j < 32) {
        (true, true) => Rgba::opaque(1.0, 0.0, 0.0),
        (false, true) => Rgba::opaque(0.0, 1.0, 0.0),
        _ => Rgba::opaque(0.0, 0.0, 1.0),
    });
    let emissive = Paint::picture(Texture::new(painted, [Wrap::Clamp; 2]));
    let dark = Finish { base: Paint::plain([0.0; 3]), emissive, specular: 0.0, ..Finish::default() };
    let image = made(vec![object(square(), Material::of(dark))], &parallel(2.0, [40, 40]));
    for (at, expected) in [((8, 8), [1.0, 0.0, 0.0]), ((31, 8), [0.0, 1.0, 0.0]), ((20, 31), [0.0, 0.0, 1.0])] {
        let found = image.get(at.0, at.1).0;
        assert!((0..3).all(|k| (found[k] - expected[k]).abs() < 1e-3), "{at:?}: {found:?} for {expected:?}");
    }
}

/// A mirror whose normals lean towards u stands as a plane that leans so, from before and from behind.
#[test]
fn dents_are_the_same_plane_from_both_sides() {
    let (sin, cos) = 0.2f64.sin_cos();
    let code = |part: f64| (0.5 + 0.5 * part) as f32;
    let leaning = Image::filled(4, 4, Rgba::opaque(code(sin), code(0.0), code(cos)));
    let normal_map = Some(NormalMap::new(&leaning, [Wrap::Repeat; 2], 1.0));
    let mirror = Finish { metallic: 1.0, normal_map, ..Finish::default() };
    for side in [1.0, -1.0] {
        let place = Place { eye: DVec3::new(0.0, 0.0, 9.0 * side), target: DVec3::ZERO };
        let camera = Camera::Orthographic(Orthographic::new(place, 2.0, [24, 24]).unwrap());
        let image = made(vec![object(square(), Material::of(mirror.clone()))], &camera);
        let (view, normal) = (DVec3::Z * -side, DVec3::new(sin, 0.0, cos));
        let expected = light(view - 2.0 * view.dot(normal) * normal);
        let found = image.get(12, 12).0;
        assert!((0..3).all(|k| (found[k] - expected[k]).abs() < 0.02), "{side}: {found:?} for {expected:?}");
    }
}
