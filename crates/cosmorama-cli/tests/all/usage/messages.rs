//! Everything that the program says: some hundred commands with their exit codes, standard output and standard error.
//!
//! `messages.txt` lists each command after `$`, as a shell would take it (single quotes, `< FILE`), and what it says. After a
//! change that is meant: `UPDATE_GOLDENS=1 cargo test -p cosmorama-cli messages`, and read the difference.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};

use crate::bench::{Bench, flat, floats, picture, text, veiled};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Samples, Transfer};
use cosmorama_io::{LayeredImage, Plane, PlaneSamples, WriteOptions, write_layers};

const MESSAGES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/all/usage/messages.txt");

#[test]
fn messages_stay_as_they_are() {
    let stored = fs::read_to_string(MESSAGES).unwrap();
    let bench = inputs();
    let mut found = String::new();
    for line in stored.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            let _ = write!(found, "{line}\n{}\n", said(&bench, command));
        } else if line.starts_with("# ") {
            let _ = write!(found, "{line}\n\n");
        }
    }
    if std::env::var_os("UPDATE_GOLDENS").is_some() {
        fs::write(MESSAGES, found).unwrap();
        return;
    }
    let difference = stored.lines().zip(found.lines()).position(|(stored, found)| stored != found);
    if let Some(at) = difference {
        let command = stored.lines().take(at + 1).filter(|line| line.starts_with("$ ")).last();
        let line = |text: &str| text.lines().nth(at).unwrap_or_default().to_owned();
        panic!("{}\nstored: {}\nfound:  {}", command.unwrap_or_default(), line(&stored), line(&found));
    }
    assert_eq!(stored, found);
}

/// Runs a command in the folder, which it leaves as it was: what it says, and its exit code.
fn said(bench: &Bench, command: &str) -> String {
    let (before, folders) = (bench.files(), bench.folders());
    let mut words = words(command).into_iter();
    let mut call = Command::new(program());
    call.current_dir(bench.path("")).stdin(Stdio::null()).env("COLUMNS", "100").env("TMPDIR", bench.path(""));
    assert_eq!(words.next().as_deref(), Some("cosmorama"), "{command}");
    while let Some(word) = words.next() {
        if word == "<" {
            call.stdin(File::open(bench.path(&words.next().unwrap())).unwrap());
        } else {
            call.arg(word);
        }
    }
    let output = call.output().unwrap();
    let mut said = format!("exit {}\n", output.status.code().unwrap());
    for (stream, bytes) in [("out", &output.stdout), ("err", &output.stderr)] {
        for line in text(bytes).replace(&bench.path("").display().to_string(), "FOLDER/").lines() {
            let _ = writeln!(said, "{}", format!("{stream}: {}", steady(line)).trim_end());
        }
    }
    for made in bench.files().difference(&before) {
        fs::remove_file(made).unwrap();
    }
    // Inner folders come after those that they are in.
    let made: Vec<_> = bench.folders().difference(&folders).cloned().collect();
    made.iter().rev().for_each(|folder| fs::remove_dir(folder).unwrap());
    said
}

/// The program, or another one to compare with.
fn program() -> String {
    std::env::var("COSMORAMA").unwrap_or_else(|_| env!("CARGO_BIN_EXE_cosmorama").to_owned())
}

/// A command's words, of which single quotes hold together.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for (index, part) in command.split('\'').enumerate() {
        if index % 2 == 1 {
            words.last_mut().unwrap().push_str(part);
            continue;
        }
        for (index, word) in part.split(' ').enumerate() {
            if index > 0 {
                words.push(String::new());
            }
            words.last_mut().unwrap().push_str(word);
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Figures that differ from run to run, or from one number of cores to another.
const UNSTEADY: [&str; 10] = [
    "wall_seconds",
    "peak_memory_bytes",
    "estimated_memory_bytes",
    "picture_memory_bytes",
    "sequence_memory_bytes",
    "decode",
    "plan",
    "filter",
    "encode",
    "seconds_per_frame",
];

/// A line without what differs from run to run: times, the most memory that was held, and that which so many cores would need.
fn steady(line: &str) -> String {
    if let Some((kind, _)) = line.strip_prefix("cost     ").and_then(|line| line.split_once(": ")) {
        return format!("cost     {kind}: MEMORY");
    }
    if let Some((key, _)) = line.split_once(": ").filter(|(key, _)| UNSTEADY.contains(&key.trim().trim_matches('"'))) {
        return format!("{key}: TIME");
    }
    // What the machine has is none of the program's words.
    for begin in ["memory: ", "frames: "] {
        if line.starts_with(begin) && (line.contains("may be used") || line.contains("are free")) {
            return format!("{begin}MACHINE");
        }
    }
    let words: Vec<&str> = line.split(' ').collect();
    let is_time = |at: usize| {
        let unit = words.get(at + 1).map(|word| word.trim_end_matches(|mark: char| !mark.is_alphabetic()));
        let is_rate = words.get(at + 1..at + 3) == Some(&["a", "second,"]);
        words[at].parse::<f64>().is_ok() && (is_rate || ["s", "ms"].contains(&unit.unwrap_or_default()))
    };
    let steady: Vec<&str> = (0..words.len()).map(|at| if is_time(at) { "TIME" } else { words[at] }).collect();
    steady.join(" ")
}

/// The files that the commands read.
fn inputs() -> Bench {
    let bench = Bench::new();
    pictures(&bench);
    sequences(&bench);
    worlds(&bench);
    for folder in ["none", "diagrams", "taken.png"] {
        fs::create_dir(bench.path(folder)).unwrap();
    }
    fs::write(bench.path("diagrams/ownership.png"), "mine").unwrap();
    cameras(&bench);
    made(&bench);
    bench
}

fn pictures(bench: &Bench) {
    for (name, width, height) in [
        ("sky.png", 64, 32),
        ("sky.jpg", 64, 32),
        ("small.png", 32, 16),
        ("photo.png", 50, 37),
        ("square.png", 64, 64),
        ("cross.png", 64, 48),
        ("sheet.png", 48, 32),
        ("odd.png", 63, 33),
        ("wide.png", 96, 64),
        ("there.png", 4, 4),
    ] {
        bench.save(name, &picture(1, width, height));
    }
    bench.save("dark.png", &flat(64, 48, &[0, 0, 0]));
    bench.save("grey.png", &flat(64, 32, &[77]));
    bench.save("alpha.png", &flat(64, 32, &[10, 20, 30, 64]));
    bench.save("patches.png", &patchwork(256, 128));
    bench.save("nan.exr", &floats(64, 32, |_, _| [f32::NAN; 3]));
    bench.save("half-nan.exr", &floats(64, 32, |_, j| if j < 16 { [f32::NAN; 3] } else { [0.5; 3] }));
    bench.save("veil.exr", &veiled(64, 32, |i, j| if i < 8 && j < 4 { [f32::NAN; 3] } else { [0.5; 3] }));
    bench.save("suns.exr", &floats(128, 64, |i, j| if i == 32 && j == 16 { [90000.0; 3] } else { [0.5; 3] }));
    bench.save("lamps.exr", &floats(128, 64, |i, j| if i == 32 && j == 16 { [80000.0; 3] } else { [0.5; 3] }));
    // An infinite pixel, one with an alpha below 0 and one that is NaN.
    let odd = [[f32::INFINITY, 0.5, 0.5, 1.0], [0.5, 0.5, 0.5, -1.0], [f32::NAN, 0.5, 0.5, 1.0]];
    let odd = (0..64 * 32).flat_map(|index| odd.get(index).copied().unwrap_or([0.5, 0.5, 0.5, 1.0])).collect();
    bench.save("odd.exr", &EncodedImage::new(64, 32, Channels::Rgba, Depth::Float, Samples::Float(odd)).unwrap());
    let one = EncodedImage::new(2, 2, Channels::Grey, Depth::Float, Samples::Float(vec![0.5; 4])).unwrap();
    bench.save("one.exr", &one);
    layered(bench);
    let whole = bench.bytes("sky.png");
    fs::write(bench.path("cut.png"), &whole[..whole.len() * 2 / 3]).unwrap();
    fs::write(bench.path("empty.png"), "").unwrap();
    fs::write(bench.path("notes.png"), "not a picture").unwrap();
    bench.faces("face_", 64);
    bench.faces("lost/", 64);
    fs::remove_file(bench.path("lost/right.png")).unwrap();
    bench.faces("shape/", 64);
    bench.save("shape/top.png", &picture(4, 64, 40));
    bench.faces("crop/", 64);
    bench.save("crop/left.png", &picture(3, 20, 64));
    for name in ["front", "left", "f", "l"] {
        bench.save(&format!("two/{name}.png"), &picture(0, 16, 16));
    }
}

/// A panorama with channels beside its picture, channels without any, and a file of two parts.
fn layered(bench: &Bench) {
    let samples = |value: f32| PlaneSamples::Float(vec![value; 64 * 32]);
    let plane = |name: &str, samples| Plane { name: name.to_owned(), samples };
    let normal = ["N.X", "N.Y", "N.Z"].map(|name| plane(name, samples(0.5)));
    let ids = plane("objectId", PlaneSamples::Uint(vec![7; 64 * 32]));
    let depth = plane("Z", samples(3.0));
    let light = ["R", "G", "B"].map(|name| plane(&format!("diffuse.{name}"), samples(0.25)));
    let image = floats(64, 32, |_, _| [0.5; 3]);
    let all = normal.into_iter().chain([ids, depth.clone()]).chain(light).collect();
    for (name, picture, planes) in [("layers.exr", Some(&image), all), ("depth.exr", None, vec![depth])] {
        let layered = LayeredImage { size: (64, 32), picture, names: Vec::new(), planes };
        write_layers(bench.path(name), layered, &WriteOptions::default()).unwrap();
    }
    use exr::prelude::WritableImage as _;
    let part = |name: &str, value: f32| {
        use exr::prelude::{Encoding, Layer, LayerAttributes, SpecificChannels, Vec2};
        let channels = SpecificChannels::rgb(move |_: Vec2<usize>| (value, value, value));
        Layer::new((64, 32), LayerAttributes::named(name), Encoding::UNCOMPRESSED, channels)
    };
    let size = exr::prelude::IntegerBounds::from_dimensions((64, 32));
    let parts = exr::prelude::Image::empty(exr::prelude::ImageAttributes::new(size));
    parts
        .with_layer(part("left", 0.5))
        .with_layer(part("right", 0.25))
        .write()
        .to_file(bench.path("parts.exr"))
        .unwrap();
}

/// A panorama of patches without any order, so that no part of it is like another.
fn patchwork(width: usize, height: usize) -> EncodedImage {
    let light = Image::from_fn(width, height, |i, j| {
        let patch = (i * 24 / width) as u32 * 92_821 + (j * 12 / height) as u32 * 68_917 + 31;
        let mixed = (patch ^ (patch >> 7)).wrapping_mul(2_654_435_761);
        let light = |bits: u32| 0.1 + 0.8 * ((mixed >> bits) & 255) as f32 / 255.0;
        Rgba::opaque(light(3), light(11), light(19))
    });
    EncodedImage::encode(&light, Channels::Rgb, Depth::Eight, &Transfer::Srgb)
}

fn sequences(bench: &Bench) {
    for frame in [1, 2, 3, 7] {
        bench.save(&format!("shot/sky_{frame:04}.png"), &picture(frame, 64, 32));
    }
    bench.save("other/sky_1.png", &picture(1, 64, 32));
    bench.save("other/sky_2.png", &picture(2, 128, 64));
    for frame in 1..=2 {
        for name in ["front", "right", "back", "left", "top", "bottom"] {
            bench.save(&format!("cube/{name}_{frame}.png"), &picture(frame, 8, 8));
        }
    }
    bench.save("single/a.png", &picture(0, 8, 8));
}

fn worlds(bench: &Bench) {
    bench.save("mask.png", &flat(50, 37, &[255]));
    bench.save("black.png", &flat(50, 37, &[0]));
    let view = "spec = \"perspective:fov=90,yaw=-30\"\n";
    for (name, world) in [
        (
            "world.toml",
            &format!(
                "[[view]]\nimage = \"photo.png\"\n{view}feather = 5\n\n[[view]]\nimage = \"sky.png\"\nspec = \
                 \"equirect\"\npriority = -1\n"
            ),
        ),
        ("lone.toml", &format!("[[view]]\nimage = \"photo.png\"\nmask = \"mask.png\"\n{view}")),
        ("black.toml", &format!("[[view]]\nimage = \"photo.png\"\nmask = \"black.png\"\n{view}")),
        ("size.toml", &format!("[[view]]\nimage = \"photo.png\"\nmask = \"sky.png\"\n{view}")),
        ("key.toml", &"[[view]]\nimage = \"photo.png\"\nspce = \"x\"\n".to_owned()),
        ("spec.toml", &"[[view]]\nimage = \"photo.png\"\nspec = \"fisheye:fvo=3\"\n".to_owned()),
        ("shape.toml", &"[[view]]\nimage = \"photo.png\"\n".to_owned()),
        ("gone.toml", &"[[view]]\n\nimage = \"gone.png\"\nspec = \"fisheye\"\n".to_owned()),
        ("self.toml", &"[[view]]\nimage = \"self.toml\"\n".to_owned()),
        ("formula.toml", &"[[view]]\nimage = \"builtin:grid\"\n".to_owned()),
        ("feather.toml", &"[[view]]\nimage = \"sky.png\"\nfeather = -2\n".to_owned()),
        ("empty.toml", &"# nothing\n".to_owned()),
        ("torn.toml", &"[[view]\n".to_owned()),
        ("good.pto", &"p f2 w200 h100 v360\ni w50 h37 f0 v90 y45 p0 r20 n\"photo.png\"\n".to_owned()),
        ("thoby.pto", &"p f0 w240 h160 v36\ni w50 h37 f20 v70 n\"photo.png\"\n".to_owned()),
        ("bent.pto", &"p f0 w240 h160 v36\ni w50 h37 f0 v70 b-0.9 n\"photo.png\"\n".to_owned()),
        ("size.pto", &"p f0 w240 h160 v36\ni w51 h37 f0 v70 n\"photo.png\"\n".to_owned()),
        ("panorama.pto", &"p f17 w240 h160 v36\ni w50 h37 f0 v70 n\"photo.png\"\n".to_owned()),
    ] {
        fs::write(bench.path(name), world).unwrap();
    }
}

fn cameras(bench: &Bench) {
    let pinhole = "%YAML:1.0\n---\nimage_width: 320\nimage_height: 240\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   \
                   cols: 3\n   dt: d\n   data: [ 200., 0., 170., 0., 210., 110., 0., 0., 1. ]\ndistortion_coefficients: \
                   !!opencv-matrix\n   data: [ -0.22, 0.045, 0.002, -0.001, 0.001 ]\n";
    fs::write(bench.path("pinhole.yml"), pinhole).unwrap();
    fs::write(bench.path("torn.yml"), &pinhole[..120]).unwrap();
}

/// Files that the program makes itself.
fn made(bench: &Bench) {
    for command in [
        "patches.png dome.png --from equirect --to fulldome --size 128",
        "patches.png two.png --from equirect --to dual-fisheye --size 128",
        "patches.png pair.png --from equirect --to equirect:stereo=tb --size 128",
        "patches.png crossed.png --from equirect --to cube:layout=cross-h --size 64",
        "patches.png oval.png --from equirect --to hammer --size 320x160 --background white",
        "patches.png part.jpg --from equirect --to equirect:hfov=180,vfov=90 --size 64x32",
        "patches.png cube.exr --from equirect --to cube --size 32",
        "photo.png map.exr --from fisheye:fov=150 --to perspective:fov=70 --size 40x30 --st-map",
        "builtin:direction-map way.exr --to fulldome --size 16",
        "builtin:demo turned/{face}.png --to cube:naming=words --size 96",
        "builtin:demo sheets.png --to cube:layout=eac --size 96",
    ] {
        fs::create_dir_all(bench.path("turned")).unwrap();
        let mut call = Command::new(program());
        call.current_dir(bench.path("")).arg("convert").args(words(command));
        let output = call.output().unwrap();
        assert!(output.status.success(), "{command}: {}", text(&output.stderr));
    }
    let path = |name: &str| bench.path("turned").join(Path::new(name));
    fs::rename(path("left.png"), path("between")).unwrap();
    fs::rename(path("right.png"), path("left.png")).unwrap();
    fs::rename(path("between"), path("right.png")).unwrap();
}
