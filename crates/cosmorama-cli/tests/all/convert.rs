//! What a conversion promises: geometry, faces, files.

use crate::bench::{Bench, eight_bits, flat, floats, picture, word};
use cosmorama::camera::{CameraModel, CubeFaceCamera, PixelPoint};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};
use cosmorama::sphere::{CubeFace, Direction};
use serde_json::Value;

/// Cube faces whose colour is their direction, from −1…1 to 0…1.
fn direction_faces(bench: &Bench, size: usize) {
    let view = CameraModel::CubeFace(CubeFaceCamera).view(size, size).unwrap();
    for face in CubeFace::ALL {
        let image = floats(size, size, |i, j| {
            let direction = face.orientation().to_world(view.direction(PixelPoint::centre(i, j)).unwrap());
            direction.vector().to_array().map(|c| (c / 2.0 + 0.5) as f32)
        });
        bench.save(&format!("world_{}.exr", word(face)), &image);
    }
}

/// What the middle of an image sees of the world of directions.
fn middle(bench: &Bench, name: &str) -> Direction {
    let image = bench.load(name).to_light(&Transfer::Linear);
    let pixel = image.get(image.width() / 2, image.height() / 2).0;
    Direction::new([0, 1, 2].map(|c| f64::from(pixel[c]) * 2.0 - 1.0).into()).unwrap()
}

#[test]
fn the_output_looks_where_it_is_turned() {
    let bench = Bench::new();
    direction_faces(&bench, 32);
    let looks = |args: &[&str], expected: Direction| {
        let mut all = vec!["convert", "world_{face}.exr", "view.exr", "-y", "--size", "33x33"];
        all.extend(args);
        bench.succeed(&all);
        let seen = middle(&bench, "view.exr");
        assert!(seen.angle_to(expected).degrees() < 0.05, "{args:?} sees {seen:?}, not {expected:?}");
    };
    let camera = "perspective:fov=20";
    looks(&["--to", camera], Direction::FRONT);
    looks(&["--to", camera, "--yaw", "90"], Direction::RIGHT);
    looks(&["--to", camera, "--yaw", "-90"], Direction::LEFT);
    looks(&["--to", camera, "--pitch", "90"], Direction::UP);
    looks(&["--to", camera, "--yaw", "180", "--roll", "77"], Direction::BACK);
    looks(&["--to", "perspective:fov=20,pitch=-90"], Direction::DOWN);
    looks(&["--to", "fulldome"], Direction::UP);
    looks(&["--to", "fulldome:tilt=90"], Direction::FRONT);
    looks(&["--to", "fisheye", "--yaw", "90"], Direction::RIGHT);
    looks(&["--to", "omnimax:framing=circle,axis=90"], Direction::UP);
    looks(&["--to", "equirect", "--yaw", "180"], Direction::BACK);
    // The input may be turned, too: what was ahead of it is then to the right.
    looks(&["--from", "cube:yaw=90", "--to", camera, "--yaw", "90"], Direction::FRONT);
}

#[test]
fn there_and_back() {
    let bench = Bench::new();
    direction_faces(&bench, 64);
    bench.succeed(&["convert", "world_{face}.exr", "sky.exr", "--to", "equirect"]);
    bench.succeed(&["convert", "sky.exr", "back_{face}.exr", "--size", "64"]);
    for face in CubeFace::ALL {
        let first = format!("world_{}.exr", word(face));
        let again = format!("back_{}.exr", word(face));
        bench.succeed(&["compare", &again, &first, "--min-psnr", "60", "--max-shift", "0.03"]);
    }
    bench.succeed(&["convert", "sky.exr", "dome.exr", "--to", "fulldome"]);
    bench.succeed(&[
        "convert",
        "dome.exr",
        "up.exr",
        "--from",
        "fulldome",
        "--to",
        "perspective",
        "--size",
        "64x64",
        "--pitch",
        "90",
    ]);
    bench.succeed(&["compare", "up.exr", "world_top.exr", "--min-psnr", "55"]);
}

/// Blender, Nuke, Mitsuba and Unreal take the samples of a panorama to lie at pixel centres, and know no `envmap`.
#[test]
fn panoramas_in_openexr_have_pixel_centres_unless_edges_are_asked_for() {
    let bench = Bench::new();
    direction_faces(&bench, 32);
    let convert = |output: &str, spec: &str| {
        bench.succeed(&["convert", "world_{face}.exr", output, "--to", spec, "--size", "64"]);
        let info = bench.succeed(&["info", output, "--json"]);
        let info: Value = serde_json::from_str(&info).unwrap();
        (info["envmap"].clone(), info["projection"].as_str().unwrap().to_owned())
    };
    let (envmap, projection) = convert("sky.exr", "equirect");
    assert_eq!(
        (envmap, &projection[..]),
        (Value::Null, "equirect (2:1), samples at pixel centres (no envmap attribute)")
    );
    let (envmap, projection) = convert("edges.exr", "equirect:samples=edges");
    assert_eq!((envmap, &projection[..]), ("latlong".into(), "equirect, samples on the edges (envmap attribute)"));
    // The first sample is half a pixel inside, or else at the pole and the seam.
    let pixels = |name: &str| bench.load(name).to_light(&Transfer::Linear);
    let (centres, edges) = (pixels("sky.exr"), pixels("edges.exr"));
    let looks_at = |x: usize, y: usize| {
        let longitude = (x as f64 + 0.5) / 64.0 * std::f64::consts::TAU;
        let latitude = (0.5 - (y as f64 + 0.5) / 32.0) * std::f64::consts::PI;
        // The left border looks back, +Z; a quarter of the width on is the left, -X.
        [-longitude.sin() * latitude.cos(), latitude.sin(), longitude.cos() * latitude.cos()]
    };
    for (x, y) in [(0, 0), (0, 16), (7, 5), (40, 20), (63, 31)] {
        for (channel, expected) in looks_at(x, y).into_iter().enumerate() {
            let found = f64::from(centres.get(x, y).0[channel]) * 2.0 - 1.0;
            assert!((found - expected).abs() < 5e-3, "{x},{y}: {found} instead of {expected}");
        }
    }
    for c in 0..3 {
        assert!((edges.get(0, 16).0[c] - edges.get(63, 16).0[c]).abs() < 1e-3);
        assert!((edges.get(5, 0).0[c] - edges.get(40, 0).0[c]).abs() < 5e-3);
    }
    // Each is read by its own rule.
    for name in ["sky.exr", "edges.exr"] {
        let view = ["--to", "perspective:fov=60", "--size", "64", "--yaw", "120"];
        bench.succeed(&[&["convert", name, "view.exr", "-y"][..], &view].concat());
        bench.succeed(&[&["convert", "world_{face}.exr", "truth.exr", "-y"][..], &view].concat());
        // By the other's rule it would be 32 dB.
        bench.succeed(&["compare", "view.exr", "truth.exr", "--min-psnr", "55"]);
    }
}

#[test]
fn what_is_not_needed_does_not_leak_in() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    bench.succeed(&["convert", "face_{face}.png", "clean.png", "--to", "omnimax"]);
    // The far halves of the sides and of the top, the back and the bottom may hold anything.
    let spoil = |face: CubeFace, needed: &dyn Fn(usize, usize) -> bool| {
        let name = format!("face_{}.png", word(face));
        let image = bench.load(&name);
        let mut samples = eight_bits(&image).to_vec();
        for (index, sample) in samples.iter_mut().enumerate() {
            if !needed(index / 3 % 64, index / 3 / 64) {
                *sample = 255 - *sample;
            }
        }
        let spoilt = EncodedImage::new(64, 64, Channels::Rgb, Depth::Eight, Samples::U8(samples)).unwrap();
        bench.save(&name, &spoilt);
    };
    spoil(CubeFace::Right, &|i, _| i < 36);
    spoil(CubeFace::Left, &|i, _| i >= 28);
    spoil(CubeFace::Up, &|_, j| j >= 28);
    spoil(CubeFace::Back, &|_, _| false);
    bench.succeed(&["convert", "face_{face}.png", "spoilt.png", "--to", "omnimax"]);
    assert!(bench.bytes("clean.png") == bench.bytes("spoilt.png"));
}

#[test]
fn cropped_faces_are_as_good_as_whole_ones() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    bench.succeed(&["convert", "face_{face}.png", "whole.png", "--to", "omnimax"]);
    let image = bench.load("face_left.png");
    let rows = eight_bits(&image).chunks(64 * 3).flat_map(|row| row[24 * 3..].to_vec()).collect();
    let crop = EncodedImage::new(40, 64, Channels::Rgb, Depth::Eight, Samples::U8(rows)).unwrap();
    bench.save("face_left.png", &crop);
    let from = ["--from", "cube:canvas.left=64x64+24+0"];
    bench.succeed(&[&["convert", "face_{face}.png", "cropped.png", "--to", "omnimax"][..], &from].concat());
    assert!(bench.bytes("whole.png") == bench.bytes("cropped.png"));
}

#[test]
fn faces_of_different_sizes_and_shapes() {
    let bench = Bench::new();
    for (face, size) in CubeFace::ALL.into_iter().zip([96, 64, 16, 64, 48, 16]) {
        bench.save(&format!("face_{face}.png"), &flat(size, size, &[200, 100, 50]));
        bench.save(&format!("wide_{face}.png"), &flat(64, 60, &[200, 100, 50]));
        bench.save(&format!("mixed_{face}.png"), &flat(size, size * 15 / 16, &[200, 100, 50]));
    }
    bench.save("mixed_front.png", &flat(64, 64, &[200, 100, 50]));
    for input in ["face_{face}.png", "wide_{face}.png", "mixed_{face}.png"] {
        bench.succeed(&["convert", input, "out.png", "--to", "fisheye:fov=360", "--size", "64", "-y"]);
        let out = bench.load("out.png");
        let inside = |index: usize| {
            let (x, y) = ((index % 64) as f64 - 31.5, (index / 64) as f64 - 31.5);
            x.hypot(y) < 30.0
        };
        let pixels = eight_bits(&out).chunks(3).enumerate().filter(|(index, _)| inside(*index));
        assert!(pixels.into_iter().all(|(_, pixel)| pixel == [200, 100, 50]), "{input}");
    }
}

#[test]
fn a_face_spans_ninety_degrees_whatever_its_pixels() {
    let bench = Bench::new();
    direction_faces(&bench, 64);
    let camera = ["--to", "perspective:fov=40", "--size", "65x65", "--yaw", "45"];
    bench.succeed(&[&["convert", "world_{face}.exr", "square.exr"][..], &camera].concat());
    let view = CameraModel::CubeFace(CubeFaceCamera).view(64, 60).unwrap();
    bench.save(
        "world_right.exr",
        &floats(64, 60, |i, j| {
            let direction = view.direction(PixelPoint::centre(i, j)).unwrap();
            let direction = CubeFace::Right.orientation().to_world(direction);
            direction.vector().to_array().map(|c| (c / 2.0 + 0.5) as f32)
        }),
    );
    bench.succeed(&[&["convert", "world_{face}.exr", "mixed.exr"][..], &camera].concat());
    bench.succeed(&["compare", "mixed.exr", "square.exr", "--min-psnr", "80"]);
}

#[test]
fn cube_faces_are_written_as_others_name_them() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 128, 64));
    for folder in ["f", "t"] {
        std::fs::create_dir(bench.path(folder)).unwrap();
    }
    bench.succeed(&["convert", "sky.png", "%c/c_%c.png", "--to", "cube:naming=bourke,faces=front,up", "--size", "16"]);
    assert_eq!(bench.files().len(), 3);
    assert!(bench.path("f/c_f.png").exists() && bench.path("t/c_t.png").exists());
}

#[test]
fn a_panorama_may_begin_anywhere() {
    let bench = Bench::new();
    let sky = picture(1, 64, 32);
    bench.save("sky.png", &sky);
    // Its first column is the panorama's column 60, or, the other way round, 4 columns left of its first one.
    let codes = eight_bits(&sky);
    let rolled = codes.chunks(64 * 3).flat_map(|row| row[180..].iter().chain(&row[..180]).copied()).collect();
    bench.save("rolled.png", &EncodedImage::new(64, 32, Channels::Rgb, Depth::Eight, Samples::U8(rolled)).unwrap());
    let to = ["--to", "fisheye", "--size", "64", "--yaw", "60"];
    bench.succeed(&[&["convert", "sky.png", "a.png", "--from", "equirect"], &to[..]].concat());
    let from = "equirect:canvas=64x32+60+0";
    bench.succeed(&[&["convert", "rolled.png", "b.png", "--from", from], &to[..]].concat());
    bench.succeed(&["compare", "a.png", "b.png", "--min-psnr", "60"]);
    let from = "equirect:canvas=64x32+-4+0";
    bench.succeed(&[&["convert", "rolled.png", "c.png", "--from", from], &to[..]].concat());
    bench.succeed(&["compare", "a.png", "c.png", "--min-psnr", "60"]);
}

#[test]
fn faces_that_lie_turned_are_turned() {
    let bench = Bench::new();
    direction_faces(&bench, 32);
    let size = ["--size", "32", "--filter", "point"];
    bench.succeed(
        &[&["convert", "world_{face}.exr", "lux_{face}.exr", "--to", "cube:naming=envutil"], &size[..]].concat(),
    );
    let (upright, turned) = (bench.load("world_top.exr"), bench.load("lux_top.exr"));
    let [upright, turned] = [upright, turned].map(|image| image.to_light(&Transfer::Linear));
    for (i, j) in [(0, 0), (3, 30), (17, 5)] {
        let (here, there) = (upright.get(i, j).0, turned.get(31 - i, 31 - j).0);
        assert!(here.iter().zip(there).all(|(here, there)| (here - there).abs() < 1e-3), "{here:?} {there:?}");
    }
    let from = ["convert", "lux_{face}.exr", "back_{face}.exr", "--from", "cube:naming=envutil"];
    bench.succeed(&[&from[..], &size].concat());
    bench.succeed(&["compare", "back_top.exr", "world_top.exr", "--min-psnr", "60"]);
}

#[test]
fn letters_for_bourkes_mark() {
    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[10, 20, 30]));
    bench.succeed(&["convert", "sky.png", "v_%c.png", "--from", "equirect", "--to", "cube", "--size", "8"]);
    for letter in ["l", "f", "r", "b", "t", "d"] {
        assert!(bench.path(&format!("v_{letter}.png")).exists(), "{letter}");
    }
}
