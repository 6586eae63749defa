//! Pictures that end in the middle of their pixels, read back.

use crate::bench::{Bench, flat};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};

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

/// Where a rim's texels are no mixtures of what lies beside them, what they would be mixtures of may be brighter than white.
#[test]
fn noise_is_the_same_in_15_bits_and_in_floats() {
    let bench = Bench::new();
    let noise = (0..96 * 96 * 3).map(|at: usize| (at.wrapping_mul(2_654_435_761) >> 11) as u8).collect();
    let noise = EncodedImage::new(96, 96, Channels::Rgb, Depth::Eight, Samples::U8(noise)).unwrap();
    bench.save("noise.png", &noise);
    for (from, [yaw, fov]) in [
        ("mirror-ball", ["0", "40"]),
        ("mirror-ball", ["180", "40"]),
        ("fisheye:fov=360", ["180", "30"]),
        ("omnimax", ["0", "90"]),
    ] {
        let to = format!("perspective:fov={fov}");
        for depth in ["8", "16"] {
            let out = format!("{depth}.png");
            let given = ["convert", "noise.png", &out, "--from", from, "--to", &to, "--yaw", yaw, "--size", "64"];
            bench.succeed(&[&given[..], &["--missing", "black", "--depth", depth, "-y"]].concat());
        }
        let [Samples::U8(few), Samples::U16(many)] = ["8.png", "16.png"].map(|name| bench.load(name).into_samples())
        else {
            panic!("files of 8 and of 16 bits")
        };
        let difference = |(few, many): (&u8, &u16)| (f32::from(*few) - f32::from(*many) / 257.0).abs();
        let worst = few.iter().zip(&many).map(difference).fold(0.0, f32::max);
        assert!(worst < 1.0, "{from} at {yaw}: {worst} codes");
    }
}
