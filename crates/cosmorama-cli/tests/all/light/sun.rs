//! Suns and lamps of a world: `light sun`.

use std::f64::consts::PI;

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use serde_json::Value;

use super::sky::{light, save_sky};
use crate::bench::{Bench, assert_says, text};

/// Grey with a sun of three by three texels and a lamp of one, in a panorama of 128×64.
fn save_two(bench: &Bench) {
    save_sky(bench, "sky.exr", 128, |i, j| match (i, j) {
        (79..=81, 19..=21) => [3000.0, 2000.0, 1000.0],
        (0, 40) => [800.0; 3],
        _ => [0.18 + 0.001 * j as f32; 3],
    });
}

/// Solid angle of a texel in row j of 64, of 128 columns.
fn angle(j: usize) -> f64 {
    let edge = |j: usize| (PI * j as f64 / 64.0).cos();
    2.0 * PI / 128.0 * (edge(j) - edge(j + 1))
}

fn report(bench: &Bench, args: &[&str]) -> Value {
    serde_json::from_str(&bench.succeed(&[&["light", "sun"], args, &["--json"]].concat())).unwrap()
}

#[test]
fn suns_are_found_with_their_light() {
    let bench = Bench::new();
    save_two(&bench);
    let found = report(&bench, &["sky.exr"]);
    let suns = found["suns"].as_array().unwrap();
    assert_eq!(suns.len(), 2, "{found}");
    let number = |k: usize, key: &str| suns[k][key].as_f64().unwrap();
    // The middle of texel (80, 20), as yaw and pitch.
    assert!((number(0, "yaw") - (80.5 / 128.0 * 360.0 - 180.0)).abs() < 0.05, "{found}");
    assert!((number(0, "pitch") - (90.0 - 20.5 / 64.0 * 180.0)).abs() < 0.05, "{found}");
    let expected = 3.0 * (angle(19) + angle(20) + angle(21));
    assert!((number(0, "solid_angle") / expected - 1.0).abs() < 1e-4, "{found}");
    assert!((suns[0]["irradiance"][0].as_f64().unwrap() / (expected * 2999.8) - 1.0).abs() < 1e-4, "{found}");
    assert!((suns[0]["radiance"][1].as_f64().unwrap() / 1999.8 - 1.0).abs() < 1e-4, "{found}");
    // The lamp stands on the seam.
    assert!((number(1, "yaw") + 178.59).abs() < 0.05 && (number(1, "solid_angle") / angle(40) - 1.0).abs() < 1e-4);
    // The part of the light, by colours together.
    let sum = |light: &Value| (0..3).map(|channel: usize| light[channel].as_f64().unwrap()).sum::<f64>();
    for (k, sun) in suns.iter().enumerate() {
        let share = sum(&sun["irradiance"]) / (4.0 * PI * sum(&found["energy_in"]));
        assert!((number(k, "share") - share).abs() < 1e-4, "{share}: {found}");
    }
    let told = bench.succeed(&["light", "sun", "sky.exr"]);
    assert_says(&told, &["1: yaw 46.4", "% of the light; irradiance", "2: yaw -178.59"]);
    save_sky(&bench, "grey.exr", 64, |_, _| [0.5; 3]);
    assert_says(&bench.succeed(&["light", "sun", "grey.exr"]), &["no suns or lamps"]);
}

/// What is taken out, and what is left, is what there was.
#[test]
fn light_is_kept_when_suns_are_taken_out() {
    let bench = Bench::new();
    save_two(&bench);
    let found = report(&bench, &["sky.exr", "--remove", "own/left.exr"]);
    let left = bench.load("own/left.exr");
    assert_eq!((left.width(), left.height(), left.depth()), (128, 64, Depth::Float));
    let pixels = light(&bench, "own/left.exr");
    for channel in 0..3 {
        let energy = |key: &str| found[key][channel].as_f64().unwrap();
        let suns = found["suns"].as_array().unwrap().iter();
        let taken: f64 = suns.map(|sun| sun["irradiance"][channel].as_f64().unwrap()).sum::<f64>() / (4.0 * PI);
        assert!(((energy("energy_out") + taken) / energy("energy_in") - 1.0).abs() < 1e-5, "{found}");
        let written: f64 =
            pixels.iter().enumerate().map(|(k, light)| f64::from(light[channel]) * angle(k / 128)).sum::<f64>()
                / (4.0 * PI);
        assert!((written / energy("energy_out") - 1.0).abs() < 1e-4, "{written}: {found}");
    }
    // The grey goes on.
    for (i, j) in [(79, 19), (80, 20), (81, 21), (0, 40)] {
        let expected = 0.18 + 0.001 * j as f32;
        assert!((pixels[j * 128 + i][1] - expected).abs() < 3e-3, "{i} {j}: {:?}", pixels[j * 128 + i]);
    }
    assert_eq!(report(&bench, &["own/left.exr"])["suns"].as_array().unwrap().len(), 0);
}

#[test]
fn real_suns_keep_their_light() {
    let Some(folder) = testkit::shared("data/equirect_hdr") else { return };
    let bench = Bench::new();
    let mut skies = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "hdr" && extension != "exr") {
            continue;
        }
        let found = report(&bench, &[&path.display().to_string(), "--remove", "left.exr", "-y"]);
        for channel in 0..3 {
            let energy = |key: &str| found[key][channel].as_f64().unwrap();
            let suns = found["suns"].as_array().unwrap().iter();
            let taken: f64 = suns.map(|sun| sun["irradiance"][channel].as_f64().unwrap()).sum::<f64>() / (4.0 * PI);
            let kept = (energy("energy_out") + taken) / energy("energy_in");
            assert!((kept - 1.0).abs() < 1e-3, "{}: {kept}", path.display());
        }
        assert!(found["peak_out"].as_f64() <= found["peak_in"].as_f64());
        skies += 1;
    }
    assert!(skies > 0);
}

#[test]
fn mistakes_about_suns_are_answered() {
    let bench = Bench::new();
    save_two(&bench);
    let fail = |code: i32, args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(code, &[&["light", "sun"], args].concat()), says);
    };
    fail(2, &["sky.exr", "--remove", "a.json"], &["a.json"]);
    fail(2, &["sky.exr", "--remove", "a.ktx2"], &["a.ktx2", ".exr, .hdr, .png or .tif"]);
    fail(2, &["sky.exr", "--remove", "sky.exr", "-y"], &["would replace its own input"]);
    bench.succeed(&["convert", "sky.exr", "{face}.exr", "--to", "cube", "--size", "32"]);
    fail(2, &["{face}.exr", "--remove", "a.exr"], &["6 views", "--to equirect"]);
    let found = report(&bench, &["{face}.exr"]);
    assert!((found["suns"][0]["yaw"].as_f64().unwrap() - 46.4).abs() < 0.5, "{found}");
    bench.succeed(&["light", "sun", "sky.exr", "--remove", "a.exr"]);
    fail(1, &["sky.exr", "--remove", "a.exr"], &["a.exr exists", "--overwrite"]);
    let output = bench.run(&["light", "sun", "sky.exr", "--remove", "a.hdr"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// What a file cannot say, and what is no number, is told.
#[test]
fn light_that_is_lost_is_told() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| if (i, j) == (9, 9) { [3.0, 4.0, 0.5] } else { [0.5; 3] });
    let lost = |output: &str| {
        let output = bench.run(&["light", "sun", "sky.exr", "--remove", output, "--json"]);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        (report["overflowed_samples"].as_u64(), text(&output.stderr))
    };
    let (samples, told) = lost("left.png");
    assert_eq!(samples, Some(2));
    assert_says(&told, &["left.png: 2 samples are brighter", "OpenEXR"]);
    let (samples, told) = lost("left.exr");
    assert!(samples == Some(0) && !told.contains("brighter"), "{told}");
    let save = |name: &str, samples: Vec<f32>| {
        bench.save(name, &EncodedImage::new(64, 32, Channels::Rgb, Depth::Float, Samples::Float(samples)).unwrap());
    };
    save("none.exr", vec![f32::NAN; 64 * 32 * 3]);
    assert_says(
        &bench.fail(1, &["light", "sun", "none.exr", "--remove", "left.tif"]),
        &["none.exr", "no pixel is a number"],
    );
    assert_says(
        &bench.fail(2, &["light", "sun", "sky.exr", "--remove", "left_{face}.exr"]),
        &["{face}", "single pictures"],
    );
    save("bright.exr", (0..64 * 32 * 3).map(|at| if at < 3 { f32::INFINITY } else { 0.5 }).collect());
    for args in [&["sun", "bright.exr"][..], &["table", "bright.exr", "t.csv"], &["harmonics", "bright.exr", "h.json"]]
    {
        let output = bench.run(&[&["light"], args].concat());
        assert!(output.status.success());
        assert_says(&text(&output.stderr), &["bright.exr", "65504"]);
    }
}

/// Energy goes in, and comes out, of tables and harmonics, too; black is missed by nothing.
#[test]
fn energy_is_told_of_what_is_no_picture() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |_, j| [0.5, 0.25, j as f32 / 64.0]);
    save_sky(&bench, "black.exr", 64, |_, _| [0.0; 3]);
    for args in [&["table", "sky.exr", "t.csv"][..], &["harmonics", "sky.exr", "h.json"]] {
        let json: Value = serde_json::from_str(&bench.succeed(&[&["light"], args, &["--json"]].concat())).unwrap();
        for (channel, expected) in [0.5, 0.25, 15.5 / 64.0].into_iter().enumerate() {
            let [before, after] = ["energy_in", "energy_out"].map(|key| json[key][channel].as_f64().unwrap());
            assert!((before - expected).abs() < 0.01 && (after - before).abs() < 0.005, "{json}");
        }
    }
    let json = bench.succeed(&["light", "harmonics", "black.exr", "black.json", "--json"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["irradiance"]["truncation_rms"].as_f64(), Some(0.0), "{json}");
}

/// Each frame of a sequence loses its own suns.
#[test]
fn suns_of_sequences_are_taken_out_frame_by_frame() {
    let bench = Bench::new();
    for frame in 3..6 {
        let sun = |i: usize, j: usize| if (i, j) == (10 * frame, 20) { [3000.0; 3] } else { [0.2; 3] };
        save_sky(&bench, &format!("sky.{frame:04}.exr"), 128, sun);
    }
    let found = report(&bench, &["sky.####.exr", "--remove", "left/####.exr"]);
    let frames = found["frames"].as_array().unwrap();
    assert_eq!(frames.iter().map(|frame| frame["frame"].as_u64().unwrap()).collect::<Vec<_>>(), [3, 4, 5]);
    for (number, frame) in (3..).zip(frames) {
        let yaw = (f64::from(10 * number) + 0.5) / 128.0 * 360.0 - 180.0;
        assert!((frame["suns"][0]["yaw"].as_f64().unwrap() - yaw).abs() < 0.05, "{frame}");
        assert!(
            light(&bench, &format!("left/{number:04}.exr")).iter().flatten().all(|light| (light - 0.2).abs() < 1e-6)
        );
    }
    assert_says(
        &bench.succeed(&["light", "sun", "sky.####.exr", "--remove", "left/####.exr", "--frames", "4", "-y"]),
        &["frame 4:"],
    );
    assert_says(&bench.fail(1, &["light", "sun", "sky.####.exr", "--remove", "left/####.exr"]), &["3 outputs exist"]);
    assert_says(&bench.fail(2, &["light", "sun", "sky.0003.exr", "--remove", "left.####.exr"]), &["frame marker"]);
}
