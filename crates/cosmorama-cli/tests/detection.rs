//! What one image is a picture of, found without `--from`: said by metadata, guessed and announced, or refused.

// A test that cannot go on stops where it stands.
#![allow(clippy::unwrap_used)]

mod bench;

use bench::{Bench, picture, text};
use cosmorama_io::{Metadata, Window, WriteOptions, write};
use serde_json::Value;

const TO: [&str; 4] = ["--to", "perspective:fov=40", "--size", "40x30"];

fn info(bench: &Bench, name: &str) -> String {
    let report: Value = serde_json::from_str(&bench.succeed(&["info", name, "--json"])).unwrap();
    report["projection"].as_str().unwrap().to_owned()
}

/// Converts without `--from`, with nothing but `said` on the way, and as the SPEC has it: the same.
fn found(bench: &Bench, name: &str, spec: &str, said: &str) {
    let output = bench.run(&[&["convert", name, "found.png", "-y"], &TO[..]].concat());
    let message = text(&output.stderr);
    assert!(output.status.success() && message.contains(said), "{name}: {message}");
    bench.succeed(&[&["convert", name, "given.png", "-y", "--from", spec], &TO[..]].concat());
    assert_eq!(bench.bytes("found.png"), bench.bytes("given.png"), "{name}");
}

fn refused(bench: &Bench, name: &str, candidates: &[&str]) {
    let message = bench.fail(1, &[&["convert", name, "found.png"], &TO[..]].concat());
    for candidate in candidates {
        assert!(message.contains(candidate), "{name}: {message}");
    }
}

#[test]
fn panoramas_say_that_they_are() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 256, 128));
    let window = "equirect:canvas=256x128+32+16";
    for name in ["part.jpg", "part.png"] {
        bench.succeed(&["convert", "sky.png", name, "--from", "equirect", "--to", window, "--size", "160x80"]);
        assert_eq!(info(&bench, name), format!("{window} (GPano metadata)"));
        found(&bench, name, window, "found.png in");
        // What is asked for may also be said in part.
        found(&bench, name, "equirect", "found.png in");
    }
    bench.succeed(&["convert", "sky.png", "whole.jpg", "--from", "equirect", "--to", "equirect", "--size", "128"]);
    assert_eq!(info(&bench, "whole.jpg"), "equirect (GPano metadata)");
    // Another projection is none, and says nothing.
    bench.succeed(&["convert", "sky.png", "dome.jpg", "--from", "equirect", "--to", "fulldome", "--size", "64"]);
    assert!(!text(&bench.bytes("dome.jpg")).contains("GPano"));
}

#[test]
fn a_panorama_that_says_it_is_huge_is_refused_before_memory_is_taken() {
    let bench = Bench::new();
    let panorama = Some(Window { canvas_width: 4_000_000_000, canvas_height: 2_000_000_000, x: 0, y: 0 });
    let metadata = Metadata { panorama, ..Metadata::default() };
    write(&bench.path("a.png"), &picture(1, 40, 20), &metadata, &WriteOptions::default()).unwrap();
    let message = bench.fail(1, &[&["convert", "a.png", "b.png", "--memory", "1G"], &TO[..]].concat());
    assert!(message.contains("4000000000x2000000000") && message.contains("--memory"), "{message}");
}

#[test]
fn what_is_guessed_is_announced() {
    let bench = Bench::new();
    bench.faces("world_", 64);
    let make = |name: &str, to: &str| {
        bench.succeed(&["convert", "world_{face}.png", name, "--to", to, "--size", "64"]);
    };
    make("dome.png", "fulldome");
    make("dome.jpg", "fulldome");
    make("strip.png", "cube:layout=strip-v");
    make("cross.png", "cube:layout=cross-h");
    make("cross.jpg", "cube:layout=cross-v");
    for (name, spec) in [
        ("dome.png", "fulldome"),
        ("dome.jpg", "fulldome"),
        ("strip.png", "cube:layout=strip-v"),
        ("cross.png", "cube:layout=cross-h"),
        ("cross.jpg", "cube:layout=cross-v"),
    ] {
        // A dome ends at the horizon.
        let to = ["--to", "perspective:fov=40", "--size", "40x30", "--pitch", "60"];
        let output = bench.run(&[&["convert", name, "found.png", "-y"], &to[..]].concat());
        let message = text(&output.stderr);
        assert!(output.status.success() && message.contains(&format!("--from {spec}")), "{name}: {message}");
        bench.succeed(&[&["convert", name, "given.png", "-y", "--from", spec], &to[..]].concat());
        assert_eq!(bench.bytes("found.png"), bench.bytes("given.png"), "{name}");
        assert!(info(&bench, name).starts_with(spec), "{name}");
    }
}

#[test]
fn what_could_be_several_things_is_refused() {
    let bench = Bench::new();
    for (width, height, candidates) in [
        (64, 48, &["cube:layout=cross-h", "perspective:fov=DEGREES"][..]),
        (48, 64, &["cube:layout=cross-v", "perspective:fov=DEGREES"]),
        (48, 32, &["cube:layout=3x2", "cube:layout=eac", "perspective:fov=DEGREES"]),
        (32, 48, &["cube:layout=2x3", "perspective:fov=DEGREES"]),
        (40, 40, &["fulldome", "fisheye:fov=DEGREES", "perspective:fov=DEGREES"]),
        (50, 37, &["perspective:fov=DEGREES", "equirect"]),
    ] {
        bench.save("photo.png", &picture(3, width, height));
        refused(&bench, "photo.png", candidates);
        assert!(info(&bench, "photo.png").starts_with("unknown"));
    }
    // Nothing in the picture, nothing to guess from.
    bench.save("photo.png", &bench::flat(64, 48, &[0, 0, 0]));
    refused(&bench, "photo.png", &["cube:layout=cross-h"]);
}
