//! Labels: values that go through a conversion unchanged, or not at all.

use std::collections::BTreeSet;

use crate::bench::{Bench, eight_bits, flat, floats, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};

/// Labels of 16 bits, 40 of them, that lie far apart.
fn labels() -> EncodedImage {
    let label = |at: usize| (at % 64 / 5 * 4001 + at / 64 / 9 * 777) as u16;
    EncodedImage::new(64, 32, Channels::Grey, Depth::Sixteen, Samples::U16((0..64 * 32).map(label).collect())).unwrap()
}

fn values(image: &EncodedImage) -> BTreeSet<u16> {
    let Samples::U16(values) = image.samples() else { panic!("16 bits") };
    values.iter().copied().collect()
}

#[test]
fn values_that_were_not_there_never_appear() {
    let bench = Bench::new();
    bench.save("ids.png", &labels());
    let known = values(&labels());
    let turned = ["--size", "50", "--yaw", "33", "--pitch", "20", "--roll", "10", "-y"];
    for rule in ["nearest", "vote"] {
        for (to, output) in
            [("fulldome:tilt=20", "out.png"), ("perspective:fov=100", "out.tif"), ("mirror-ball", "out.png")]
        {
            bench.succeed(&[&["convert", "ids.png", output, "--to", to, "--labels", rule], &turned[..]].concat());
            let found = values(&bench.load(output));
            // Black is the background.
            assert!(found.iter().all(|value| *value == 0 || known.contains(value)) && found.len() > 5, "{rule}, {to}");
        }
    }
    // Colours stand for labels, too.
    bench.save("red.png", &flat(64, 32, &[200, 17, 3]));
    bench.succeed(&[&["convert", "red.png", "out.png", "--to", "fisheye", "--labels", "vote"], &turned[..]].concat());
    let pixels: BTreeSet<[u8; 3]> = eight_bits(&bench.load("out.png")).chunks(3).map(|p| [p[0], p[1], p[2]]).collect();
    assert_eq!(pixels, BTreeSet::from([[0, 0, 0], [200, 17, 3]]));
}

#[test]
fn codes_that_are_spread_are_told_of() {
    let bench = Bench::new();
    // 16 × 8 pixels of 4 bits: 5 and 10.
    let file = b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x10\x00\x00\x00\x08\x04\x00\x00\x00\x00\x10\xed\xcdJ\x00\x00\
        \x00\x0eIDATx\xdac\x88\x82\x02\x06\xca\x18\x00*u\x16\x81\xc1\x5c\xeb^\x00\x00\x00\x00IEND\xaeB`\x82";
    std::fs::write(bench.path("four.png"), file).unwrap();
    let words = ["convert", "four.png", "out.png", "--from", "equirect", "--to", "fisheye", "--size", "8"];
    let output = bench.run(&[&words[..], &["--labels", "nearest"]].concat());
    assert!(text(&output.stderr).contains("the codes of four.png are of 4 bits"), "{}", text(&output.stderr));
}

#[test]
fn labels_of_alpha_0_are_told_of() {
    let bench = Bench::new();
    let samples = [200, 17, 3, 0].repeat(64 * 32);
    bench.save("clear.png", &EncodedImage::new(64, 32, Channels::Rgba, Depth::Eight, Samples::U8(samples)).unwrap());
    let words = ["convert", "clear.png", "out.png", "--from", "equirect", "--to", "fisheye", "--labels", "vote"];
    let output = bench.run(&words);
    assert!(text(&output.stderr).contains("clear.png has alpha: labels where it is 0"), "{}", text(&output.stderr));
}

/// A mean of labels over a shutter would be no label.
#[test]
fn labels_are_those_of_one_moment() {
    let bench = Bench::new();
    bench.save("ids.png", &labels());
    let known = values(&labels());
    let words = ["convert", "ids.png", "out_#.png", "--from", "equirect", "--to", "perspective:fov=60", "--size", "40"];
    let moving = ["--labels", "vote", "--yaw", "0..90", "--frames", "1-3", "--shutter", "0.5"];
    let output = bench.run(&[&words[..], &moving].concat());
    assert!(text(&output.stderr).contains("--shutter has no effect"), "{}", text(&output.stderr));
    for frame in 1..=3 {
        assert!(values(&bench.load(&format!("out_{frame}.png"))).is_subset(&known));
    }
}

#[test]
fn what_would_change_values_is_refused() {
    let bench = Bench::new();
    bench.save("ids.png", &labels());
    bench.save("ids.exr", &floats(64, 32, |_, _| [1.0; 3]));
    let refused = |args: &[&str], expected: &str| {
        let told = bench.fail(2, &[&["convert"], args, &["--to", "fisheye", "--labels", "vote"]].concat());
        assert!(told.contains(expected), "{told}");
    };
    refused(&["ids.png", "out.jpg"], "JPEG changes values; write PNG, TIFF or TGA");
    refused(&["ids.png", "out.png", "--depth", "8"], "ids.png has 16 bits and the output 8; give --depth 16");
    refused(&["ids.exr", "out.exr"], "ids.exr holds float samples; labels are integers of 8 or 16 bits");
    refused(&["ids.png", "out.png", "--out-transfer", "linear"], "encoded otherwise than ids.png");
    refused(&["ids.png", "out.png", "--filter", "point"], "--filter");
    refused(&["ids.png", "out.exr"], "; write PNG or TIFF, which have as many");
}
