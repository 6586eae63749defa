//! Texts from strangers, as far as a conversion follows them: each is refused or understood, in bounded time.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use cosmorama::motion::Smoothness;
use cosmorama_convert::{CameraMovement, Conversion, Existing, InMemory, PoseFile, Quiet};
use cosmorama_io::{FrameList, Limits, read};
use testkit::Mutants;

/// Longest time that a text of some kilobytes may take.
const LONGEST: Duration = Duration::from_secs(10);

/// Memory that a conversion of a few pixels may use.
const MEMORY: &str = "256M";

/// Makes a picture of the demo, and returns its bytes.
fn picture(folder: &Path, name: &str, to: &str, size: &str) -> Vec<u8> {
    let path = folder.join(name);
    let conversion = Conversion::new("builtin:demo", path.display().to_string()).to(to.parse().unwrap());
    conversion.size(size.parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    std::fs::read(path).unwrap()
}

/// Checks a conversion, and returns whether it could run.
fn is_understood(conversion: Conversion, text: &[u8]) -> bool {
    let start = Instant::now();
    let outcome = conversion.memory(MEMORY.parse().unwrap()).check();
    if let Err(error) = &outcome.result {
        assert!(!error.message().render(|_| String::new()).is_empty());
    }
    let spent = start.elapsed();
    assert!(spent < LONGEST, "{spent:?} for {}", String::from_utf8_lossy(text));
    outcome.result.is_ok()
}

#[test]
fn world_files_and_projects_are_refused_or_understood() {
    let folder = tempfile::tempdir().unwrap();
    let view = picture(folder.path(), "view.png", "perspective:fov=75", "48x36");
    let camera = br#"{"image_size": [48, 36], "K": [[31, 0, 23.5], [0, 31, 17.5], [0, 0, 1]], "D": [0, 0, 0, 0, 0]}"#;
    let path = b"frame,yaw,pitch,roll\n1,0,0,0\n3,10,0,0\n";
    let texts: [(&str, &str, &[&str]); 3] = [
        (
            "m/world.toml",
            include_str!("../../../../fuzz/seeds/worlds/world.toml"),
            &[
                "[[view]]\n",
                "[[layer]]\n",
                "image = ",
                "\"view.png\"\n",
                "builtin:demo",
                "world.toml",
                "{face}",
                "####",
                "../",
            ],
        ),
        (
            "m/layers.toml",
            include_str!("../../../../fuzz/seeds/worlds/layers.toml"),
            &["[[layer]]\n", "loop", "step", "fps = 25\n", "layers.toml", "builtin:checker", "opacity = "],
        ),
        (
            "m/two.pto",
            include_str!("../../../../fuzz/seeds/worlds/two.pto"),
            &["\ni ", "=0", "f3 ", "S0,40,0,30 ", "n\"view.png\"", "k i1 t1 p\""],
        ),
    ];
    for (seed, (name, text, words)) in (0..).zip(texts) {
        let check = |bytes: &[u8]| {
            let mut files = InMemory::default();
            for (name, bytes) in
                [("m/view.png", &view[..]), ("m/camera.json", camera), ("m/path.csv", path), (name, bytes)]
            {
                files.insert(name, bytes.to_vec());
            }
            // Layers move.
            let moves = name.contains("layers");
            let output = folder.path().join(if moves { "out_#.png" } else { "out.png" }).display().to_string();
            let conversion = Conversion::new(name, output).to("perspective:fov=30".parse().unwrap());
            let conversion = conversion.size("8x6".parse().unwrap()).missing("#204060".parse().unwrap());
            let conversion = if moves { conversion.frames(FrameList::new(1..=3)) } else { conversion };
            is_understood(conversion.files(Arc::new(files)), bytes)
        };
        assert!(check(text.as_bytes()), "{name}");
        let understood =
            Mutants::new(text.as_bytes(), words, seed).take(Mutants::count(400)).filter(|damaged| check(damaged));
        assert!(understood.count() > 0, "{name}");
    }
}

#[test]
fn paths_of_cameras_are_refused_or_understood() {
    let folder = tempfile::tempdir().unwrap();
    let text = b"frame,yaw,pitch,roll,fov\n1,0,0,0,60\n10,30,10,0,60\n25,45,10.5,-3,70\n";
    let check = |bytes: &[u8]| {
        let mut files = InMemory::default();
        files.insert("path.csv", bytes.to_vec());
        let output = folder.path().join("out_####.png").display().to_string();
        let conversion = Conversion::new("builtin:checker", output).to("perspective:fov=60".parse().unwrap());
        let file = PoseFile { file: "path.csv".to_owned(), fps: None, smoothness: Smoothness::Smooth };
        let moved = conversion.size("8x6".parse().unwrap()).moved(CameraMovement::Path(file));
        is_understood(moved.files(Arc::new(files)), bytes)
    };
    assert!(check(text));
    let copies = Mutants::new(text, &["1e7", "frame", "360", "9999999"], 5).take(Mutants::count(300));
    assert!(copies.filter(|damaged| check(damaged)).count() > 0);
}

#[test]
fn specs_make_views_or_say_why_not() {
    let folder = tempfile::tempdir().unwrap();
    let view = picture(folder.path(), "view.png", "equirect", "64");
    let output = folder.path().join("out.png").display().to_string();
    let specs = [
        "omnimax:framing=circle,lower=45,axis=11",
        "fisheye:fov=220,lens=polynomial,k=1.2:0.1:-0.02,center=30:20,radius=25",
        "fisheye:lens=kannala-brandt,k=0.1:0.01:0.001:0,fov=190,aspect=1.2",
        "fulldome:fov=200,tilt=20",
        "equirect:hfov=180,vfov=90,yaw=10",
        "perspective:fov=90,vfov=60,roll=5,canvas=64x48+3+4",
        "mirror-ball:distance=3",
        "pannini:fov=180,d=0.5",
        "mercator:lat=80,flip=x",
        "dual-fisheye:fov=195,layout=top-bottom",
        "cube:layout=3x2,order=rludfb,rotate=012301,fov=92",
        "octahedral",
        "stereographic:fov=300",
    ];
    for (seed, spec) in (0..).zip(specs) {
        for damaged in Mutants::new(spec.as_bytes(), &["fov=", "=1e9", ":", ",", "yaw=", "k=", "canvas="], seed)
            .take(Mutants::count(150))
        {
            let Ok(text) = str::from_utf8(&damaged) else { continue };
            let start = Instant::now();
            let parsed = text.parse::<cosmorama_spec::Spec>();
            assert!(start.elapsed() < LONGEST, "{:?} to parse {text}", start.elapsed());
            let Ok(spec) = parsed else { continue };
            let to = Conversion::new("builtin:checker", &output).to(spec.clone()).size("16".parse().unwrap());
            is_understood(to, &damaged);
            let mut files = InMemory::default();
            files.insert("m/view.png", view.clone());
            let from = Conversion::new("m/view.png", &output).from(spec).to("perspective:fov=30".parse().unwrap());
            is_understood(from.size("8x6".parse().unwrap()).files(Arc::new(files)), &damaged);
        }
    }
}

/// Whatever happened to a frame: to resume makes it whole, or is refused. A frame that was cut off is always made again.
#[test]
fn a_damaged_frame_is_never_taken_for_whole() {
    let folder = tempfile::tempdir().unwrap();
    for frame in 1..=2 {
        picture(folder.path(), &format!("sky_{frame}.png"), "equirect", "32");
    }
    // Each waits for the disk most of the time.
    std::thread::scope(|scope| {
        for extension in ["png", "exr", "tif", "jpg", "hdr", "tga"] {
            let folder = folder.path();
            scope.spawn(move || damaged_frames_are_made_again(folder, extension));
        }
    });
}

/// Makes two frames of a format, and resumes after each damage to the second.
fn damaged_frames_are_made_again(folder: &Path, extension: &str) {
    let path = |name: &str| folder.join(name);
    let name = |frame: &str| path(&format!("dome_{frame}.{extension}"));
    let run = |existing: Existing| {
        let conversion = Conversion::new(path("sky_#.png").display().to_string(), name("#").display().to_string());
        let conversion = conversion.from("equirect".parse().unwrap()).to("fulldome".parse().unwrap());
        let conversion = conversion.size("12".parse().unwrap()).existing(existing).threads(1);
        conversion.check().result.and_then(|checked| checked.run(&mut Quiet))
    };
    run(Existing::Replace).unwrap();
    let good = std::fs::read(name("2")).unwrap();
    let words = ["cosmorama", ", pose ", "geometry 00000000"];
    for (mutant, damaged) in Mutants::new(&good, &words, 9).take(Mutants::count(60)).enumerate() {
        std::fs::write(name("2"), &damaged).unwrap();
        let resumed = run(Existing::Resume);
        let after = std::fs::read(name("2")).unwrap();
        if resumed.is_err() {
            assert_eq!(after, damaged, "{extension}, mutant {mutant}: refused, but changed");
            continue;
        }
        let file = read(name("2"), &Limits::default()).unwrap();
        assert_eq!((file.image.width(), file.image.height()), (12, 12), "{extension}, mutant {mutant}");
        // The last bytes of a TGA are a footer that no one needs.
        let needed = if extension == "tga" { good.len() - 26 } else { good.len() };
        let is_cut_off = good.starts_with(&damaged) && damaged.len() < needed;
        assert!(
            !is_cut_off || after == good,
            "{extension}, mutant {mutant}: cut to {} of {}",
            damaged.len(),
            good.len()
        );
    }
}
