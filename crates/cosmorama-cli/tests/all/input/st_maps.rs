//! St maps: written for other programs, which do with them what we do; read from them, both ways.

use std::process::Command;

use crate::bench::{Bench, assert_says, floats, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_io::{Limits, StPairs, WriteOptions, read_pairs, write_planes};

/// A panorama, a camera's view of it, and the map from the one to the other.
fn scene() -> Bench {
    let bench = Bench::new();
    let size = ["--size", "400x300"];
    bench.succeed(&["convert", "builtin:directions", "pano.exr", "--to", "equirect", "--size", "800"]);
    bench.succeed(&[&["convert", "pano.exr", "plate.exr", "--to", "fisheye:fov=150,fit=diagonal"][..], &size].concat());
    let straight = ["--from", "fisheye:fov=150,fit=diagonal", "--to", "perspective:fov=70"];
    bench.succeed(&[&["convert", "plate.exr", "direct.exr"][..], &straight, &size].concat());
    bench.succeed(&[&["convert", "plate.exr", "map.exr", "--st-map"][..], &straight, &size].concat());
    bench
}

fn close(bench: &Bench, found: &str, expected: &str, psnr: &str, shift: &str) {
    bench.succeed(&["compare", found, expected, "--min-psnr", psnr, "--max-shift", shift]);
}

fn pairs(bench: &Bench, name: &str) -> StPairs {
    read_pairs(bench.path(name), &Limits::default()).unwrap()
}

/// oiiotool, if it is installed.
fn oiiotool(bench: &Bench, arguments: &[&str]) -> bool {
    let Ok(output) = Command::new("oiiotool").current_dir(bench.path(".")).args(arguments).output() else {
        assert!(std::env::var_os("CI").is_none(), "oiiotool is not installed");
        eprintln!("SKIPPED: oiiotool is not installed");
        return false;
    };
    assert!(output.status.success(), "{}", text(&output.stderr));
    true
}

#[test]
fn oiiotool_does_our_conversion_by_our_map() {
    let bench = scene();
    // Its origin is at the top, unless it is told that the map comes from Nuke.
    let warp = ["plate.exr", "map.exr", "--st_warp:flip_t=1:filter=cubic", "-o", "theirs.exr"];
    if !oiiotool(&bench, &warp) {
        return;
    }
    close(&bench, "theirs.exr", "direct.exr", "70", "0.01");
}

#[test]
fn what_shows_nothing_is_outside_and_black_elsewhere() {
    let bench = scene();
    let dome = ["--to", "fulldome:fov=60", "--pitch", "-90", "--size", "64"];
    let from = ["--from", "fisheye:fov=150,fit=diagonal"];
    bench.succeed(&[&["convert", "plate.exr", "dome.exr", "--st-map"][..], &from, &dome].concat());
    let map = pairs(&bench, "dome.exr");
    assert_eq!(map.get(0, 0), [-1.0, -1.0]);
    let [s, t] = map.get(32, 32);
    assert!((s - 0.5).abs() < 0.01 && (t - 0.5).abs() < 0.01, "{s}, {t}");
    // T is up: the upper row of the picture looks at the upper half of the plate.
    assert!(map.get(32, 3)[1] > 0.6, "{:?}", map.get(32, 3));
    let coverage = bench.load("dome.exr").to_light(&cosmorama::raster::Transfer::Linear);
    assert_eq!((coverage.get(0, 0).0[2], coverage.get(32, 32).0[2]), (0.0, 1.0));
    // Maps come back: what looks nowhere is outside the picture.
    let back = ["--to", "st-map:file=dome.exr", "--missing", "transparent"];
    bench.succeed(&[&["convert", "plate.exr", "back.exr"][..], &from, &back].concat());
    let image = bench.load("back.exr").to_light(&cosmorama::raster::Transfer::Linear);
    assert_eq!((image.get(0, 0).alpha(), image.get(32, 32).alpha()), (0.0, 1.0));
    if oiiotool(&bench, &["plate.exr", "--resize", "64x64", "dome.exr", "--st_warp:flip_t=1", "-o", "black.exr"]) {
        assert_eq!(bench.load("black.exr").to_light(&cosmorama::raster::Transfer::Linear).get(0, 0).0[..3], [0.0; 3]);
    }
}

#[test]
fn a_map_is_applied_whichever_side_it_is_given_for() {
    let bench = scene();
    for (name, spec) in [("to.exr", "--to"), ("from.exr", "--from")] {
        bench.succeed(&["convert", "plate.exr", name, spec, "st-map:file=map.exr"]);
        let image = bench.load(name);
        assert_eq!((image.width(), image.height()), (400, 300), "as large as the map");
        close(&bench, name, "direct.exr", "75", "0.005");
    }
}

/// Maps of other programs hold two channels and are no pictures: they, too, say how large the output is to be.
#[test]
fn a_map_of_two_channels_alone_gives_the_size() {
    let bench = scene();
    let map = pairs(&bench, "map.exr");
    let plane = |c: usize| map.pairs.iter().map(|pair| pair[c]).collect::<Vec<f32>>();
    for (name, channels) in [("rg.exr", ["R", "G"]), ("uv.exr", ["u", "v"]), ("layer.exr", ["forward.u", "forward.v"])]
    {
        let planes = vec![(channels[0], plane(0)), (channels[1], plane(1))];
        let size = (map.width, map.height);
        write_planes(bench.path(name), size, planes, Depth::Float, &WriteOptions::default()).unwrap();
        bench.succeed(&["convert", "plate.exr", "out.exr", "--to", &format!("st-map:file={name}"), "-y"]);
        let image = bench.load("out.exr");
        assert_eq!((image.width(), image.height()), (400, 300), "{name}");
        close(&bench, "out.exr", "direct.exr", "75", "0.005");
    }
}

/// Outside a lens a map of ours says nothing, and so does the picture that it makes.
#[test]
fn a_map_of_a_lens_is_read_by_ourselves() {
    let bench = scene();
    let to = ["--to", "fisheye:fov=100", "--yaw", "20", "--size", "96"];
    bench.succeed(&[&["convert", "pano.exr", "lens-map.exr", "--st-map"], &to[..]].concat());
    bench.succeed(&[&["convert", "pano.exr", "lens.png", "--depth", "8"], &to[..]].concat());
    bench.succeed(&["convert", "pano.exr", "applied.png", "--depth", "8", "--from", "st-map:file=lens-map.exr"]);
    bench.succeed(&[
        "compare",
        "applied.png",
        "lens.png",
        "--region",
        "disc",
        "--min-psnr",
        "40",
        "--max-shift",
        "0.02",
    ]);
    let applied = bench.load("applied.png");
    assert_eq!(crate::bench::eight_bits(&applied)[..3], [0, 0, 0]);
}

#[test]
fn the_other_way_round_a_map_is_undone() {
    let bench = scene();
    // The part of the plate that the straight picture shows.
    for (name, spec) in [("to.exr", "--to"), ("from.exr", "--from")] {
        let convert =
            ["convert", "direct.exr", name, spec, "st-map:file=map.exr,invert=yes", "--missing", "transparent"];
        bench.succeed(&convert);
        let (back, plate) = (bench.load(name), bench.load("plate.exr"));
        let [back, plate] = [back, plate].map(|image| image.to_light(&cosmorama::raster::Transfer::Linear));
        let mut seen = 0;
        for (found, expected) in back.pixels().iter().zip(plate.pixels()).filter(|(found, _)| found.alpha() == 1.0) {
            seen += 1;
            let difference = (0..3).map(|c| (found.0[c] - expected.0[c]).abs()).fold(0.0, f32::max);
            assert!(difference < 2e-3, "{name}: {difference}");
        }
        assert!((20_000..100_000).contains(&seen), "{name}: {seen} pixels");
    }
}

#[test]
fn with_a_base_the_map_is_a_lens_of_the_world() {
    let bench = scene();
    let lens = "st-map:file=map.exr,base=perspective:fov=70";
    let view = ["--to", "perspective:fov=40", "--yaw", "8", "--pitch", "-5", "--size", "320x240"];
    bench.succeed(&[&["convert", "plate.exr", "a.exr", "--from", lens][..], &view].concat());
    let from = ["--from", "fisheye:fov=150,fit=diagonal"];
    bench.succeed(&[&["convert", "plate.exr", "b.exr"][..], &from, &view].concat());
    close(&bench, "a.exr", "b.exr", "70", "0.005");
    // A world file's views take maps from beside it.
    std::fs::create_dir(bench.path("shot")).unwrap();
    for name in ["plate.exr", "map.exr"] {
        std::fs::copy(bench.path(name), bench.path("shot").join(name)).unwrap();
    }
    let world = format!("[[view]]\nimage = \"plate.exr\"\nspec = \"{lens}\"\n");
    std::fs::write(bench.path("shot/world.toml"), world).unwrap();
    bench.succeed(&[&["convert", "shot/world.toml", "c.exr"][..], &view].concat());
    assert_eq!(bench.load("c.exr"), bench.load("a.exr"));
    // And as an output: the plate is made of the world.
    let lens = "st-map:file=map.exr,invert=yes,base=perspective:fov=70";
    let to = ["--to", lens, "--size", "400x300", "--missing", "transparent"];
    bench.succeed(&[&["convert", "pano.exr", "made.exr"][..], &to].concat());
    let (made, plate) = (bench.load("made.exr"), bench.load("plate.exr"));
    let [made, plate] = [made, plate].map(|image| *image.to_light(&cosmorama::raster::Transfer::Linear).get(200, 140));
    assert!((0..3).all(|c| (made.0[c] - plate.0[c]).abs() < 1e-3), "{made:?} is not {plate:?}");
}

#[test]
fn cubes_in_one_image_have_maps_too() {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:directions", "cube.exr", "--to", "cube:layout=3x2", "--size", "64"]);
    let from = ["--from", "cube:layout=3x2", "--to", "equirect", "--size", "64"];
    bench.succeed(&[&["convert", "cube.exr", "map.exr", "--st-map"][..], &from].concat());
    // The front is the second picture of the lower row.
    let [s, t] = pairs(&bench, "map.exr").get(32, 16);
    assert!((0.5..0.52).contains(&s) && (0.23..0.25).contains(&t), "{s}, {t}");
    bench.succeed(&["convert", "cube.exr", "{face}.exr", "--from", "cube:layout=3x2", "--size", "64"]);
    let files = ["convert", "{face}.exr", "no.exr", "--to", "equirect", "--size", "64", "--st-map"];
    assert_says(&bench.fail(1, &files), &["one image", "has 6", "layout=3x2"]);
}

#[test]
fn mistakes_are_told() {
    let bench = scene();
    bench.save("grey.exr", &floats(4, 4, |_, _| [0.0; 3]));
    let refused = |code: i32, args: &[&str], parts: &[&str]| {
        assert_says(&bench.fail(code, &[&["convert", "plate.exr", "o.exr"][..], args].concat()), parts);
    };
    refused(2, &["--to", "st-map"], &["file=", "st-map:file="]);
    refused(2, &["--to", "st-map:file=map.exr,invert=maybe"], &["invert=maybe", "yes, no"]);
    refused(1, &["--to", "st-map:file=none.exr"], &["none.exr"]);
    refused(1, &["--to", "st-map:file=grey.exr"], &["grey.exr", "4x4", "no four neighbouring"]);
    // The map takes one MiB, what is made of it several.
    let used = "st-map:file=map.exr,base=equirect";
    refused(1, &["--from", used, "--memory", "3MB"], &["an st map needs", "400x300", "--memory"]);
    let one = EncodedImage::new(2, 2, Channels::Grey, Depth::Float, Samples::Float(vec![0.5; 4])).unwrap();
    bench.save("one.exr", &one);
    refused(1, &["--to", "st-map:file=one.exr"], &["one.exr", "the channels Y", "R and G, u and v"]);
    refused(2, &["--from", "st-map:file=map.exr", "--to", "cube:layout=3x2"], &["--from", "base="]);
    let both = ["--from", "st-map:file=map.exr", "--to", "st-map:file=map.exr"];
    refused(2, &both, &["base="]);
    let png =
        ["convert", "plate.exr", "o.png", "--from", "fisheye", "--to", "equirect", "--st-map", "--missing", "black"];
    assert_says(&bench.fail(2, &png), &["--st-map", ".exr"]);
    let of_filter = [["--filter", "point"], ["--kernel", "box"], ["--anti-ringing", "off"]];
    let of_light = [["--transfer", "srgb"], ["--in-transfer", "pq"], ["--background", "red"]];
    for ignored in of_filter.into_iter().chain(of_light) {
        let given = ["convert", "plate.exr", "o.exr", "--from", "fisheye", "--to", "fisheye:fov=90", "--st-map"];
        assert_says(&bench.fail(2, &[&given[..], &ignored].concat()), &[ignored[0], "leave them out"]);
    }
    let coloured =
        ["convert", "plate.exr", "o.exr", "--from", "fisheye", "--to", "equirect", "--size", "32", "--st-map"];
    assert_says(&bench.fail(2, &[&coloured[..], &["--missing", "red"]].concat()), &["--missing", "no colours"]);
    // What looks like x and y are two parts of a direction.
    bench.succeed(&["convert", "builtin:direction-map", "way.exr", "--to", "fulldome", "--size", "16"]);
    refused(1, &["--from", "st-map:file=way.exr"], &["way.exr", "direction.Z", "R and G, u and v"]);
    let itself = ["convert", "plate.exr", "map.exr", "--to", "st-map:file=map.exr", "-y"];
    assert_says(&bench.fail(2, &itself), &["map.exr", "its own input"]);
    let formula = ["convert", "builtin:grid", "o.exr", "--to", "fulldome", "--size", "16", "--st-map"];
    assert_says(&bench.fail(2, &formula), &["--st-map", "formula"]);
}
