//! Models from files.

use std::path::PathBuf;

use cosmorama_scene::{Material, Model, ModelSettings, Shape};

const SETTINGS: ModelSettings = ModelSettings { crease: None, material: None, most: 1_000_000 };

/// A file that is removed after the test.
struct File(PathBuf);

impl File {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("cosmorama-{}-{name}", std::process::id()));
        std::fs::write(&path, text).unwrap();
        Self(path)
    }

    fn read(&self) -> Result<Model, String> {
        Model::read(&self.0, &SETTINGS).map_err(|error| error.to_string())
    }
}

impl Drop for File {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).unwrap();
    }
}

const SQUARE: &str =
    "# a square, in all forms of corners\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nvt 0 0\nvt 1 1 0\nvn 0 0 1\n";

#[test]
fn obj_files_are_read() {
    let text = format!(
        "{SQUARE}g left\nusemtl red\nf 1 2 3\nusemtl blue\nf 1/1 3/2 4/1\ng right\nf -4//1 -3//-1 -2//1\nf 1/1/1 2/1/1 3/2/1 4/2/1\n"
    );
    let file = File::new("square.obj", &text);
    let model = file.read().unwrap();
    let names: Vec<&str> = model.object.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["red", "blue", "right"]);
    let Shape::Mesh(mesh) = &model.object.shape else { panic!() };
    assert_eq!(mesh.count(), 5);
    assert_eq!(mesh.ball().centre.to_array(), [0.5, 0.5, 0.0]);
    let material = Some(Material::MATTE);
    let matt = Model::read(&file.0, &ModelSettings { material, ..SETTINGS }).unwrap();
    assert!(matt.object.parts.iter().all(|part| part.material == Material::MATTE));
}

#[test]
fn faults_of_obj_files_name_the_line() {
    let cases = [
        ("f 1 2 7", "line 9: vertex '7' is not there: 4 are"),
        ("f 1 2 0", "line 9: vertex '0'"),
        ("f 1 2 -5", "line 9: vertex '-5'"),
        ("f 1/9 2/1 3/1", "line 9: texture coordinates '9'"),
        ("f 1//2 2//1 3//1", "line 9: normal '2'"),
        ("f 1 2", "line 9: the face has 2 corners"),
        ("f a b c", "line 9: vertex 'a' is not a whole number"),
        ("v 1 2", "line 9: expected 3 numbers"),
        ("v 1 2 x", "line 9: expected a number, but found 'x'"),
        ("v nan 0 0\nf 1 2 5", "corner 2 of triangle 0 is not a point"),
        ("", "no triangle"),
    ];
    for (line, says) in cases {
        let error = File::new("wrong.obj", &format!("{SQUARE}{line}\n")).read().unwrap_err();
        assert!(error.contains(says) && error.contains("wrong.obj"), "{line}: {error}");
    }
    let error = Model::read("nothing.obj".as_ref(), &SETTINGS).unwrap_err().to_string();
    assert!(error.contains("nothing.obj"), "{error}");
    let error = Model::read("nothing.stl".as_ref(), &SETTINGS).unwrap_err().to_string();
    assert!(error.contains(".obj"), "{error}");
}

#[test]
fn more_triangles_than_fit_are_refused_before_they_are_made() {
    let file = File::new("large.obj", &format!("{SQUARE}{}", "f 1 2 3 4\n".repeat(600_000)));
    let error = file.read().unwrap_err();
    assert!(error.contains("1200000 triangles"), "{error}");
}
