//! Hugin projects: ours beside what nona makes of them, and what is told of those that we cannot do.
//!
//! nona is Hugin's own resampler (Debian's hugin-tools); `.ci/run programs` installs it.

use std::process::Command;

use crate::bench::{Bench, assert_says, picture};

const IDLE: &str = "Ra0 Rb0 Rc0 Rd0 Re0 Eev0 Er1 Eb1 TrX0 TrY0 TrZ0 j0 g0 t0 Va1 Vb0 Vc0 Vd0 Vx0 Vy0";

/// A picture of the demo's arcade, and a project of it.
fn bench(panorama: &str, image: &str) -> Bench {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "one.png", "--to", "perspective:fov=75", "--size", "480x360"]);
    project(&bench, panorama, &format!("i w480 h360 {image} {IDLE} n\"one.png\"\n"));
    bench
}

fn project(bench: &Bench, panorama: &str, images: &str) {
    let text = format!("p {panorama} E0 R0 n\"PNG\"\nm i0\n{images}");
    std::fs::write(bench.path("project.pto"), text).unwrap();
}

/// Whether nona is there; in CI it must be.
fn nona_is_there() -> bool {
    let found = Command::new("nona").arg("--help").output().is_ok();
    assert!(found || std::env::var_os("CI").is_none(), "nona is missing: .ci/run programs installs it");
    if !found {
        eprintln!("left out: nona is not installed");
    }
    found
}

/// Every kind of lens that we read, off its axis, bent and shifted; into every kind of panorama.
#[test]
fn pictures_are_where_nona_puts_them() {
    if !nona_is_there() {
        return;
    }
    let bench = bench("f0 w240 h160 v36", "f0 v70");
    let turned = "y10 p-5 r6";
    let bent = "a0.01 b-0.03 c0.02 d6.5 e-4.25";
    for (panorama, image) in [
        ("f0 w240 h160 v36", format!("f0 v70 a0 b0 c0 d0 e0 {turned}")),
        ("f0 w240 h160 v36", format!("f0 v70 {bent} {turned}")),
        ("f1 w240 h160 v36", format!("f0 v70 {bent} {turned}")),
        ("f2 w1600 h800 v360 S710,890,330,470", format!("f3 v90 {bent} {turned}")),
        ("f3 w240 h160 v45", format!("f2 v95 {bent} {turned}")),
        ("f4 w240 h160 v45", format!("f10 v90 {bent} {turned}")),
        ("f5 w240 h160 v45", format!("f21 v90 {bent} {turned}")),
        ("f8 w240 h160 v45", format!("f8 v90 {bent} {turned}")),
        ("f15 w240 h160 v45", format!("f1 v90 a0 b0 c0 d3 e2 {turned}")),
        ("f0 w240 h160 v36", format!("f4 v90 a0 b0 c0 d3 e2 {turned}")),
    ] {
        project(&bench, panorama, &format!("i w480 h360 {image} {IDLE} n\"one.png\"\n"));
        bench.succeed(&["convert", "project.pto", "ours.png", "-y"]);
        let mut nona = Command::new("nona");
        nona.args(["-m", "PNG", "-o", "nona.png", "project.pto"]).current_dir(bench.path("."));
        let output = nona.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let report = bench.succeed(&["compare", "ours.png", "nona.png", "--min-psnr", "35", "--max-shift", "0.015"]);
        println!("{panorama} of {image}: {report}");
    }
}

#[test]
fn pictures_are_cropped_and_blended() {
    let bench = Bench::new();
    for (name, yaw) in [("one.png", "-25"), ("two.png", "25")] {
        let to = ["--to", "perspective:fov=75", "--size", "480x360", "--yaw", yaw];
        bench.succeed(&[&["convert", "builtin:demo", name], &to[..]].concat());
    }
    let image =
        |yaw: i32, name: &str, crop: &str| format!("i w480 h360 f0 v75 y{yaw} p0 r0 {IDLE} {crop} n\"{name}\"\n");
    let images = image(-25, "one.png", "S0,440,0,360") + &image(25, "two.png", "S30,480,10,350").replace("v75", "v=0");
    project(&bench, "f0 w300 h200 v60", &images);
    bench.succeed(&["convert", "project.pto", "ours.png"]);
    bench.succeed(&["convert", "builtin:demo", "direct.png", "--to", "perspective:fov=60", "--size", "300x200"]);
    bench.succeed(&["compare", "ours.png", "direct.png", "--min-psnr", "30", "--max-shift", "0.05"]);
    // Masks and round crops are seen as nona sees them: here, that the rest is not there.
    for (image, masks) in [
        (image(0, "one.png", ""), "k i0 t0 p\"200 150 300 150 300 220 200 220\"\n"),
        (image(0, "one.png", "S140,340,80,280").replace("f0", "f2"), ""),
    ] {
        project(&bench, "f0 w300 h200 v60", &(image + masks));
        assert_says(&bench.fail(1, &["convert", "project.pto", "out.png"]), &["where no view does", "yaw"]);
    }
    // What is cropped away is not there, and told.
    project(&bench, "f0 w300 h200 v60", &image(-25, "one.png", "S0,200,0,360"));
    assert_says(&bench.fail(1, &["convert", "project.pto", "out.png"]), &["where no view does", "yaw"]);
}

#[test]
fn what_cannot_be_done_is_named() {
    let plain = "f0 v70 y0 p0 r0";
    let bench = bench("f0 w240 h160 v36", plain);
    let convert = ["convert", "project.pto", "out.png"];
    for (panorama, image, name, expected) in [
        ("f0 w240 h160 v36", "f20 v70", "one.png", &["project.pto, line 3", "f20 (Thoby)"][..]),
        ("f0 w240 h160 v36", "f2 v70 S600,700,0,100", "one.png", &["line 3", "S leaves nothing"]),
        ("f0 w240 h160 v36", "f0 v70 b-0.9", "one.png", &["line 3", "turn back", "pixels"]),
        ("f0 w240 h160 v36", "f1 v70 b-0.9", "one.png", &["line 3", "must be 0"]),
        ("f0 w240 h160 v36", "f0 v190", "one.png", &["line 3", "less than 180"]),
        ("f0 w240 h160 v36", plain, "none.png", &["line 3", "none.png"]),
        ("f17 w240 h160 v36", plain, "one.png", &["line 1", "f17", "--to"]),
    ] {
        project(&bench, panorama, &format!("i w480 h360 {image} n\"{name}\"\n"));
        assert_says(&bench.fail(1, &convert), expected);
    }
    project(&bench, "f0 w240 h160 v36", &format!("i w481 h360 {plain} n\"one.png\"\n"));
    assert_says(&bench.fail(1, &convert), &["480x360", "w481"]);
    project(&bench, "f0 w240 h160 v36 S0,100,0,100", &format!("i w480 h360 {plain} n\"one.png\"\n"));
    assert_says(&bench.fail(2, &["convert", "project.pto", "out.png", "--size", "120"]), &["--size", "p-line"]);
    project(&bench, "f0 w240 h160 v36", &format!("i w480 h360 {plain} n\"one.png\"\n"));
    bench.succeed(&["convert", "project.pto", "out.png", "--size", "120"]);
    assert_eq!((bench.load("out.png").width(), bench.load("out.png").height()), (120, 80));
    assert_says(&bench.fail(2, &["convert", "project.pto", "new.png", "--from", "equirect"]), &["leave out --from"]);
}

/// Every lens: an i-line's words, and the SPEC that says the same.
const LENSES: [(&str, &str); 7] = [
    ("f0 v75 a0 b0 c0 d0 e0", "hugin:fov=75"),
    ("f0 v75 a0.01 b-0.03 c0.02 d6.5 e-4.25", "hugin:fov=75,a=0.01,b=-0.03,c=0.02,d=6.5,e=-4.25"),
    ("f2 v200 a0 b0 c0 d5 e3", "hugin:lens=fisheye,fov=200,d=5,e=3"),
    ("f3 v140 a0.01 b-0.03 c0.02 d-6.5 e4.25", "hugin:lens=fisheye,fov=140,a=0.01,b=-0.03,c=0.02,d=-6.5,e=4.25"),
    ("f8 v100 a0 b-0.03 c0 d0 e0", "hugin:lens=orthographic,fov=100,b=-0.03"),
    ("f10 v140 a0 b0 c-0.02 d0 e0", "hugin:lens=stereographic,fov=140,c=-0.02"),
    ("f21 v140 a0.01 b0 c0 d0 e8", "hugin:lens=equisolid,fov=140,a=0.01,e=8"),
];

/// One picture by itself needs no project.
#[test]
fn an_i_line_and_its_spec_say_the_same() {
    let bench = bench("f0 w240 h160 v36", "f0 v70");
    let to = ["--to", "perspective:fov=40,yaw=8,pitch=-6", "--size", "120x80", "-y"];
    let mut pictures = Vec::new();
    for (line, spec) in LENSES {
        project(&bench, "f0 w240 h160 v36", &format!("i w480 h360 {line} y10 p-5 r6 {IDLE} n\"one.png\"\n"));
        bench.succeed(&[&["convert", "project.pto", "project.png"], &to[..]].concat());
        let spec = format!("{spec},yaw=10,pitch=-5,roll=6");
        bench.succeed(&[&["convert", "one.png", "spec.png", "--from", &spec], &to[..]].concat());
        assert!(bench.bytes("project.png") == bench.bytes("spec.png"), "{line} is not {spec}");
        pictures.push(bench.bytes("spec.png"));
    }
    pictures.sort();
    pictures.dedup();
    assert_eq!(pictures.len(), LENSES.len(), "each is another lens");
}

#[test]
fn what_its_lens_saw_is_seen_again() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 1024, 512));
    let to = ["--to", "perspective:fov=40", "--size", "120", "-y"];
    bench.succeed(&[&["convert", "sky.png", "direct.png"], &to[..]].concat());
    for (_, spec) in LENSES {
        bench.succeed(&["convert", "sky.png", "seen.png", "--to", spec, "--size", "1200x900", "-y"]);
        bench.succeed(&[&["convert", "seen.png", "back.png", "--from", spec], &to[..]].concat());
        bench.succeed(&["compare", "back.png", "direct.png", "--min-psnr", "60"]);
        if let Some((unshifted, _)) = spec.split_once(",d=") {
            bench.succeed(&[&["convert", "seen.png", "back.png", "--from", unshifted], &to[..]].concat());
            let run = bench.run(&["compare", "back.png", "direct.png", "--min-psnr", "60"]);
            assert_eq!(run.status.code(), Some(1), "{spec} without its shift is another lens");
        }
    }
}

#[test]
fn what_no_lens_of_its_is_refused() {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "sky.png", "--to", "equirect", "--size", "64x32"]);
    for (spec, expected) in [
        ("hugin:k=0.5", &["unknown key 'k' for hugin"][..]),
        ("hugin:aspect=2", &["hugin takes no aspect=", "square"]),
        ("hugin:lens=kannala-brandt", &["lens=kannala-brandt", "rectilinear, fisheye"]),
        ("hugin:a=nan", &["a=nan", "a=-0.02"]),
        ("hugin:d=far", &["d=far", "d=12.5"]),
        ("hugin:fov=180", &["less than 180"]),
        ("hugin:d=3", &["pixels", "--size"]),
    ] {
        assert_says(&bench.fail(2, &["convert", "sky.png", "out.png", "--to", spec]), expected);
    }
    let turns = ["convert", "sky.png", "out.png", "--to", "hugin:fov=100,b=-0.6", "--size", "400x300"];
    assert_says(&bench.fail(2, &turns), &["turn back", "radius"]);
}
