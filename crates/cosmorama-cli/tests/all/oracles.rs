//! The program against direct renders by another program: `convert`, then `compare`.
//!
//! The floors are those of the project's specification, in dB of linear light (and of sRGB code values).

use std::path::Path;

use crate::bench::Bench;
use serde_json::Value;

/// Greatest shift between the frame that we make and the direct render, in pixels.
const MOST_SHIFT: f64 = 0.01;

struct Case {
    faces: &'static str,
    direct: &'static str,
    to: &'static [&'static str],
    region: &'static str,
    box_reference: f64,
    linear: f64,
    encoded: f64,
}

const SIX: &str = "face_{face}.png";
const FOUR: &str = "face4_{face}.png";

const CASES: [Case; 10] = [
    Case {
        faces: SIX,
        direct: "omnimax_1966x1436.png",
        to: &["--to", "omnimax", "--size", "1966x1436"],
        region: "omnimax",
        box_reference: 32.9,
        linear: 35.9,
        encoded: 36.1,
    },
    Case {
        faces: FOUR,
        direct: "omnimax_1966x1436.png",
        to: &["--to", "omnimax", "--size", "1966x1436"],
        region: "omnimax",
        box_reference: 32.5,
        linear: 35.2,
        encoded: 35.5,
    },
    Case {
        faces: SIX,
        direct: "omnimax_tight_1024x798.png",
        to: &["--to", "omnimax:aspect=1.000193", "--size", "1024x798"],
        region: "omnimax",
        box_reference: 36.1,
        linear: 39.5,
        encoded: 39.5,
    },
    Case {
        faces: SIX,
        direct: "fisheye180.png",
        to: &["--to", "fisheye", "--size", "1024"],
        region: "disc",
        box_reference: 38.1,
        linear: 41.8,
        encoded: 41.5,
    },
    Case {
        faces: SIX,
        direct: "fisheye220.png",
        to: &["--to", "fisheye:fov=220", "--size", "1024"],
        region: "disc",
        box_reference: 39.4,
        linear: 42.4,
        encoded: 42.2,
    },
    Case {
        faces: SIX,
        direct: "spherical.png",
        to: &["--to", "equirect", "--size", "2048"],
        region: "all",
        box_reference: 37.9,
        linear: 40.3,
        encoded: 39.8,
    },
    Case {
        faces: SIX,
        direct: "perspective.png",
        to: &["--to", "perspective:fov=45", "--size", "640x480", "--yaw", "-37", "--pitch", "12", "--roll", "-9"],
        region: "all",
        box_reference: 29.0,
        linear: 33.2,
        encoded: 32.2,
    },
    Case {
        faces: SIX,
        direct: "cylinder1.png",
        to: &["--to", "cylinder", "--size", "1024x512"],
        region: "all",
        box_reference: 42.4,
        linear: 41.7,
        encoded: 41.7,
    },
    Case {
        faces: SIX,
        direct: "mercator.png",
        to: &["--to", "mercator", "--size", "768x576"],
        region: "all",
        box_reference: 40.1,
        linear: 40.3,
        encoded: 40.2,
    },
    Case {
        faces: SIX,
        direct: "motion_mid.png",
        to: &["--to", "perspective:fov=60", "--size", "640x480", "--yaw", "20", "--pitch", "-4"],
        region: "all",
        box_reference: 30.3,
        linear: 33.5,
        encoded: 34.6,
    },
];

/// Converts, and measures the frame against the direct render: PSNR linear and encoded, and the shift.
fn measure(case: &Case, folder: &Path, filter: &[&str]) -> (f64, f64, f64) {
    let bench = Bench::new();
    let (faces, direct) = (folder.join(case.faces), folder.join(case.direct));
    let mut args = vec!["convert", faces.to_str().unwrap(), "out.png", "--transfer", "linear"];
    args.extend(case.to);
    args.extend(filter);
    bench.succeed(&args);
    let direct = direct.to_str().unwrap();
    let report =
        bench.succeed(&["compare", "out.png", direct, "--region", case.region, "--transfer", "linear", "--json"]);
    let report: Value = serde_json::from_str(&report).unwrap();
    let figure = |value: &Value| value.as_f64().unwrap();
    (figure(&report["linear"]["psnr"]), figure(&report["srgb"]["psnr"]), figure(&report["shift"]["pixels"]))
}

#[test]
fn the_default_filter_reaches_its_floors() {
    let Some(folder) = testkit::shared("oracles/povray") else { return };
    for case in &CASES {
        let (linear, encoded, shift) = measure(case, &folder, &[]);
        println!("{} → {}: {linear:.2} / {encoded:.2} dB, shift {shift:.4} px", case.faces, case.direct);
        assert!(linear >= case.linear, "{}: {linear} dB of linear light", case.direct);
        assert!(encoded >= case.encoded, "{}: {encoded} dB of code values", case.direct);
        assert!(shift <= MOST_SHIFT, "{}: shift {shift} px", case.direct);
    }
}

#[test]
fn the_box_reference_proves_the_geometry() {
    let Some(folder) = testkit::shared("oracles/povray") else { return };
    for case in &CASES {
        let (linear, _, shift) = measure(case, &folder, &["--filter", "reference", "--kernel", "box"]);
        println!("{} → {}: {linear:.2} dB, shift {shift:.4} px", case.faces, case.direct);
        assert!(linear >= case.box_reference, "{}: {linear} dB", case.direct);
        assert!(shift <= MOST_SHIFT, "{}: shift {shift} px", case.direct);
    }
}
