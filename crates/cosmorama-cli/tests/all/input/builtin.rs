//! Built-in worlds as inputs: every form of output, and what makes no sense.

use std::collections::BTreeMap;
use std::path::Path;

use crate::bench::{Bench, assert_says};
use cosmorama::camera::{CameraModel, FulldomeCamera, PixelPoint, Placement};
use cosmorama::raster::{Channels, Depth, Transfer};
use cosmorama::sphere::{Angle, Orientation};
use serde_json::Value;

#[test]
fn every_world_goes_into_every_form() {
    let bench = Bench::new();
    for world in ["grid", "checker", "directions", "zone-plate", "demo"] {
        let input = format!("builtin:{world}");
        let dome = format!("{world}.png");
        bench.succeed(&["convert", &input, &dome, "--to", "fulldome", "--size", "24"]);
        let image = bench.load(&dome);
        assert_eq!((image.width(), image.height(), image.channels()), (24, 24, Channels::Rgb));
        bench.succeed(&["convert", &input, &format!("{world}.exr"), "--to", "equirect", "--size", "32"]);
        bench.succeed(&["convert", &input, &format!("{world}_{{face}}.tif"), "--size", "8"]);
        assert_eq!(bench.load(&format!("{world}_top.tif")).width(), 8);
        let cross = format!("{world}-cross.jpg");
        bench.succeed(&["convert", &input, &cross, "--to", "cube:layout=cross-h", "--size", "8"]);
        assert_eq!(bench.load(&cross).width(), 32);
    }
}

#[test]
fn depth_transfer_and_background_are_those_asked_for() {
    let bench = Bench::new();
    let convert = |output: &str, more: &[&str]| {
        let mut args = vec!["convert", "builtin:directions", output, "--to", "fulldome", "--size", "33"];
        args.extend(more);
        bench.succeed(&args);
        bench.load(output)
    };
    // The zenith: x = 0, y = 1, z = 0.
    let zenith = [0.5, 1.0, 0.5];
    for (output, depth, transfer, more) in [
        ("a.png", Depth::Sixteen, Transfer::Srgb, ["--depth", "16"]),
        ("b.png", Depth::Eight, Transfer::Linear, ["--transfer", "linear"]),
        ("c.exr", Depth::Float, Transfer::Linear, ["--depth", "float"]),
        ("d.tif", Depth::Eight, Transfer::Srgb, ["--background", "transparent"]),
    ] {
        let image = convert(output, &more);
        assert_eq!(image.depth(), depth);
        let light = image.to_light(&transfer);
        let middle = light.get(16, 16).0;
        assert!((0..3).all(|c| (f64::from(middle[c]) - zenith[c]).abs() < 0.003), "{output}: {middle:?}");
        assert_eq!(light.get(0, 0).alpha() == 0.0, output == "d.tif");
    }
    let [red, green, blue, _] = convert("e.png", &["--background", "red"]).to_light(&Transfer::Srgb).get(0, 0).0;
    assert_eq!([red, green, blue], [1.0, 0.0, 0.0]);
}

#[test]
fn the_same_bytes_whatever_the_number_of_threads() {
    let bench = Bench::new();
    for (output, threads) in [("a.png", "1"), ("b.png", "3")] {
        bench.succeed(&["convert", "builtin:grid", output, "--to", "omnimax", "--size", "300", "--threads", threads]);
    }
    assert!(bench.bytes("a.png") == bench.bytes("b.png"));
}

#[test]
fn what_files_have_a_formula_has_not() {
    let bench = Bench::new();
    let refused = |args: &[&str], parts: &[&str]| {
        let mut all = vec!["convert"];
        all.extend(args);
        assert_says(&bench.fail(2, &all), parts);
    };
    let dome = ["--to", "fulldome", "--size", "16"];
    let with = |more: &[&'static str]| [&["builtin:grid", "a.png"][..], &dome, more].concat();
    refused(
        &["builtin:gird", "a.png", "--to", "fulldome", "--size", "16"],
        &["'gird'", "did you mean 'grid'?", "builtin:zone-plate"],
    );
    refused(&with(&["--from", "equirect"]), &["--from", "builtin:grid", "formula"]);
    refused(&with(&["--frames", "1-3"]), &["--frames"]);
    refused(&with(&["--in-transfer", "srgb"]), &["--in-transfer"]);
    refused(&with(&["--missing", "red"]), &["--missing", "in every direction"]);
    refused(&["builtin:grid", "a.png", "--to", "fulldome"], &["--size is missing"]);
    refused(&["builtin:grid", "a.png", "--size", "16"], &["--to is missing"]);
    refused(&["builtin:grid", "a_####.png", "--to", "fulldome", "--size", "16"], &["frame marker"]);
    assert_says(
        &bench.fail(2, &["explain", "builtin:grid", "--to", "fulldome", "--size", "16"]),
        &["nothing to explain"],
    );
    let existing = with(&[]);
    bench.succeed(&[&["convert"][..], &existing].concat());
    assert_says(&bench.fail(1, &[&["convert"][..], &existing].concat()), &["a.png exists"]);
    let resumed = bench.succeed(&[&["convert"][..], &existing, &["--resume", "--json"]].concat());
    let report: Value = serde_json::from_str(&resumed).unwrap();
    assert_eq!((&report["skipped"], &report["inputs"][0]), (&Value::from(1), &Value::from("builtin:grid")));
}

#[test]
fn maps_of_directions_hold_what_pixels_see() {
    let bench = Bench::new();
    let map = |output: &str, input: &str, more: &[&str]| {
        let to = ["--to", "fulldome", "--size", "41", "--yaw", "30"];
        bench.succeed(&[&["convert", input, output][..], &to, more].concat());
        channels(&bench.path(output))
    };
    let orientation = Orientation::from_yaw_pitch_roll(Angle::from_degrees(30.0), Angle::ZERO, Angle::ZERO);
    let upright = Placement::new(CameraModel::Fulldome(FulldomeCamera::default()));
    let view = Placement { orientation: upright.orientation.within(orientation), ..upright }.view(41, 41).unwrap();
    let names = ["direction.X", "direction.Y", "direction.Z", "dx.X", "dx.Y", "dx.Z", "dy.X", "dy.Y", "dy.Z"];
    let whole = map("whole.exr", "builtin:direction-map:footprint=yes", &[]);
    assert_eq!(whole.keys().map(String::as_str).collect::<Vec<_>>(), names);
    for (j, i) in (0..41).flat_map(|j| (0..41).map(move |i| (j, i))) {
        // The middle of each, also of those that the rim cuts.
        let middle = PixelPoint::centre(i, j);
        let expected = view.footprint(middle).filter(|_| view.shows(middle)).map_or([[0.0; 3]; 3], |seen| {
            [seen.direction.vector(), seen.jacobian.dx, seen.jacobian.dy].map(|vector| vector.to_array())
        });
        let expected = expected.into_iter().flatten();
        for (name, expected) in names.into_iter().zip(expected) {
            let found = f64::from(whole[name][j * 41 + i]);
            assert!((found - expected).abs() < 1e-6, "{name} at {i}, {j}: {found} is not {expected}");
        }
    }
    let bare = map("bare.exr", "builtin:direction-map", &["--depth", "half"]);
    assert_eq!(bare.keys().map(String::as_str).collect::<Vec<_>>(), names[..3]);
    // Cubes, in files of their own and in one.
    bench.succeed(&["convert", "builtin:direction-map", "map_{face}.exr", "--size", "9"]);
    let right = channels(&bench.path("map_right.exr"));
    assert!((right["direction.X"][40] - 1.0).abs() < 1e-6);
    bench.succeed(&["convert", "builtin:direction-map", "cross.exr", "--to", "cube:layout=cross-h", "--size", "9"]);
    assert_eq!(channels(&bench.path("cross.exr"))["direction.Y"].len(), 36 * 27);
}

/// The channels of an OpenEXR file, read by the library that others use, too.
fn channels(path: &Path) -> BTreeMap<String, Vec<f32>> {
    use exr::prelude::{ReadChannels, ReadLayers, read};
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.from_file(path).unwrap();
    let list = image.layer_data.channel_data.list;
    list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect())).collect()
}

#[test]
fn maps_of_directions_are_no_pictures() {
    let bench = Bench::new();
    let refused = |input: &str, output: &str, more: &[&str], parts: &[&str]| {
        let dome = ["--to", "fulldome", "--size", "16"];
        assert_says(&bench.fail(2, &[&["convert", input, output][..], &dome, more].concat()), parts);
    };
    refused("builtin:direction-map", "a.png", &[], &["PNG", ".exr"]);
    refused("builtin:direction-map", "a.exr", &["--depth", "16"], &["--depth 16"]);
    refused("builtin:direction-map", "a.exr", &["--background", "red"], &["--background"]);
    refused("builtin:direction-map", "a.exr", &["--transfer", "pq"], &["--transfer", "for light"]);
    refused("builtin:direction-map:footprint=maybe", "a.exr", &[], &["footprint=yes", "maybe"]);
    bench.succeed(&["convert", "builtin:direction-map", "map.exr", "--to", "fulldome", "--size", "16"]);
    assert_says(&bench.succeed(&["info", "map.exr"]), &["no picture", "direction.X"]);
    refused("builtin:grid:step=3", "a.exr", &[], &["no keys"]);
}

#[test]
fn info_says_what_a_world_shows() {
    let bench = Bench::new();
    assert_says(&bench.succeed(&["info", "builtin:grid"]), &["azimuth"]);
    assert_says(&bench.fail(2, &["info", "builtin:grids"]), &["did you mean 'grid'?"]);
}

/// Whichever size and projection, there are letters that can be read, or it is said that there are none.
#[test]
fn grids_have_letters_or_say_that_they_have_none() {
    let bench = Bench::new();
    for (to, size, has_letters) in [
        ("equirect", "1024", true),
        ("equirect", "300", true),
        ("fulldome", "512", true),
        ("fulldome", "150", true),
        ("fulldome", "90", false),
    ] {
        let output = bench.run(&["convert", "builtin:grid", "grid.png", "--to", to, "--size", size, "-y"]);
        let warning = crate::bench::text(&output.stderr);
        assert_eq!(!warning.contains("letters would be too small"), has_letters, "{to} {size}: {warning}");
        // Nothing but letters is white.
        let image = bench.load("grid.png");
        let white =
            crate::bench::eight_bits(&image).chunks_exact(3).filter(|pixel| pixel.iter().all(|code| *code > 230));
        assert_eq!(white.count() > 12, has_letters, "{to} {size}");
    }
    let output = bench.run(&["convert", "builtin:grid", "grid.png", "--to", "fulldome", "--size", "90", "-y"]);
    assert_says(&crate::bench::text(&output.stderr), &["grid.png", "90x90", "from a width of 113 on"]);
}
