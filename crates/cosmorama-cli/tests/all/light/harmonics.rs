//! Spherical harmonics of a world's light: `light harmonics`.

use std::path::Path;
use std::process::Command;

use cosmorama::lighting::{HarmonicBasis, HarmonicFunctions};
use cosmorama::sphere::Direction;
use serde_json::Value;

use super::sky::save_sky;
use crate::bench::{Bench, assert_says, text};

/// Coefficients in a JSON file.
fn coefficients(bench: &Bench, name: &str) -> (Value, Vec<[f64; 3]>) {
    let json: Value = serde_json::from_slice(&bench.bytes(name)).unwrap();
    let light = |light: &Value| [0, 1, 2].map(|channel: usize| light[channel].as_f64().unwrap());
    let coefficients = json["coefficients"].as_array().unwrap().iter().map(light).collect();
    (json, coefficients)
}

#[test]
fn harmonics_are_written_as_json() {
    let bench = Bench::new();
    // Brighter in red to the right, in blue above.
    save_sky(&bench, "sky.exr", 128, |i, j| {
        let (longitude, up) = ((i as f32 + 0.5) / 64.0 - 1.0, 0.5 - (j as f32 + 0.5) / 64.0);
        let (longitude, latitude) = (longitude * std::f32::consts::PI, up * std::f32::consts::PI);
        [2.0 + longitude.sin() * latitude.cos(), 2.0, 2.0 + latitude.sin()]
    });
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 2e-3, "{found}, expected {expected}");
    let first = 4.0 * std::f64::consts::PI.sqrt();
    bench.succeed(&["light", "harmonics", "sky.exr", "own/light.json"]);
    let (json, own) = coefficients(&bench, "own/light.json");
    assert_eq!((&json["order"], &json["basis"], &json["kind"]), (&2.into(), &"zup".into(), &"radiance".into()));
    assert_eq!(own.len(), 9);
    own[0].iter().for_each(|light| near(*light, first));
    let slope = 4.0 * std::f64::consts::PI / 3.0 * 0.488603;
    // Y1−1 is up, Y11 right.
    near(own[3][0], slope);
    near(own[1][2], slope);
    near(own[2][0].abs() + own[3][1].abs() + own[3][2].abs(), 0.0);

    let matt = ["--order", "4", "--kind", "irradiance", "--basis", "yup", "--window", "lanczos:2"];
    bench.succeed(&[&["light", "harmonics", "sky.exr", "matt.json"], &matt[..]].concat());
    let (json, matt) = coefficients(&bench, "matt.json");
    assert_eq!((&json["order"], &json["basis"], &json["kind"]), (&4.into(), &"yup".into(), &"irradiance".into()));
    assert_eq!(matt.len(), 25);
    near(matt[0][1], std::f64::consts::PI * first);
    // Lanczos' sin(π/2)/(π/2), Lambert's 2π/3; the pole is up.
    near(matt[2][2], slope * 4.0 / 3.0);
    assert!(matt[4..].iter().flatten().all(|light| *light == 0.0), "bands beyond the window");
}

#[test]
fn harmonics_replace_nothing_and_need_all_the_sphere() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |_, _| [1.0; 3]);
    let to = ["light", "harmonics", "sky.exr"];
    bench.succeed(&[&to[..], &["a.json"]].concat());
    assert_says(&bench.fail(1, &[&to[..], &["a.json"]].concat()), &["a.json exists", "--overwrite"]);
    bench.succeed(&[&to[..], &["a.json", "-y", "--order", "10"]].concat());
    assert_eq!(coefficients(&bench, "a.json").1.len(), 121);
    let fail = |args: &[&str], says: &[&str]| assert_says(&bench.fail(2, &[&to[..], args].concat()), says);
    fail(&["b.exr"], &["written as JSON, CSV or code", ".json"]);
    fail(&["b.json", "--order", "11"], &["expected a number from 0 to 10"]);
    fail(&["b.json", "--window", "hamming"], &["expected hanning or lanczos"]);
    fail(&["b.json", "--window", "lanczos:0"], &["a width more than 0, as in lanczos:4"]);
    assert_says(&bench.fail(2, &["light", "harmonics", "builtin:demo", "b.json"]), &["is a formula"]);
    save_sky(&bench, "sky_0001.exr", 16, |_, _| [1.0; 3]);
    save_sky(&bench, "sky_0002.exr", 16, |_, _| [2.0; 3]);
    let frames = ["light", "harmonics", "sky_####.exr", "frame.json"];
    assert_says(&bench.fail(2, &frames), &["has 2 frames", "as in --frames 1"]);
    bench.succeed(&[&frames[..], &["--frames", "2"]].concat());
    assert!((coefficients(&bench, "frame.json").1[0][0] - 4.0 * std::f64::consts::PI.sqrt()).abs() < 1e-6);
    bench.succeed(&["convert", "sky.exr", "dome.exr", "--to", "fulldome", "--size", "128"]);
    let half = ["light", "harmonics", "dome.exr", "b.json", "--from", "fulldome"];
    assert_says(&bench.fail(1, &half), &["50.0 % of the sphere", "--missing"]);
    assert!(!Path::new(&bench.path("b.json")).exists());
    bench.succeed(&[&half[..], &["--missing", "white"]].concat());
    let (_, filled) = coefficients(&bench, "b.json");
    assert!((filled[0][0] - 2.0 * std::f64::consts::PI.sqrt()).abs() < 2e-2, "{:?}", filled[0]);
}

/// A sky that is brighter in one place, and of another colour in each.
fn save_bright_sky(bench: &Bench) {
    save_sky(bench, "sky.exr", 64, |i, j| {
        let (x, y) = (i as f32 / 10.0, j as f32 / 10.0);
        let sun = if (i, j) == (13, 9) { 900.0 } else { 0.0 };
        [2.0 + x.sin() * y.sin() + sun, 1.0 + 0.5 * y.cos() + sun, 3.0 + (2.0 * x).cos() * y.sin()]
    });
}

/// Sums functions times coefficients in a direction.
fn sum(order: usize, coefficients: &[[f64; 3]], direction: Direction) -> [f64; 3] {
    let values = HarmonicFunctions::new(order, HarmonicBasis::ZUp).at(direction);
    [0, 1, 2].map(|channel: usize| values.iter().zip(coefficients).map(|(value, light)| value * light[channel]).sum())
}

/// Compiles the code of each language that is there to compile, and compares what it makes of directions.
#[test]
fn code_sums_to_the_light() {
    let bench = Bench::new();
    save_bright_sky(&bench);
    let rust = (
        "rs",
        "fn main() { for [x, y, z] in [POINTS] { let [r, g, b] = world_light([x, y, z]); println!(\"{r} {g} {b}\"); } }",
    );
    let cpp = (
        "h",
        "#include \"HEADER\"\n#include <cstdio>\nint main() { const float d[][3] = {POINTS}; \
         for (auto& p : d) { auto l = world_light(p[0], p[1], p[2]); std::printf(\"%.9g %.9g %.9g\\n\", l[0], l[1], l[2]); } }",
    );
    let directions: Vec<Direction> = Direction::spread(40).collect();
    let plain: [&[&str]; 3] = [&["--order", "0"], &["--order", "2", "--kind", "irradiance"], &["--order", "10"]];
    let presets = ["filament", "three", "unity", "godot"].map(|preset| ["--basis", preset]);
    let cases: Vec<&[&str]> = plain.into_iter().chain(presets.iter().map(|preset| &preset[..])).collect();
    for (extension, main) in [rust, cpp] {
        for (number, case) in cases.iter().enumerate() {
            let name = format!("code_{number}.{extension}");
            bench.succeed(&[&["light", "harmonics", "sky.exr", &name], *case].concat());
            let axes = match case {
                ["--basis", "filament" | "godot"] => HarmonicBasis::FrontZ,
                ["--basis", "three"] => HarmonicBasis::FrontX,
                ["--basis", "unity"] => HarmonicBasis::FrontXLeftHanded,
                _ => HarmonicBasis::ZUp,
            };
            let brackets = if extension == "rs" { ["[", "]"] } else { ["{", "}"] };
            let point = |direction: &Direction| {
                let [x, y, z] = axes.coordinates(*direction).map(|number| format!("{number:?}"));
                format!("{}{x}, {y}, {z}{}, ", brackets[0], brackets[1])
            };
            let points: String = directions.iter().map(point).collect();
            let main = main.replace("POINTS", points.trim_end_matches(", ")).replace("HEADER", &name);
            let program =
                if extension == "rs" { (text(&bench.bytes(&name)) + &main, "main.rs") } else { (main, "main.cpp") };
            std::fs::write(bench.path(program.1), program.0).unwrap();
            let Some(printed) = compiled(&bench, program.1) else { continue };
            // Our own, in plain coefficients.
            let order = if number == 0 {
                "0"
            } else if number == 2 {
                "10"
            } else {
                "2"
            };
            let is_radiance = matches!(case, ["--order", "0" | "10"] | ["--basis", "three"]);
            let kind = if is_radiance { "radiance" } else { "irradiance" };
            bench.succeed(&["light", "harmonics", "sky.exr", "own.json", "--order", order, "--kind", kind, "-y"]);
            let own = coefficients(&bench, "own.json").1;
            let part = if number > 2 && !is_radiance { std::f64::consts::FRAC_1_PI } else { 1.0 };
            let most = own.iter().flatten().fold(0.0f64, |most, light| most.max(light.abs()));
            for (line, direction) in printed.lines().zip(&directions) {
                let found: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
                for (found, expected) in found.into_iter().zip(sum(order.parse().unwrap(), &own, *direction)) {
                    assert!(
                        (found - part * expected).abs() < 1e-5 * most,
                        "{name} {case:?}: {found}, {}",
                        part * expected
                    );
                }
            }
            assert_eq!(printed.lines().count(), directions.len(), "{name}");
        }
    }
}

/// Compiles and runs a program; `None`, and says so, where there is no compiler.
fn compiled(bench: &Bench, name: &str) -> Option<String> {
    let program = bench.path("program");
    let mut compiler = if name.ends_with(".rs") {
        Command::new("rustc")
    } else {
        let mut compiler = Command::new("g++");
        compiler.args(["-std=c++17", "-Wall", "-Wextra", "-Werror"]);
        compiler
    };
    let Ok(output) = compiler.arg(bench.path(name)).arg("-o").arg(&program).output() else {
        println!("left out: no compiler for {name}");
        return None;
    };
    assert!(output.status.success(), "{name}: {}", text(&output.stderr));
    assert_eq!(text(&output.stderr), "", "{name}");
    Some(text(&Command::new(program).output().unwrap().stdout))
}

#[test]
fn tables_and_shaders_hold_the_numbers() {
    let bench = Bench::new();
    save_bright_sky(&bench);
    for name in ["light.json", "light.csv", "light.glsl", "light.hlsl"] {
        bench.succeed(&["light", "harmonics", "sky.exr", name, "--basis", "three"]);
    }
    let numbers = coefficients(&bench, "light.json").1;
    let table = text(&bench.bytes("light.csv"));
    let mut rows = table.lines();
    assert_eq!(rows.next(), Some("l,m,red,green,blue"));
    let bands = [(0, 0), (1, -1), (1, 0), (1, 1), (2, -2), (2, -1), (2, 0), (2, 1), (2, 2)];
    for ((row, (l, m)), expected) in rows.zip(bands).zip(&numbers) {
        let found: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
        assert_eq!(found[..2], [f64::from(l), f64::from(m)]);
        // The reader of JSON is off by a last digit at times.
        assert!(found[2..].iter().zip(expected).all(|(found, light)| (found - light).abs() < 1e-12), "{row}");
    }
    for (name, vector, array) in [("light.glsl", "vec3", "vec3[9]("), ("light.hlsl", "float3", "= {")] {
        let code = text(&bench.bytes(name));
        for [red, green, blue] in &numbers {
            let [red, green, blue] = [red, green, blue].map(|light| *light as f32);
            assert_says(&code, &[&format!("{vector}({red:?}, {green:?}, {blue:?})")]);
        }
        assert_says(
            &code,
            &[array, &format!("{vector} world_light({vector} direction)"), "+x is front, +y up, +z right"],
        );
    }
}

/// Truncation and positivity against what is known of a small lamp over black.
#[test]
fn what_coefficients_miss_is_told() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |i, j| if (i, j) == (20, 10) { [1000.0; 3] } else { [0.0; 3] });
    let args = ["light", "harmonics", "sky.exr", "light.json"];
    let output = bench.run(&args);
    assert_says(
        &text(&output.stderr),
        &["order 2 misses", "% of the irradiance (rms)", "the radiance is negative over"],
    );
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["-y", "--json"]].concat())).unwrap();
    let number = |kind: &str, key: &str| report[kind][key].as_f64().unwrap();
    // Of a point, nine of infinitely many functions of like power are hardly anything.
    assert!((0.98..1.0).contains(&number("radiance", "truncation_rms")), "{report}");
    // Of the cosine's power, 2π/3, bands 0 to 2 hold π/4 + π/3 + 5π/64, by the factors of the paper.
    let missed = (1.0f64 - (0.25 + 1.0 / 3.0 + 5.0 / 64.0) / (2.0 / 3.0)).sqrt();
    assert!((number("irradiance", "truncation_rms") - missed).abs() < 2e-3, "{missed}: {report}");
    assert!(number("irradiance", "least") < 0.0 && number("irradiance", "negative_share") > 0.1, "{report}");
    assert!((report["brightest_texels_share"].as_f64().unwrap() - 1.0).abs() < 1e-6, "{report}");
    // A window weakens ringing, at the price of sharpness.
    let windowed = [&args[..], &["-y", "--json", "--window", "hanning"]].concat();
    let windowed: Value = serde_json::from_str(&bench.succeed(&windowed)).unwrap();
    assert!(windowed["radiance"]["least"].as_f64().unwrap() > number("radiance", "least"), "{windowed}");
    assert!(windowed["irradiance"]["truncation_rms"].as_f64().unwrap() > missed, "{windowed}");
}

#[test]
fn presets_take_what_their_programs_take() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 64, |_, _| [1.0; 3]);
    let fail = |args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(2, &[&["light", "harmonics", "sky.exr", "a.json"], args].concat()), says);
    };
    fail(&["--basis", "unity", "--kind", "radiance"], &["--basis unity", "Irradiance only"]);
    fail(&["--basis", "godot", "--kind", "irradiance"], &["--basis godot", "Radiance only"]);
    fail(&["--basis", "three", "--order", "3"], &["--basis three", "order 2, not 3"]);
    fail(&["--basis", "filament", "--order", "3"], &["order 0, 1 or 2, not 3"]);
    for (preset, kind, white) in [
        ("filament", "irradiance", 1.0),
        ("three", "radiance", 2.0 * std::f64::consts::PI.sqrt()),
        ("unity", "irradiance", 1.0),
        ("godot", "radiance", 2.0 / std::f64::consts::PI.sqrt()),
    ] {
        bench.succeed(&["light", "harmonics", "sky.exr", "a.json", "--basis", preset, "-y"]);
        let (json, numbers) = coefficients(&bench, "a.json");
        assert_eq!((&json["basis"], &json["kind"]), (&preset.into(), &kind.into()));
        assert!((numbers[0][0] - white).abs() < 1e-6, "{preset}: {}", numbers[0][0]);
    }
    bench.succeed(&["light", "harmonics", "sky.exr", "a.json", "--basis", "filament", "--order", "1", "-y"]);
    assert_eq!(coefficients(&bench, "a.json").1.len(), 4);
}
