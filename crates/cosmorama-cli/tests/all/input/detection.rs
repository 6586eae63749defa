//! What one image is a picture of, found without `--from`: said by metadata, guessed and announced, or refused.

use crate::bench::{Bench, assert_says, picture, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama_io::{Metadata, Window, WriteOptions, write};
use serde_json::Value;

const TO: [&str; 4] = ["--to", "perspective:fov=40", "--size", "40x30"];

fn info(bench: &Bench, name: &str) -> String {
    let report: Value = serde_json::from_str(&bench.succeed(&["info", name, "--json"])).unwrap();
    report["projection"].as_str().unwrap().to_owned()
}

/// Converts without `--from`, with nothing but `said` on the way, and as the SPEC has it: the same.
fn found(bench: &Bench, name: &str, spec: &str, said: &str) {
    let rest = [&TO[..], &["-y", "--missing", "black"]].concat();
    let output = bench.run(&[&["convert", name, "found.png"], &rest[..]].concat());
    let message = text(&output.stderr);
    assert!(output.status.success() && message.contains(said), "{name}: {message}");
    bench.succeed(&[&["convert", name, "given.png", "--from", spec], &rest[..]].concat());
    assert_eq!(bench.bytes("found.png"), bench.bytes("given.png"), "{name}");
}

fn refused(bench: &Bench, name: &str, candidates: &[&str]) {
    let message = bench.fail(1, &[&["convert", name, "found.png"], &TO[..]].concat());
    for candidate in candidates {
        assert!(message.contains(candidate), "{name}: {message}");
    }
}

#[test]
fn panoramas_say_that_they_are() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 256, 128));
    let window = "equirect:canvas=256x128+32+16";
    for name in ["part.jpg", "part.png"] {
        bench.succeed(&["convert", "sky.png", name, "--from", "equirect", "--to", window, "--size", "160x80"]);
        assert_eq!(info(&bench, name), format!("{window} (GPano metadata)"));
        found(&bench, name, window, "found.png in");
        // What is asked for may also be said in part.
        found(&bench, name, "equirect", "found.png in");
    }
    bench.succeed(&["convert", "sky.png", "whole.jpg", "--from", "equirect", "--to", "equirect", "--size", "128"]);
    assert_eq!(info(&bench, "whole.jpg"), "equirect (GPano metadata)");
    // Another projection is none, and says nothing.
    bench.succeed(&["convert", "sky.png", "dome.jpg", "--from", "equirect", "--to", "fulldome", "--size", "64"]);
    assert!(!text(&bench.bytes("dome.jpg")).contains("GPano"));
}

#[test]
fn a_panorama_that_says_it_is_huge_is_refused_before_memory_is_taken() {
    let bench = Bench::new();
    let panorama = Some(Window { canvas_width: 4_000_000_000, canvas_height: 2_000_000_000, x: 0, y: 0 });
    let metadata = Metadata { panorama, ..Metadata::default() };
    write(bench.path("a.png"), &picture(1, 40, 20), &WriteOptions::with_metadata(metadata)).unwrap();
    let message = bench.fail(1, &[&["convert", "a.png", "b.png", "--memory", "1G"], &TO[..]].concat());
    assert!(message.contains("4000000000x2000000000") && message.contains("--memory"), "{message}");
}

#[test]
fn what_is_guessed_is_announced() {
    let bench = Bench::new();
    bench.faces("world_", 64);
    let make = |name: &str, to: &str| {
        bench.succeed(&["convert", "world_{face}.png", name, "--to", to, "--size", "64"]);
    };
    make("dome.png", "fulldome");
    make("dome.jpg", "fulldome");
    make("strip.png", "cube:layout=strip-v");
    make("cross.png", "cube:layout=cross-h");
    make("cross.jpg", "cube:layout=cross-v");
    for (name, spec) in [
        ("dome.png", "fulldome"),
        ("dome.jpg", "fulldome"),
        ("strip.png", "cube:layout=strip-v"),
        ("cross.png", "cube:layout=cross-h"),
        ("cross.jpg", "cube:layout=cross-v"),
    ] {
        // A dome ends at the horizon.
        let to = ["--to", "perspective:fov=40", "--size", "40x30", "--pitch", "60"];
        let output = bench.run(&[&["convert", name, "found.png", "-y"], &to[..]].concat());
        let message = text(&output.stderr);
        assert!(output.status.success() && message.contains(&format!("--from {spec}")), "{name}: {message}");
        bench.succeed(&[&["convert", name, "given.png", "-y", "--from", spec], &to[..]].concat());
        assert_eq!(bench.bytes("found.png"), bench.bytes("given.png"), "{name}");
        assert!(info(&bench, name).starts_with(spec), "{name}");
    }
}

#[test]
fn what_could_be_several_things_is_refused() {
    let bench = Bench::new();
    for (width, height, candidates) in [
        (64, 48, &["cube:layout=cross-h", "perspective:fov=DEGREES"][..]),
        (48, 64, &["cube:layout=cross-v", "perspective:fov=DEGREES"]),
        (48, 32, &["cube:layout=3x2", "cube:layout=eac", "perspective:fov=DEGREES"]),
        (32, 48, &["cube:layout=2x3", "perspective:fov=DEGREES"]),
        (40, 40, &["fulldome", "fisheye:fov=DEGREES", "perspective:fov=DEGREES"]),
        (50, 37, &["perspective:fov=DEGREES", "equirect"]),
    ] {
        bench.save("photo.png", &picture(3, width, height));
        refused(&bench, "photo.png", candidates);
        assert!(info(&bench, "photo.png").starts_with("unknown"));
    }
    // Nothing in the picture, nothing to guess from.
    bench.save("photo.png", &crate::bench::flat(64, 48, &[0, 0, 0]));
    refused(&bench, "photo.png", &["cube:layout=cross-h"]);
}

/// A panorama of patches without any order, so that no part of it is like another.
fn patchwork(width: usize, height: usize) -> EncodedImage {
    let light = Image::from_fn(width, height, |i, j| {
        let patch = (i * 24 / width) as u32 * 92_821 + (j * 12 / height) as u32 * 68_917 + 31;
        let mixed = (patch ^ (patch >> 7)).wrapping_mul(2_654_435_761);
        let light = |bits: u32| 0.1 + 0.8 * ((mixed >> bits) & 255) as f32 / 255.0;
        Rgba::opaque(light(3), light(11), light(19))
    });
    EncodedImage::encode(&light, Channels::Rgb, Depth::Eight, &Transfer::Srgb)
}

#[test]
fn two_pictures_in_one_are_told_from_one() {
    let bench = Bench::new();
    bench.save("world.png", &patchwork(256, 128));
    for (to, told) in [
        ("dual-fisheye", "two circles on black"),
        ("dual-fisheye:layout=top-bottom", "two circles on black"),
        ("fulldome:stereo=sbs", "alike"),
        ("fulldome:stereo=tb", "alike"),
        ("equirect:stereo=tb", "halves are alike"),
        ("equirect:stereo=sbs", "halves are alike"),
        ("omnimax", "cut off below"),
    ] {
        for name in ["pair.png", "pair.jpg"] {
            let size = if to == "omnimax" { "400" } else { "128" };
            let from = ["convert", "world.png", name, "-y", "--from", "equirect", "--to", to];
            bench.succeed(&[&from[..], &["--size", size]].concat());
            assert!(info(&bench, name).starts_with(to), "{name} {to}: {}", info(&bench, name));
            found(&bench, name, to, told);
            found(&bench, name, to, &format!("--from {to}"));
        }
    }
    // Those have the shape of a panorama: it is taken for one, but what else it may be is told.
    for (to, else_what) in [
        ("equirect:stereo=sbs-half", "equirect:stereo=sbs-half"),
        ("equirect:hfov=180,stereo=sbs", "equirect:hfov=180,stereo=sbs"),
        ("equirect:stereo=tb-half", "equirect:stereo=tb-half"),
    ] {
        bench.succeed(&["convert", "world.png", "pair.png", "-y", "--from", "equirect", "--to", to, "--size", "128"]);
        assert_says(&info(&bench, "pair.png"), &["equirect (2:1)", else_what]);
        found(&bench, "pair.png", "equirect", else_what);
    }
}

#[test]
fn circles_that_do_not_fill_their_halves_are_measured() {
    let bench = Bench::new();
    bench.save("world.png", &patchwork(256, 128));
    let circles = "dual-fisheye:front.center=124:130,front.radius=110,back.center=390:126,back.radius=112";
    bench.succeed(&["convert", "world.png", "two.png", "--from", "equirect", "--to", circles, "--size", "512x256"]);
    let found = info(&bench, "two.png");
    let number = |key: &str, part: usize| -> f64 {
        let value = found.split(&format!("{key}=")).nth(1).unwrap().split([',', ' ']).next().unwrap();
        value.split(':').nth(part).unwrap().parse().unwrap()
    };
    for (key, part, drawn) in [
        ("front.center", 0, 124.0),
        ("front.center", 1, 130.0),
        ("front.radius", 0, 110.0),
        ("back.center", 0, 390.0),
        ("back.center", 1, 126.0),
        ("back.radius", 0, 112.0),
    ] {
        assert!((number(key, part) - drawn).abs() < 1.0, "{key}: {found}");
    }
    // What is printed can be typed.
    let spec = found.split(' ').next().unwrap();
    bench.succeed(&[&["convert", "two.png", "view.png", "--from", spec], &TO[..]].concat());
}

/// A circle that fills its square may be a domemaster; another is measured, whatever the blocks of a JPEG file leave around it.
#[test]
fn circles_are_measured_and_domes_are_not_guessed_of_smaller_ones() {
    let bench = Bench::new();
    bench.save("world.png", &patchwork(256, 128));
    for (size, x, y, radius) in
        [((1000, 1000), 500.0, 500.0, 480.0), ((1000, 1000), 515.0, 500.0, 485.0), ((1200, 1000), 600.0, 500.0, 450.0)]
    {
        let to = format!("fisheye:center={x}:{y},radius={radius}");
        let size = format!("{}x{}", size.0, size.1);
        for (name, quality) in [("a.png", &[][..]), ("a.jpg", &["--quality", "90"])] {
            let convert = ["convert", "world.png", name, "--from", "equirect", "--to", &to, "--size", &size, "-y"];
            bench.succeed(&[&convert[..], &["--filter", "bilinear"], quality].concat());
            let report: Value = serde_json::from_str(&bench.succeed(&["info", name, "--json"])).unwrap();
            let circle = &report["circle"];
            assert_eq!(circle["measured"], true, "{name}: {report}");
            for (key, drawn) in [("x", x), ("y", y), ("radius", radius)] {
                assert!((circle[key].as_f64().unwrap() - drawn).abs() < 0.5, "{name} {to}: {circle}");
            }
            assert!(info(&bench, name).starts_with("fisheye:fov=180,center="), "{name}: {report}");
            refused(&bench, name, &["fisheye:fov=DEGREES,center=", "radius="]);
        }
    }
    // One that fills its square but for a pixel is none that has to be told.
    let to = ["--to", "fisheye:center=250:250,radius=249", "--size", "500x500"];
    bench.succeed(&[&["convert", "world.png", "dome.png", "--from", "equirect"], &to[..]].concat());
    assert!(info(&bench, "dome.png").starts_with("fulldome"));
}

#[test]
fn a_circle_on_black_may_be_several_things() {
    let bench = Bench::new();
    bench.save("world.png", &patchwork(256, 128));
    for to in ["fisheye:fov=220", "mirror-ball", "angular-map"] {
        bench.succeed(&["convert", "world.png", "a.png", "-y", "--from", "equirect", "--to", to, "--size", "128"]);
        let candidates = ["fulldome", "fisheye:fov=DEGREES", "mirror-ball", "angular-map"];
        assert_says(&info(&bench, "a.png"), &candidates);
        let convert = [&["convert", "a.png", "b.png", "-y"], &TO[..]].concat();
        let output = bench.run(&[&convert[..], &["--missing", "black"]].concat());
        assert_says(&text(&output.stderr), &candidates);
        // Where what is guessed cannot show what is asked for, it may be the guess that is wrong.
        assert_says(&bench.fail(1, &convert), &[&candidates[..], &["look where no view does"]].concat());
    }
}

#[test]
fn what_cannot_be_read_is_not_said_to_have_been_looked_at() {
    let bench = Bench::new();
    bench.save("a.png", &patchwork(300, 200));
    let whole = bench.bytes("a.png");
    std::fs::write(bench.path("b.png"), &whole[..whole.len() / 2]).unwrap();
    let output = bench.run(&["info", "b.png"]);
    assert_eq!(output.status.code(), Some(1));
    let told = text(&output.stdout);
    assert_says(&told, &["300", "its pixels cannot be read", "damaged: b.png: damaged or truncated PNG"]);
    assert!(!told.contains("no circle"), "{told}");
    let message = bench.fail(1, &[&["convert", "b.png", "c.png"], &TO[..]].concat());
    assert_says(&message, &["b.png: damaged or truncated PNG"]);
}

#[test]
fn oval_maps_are_no_panoramas() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 256, 128));
    for name in ["hammer", "mollweide", "sinusoidal"] {
        for (file, background) in [("map.png", "white"), ("map.jpg", "black"), ("clear.png", "transparent")] {
            let to = ["--to", name, "--size", "320x160", "--background", background, "-y"];
            bench.succeed(&[&["convert", "sky.png", file, "--from", "equirect"], &to[..]].concat());
            refused(&bench, file, &["around an oval", "--from hammer, mollweide or sinusoidal", "--from equirect"]);
            assert_eq!(
                info(&bench, file),
                "hammer, mollweide or sinusoidal (2:1, one colour around an oval), or equirect"
            );
        }
    }
    // A panorama with a white sky, and ground as white.
    let light = Image::from_fn(320, 160, |i, j| {
        let is_land = (60..100).contains(&j);
        if is_land { Rgba::opaque(0.2, 0.003 * i as f32, 0.1) } else { Rgba::opaque(1.0, 1.0, 1.0) }
    });
    bench.save("snow.png", &EncodedImage::encode(&light, Channels::Rgb, Depth::Eight, &Transfer::Srgb));
    assert!(info(&bench, "snow.png").starts_with("equirect (2:1)"));
}

#[test]
fn a_square_that_tells_nothing_is_asked_about_once() {
    let bench = Bench::new();
    bench.save("square.png", &crate::bench::picture(1, 64, 64));
    let message = bench.fail(1, &["convert", "square.png", "out.png", "--to", "equirect"]);
    assert_eq!(message.matches("{face}").count(), 1, "{message}");
    let ball = "mirror-ball (with center= and radius= unless the ball touches the borders)";
    assert_says(&message, &[ball, "angular-map"]);
    assert_says(&bench.succeed(&["info", "square.png"]), &[ball, "a face of a cube (a pattern with {face})"]);
}

#[test]
fn a_folder_of_faces_is_called_one_with_its_pattern() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("u")).unwrap();
    std::fs::create_dir(bench.path("v")).unwrap();
    bench.faces("u/", 16);
    bench.faces("v/sky_", 16);
    assert_says(&bench.fail(2, &["info", "u"]), &["u is a folder", "write u/{face}.png"]);
    assert_says(&bench.fail(2, &["info", "v"]), &["v is a folder", "write v/sky_{face}.png"]);
    let message = bench.fail(2, &["convert", "v", "out.png", "--to", "equirect"]);
    assert_says(&message, &["write v/sky_{face}.png"]);
}

#[test]
fn sheets_of_faces_are_found_by_info_and_convert_alike() {
    let bench = Bench::new();
    for spec in ["cube:layout=3x2", "cube:layout=2x3", "cube:layout=eac"] {
        bench.succeed(&["convert", "builtin:demo", "sheet.png", "-y", "--to", spec, "--size", "96"]);
        let why = "(by its shape, and because the borders of its faces meet)";
        assert_eq!(info(&bench, "sheet.png"), format!("{spec} {why}"));
        found(&bench, "sheet.png", spec, &format!("the faces of a cube (--from {spec})"));
        assert_says(&bench.succeed(&["explain", "sheet.png", "--to", "fulldome", "--size", "64"]), &["front"]);
    }
    // Faces in another order may be a photograph: an error with the candidates, and with what the borders tell.
    let to = ["--to", "cube:layout=3x2,order=fudlrb", "--size", "96"];
    bench.succeed(&[&["convert", "builtin:demo", "sheet.png", "-y"], &to[..]].concat());
    refused(
        &bench,
        "sheet.png",
        &["give --from cube:layout=3x2, cube:layout=eac", "would meet by --from cube:layout=3x2,"],
    );
}

#[test]
fn a_circle_elsewhere_than_a_lens_is_taken_to_have_it_is_told() {
    let bench = Bench::new();
    bench.save("world.png", &patchwork(512, 256));
    let warned = |name: &str, from: &str| {
        let rest = ["--from", from, "--to", "fulldome", "--size", "32", "--missing", "black", "-y"];
        let output = bench.run(&[&["convert", name, "out.png"], &rest[..]].concat());
        let message = text(&output.stderr);
        assert!(output.status.success(), "{message}");
        message.lines().find(|line| line.contains("another circle")).map(str::to_owned)
    };
    let make = |name: &str, size: &str, circle: &str| {
        let to = format!("fisheye:fov=180{circle}");
        bench.succeed(&["convert", "world.png", name, "--from", "equirect", "--to", &to, "--size", size]);
    };
    // A picture of more than a thousand columns is looked at coarsely.
    for (name, size, circle) in [
        ("small.png", "400x300", "center=190:160,radius=120"),
        ("large.png", "2400x1800", "center=1130:930,radius=700"),
        ("clear.png", "400x300", "center=200:150,radius=146"),
    ] {
        make(name, size, &format!(",{circle}"));
        let told = warned(name, "fisheye:yaw=20").unwrap();
        let numbers = |spec: &str| -> Vec<f64> {
            let numbers = spec.split(|c: char| !c.is_ascii_digit() && c != '.');
            numbers.filter_map(|number| number.parse().ok()).take(3).collect()
        };
        let (_, advised) = told.split_once("give --from fisheye:").unwrap();
        for (advised, made) in numbers(advised).into_iter().zip(numbers(circle)) {
            assert!((advised - made).abs() <= 1.5, "{name}: {told}");
        }
        assert!(told.ends_with("yaw=20"), "{told}");
        assert_eq!(warned(name, &format!("fisheye:{circle}")), None);
        assert_eq!(warned(name, "perspective"), None);
    }
    assert!(warned("small.png", "mirror-ball").unwrap().contains("give --from mirror-ball:center="));
    make("filling.png", "400x300", "");
    assert_eq!(warned("filling.png", "fisheye"), None);
    assert_eq!(warned("world.png", "fisheye"), None);
}

#[test]
fn a_damaged_file_is_called_so_before_what_it_seems_to_lack() {
    let bench = Bench::new();
    bench.save("a.png", &patchwork(300, 200));
    let whole = bench.bytes("a.png");
    std::fs::write(bench.path("b.png"), &whole[..whole.len() / 2]).unwrap();
    for (verb, from, lacks) in [
        (&["convert", "NAME", "c.png"][..], "fisheye", "does not cover"),
        (&["convert", "NAME", "c.png"], "equirect", "are no panorama"),
        (&["explain", "NAME"], "equirect", "are no panorama"),
    ] {
        let message = |name: &str| {
            let verb = verb.iter().map(|word| if *word == "NAME" { name } else { word });
            let result =
                bench.run(&verb.chain(["--from", from, "--to", "equirect", "--size", "64"]).collect::<Vec<_>>());
            assert_ne!(result.status.code(), Some(0), "{name} {from}");
            text(&result.stderr)
        };
        assert_says(&message("a.png"), &[lacks]);
        assert_says(&message("b.png"), &["b.png: damaged or truncated PNG"]);
        assert!(!message("b.png").contains(lacks), "{from}");
    }
    let told = text(&bench.run(&["info", "b.png"]).stdout);
    let place = |words: &str| told.find(words).unwrap();
    assert!(place("damaged: b.png") < place("format: ") && place("format: ") < place("projection: "), "{told}");
}

#[test]
fn a_single_pixel_is_a_note() {
    let bench = Bench::new();
    bench.save("dot.png", &crate::bench::flat(1, 1, &[90, 120, 200]));
    let args = ["convert", "dot.png", "out.png", "--from", "equirect", "--to", "fulldome", "--size", "16", "-y"];
    assert!(!text(&bench.run(&args).stderr).contains("single pixel"));
    let told = text(&bench.run(&[&args[..], &["-v"]].concat()).stderr);
    assert_says(&told, &["note: dot.png is a single pixel: the same light is assumed in all directions"]);
}
