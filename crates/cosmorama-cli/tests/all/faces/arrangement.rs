//! Faces that lie wrongly: what `info` says of them, and what `convert` warns of.

use crate::bench::{Bench, assert_says, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use serde_json::Value;

const FACES: [&str; 6] = ["front", "right", "back", "left", "top", "bottom"];

/// The faces of the demo's arcade.
fn world(size: &str) -> Bench {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "{face}.png", "--to", "cube:naming=words", "--size", size]);
    bench
}

fn arrangement(bench: &Bench, name: &str) -> Value {
    let report: Value = serde_json::from_str(&bench.succeed(&["info", name, "--json"])).unwrap();
    report["arrangement"].clone()
}

fn swap(bench: &Bench, a: &str, b: &str) {
    let path = |name: &str| bench.path(&format!("{name}.png"));
    std::fs::rename(path(a), path("between")).unwrap();
    std::fs::rename(path(b), path(a)).unwrap();
    std::fs::rename(path("between"), path(b)).unwrap();
}

fn warnings(bench: &Bench, input: &[&str]) -> String {
    let to = ["out.png", "-y", "--to", "equirect", "--size", "64"];
    let output = bench.run(&[&["convert"], input, &to[..]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stderr)
}

#[test]
fn faces_that_lie_rightly() {
    let bench = world("96");
    assert_eq!(arrangement(&bench, "{face}.png")["fits"], true);
    assert!(bench.succeed(&["info", "{face}.png"]).contains("arrangement: the borders of the faces meet (confidence"));
    assert!(!warnings(&bench, &["{face}.png"]).contains("warning"));
}

#[test]
fn left_and_right_swapped() {
    let bench = world("96");
    swap(&bench, "left", "right");
    let told = arrangement(&bench, "{face}.png");
    assert_eq!(told["fits"], false);
    assert_eq!(told["changes"], serde_json::json!(["right and left are swapped"]));
    assert!(told["confidence"].as_f64().unwrap() >= 0.99, "{told}");
    assert_says(&warnings(&bench, &["{face}.png"]), &["warning: ", "right and left are swapped", "confidence"]);
    // The mirror image of a cube fits as well.
    assert_eq!(told["spec"], "cube:naming=words,flip=x");
    assert_says(
        told["told"].as_str().unwrap(),
        &["do that with the files", "backwards", "--from cube:naming=words,flip=x"],
    );
}

#[test]
fn a_tools_own_up_and_down() {
    let bench = world("96");
    // As envutil has them, whose names are the same.
    for name in ["top", "bottom"] {
        let file = format!("{name}.png");
        let image = bench.load(&file).to_light(&Transfer::Srgb);
        let size = image.width();
        save(&bench, &file, &Image::from_fn(size, size, |i, j| *image.get(size - 1 - i, size - 1 - j)));
    }
    let told = arrangement(&bench, "{face}.png");
    assert_eq!(told["spec"], "cube:naming=envutil", "{told}");
    let message = warnings(&bench, &["{face}.png"]);
    assert_says(&message, &["--from cube:naming=envutil", "up has to be turned clockwise by 180 degrees"]);
    assert!(!warnings(&bench, &["{face}.png", "--from", "cube:naming=envutil"]).contains("warning"));
}

/// What is advised for a picture is seamless.
fn assert_seamless(bench: &Bench, picture: &str, spec: &str) {
    let to = ["--to", "cube:layout=strip-v", "--size", "96", "-y"];
    bench.succeed(&[&["convert", picture, "again.png", "--from", spec], &to[..]].concat());
    assert_eq!(arrangement(bench, "again.png")["fits"], true, "{spec}");
}

#[test]
fn another_order_in_one_image() {
    let bench = world("96");
    for (made, fits) in [
        // Its samples are at the centres, as openexr's are not.
        ("cube:layout=strip-v,order=openexr", "cube:layout=strip-v,order=envutil"),
        ("cube:layout=strip-v,order=kartavr", "cube:layout=strip-v,order=kartavr"),
        ("cube:layout=strip-v,order=fudlrb,rotate=010203", "cube:layout=strip-v,order="),
    ] {
        let made = format!("{made},samples=centres");
        bench.succeed(&["convert", "{face}.png", "strip.png", "-y", "--to", &made, "--size", "96"]);
        let told = arrangement(&bench, "strip.png");
        let spec = told["spec"].as_str().unwrap_or_default().to_owned();
        assert!(told["fits"] == false && spec.starts_with(fits), "{made}: {told}");
        assert_says(&warnings(&bench, &["strip.png"]), &["warning: ", &spec]);
        assert_seamless(&bench, "strip.png", &spec);
    }
}

#[test]
fn layouts_are_told_from_photographs_by_their_seams() {
    let bench = world("96");
    bench.succeed(&["convert", "{face}.png", "grid.png", "--to", "cube:layout=3x2", "--size", "96"]);
    assert_eq!(arrangement(&bench, "grid.png")["fits"], true);
    bench.save("photo.png", &crate::bench::picture(1, 96, 64));
    assert_eq!(arrangement(&bench, "photo.png"), Value::Null);
}

#[test]
fn a_plain_sky_does_not_tell() {
    let bench = Bench::new();
    for face in FACES {
        bench.save(&format!("{face}.png"), &crate::bench::flat(32, 32, &[90, 120, 200]));
    }
    let told = arrangement(&bench, "{face}.png");
    assert!(told["fits"].is_null() && told["told"].as_str().unwrap().contains("do not tell"), "{told}");
    assert!(!warnings(&bench, &["{face}.png"]).contains("warning"));
}

#[test]
fn faces_that_are_all_mirrored() {
    let bench = world("96");
    for layout in ["strip-v", "strip-h", "3x2"] {
        // The whole image mirrored, and each face in its own place.
        let (whole, each) = (format!("cube:layout={layout},flip=x"), format!("cube:layout={layout}"));
        bench.succeed(&["convert", "{face}.png", "whole.png", "-y", "--to", &whole, "--size", "96"]);
        mirror_each(&bench);
        bench.succeed(&["convert", "m_{face}.png", "each.png", "-y", "--to", &each, "--size", "96"]);
        for (name, spec) in [("whole.png", whole), ("each.png", format!("{each},"))] {
            let told = arrangement(&bench, name);
            assert_eq!(told["fits"], false, "{name} {layout}: {told}");
            let advice = told["told"].as_str().unwrap();
            assert_says(advice, &["backwards", &spec, "flip=x: borders do not tell"]);
            let flip = advice.split("--from ").last().unwrap().split(": ").next().unwrap();
            for from in [flip, told["spec"].as_str().unwrap()] {
                let to = ["--to", "cube:layout=strip-v", "--size", "96"];
                bench.succeed(&[&["convert", name, "again.png", "-y", "--from", from], &to[..]].concat());
                assert_eq!(arrangement(&bench, "again.png")["fits"], true, "{from}");
                bench.succeed(&[&["convert", "{face}.png", "world.png", "-y"], &to[..]].concat());
                let is_world = bench.run(&["compare", "again.png", "world.png", "--min-psnr", "20"]).status.success();
                assert_eq!(is_world, from == flip, "{from}: one is the world, the other one its mirror image");
            }
        }
    }
}

/// The faces of the world, each mirrored, as `m_NAME.png`.
fn mirror_each(bench: &Bench) {
    for name in FACES {
        let image = bench.load(&format!("{name}.png")).to_light(&Transfer::Srgb);
        let size = image.width();
        save(bench, &format!("m_{name}.png"), &Image::from_fn(size, size, |i, j| *image.get(size - 1 - i, j)));
    }
}

fn save(bench: &Bench, name: &str, light: &Image<Rgba>) {
    bench.save(name, &EncodedImage::encode(light, Channels::Rgb, Depth::Eight, &Transfer::Srgb));
}

/// A picture mirrored as a whole.
fn mirror_whole(bench: &Bench, name: &str, (across, down): (bool, bool)) {
    let image = bench.load(name).to_light(&Transfer::Srgb);
    let (width, height) = (image.width(), image.height());
    let column = |i: usize| if across { width - 1 - i } else { i };
    let row = |j: usize| if down { height - 1 - j } else { j };
    save(bench, name, &Image::from_fn(width, height, |i, j| *image.get(column(i), row(j))));
}

/// Crosses mirrored or turned: which way, and the SPECs under which each is the world, and its mirror image.
const MIRRORED_CROSSES: [(&str, (bool, bool), &str, &str); 4] = [
    ("cross-h", (true, false), "cube:layout=cross-h,flip=x", "cube:layout=cross-h,flip=xy,roll=180"),
    ("cross-h", (true, true), "cube:layout=cross-h,flip=xy", "cube:layout=cross-h,flip=x"),
    ("cross-v", (false, true), "cube:layout=cross-v,flip=y", "cube:layout=cross-v,flip=xy,roll=180"),
    ("cross-v", (true, true), "cube:layout=cross-v,flip=xy", "cube:layout=cross-v,flip=y"),
];

#[test]
fn crosses_that_are_mirrored_as_a_whole() {
    let Some(oracles) = testkit::shared("oracles/povray") else { return };
    let bench = Bench::new();
    let faces = oracles.join("face_{face}_srgb8.png");
    let convert = |input: &str, from: &[&str], output: &str, to: &str| {
        bench.succeed(&[&["convert", input, output, "-y", "--size", "128", "--to", to], from].concat());
    };
    convert(faces.to_str().unwrap(), &[], "world.png", "cube:layout=strip-v");
    for (kind, ways, spec, mirrored) in MIRRORED_CROSSES {
        let layout = format!("cube:layout={kind}");
        convert(faces.to_str().unwrap(), &[], "cross.png", &layout);
        mirror_whole(&bench, "cross.png", ways);
        let told = arrangement(&bench, "cross.png");
        assert_eq!(told["fits"], false, "{kind}: {told}");
        assert!(told["confidence"].as_f64().unwrap() >= 0.99, "{told}");
        assert_says(
            told["told"].as_str().unwrap(),
            &["the whole picture is mirrored", "does not read backwards", "roll=180"],
        );
        // What is advised is the world, or, where it was turned, its mirror image; then the world is one of the others.
        let advised = told["spec"].as_str().unwrap().to_owned();
        assert!(advised == spec || advised == mirrored, "{advised}");
        assert_says(
            told["told"].as_str().unwrap(),
            &[&format!("--from {spec}{}", if ways == (true, true) { ":" } else { "," })],
        );
        let like_world = |from: &str| {
            convert("cross.png", &["--from", from], "again.png", "cube:layout=strip-v");
            bench.run(&["compare", "again.png", "world.png", "--min-psnr", "25"]).status.success()
        };
        assert!(like_world(spec) && !like_world(mirrored), "{spec}");
        assert_eq!(arrangement(&bench, "again.png")["fits"], true);
        // `convert` warns where it is given as a plain cross, not where it is given rightly, and does not guess.
        assert_says(
            &warnings(&bench, &["cross.png", "--from", &layout]),
            &["warning: the whole picture is mirrored", &advised],
        );
        assert!(!warnings(&bench, &["cross.png", "--from", spec]).contains("warning"), "{spec}");
        let guess = bench.run(&["convert", "cross.png", "out.png", "-y", "--to", "equirect"]);
        assert_eq!(guess.status.code(), Some(1));
        assert_says(&text(&guess.stderr), &["long arm", &advised, "roll=180"]);
    }
}

#[test]
fn a_cross_with_the_back_at_its_other_end_is_not_mirrored() {
    let bench = world("96");
    bench.succeed(&["convert", "{face}.png", "world.png", "--to", "cube:layout=strip-v", "--size", "96"]);
    bench.succeed(&["convert", "{face}.png", "cross.png", "--to", "cube:layout=cross-h", "--size", "96"]);
    let image = bench.load("cross.png").to_light(&Transfer::Srgb);
    save(&bench, "cross.png", &Image::from_fn(384, 288, |i, j| *image.get((i + 288) % 384, j)));
    let spec = "cube:layout=cross-h,flip=xy,roll=180";
    assert_says(arrangement(&bench, "cross.png")["told"].as_str().unwrap(), &["does not read backwards", spec]);
    bench.succeed(&[
        "convert",
        "cross.png",
        "again.png",
        "--from",
        spec,
        "--to",
        "cube:layout=strip-v",
        "--size",
        "96",
    ]);
    bench.succeed(&["compare", "again.png", "world.png", "--min-psnr", "40"]);
}

#[test]
fn a_plain_cross_is_told_from_its_mirror_image_by_its_reader_alone() {
    let bench = world("96");
    for (kind, ways, flip) in [("cross-h", (false, true), "flip=y"), ("cross-v", (true, false), "flip=x")] {
        let layout = format!("cube:layout={kind}");
        bench.succeed(&["convert", "{face}.png", "cross.png", "-y", "--to", &layout, "--size", "96"]);
        for _ in 0..2 {
            let told = arrangement(&bench, "cross.png");
            assert_eq!(told["fits"], true, "{told}");
            assert_says(told["told"].as_str().unwrap(), &["reads backwards", &format!("--from {layout},{flip}")]);
            // Given as mirrored although it is not, and in other places than it has.
            let end = if kind == "cross-h" { "x" } else { "y" };
            let message = warnings(&bench, &["cross.png", "--from", &format!("{layout},flip={end}")]);
            assert_says(&message, &["warning: the picture is not mirrored", &format!("--from {layout},")]);
            mirror_whole(&bench, "cross.png", ways);
        }
    }
}

#[test]
fn mirrored_crosses_of_shuffled_faces() {
    let bench = world("96");
    for (made, end) in
        [("cross-h,order=bdlfur,rotate=013203", (true, false)), ("cross-v,order=rudlbf,rotate=301120", (false, true))]
    {
        let made = format!("cube:layout={made}");
        bench.succeed(&["convert", "{face}.png", "cross.png", "-y", "--to", &made, "--size", "96"]);
        mirror_whole(&bench, "cross.png", end);
        let told = arrangement(&bench, "cross.png");
        let spec = told["spec"].as_str().unwrap_or_default();
        assert!(told["fits"] == false && spec.contains("flip="), "{made}: {told}");
        assert_says(told["told"].as_str().unwrap(), &["the whole picture is mirrored", "do not meet", spec]);
        assert_seamless(&bench, "cross.png", spec);
    }
}

#[test]
fn a_mirrored_cross_of_a_plain_sky_does_not_tell() {
    let bench = Bench::new();
    for face in FACES {
        bench.save(&format!("{face}.png"), &crate::bench::flat(32, 32, &[90, 120, 200]));
    }
    for (kind, ways) in [("cross-h", (true, false)), ("cross-v", (false, true))] {
        let to = format!("cube:layout={kind}");
        bench.succeed(&["convert", "{face}.png", "cross.png", "-y", "--to", &to, "--size", "32"]);
        mirror_whole(&bench, "cross.png", ways);
        let told = arrangement(&bench, "cross.png");
        assert!(told["fits"].is_null() && told["told"].as_str().unwrap().contains("do not tell"), "{told}");
        assert!(!warnings(&bench, &["cross.png", "--from", &to]).contains("warning"));
    }
}
