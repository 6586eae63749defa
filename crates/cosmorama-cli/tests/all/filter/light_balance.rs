//! `--kernel light`: what whole worlds keep, and what is left alone.

use crate::bench::{Bench, assert_says, floats, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};

const TO: [&str; 6] = ["--to", "octahedral", "--size", "90", "--kernel", "light"];

fn light(bench: &Bench, name: &str) -> Image<Rgba> {
    bench.load(name).to_light(&Transfer::Linear)
}

/// A sun of one pixel at the zenith, in front of next to nothing.
fn sky(bench: &Bench) {
    bench.save("sky.exr", &floats(128, 64, |i, j| [if (i, j) == (40, 0) { 1e4 } else { 0.01 }; 3]));
}

#[test]
fn a_sun_at_the_zenith_keeps_its_light() {
    let bench = Bench::new();
    sky(&bench);
    // Octahedral pixels have the same solid angle; a panorama's have that of their row.
    let row = |j: usize| (std::f64::consts::PI * (0.5 - (j as f64 + 0.5) / 64.0)).cos();
    let sky = light(&bench, "sky.exr");
    let power = |(at, pixel): (usize, &Rgba)| f64::from(pixel.0[0]) * row(at / 128);
    let weight: f64 = (0..64).map(row).sum::<f64>() * 128.0;
    let before = sky.pixels().iter().enumerate().map(power).sum::<f64>() / weight;
    let mean = |name: &str| {
        let picture = light(&bench, name);
        picture.pixels().iter().map(|pixel| f64::from(pixel.0[0])).sum::<f64>() / picture.pixels().len() as f64
    };
    bench.succeed(&[&["convert", "sky.exr", "kept.exr"], &TO[..]].concat());
    assert!((mean("kept.exr") / before - 1.0).abs() < 2e-3, "{}, not {before}", mean("kept.exr"));
    // Without memory for the plan it is said that light may be lost, as it is.
    bench.save("large.exr", &floats(512, 256, |_, _| [0.5; 3]));
    let large = ["convert", "large.exr", "o.exr", "-y", "--to", "octahedral", "--size", "360", "--kernel", "light"];
    let short = bench.run(&[&large[..], &["--memory", "12M"]].concat());
    assert_says(&text(&short.stderr), &["--kernel light", "--memory"]);
    assert!(!text(&bench.run(&large).stderr).contains("--memory"));
}

/// Where there are holes or veils, colours are not touched.
#[test]
fn nothing_is_balanced_beside_holes_or_under_veils() {
    let bench = Bench::new();
    let constant = |name: &str, extra: &[&str]| {
        bench.succeed(&[&["convert", name, "out.exr", "-y"], &TO[..], extra].concat());
        for pixel in light(&bench, "out.exr").pixels().iter().filter(|pixel| pixel.alpha() > 0.01) {
            let colour = pixel.0[0] / pixel.alpha();
            assert!((colour - 0.5).abs() < 4e-3, "{name}: {pixel:?}");
        }
    };
    bench.save("band.exr", &floats(128, 61, |_, _| [0.5; 3]));
    constant("band.exr", &["--from", "equirect:hfov=360,vfov=171.5625", "--missing", "#bcbcbc"]);
    bench.save("holes.exr", &floats(128, 64, |i, _| [if i % 16 < 3 { f32::NAN } else { 0.5 }; 3]));
    constant("holes.exr", &[]);
    let veil = Image::from_fn(128, 64, |i, _| Rgba::opaque(0.5, 0.5, 0.5) * if i % 32 < 16 { 1.0 } else { 0.3 });
    bench.save("veil.exr", &EncodedImage::encode(&veil, Channels::Rgba, Depth::Float, &Transfer::Linear));
    constant("veil.exr", &[]);
}
