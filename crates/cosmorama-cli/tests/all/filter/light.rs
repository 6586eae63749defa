//! What becomes of light: transfer functions, depth, channels, background and holes.

use crate::bench::{Bench, eight_bits, flat, floats, text, veiled};
use cosmorama::raster::{AlphaMode, Channels, ColourChannel, Depth, EncodedImage, Samples, Transfer};

#[test]
fn what_comes_in_goes_out() {
    let bench = Bench::new();
    let convert = |input: &str, output: &str, extra: &[&str]| {
        let args =
            ["convert", input, output, "--from", "equirect", "--to", "perspective:fov=60", "--size", "8x6", "-y"];
        bench.succeed(&[&args[..], extra].concat());
        bench.load(output)
    };
    // One colour stays that colour, whatever the transfer function.
    for transfer in ["auto", "srgb", "linear", "bt1886", "pq", "hlg", "gamma:2.2"] {
        bench.save("sky.png", &flat(64, 32, &[200, 100, 50]));
        let out = convert("sky.png", "out.png", &["--transfer", transfer]);
        assert!(eight_bits(&out).chunks(3).all(|pixel| pixel == [200, 100, 50]), "{transfer}: {out:?}");
    }
    // A file that cannot say what its code values mean gets those that everyone expects.
    bench.save("sky.png", &flat(64, 32, &[200, 100, 50]));
    let linear = ["--in-transfer", "linear"];
    let expected = convert("sky.png", "out.png", &[&linear[..], &["--out-transfer", "srgb"]].concat());
    for name in ["out.tif", "out.tga"] {
        assert_eq!(eight_bits(&convert("sky.png", name, &linear)), eight_bits(&expected), "{name}");
    }
    // Grey stays grey, alpha stays, and its colour.
    for pixel in [&[77u8][..], &[90, 128], &[10, 20, 30, 64]] {
        bench.save("sky.png", &flat(64, 32, pixel));
        let out = convert("sky.png", "out.png", &[]);
        assert_eq!(out.channels().count(), pixel.len());
        assert!(eight_bits(&out).chunks(pixel.len()).all(|found| found == pixel), "{out:?}");
    }
    // The depth stays where the format can hold it, and follows where it must.
    let sky = EncodedImage::new(64, 32, Channels::Rgb, Depth::Sixteen, Samples::U16(vec![40000; 64 * 32 * 3])).unwrap();
    bench.save("deep.png", &sky);
    assert_eq!(convert("deep.png", "out.png", &[]).depth(), Depth::Sixteen);
    assert_eq!(convert("deep.png", "out.jpg", &[]).depth(), Depth::Eight);
    assert_eq!(convert("deep.png", "out.exr", &["--depth", "half"]).depth(), Depth::Half);
    // Float files are linear: sRGB 40000 is this much light, and comes back as it went.
    let light = convert("deep.png", "sky.exr", &[]).to_light(&Transfer::Linear);
    assert!(
        (f64::from(light.get(3, 3).0[0]) - Transfer::Srgb.decode(40000.0 / 65535.0, ColourChannel::Green)).abs() < 1e-4
    );
    bench.save("float.exr", &floats(64, 32, |_, _| [light.get(3, 3).0[0]; 3]));
    let Samples::U16(back) = convert("float.exr", "out.png", &["--depth", "16"]).into_samples() else {
        panic!("16 bits")
    };
    assert!(back.iter().all(|code| code.abs_diff(40000) <= 1), "{}", back[0]);
}

#[test]
fn outside_the_lens() {
    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[200, 100, 50]));
    bench.save("veil.png", &flat(64, 32, &[200, 100, 50, 255]));
    let corner = |input: &str, extra: &[&str]| {
        let args = ["convert", input, "out.png", "--to", "fulldome", "--size", "32", "-y"];
        bench.succeed(&[&args[..], extra].concat());
        let out = bench.load("out.png");
        let count = out.channels().count();
        let samples = eight_bits(&out).to_vec();
        let at = |i: usize, j: usize| samples[(j * 32 + i) * count..][..count].to_vec();
        assert_eq!(at(16, 16)[..3], [200, 100, 50]);
        at(0, 0)
    };
    assert_eq!(corner("sky.png", &[]), [0, 0, 0]);
    assert_eq!(corner("veil.png", &[]), [0, 0, 0, 0]);
    assert_eq!(corner("sky.png", &["--background", "#ff8000"]), [255, 128, 0]);
    assert_eq!(corner("veil.png", &["--background", "#ff8000"]), [255, 128, 0, 255]);
    assert_eq!(corner("sky.png", &["--background", "transparent"]), [0, 0, 0, 0]);
}

#[test]
fn missing_directions_may_be_filled() {
    let bench = Bench::new();
    bench.save("ahead.png", &flat(32, 32, &[200, 100, 50]));
    let at_the_side = |missing: &str| {
        let args = [
            "convert",
            "ahead.png",
            "out.png",
            "--from",
            "perspective:fov=90",
            "--to",
            "fisheye",
            "--size",
            "64",
            "-y",
        ];
        bench.succeed(&[&args[..], &["--missing", missing]].concat());
        let out = bench.load("out.png");
        let count = out.channels().count();
        let row = &eight_bits(&out)[32 * 64 * count..][..64 * count];
        assert_eq!(row[32 * count..][..3], [200, 100, 50]);
        row[4 * count..][..count].to_vec()
    };
    assert_eq!(at_the_side("#00ff00"), [0, 255, 0]);
    assert_eq!(at_the_side("transparent"), [0, 0, 0, 0]);
    assert_eq!(at_the_side("0.5,0.5,0.5"), [188, 188, 188]);
}

#[test]
fn isolated_nans_are_closed_from_around() {
    let bench = Bench::new();
    let hole = |i: usize, j: usize| if (i, j) == (32, 16) { [f32::NAN; 3] } else { [0.25, 0.5, 2.0] };
    bench.save("sky.exr", &floats(64, 32, hole));
    bench.succeed(&[
        "convert",
        "sky.exr",
        "out.exr",
        "--to",
        "perspective:fov=60",
        "--size",
        "24x24",
        "--from",
        "equirect",
    ]);
    let out = bench.load("out.exr").to_light(&Transfer::Linear);
    let fine = |pixel: &cosmorama::raster::Rgba| {
        pixel.0.iter().zip([0.25, 0.5, 2.0]).all(|(found, expected)| (found - expected).abs() < 1e-5)
    };
    assert!(out.pixels().iter().all(fine));
}

#[test]
fn a_hole_is_said_to_be_in_its_own_frame() {
    let bench = Bench::new();
    for frame in 1..=3 {
        let is_hole = |i: usize, j: usize| frame == 2 && (24..40).contains(&i) && (8..24).contains(&j);
        let hole = |i: usize, j: usize| if is_hole(i, j) { [f32::NAN; 3] } else { [0.5; 3] };
        bench.save(&format!("sky_{frame}.exr"), &floats(64, 32, hole));
    }
    let args = ["--from", "equirect", "--to", "perspective:fov=60", "--size", "24x24"];
    let output = bench.run(&[&["convert", "sky_#.exr", "out_#.exr"], &args[..]].concat());
    let message = crate::bench::text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("frame 2") && message.contains("found in sky_2.exr (256)"), "{message}");
}

#[test]
fn missing_pixels_are_told_of_inputs_with_alpha_too() {
    let bench = Bench::new();
    bench.save("sky.exr", &veiled(64, 32, |i, j| if i < 8 && j < 4 { [f32::NAN; 3] } else { [0.5; 3] }));
    let args = ["convert", "sky.exr", "out.exr", "--from", "equirect", "--to", "fulldome", "--size", "32"];
    let output = bench.run(&args);
    assert!(output.status.success());
    let told = crate::bench::text(&output.stderr);
    assert!(told.contains("warning: sky.exr: 32 pixels are NaN"), "{told}");
    bench.save("void.exr", &veiled(64, 32, |_, _| [f32::NAN; 3]));
    let message = bench.fail(1, &["convert", "void.exr", "none.exr", "--from", "equirect", "--to", "fulldome"]);
    assert!(message.contains("void.exr") && message.contains("every pixel is NaN"), "{message}");
}

/// As RGBM keeps them.
#[test]
fn alpha_that_is_full_nowhere_is_told() {
    let bench = Bench::new();
    for (full, is_told) in [(209, true), (255, false)] {
        let samples: Vec<u8> = (0..64 * 32).flat_map(|k| [90, 80, 70, if k == 777 { full } else { 120 }]).collect();
        bench.save("sky.png", &EncodedImage::new(64, 32, Channels::Rgba, Depth::Eight, Samples::U8(samples)).unwrap());
        assert_eq!(
            bench.succeed(&["info", "sky.png"]).contains("no pixel's alpha is full: it is from 47 to 82 %"),
            is_told
        );
        let to = ["--from", "equirect", "--to", "fulldome", "--size", "32"];
        let run = bench.run(&[&["convert", "sky.png", "out.png", "-y"], &to[..]].concat());
        assert_eq!(text(&run.stderr).contains("warning: sky.png: no pixel's alpha is full"), is_told);
    }
}

/// Float pixels, each of one grey and an alpha, as the file holds them.
fn greys(pixel: impl Fn(usize) -> [f32; 2]) -> EncodedImage {
    let samples = (0..64 * 32).map(|k| pixel(k % 64)).flat_map(|[grey, alpha]| [grey, grey, grey, alpha]).collect();
    let image = EncodedImage::new(64, 32, Channels::Rgba, Depth::Float, Samples::Float(samples)).unwrap();
    image.with_alpha_mode(AlphaMode::Premultiplied)
}

#[test]
fn straight_alpha_is_told_of_and_bright_edges_and_glow_are_not() {
    let bench = Bench::new();
    let alpha = |i: usize| (i as f32 / 50.0).min(1.0);
    let told = |pixel: &dyn Fn(usize) -> [f32; 2]| {
        bench.save("sky.exr", &greys(pixel));
        let to = ["--from", "equirect", "--to", "fulldome", "--size", "32"];
        let run = bench.run(&[&["convert", "sky.exr", "out.exr", "-y"], &to[..]].concat());
        text(&run.stderr).contains("warning: sky.exr: colour exceeds alpha")
    };
    assert!(told(&|i| [0.9, alpha(i)]));
    assert!(!told(&|i| [0.9 * alpha(i), alpha(i)]));
    assert!(!told(&|i| [4.0 * alpha(i), alpha(i)]));
    assert!(!told(&|i| if i < 40 { [0.5, 0.0] } else { [1.0, 1.0] }));
}

#[test]
fn colours_above_alpha_of_a_tiff_are_counted_where_they_are_cut() {
    let bench = Bench::new();
    let samples = (0..64 * 32).flat_map(|k| if k < 100 { [90, 90, 90, 50] } else { [30, 30, 30, 60] }).collect();
    bench.save("sky.tif", &EncodedImage::new(64, 32, Channels::Rgba, Depth::Eight, Samples::U8(samples)).unwrap());
    testkit::say_premultiplied(&bench.path("sky.tif")).unwrap();
    let run = bench.run(&["convert", "sky.tif", "out.png", "--from", "equirect", "--to", "fulldome", "--size", "32"]);
    let told = text(&run.stderr);
    assert!(run.status.success() && told.contains("sky.tif: colour exceeds alpha in 100 pixels, and is cut"), "{told}");
}
