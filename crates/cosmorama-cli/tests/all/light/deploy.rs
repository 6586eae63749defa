//! Folders for engines: `light deploy`.

use serde_json::Value;

use super::sky::{light, save_sky};
use crate::bench::{Bench, assert_says};

/// Direction of a panorama's pixel: right, up, back.
fn direction(width: usize, (i, j): (usize, usize)) -> [f64; 3] {
    let angle = |k: usize| (k as f64 + 0.5) / width as f64 * std::f64::consts::TAU;
    let (longitude, latitude) = (angle(i) - std::f64::consts::PI, std::f64::consts::FRAC_PI_2 - angle(j));
    [longitude.sin() * latitude.cos(), latitude.sin(), -longitude.cos() * latitude.cos()]
}

/// A sky that is different in every direction.
fn colour(direction: [f64; 3]) -> [f32; 3] {
    direction.map(|part| (1.0 + 0.5 * part) as f32)
}

fn save_directions(bench: &Bench) {
    save_sky(bench, "sky.exr", 128, |i, j| colour(direction(128, (i, j))));
}

/// The texel of a cube that OpenGL, Vulkan and Direct3D show for a direction (OpenGL 4.6, table 8.19), of faces +X −X +Y −Y +Z −Z.
fn texel(faces: &[[f32; 3]], [x, y, z]: [f64; 3]) -> [f32; 3] {
    let edge = (faces.len() / 6).isqrt();
    let (face, s, t, major) = if x.abs() >= y.abs().max(z.abs()) {
        if x > 0.0 { (0, -z, -y, x) } else { (1, z, -y, -x) }
    } else if y.abs() >= z.abs() {
        if y > 0.0 { (2, x, z, y) } else { (3, x, -z, -y) }
    } else if z > 0.0 {
        (4, x, -y, z)
    } else {
        (5, -x, -y, -z)
    };
    let place = |at: f64| (((at / major + 1.0) / 2.0 * edge as f64) as usize).min(edge - 1);
    faces[(face * edge + place(t)) * edge + place(s)]
}

/// An engine: its axes ahead, right and up, and the signs of a direction by which its shaders look a cube up.
struct Engine {
    name: &'static str,
    cubes: &'static [&'static str],
    axes: [[f64; 3]; 3],
    looked_up: [f64; 3],
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
const AS_IT_IS: [f64; 3] = [1.0, 1.0, 1.0];

fn minus(axis: [f64; 3]) -> [f64; 3] {
    axis.map(|part| -part)
}

#[test]
fn each_engine_sees_the_world_upright_and_not_mirrored() {
    let bench = Bench::new();
    save_directions(&bench);
    let (ktx, ktx2, dds): (&[&str], &[&str], &[&str]) =
        (&["sky_skybox.ktx", "sky_ibl.ktx"], &["sky.ktx2", "specular.ktx2"], &["specular.dds"]);
    for Engine { name, cubes, axes: [ahead, right, up], looked_up } in [
        Engine { name: "filament", cubes: ktx, axes: [Z, minus(X), Y], looked_up: AS_IT_IS },
        Engine { name: "gltf", cubes: ktx2, axes: [X, Z, Y], looked_up: AS_IT_IS },
        Engine { name: "three", cubes: ktx2, axes: [X, Z, Y], looked_up: [-1.0, 1.0, 1.0] },
        Engine { name: "bevy", cubes: ktx2, axes: [minus(Z), X, Y], looked_up: [1.0, 1.0, -1.0] },
        Engine { name: "godot", cubes: dds, axes: [Z, minus(X), Y], looked_up: AS_IT_IS },
        Engine { name: "unreal", cubes: dds, axes: [X, Y, Z], looked_up: AS_IT_IS },
    ] {
        let folder = format!("{name}/sky");
        bench.succeed(&["light", "deploy", "sky.exr", &folder, "--preset", name, "--size", "64", "--sky-size", "64"]);
        for cube in cubes {
            let faces = light(&bench, &format!("{folder}/{cube}"));
            for (i, j) in (0..128).step_by(9).flat_map(|i| (4..64).step_by(9).map(move |j| (i, j))) {
                let [x, y, z] = direction(128, (i, j));
                let part = |k: usize| (right[k] * x + up[k] * y - ahead[k] * z) * looked_up[k];
                let (found, expected) = (texel(&faces, [part(0), part(1), part(2)]), colour([x, y, z]));
                let off =
                    found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f32::max);
                assert!(off < 0.03, "{name}, {cube}, {i}, {j}: {found:?}, {expected:?}");
            }
        }
        assert!(std::fs::read_to_string(bench.path(&format!("{folder}/README.txt"))).unwrap().len() > 200);
    }
}

#[test]
fn energy_is_kept_and_told_file_by_file() {
    let Some(sky) = testkit::shared("data/equirect_hdr/polyhaven_chinese_garden_1k.hdr") else { return };
    let bench = Bench::new();
    let sky = sky.display().to_string();
    let args = ["light", "deploy", &sky, "out", "--size", "64", "--sky-size", "128", "--json", "--preset"];
    for (preset, levels) in [("three", 8 + 4), ("bevy", 8 + 1 + 4), ("unreal", 1 + 8 + 1 + 7)] {
        let told: Value = serde_json::from_str(&bench.succeed(&[&args[..], &[preset, "-y"]].concat())).unwrap();
        let outputs = told["outputs"].as_array().unwrap();
        let maps: Vec<&Value> = outputs.iter().filter_map(|output| output["light"].as_array()).flatten().collect();
        assert_eq!(maps.len(), levels, "{preset}");
        for map in maps {
            let kept = map["energy_out"][0].as_f64().unwrap_or(0.0) / map["energy_in"][0].as_f64().unwrap();
            // Faces of less than 16 pixels are too coarse to be measured.
            assert!((kept - 1.0).abs() < 5e-3 || map["level"].as_u64().unwrap() > 2, "{preset}: {map}");
        }
        for output in outputs {
            assert!(bench.path("out").join(output["file"].as_str().unwrap()).is_file(), "{output}");
        }
        let probe = outputs.iter().find(|output| output["holds"] == "harmonics");
        assert_eq!(probe.is_some(), preset == "three");
        assert!(probe.is_none_or(|probe| probe["irradiance"]["truncation_rms"].as_f64().unwrap() > 0.05));
    }
}

/// Nine coefficients in the metadata of a KTX file: the text under `sh`, as Filament's `Ktx1Bundle` finds it.
fn harmonics(file: &[u8]) -> Vec<f64> {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let (mut at, end) = (64, 64 + word(60));
    while at < end {
        let pair = &file[at + 4..at + 4 + word(at)];
        if let Some(text) = pair.strip_prefix(b"sh\0") {
            let text = String::from_utf8_lossy(text);
            return text.trim_end_matches('\0').split_whitespace().map(|number| number.parse().unwrap()).collect();
        }
        at = (at + 4 + word(at)).next_multiple_of(4);
    }
    panic!("no harmonics")
}

/// A sky and its light from Filament's own samples, by cmgen: from the sky we make the same light. cmgen weakened the bands by its window,
/// so that the light is nowhere negative.
#[test]
fn filament_finds_what_cmgen_makes() {
    let Some(theirs) = testkit::shared("data/filament_ibl") else { return };
    let bench = Bench::new();
    let sky = theirs.join("hall_skybox.ktx").display().to_string();
    let args = ["light", "deploy", &sky, "hall", "--preset", "filament", "--sky-size", "256"];
    bench.succeed(&[&args[..], &["--from", "cube:order=lrudfb,flip=x"]].concat());
    let theirs = std::fs::read(theirs.join("hall_ibl.ktx")).unwrap();
    let ours = bench.bytes("hall/hall_ibl.ktx");
    let words = |file: &[u8]| -> Vec<u32> {
        file[36..60].chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
    };
    assert_eq!(words(&ours), words(&theirs), "edges, layers, faces, levels");
    let (ours, theirs) = (harmonics(&ours), harmonics(&theirs));
    assert_eq!((ours.len(), theirs.len()), (27, 27));
    // Bands 0, 1 and 2, each times a factor of its own, at most 1 and falling.
    let mut before = 1.0;
    for band in [0..3, 3..12, 12..27] {
        let (ours, theirs) = (&ours[band.clone()], &theirs[band.clone()]);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let factor = product(ours, theirs) / product(ours, ours);
        assert!(factor < before + 5e-3 && factor > 0.5, "{band:?}: {factor}");
        for (ours, theirs) in ours.iter().zip(theirs) {
            assert!((factor * ours - theirs).abs() < 0.01, "{band:?}: {ours} times {factor}, {theirs}");
        }
        before = factor;
    }
}

#[test]
fn a_folder_is_whole_or_not_there() {
    let bench = Bench::new();
    save_directions(&bench);
    let small = ["--preset", "three", "--size", "16", "--sky-size", "16"];
    let fail = |code: i32, args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(code, &[&["light", "deploy"], args].concat()), says);
    };
    fail(2, &["sky.exr", "out"], &["--preset <ENGINE>"]);
    fail(2, &["sky.exr", "out", "--preset", "unity"], &["unity", "filament", "unreal"]);
    fail(2, &["sky.exr", "out", "--preset", "three", "--size", "100"], &["expected a power of two from 16 to 4096"]);
    fail(1, &["none.exr", "out", "--preset", "three"], &["none.exr"]);
    fail(1, &["sky.exr", "sky.exr", "--preset", "three"], &["sky.exr is a file, where a folder was expected"]);
    // Half a sky, and no word about the rest.
    bench.succeed(&["convert", "sky.exr", "half.exr", "--to", "fulldome", "--size", "32"]);
    fail(1, &["half.exr", "out", "--from", "fulldome", "--preset", "three"], &["--missing"]);
    bench.succeed(&[&["light", "deploy", "sky.exr", "new/out"], &small[..]].concat());
    std::fs::write(bench.path("new/out/notes.txt"), "mine").unwrap();
    fail(1, &[&["sky.exr", "new/out"], &small[..]].concat(), &["outputs exist", "-y"]);
    bench.succeed(&[&["light", "deploy", "sky.exr", "new/out", "-y"], &small[..]].concat());
    assert_eq!(std::fs::read_dir(bench.path("new/out")).unwrap().count(), 7);
    assert_eq!(std::fs::read_dir(bench.path("new")).unwrap().count(), 1);
}
