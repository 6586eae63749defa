//! Channels beside the picture's: light filtered, depth converted, normals turned, labels chosen.

use std::collections::BTreeSet;

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama_io::{
    Attribute, Choice, LayeredImage, Limits, Metadata, Plane, PlaneSamples, WriteOptions, open, read_layers,
    write_layers,
};

use crate::bench::{Bench, assert_says, floats, text, word};

/// Distance of the sphere that is seen.
const DISTANCE: f64 = 7.0;

fn plane(name: &str, numbers: impl IntoIterator<Item = f64>) -> Plane {
    Plane { name: name.to_owned(), samples: PlaneSamples::Float(numbers.into_iter().map(|x| x as f32).collect()) }
}

fn uints(name: &str, numbers: impl IntoIterator<Item = u32>) -> Plane {
    Plane { name: name.to_owned(), samples: PlaneSamples::Uint(numbers.into_iter().collect()) }
}

/// Writes channels, beside a grey picture unless it is to be without.
fn save(bench: &Bench, name: &str, size: (usize, usize), has_picture: bool, planes: Vec<Plane>) {
    let image = floats(size.0, size.1, |_, _| [0.5; 3]);
    let layered = LayeredImage { size, picture: has_picture.then_some(&image), names: Vec::new(), planes };
    write_layers(bench.path(name), layered, &WriteOptions::default()).unwrap();
}

fn planes(bench: &Bench, name: &str, channels: &[&str]) -> Vec<PlaneSamples> {
    let (path, choice) = (bench.path(name), Choice { without_picture: true, ..Choice::default() });
    let read = read_layers(open(&path).unwrap(), &path, &Limits::NONE, (&choice, channels)).unwrap();
    read.into_iter().map(|plane| plane.samples).collect()
}

fn numbers(bench: &Bench, name: &str, channel: &str) -> Vec<f64> {
    let PlaneSamples::Float(numbers) = planes(bench, name, &[channel]).remove(0) else { panic!("{channel}: floats") };
    numbers.into_iter().map(f64::from).collect()
}

/// Pixels of a face of 90°: right and up of each on the plane at the distance 1.
fn on_face(edge: usize) -> impl Iterator<Item = [f64; 2]> {
    let at = move |k: usize| 2.0 * (k as f64 + 0.5) / edge as f64 - 1.0;
    (0..edge * edge).map(move |k| [at(k % edge), -at(k / edge)])
}

/// Directions in the frame of a face, by its pixels: x to the right, y up, z to the viewer.
fn face_directions(edge: usize) -> Vec<[f64; 3]> {
    let unit = |[x, y]: [f64; 2]| [x, y, -1.0].map(|c| c / (1.0 + x * x + y * y).sqrt());
    on_face(edge).map(unit).collect()
}

/// Directions in the frame of a panorama, by its pixels.
fn panorama_directions(width: usize) -> Vec<[f64; 3]> {
    let height = width / 2;
    let direction = |k: usize| {
        let longitude = ((k % width) as f64 + 0.5) / width as f64 * std::f64::consts::TAU - std::f64::consts::PI;
        let latitude = (0.5 - ((k / width) as f64 + 0.5) / height as f64) * std::f64::consts::PI;
        [longitude.sin() * latitude.cos(), latitude.sin(), -longitude.cos() * latitude.cos()]
    };
    (0..width * height).map(direction).collect()
}

fn vector(names: &str, directions: &[[f64; 3]]) -> Vec<Plane> {
    let name = |axis: usize| format!("{names}.{}", ["X", "Y", "Z"][axis]);
    (0..3).map(|axis| plane(&name(axis), directions.iter().map(|d| d[axis]))).collect()
}

fn turned(orientation: Orientation, [x, y, z]: [f64; 3]) -> [f64; 3] {
    orientation.to_world(Direction::new([x, y, z].into()).unwrap()).vector().to_array()
}

#[test]
fn a_sphere_has_one_depth_in_a_panorama_and_comes_back_as_planes() {
    let bench = Bench::new();
    // Of the paper's cameras: a face and its plane at z.
    let planar: Vec<f64> = face_directions(48).iter().map(|d| DISTANCE * -d[2]).collect();
    for face in CubeFace::ALL {
        let name = format!("{}.exr", word(face));
        save(
            &bench,
            &name,
            (48, 48),
            true,
            vec![plane("Z", planar.iter().copied()), plane("other", vec![3.0; 48 * 48])],
        );
    }
    let pose = ["--yaw", "30", "--pitch", "-20", "--roll", "70"];
    let sky = ["convert", "{face}.exr", "sky.exr", "--to", "equirect", "--size", "96"];
    let output = bench.run(&[&sky[..], &pose[..]].concat());
    assert_says(
        &text(&output.stderr),
        &["Z: taken for planar depth", "written as radial depth", "--depth-kind radial"],
    );
    let depths = numbers(&bench, "sky.exr", "Z");
    assert!(depths.iter().all(|depth| (depth - DISTANCE).abs() < 1e-4 * DISTANCE), "{:?}", &depths[..4]);
    assert!(numbers(&bench, "sky.exr", "other").iter().all(|number| (number - 3.0).abs() < 1e-5), "no depth");

    bench.succeed(&["convert", "sky.exr", "back/{face}.exr", "--to", "cube", "--size", "40"]);
    let expected = face_directions(40).into_iter().map(|d| DISTANCE * -d[2]);
    for (depth, expected) in numbers(&bench, "back/top.exr", "Z").into_iter().zip(expected) {
        assert!((depth - expected).abs() < 1e-4 * expected, "{depth} {expected}");
    }
    // As distances from the camera they are what they are.
    let radial = ["convert", "{face}.exr", "dome.exr", "--to", "fisheye", "--size", "32", "--depth-kind", "radial"];
    let output = bench.run(&radial);
    assert_eq!(text(&output.stderr).matches("warning").count(), 0, "{}", text(&output.stderr));
    let depths = numbers(&bench, "dome.exr", "Z");
    assert!((depths[16 * 32 + 16] - DISTANCE).abs() < 0.02 && depths[0] == 0.0, "black outside of the lens");
    let told = bench.fail(2, &["convert", "sky.exr", "x.exr", "--to", "fisheye", "--depth-kind", "planar"]);
    assert_says(&told, &["--depth-kind planar", "is not flat"]);
}

#[test]
fn depth_without_a_picture_and_without_end() {
    let bench = Bench::new();
    let far = |k: usize| if k % 64 < 32 { f64::INFINITY } else { 5.0 };
    save(&bench, "depth.exr", (64, 32), false, vec![plane("Z", (0..64 * 32).map(far))]);
    bench.succeed(&["convert", "depth.exr", "out.exr", "--from", "equirect", "--to", "equirect", "--size", "50"]);
    let found: BTreeSet<u64> =
        numbers(&bench, "out.exr", "Z").iter().map(|x| (x * 1e3).round().min(1e9) as u64).collect();
    assert_eq!(found, BTreeSet::from([5000, 1_000_000_000]), "what has no end is not mixed with what has");
    let header = cosmorama_io::probe(bench.path("out.exr")).unwrap();
    assert_eq!(header.metadata.layers.picture, ["Z"], "no picture is made of it");
}

#[test]
fn normals_of_a_sphere_are_its_directions() {
    let bench = Bench::new();
    let pose = ["--yaw", "-50", "--pitch", "35", "--roll", "15"];
    let orientation = Orientation::from_yaw_pitch_roll(
        Angle::from_degrees(-50.0),
        Angle::from_degrees(35.0),
        Angle::from_degrees(15.0),
    );
    let close = |name: &str, expected: &[[f64; 3]]| {
        for (axis, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
            for (found, expected) in numbers(&bench, name, &format!("N.{letter}")).into_iter().zip(expected) {
                assert!((found - expected[axis]).abs() < 1e-3, "{name} {letter}: {found} {}", expected[axis]);
            }
        }
    };
    // Each face's own frame, and the output's.
    for face in CubeFace::ALL {
        save(&bench, &format!("{}.exr", word(face)), (64, 64), true, vector("N", &face_directions(64)));
    }
    let sky = ["convert", "{face}.exr", "sky.exr", "--to", "equirect", "--size", "96"];
    bench.succeed(&[&sky[..], &pose, &["--normals"]].concat());
    close("sky.exr", &panorama_directions(96));
    bench.succeed(&["convert", "sky.exr", "back/{face}.exr", "--to", "cube", "--size", "32", "--normals=camera"]);
    close("back/left.exr", &face_directions(32));

    // The world's frame: a panorama that looks elsewhere has the same normals by direction.
    save(&bench, "world.exr", (128, 64), true, vector("N", &panorama_directions(128)));
    bench.succeed(&[&["convert", "world.exr", "out.exr", "--to", "equirect", "--size", "64"], &pose[..]].concat());
    let expected: Vec<_> = panorama_directions(64).into_iter().map(|d| turned(orientation, d)).collect();
    close("out.exr", &expected);
}

#[test]
fn labels_are_taken_whole_and_belong_together() {
    let bench = Bench::new();
    let (width, count) = (64, 64 * 32);
    let cell = |k: usize| (k % width / 5 * 31 + k / width / 4 * 977) as u32;
    let planes_in = vec![
        uints("id", (0..count).map(|k| cell(k).wrapping_mul(2_654_435_761))),
        plane("cryptoObject00.R", (0..count).map(|k| f64::from(f32::from_bits(0x3f00_0000 ^ cell(k))))),
        plane("cryptoObject00.G", (0..count).map(|k| f64::from(cell(k)) / 1e4)),
    ];
    save(&bench, "ids.exr", (width, 32), true, planes_in);
    let tuples = |name: &str| -> BTreeSet<[u32; 2]> {
        let found = planes(&bench, name, &["cryptoObject00.R", "cryptoObject00.G"]);
        (0..found[0].len()).map(|k| [found[0].bits(k), found[1].bits(k)]).collect()
    };
    let ids = |name: &str| -> BTreeSet<u32> {
        let PlaneSamples::Uint(ids) = planes(&bench, name, &["id"]).remove(0) else { panic!("integers stay integers") };
        ids.into_iter().collect()
    };
    for rule in ["nearest", "vote"] {
        let to = ["convert", "ids.exr", "out.exr", "-y", "--to", "fulldome:tilt=20", "--size", "50", "--yaw", "33"];
        bench.succeed(&[&to[..], &["--labels", rule]].concat());
        assert!(ids("out.exr").len() > 20 && ids("out.exr").is_subset(&(&ids("ids.exr") | &BTreeSet::from([0]))));
        let background = BTreeSet::from([[0, 0]]);
        assert!(tuples("out.exr").len() > 20 && tuples("out.exr").is_subset(&(&tuples("ids.exr") | &background)));
    }
}

/// Planes of these names that stand for one thing at each pixel.
fn four(names: [&str; 4], number: impl Fn(usize, usize) -> f64) -> Vec<Plane> {
    let planes = names.into_iter().enumerate();
    planes.map(|(which, name)| plane(name, (0..64 * 32).map(|k| number(k, which)))).collect()
}

/// Writes channels without a picture, with attributes.
fn save_with(bench: &Bench, name: &str, planes: Vec<Plane>, attributes: Vec<Attribute>) {
    let metadata = Metadata { carried: std::sync::Arc::new(attributes.into()), ..Metadata::default() };
    let layered = LayeredImage { size: (64, 32), picture: None, names: Vec::new(), planes };
    write_layers(bench.path(name), layered, &WriteOptions::with_metadata(metadata)).unwrap();
}

/// The two ranks of a cryptomatte, known by its name or by its attribute.
#[test]
fn labels_alone_with_red_green_and_blue_are_no_picture() {
    let bench = Bench::new();
    let cell = |k: usize| (k % 64 / 5 * 31 + k / 64 / 4 * 977) as f64;
    let turned = ["--from", "equirect", "--to", "fulldome:tilt=20", "--size", "50", "--yaw", "33", "-y"];
    for matte in ["crypto_object", "UserObj"] {
        let names = |rank: &str| ["R", "G", "B", "A"].map(|letter| format!("{matte}{rank}.{letter}"));
        let (first, second) = (names("00"), names("01"));
        let ranks = |k: usize, which: usize| if which.is_multiple_of(2) { cell(k) * 7.0 + which as f64 } else { 0.5 };
        let deeper = |k: usize, which: usize| 1e4 - ranks(k / 3 * 3, which);
        let planes_in =
            [four(first.each_ref().map(|name| &**name), ranks), four(second.each_ref().map(|name| &**name), deeper)];
        let attribute = Attribute {
            name: "cryptomatte/abc1234/name".to_owned(),
            kind: "string".to_owned(),
            bytes: matte.as_bytes().to_vec(),
        };
        save_with(&bench, "in.exr", planes_in.concat(), vec![attribute]);
        assert!(bench.succeed(&["info", "in.exr"]).contains("R: float, labels"), "{matte}");
        let tuples = |name: &str| -> BTreeSet<[u32; 4]> {
            let channels = [&first[0], &first[2], &second[0], &second[2]].map(|name| &**name);
            let found = planes(&bench, name, &channels);
            (0..found[0].len()).map(|k| [0, 1, 2, 3].map(|channel| found[channel].bits(k))).collect()
        };
        let known = &tuples("in.exr") | &BTreeSet::from([[0; 4]]);
        let only = format!("{matte}*");
        for more in [&[][..], &["--labels", "vote"], &["--channels", &only]] {
            bench.succeed(&[&["convert", "in.exr", "out.exr"], &turned[..], more].concat());
            assert!(tuples("out.exr").len() > 20 && tuples("out.exr").is_subset(&known), "{matte} {more:?}");
        }
        let told = bench.fail(2, &[&["convert", "in.exr", "out.png"], &turned[..]].concat());
        assert_says(&told, &["PNG files hold light", "of in.exr holds labels; write OpenEXR"]);
    }
}

#[test]
fn normals_and_depth_with_red_green_and_blue_are_no_picture() {
    let bench = Bench::new();
    let sphere = panorama_directions(64);
    save_with(
        &bench,
        "n.exr",
        four(["normal.R", "normal.G", "normal.B", "normal.A"], |k, c| sphere[k].get(c).map_or(1.0, |x| *x)),
        Vec::new(),
    );
    bench.succeed(&[
        "convert",
        "n.exr",
        "out.exr",
        "--from",
        "equirect",
        "--to",
        "fisheye",
        "--size",
        "20",
        "--primaries",
        "rec709",
    ]);
    let axes = ["normal.R", "normal.G", "normal.B"].map(|axis| numbers(&bench, "out.exr", axis));
    let length = (0..3).map(|axis| axes[axis][10 * 20 + 10].powi(2)).sum::<f64>();
    assert!((length - 1.0).abs() < 1e-3, "{length}");
    let planar: Vec<f64> = face_directions(48).iter().map(|d| DISTANCE * -d[2]).collect();
    for face in CubeFace::ALL {
        let all = ["depth.R", "depth.G", "depth.B"].map(|name| plane(name, planar.iter().copied()));
        save(&bench, &format!("{}.exr", word(face)), (48, 48), false, all.into());
    }
    bench.succeed(&["convert", "{face}.exr", "sky.exr", "--to", "equirect", "--size", "96"]);
    assert!(numbers(&bench, "sky.exr", "depth.G").iter().all(|depth| (depth - DISTANCE).abs() < 1e-4 * DISTANCE));
    save(&bench, "z.exr", (64, 32), true, vec![plane("Z", vec![3.0; 64 * 32])]);
    let told =
        bench.fail(2, &["convert", "z.exr", "z.tif", "--from", "equirect", "--to", "equirect", "--channels", "Z"]);
    assert_says(&told, &["TIFF files hold light, but Z of z.exr holds depth"]);
    let told = bench.fail(2, &["light", "diffuse", "n.exr", "l.hdr"]);
    assert_says(&told, &["this needs light, but normal.R"]);
}

#[test]
fn depth_of_nothing_stays_what_it_was() {
    let bench = Bench::new();
    for nothing in [1e10, 1e30, 65504.0] {
        let far = |k: usize| if k % 64 < 32 { nothing } else { 5.0 };
        save(&bench, "depth.exr", (64, 32), false, vec![plane("Z", (0..64 * 32).map(far))]);
        for (to, size) in [("equirect", "50"), ("perspective:fov=90", "40")] {
            let words = ["convert", "depth.exr", "out.exr", "-y", "--from", "equirect", "--to", to, "--size", size];
            bench.succeed(&words);
            let is_one = |depth: &f64| (3.0..5.001).contains(depth) || (depth / nothing - 1.0).abs() < 1e-5;
            assert!(numbers(&bench, "out.exr", "Z").iter().all(is_one), "{nothing} {to}");
        }
    }
}

#[test]
fn channels_end_where_the_picture_ends() {
    let bench = Bench::new();
    let planes_in = ["diffuse.R", "diffuse.G", "diffuse.B", "Z"].map(|name| plane(name, vec![5.0; 64 * 64]));
    save(&bench, "front.exr", (64, 64), true, planes_in.into());
    let from = ["convert", "front.exr", "out.exr", "--from", "perspective:fov=90", "--to", "equirect", "--size", "128"];
    bench.succeed(&[&from[..], &["--missing", "transparent"]].concat());
    let alpha = numbers(&bench, "out.exr", "A");
    assert!(alpha.contains(&0.0) && alpha.contains(&1.0));
    for name in ["diffuse.R", "Z"] {
        let found = numbers(&bench, "out.exr", name);
        assert!(found.iter().zip(&alpha).all(|(number, alpha)| *alpha > 0.0 || *number == 0.0), "{name}");
    }
}

#[test]
fn layers_of_light_beside_a_grey_picture_get_the_output_s_primaries() {
    let bench = Bench::new();
    let grey = EncodedImage::new(64, 32, Channels::Grey, Depth::Float, Samples::Float(vec![0.5; 64 * 32])).unwrap();
    let metadata = Metadata { primaries: Some(cosmorama::raster::Primaries::AP1), ..Metadata::default() };
    for (name, image) in [("grey.exr", &grey), ("colour.exr", &floats(64, 32, |_, _| [0.5; 3]))] {
        let planes = [("d.R", 0.9), ("d.G", 0.1), ("d.B", 0.2)].map(|(name, value)| plane(name, vec![value; 64 * 32]));
        let layered = LayeredImage { size: (64, 32), picture: Some(image), names: Vec::new(), planes: planes.into() };
        write_layers(bench.path(name), layered, &WriteOptions::with_metadata(metadata.clone())).unwrap();
        let to = ["--from", "equirect", "--to", "equirect", "--size", "32", "--primaries", "rec709"];
        bench.succeed(&[&["convert", name, &format!("to_{name}")], &to[..]].concat());
    }
    let red = |name: &str| numbers(&bench, name, "d.R")[100];
    assert!((red("to_grey.exr") - red("to_colour.exr")).abs() < 1e-6 && red("to_grey.exr") > 1.0);
}

#[test]
fn a_channel_named_twice_is_refused() {
    let bench = Bench::new();
    save(&bench, "in.exr", (8, 4), true, vec![plane("Za", vec![1.0; 32]), plane("Zb", vec![2.0; 32])]);
    let mut bytes = bench.bytes("in.exr");
    let at = bytes.windows(3).position(|three| three == b"Zb\0").unwrap();
    bytes[at + 1] = b'a';
    std::fs::write(bench.path("in.exr"), bytes).unwrap();
    let told = bench.fail(1, &["convert", "in.exr", "out.exr", "--from", "equirect", "--to", "fisheye"]);
    assert_says(&told, &["in.exr", "two of its channels are called Za"]);
}

#[test]
fn layers_of_light_keep_names_types_and_constants() {
    let bench = Bench::new();
    let count = 64 * 32;
    // The picture is half transparent; a layer is not, and its own.
    let veil =
        Samples::Float((0..count * 4).map(|k| if k % 4 == 3 { (k / 4 % 64) as f32 / 64.0 } else { 0.1 }).collect());
    let image = EncodedImage::new(64, 32, Channels::Rgba, Depth::Float, veil).unwrap();
    let half = |name: &str, value: f32| Plane {
        name: name.to_owned(),
        samples: PlaneSamples::Half(vec![exr::prelude::f16::from_f32(value); count]),
    };
    let constant = [("diffuse.R", 0.25), ("diffuse.G", 0.5), ("diffuse.B", 40.0), ("diffuse.A", 1.0), ("mask", 2.0)];
    let planes_in: Vec<Plane> = constant.iter().map(|(name, value)| half(name, *value)).collect();
    let layered = LayeredImage { size: (64, 32), picture: Some(&image), names: Vec::new(), planes: planes_in };
    write_layers(bench.path("in.exr"), layered, &WriteOptions::default()).unwrap();

    let told = bench.succeed(&["info", "in.exr"]);
    assert_says(
        &told,
        &["picture: R, G, B, A", "diffuse:\n    A: half, numbers\n    B: half, light", "mask: half, numbers"],
    );
    bench.succeed(&["convert", "in.exr", "cube/{face}.exr", "--to", "cube", "--size", "30", "--yaw", "20"]);
    for (name, value) in constant {
        let found = planes(&bench, "cube/front.exr", &[name]).remove(0);
        assert!(matches!(found, PlaneSamples::Half(_)), "{name} stays half");
        assert!((0..found.len()).all(|k| (found.number(k) - value).abs() < 1e-3 * value), "{name}");
    }
    bench.succeed(&["convert", "cube/{face}.exr", "back.exr", "--to", "equirect", "--size", "64"]);
    let layers = |name: &str| cosmorama_io::probe(bench.path(name)).unwrap().metadata.layers;
    assert_eq!(layers("back.exr"), layers("in.exr"));

    // A layer as the picture, and alone.
    bench.succeed(&[
        "convert",
        "in.exr",
        "diffuse.exr",
        "--to",
        "fisheye",
        "--size",
        "20",
        "--channels",
        "diffuse.?,mask",
    ]);
    assert_eq!(layers("diffuse.exr").picture, ["diffuse.R", "diffuse.G", "diffuse.B", "diffuse.A"]);
    assert_eq!(layers("diffuse.exr").further.len(), 1);
    bench.succeed(&["convert", "in.exr", "mask.exr", "--to", "fisheye", "--size", "20", "--channels", "mask"]);
    assert_eq!(layers("mask.exr").picture, ["mask"]);
    let args = ["convert", "in.exr", "out.png", "--to", "fisheye", "--size", "20"];
    let output = bench.run(&args);
    let lost = "PNG files hold one picture: left out are the channels diffuse.A, diffuse.B, diffuse.G, diffuse.R, mask";
    assert_says(&text(&output.stderr), &[lost]);
}

/// What `convert` takes, `explain` takes.
#[test]
fn numbers_without_a_picture_are_explained() {
    let bench = Bench::new();
    save(&bench, "a.exr", (32, 16), false, vec![uints("id", 0..512), plane("N.X", vec![0.5; 512])]);
    let told = bench.succeed(&["explain", "a.exr", "--from", "equirect", "--to", "fulldome", "--size", "8"]);
    assert!(told.contains("32"), "{told}");
}

#[test]
fn one_picture_of_several_sample_types_is_told_of() {
    let bench = Bench::new();
    let half = PlaneSamples::Half(vec![half::f16::from_f32(0.25); 512]);
    let planes =
        vec![plane("B", vec![0.25; 512]), Plane { name: "G".to_owned(), samples: half }, plane("R", vec![0.25; 512])];
    save(&bench, "a.exr", (32, 16), false, planes);
    let words = ["-v", "convert", "a.exr", "b.exr", "--from", "equirect", "--to", "fulldome", "--size", "8"];
    let run = bench.run(&words);
    let told = text(&run.stderr);
    let lines: Vec<&str> = told.lines().filter(|line| line.contains("several sample types")).collect();
    assert!(lines.len() == 1 && lines[0].contains("R, G, B"), "{told}");
}

#[test]
fn what_is_not_there_is_told_with_what_is() {
    let bench = Bench::new();
    save(&bench, "in.exr", (8, 4), true, vec![plane("Z", vec![1.0; 32])]);
    bench.save("in.png", &crate::bench::flat(8, 4, &[1, 2, 3]));
    let refused = |args: &[&str], expected: &str| {
        let told = bench.fail(2, &[&["convert"], args, &["--to", "fisheye"]].concat());
        assert!(told.contains(expected), "{told}");
    };
    refused(&["in.exr", "out.exr", "--channels", "R,G,B,depth"], "no channel is called depth; there are B, G, R, Z");
    refused(&["in.exr", "out.exr", "--channels", "Z,R,Z"], "Z is named twice, by Z and by Z");
    refused(&["in.exr", "out.exr", "--part", "3"], "no part is called 3");
    refused(&["in.png", "out.exr", "--channels", "R"], "--channels is for OpenEXR files, but in.png is PNG");
    let output = bench.run(&["convert", "in.png", "out.exr", "--to", "fisheye", "--normals", "--depth-kind", "radial"]);
    assert_says(&text(&output.stderr), &["--normals has no effect", "--depth-kind has no effect"]);
}

#[test]
fn frames_have_channels_of_their_own_and_parts_are_told_of() {
    let bench = Bench::new();
    for frame in [1, 2] {
        let name = format!("in_{frame:04}.exr");
        save(&bench, &name, (32, 16), true, vec![plane("mask", vec![f64::from(frame); 512])]);
    }
    bench.succeed(&["convert", "in_####.exr", "out_####.exr", "--to", "equirect", "--size", "20", "--yaw", "90"]);
    for frame in [1, 2] {
        let found = numbers(&bench, &format!("out_{frame:04}.exr"), "mask");
        assert!(found.iter().all(|number| (number - f64::from(frame)).abs() < 1e-5));
    }
    let to = ["--to", "equirect", "--size", "20", "--yaw", "90", "--resume"];
    let again = [&["convert", "in_####.exr", "out_####.exr"], &to[..]].concat();
    assert_says(&text(&bench.run(&again).stderr), &["nothing to do"]);
    let fewer = bench.fail(1, &[&again[..], &["--channels", "R,G,B"]].concat());
    assert_says(&fewer, &["out_0001.exr was made with other colours, samples or layers"]);
    // Frames that say nothing of how they were made are judged by what is in them.
    bench.succeed(&[&["convert", "in_####.exr", "bare_####.exr", "--strip"], &to[..6]].concat());
    let bare = bench.run(&[&["convert", "in_####.exr", "bare_####.exr", "--channels", "R,G,B"], &to[..]].concat());
    assert_says(&text(&bare.stderr), &["other channels beside the picture's"]);
}
