//! Sequences with faults, each of which `verify` names by its frame.

use crate::bench::{Bench, assert_says, flat, picture, text};
use serde_json::{Value, json};

/// Frames 1 to `count`, each a little other than the one before.
fn sequence(bench: &Bench, count: usize) {
    for frame in 1..=count {
        bench.save(&format!("dome_{frame}.png"), &picture(frame, 32, 16));
    }
}

#[test]
fn a_whole_sequence_has_no_faults() {
    let bench = Bench::new();
    sequence(&bench, 4);
    assert_eq!(bench.succeed(&["verify", "dome_#.png"]), "4 frames are whole and alike\n");
    let report: Value =
        serde_json::from_str(&bench.succeed(&["verify", "dome_#.png", "--size", "32x16", "--json"])).unwrap();
    assert_eq!((&report["frames"], &report["whole"], &report["faults"]), (&4.into(), &4.into(), &json!([])));
}

#[test]
fn every_fault_is_named_by_its_frame() {
    let bench = Bench::new();
    sequence(&bench, 9);
    std::fs::remove_file(bench.path("dome_2.png")).unwrap();
    let bytes = bench.bytes("dome_3.png");
    std::fs::write(bench.path("dome_3.png"), &bytes[..bytes.len() - 20]).unwrap();
    bench.save("dome_4.png", &picture(4, 30, 15));
    bench.save("dome_6.png", &picture(5, 32, 16));
    bench.save("dome_7.png", &flat(32, 16, &[0, 0, 0]));
    let output = bench.run(&["verify", "dome_#.png", "--frames", "1-10", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let faults = report["faults"].as_array().unwrap().iter();
    let named: Vec<(u64, &str)> =
        faults.map(|fault| (fault["frame"].as_u64().unwrap(), fault["fault"].as_str().unwrap())).collect();
    let expected = [(2, "missing"), (3, "damaged"), (4, "size"), (6, "frozen"), (7, "black"), (10, "missing")];
    assert!(expected.iter().all(|fault| named.contains(fault)), "{report}");
    assert_eq!(report["frames_with_faults"], "2-4,6,7,10", "{report}");
    let told = text(&bench.run(&["verify", "dome_#.png"]).stdout);
    assert_says(
        &told,
        &["missing: 2\n", "it ends too early", "of size 30x15 instead of 32x16: 4", "frames have faults: 2-4,6,7\n"],
    );
}

#[test]
fn a_frame_by_other_settings_is_found() {
    let bench = Bench::new();
    sequence(&bench, 3);
    let args = ["convert", "dome_#.png", "out_#.png", "--from", "equirect", "--to", "fisheye", "--size", "16"];
    bench.succeed(&args);
    bench.succeed(&[&args[..], &["--frames", "2", "-y", "--yaw", "3"]].concat());
    let output = bench.run(&["verify", "out_#.png", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["faults"], json!([{ "frame": 2, "fault": "settings" }]));
}

#[test]
fn a_sheet_shows_every_so_many_frames() {
    let bench = Bench::new();
    sequence(&bench, 7);
    bench.succeed(&["verify", "dome_#.png", "--sheet", "sheet.png", "--every", "2"]);
    // Frames 1, 3, 5 and 7, two by two.
    let sheet = bench.load("sheet.png");
    assert_eq!((sheet.width(), sheet.height()), (32 + 4 + 32, 16 + 4 + 16));
    let told = bench.fail(1, &["verify", "dome_#.png", "--sheet", "sheet.png"]);
    assert_says(&told, &["sheet.png", "-y"]);
    assert_says(&bench.fail(2, &["verify", "dome_#.png", "--sheet", "dome_3.png", "-y"]), &["would replace a frame"]);
}

#[test]
fn what_is_no_sequence_is_refused() {
    let bench = Bench::new();
    sequence(&bench, 2);
    assert_says(&bench.fail(2, &["verify", "dome_1.png"]), &["no frame marker", "####"]);
    assert_says(&bench.fail(2, &["verify", "{face}_#.png"]), &["{face}", "by itself"]);
    assert_says(&bench.fail(1, &["verify", "none_#.png"]), &["none_#.png"]);
    assert_says(&bench.fail(2, &["verify", "dome_#.png", "--every", "3"]), &["--sheet"]);
}
