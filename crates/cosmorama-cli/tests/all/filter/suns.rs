//! Whole worlds with a sun, from float files: what is said of it, and the kernel that keeps its light.

use crate::bench::{Bench, floats, text};
use cosmorama::raster::Transfer;

const SIZE: (usize, usize) = (256, 128);

/// A grey sky, and a sun of one texel.
fn sky(i: usize, j: usize) -> [f32; 3] {
    [if (i, j) == (77, 31) { 20_000.0 } else { 0.5 }; 3]
}

/// A panorama's mean light.
fn mean_of_sky() -> f64 {
    let weight = |j: usize| ((j as f64 + 0.5) / SIZE.1 as f64 * std::f64::consts::PI).sin();
    let pixels = || (0..SIZE.1).flat_map(|j| (0..SIZE.0).map(move |i| (i, j)));
    let light: f64 = pixels().map(|(i, j)| weight(j) * f64::from(sky(i, j)[0])).sum();
    light / pixels().map(|(_, j)| weight(j)).sum::<f64>()
}

/// Pixels of an equal-area map are equal parts of the sphere.
fn mean_of_map(bench: &Bench, name: &str) -> f64 {
    let light = bench.load(name).to_light(&Transfer::Linear);
    let pixels = light.pixels();
    pixels.iter().map(|pixel| f64::from(pixel.0[0])).sum::<f64>() / pixels.len() as f64
}

#[test]
fn the_light_of_suns_is_kept_by_the_kernel_of_that_name() {
    let bench = Bench::new();
    bench.save("sky.exr", &floats(SIZE.0, SIZE.1, sky));
    let convert = |output: &str, extra: &[&str]| {
        let args = [
            "convert",
            "sky.exr",
            output,
            "--from",
            "equirect",
            "--to",
            "octahedral",
            "--size",
            "180",
            "--depth",
            "float",
            "--json",
        ];
        let output = bench.run(&[&args[..], extra].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        (report["warnings"].to_string(), text(&output.stderr))
    };
    let (in_report, told) = convert("default.exr", &[]);
    for said in [in_report, told] {
        assert!(said.contains("57 % of the light comes from suns") && said.contains("--kernel light"), "{said}");
    }
    let (in_report, told) = convert("light.exr", &["--kernel", "light"]);
    assert!(in_report == "[]" && !told.contains("suns"), "{told}");
    convert("spelt.exr", &["--kernel", "gaussian:cutoff=2,scale=1.4,floor=1.4", "--anti-ringing", "off"]);
    convert("clamped.exr", &["--kernel", "light", "--anti-ringing", "on"]);
    assert!(bench.bytes("light.exr") == bench.bytes("spelt.exr"));
    assert!(bench.bytes("light.exr") != bench.bytes("clamped.exr"));
    let gain = |name: &str| mean_of_map(&bench, name) / mean_of_sky() - 1.0;
    assert!(gain("light.exr").abs() < 0.002, "{}", gain("light.exr"));
    assert!(gain("default.exr") > 0.01, "{}", gain("default.exr"));
}

#[test]
fn nothing_is_said_where_no_scene_is_lit() {
    let bench = Bench::new();
    bench.save("sky.exr", &floats(SIZE.0, SIZE.1, sky));
    bench.save("dull.exr", &floats(SIZE.0, SIZE.1, |_, j| [if j < 9 { 20.0 } else { 0.5 }; 3]));
    for (input, to) in [("sky.exr", "fulldome"), ("sky.exr", "perspective:fov=60"), ("dull.exr", "octahedral")] {
        let output = bench.run(&["convert", input, "out.exr", "--to", to, "--size", "64", "-y"]);
        let told = text(&output.stderr);
        assert!(output.status.success() && !told.contains("suns"), "{told}");
    }
}
