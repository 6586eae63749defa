//! Stereo pairs: each eye's world on its own, every packing, in and out.

use crate::bench::{Bench, assert_says, eight_bits, flat, picture, word};
use cosmorama::sphere::CubeFace;

/// Nothing of one in the other.
const LEFT: [u8; 3] = [250, 0, 0];
const RIGHT: [u8; 3] = [0, 0, 240];

/// Packings with the size of an image for pictures of 64×32.
const PACKINGS: [(&str, (usize, usize)); 4] =
    [("sbs", (128, 32)), ("tb", (64, 64)), ("sbs-half", (64, 32)), ("tb-half", (64, 32))];

/// An image whose eyes have a colour each.
fn pair(bench: &Bench, name: &str, (width, height): (usize, usize), stacked: bool) {
    let mut image = flat(width, height, &LEFT).into_samples();
    let cosmorama::raster::Samples::U8(samples) = &mut image else { panic!("8 bits are 8 bits") };
    for (at, pixel) in samples.chunks_mut(3).enumerate() {
        let is_second = if stacked { at / width >= height / 2 } else { at % width >= width / 2 };
        if is_second {
            pixel.copy_from_slice(&RIGHT);
        }
    }
    let (channels, depth) = (cosmorama::raster::Channels::Rgb, cosmorama::raster::Depth::Eight);
    bench.save(name, &cosmorama::raster::EncodedImage::new(width, height, channels, depth, image).unwrap());
}

/// Whether a pixel has light of a colour alone, all of it or less.
fn is_part_of(pixel: &[u8], colour: [u8; 3]) -> bool {
    pixel.iter().zip(colour).all(|(found, full)| *found <= full)
}

/// Every pixel of an image has the colour of its half, or less of it at the rim of a lens.
#[track_caller]
fn assert_apart(bench: &Bench, name: &str, stacked: bool, [first, second]: [[u8; 3]; 2]) {
    let image = bench.load(name);
    let (width, height) = (image.width(), image.height());
    let mut counts = [0usize; 2];
    for (at, pixel) in eight_bits(&image).chunks(3).enumerate() {
        let half = if stacked { at / width >= height / 2 } else { at % width >= width / 2 };
        let expected = if half { second } else { first };
        assert!(is_part_of(pixel, expected), "{name}: {pixel:?} at {at}, not {expected:?}");
        counts[usize::from(half)] += usize::from(pixel == expected);
    }
    assert!(counts[0] > width * height / 8 && counts[0] == counts[1], "{name}: {counts:?}");
}

#[test]
fn nothing_of_one_eye_reaches_the_other() {
    let bench = Bench::new();
    for (packing, size) in PACKINGS {
        pair(&bench, "in.png", size, packing.starts_with("tb"));
        let from = format!("equirect:stereo={packing}");
        for (out, stacked, swapped) in [("sbs", false, false), ("tb", true, false), ("tb-half,swap=yes", true, true)] {
            for to in ["equirect:yaw=30", "cube:layout=3x2", "dual-fisheye", "perspective:fov=70,pitch=80"] {
                let keys = if to.contains(':') { "," } else { ":" };
                let spec = format!("{to}{keys}stereo={out}");
                bench.succeed(&["convert", "in.png", "out.png", "-y", "--from", &from, "--to", &spec, "--size", "32"]);
                let colours = if swapped { [RIGHT, LEFT] } else { [LEFT, RIGHT] };
                assert_apart(&bench, "out.png", stacked, colours);
                // And back, each eye alone.
                for (eye, colour) in [("left", LEFT), ("right", RIGHT)] {
                    let back = format!("{spec},eye={eye}");
                    let to = ["--to", "perspective:fov=60,pitch=80", "--yaw", "-10", "--size", "8"];
                    bench.succeed(&[&["convert", "out.png", "eye.png", "-y", "--from", &back], &to[..]].concat());
                    let image = bench.load("eye.png");
                    // Black around a circle darkens its outermost texels.
                    let is_own = |pixel: &[u8]| is_part_of(pixel, colour) && pixel.iter().any(|code| *code > 120);
                    assert!(eight_bits(&image).chunks(3).all(is_own), "{back}: {:?}", eight_bits(&image));
                }
            }
        }
    }
}

#[test]
fn what_is_packed_comes_out_as_it_was() {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "sky.png", "--to", "equirect", "--size", "512"]);
    for (to, size, out) in [
        ("equirect:stereo=sbs", "512", (1024, 256)),
        ("equirect:stereo=tb", "512", (512, 512)),
        ("equirect:stereo=sbs", "1024x256", (1024, 256)),
        ("equirect:stereo=sbs-half", "512", (512, 256)),
        ("equirect:stereo=tb-half,swap=yes,flip=x", "512x256", (512, 256)),
        ("dual-fisheye:stereo=tb", "320", (640, 640)),
        ("cube:layout=cross-h,stereo=sbs-half", "160", (640, 480)),
        ("cube:layout=strip-v,half=up,stereo=tb", "160", (160, 1760)),
    ] {
        let output = bench.run(&["convert", "sky.png", "pair.png", "-y", "--to", to, "--size", size]);
        let said = crate::bench::text(&output.stderr);
        assert!(output.status.success() && said.contains("both eyes get the same picture"), "{to}: {said}");
        let pair = bench.load("pair.png");
        assert_eq!((pair.width(), pair.height()), out, "{to}");
        let view = ["--to", "perspective:fov=80", "--pitch", "45", "--size", "160"];
        bench.succeed(&[&["convert", "sky.png", "direct.png", "-y"], &view[..]].concat());
        let said = bench.run(&[&["convert", "pair.png", "left.png", "-y", "--from", to], &view[..]].concat());
        assert!(
            crate::bench::text(&said.stderr).contains("eye=left, or eye=right"),
            "{}",
            crate::bench::text(&said.stderr)
        );
        bench.succeed(&["compare", "left.png", "direct.png", "--min-psnr", "26", "--max-shift", "0.06"]);
    }
}

#[test]
fn files_of_faces_and_world_files_hold_eyes_too() {
    let bench = Bench::new();
    for face in CubeFace::ALL {
        pair(&bench, &format!("{}.png", word(face)), (32, 32), false);
    }
    let to = ["--to", "equirect:stereo=tb", "--size", "64"];
    bench.succeed(&[&["convert", "{face}.png", "faces.png", "--from", "cube:stereo=sbs-half"], &to[..]].concat());
    assert_apart(&bench, "faces.png", true, [LEFT, RIGHT]);
    bench.succeed(&[
        "convert",
        "faces.png",
        "out_{face}.png",
        "--from",
        "e:stereo=tb",
        "--to",
        "cube:stereo=sbs",
        "--size",
        "16",
    ]);
    assert_apart(&bench, "out_top.png", false, [LEFT, RIGHT]);
    // A mono picture in front of a stereo world is seen by both eyes.
    bench.save("sign.png", &flat(16, 16, &[0, 200, 0]));
    let world = "[[view]]\nimage = \"faces.png\"\nspec = \"equirect:stereo=tb\"\n\n[[view]]\nimage = \"sign.png\"\nspec = \
                 \"perspective:fov=30\"\npriority = 1\n";
    std::fs::write(bench.path("world.toml"), world).unwrap();
    let to = ["--to", "perspective:fov=60,stereo=sbs", "--size", "32x16"];
    bench.succeed(&[&["convert", "world.toml", "both.png"], &to[..]].concat());
    let both = bench.load("both.png");
    let at = |x: usize, y: usize| eight_bits(&both)[(y * 32 + x) * 3..][..3].to_vec();
    assert_eq!((at(8, 8), at(24, 8)), (vec![0, 200, 0], vec![0, 200, 0]));
    assert_eq!((at(1, 1), at(30, 1)), (LEFT.to_vec(), RIGHT.to_vec()));
    // Patterns by formula have no depth, but two eyes if need be.
    bench.succeed(&["convert", "builtin:grid", "grid.png", "--to", "fulldome:stereo=sbs", "--size", "64"]);
    assert_eq!(bench.load("grid.png").width(), 128);
    let explained = bench.succeed(&[&["explain", "world.toml"], &to[..]].concat());
    assert!(explained.contains("left-eye:") && explained.contains("right-eye:"), "{explained}");
}

#[test]
fn mistakes_about_eyes() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    bench.save("odd.png", &picture(1, 63, 33));
    let refused = |code: i32, args: &[&str], says: &[&str]| assert_says(&bench.fail(code, args), says);
    let to = |spec: &'static str, output: &'static str| ["convert", "sky.png", output, "--to", spec, "--size", "32"];
    refused(2, &to("equirect:swap=yes", "o.png"), &["swap=yes", "stereo=sbs"]);
    refused(2, &to("equirect:stereo=3d", "o.png"), &["expected one of sbs, tb, sbs-half, tb-half"]);
    refused(2, &to("equirect:stereo=sbs,eye=left", "o.png"), &["eye=left is for inputs"]);
    refused(2, &to("cube:stereo=sbs", "o.ktx2"), &["strip-h, strip-v"]);
    refused(2, &to("cube:layout=strip-v,stereo=tb", "o.ktx2"), &["six whole faces"]);
    refused(2, &to("cube:stereo=sbs", "o.exr"), &["strip-h, strip-v"]);
    let odd = |spec: &'static str| ["convert", "odd.png", "o.png", "--from", spec, "--to", "fulldome", "--size", "32"];
    refused(1, &odd("equirect:stereo=sbs"), &["odd.png", "63x33", "even width"]);
    refused(1, &odd("equirect:stereo=tb"), &["odd.png", "63x33", "even height"]);
    let size = ["convert", "sky.png", "o.png", "--to", "equirect:stereo=sbs", "--size", "33x16"];
    refused(2, &size, &["33x16", "even width"]);
    let half = ["convert", "sky.png", "o.png", "--to", "cube:layout=3x2,stereo=sbs-half", "--size", "33"];
    refused(2, &half, &["even"]);
}
