//! Built-in worlds as inputs: every form of output, and what makes no sense.

// A test that cannot go on stops where it stands.
#![allow(clippy::unwrap_used)]

mod bench;

use bench::{Bench, assert_says};
use cosmorama::raster::{Channels, Depth, Transfer};
use serde_json::Value;

#[test]
fn every_world_goes_into_every_form() {
    let bench = Bench::new();
    for world in ["grid", "checker", "directions", "zone-plate", "demo"] {
        let input = format!("builtin:{world}");
        let dome = format!("{world}.png");
        bench.succeed(&["convert", &input, &dome, "--to", "fulldome", "--size", "24"]);
        let image = bench.load(&dome);
        assert_eq!((image.width(), image.height(), image.channels()), (24, 24, Channels::Rgb));
        bench.succeed(&["convert", &input, &format!("{world}.exr"), "--to", "equirect", "--size", "32"]);
        bench.succeed(&["convert", &input, &format!("{world}_{{face}}.tif"), "--size", "8"]);
        assert_eq!(bench.load(&format!("{world}_top.tif")).width(), 8);
        let cross = format!("{world}-cross.jpg");
        bench.succeed(&["convert", &input, &cross, "--to", "cube:layout=cross-h", "--size", "8"]);
        assert_eq!(bench.load(&cross).width(), 32);
    }
}

#[test]
fn depth_transfer_and_background_are_those_asked_for() {
    let bench = Bench::new();
    let convert = |output: &str, more: &[&str]| {
        let mut args = vec!["convert", "builtin:directions", output, "--to", "fulldome", "--size", "33"];
        args.extend(more);
        bench.succeed(&args);
        bench.load(output)
    };
    // The zenith: x = 0, y = 1, z = 0.
    let zenith = [0.5, 1.0, 0.5];
    for (output, depth, transfer, more) in [
        ("a.png", Depth::Sixteen, Transfer::Srgb, ["--depth", "16"]),
        ("b.png", Depth::Eight, Transfer::Linear, ["--transfer", "linear"]),
        ("c.exr", Depth::Float, Transfer::Linear, ["--depth", "float"]),
        ("d.tif", Depth::Eight, Transfer::Srgb, ["--background", "transparent"]),
    ] {
        let image = convert(output, &more);
        assert_eq!(image.depth(), depth);
        let light = image.to_light(&transfer);
        let middle = light.get(16, 16).0;
        assert!((0..3).all(|c| (f64::from(middle[c]) - zenith[c]).abs() < 0.003), "{output}: {middle:?}");
        assert_eq!(light.get(0, 0).alpha() == 0.0, output == "d.tif");
    }
    let [red, green, blue, _] = convert("e.png", &["--background", "red"]).to_light(&Transfer::Srgb).get(0, 0).0;
    assert_eq!([red, green, blue], [1.0, 0.0, 0.0]);
}

#[test]
fn the_same_bytes_whatever_the_number_of_threads() {
    let bench = Bench::new();
    for (output, threads) in [("a.png", "1"), ("b.png", "3")] {
        bench.succeed(&["convert", "builtin:grid", output, "--to", "omnimax", "--size", "300", "--threads", threads]);
    }
    assert!(bench.bytes("a.png") == bench.bytes("b.png"));
}

#[test]
fn what_files_have_a_formula_has_not() {
    let bench = Bench::new();
    let refused = |args: &[&str], parts: &[&str]| {
        let mut all = vec!["convert"];
        all.extend(args);
        assert_says(&bench.fail(2, &all), parts);
    };
    let dome = ["--to", "fulldome", "--size", "16"];
    let with = |more: &[&'static str]| [&["builtin:grid", "a.png"][..], &dome, more].concat();
    refused(
        &["builtin:gird", "a.png", "--to", "fulldome", "--size", "16"],
        &["'gird'", "did you mean 'grid'?", "builtin:zone-plate"],
    );
    refused(&with(&["--from", "equirect"]), &["--from", "builtin:grid", "formula"]);
    refused(&with(&["--frames", "1-3"]), &["--frames"]);
    refused(&with(&["--in-transfer", "srgb"]), &["--in-transfer"]);
    refused(&["builtin:grid", "a.png", "--to", "fulldome"], &["--size is missing"]);
    refused(&["builtin:grid", "a.png", "--size", "16"], &["--to is missing"]);
    refused(&["builtin:grid", "a_####.png", "--to", "fulldome", "--size", "16"], &["frame marker"]);
    assert_says(
        &bench.fail(2, &["explain", "builtin:grid", "--to", "fulldome", "--size", "16"]),
        &["nothing to explain"],
    );
    let existing = with(&[]);
    bench.succeed(&[&["convert"][..], &existing].concat());
    assert_says(&bench.fail(1, &[&["convert"][..], &existing].concat()), &["a.png exists"]);
    let resumed = bench.succeed(&[&["convert"][..], &existing, &["--resume", "--json"]].concat());
    let report: Value = serde_json::from_str(&resumed).unwrap();
    assert_eq!((&report["skipped"], &report["inputs"][0]), (&Value::from(1), &Value::from("builtin:grid")));
}

#[test]
fn info_says_what_a_world_shows() {
    let bench = Bench::new();
    assert_says(&bench.succeed(&["info", "builtin:grid"]), &["azimuth"]);
    assert_says(&bench.fail(2, &["info", "builtin:grids"]), &["did you mean 'grid'?"]);
}
