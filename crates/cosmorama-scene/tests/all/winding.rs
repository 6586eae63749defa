//! Triangles wound the wrong way, hollows, and models that many things share.

use std::path::Path;
use std::sync::Arc;

use cosmorama::camera::PixelPoint;
use cosmorama::prelude::*;
use cosmorama_scene::{
    Background, Camera, Face, LightMaps, Mesh, Model, ModelSettings, Normals, Object, Part, PictureKind, PictureReader,
    PictureSource, Scene, SceneFile, SceneReader, Shape, Sky, Surroundings, picture,
};
use glam::DVec3;

use crate::meshes::{self, MADE, decibels, deep_glass, face, lens, light};
use crate::models::{File, Files, SETTINGS};

fn mended(faces: Vec<Face>) -> Mesh {
    Mesh::mended(faces, MADE).unwrap()
}

/// Makes the picture of a thing under a small sky.
fn made(object: Object, camera: &Camera) -> Image<Rgba> {
    let view = CameraModel::from(EquirectCamera::default()).view(128, 64).unwrap();
    let texel = |i, j| {
        let [red, green, blue] = light(view.direction(PixelPoint::centre(i, j)).unwrap().vector());
        Rgba::opaque(red, green, blue)
    };
    let (world, light) = World::from_panorama(Image::from_fn(128, 64, texel)).unwrap();
    let (sky, scene) = (Sky::new(&world, &light), Scene { objects: vec![object] });
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap();
    picture(&scene, camera, &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap()
}

fn shown(mesh: Mesh) -> Image<Rgba> {
    let part = Part { name: "mesh".to_owned(), material: deep_glass(), world: 0 };
    let object = Object { shape: Shape::Mesh(Arc::new(mesh)), parts: vec![part] };
    made(object, &lens([0.4, 1.0, 4.0], 34.0, (32, 32)))
}

/// Turns every so many triangles round.
fn turned(mut faces: Vec<Face>, every: usize) -> Vec<Face> {
    faces.iter_mut().step_by(every).for_each(|face| face.corners.swap(1, 2));
    faces
}

/// A ball whose triangles face outward.
fn ball(columns: usize) -> Vec<Face> {
    turned(meshes::ball(columns), 1)
}

/// A ball about a place.
fn ball_at(middle: DVec3, radius: f64, columns: usize) -> Vec<Face> {
    let faces = ball(columns).into_iter();
    faces.map(|face| Face { corners: face.corners.map(|corner| middle + corner * radius), ..face }).collect()
}

#[test]
fn a_ball_with_a_tenth_of_its_triangles_turned_refracts_as_the_whole_one() {
    let whole = Mesh::new(ball(64), MADE).unwrap();
    let expected = shown(whole);
    for (every, count) in [(10, 410), (1, 4096)] {
        let mesh = mended(turned(ball(64), every));
        // Triangles without area at the poles are left out, and not counted.
        assert!(mesh.turned().abs_diff(count) < 10 + 128 / every && mesh.hole().is_none(), "{}", mesh.turned());
        assert_eq!(shown(mesh).pixels(), expected.pixels(), "every {every}");
    }
    // Left as it is, it bounds nothing.
    assert!(Mesh::new(turned(ball(64), 10), MADE).unwrap().hole().is_some());
}

#[test]
fn hollows_stay_hollows() {
    let (outer, inner) = (ball_at(DVec3::ZERO, 1.0, 48), ball_at(DVec3::new(0.1, 0.0, 0.05), 0.6, 32));
    let hollow = [outer.clone(), turned(inner.clone(), 1)].concat();
    let expected = shown(Mesh::new(hollow.clone(), MADE).unwrap());
    assert!(decibels(&expected, &shown(Mesh::new(outer.clone(), MADE).unwrap())) < 30.0, "a hollow is seen");
    assert_eq!(mended(hollow.clone()).turned(), 0);
    // Wound on purpose or not, a piece within another is a hollow, and one within that is none.
    let marble = ball_at(DVec3::new(0.1, 0.0, 0.05), 0.2, 16);
    let count = |faces: &[Face]| mended(faces.to_vec()).count();
    for (faces, wrong) in [
        ([outer.clone(), inner.clone()].concat(), Some(count(&inner))),
        (turned(hollow.clone(), 1), Some(count(&hollow))),
        ([turned(outer, 3), turned(inner, 7)].concat(), None),
    ] {
        let mesh = mended(faces);
        assert!(wrong.is_none_or(|wrong| mesh.turned() == wrong), "{} of {wrong:?}", mesh.turned());
        assert_eq!(shown(mesh).pixels(), expected.pixels());
    }
    assert_eq!(mended([hollow.clone(), marble.clone()].concat()).turned(), 0);
    let all = count(&marble);
    assert_eq!(mended([hollow, turned(marble, 1)].concat()).turned(), all);
}

#[test]
fn pieces_beside_one_another_face_outward() {
    // They overlap: points of each are inside the other.
    let [left, right] = [-0.4, 0.4].map(|x| ball_at(DVec3::X * x, 0.6, 24));
    assert_eq!(mended([left.clone(), right.clone()].concat()).turned(), 0);
    let mesh = mended([left, turned(right, 1)].concat());
    assert_eq!(2 * mesh.turned(), mesh.count());
}

#[test]
fn what_cannot_be_wound_one_way_names_an_edge() {
    // The projective plane of six points: closed, and with one side.
    let points: Vec<DVec3> = (0..6).map(f64::from).map(|k| DVec3::new(k.cos(), (2.3 * k).sin(), 0.3 * k)).collect();
    let triangles =
        [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 1], [1, 2, 4], [2, 3, 5], [3, 4, 1], [4, 5, 2], [5, 1, 3]];
    let plane: Vec<Face> = triangles.iter().map(|corners| face(corners.map(|k| points[k]))).collect();
    let mesh = mended(plane.clone());
    let edge = mesh.hole().expect("an edge at which it turns inside out");
    assert!(mesh.turned() == 0 && edge.iter().all(|end| points.contains(end)), "{edge:?}");
    // It does not keep a ball beside it from being mended, nor does an open piece.
    let away = ball_at(DVec3::X * 5.0, 1.0, 24);
    let open: Vec<Face> =
        away.iter().skip(60).map(|face| Face { corners: face.corners.map(|c| c * 3.0), ..*face }).collect();
    let mesh = mended([plane, turned(away, 1), turned(open, 5)].concat());
    assert_eq!(mesh.turned(), mended(ball_at(DVec3::X * 5.0, 1.0, 24)).count());
}

/// Text of a model with a ball, some of whose triangles are turned.
fn text(every: usize) -> String {
    let faces = turned(ball(12), every);
    let points: String =
        faces.iter().flat_map(|face| face.corners).map(|DVec3 { x, y, z }| format!("v {x} {y} {z}\n")).collect();
    let triangles: String =
        (0..faces.len()).map(|k| format!("f {} {} {}\n", 3 * k + 1, 3 * k + 2, 3 * k + 3)).collect();
    points + &triangles
}

#[test]
fn turned_triangles_are_told() {
    let notes = |every: usize| File::new(&format!("turned{every}.obj"), &text(every)).read().unwrap().notes.join("; ");
    assert!(notes(10).contains("triangles faced the wrong way, and are turned round"), "{}", notes(10));
    // The first triangle is at a pole, and has no area.
    assert!(!notes(1000).contains("wrong way"), "{}", notes(1000));
}

/// A reader that counts the models that it reads.
#[derive(Default)]
struct Counting {
    models: usize,
    notes: Vec<String>,
}

impl PictureReader for Counting {
    fn picture(&mut self, source: PictureSource, kind: PictureKind) -> Result<Image<Rgba>, String> {
        Files.picture(source, kind)
    }
}

impl SceneReader for Counting {
    fn model(&mut self, path: &Path, settings: ModelSettings) -> Result<Object, String> {
        self.models += 1;
        let settings = ModelSettings { most: SETTINGS.most, ..settings };
        Model::read(path, &settings, &mut Files).map(|model| model.object).map_err(|error| error.to_string())
    }

    fn tell(&mut self, _: &Path, note: &str) {
        self.notes.push(note.to_owned());
    }
}

fn mesh_of(object: &Object) -> &Mesh {
    let Shape::Mesh(mesh) = &object.shape else { panic!("a mesh") };
    mesh
}

#[test]
fn a_model_of_many_things_is_read_and_built_once() {
    let file = File::new("shared.obj", &text(usize::MAX));
    let name = file.0.display();
    let places = [("glass", 0.5, 1.0), ("mirror", -3.0, 0.5), ("matte", 4.0, 2.0), ("mirror", 0.0, 0.1)];
    let things = places.map(|(material, x, scale)| {
        format!("[[object]]\nfile = '{name}'\nmaterial = '{material}'\ntranslate = [{x}, 0.2, -1]\nrotate = [30, {x}, 5]\nscale = {scale}\n")
    });
    let mut reader = Counting::default();
    let read = |text: &str, reader: &mut Counting| SceneFile::parse("scene.toml", text).unwrap().scene(reader).unwrap();
    let scene = read(&things.concat(), &mut reader);
    assert_eq!(reader.models, 1);
    let first = mesh_of(&scene.objects[0]);
    assert!(scene.objects.iter().all(|object| mesh_of(object).shares_triangles(first)));
    // Each looks as it does alone.
    for (k, thing) in things.iter().enumerate() {
        let alone = read(thing, &mut Counting::default());
        assert_eq!(scene.objects[k].parts, alone.objects[0].parts, "{k}");
        let camera = lens([0.4, 1.0, 9.0], 60.0, (40, 30));
        let [shared, own] = [&scene, &alone].map(|scene| {
            let object = scene.objects[if scene.objects.len() > 1 { k } else { 0 }].clone();
            made(object, &camera)
        });
        assert_eq!(shared.pixels(), own.pixels(), "{k}");
        assert!(shared.pixels().iter().any(|pixel| pixel.alpha() > 0.0), "{k}");
    }
    // Normals of another crease are another surface.
    let other = things[0].replace("scale", "crease = 0\nscale");
    read(&[&things[0], other.as_str()].concat(), &mut reader);
    assert_eq!(reader.models, 3);
    // A material whose pictures a model has no place for is refused wherever it comes.
    let picture = crate::models::two_texels("shared.png", false);
    let painted = format!("[material.painted]\ntexture = '{}'\n", picture.0.display());
    let text = format!("{}{}{painted}", things[1], things[2].replace("'matte'", "'painted'"));
    let error = SceneFile::parse("scene.toml", &text).unwrap().scene(&mut reader).unwrap_err().to_string();
    assert!(error.contains("line 8") && error.contains("no texture coordinates"), "{error}");
    assert!(reader.notes.is_empty(), "{:?}", reader.notes);
}

/// A placed mesh shows what a mesh of placed triangles shows.
#[test]
fn placed_models_are_models_of_placed_triangles() {
    let file = File::new("placed.obj", &text(usize::MAX));
    let text = format!(
        "[[object]]\nfile = '{}'\ncrease = 60\nmaterial = 'NAME'\ntranslate = [0.7, -0.2, -1]\nrotate = [30, 40, 5]\nscale = 1.7\n",
        file.0.display()
    );
    let [yaw, pitch, roll] = [30.0, 40.0, 5.0].map(Angle::from_degrees);
    let turn = Orientation::from_yaw_pitch_roll(yaw, pitch, roll).rotation();
    let place = |corner: DVec3| DVec3::new(0.7, -0.2, -1.0) + turn * (corner * 1.7);
    let faces: Vec<Face> = ball(12).into_iter().map(|face| Face { corners: face.corners.map(place), ..face }).collect();
    for material in ["glass", "mirror", "matte"] {
        let text = text.replace("NAME", material);
        let scene = SceneFile::parse("scene.toml", &text).unwrap().scene(&mut Counting::default()).unwrap();
        let object = &scene.objects[0];
        let normals = Normals { crease: Angle::from_degrees(60.0), ..MADE };
        let mesh = Arc::new(Mesh::new(faces.clone(), normals).unwrap());
        let moved = Object { shape: Shape::Mesh(mesh), parts: object.parts.clone() };
        let camera = lens([0.4, 1.0, 8.0], 40.0, (60, 50));
        let found = decibels(&made(object.clone(), &camera), &made(moved, &camera));
        assert!(found > 60.0, "{material}: {found:.1} dB");
    }
}
