//! Maps of a world's light: `light diffuse` and `light specular`.

use std::path::Path;

use cosmorama::raster::Depth;
use serde_json::Value;

use super::sky::{light, save_sky};
use crate::bench::{Bench, assert_says, text};

/// Largest and root mean square of relative errors.
fn errors(found: &[[f32; 3]], expected: &[u8]) -> (f64, f64) {
    let expected = expected.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()));
    let errors: Vec<f64> =
        found.iter().flatten().zip(expected).map(|(found, expected)| f64::from(*found) / expected - 1.0).collect();
    assert_eq!(errors.len(), 64 * 32 * 3);
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    (errors.iter().fold(0.0, |worst, error| worst.max(error.abs())), (squares / errors.len() as f64).sqrt())
}

#[test]
fn maps_match_brute_force_by_another_program() {
    let (Some(faces), Some(oracles)) = (testkit::shared("oracles/povray"), testkit::shared("oracles/reflection"))
    else {
        return;
    };
    let faces = faces.join("face_{face}.png").display().to_string();
    let bench = Bench::new();
    let diffuse = ["diffuse", "--normalise", "radiance"];
    let cases: [(&str, &[&str], f64, f64); 4] = [
        ("diffuse", &diffuse, 1e-3, 1e-4),
        ("diffuse", &["diffuse", "--normalise", "radiance", "--exact"], 1e-4, 2e-5),
        ("phong16", &["specular", "--lobe", "phong:16"], 1e-3, 5e-4),
        ("phong64", &["specular", "--lobe", "phong:64"], 1e-3, 5e-4),
    ];
    for (oracle, args, most, rms) in cases {
        let expected = std::fs::read(oracles.join(format!("{oracle}_64x32.f64"))).unwrap();
        let linear = ["--transfer", "linear", "--size", "64", "-y"];
        bench.succeed(&[&["light"], &args[..1], &[&faces, "map.exr"], &args[1..], &linear].concat());
        let found = errors(&light(&bench, "map.exr"), &expected);
        assert!(found.0 <= most && found.1 <= rms, "{args:?}: largest {:.2e}, rms {:.2e}", found.0, found.1);
    }
}

#[test]
fn real_skies_keep_their_energy() {
    let Some(folder) = testkit::shared("data/equirect_hdr") else { return };
    let bench = Bench::new();
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path().display().to_string();
        for map in [&["diffuse"][..], &["specular", "--alpha", "0.25", "--size", "128"]] {
            let report =
                bench.succeed(&[&["light"], &map[..1], &[&path, "map.exr", "-y", "--json"], &map[1..]].concat());
            let report: Value = serde_json::from_str(&report).unwrap();
            let energy = |key: &str, channel: usize| report["light"][0][key][channel].as_f64().unwrap();
            for channel in 0..3 {
                let kept = energy("energy_out", channel) / energy("energy_in", channel);
                assert!((kept - 1.0).abs() < 1e-3, "{path}, {map:?}: {kept}");
            }
        }
        count += 1;
    }
    assert!(count >= 10, "{count} skies");
}

#[test]
fn a_constant_world_gives_pi_or_one() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |_, _| [1.0, 2.0, 0.5]);
    let near = |name: &str, unit: f32| {
        for [red, green, blue] in light(&bench, name) {
            let is_near = |found: f32, expected: f32| (found / (unit * expected) - 1.0).abs() < 1e-6;
            assert!(is_near(red, 1.0) && is_near(green, 2.0) && is_near(blue, 0.5), "{name}: {red} {green} {blue}");
        }
    };
    bench.succeed(&["light", "diffuse", "sky.exr", "irradiance.exr"]);
    near("irradiance.exr", std::f32::consts::PI);
    let made = bench.load("irradiance.exr");
    assert_eq!((made.width(), made.height(), made.depth()), (64, 32, Depth::Float));
    bench.succeed(&["light", "diffuse", "sky.exr", "radiance.exr", "--normalise", "radiance", "--to", "mercator"]);
    near("radiance.exr", 1.0);
    bench.succeed(&["light", "specular", "sky.exr", "cube/{face}.exr", "--alpha", "0.3", "--size", "8"]);
    near("cube/front.exr", 1.0);
    near("cube/top.exr", 1.0);
    let report =
        bench.succeed(&["light", "specular", "sky.exr", "cloth.exr", "--lobe", "charlie", "--alpha", "0.5", "--json"]);
    near("cloth.exr", 1.0);
    let report: Value = serde_json::from_str(&report).unwrap();
    assert!((report["light"][0]["peak_out"].as_f64().unwrap() - 2.0).abs() < 1e-5, "{report}");
    assert_eq!(report["light"][0]["overflowed_samples"], 0);
}

#[test]
fn half_a_world_needs_to_be_told_what_is_missing() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 128, |_, _| [1.0; 3]);
    bench.succeed(&["convert", "sky.exr", "dome.exr", "--to", "fulldome", "--size", "128"]);
    let map = ["light", "diffuse", "dome.exr", "map.exr", "--from", "fulldome", "--normalise", "radiance"];
    assert_says(&bench.fail(1, &map), &["50.0 % of the sphere, around yaw", "pitch -90°", "--missing"]);
    bench.succeed(&[&map[..], &["--missing", "black"]].concat());
    let made = light(&bench, "map.exr");
    assert!((made[0][0] - 1.0).abs() < 0.01 && made[31 * 64][0] < 0.01, "{:?} {:?}", made[0], made[31 * 64]);
    bench.succeed(&[&map[..], &["--missing", "white", "-y"]].concat());
    assert!(light(&bench, "map.exr").iter().flatten().all(|light| (light - 1.0).abs() < 2e-3));
    bench.succeed(&[&map[..], &["--missing", "transparent", "-y"]].concat());
    assert!(bench.load("map.exr").channels().has_alpha());
}

#[test]
fn light_beyond_white_is_told_of() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| if (i, j) == (20, 10) { [2e8; 3] } else { [1.0; 3] });
    let output = bench.run(&["light", "diffuse", "sky.exr", "map.png"]);
    assert!(output.status.success());
    assert_says(&text(&output.stderr), &["samples are brighter than --depth 16 holds", "OpenEXR"]);
    let output = bench.run(&["light", "specular", "sky.exr", "map.exr", "--alpha", "0.05", "--depth", "half"]);
    assert_says(&text(&output.stderr), &["samples are brighter than --depth half holds"]);
    assert!(light(&bench, "map.exr").iter().flatten().all(|light| light.is_finite() && *light <= 65504.0));
}

#[test]
fn mistakes_are_answered() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 32, |_, _| [1.0; 3]);
    let fail = |args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(2, &[&["light", "specular", "sky.exr", "map.exr"], args].concat()), says);
    };
    fail(&[], &["--alpha is missing", "--alpha 0.25"]);
    fail(&["--alpha", "2"], &["a roughness α of 2 is outside 0.001 to 1"]);
    fail(&["--lobe", "phong"], &["phong needs an exponent, as in phong:64"]);
    fail(&["--lobe", "phong:16", "--alpha", "0.5"], &["--alpha is for ggx and charlie"]);
    fail(&["--lobe", "cone"], &["expected ggx, charlie, phong:N or blinn:N"]);
    assert_says(&bench.fail(2, &["light", "diffuse", "builtin:demo", "map.exr"]), &["is a formula"]);
    assert_says(&bench.fail(2, &["light", "diffuse", "sky.exr", "-"]), &["name one"]);
    assert!(!Path::new(&bench.path("map.exr")).exists());
}

/// A panorama in which light changes slowly.
fn save_smooth_sky(bench: &Bench) {
    save_sky(bench, "sky.exr", 128, |i, j| {
        let (x, y) = (i as f32 / 20.372, j as f32 / 20.372);
        [2.0 + x.sin() * y.sin(), 1.0 + 0.5 * y.cos(), 3.0 + (2.0 * x).cos() * y.sin() * y.sin()]
    });
}

#[test]
fn a_chain_goes_into_the_levels_of_a_texture() {
    let bench = Bench::new();
    save_smooth_sky(&bench);
    let chain = ["light", "specular", "sky.exr", "chain.ktx2", "--levels", "4", "--size", "32", "--json"];
    let report: Value = serde_json::from_str(&bench.succeed(&chain)).unwrap();
    let levels = report["light"].as_array().unwrap();
    let alphas: Vec<f64> = levels.iter().map(|level| level["alpha"].as_f64().unwrap()).collect();
    assert_eq!(alphas, [0.0, (1.0f64 / 3.0).powi(2), (2.0f64 / 3.0).powi(2), 1.0]);
    for (at, level) in levels.iter().enumerate() {
        assert_eq!(level["level"], at);
        for channel in 0..3 {
            let energy = |key: &str| level[key][channel].as_f64().unwrap();
            assert!((energy("energy_out") / energy("energy_in") - 1.0).abs() < 2e-3, "{level}");
        }
    }
    // KTX 2: the number of levels, and for each the place and the length of its texels.
    let bytes = bench.bytes("chain.ktx2");
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((word(20), word(36), word(40)), (32, 6, 4));
    let faces = ["light", "specular", "sky.exr", "{level}/{face}.exr", "--levels", "4", "--size", "32"];
    bench.succeed(&faces);
    for level in 0..4 {
        let (offset, length) = (word(80 + 24 * level), word(80 + 24 * level + 8));
        let edge = 32 >> level;
        assert_eq!(length, 6 * edge * edge * 8);
        let red = bytes[offset..offset + length].chunks_exact(8);
        let red = red.map(|texel| half::f16::from_le_bytes([texel[0], texel[1]]).to_f64());
        let found = red.sum::<f64>() / (6 * edge * edge) as f64;
        let of_face = |face: &str| {
            let light = light(&bench, &format!("{level}/{face}.exr"));
            assert_eq!(light.len(), edge * edge);
            light.iter().map(|light| f64::from(light[0])).sum::<f64>() / (edge * edge) as f64
        };
        let faces = ["front", "back", "left", "right", "top", "bottom"];
        let expected = faces.iter().map(|face| of_face(face)).sum::<f64>() / 6.0;
        assert!((found / expected - 1.0).abs() < 5e-4, "level {level}: {found}, {expected}");
    }
}

#[test]
fn levels_of_a_chain_are_maps_of_their_roughness() {
    let bench = Bench::new();
    save_smooth_sky(&bench);
    let chain = ["light", "specular", "sky.exr", "rough_{level}.exr", "--alpha", "0,0.1,0.5", "--size", "64"];
    bench.succeed(&chain);
    let mirror = ["convert", "sky.exr", "mirror.exr", "--to", "equirect", "--size", "64"];
    // Not balanced, as the kernel is without clamping.
    bench.succeed(&[&mirror[..], &["--kernel", "light", "--anti-ringing", "on"]].concat());
    bench.succeed(&["light", "specular", "sky.exr", "second.exr", "--alpha", "0.1", "--size", "32"]);
    bench.succeed(&["light", "specular", "sky.exr", "third.exr", "--alpha", "0.5", "--size", "16"]);
    for (level, other) in ["mirror.exr", "second.exr", "third.exr"].into_iter().enumerate() {
        let (found, expected) = (light(&bench, &format!("rough_{level}.exr")), light(&bench, other));
        assert_eq!(found.len(), 2048 >> (2 * level));
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found / expected - 1.0).abs() < 1e-4, "level {level}: {found}, {expected}");
        }
    }
    // The author's own: means of two by two.
    let plain =
        ["light", "specular", "sky.exr", "{level}/{face}.exr", "--method", "mipmap", "--levels", "3", "--size", "8"];
    bench.succeed(&plain);
    for level in [1, 2] {
        let [finer, made] = [level - 1, level].map(|level| light(&bench, &format!("{level}/left.exr")));
        let (edge, half) = (8 >> (level - 1), 8 >> level);
        assert_eq!(made.len(), half * half);
        for (k, pixel) in made.iter().enumerate() {
            let (i, j) = (2 * (k % half), 2 * (k / half));
            let of = |i: usize, j: usize| finer[j * edge + i][1];
            let mean = 0.25 * (of(i, j) + of(i + 1, j) + of(i, j + 1) + of(i + 1, j + 1));
            assert!((pixel[1] / mean - 1.0).abs() < 1e-6, "level {level}");
        }
    }
}

#[test]
fn mistakes_about_chains_are_answered() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 32, |_, _| [1.0; 3]);
    let fail = |args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(2, &[&["light", "specular", "sky.exr"], args].concat()), says);
    };
    fail(
        &["chain.hdr", "--levels", "5"],
        &["chain.hdr is Radiance HDR", "5 levels", ".ktx2, .dds or .exr", "chain_{level}.hdr"],
    );
    fail(&["chain.exr", "--levels", "5", "--to", "cube"], &["chain.exr", "down to one pixel", "{face}", ".ktx2"]);
    fail(&["chain.ktx2", "--levels", "5", "--size", "8"], &["--levels", "8x8 pixels have 4 at most", "--size"]);
    fail(&["chain.ktx2", "--levels", "0"], &["expected a number from 1 to 16"]);
    fail(&["chain.ktx2", "--levels", "3", "--alpha", "0,0.5"], &["--levels is 3, but --alpha has 2 values"]);
    fail(&["chain.ktx2", "--alpha", "0,1.5"], &["a roughness α of 1.5 is outside 0.001 to 1"]);
    fail(&["chain.ktx2", "--alpha", "-0.5"], &["a roughness α of -0.5 is outside 0.001 to 1"]);
    fail(&["chain.ktx2", "--roughness-map", "linear"], &["give the number of levels, as in --levels 5"]);
    fail(&["a_{level}.exr", "--levels", "4", "--roughness-map", "three"], &["the size of a cube's faces"]);
    fail(&["chain.ktx2", "--levels", "4", "--lobe", "phong:9"], &["--levels is for ggx and charlie"]);
    fail(&["chain.ktx2", "--method", "mipmap"], &["--levels 5"]);
    fail(&["chain.ktx2", "--method", "mipmap", "--levels", "3", "--alpha", "0.1"], &["knows no lobes"]);
    fail(&["chain.ktx2", "--levels", "3", "--roughness-map", "unity"], &["linear", "filament"]);
    let convert = ["convert", "sky.exr", "a_{level}.exr", "--to", "equirect"];
    assert_says(&bench.fail(2, &convert), &["{level} stands for nothing"]);
    assert!(!Path::new(&bench.path("chain.ktx2")).exists());
}

/// No half float is infinite, however bright the sun.
#[test]
fn a_chain_under_a_sun_is_finite() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| if (i, j) == (20, 10) { [250_000.0; 3] } else { [0.18; 3] });
    let output = bench.run(&["light", "specular", "sky.exr", "chain.ktx2", "--levels", "3", "--size", "64"]);
    assert!(output.status.success());
    assert_says(&text(&output.stderr), &["samples are brighter than --depth half holds"]);
    let bytes = bench.bytes("chain.ktx2");
    let first = u32::from_le_bytes(bytes[80 + 48..80 + 52].try_into().unwrap()) as usize;
    let halves = bytes[first..].chunks_exact(2).map(|bytes| half::f16::from_le_bytes([bytes[0], bytes[1]]));
    assert!(halves.into_iter().all(half::f16::is_finite));
}

/// Light that grows by the square of the frame's number.
#[test]
fn frames_between_computed_ones_are_interpolated() {
    let bench = Bench::new();
    for frame in 1..=8 {
        save_sky(&bench, &format!("sky_{frame:02}.exr"), 32, |_, _| [(frame * frame) as f32, 1.0, 0.5]);
    }
    let map = ["light", "diffuse", "sky_##.exr", "map_##.exr", "--size", "16", "--normalise", "radiance"];
    let args = [&map[..], &["--every", "3", "--every-error", "--json"]].concat();
    let report: Value = serde_json::from_str(&bench.succeed(&args)).unwrap();
    // Frames 1, 4, 7 and 8 are computed.
    for (frame, expected) in [(1, 1.0), (2, 6.0), (3, 11.0), (4, 16.0), (5, 27.0), (6, 38.0), (7, 49.0), (8, 64.0)] {
        for [red, green, blue] in light(&bench, &format!("map_{frame:02}.exr")) {
            assert!((red / expected - 1.0).abs() < 1e-5 && (green - 1.0).abs() < 1e-5 && (blue - 0.5).abs() < 1e-5);
        }
    }
    assert_eq!(report["frames"], 8);
    let told = report["interpolated"].as_array().unwrap();
    let frames: Vec<u64> = told.iter().map(|told| told["frame"].as_u64().unwrap()).collect();
    assert_eq!(frames, [2, 5]);
    // 6 for 4, beside a green of 1 and a blue of a half.
    assert!((told[0]["rms"].as_f64().unwrap() - 2.0 / 17.25f64.sqrt()).abs() < 1e-5, "{report}");
    assert!((told[0]["largest"].as_f64().unwrap() - 0.5).abs() < 1e-5, "{report}");
    let plain = bench.run(&[&map[..], &["--every", "3", "-y"]].concat());
    assert!(plain.status.success() && !text(&plain.stderr).contains("interpolated"));
    assert!((light(&bench, "map_06.exr")[0][0] - 38.0).abs() < 1e-3);
    assert_says(&bench.fail(2, &[&map[..], &["--every", "0", "-y"]].concat()), &["a number of frames, 1 at least"]);
    assert_says(&bench.fail(2, &[&map[..], &["--every-error", "-y"]].concat()), &["--every <N>"]);
    assert_says(&bench.fail(2, &[&map[..], &["--every", "3", "--resume"]].concat()), &["--resume"]);
}

/// Floats hold a sun that halves cut, and files say what their samples are.
#[test]
fn textures_hold_suns_in_floats_and_say_their_unit() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| if (i, j) == (20, 10) { [250_000.0; 3] } else { [0.18; 3] });
    for (name, format, most) in [("half.ktx2", 97, 65504.0), ("float.ktx2", 109, 1e30), ("float.dds", 0, 1e30)] {
        let depth: &[&str] = if name == "half.ktx2" { &[] } else { &["--depth", "float"] };
        let chain = ["light", "specular", "sky.exr", name, "--levels", "3", "--size", "64", "--json"];
        let report: Value = serde_json::from_str(&bench.succeed(&[&chain[..], depth].concat())).unwrap();
        let cut = report["light"][0]["overflowed_samples"].as_u64().unwrap();
        let peak = report["light"][0]["peak_out"].as_f64().unwrap();
        assert!(peak > 65504.0 && (cut > 0) == (peak > most), "{name}: {report}");
        let bytes = bench.bytes(name);
        if format > 0 {
            assert_eq!(u32::from_le_bytes(bytes[12..16].try_into().unwrap()), format, "{name}");
            assert!(bytes.windows(18).any(|key| key == b"lightUnit\0radiance"), "{name}");
        }
        // Read again, it has the peak that was told.
        bench.succeed(&["convert", name, "f_{face}.exr", "--to", "cube", "--filter", "point", "-y"]);
        let faces =
            ["front", "back", "left", "right", "top", "bottom"].map(|face| light(&bench, &format!("f_{face}.exr")));
        let read = faces.iter().flatten().flatten().fold(0.0f32, |most, light| most.max(*light));
        let expected = if depth.is_empty() { 65504.0 } else { peak };
        assert!((f64::from(read) / expected - 1.0).abs() < 1e-5, "{name}: {read}, {expected}");
    }
    bench.succeed(&["light", "diffuse", "sky.exr", "map.exr"]);
    assert!(bench.bytes("map.exr").windows(10).any(|text| text == b"irradiance"));
}

/// Half floats end at 65504. A stated scale keeps a sun within them; what is cut without one is counted.
#[test]
fn a_scale_keeps_suns_within_halves() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| if (i, j) == (20, 10) { [250_000.0; 3] } else { [0.18; 3] });
    let chain = ["light", "specular", "sky.exr", "a.ktx2", "--levels", "3", "--size", "64", "--json", "-y"];
    let run = |args: &[&str]| {
        let output = bench.run(&[&chain[..], args].concat());
        let report: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
        (report, text(&output.stderr))
    };
    let (plain, said) = run(&[]);
    assert_says(&said, &["a.ktx2", "brighter than --depth half holds", "--scale auto"]);
    assert_eq!(plain["light"][0]["scale"], 1.0);
    let (fitted, said) = run(&["--scale", "auto"]);
    let peak = plain["light"][0]["peak_out"].as_f64().unwrap();
    let scale = (65504.0 / peak).log2().floor().exp2();
    assert_says(&said, &[&format!("written times {scale}"), "lightScale"]);
    assert!(scale < 1.0 && bench.bytes("a.ktx2").windows(11).any(|key| key == b"lightScale\0"));
    for (level, plain) in fitted["light"].as_array().unwrap().iter().zip(plain["light"].as_array().unwrap()) {
        assert_eq!((&level["scale"], &level["overflowed_samples"]), (&scale.into(), &0.into()));
        let (found, expected) = (level["energy_out"][0].as_f64().unwrap(), plain["energy_out"][0].as_f64().unwrap());
        assert!((found / expected - 1.0).abs() < 1e-6, "figures are those of the light: {found}, {expected}");
    }
    // A factor of one's own, in a map of floats.
    bench.succeed(&["light", "diffuse", "sky.exr", "one.exr"]);
    bench.succeed(&["light", "diffuse", "sky.exr", "half.exr", "--scale", "0.5"]);
    let pairs = light(&bench, "one.exr").into_iter().zip(light(&bench, "half.exr"));
    assert!(pairs.into_iter().all(|(one, half)| one.map(|light| 0.5 * light) == half));
    // Integers end at 1; this irradiance is within halves.
    for (name, says) in
        [("a.tga", &["TGA has no place", "irradiance", "written times"][..]), ("a.dds", &["DDS has no place"])]
    {
        let args = ["light", "diffuse", "sky.exr", name, "--scale", "auto"];
        assert_says(&text(&bench.run(&args).stderr), says);
    }
    bench.succeed(&["light", "diffuse", "sky.exr", "a.jpg", "--scale", "auto"]);
    let comment =
        |bytes: &[u8]| bytes.windows(35).any(|bytes| bytes.starts_with(b"lightUnit: irradiance; lightScale: "));
    assert!(comment(&bench.bytes("a.jpg")));
    for frame in ["1", "2"] {
        std::fs::copy(bench.path("sky.exr"), bench.path(&format!("sky.000{frame}.exr"))).unwrap();
    }
    let frames = ["light", "diffuse", "sky.####.exr", "map.####.png", "--scale"];
    assert_says(&bench.fail(2, &[&frames[..], &["auto"]].concat()), &["--scale auto", "2 frames", "--scale 0.25"]);
    assert_says(&bench.fail(2, &[&frames[..], &["0"]].concat()), &["a factor more than 0"]);
}

/// The levels of an OpenEXR file are those of a chain in files of their own, and go down to one pixel.
#[test]
fn a_chain_is_in_the_mip_levels_of_openexr() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| [1.0 + (i % 7) as f32, j as f32, 3.0]);
    let chain = ["light", "specular", "sky.exr", "--json"];
    let run = |args: &[&str]| -> Value { serde_json::from_str(&bench.succeed(&[&chain[..], args].concat())).unwrap() };
    let three = ["--levels", "3", "--size", "64"];
    let (whole, apart) =
        (run(&[&["mips.exr"][..], &three[..]].concat()), run(&[&["level_{level}.exr"][..], &three[..]].concat()));
    let alphas = |report: &Value| -> Vec<f64> {
        report["light"].as_array().unwrap().iter().map(|level| level["alpha"].as_f64().unwrap()).collect()
    };
    assert_eq!(alphas(&whole), [&alphas(&apart)[..], &[1.0; 4]].concat());
    assert_eq!(whole["light"][1]["energy_out"], apart["light"][1]["energy_out"]);
    assert_eq!(light(&bench, "mips.exr"), light(&bench, "level_0.exr"));
    run(&["{face}.exr", "--levels", "2", "--size", "16"]);
    assert_eq!(bench.load("front.exr").width(), 16);
    if std::process::Command::new("oiiotool").arg("--help").output().is_ok() {
        let select = ["mips.exr", "--selectmip", "2", "-o", "two.exr"];
        let status = std::process::Command::new("oiiotool").current_dir(bench.path("")).args(select).status();
        assert!(status.unwrap().success());
        assert_eq!(light(&bench, "two.exr"), light(&bench, "level_2.exr"));
    }
}
