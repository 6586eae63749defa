//! Other programs read what we write, and we what they write: our file in one format goes through the program
//! into another and comes back to us.

use std::path::Path;
use std::process::Command;

use crate::common::{picture, program};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};
use cosmorama_io::{
    Choice, EnvMap, LayeredImage, Limits, Metadata, Plane, PlaneSamples, Window, WriteOptions, check_chosen, open,
    probe, read, read_layers, write, write_layers, write_levels,
};

fn run(program: &str, arguments: &[&str]) {
    let output = Command::new(program).args(arguments).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program} {}: {text}", arguments.join(" "));
}

/// Our file, through the program, back to us.
fn through(program: &str, image: &EncodedImage, ours: &Path, theirs: &Path, options: &[&str]) -> EncodedImage {
    write(ours, image, &WriteOptions::default()).unwrap();
    let mut arguments: Vec<&str> = Vec::new();
    if program == "ffmpeg" {
        arguments.extend(["-v", "error", "-y", "-i"]);
    }
    arguments.push(ours.to_str().unwrap());
    arguments.extend(options);
    if program == "oiiotool" {
        arguments.push("-o");
    }
    arguments.push(theirs.to_str().unwrap());
    run(program, &arguments);
    check_chosen(open(theirs).unwrap(), theirs, &Limits::default(), &Choice::default()).unwrap();
    read(theirs, &Limits::default()).unwrap().image
}

fn largest_difference(a: &EncodedImage, b: &EncodedImage) -> f32 {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let (a, b) = (a.to_light(&Transfer::Linear), b.to_light(&Transfer::Linear));
    let pairs = a.pixels().iter().zip(b.pixels());
    pairs.map(|(a, b)| (0..4).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max)).fold(0.0, f32::max)
}

/// One journey: our extension, theirs, depth, channels, options of the program, error allowed.
type Journey<'a> = (&'a str, &'a str, Depth, Channels, &'a [&'a str], f32);

fn journeys(program: &str, list: &[Journey<'_>]) {
    let folder = tempfile::tempdir().unwrap();
    for (i, (from, to, depth, channels, options, allowed)) in list.iter().enumerate() {
        let image = picture(150, 70, *channels, *depth);
        let ours = folder.path().join(format!("ours{i}.{from}"));
        let theirs = folder.path().join(format!("theirs{i}.{to}"));
        let back = through(program, &image, &ours, &theirs, options);
        let difference = largest_difference(&image, &back);
        assert!(difference <= *allowed, "{program} {from} → {to} {depth} {channels} {options:?}: {difference}");
    }
}

#[test]
fn oiiotool() {
    let Some(oiiotool) = program("oiiotool") else { return };
    use Channels::{Grey, Rgb, Rgba};
    use Depth::{Eight, Float, Half, Sixteen};
    journeys(
        oiiotool,
        &[
            ("png", "tif", Eight, Rgb, &[], 0.0),
            ("png", "tif", Sixteen, Rgb, &[], 0.0),
            ("png", "tif", Sixteen, Grey, &[], 0.0),
            ("tif", "png", Sixteen, Rgb, &[], 0.0),
            ("tif", "png", Eight, Grey, &[], 0.0),
            ("tga", "png", Eight, Rgb, &[], 0.0),
            ("png", "tga", Eight, Rgb, &[], 0.0),
            ("png", "tga", Eight, Grey, &[], 0.0),
            ("tif", "exr", Float, Rgb, &[], 0.0),
            ("tif", "exr", Half, Rgba, &[], 0.0),
            ("exr", "tif", Float, Rgba, &[], 0.0),
            ("exr", "tif", Half, Rgb, &["-d", "half"], 0.0),
            ("exr", "exr", Half, Rgb, &["--compression", "piz"], 0.0),
            ("exr", "exr", Float, Rgb, &["--compression", "rle"], 0.0),
            ("exr", "exr", Half, Rgba, &["--compression", "zips", "--tile", "32", "32"], 0.0),
            ("exr", "exr", Float, Rgba, &["--tile", "64", "16"], 0.0),
            ("exr", "exr", Half, Rgb, &["--compression", "pxr24"], 0.0),
            ("exr", "exr", Half, Rgb, &["--compression", "b44"], 0.1),
            ("exr", "exr", Half, Rgb, &["--compression", "dwaa"], 0.2),
            ("exr", "exr", Float, Rgba, &["--compression", "dwab", "--tile", "64", "64"], 0.2),
            ("exr", "exr", Half, Grey, &["--compression", "none"], 0.0),
            ("hdr", "exr", Float, Rgb, &[], 1.0 / 256.0),
            ("exr", "hdr", Float, Rgb, &[], 1.0 / 128.0),
            ("jpg", "png", Eight, Rgb, &[], 0.3),
            ("png", "jpg", Eight, Grey, &[], 0.3),
        ],
    );
}

#[test]
fn oiiotool_reads_our_cubes() {
    let Some(oiiotool) = program("oiiotool") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    // Opaque: it would multiply by alpha.
    let colours = picture(32, 192, Channels::Rgb, Depth::Eight).to_light(&Transfer::Linear);
    let image = EncodedImage::encode(&colours, Channels::Rgba, Depth::Eight, &Transfer::Linear);
    let metadata = Metadata { envmap: Some(EnvMap::GlCube), ..Metadata::default() };
    write(Path::new(&at("a.dds")), &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
    // It takes the first face for the picture and the others for what lies outside.
    run(oiiotool, &[&at("a.dds"), "--fullpixels", "-o", &at("a.tif")]);
    let back = read(Path::new(&at("a.tif")), &Limits::default()).unwrap().image;
    assert_eq!((back.width(), back.height()), (32, 192));
    assert!(largest_difference(&image, &back) < 1e-6);
}

/// Mip levels in OpenEXR: tiles, each level its own picture, down to one pixel.
#[test]
fn oiiotool_and_exrheader_read_our_mip_levels() {
    let (Some(oiiotool), Some(exrheader)) = (program("oiiotool"), program("exrheader")) else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    for (depth, channels) in [(Depth::Half, Channels::Rgb), (Depth::Float, Channels::Rgba)] {
        let sizes = [(150, 70), (75, 35), (37, 17), (18, 8), (9, 4), (4, 2), (2, 1), (1, 1)];
        let levels = sizes.map(|(width, height)| picture(width, height, channels, depth));
        write_levels(Path::new(&at("mips.exr")), &levels, &WriteOptions::default()).unwrap();
        let header = Command::new(exrheader).arg(at("mips.exr")).output().unwrap();
        let header = String::from_utf8_lossy(&header.stdout).into_owned();
        assert!(header.contains("mip-map") && header.contains("tile size 64 by 64 pixels"), "{header}");
        for (level, image) in levels.iter().enumerate() {
            let selected = level.to_string();
            run(oiiotool, &[&at("mips.exr"), "--selectmip", &selected, "-o", &at("level.exr")]);
            let found = read(Path::new(&at("level.exr")), &Limits::default()).unwrap().image;
            assert!(largest_difference(image, &found) == 0.0, "{depth}, level {level}");
        }
        // We read the largest.
        assert!(read(Path::new(&at("mips.exr")), &Limits::default()).unwrap().image == levels[0]);
        for wrong in [&levels[..3], &[&levels[..1], &levels[2..], &levels[7..]].concat()] {
            let error = write_levels(Path::new(&at("mips.exr")), wrong, &WriteOptions::default());
            assert!(error.unwrap_err().to_string().contains("level"));
        }
    }
}

#[test]
fn image_magick() {
    let Some(convert) = program("/usr/bin/convert") else { return };
    use Channels::{Grey, GreyAlpha, Rgb, Rgba};
    use Depth::{Eight, Sixteen};
    journeys(
        convert,
        &[
            ("png", "tif", Eight, Rgba, &[], 0.0),
            ("tif", "png", Sixteen, Rgba, &[], 0.0),
            ("tif", "png", Sixteen, GreyAlpha, &[], 0.0),
            ("png", "tif", Sixteen, Rgb, &["-compress", "LZW"], 0.0),
            ("png", "png", Sixteen, Grey, &["-interlace", "PNG"], 0.0),
            ("tga", "tif", Eight, Rgba, &[], 0.0),
            // TGA is not asked of it: version 6 writes rows from the top and declares them from the bottom.
            ("jpg", "png", Eight, Grey, &[], 0.3),
            ("png", "jpg", Eight, Rgb, &["-interlace", "Plane", "-quality", "97"], 0.3),
        ],
    );
}

#[test]
fn ffmpeg() {
    let Some(ffmpeg) = program("ffmpeg") else { return };
    use Channels::{Grey, Rgb, Rgba};
    use Depth::{Eight, Float, Sixteen};
    journeys(
        ffmpeg,
        &[
            ("png", "tif", Eight, Rgb, &[], 0.0),
            ("tif", "png", Sixteen, Rgb, &[], 0.0),
            ("png", "tga", Eight, Rgba, &[], 0.0),
            ("tga", "png", Eight, Rgb, &[], 0.0),
            ("tif", "png", Eight, Grey, &[], 0.0),
            ("exr", "exr", Float, Rgb, &[], 0.0),
            ("jpg", "png", Eight, Rgb, &[], 0.3),
        ],
    );
}

#[test]
fn exr_windows() {
    let Some(oiiotool) = program("oiiotool") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let image = picture(40, 30, Channels::Rgb, Depth::Half);
    write(Path::new(&at("a.exr")), &image, &WriteOptions::default()).unwrap();

    // A data window in a larger display window, both away from zero.
    run(oiiotool, &[&at("a.exr"), "--origin", "+5-3", "--fullsize", "100x60-10-20", "-o", &at("small.exr")]);
    let file = read(Path::new(&at("small.exr")), &Limits::default()).unwrap();
    assert_eq!(file.window, Some(Window { canvas_width: 100, canvas_height: 60, x: 15, y: 17 }));
    assert_eq!(file.image, image);

    // A data window beyond the display window is cut; tiles, too.
    for options in [&["--scanline"][..], &["--tile", "16", "16"]] {
        let a = at("a.exr");
        let large = at("large.exr");
        let mut arguments = vec![a.as_str(), "--fullsize", "20x10+4+6"];
        arguments.extend(options);
        arguments.extend(["-o", large.as_str()]);
        run(oiiotool, &arguments);
        let file = read(Path::new(&large), &Limits::default()).unwrap();
        assert_eq!((file.image.width(), file.image.height(), file.window), (20, 10, None));
        assert_eq!(probe(Path::new(&large)).unwrap().width, 20);
        let (cut, whole) = (file.image.to_light(&Transfer::Linear), image.to_light(&Transfer::Linear));
        assert_eq!(cut.get(0, 0), whole.get(4, 6));
        assert_eq!(cut.get(19, 9), whole.get(23, 15));
    }
}

#[test]
fn exr_layers_and_other_channels() {
    let Some(oiiotool) = program("oiiotool") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let image = picture(40, 30, Channels::Rgba, Depth::Half);
    write(Path::new(&at("a.exr")), &image, &WriteOptions::default()).unwrap();
    // The same four channels in two layers, and a depth.
    let names = "beauty.R,beauty.G,beauty.B,beauty.A,extra.R,extra.G,extra.B,Z";
    let append = [&*at("a.exr"), &at("a.exr"), "--chappend", "--ch", "0,1,2,3,4,5,6,7", "--chnames", names];
    run(oiiotool, &[&append[..], &["-o", &at("layers.exr")]].concat());
    let file = read(Path::new(&at("layers.exr")), &Limits::default()).unwrap();
    assert_eq!(file.image, image);
    assert_eq!(file.metadata.other_channels, ["Z", "extra.B", "extra.G", "extra.R"]);
    // Of several parts, each a picture, the first is read.
    run(oiiotool, &[&at("a.exr"), "--dup", "--siappend", "-o", &at("parts.exr")]);
    let file = read(Path::new(&at("parts.exr")), &Limits::default()).unwrap();
    assert!(file.image == image && file.metadata.layers.parts.len() == 2);
}

#[test]
fn named_channels_of_every_type_as_others_read_them() {
    let (Some(oiiotool), Some(exrheader)) = (program("oiiotool"), program("exrheader")) else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let image = picture(40, 30, Channels::Rgb, Depth::Half);
    let depths: Vec<f32> = (0..1200).map(|k| 1e6 + k as f32).collect();
    let plane = |name: &str, samples| Plane { name: name.to_owned(), samples };
    let ids = plane("objectId", PlaneSamples::Uint((0..1200).collect()));
    let planes = vec![ids.clone(), plane("depth.Z", PlaneSamples::Float(depths.clone()))];
    let layered = LayeredImage { size: (40, 30), picture: Some(&image), names: Vec::new(), planes };
    write_layers(at("layers.exr"), layered, &WriteOptions::default()).unwrap();

    let header = Command::new(exrheader).arg(at("layers.exr")).output().unwrap();
    let header = String::from_utf8_lossy(&header.stdout).into_owned();
    for channel in ["R, 16-bit floating-point", "depth.Z, 32-bit floating-point", "objectId, 32-bit unsigned integer"] {
        assert!(header.contains(channel), "{channel} is not in {header}");
    }
    // What it writes again has the same values.
    run(oiiotool, &[&at("layers.exr"), "--ch", "R,G,B,depth.Z", "-d", "float", "-o", &at("theirs.exr")]);
    let (path, limits) = (at("theirs.exr"), Limits::default());
    let read =
        read_layers(open(Path::new(&path)).unwrap(), &path, &limits, (&Choice::default(), &["depth.Z"])).unwrap();
    assert_eq!(read[0].samples, PlaneSamples::Float(depths));
}

#[test]
fn palettes_and_few_bits() {
    let Some(convert) = program("/usr/bin/convert") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let ramp = ["-size", "1x4", "gradient:white-black", "-depth", "2"];
    for (name, options) in [
        ("grey2.png", &["-type", "Grayscale", "-define", "png:bit-depth=2", "-define", "png:color-type=0"][..]),
        ("palette.png", &["-define", "png:color-type=3"]),
    ] {
        let target = at(name);
        run(convert, &[&ramp[..], options, &[&target]].concat());
        let file = read(Path::new(&target), &Limits::default()).unwrap().image;
        let Samples::U8(samples) = file.samples() else { panic!("{name}: 8 bits") };
        let first: Vec<u8> = samples.chunks(file.channels().count()).map(|pixel| pixel[0]).collect();
        assert_eq!(first, [255, 170, 85, 0], "{name}");
    }
}

/// It keeps what our panorama said of its chunks, of which its cube has more.
#[test]
fn the_cube_that_exrenvmap_makes_of_ours() {
    if program("exrenvmap").is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (ours, theirs) = (folder.path().join("ours.exr"), folder.path().join("theirs.exr"));
    let image = picture(256, 128, Channels::Rgb, Depth::Half);
    let metadata = Metadata { envmap: Some(EnvMap::LatLong), ..Metadata::default() };
    write(&ours, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
    run("exrenvmap", &["-c", "-w", "96", ours.to_str().unwrap(), theirs.to_str().unwrap()]);
    let cube = read(&theirs, &Limits::default()).unwrap();
    assert_eq!((cube.image.width(), cube.image.height()), (96, 6 * 96));
    assert_eq!(cube.metadata.envmap, Some(EnvMap::Cube));
}
