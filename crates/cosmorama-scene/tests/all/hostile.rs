//! Scene files and models from strangers: each is refused or understood, in bounded time.

use std::path::Path;
use std::time::{Duration, Instant};

use cosmorama::raster::{Image, Rgba};
use cosmorama_scene::{
    Model, ModelSettings, Object, PictureKind, PictureReader, PictureSource, SceneFile, SceneReader,
};
use testkit::Mutants;

use crate::models::SETTINGS;

/// Longest time that a text of some kilobytes may take.
const LONGEST: Duration = Duration::from_secs(10);

/// A reader that finds small pictures everywhere, and models nowhere.
struct Small;

impl PictureReader for Small {
    fn picture(&mut self, _: PictureSource, _: PictureKind) -> Result<Image<Rgba>, String> {
        Ok(Image::filled(2, 2, Rgba::BLACK))
    }
}

impl SceneReader for Small {
    fn model(&mut self, path: &Path, _: ModelSettings) -> Result<Object, String> {
        Err(format!("{}: no model", path.display()))
    }

    fn tell(&mut self, _: &Path, _: &str) {}
}

/// A scene file that names most of what there is; fuzzing begins with it, too.
const SCENE: &str = include_str!("../../../../fuzz/seeds/scenes/scene.toml");

fn scene(text: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(text) else { return false };
    SceneFile::parse("scene.toml", text).is_ok_and(|file| {
        file.camera();
        file.worlds().is_ok() & file.scene(&mut Small).is_ok()
    })
}

#[test]
fn scene_files_are_refused_or_understood() {
    assert!(scene(SCENE.as_bytes()), "{:?}", SceneFile::parse("scene.toml", SCENE).map(drop));
    let words = [
        "[[object]]\n",
        "[material.a]\n",
        "[world.b]\n",
        "[[light]]\n",
        "glass = true\n",
        "file = \"a.obj\"\n",
        "scale = ",
        "turn = ",
        "#",
    ];
    let mut understood = 0;
    for damaged in Mutants::new(SCENE.as_bytes(), &words, 1).take(Mutants::count(2000)) {
        let start = Instant::now();
        understood += usize::from(scene(&damaged));
        assert!(start.elapsed() < LONGEST, "{:?} for {}", start.elapsed(), String::from_utf8_lossy(&damaged));
    }
    assert!(understood > 0);
}

#[test]
fn a_scene_file_is_no_longer_than_its_things() {
    let text = format!("{SCENE}#{}", " ".repeat(SceneFile::LONGEST));
    let error = SceneFile::parse("long.toml", &text).unwrap_err().to_string();
    assert!(error.contains("long.toml") && error.contains("16777216 bytes"), "{error}");
}

/// Models, and what they name beside them.
#[test]
fn models_are_refused_or_understood() {
    let folder = std::env::temp_dir().join(format!("cosmorama-hostile-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let material = include_str!("../../../../fuzz/seeds/models/beside.mtl");
    std::fs::write(folder.join("beside.mtl"), material).unwrap();
    let plane = include_str!("../../../../fuzz/seeds/models/a.obj");
    std::fs::write(folder.join("beside.obj"), plane.replace("beside.mtl", "damaged.mtl")).unwrap();
    let gltf = include_str!("../../../../fuzz/seeds/models/a.gltf");
    let words =
        ["usemtl", "f 1 2 3\n", "\"children\":[0],", "\"sparse\":{\"count\":1},", "{", "}", "[", "]", "map_Bump "];
    for (seed, (name, opened, text)) in
        (0..).zip([("a.obj", "a.obj", plane), ("damaged.mtl", "beside.obj", material), ("a.gltf", "a.gltf", gltf)])
    {
        let read = |bytes: &[u8]| {
            std::fs::write(folder.join(name), bytes).unwrap();
            let start = Instant::now();
            let model = Model::read(&folder.join(opened), &SETTINGS, &mut Small);
            assert!(start.elapsed() < LONGEST, "{:?} for {}", start.elapsed(), String::from_utf8_lossy(bytes));
            model.map(drop).map_err(|error| error.to_string())
        };
        assert_eq!(read(text.as_bytes()), Ok(()), "{name}");
        let copies = Mutants::new(text.as_bytes(), &words, seed).take(Mutants::count(1000));
        assert!(copies.filter(|damaged| read(damaged).is_ok()).count() > 0, "{name}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Many nodes that all show a mesh of many points, which are no triangles: each would be a part.
#[test]
fn parts_without_triangles_count_too() {
    const MANY: usize = 3000;
    let primitives = vec!["{\"mode\":0,\"attributes\":{\"POSITION\":0}}"; MANY].join(",");
    let (nodes, numbers) = (vec!["{\"mesh\":0}"; MANY].join(","), (0..MANY).map(|node| node.to_string()));
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}],\"nodes\":[{nodes}],\"meshes\":[{{\"primitives\":\
         [{primitives}]}}],\"buffers\":[{{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,\
         AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":36}}],\"accessors\":\
         [{{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}}]}}",
        numbers.collect::<Vec<_>>().join(",")
    );
    let path = std::env::temp_dir().join(format!("cosmorama-parts-{}.gltf", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let error = Model::read(&path, &SETTINGS, &mut Small).map(drop).map_err(|error| error.to_string());
    std::fs::remove_file(&path).unwrap();
    assert!(error.as_ref().is_err_and(|error| error.contains("9000000")), "{error:?}");
}
