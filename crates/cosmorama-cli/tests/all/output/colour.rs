//! Primaries and profiles: what comes in goes out with the same colours, or is told.

use std::process::Output;

use crate::bench::{Bench, assert_says, flat, text};
use cosmorama::raster::{Channels, ColourMatrix, Depth, EncodedImage, Image, Primaries, Rgba, Samples, Transfer};
use cosmorama_io::{Metadata, WriteOptions, probe, write};

const EQUIRECT: [&str; 6] = ["--from", "equirect", "--to", "equirect", "--size", "16x8"];

fn tagged(transfer: Transfer, primaries: Primaries) -> Metadata {
    Metadata { transfer: Some(transfer), primaries: Some(primaries), ..Metadata::default() }
}

/// One colour of light, in a file that says what it is.
fn save(bench: &Bench, name: &str, light: [f32; 3], depth: Depth, metadata: &Metadata) {
    let [red, green, blue] = light;
    let usual = if depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
    let transfer = metadata.transfer.clone().unwrap_or(usual);
    let image = Image::filled(16, 8, Rgba::opaque(red, green, blue));
    let encoded = EncodedImage::encode(&image, Channels::Rgb, depth, &transfer);
    write(bench.path(name), &encoded, &WriteOptions::with_metadata(metadata.clone())).unwrap();
}

fn convert(bench: &Bench, input: &str, output: &str, extra: &[&str]) -> Output {
    let run = bench.run(&[&["convert", input, output, "-y"], &EQUIRECT[..], extra].concat());
    assert!(run.status.success(), "{input} {output}: {}", text(&run.stderr));
    run
}

/// The light of an output's pixel, by what the file says.
fn light(bench: &Bench, name: &str) -> [f32; 3] {
    let header = probe(bench.path(name)).unwrap();
    let transfer =
        if header.depth.is_float() { Transfer::Linear } else { header.metadata.transfer.unwrap_or_default() };
    let [red, green, blue, _] = bench.load(name).to_light(&transfer).get(5, 3).0;
    [red, green, blue]
}

#[track_caller]
fn assert_light(found: [f32; 3], expected: [f64; 3], allowed: f64) {
    let near = (0..3).all(|c| (f64::from(found[c]) - expected[c]).abs() <= allowed);
    assert!(near, "{found:?} is not {expected:?}");
}

fn between(from: &Primaries, to: &Primaries, colour: [f64; 3]) -> [f64; 3] {
    ColourMatrix::between(from, to).apply(colour)
}

#[test]
fn what_one_kind_of_input_says_the_output_says() {
    let bench = Bench::new();
    let acescg = Metadata { white_luminance: Some(100.0), ..tagged(Transfer::Linear, Primaries::AP1) };
    save(&bench, "aces.exr", [0.5, -0.25, 3.0], Depth::Float, &acescg);
    convert(&bench, "aces.exr", "out.exr", &[]);
    let found = probe(bench.path("out.exr")).unwrap().metadata;
    assert_eq!((found.primaries, found.white_luminance), (Some(Primaries::AP1), Some(100.0)));
    assert_light(light(&bench, "out.exr"), [0.5, -0.25, 3.0], 1e-6);

    save(&bench, "pq.png", [0.3, 2.0, 0.1], Depth::Sixteen, &tagged(Transfer::Pq, Primaries::REC2020));
    for (name, allowed) in [("out.png", 1e-3), ("out.tif", 1e-3), ("out.jpg", 0.1), ("out.exr", 1e-3)] {
        let run = convert(&bench, "pq.png", name, &[]);
        assert!(!text(&run.stderr).contains("warning"), "{name}: {}", text(&run.stderr));
        let found = probe(bench.path(name)).unwrap().metadata;
        assert_eq!(found.primaries, Some(Primaries::REC2020), "{name}");
        assert_light(light(&bench, name), [0.3, 2.0, 0.1], allowed);
    }
    assert_eq!(probe(bench.path("out.tif")).unwrap().metadata.transfer, Some(Transfer::Pq));
    // Nits are kept: 203 cd/m² are white in PQ.
    assert_eq!(probe(bench.path("out.exr")).unwrap().metadata.white_luminance, Some(203.0));

    let adobe = tagged(Transfer::Gamma(2.2), Primaries::ADOBE_RGB);
    save(&bench, "adobe.png", [0.3, 0.6, 0.1], Depth::Sixteen, &adobe);
    convert(&bench, "adobe.png", "out.png", &[]);
    assert_eq!(probe(bench.path("out.png")).unwrap().metadata.colour_space().as_deref(), Some("Adobe RGB (1998)"));
}

#[test]
fn absolute_luminance_goes_from_openexr_to_pq_and_back() {
    let bench = Bench::new();
    let metadata = Metadata { white_luminance: Some(100.0), ..tagged(Transfer::Linear, Primaries::REC2020) };
    save(&bench, "a.exr", [10.0, 10.0, 10.0], Depth::Float, &metadata);
    convert(&bench, "a.exr", "a.png", &["--out-transfer", "pq", "--depth", "16"]);
    // 1000 cd/m² are 75.18 % of the signal (ITU-R BT.2408).
    let Samples::U16(codes) = bench.load("a.png").into_samples() else { panic!("16 bits") };
    assert!((f64::from(codes[0]) / 65535.0 - 0.751_827).abs() < 1e-4, "{}", codes[0]);
    convert(&bench, "a.png", "back.exr", &[]);
    let white = probe(bench.path("back.exr")).unwrap().metadata.white_luminance.unwrap();
    assert!((light(&bench, "back.exr")[0] * white - 1000.0).abs() < 0.5);
}

#[test]
fn primaries_can_be_asked_for_and_declared() {
    let bench = Bench::new();
    let metadata = tagged(Transfer::Linear, Primaries::AP1);
    save(&bench, "aces.exr", [0.2, 0.3, 0.4], Depth::Float, &metadata);
    convert(&bench, "aces.exr", "out.exr", &["--primaries", "rec709"]);
    assert_light(light(&bench, "out.exr"), between(&Primaries::AP1, &Primaries::REC709, [0.2, 0.3, 0.4]), 1e-6);
    assert_eq!(probe(bench.path("out.exr")).unwrap().metadata.primaries, Some(Primaries::REC709));
    // There and back.
    convert(&bench, "out.exr", "back.exr", &["--primaries", "acescg"]);
    assert_light(light(&bench, "back.exr"), [0.2, 0.3, 0.4], 1e-6);

    save(&bench, "plain.exr", [0.2, 0.3, 0.4], Depth::Float, &Metadata::default());
    convert(&bench, "plain.exr", "out.exr", &["--in-primaries", "acescg", "--primaries", "rec709"]);
    assert_light(light(&bench, "out.exr"), between(&Primaries::AP1, &Primaries::REC709, [0.2, 0.3, 0.4]), 1e-6);
    let run = convert(&bench, "aces.exr", "out.exr", &["--in-primaries", "rec2020"]);
    assert_says(&text(&run.stderr), &["--in-primaries has no effect"]);
    // Colours of the command line and formulas are those of sRGB.
    bench.succeed(&["convert", "builtin:demo", "a.exr", "-y", "--to", "equirect", "--size", "16x8"]);
    let p3 = ["--primaries", "p3-d65"];
    let demo = ["convert", "builtin:demo", "b.exr", "-y", "--to", "equirect", "--size", "16x8"];
    bench.succeed(&[&demo[..], &p3].concat());
    let expected = light(&bench, "a.exr").map(f64::from);
    assert_light(light(&bench, "b.exr"), between(&Primaries::REC709, &Primaries::P3_D65, expected), 2e-3);
    let outside = ["convert", "aces.exr", "c.exr", "--from", "equirect", "--to", "fulldome", "--size", "16", "-y"];
    bench.succeed(&[&outside[..], &["--background", "red"]].concat());
    let corner = bench.load("c.exr").to_light(&Transfer::Linear).get(0, 0).0;
    let expected = between(&Primaries::REC709, &Primaries::AP1, [1.0, 0.0, 0.0]);
    assert_light([corner[0], corner[1], corner[2]], expected, 1e-3);
}

#[test]
fn views_of_different_primaries_show_one_world() {
    let bench = Bench::new();
    let colour = [0.3, 0.5, 0.2];
    for (place, face) in ["front", "right", "back", "left", "top", "bottom"].iter().enumerate() {
        let primaries = [Primaries::REC709, Primaries::P3_D65][place % 2];
        let own = between(&Primaries::REC709, &primaries, colour).map(|light| light as f32);
        let image = Image::filled(16, 16, Rgba::opaque(own[0], own[1], own[2]));
        let encoded = EncodedImage::encode(&image, Channels::Rgb, Depth::Sixteen, &Transfer::Srgb);
        let options = WriteOptions::with_metadata(tagged(Transfer::Srgb, primaries));
        write(bench.path(&format!("{face}.png")), &encoded, &options).unwrap();
    }
    bench.succeed(&["convert", "{face}.png", "out.png", "--to", "equirect", "--size", "32x16"]);
    let out = bench.load("out.png").to_light(&Transfer::Srgb);
    for pixel in out.pixels() {
        assert_light([pixel.0[0], pixel.0[1], pixel.0[2]], colour, 2e-4);
    }
}

#[test]
fn what_is_outside_is_kept_in_floats_and_told_of_integers() {
    let bench = Bench::new();
    let green = [0.0, 1.0, 0.0];
    save(&bench, "green.exr", [0.0, 1.0, 0.0], Depth::Half, &tagged(Transfer::Linear, Primaries::REC2020));
    let run = convert(&bench, "green.exr", "out.exr", &["--primaries", "rec709"]);
    assert!(!text(&run.stderr).contains("warning"), "{}", text(&run.stderr));
    assert_light(light(&bench, "out.exr"), between(&Primaries::REC2020, &Primaries::REC709, green), 2e-3);
    for name in ["out.png", "out.hdr"] {
        let run = convert(&bench, "green.exr", name, &["--primaries", "rec709"]);
        assert_says(&text(&run.stderr), &["green.exr: 100.00 % of its pixels lie outside", "Rec. 709", "clipped"]);
        assert_light(light(&bench, name), [0.0, light(&bench, name)[1].into(), 0.0], 1e-6);
    }
    // So does light that was negative before, in the same primaries.
    save(&bench, "negative.exr", [-0.25, 0.5, 0.5], Depth::Half, &Metadata::default());
    let run = convert(&bench, "negative.exr", "negative.png", &[]);
    assert_says(&text(&run.stderr), &["negative.exr: 100.00 % of its pixels lie outside", "clipped"]);
    // A format that names no primaries gets Rec. 709, and says so.
    save(&bench, "grey.png", [0.4, 0.5, 0.3], Depth::Eight, &tagged(Transfer::Srgb, Primaries::P3_D65));
    let run = convert(&bench, "grey.png", "out.tga", &[]);
    assert_says(&text(&run.stderr), &["TGA files cannot name the input's primaries, P3-D65", "converted to Rec. 709"]);
    assert_light(light(&bench, "out.tga"), between(&Primaries::P3_D65, &Primaries::REC709, [0.4, 0.5, 0.3]), 5e-3);
    let run = convert(&bench, "grey.png", "out.tga", &["--primaries", "p3-d65"]);
    assert_says(&text(&run.stderr), &["nothing says that these are P3-D65"]);
    assert_light(light(&bench, "out.tga"), [0.4, 0.5, 0.3], 5e-3);
}

/// A display's profile of tables: its curves are gone, and a table is in place of its colorants.
pub(super) fn tables() -> Vec<u8> {
    let mut profile = parts_of_tables();
    let length = (profile.len() as u32).to_be_bytes();
    profile[..4].copy_from_slice(&length);
    profile
}

/// An ICC profile, by hand: a header, and one tag, `A2B0`, of type `mft1` with a grid of 2×2×2.
fn parts_of_tables() -> Vec<u8> {
    let mut table = b"mft1\0\0\0\0".to_vec();
    table.extend([3, 3, 2, 0]);
    for number in [1_i32, 0, 0, 0, 1, 0, 0, 0, 1] {
        table.extend((number << 16).to_be_bytes());
    }
    let ramp: Vec<u8> = (0..=255).collect();
    (0..3).for_each(|_| table.extend(&ramp));
    for corner in 0..8_u8 {
        table.extend([4, 2, 1].map(|bit| if corner & bit > 0 { 255 } else { 0 }));
    }
    (0..3).for_each(|_| table.extend(&ramp));
    let mut header = vec![0; 128];
    header[8..12].copy_from_slice(&[2, 0x20, 0, 0]);
    header[12..24].copy_from_slice(b"mntrRGB XYZ ");
    header[36..40].copy_from_slice(b"acsp");
    for (place, number) in [0x0000_f6d6_u32, 0x0001_0000, 0x0000_d32d].iter().enumerate() {
        header[68 + 4 * place..72 + 4 * place].copy_from_slice(&number.to_be_bytes());
    }
    header.extend(1_u32.to_be_bytes());
    header.extend(b"A2B0");
    header.extend(144_u32.to_be_bytes());
    header.extend((table.len() as u32).to_be_bytes());
    header.extend(table);
    header
}

#[test]
fn profiles_that_cannot_be_followed() {
    let bench = Bench::new();
    let options = |icc: Vec<u8>| WriteOptions::with_metadata(Metadata { icc: Some(icc), ..Metadata::default() });
    let image = flat(16, 8, &[200, 100, 50]);
    write(bench.path("tables.tif"), &image, &options(tables())).unwrap();
    let run = convert(&bench, "tables.tif", "out.png", &[]);
    assert!(!text(&run.stderr).contains("warning"), "{}", text(&run.stderr));
    assert_eq!(probe(bench.path("out.png")).unwrap().metadata.icc, Some(tables()));
    assert!(bench.load("out.png").samples() == image.samples());
    for (output, extra) in [("new.exr", &[][..]), ("new.png", &["--primaries", "rec709"]), ("new.tga", &[])] {
        let args = [&["convert", "tables.tif", output], &EQUIRECT[..], extra].concat();
        assert_says(
            &bench.fail(1, &args),
            &["tables.tif: its ICC profile holds tables of colours", "--ignore-profile"],
        );
    }
    let run = convert(&bench, "tables.tif", "out.tga", &["--ignore-profile"]);
    assert_says(&text(&run.stderr), &["ICC profiles are ignored"]);
    assert_says(&bench.succeed(&["info", "tables.tif"]), &["icc_profile_holds: tables of colours"]);

    write(bench.path("damaged.jpg"), &image, &options(tables()[..150].to_vec())).unwrap();
    let args = [&["convert", "damaged.jpg", "new.png"], &EQUIRECT[..]].concat();
    assert_says(&bench.fail(1, &args), &["damaged.jpg: its ICC profile is damaged", "--ignore-profile"]);
    let info = bench.run(&["info", "damaged.jpg"]);
    assert_eq!(info.status.code(), Some(1));
    let told = text(&info.stdout);
    assert!(told.lines().nth(1).is_some_and(|line| line.starts_with("icc_profile_damaged: ")), "{told}");
    convert(&bench, "damaged.jpg", "out.png", &["--ignore-profile"]);
    assert_eq!(probe(bench.path("out.png")).unwrap().metadata.icc, None);
    let run = convert(&bench, "out.png", "other.png", &["--ignore-profile"]);
    assert_says(&text(&run.stderr), &["--ignore-profile has no effect"]);
}

#[test]
fn info_says_colour_spaces_as_people_do() {
    let bench = Bench::new();
    for (name, depth, transfer, primaries, said) in [
        ("a.png", Depth::Sixteen, Transfer::Pq, Primaries::REC2020, "Rec. 2020, PQ"),
        ("b.png", Depth::Eight, Transfer::Srgb, Primaries::REC709, "sRGB"),
        ("c.tif", Depth::Eight, Transfer::Srgb, Primaries::P3_D65, "Display P3"),
        ("d.exr", Depth::Half, Transfer::Linear, Primaries::AP1, "ACEScg"),
        ("e.hdr", Depth::Float, Transfer::Linear, Primaries::REC2020, "Rec. 2020, linear"),
    ] {
        save(&bench, name, [0.3, 0.4, 0.5], depth, &tagged(transfer, primaries));
        assert_says(&bench.succeed(&["info", name]), &[&format!("colour_space: {said}\n")]);
        assert_says(&bench.succeed(&["info", name, "--json"]), &[&format!("\"colour_space\": \"{said}\"")]);
    }
}

#[test]
fn pictures_of_different_primaries_are_compared_as_light() {
    let bench = Bench::new();
    let colour = [0.3, 0.5, 0.2];
    save(&bench, "a.png", colour.map(|light| light as f32), Depth::Sixteen, &tagged(Transfer::Srgb, Primaries::REC709));
    let own = between(&Primaries::REC709, &Primaries::REC2020, colour).map(|light| light as f32);
    save(&bench, "b.png", own, Depth::Sixteen, &tagged(Transfer::Pq, Primaries::REC2020));
    bench.succeed(&["compare", "a.png", "b.png", "--min-psnr", "70"]);
    save(
        &bench,
        "c.png",
        colour.map(|light| light as f32),
        Depth::Sixteen,
        &tagged(Transfer::Srgb, Primaries::REC2020),
    );
    assert!(!bench.run(&["compare", "a.png", "c.png", "--min-psnr", "40"]).status.success());
}

/// A program that was built without OpenColorIO says how to build one with it.
#[cfg(not(feature = "ocio"))]
#[test]
fn a_config_needs_a_program_that_can_read_it() {
    let bench = Bench::new();
    bench.save("a.png", &flat(16, 8, &[100, 150, 200]));
    let convert = ["convert", "a.png", "b.png", "--from", "equirect", "--to", "fulldome"];
    let refused = |more: &[&str]| bench.fail(2, &[&convert, more].concat());
    let config = ["--ocio", "ocio://default", "--in-space", "ACEScg"];
    assert_says(&refused(&config), &["--ocio ocio://default", "with the feature ocio"]);
    assert_says(&refused(&["--ocio", "ocio://default"]), &["--in-space"]);
    let nameless =
        bench.command(&[&convert[..], &["--in-space", "ACEScg"]].concat()).env_remove("OCIO").output().unwrap();
    assert_says(&text(&nameless.stderr), &["--ocio", "$OCIO"]);
    assert_says(&refused(&[&config[..], &["--primaries", "rec2020"]].concat()), &["--primaries", "--ocio"]);
    let both = ["--out-space", "ACEScg", "--view", "a/b"];
    assert_says(&refused(&[&config[..], &both].concat()), &["--out-space or --view"]);
    // The variable alone is no request.
    let made = bench.command(&convert).env("OCIO", "ocio://default").output().unwrap();
    assert!(made.status.success(), "{}", text(&made.stderr));
}
