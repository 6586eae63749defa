//! The faces of a cube in one image: there and back, half cubes, other programs' pictures, and what is refused.

use std::process::Command;

use crate::bench::{Bench, flat, word};
use cosmorama::sphere::CubeFace;
use serde_json::Value;

const SIZE: &str = "32";

/// Faces in PNG files, as any conversion would write them.
fn faces(bench: &Bench) {
    bench.faces("drawn_", 40);
    bench.succeed(&["convert", "drawn_{face}.png", "world_{face}.png", "--size", SIZE]);
}

fn assert_same_faces(bench: &Bench, prefix: &str, why: &str) {
    for face in CubeFace::ALL {
        let (made, direct) = (format!("{prefix}{}.png", word(face)), format!("direct_{}.png", word(face)));
        let (made, direct) = (bench.load(&made), bench.load(&direct));
        let pairs = crate::bench::eight_bits(&made).iter().zip(crate::bench::eight_bits(&direct));
        let differences: Vec<u8> = pairs.map(|(a, b)| a.abs_diff(*b)).filter(|difference| *difference > 0).collect();
        // Texels that lie turned are added in another order, and a value between two codes may round to either.
        let most = if why.contains("rotate") { 10 } else { 0 };
        let is_same = differences.len() <= most && differences.iter().all(|difference| *difference == 1);
        assert!(is_same, "{why}: the {face} face differs by {differences:?}");
    }
}

/// Faces → one image → faces gives what faces → faces → faces gives: to the last bit, where no picture is turned.
fn comes_back(bench: &Bench, spec: &str) {
    bench.succeed(&["convert", "drawn_{face}.png", "sheet.png", "-y", "--to", spec, "--size", SIZE]);
    bench.succeed(&["convert", "sheet.png", "back_{face}.png", "-y", "--from", spec, "--size", SIZE]);
    assert_same_faces(bench, "back_", spec);
}

#[test]
fn every_layout_order_and_turn_comes_back() {
    let bench = Bench::new();
    faces(&bench);
    bench.succeed(&["convert", "world_{face}.png", "direct_{face}.png", "--size", SIZE]);
    for layout in ["strip-h", "strip-v", "3x2", "2x3", "cross-h", "cross-v"] {
        comes_back(&bench, &format!("cube:layout={layout}"));
    }
    for turns in ["000000", "111111", "222222", "333333", "012332"] {
        comes_back(&bench, &format!("cube:layout=cross-v,rotate={turns}"));
    }
    for order in ["ffmpeg", "kartavr", "navegar", "envutil", "bdfulr"] {
        comes_back(&bench, &format!("cube:layout=3x2,order={order}"));
    }
    for flip in ["x", "y", "xy"] {
        comes_back(&bench, &format!("cube:layout=cross-h,flip={flip}"));
    }
    // Files may lie on their sides, too.
    let turned = "cube:rotate=012301";
    bench.succeed(&["convert", "drawn_{face}.png", "turned_{face}.png", "--to", turned, "--size", SIZE]);
    bench.succeed(&["convert", "turned_{face}.png", "back_{face}.png", "-y", "--from", turned, "--size", SIZE]);
    assert_same_faces(&bench, "back_", turned);
}

#[test]
fn equal_angles_and_samples_on_the_edges_come_back_nearly() {
    let bench = Bench::new();
    bench.faces("drawn_", 96);
    bench.succeed(&["convert", "drawn_{face}.png", "direct.exr", "--to", "equirect", "--size", "192"]);
    for spec in ["cube:layout=eac", "cube:layout=strip-v,order=openexr", "cube:layout=2x3,samples=edges"] {
        bench.succeed(&["convert", "drawn_{face}.png", "sheet.png", "-y", "--to", spec, "--size", "96"]);
        bench.succeed(&["convert", "sheet.png", "back.exr", "-y", "--from", spec, "--to", "equirect", "--size", "192"]);
        bench.succeed(&["compare", "back.exr", "direct.exr", "--min-psnr", "35", "--max-shift", "0.01"]);
    }
}

#[test]
fn a_mirrored_picture_is_the_mirrored_picture() {
    let bench = Bench::new();
    faces(&bench);
    let to = |name: &str, spec: &str| {
        bench.succeed(&["convert", "world_{face}.png", name, "--to", spec, "--size", SIZE]);
        bench.load(name)
    };
    let (plain, mirrored) = (to("a.png", "cube:layout=cross-h"), to("b.png", "cube:layout=cross-h,flip=x"));
    let (plain, mirrored) = (crate::bench::eight_bits(&plain), crate::bench::eight_bits(&mirrored));
    let columns = 4 * 32;
    for (row, mirrored) in plain.chunks(columns * 3).zip(mirrored.chunks(columns * 3)) {
        let reversed: Vec<u8> = row.chunks(3).rev().flatten().copied().collect();
        assert_eq!(reversed, mirrored);
    }
}

#[test]
fn half_a_cube_makes_a_dome() {
    let bench = Bench::new();
    faces(&bench);
    bench.succeed(&["convert", "world_{face}.png", "whole.png", "--to", "fulldome", "--size", "64"]);
    for (spec, size) in [("cube:layout=cross-h,half=up", (128, 48)), ("cube:layout=strip-h,half=up", (192, 32))] {
        bench.succeed(&["convert", "world_{face}.png", "sky.png", "-y", "--to", spec, "--size", SIZE]);
        let sky = bench.load("sky.png");
        assert_eq!((sky.width(), sky.height()), size, "{spec}");
        bench.succeed(&["convert", "sky.png", "dome.png", "-y", "--from", spec, "--to", "fulldome", "--size", "64"]);
        bench.succeed(&["compare", "dome.png", "whole.png", "--min-psnr", "35"]);
        let message = bench.fail(1, &["convert", "sky.png", "all.png", "--from", spec, "--to", "equirect"]);
        assert!(message.contains("does not cover"), "{message}");
    }
    // In files of their own the sides are half as high, and there is no floor.
    bench.succeed(&["convert", "world_{face}.png", "half_{face}.png", "--to", "cube:half=up", "--size", SIZE]);
    let side = bench.load("half_left.png");
    assert_eq!((side.width(), side.height()), (32, 16));
    assert!(!bench.path("half_bottom.png").exists());
    let half = ["--from", "cube:half=up", "--to", "fulldome", "--size", "64"];
    bench.succeed(&[&["convert", "half_{face}.png", "dome.png", "-y"], &half[..]].concat());
    bench.succeed(&["compare", "dome.png", "whole.png", "--min-psnr", "35"]);
}

#[test]
fn openexr_files_say_what_they_are() {
    let bench = Bench::new();
    faces(&bench);
    let at_centres = ("cube.exr", "cube", None);
    let specs = ["cube:samples=edges", "cube:layout=strip-v,order=openexr"];
    bench.succeed(&["convert", "world_{face}.png", "b.png", "--to", "equirect", "--size", "64"]);
    for (name, spec, envmap) in specs.into_iter().map(|spec| ("edges.exr", spec, Some("cube"))).chain([at_centres]) {
        bench.succeed(&["convert", "world_{face}.png", name, "-y", "--to", spec, "--size", SIZE]);
        let info: Value = serde_json::from_str(&bench.succeed(&["info", name, "--json"])).unwrap();
        assert_eq!((info["envmap"].as_str(), info["height"].as_u64()), (envmap, Some(192)), "{spec}");
        bench.succeed(&["convert", name, "a.png", "-y", "--to", "equirect", "--size", "64"]);
        bench.succeed(&["compare", "a.png", "b.png", "--min-psnr", "30", "--max-shift", "0.02"]);
    }
    // Another layout is no environment map of OpenEXR's.
    bench.succeed(&["convert", "world_{face}.png", "c.exr", "--to", "cube:layout=3x2", "--size", SIZE]);
    let info: Value = serde_json::from_str(&bench.succeed(&["info", "c.exr", "--json"])).unwrap();
    assert!(info.get("envmap").is_none());
}

/// OpenEXR's own pictures hold one world in both forms.
#[test]
fn openexrs_cube_and_panorama_agree() {
    let Some(folder) = testkit::shared("data/openexr_envmap") else { return };
    let bench = Bench::new();
    for (cube, panorama, least) in
        [("KernerEnvCube", "KernerEnvLatLong", 38.0), ("OrientationCube", "OrientationLatLong", 31.0)]
    {
        let at = |name: &str| folder.join(name).with_extension("exr").display().to_string();
        bench.succeed(&[
            "convert",
            &at(cube),
            "made.exr",
            "-y",
            "--to",
            "equirect:samples=edges",
            "--size",
            "1024x512",
        ]);
        let report = bench.succeed(&["compare", "made.exr", &at(panorama), "--json"]);
        let report: Value = serde_json::from_str(&report).unwrap();
        let (encoded, shift) = (report["srgb"]["psnr"].as_f64().unwrap(), report["shift"]["pixels"].as_f64().unwrap());
        println!("{cube}: {encoded:.2} dB, shift {shift:.4} px");
        assert!(encoded > least && shift < 0.02, "{cube}: {encoded} dB, shift {shift} px");
    }
}

/// The six files that exrenvmap makes of a panorama give that panorama back: its middle is +Z.
#[test]
fn the_faces_of_exrenvmap_have_its_own_front() {
    let Some(folder) = testkit::shared("data/openexr_envmap") else { return };
    let bench = Bench::new();
    let panorama = folder.join("OrientationLatLong.exr").display().to_string();
    let arguments = ["-c", "-w", "256", &panorama, "face%.exr"];
    let ran = std::process::Command::new("exrenvmap").current_dir(bench.path(".")).args(arguments).status();
    if ran.is_err() {
        assert!(std::env::var_os("CI").is_none(), "exrenvmap is not installed");
        eprintln!("SKIPPED: exrenvmap is not installed");
        return;
    }
    bench.succeed(&["convert", "face{face}.exr", "made.exr", "--to", "equirect:samples=edges", "--size", "1024x512"]);
    bench.succeed(&["compare", "made.exr", &panorama, "--min-psnr", "27", "--max-shift", "0.01"]);
    // And ours are its own: the strip of faces that it makes of ours is that of its own.
    let named = ["--to", "cube:naming=exrenvmap", "--size", "256"];
    bench.succeed(&[&["convert", &panorama, "ours{face}.exr"][..], &named].concat());
    bench.succeed(&["compare", "ours+X.exr", "face+X.exr", "--min-psnr", "25", "--max-shift", "0.02"]);
    bench.succeed(&["compare", "ours-Y.exr", "face-Y.exr", "--min-psnr", "25", "--max-shift", "0.02"]);
}

#[test]
fn textures_hold_their_smaller_copies() {
    let bench = Bench::new();
    faces(&bench);
    for (name, depth) in [("cube.ktx2", "8"), ("cube.dds", "half")] {
        let to = ["--to", "cube", "--size", SIZE, "--depth", depth];
        bench.succeed(&[&["convert", "world_{face}.png", name, "--mips"][..], &to].concat());
        bench.succeed(&[&["convert", "world_{face}.png", "one.ktx2", "-y"][..], &to].concat());
        // The largest is what it would be alone.
        let (levels, one) = (bench.load(name), bench.load("one.ktx2"));
        assert!(levels == one, "{name}");
        let texel = if depth == "8" { 4 } else { 8 };
        let texels: usize = [32, 16, 8, 4, 2, 1].iter().map(|edge| 6 * edge * edge).sum();
        let size = bench.bytes(name).len();
        assert!((texels * texel..texels * texel + 600).contains(&size), "{name}: {size} bytes");
    }
    let png = ["convert", "world_{face}.png", "no.png", "--to", "equirect", "--size", "64", "--mips"];
    assert!(bench.fail(2, &png).contains("--mips is for textures"));
}

#[test]
fn textures_hold_cubes_and_nothing_else() {
    let bench = Bench::new();
    faces(&bench);
    // With alpha, as textures have it: opaque pictures are filtered in integers, which differ from floats by a code here and
    // there.
    let veiled = ["--size", SIZE, "--missing", "transparent", "-y"];
    bench.succeed(&[&["convert", "drawn_{face}.png", "world_{face}.png"][..], &veiled].concat());
    bench.succeed(&[&["convert", "world_{face}.png", "direct_{face}.png"][..], &veiled].concat());
    for name in ["cube.ktx2", "cube.dds"] {
        bench.succeed(&["convert", "drawn_{face}.png", name, "--to", "cube", "--size", SIZE]);
        bench.succeed(&["convert", name, "back_{face}.png", "-y", "--size", SIZE]);
        for face in CubeFace::ALL {
            let (made, direct) = (format!("back_{}.png", word(face)), format!("direct_{}.png", word(face)));
            bench.succeed(&["compare", &made, &direct, "--min-psnr", "120"]);
        }
    }
    let refused = |to: &str| bench.fail(2, &["convert", "world_{face}.png", "a.ktx2", "--to", to, "--size", SIZE]);
    for to in ["equirect", "cube:layout=3x2", "cube:order=kartavr", "cube:half=up", "cube:faces=front"] {
        let message = refused(to);
        assert!(message.contains("the six whole faces of a cube"), "{to}: {message}");
    }
}

#[test]
fn ffmpeg_finds_the_same_world_in_our_layouts() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        assert!(std::env::var_os("CI").is_none(), "ffmpeg is not installed");
        println!("SKIPPED: ffmpeg is not installed");
        return;
    }
    let bench = Bench::new();
    bench.faces("drawn_", 96);
    bench.succeed(&["convert", "drawn_{face}.png", "direct.png", "--to", "equirect", "--size", "192"]);
    // Its own EAC leaves two pixels of rim around each row.
    let rim = "split[a][b];[a]crop=288:96:0:0,pad=292:100:2:2[x];[b]crop=288:96:0:96,pad=292:100:2:2[y];[x][y]vstack,";
    for (spec, before, layout) in [
        ("cube:layout=strip-h", "", "c6x1"),
        ("cube:layout=strip-v", "", "c1x6"),
        ("cube:layout=3x2", "", "c3x2"),
        ("cube:layout=3x2,order=bdfulr,rotate=012312", "", "c3x2:e:in_forder=bdfulr:in_frot=012312"),
        ("cube:layout=eac", rim, "eac"),
    ] {
        bench.succeed(&["convert", "drawn_{face}.png", "sheet.png", "-y", "--to", spec, "--size", "96"]);
        let to_panorama = if layout.contains(':') { "" } else { ":e" };
        let graph = format!("{before}v360={layout}{to_panorama}:w=192:h=96:interp=linear");
        let run = Command::new("ffmpeg")
            .args(["-v", "error", "-y", "-i"])
            .arg(bench.path("sheet.png"))
            .args(["-filter_complex", &graph])
            .arg(bench.path("theirs.png"))
            .output()
            .unwrap();
        assert!(run.status.success(), "{spec}: {}", crate::bench::text(&run.stderr));
        bench.succeed(&["compare", "theirs.png", "direct.png", "--min-psnr", "30", "--max-shift", "0.03"]);
    }
}

#[test]
fn the_shape_of_a_strip_tells() {
    let bench = Bench::new();
    faces(&bench);
    bench.succeed(&["convert", "world_{face}.png", "strip.png", "--to", "cube:layout=strip-h", "--size", SIZE]);
    let output = bench.run(&["convert", "strip.png", "sky.png", "--to", "equirect"]);
    let said = crate::bench::text(&output.stderr);
    assert!(output.status.success() && said.contains("--from cube:layout=strip-h"), "{said}");
}

#[test]
fn what_is_no_layout_is_refused() {
    let bench = Bench::new();
    faces(&bench);
    bench.save("photo.png", &flat(48, 32, &[9, 9, 9]));
    let refused = |code: i32, args: &[&str], says: &str| {
        let message = bench.fail(code, args);
        assert!(message.contains(says), "{args:?} says {message}");
    };
    let sky = ["--to", "equirect", "--size", "64"];
    let from = |spec: &'static str| [&["convert", "photo.png", "sky.png", "--from", spec], &sky[..]].concat();
    refused(1, &from("cube:layout=cross-h"), "whose shape is 4:3; of that shape: 3x2, eac");
    refused(1, &from("cube:layout=cross-h,half=up"), "whose shape is 8:3");
    refused(2, &from("cube"), "cube:layout=3x2 or cube:layout=eac");
    refused(2, &from("cube:layout=5x1"), "expected one of faces, strip-h");
    refused(2, &from("cube:order=rludff"), "each of r, l, u, d, f and b once");
    refused(2, &from("cube:rotate=01234"), "six quarter turns");
    refused(2, &from("cube:layout=3x2,naming=bourke"), "expected layout=faces");
    refused(2, &from("cube:layout=faces,order=rludfb"), "naming=");
    refused(2, &from("cube:layout=faces"), "a file for each face");
    refused(1, &[&["convert", "photo.png", "sky.png"], &sky[..]].concat(), "cube:layout=3x2, cube:layout=eac");
    refused(2, &["convert", "world_{face}.png", "a.png", "--to", "cube"], "cube:layout=strip-h, strip-v, 3x2");
    refused(2, &["convert", "world_{face}.png", "a_{face}.png", "--to", "cube:layout=3x2"], "leave {face} or %c out");
    let odd = ["convert", "world_{face}.png", "a.png", "--to", "cube:layout=cross-h,half=up", "--size", "33"];
    refused(2, &odd, "an even number is needed");
    let shape = ["convert", "world_{face}.png", "a.png", "--to", "cube:layout=3x2", "--size", "64x64"];
    refused(2, &shape, "whose shape is 3:2");
}
