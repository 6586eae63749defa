//! Labels: values that go through a conversion unchanged, or not at all.

use std::collections::BTreeSet;

use crate::bench::{Bench, eight_bits, flat, floats};
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
}
