//! Tables of colours by one angle: `light table`.

use cosmorama::raster::Depth;
use serde_json::Value;

use super::sky::{light, save_sky};
use crate::bench::{Bench, assert_says, text};

/// Angles and colours of a table in CSV.
fn rows(bench: &Bench, name: &str) -> (String, Vec<[f64; 4]>) {
    let table = text(&bench.bytes(name));
    let (head, rows) = table.split_once('\n').unwrap();
    let numbers = |row: &str| -> [f64; 4] {
        let numbers: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    (head.to_owned(), rows.lines().map(numbers).collect())
}

#[test]
fn a_world_becomes_the_means_of_its_rows_or_columns() {
    let bench = Bench::new();
    // Each row of 2.8° has one colour, but for a stripe in one column.
    let row = |j: usize| 1.0 + 0.1 * j as f32;
    save_sky(&bench, "sky.exr", 128, |i, j| [row(j), if i == 32 { 12.8 } else { 0.0 }, 2.0]);
    let args = ["light", "table", "sky.exr", "a.csv"];
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--json"]].concat())).unwrap();
    let (head, table) = rows(&bench, "a.csv");
    assert_eq!((head.as_str(), table.len()), ("elevation,red,green,blue", 64));
    for (k, [degrees, red, green, blue]) in table.iter().enumerate() {
        assert!((degrees - (-90.0 + (k as f64 + 0.5) * 180.0 / 64.0)).abs() < 1e-9);
        assert!((red - f64::from(row(63 - k))).abs() < 1e-4 && (green - 0.1).abs() < 1e-4 && (blue - 2.0).abs() < 1e-6);
    }
    assert!((report["energy_out"][2].as_f64().unwrap() - 2.0).abs() < 1e-9, "{report}");
    bench.succeed(&["light", "table", "sky.exr", "b.csv", "--by", "azimuth", "--size", "128"]);
    let (head, table) = rows(&bench, "b.csv");
    assert_eq!((head.as_str(), table.len()), ("azimuth,red,green,blue", 128));
    for (k, [degrees, _, green, _]) in table.iter().enumerate() {
        assert!((degrees - (-180.0 + (k as f64 + 0.5) * 360.0 / 128.0)).abs() < 1e-9);
        assert!((green - if k == 32 { 12.8 } else { 0.0 }).abs() < 1e-3, "{k}: {green}");
    }
    // A picture of one row.
    bench.succeed(&["light", "table", "sky.exr", "a.exr"]);
    let image = bench.load("a.exr");
    assert_eq!((image.width(), image.height(), image.depth()), (64, 1, Depth::Float));
    assert!((light(&bench, "a.exr")[3][0] - row(60)).abs() < 1e-4);
}

#[test]
fn a_table_becomes_a_world_and_comes_back() {
    let bench = Bench::new();
    let stops = "stops:-90=0.1,0.2,0.3;0=white;90=0.1,0.4,2";
    bench.succeed(&["light", "table", stops, "world.exr", "--size", "256"]);
    let image = bench.load("world.exr");
    assert_eq!((image.width(), image.height(), image.depth()), (256, 128, Depth::Float));
    bench.succeed(&["light", "table", "world.exr", "back.csv"]);
    for [degrees, red, green, blue] in rows(&bench, "back.csv").1 {
        let part = degrees.abs() / 90.0;
        let end = if degrees < 0.0 { [0.1, 0.2, 0.3] } else { [0.1, 0.4, 2.0] };
        let expected = end.map(|end| 1.0 + part * (end - 1.0));
        for (found, expected) in [red, green, blue].into_iter().zip(expected) {
            assert!((found - expected).abs() < 6e-3, "{degrees}: {found}, {expected}");
        }
    }
    // About a pole of one's own: from the left to the right.
    bench.succeed(&["light", "table", stops, "side.exr", "--size", "64", "--roll", "90"]);
    let side = light(&bench, "side.exr");
    assert!(side[16 * 64 + 48][2] > 1.9 && side[16 * 64 + 16][2] < 0.4 && (side[32][1] - 1.0).abs() < 0.05);
    bench.succeed(&["light", "table", "back.csv", "again.png"]);
    assert_eq!(bench.load("again.png").depth(), Depth::Sixteen);
    bench.succeed(&["light", "table", stops, "stops.csv", "--by", "azimuth"]);
    assert_eq!(rows(&bench, "stops.csv").1.len(), 3);
}

#[test]
fn mistakes_about_tables_of_colours_are_answered() {
    let bench = Bench::new();
    save_sky(&bench, "sky.exr", 32, |_, _| [2.0; 3]);
    std::fs::write(bench.path("bad.csv"), "elevation,red,green,blue\n0,1,2\n").unwrap();
    let fail = |code: i32, args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(code, &[&["light", "table"], args].concat()), says);
    };
    fail(2, &["sky.exr", "a.json"], &["a.json", ".csv, .exr, .hdr, .png or .tif"]);
    fail(2, &["sky.exr", "a.ktx2"], &["a.ktx2", ".csv, .exr, .hdr, .png or .tif"]);
    fail(2, &["sky.exr", "a.csv", "--size", "0"], &["expected a number from 1 to 8192"]);
    fail(2, &["sky.exr", "a.csv", "--depth", "half"], &["--depth is for pictures"]);
    fail(2, &["sky.exr", "a.png", "--depth", "float"], &["PNG has no --depth float; choose 8"]);
    fail(2, &["stops:0=whit", "a.exr"], &["stops:", "whit"]);
    fail(1, &["bad.csv", "a.exr"], &["bad.csv: line 2: expected four numbers"]);
    fail(1, &["none.csv", "a.exr"], &["none.csv cannot be read"]);
    fail(2, &["bad.csv", "bad.csv", "-y"], &["would replace its own input"]);
    bench.succeed(&["convert", "sky.exr", "dome.exr", "--to", "fulldome", "--size", "256"]);
    fail(1, &["dome.exr", "a.csv", "--from", "fulldome"], &["50.0 % of the sphere", "--missing"]);
    bench.succeed(&["light", "table", "dome.exr", "a.csv", "--from", "fulldome", "--missing", "black"]);
    let table = rows(&bench, "a.csv").1;
    assert!((table[60][1] - 2.0).abs() < 0.02 && table[3][1] < 1e-3, "{table:?}");
    fail(1, &["sky.exr", "a.csv"], &["a.csv exists", "--overwrite"]);
    let output = bench.run(&["light", "table", "sky.exr", "white.png"]);
    assert_says(&text(&output.stderr), &["192 samples are brighter than --depth 16 holds"]);
}
