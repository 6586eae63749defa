//! Tables of what surfaces reflect: `light brdf`.

use std::path::Path;

use cosmorama::lighting::BrdfModel;
use cosmorama::raster::Depth;
use serde_json::Value;

use super::sky::light;
use crate::bench::{Bench, assert_says, text};

/// Red and green of the cell of column i and row j.
fn expected(model: BrdfModel, size: usize, (i, j): (usize, usize)) -> [f64; 2] {
    let centre = |k: usize| (k as f64 + 0.5) / size as f64;
    let albedo = model.albedo(centre(i), centre(j).powi(2));
    [albedo.scale, albedo.bias]
}

#[test]
fn tables_hold_the_albedo_in_each_format() {
    let bench = Bench::new();
    for (name, depth, most) in [
        ("a.exr", Depth::Float, 1e-6),
        ("a.tif", Depth::Float, 1e-6),
        ("half.exr", Depth::Half, 5e-4),
        ("a.png", Depth::Sixteen, 1e-5),
    ] {
        let given: &[&str] = if name == "half.exr" { &["--depth", "half"] } else { &[] };
        bench.succeed(&[&["light", "brdf", name, "--size", "16"], given].concat());
        let image = bench.load(name);
        assert_eq!((image.width(), image.height(), image.depth()), (16, 16, depth), "{name}");
        for (k, found) in light(&bench, name).into_iter().enumerate() {
            let [scale, bias] = expected(BrdfModel::Ggx, 16, (k % 16, k / 16));
            let off = (f64::from(found[0]) - scale).abs().max((f64::from(found[1]) - bias).abs());
            assert!(off <= most && found[2] == 0.0, "{name} {k}: {found:?}, {scale} {bias}");
        }
    }
}

#[test]
fn a_flat_texture_has_a_table() {
    let bench = Bench::new();
    for (name, depth, format, bytes) in [("a.ktx2", "half", 97, 2), ("b/c.ktx2", "float", 109, 4)] {
        let args = ["light", "brdf", name, "--size", "8", "--multiscatter", "--depth", depth];
        bench.succeed(&args);
        let file = bench.bytes(name);
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        // KTX 2: the Vulkan format, the size of its type, width, height, no depth, no layers, one face, one level.
        assert_eq!([12, 16, 20, 24, 28, 32, 36, 40].map(word), [format, bytes, 8, 8, 0, 0, 1, 1], "{name}");
        let (offset, length) = (word(80), word(88));
        assert_eq!((offset % (4 * bytes), length, offset + length), (0, 64 * 4 * bytes, file.len()));
        let sample = |k: usize| -> f64 {
            let sample = &file[offset + k * bytes..offset + (k + 1) * bytes];
            match sample {
                [a, b] => half::f16::from_le_bytes([*a, *b]).to_f64(),
                _ => f32::from_le_bytes(sample.try_into().unwrap()).into(),
            }
        };
        for cell in 0..64 {
            let [scale, bias] = expected(BrdfModel::Ggx, 8, (cell % 8, cell / 8));
            let most = if bytes == 2 { 5e-4 } else { 1e-6 };
            assert!(
                (sample(4 * cell) - bias).abs() < most && (sample(4 * cell + 1) - scale - bias).abs() < most,
                "{cell}"
            );
            assert_eq!((sample(4 * cell + 2), sample(4 * cell + 3)), (0.0, 1.0));
        }
    }
}

#[test]
fn cloth_is_brighter_than_one_and_that_is_told() {
    let bench = Bench::new();
    let args = ["light", "brdf", "cloth.exr", "--lobe", "charlie", "--size", "32", "--json"];
    let report: Value = serde_json::from_str(&bench.succeed(&args)).unwrap();
    assert!(report["largest"].as_f64().unwrap() > 1.0 && report["overflowed_samples"] == 0, "{report}");
    let [albedo, none] = expected(BrdfModel::Charlie, 32, (3, 20));
    let found = light(&bench, "cloth.exr")[20 * 32 + 3];
    assert!((f64::from(found[0]) - albedo).abs() < 1e-6 && none == 0.0 && found[1..] == [0.0, 0.0]);
    let output = bench.run(&["light", "brdf", "cloth.png", "--lobe", "charlie", "--size", "32"]);
    assert!(output.status.success());
    assert_says(&text(&output.stderr), &["cells are more than 1", "--depth 16", ".exr and .ktx2"]);
}

#[test]
fn mistakes_about_tables_are_answered() {
    let bench = Bench::new();
    let fail = |args: &[&str], says: &[&str]| assert_says(&bench.fail(2, &[&["light", "brdf"], args].concat()), says);
    fail(&["a.jpg"], &["a.jpg", ".exr, .ktx2, .png or .tif"]);
    fail(&["a.dds"], &["a.dds", ".exr, .ktx2, .png or .tif"]);
    fail(&["a.exr", "--size", "0"], &["expected a number from 1 to 4096"]);
    fail(&["a.exr", "--size", "5000"], &["expected a number from 1 to 4096"]);
    fail(&["a.exr", "--depth", "16"], &["--depth 16", "choose half, float"]);
    fail(&["a.exr", "--lobe", "charlie", "--multiscatter"], &["--multiscatter", "cloth has one number a cell"]);
    bench.succeed(&["light", "brdf", "a.exr", "--size", "4"]);
    assert_says(&bench.fail(1, &["light", "brdf", "a.exr", "--size", "4"]), &["a.exr exists", "--overwrite"]);
    bench.succeed(&["light", "brdf", "a.exr", "--size", "4", "-y", "--threads", "1"]);
    assert!(Path::new(&bench.path("a.exr")).exists());
}
