//! World files, lists of layers and Hugin's projects, as far as a conversion follows them before it writes anything.
#![no_main]

use std::io::Cursor;
use std::sync::{Arc, LazyLock};

use cosmorama::raster::{Channels, Depth};
use cosmorama_convert::{Conversion, InMemory};
use cosmorama_fuzz::{path, picture, prepare};
use cosmorama_io::{Format, FrameList, WriteOptions, write_to};
use libfuzzer_sys::fuzz_target;

/// Memory that a conversion of a few pixels may use.
const MEMORY: &str = "256M";

/// Files that the seeds name.
static BESIDE: LazyLock<InMemory> = LazyLock::new(|| {
    let mut view = Cursor::new(Vec::new());
    let image = picture((48, 36), Channels::Rgb, Depth::Eight);
    write_to(&mut view, "view.png", Format::Png, &image, &WriteOptions::default()).expect("memory takes it");
    let camera = br#"{"image_size": [48, 36], "K": [[31, 0, 23.5], [0, 31, 17.5], [0, 0, 1]], "D": [0, 0, 0, 0, 0]}"#;
    let mut files = InMemory::default();
    files.insert("m/view.png", view.into_inner());
    files.insert("m/camera.json", camera.to_vec());
    files.insert("m/path.csv", b"frame,yaw,pitch,roll\n1,0,0,0\n3,10,0,0\n".to_vec());
    files
});

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    let name = if bytes.starts_with(b"[") { "m/world.toml" } else { "m/two.pto" };
    let mut files = BESIDE.clone();
    files.insert(name, bytes.to_vec());
    // Layers may move.
    let moves = bytes.starts_with(b"[[layer");
    let output = path(if moves { "out_#.png" } else { "out.png" }).display().to_string();
    let conversion = Conversion::new(name, output).to("perspective:fov=30".parse().expect("a projection"));
    let conversion = conversion.size("8x6".parse().expect("a size")).missing("#204060".parse().expect("a colour"));
    let conversion = if moves { conversion.frames(FrameList::new(1..=3)) } else { conversion };
    let conversion = conversion.memory(MEMORY.parse().expect("an amount")).files(Arc::new(files));
    if let Err(error) = conversion.check().result {
        assert!(!error.message().render(|_| String::new()).is_empty());
    }
});
