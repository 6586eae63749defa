//! Pictures that end in the middle of their pixels, read back.

// A test that cannot go on stops where it stands.
#![allow(clippy::unwrap_used)]

mod bench;

use bench::{Bench, flat};
use cosmorama::raster::Transfer;

const RIMS: [&str; 8] =
    ["hammer", "mollweide", "sinusoidal", "mirror-ball", "angular-map", "fisheye:fov=220", "dual-fisheye", "omnimax"];

/// The edges of oval maps meet behind; a rim that is read as dark as it was drawn is a line through the picture.
#[test]
fn no_rim_shows() {
    let bench = Bench::new();
    bench.save("grey.png", &flat(128, 64, &[180, 180, 180]));
    for around in ["black", "white"] {
        for name in ["rim.png", "rim.exr", "rim.jpg"] {
            for form in RIMS {
                let to = ["-y", "--to", form, "--size", "128", "--background", around];
                bench.succeed(&[&["convert", "grey.png", name, "--from", "equirect"], &to[..]].concat());
                let to = ["-y", "--to", "equirect", "--size", "64", "--missing", "#b4b4b4", "--depth", "8"];
                bench.succeed(&[&["convert", name, "back.png", "--from", form], &to[..]].concat());
                let back = bench.load("back.png").to_light(&Transfer::Srgb);
                let grey = Transfer::Srgb.decode(180.0 / 255.0, cosmorama::raster::ColourChannel::Green) as f32;
                let worst = back.pixels().iter().map(|pixel| (pixel.0[1] - grey).abs()).fold(0.0, f32::max);
                // One code value, and what JPEG makes of an edge.
                let bound = if name == "rim.jpg" { 0.1 } else { 0.008 };
                assert!(worst < bound, "{name}, {form} on {around}: off by {worst}");
            }
        }
    }
}
