//! Pictures that hold several views: two fisheyes, faces that overlap, the two halves of an Omnimax frame.

use std::path::Path;
use std::process::Command;

use crate::bench::{Bench, assert_says, flat};
use serde_json::Value;

/// A panorama of 512×256, full of lines.
fn sky() -> Bench {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "sky.png", "--to", "equirect", "--size", "512"]);
    bench
}

/// Panorama → SPEC → panorama.
fn comes_back(bench: &Bench, spec: &str, size: &str) {
    bench.succeed(&["convert", "sky.png", "sheet.png", "-y", "--to", spec, "--size", size]);
    bench.succeed(&["convert", "sheet.png", "back.png", "-y", "--from", spec, "--to", "equirect", "--size", "512"]);
    bench.succeed(&["compare", "back.png", "sky.png", "--min-psnr", "26", "--max-shift", "0.005"]);
}

#[test]
fn two_fisheyes_come_back() {
    let bench = sky();
    for (keys, size) in [
        ("", "320"),
        (":fov=210,layout=top-bottom,order=bf,yaw=20,pitch=10", "320x640"),
        (":flip=xy,lens=equisolid,back.fov=220,feather=5", "640x320"),
        (":front.roll=90,back.roll=-90,back.yaw=0.5,front.pitch=-0.4", "320"),
        (":front.center=158.5:161,front.radius=155,back.center=482:159.5,back.radius=154", "640x320"),
    ] {
        comes_back(&bench, &format!("dual-fisheye{keys}"), size);
    }
}

#[test]
fn a_circle_alone_has_the_width_that_is_given() {
    let bench = sky();
    bench.succeed(&["convert", "sky.png", "two.png", "--to", "dual-fisheye:layout=top-bottom", "--size", "64"]);
    let two = bench.load("two.png");
    assert_eq!((two.width(), two.height()), (64, 128));
    // Black outside the circles, the front's colours in the middle of the first.
    assert_eq!(&crate::bench::eight_bits(&two)[..3], [0, 0, 0]);
    let refused = |code: i32, from: &str, says: &str| {
        let args = ["convert", "two.png", "out.png", "--from", from, "--to", "equirect"];
        assert_says(&bench.fail(code, &args), &[says]);
    };
    refused(1, "dual-fisheye:layout=top-bottom,fov=150", "look where no view does");
    refused(2, "dual-fisheye:front.fvo=1", "unknown key 'front.fvo'");
    refused(2, "dual-fisheye:side.fov=1", "LENS.fov");
    refused(2, "dual-fisheye:order=ff", "expected one of fb, bf");
    refused(2, "dual-fisheye:canvas=9x9+0+0", "place them by center");
    bench.save("odd.png", &flat(65, 64, &[1, 2, 3]));
    let odd = ["convert", "odd.png", "out.png", "--from", "dual-fisheye", "--to", "equirect"];
    assert_says(&bench.fail(1, &odd), &["odd.png", "65x64", "even width"]);
}

#[test]
fn ffmpeg_finds_the_same_world_in_two_fisheyes_and_we_in_its_own() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        assert!(std::env::var_os("CI").is_none(), "ffmpeg is not installed");
        println!("SKIPPED: ffmpeg is not installed");
        return;
    }
    let bench = sky();
    let ffmpeg = |input: &str, graph: &str, output: &str| {
        let (input, output) = (bench.path(input), bench.path(output));
        let files = ["-v", "error", "-y", "-i"];
        let run = Command::new("ffmpeg").args(files).arg(input).args(["-vf", graph]).arg(output).output().unwrap();
        assert!(run.status.success(), "{graph}: {}", crate::bench::text(&run.stderr));
    };
    for fov in ["180", "195"] {
        let spec = format!("dfisheye:fov={fov}");
        let to = format!("v360=e:dfisheye:w=640:h=320:h_fov={fov}:v_fov={fov}:interp=lanczos");
        ffmpeg("sky.png", &to, "theirs.png");
        // The panorama that it reads has its samples on the edges.
        let panorama = ["--to", "equirect:samples=edges", "--size", "512"];
        bench.succeed(&[&["convert", "theirs.png", "back.png", "-y", "--from", &spec], &panorama[..]].concat());
        bench.succeed(&["compare", "back.png", "sky.png", "--min-psnr", "27", "--max-shift", "0.005"]);
        // The circle that it reads goes from the first pixel's centre to the last one's.
        let circles = "front.center=480:160,front.radius=159.5,back.center=160:160,back.radius=159.5";
        let spec = format!("{spec},{circles}");
        bench.succeed(&["convert", "sky.png", "ours.png", "-y", "--to", &spec, "--size", "640x320"]);
        let from = format!("v360=dfisheye:e:w=512:h=256:ih_fov={fov}:iv_fov={fov}:interp=lanczos");
        ffmpeg("ours.png", &from, "read.png");
        bench.succeed(&["compare", "read.png", "sky.png", "--min-psnr", "27", "--max-shift", "0.005"]);
    }
}

#[test]
fn faces_that_overlap_come_back_in_every_layout() {
    let bench = sky();
    for layout in ["strip-h", "strip-v", "3x2", "2x3", "cross-h", "cross-v", "eac"] {
        comes_back(&bench, &format!("cube:layout={layout},fov=100"), "160");
    }
    comes_back(&bench, "cube:layout=cross-v,fov=110,feather=8,yaw=20,rotate=012332", "180");
    bench.succeed(&["convert", "sky.png", "face_{face}.png", "--to", "cube:fov=100", "--size", "160"]);
    let to = ["--to", "equirect", "--size", "512"];
    bench.succeed(&[&["convert", "face_{face}.png", "wide.png", "--from", "cube:fov=100"], &to[..]].concat());
    bench.succeed(&["compare", "wide.png", "sky.png", "--min-psnr", "26", "--max-shift", "0.005"]);
    // Read as if they met at the edges, the world is another.
    bench.succeed(&[&["convert", "face_{face}.png", "wrong.png"], &to[..]].concat());
    let compared = bench.run(&["compare", "wrong.png", "sky.png", "--min-psnr", "26"]);
    assert_eq!(compared.status.code(), Some(1));
}

#[test]
fn faces_that_do_not_meet_leave_holes_and_only_whole_cubes_are_environments() {
    let bench = sky();
    bench.succeed(&["convert", "sky.png", "face_{face}.png", "--to", "cube:fov=80", "--size", "32"]);
    let from = ["convert", "face_{face}.png", "out.png", "--from", "cube:fov=80", "--to", "equirect"];
    assert_says(&bench.fail(1, &from), &["pixels look where no view does", "yaw", "--missing"]);
    bench.succeed(&[&from[..], &["--missing", "grey"]].concat());
    let refused = |spec: &str, output: &str, says: &str| {
        assert_says(&bench.fail(2, &["convert", "sky.png", output, "--to", spec, "--size", "32"]), &[says]);
    };
    refused("cube:fov=180", "w_{face}.png", "less than 180°");
    refused("cube:feather=5", "w_{face}.png", "faces that overlap, as with fov=100");
    refused("cube:fov=100,feather=0", "w_{face}.png", "more than 0");
    refused("cube:fov=100", "cube.ktx2", "whole faces of a cube");
    bench.succeed(&["convert", "sky.png", "cube.exr", "--to", "cube:fov=100", "--size", "32"]);
    assert!(!bench.succeed(&["info", "cube.exr"]).contains("envmap"));
}

/// Views that share a file are read from it, whatever file came before.
#[test]
fn a_world_of_several_images_with_several_views() {
    let bench = sky();
    bench.save("dark.png", &flat(256, 128, &[10, 10, 10]));
    bench.save("bright.png", &flat(256, 128, &[200, 200, 200]));
    for (input, output) in [("dark.png", "a.png"), ("bright.png", "b.png")] {
        bench.succeed(&["convert", input, output, "--to", "cube:layout=3x2", "--size", "32"]);
    }
    let view =
        |image: &str, faces: &str| format!("[[view]]\nimage = \"{image}\"\nspec = \"cube:layout=3x2,faces={faces}\"\n");
    std::fs::write(bench.path("w.toml"), view("a.png", "front,left,up") + &view("b.png", "back,right,down")).unwrap();
    bench.succeed(&["convert", "w.toml", "out_{face}.png", "--to", "cube", "--size", "32"]);
    for (face, code) in [("front", 10), ("left", 10), ("top", 10), ("back", 200), ("right", 200), ("bottom", 200)] {
        let out = bench.load(&format!("out_{face}.png"));
        // Away from the edges, where neighbours of the other brightness come in.
        let middle = (16 * 32 + 16) * 3;
        assert_eq!(crate::bench::eight_bits(&out)[middle], code, "{face}");
    }
    // One face of a sheet is a sheet still.
    bench.succeed(&["convert", "sky.png", "one.png", "--to", "cube:layout=3x2,faces=right", "--size", "32"]);
    assert_eq!(bench.load("one.png").width(), 96);
}

/// The paper's other way: two views for the halves of the frame. Four faces hold more where the audience looks.
#[test]
fn an_omnimax_frame_from_two_views_and_why_four_faces_are_better() {
    let bench = sky();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/two-view-omnimax");
    std::fs::copy(folder.join("world.toml"), bench.path("world.toml")).unwrap();
    for (name, yaw) in [("left.png", "-30"), ("right.png", "30")] {
        let to = ["--to", "perspective:fov=124,vfov=143", "--pitch", "22", "--size", "284x452", "--yaw", yaw];
        bench.succeed(&[&["convert", "builtin:directions", name], &to[..]].concat());
    }
    let frame = ["--to", "omnimax", "--size", "492x360"];
    bench.succeed(&[&["convert", "world.toml", "dome.png"], &frame[..]].concat());
    bench.succeed(&[&["convert", "builtin:directions", "direct.png"], &frame[..]].concat());
    bench.succeed(&["compare", "dome.png", "direct.png", "--region", "omnimax", "--min-psnr", "50"]);
    // As many texels, in four faces.
    let faces = ["--from", "cube:faces=front+left+right+up", "--input-size", "253"];
    let explain = |input: &[&str]| -> Value {
        serde_json::from_str(&bench.succeed(&[&["explain", "--json"], input, &frame[..]].concat())).unwrap()
    };
    let most_central = |report: &Value| report[0]["centre"]["texels_a_pixel"][0].as_f64().unwrap();
    let (two, four) = (explain(&["world.toml"]), explain(&faces));
    let (two, four) = (most_central(&two), most_central(&four));
    println!("texels a pixel at the centre: two views {two:.2}, four faces {four:.2}");
    assert!(four > 1.2 * two, "two views {two}, four faces {four}");
}
