//! Pictures need not be files.

use std::sync::Arc;

use cosmorama_convert::{Conversion, InMemory, Quiet};

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
