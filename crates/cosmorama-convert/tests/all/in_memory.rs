//! Inputs need not be files on disk: pictures, and what speaks of them.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use cosmorama_convert::{Conversion, Disk, Files, InMemory, Quiet};
use cosmorama_io::{IoError, ReadSeek};

#[test]
fn a_picture_in_memory_makes_what_it_makes_on_disk() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let panorama = Conversion::new("builtin:demo", path("sky.png")).to("equirect".parse().unwrap());
    panorama.size("128".parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    let view = |input: String, output: &str| {
        Conversion::new(input, path(output)).to("perspective:fov=60".parse().unwrap()).size("40x30".parse().unwrap())
    };
    view(path("sky.png"), "disk.png").check().result.unwrap().run(&mut Quiet).unwrap();
    let mut files = InMemory::default();
    files.insert("a picture", std::fs::read(path("sky.png")).unwrap());
    std::fs::remove_file(path("sky.png")).unwrap();
    let from_memory = view("a picture".to_owned(), "memory.png").files(Arc::new(files));
    let report = from_memory.check().result.unwrap().run(&mut Quiet).unwrap();
    assert_eq!(report.inputs, [std::path::PathBuf::from("a picture")]);
    assert!(std::fs::read(path("memory.png")).unwrap() == std::fs::read(path("disk.png")).unwrap());
    assert!(view("a picture".to_owned(), "none.png").check().result.is_err(), "on disk there is none of this name");
}

/// Files on disk, and how often one was opened.
#[derive(Debug, Default)]
struct Counted(AtomicUsize);

impl Files for Counted {
    fn open(&self, path: &Path) -> Result<Box<dyn ReadSeek + Send>, IoError> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Disk.open(path)
    }

    fn holds(&self, path: &Path) -> bool {
        Disk.holds(path)
    }
}

#[test]
fn what_is_decoded_to_see_what_it_is_is_not_decoded_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let panorama = Conversion::new("builtin:demo", path("sky.tif")).to("equirect".parse().unwrap());
    panorama.size("128".parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    let opened = |from: Option<&str>, output: &str| {
        let counted = Arc::new(Counted::default());
        let mut conversion = Conversion::new(path("sky.tif"), path(output)).to("perspective:fov=60".parse().unwrap());
        conversion.geometry.from = from.map(|spec| spec.parse().unwrap());
        conversion.files(counted.clone()).check().result.unwrap().run(&mut Quiet).unwrap();
        counted.0.load(Ordering::Relaxed)
    };
    // Its header is read once more, to see whether it may be decoded.
    assert_eq!(opened(None, "found.png"), opened(Some("equirect"), "given.png") + 1);
    assert!(std::fs::read(path("found.png")).unwrap() == std::fs::read(path("given.png")).unwrap());
}

/// A folder with a view of the demo, 96 x 72 pixels.
fn folder_with_view() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let view = Conversion::new("builtin:demo", folder.path().join("view.png").display().to_string());
    let view = view.to("perspective:fov=75".parse().unwrap()).size("96x72".parse().unwrap());
    view.check().result.unwrap().run(&mut Quiet).unwrap();
    folder
}

/// Converts with the files of a folder on disk, then with all of them in memory and none on disk: twice the same bytes.
fn assert_same_from_memory(folder: &Path, conversion: Conversion) {
    let made = tempfile::tempdir().unwrap();
    let path = |name: &str| made.path().join(name);
    let conversion = conversion.size("40x30".parse().unwrap());
    let to = |name: &str| Conversion { output: path(name).display().to_string().into(), ..conversion.clone() };
    to("disk.png").check().result.unwrap().run(&mut Quiet).unwrap();
    let mut files = InMemory::default();
    for entry in folder.read_dir().unwrap() {
        let file = entry.unwrap().path();
        files.insert(&file, std::fs::read(&file).unwrap());
        std::fs::remove_file(file).unwrap();
    }
    to("memory.png").files(Arc::new(files)).check().result.unwrap().run(&mut Quiet).unwrap();
    assert!(std::fs::read(path("memory.png")).unwrap() == std::fs::read(path("disk.png")).unwrap());
    assert!(to("none.png").check().result.is_err(), "on disk there is nothing");
}

fn narrow(folder: &Path, input: &str) -> Conversion {
    Conversion::new(folder.join(input).display().to_string(), "").to("perspective:fov=30".parse().unwrap())
}

#[test]
fn a_world_file_its_mask_and_its_calibration_may_be_in_memory() {
    let folder = folder_with_view();
    let folder = folder.path();
    let white = Conversion::new("builtin:checker", folder.join("mask.png").display().to_string());
    let white = white.to("perspective:fov=75".parse().unwrap()).size("96x72".parse().unwrap());
    white.check().result.unwrap().run(&mut Quiet).unwrap();
    let camera = r#"{"image_size": [96, 72], "K": [[62, 0, 47.5], [0, 62, 35.5], [0, 0, 1]], "D": [0, 0, 0, 0, 0]}"#;
    std::fs::write(folder.join("camera.json"), camera).unwrap();
    let world = "[[view]]\nimage = \"view.png\"\nspec = \"perspective:calibration=camera.json\"\nmask = \"mask.png\"\n";
    std::fs::write(folder.join("world.toml"), world).unwrap();
    assert_same_from_memory(folder, narrow(folder, "world.toml").missing("#204060".parse().unwrap()));
}

#[test]
fn a_calibration_of_an_input_may_be_in_memory() {
    let folder = folder_with_view();
    let folder = folder.path();
    let camera = r#"{"image_size": [96, 72], "K": [[62, 0, 47.5], [0, 62, 35.5], [0, 0, 1]], "D": [0, 0, 0, 0, 0]}"#;
    let file = folder.join("camera.json");
    std::fs::write(&file, camera).unwrap();
    let spec = format!("perspective:calibration={}", file.display());
    assert_same_from_memory(folder, narrow(folder, "view.png").from(spec.parse().unwrap()));
}

#[test]
fn a_hugin_project_may_be_in_memory() {
    let folder = folder_with_view();
    let folder = folder.path();
    // What the project makes itself is read from it, too: no projection is given for the output.
    let project = "p f0 w40 h30 v30 E0 R0 n\"PNG\"\nm i0\ni w96 h72 f0 v75 y0 p0 r0 n\"view.png\"\n";
    std::fs::write(folder.join("project.pto"), project).unwrap();
    let mut conversion = narrow(folder, "project.pto");
    conversion.geometry.to = None;
    assert_same_from_memory(folder, conversion);
}

#[test]
fn an_st_map_may_be_in_memory() {
    let folder = folder_with_view();
    let folder = folder.path();
    let map = folder.join("map.exr");
    let st_map = Conversion { st_map: true, ..narrow(folder, "view.png") };
    let st_map =
        Conversion { output: map.display().to_string().into(), ..st_map.from("perspective:fov=75".parse().unwrap()) };
    st_map.size("40x30".parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    let mut conversion = narrow(folder, "view.png").from(format!("st-map:file={}", map.display()).parse().unwrap());
    conversion.geometry.to = None;
    assert_same_from_memory(folder, conversion);
}
