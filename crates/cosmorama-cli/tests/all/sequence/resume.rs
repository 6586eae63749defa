//! What `--resume` promises: nothing that is complete is made again, and all else is.

use crate::bench::{Bench, assert_says, flat, picture};
use serde_json::Value;

#[test]
fn resume_keeps_what_is_complete_and_makes_the_rest() {
    let bench = Bench::new();
    for frame in 1..=5 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args = ["convert", "sky_#.png", "out_#.png", "--to", "fisheye", "--size", "32", "--json"];
    bench.succeed(&args);
    let made: Vec<Vec<u8>> = (1..=5).map(|frame| bench.bytes(&format!("out_{frame}.png"))).collect();
    // Complete but different, truncated, of another size, gone, of other channels: only the first may stay.
    bench.save("out_1.png", &flat(32, 32, &[1, 2, 3]));
    std::fs::write(bench.path("out_2.png"), &made[1][..made[1].len() / 2]).unwrap();
    bench.save("out_3.png", &flat(16, 16, &[1, 2, 3]));
    std::fs::remove_file(bench.path("out_4.png")).unwrap();
    bench.save("out_5.png", &flat(32, 32, &[1]));
    let output = bench.run(&[&args[..], &["--resume"]].concat());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&4.into(), &1.into()));
    // What was there and is not kept is told, each with its reason; what was not there is no news.
    let reasons = [
        ("out_2.png", "damaged or truncated PNG: it ends too early"),
        ("out_3.png", "16x16 instead of 32x32"),
        ("out_5.png", "grey instead of RGB"),
    ];
    let told = crate::bench::text(&output.stderr);
    let remade = report["remade"].as_array().unwrap();
    assert_eq!(remade.len(), reasons.len(), "{remade:?}");
    for ((file, reason), one) in reasons.into_iter().zip(remade) {
        assert_eq!((&one["output"], &one["reason"]), (&file.into(), &reason.into()));
        crate::bench::assert_says(&told, &["warning: --resume: 3 outputs", &format!("{file} ({reason})")]);
        assert!(report["warnings"].to_string().contains(file), "{report}");
    }
    assert_eq!(bench.load("out_1.png"), flat(32, 32, &[1, 2, 3]));
    for frame in 2..=5 {
        assert!(bench.bytes(&format!("out_{frame}.png")) == made[frame - 1], "frame {frame}");
    }
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--resume"]].concat())).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &5.into()));
    assert!(report["remade"].as_array().unwrap().is_empty() && !report["warnings"].to_string().contains("--resume"));
    bench.succeed(&[&args[..], &["-y"]].concat());
    assert!(bench.bytes("out_1.png") == made[0]);
}

#[cfg(unix)]
#[test]
fn resume_makes_again_what_is_of_another_format_or_no_file() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let args = ["--to", "fisheye", "--size", "32", "--json"];
    bench.succeed(&[&["convert", "sky.png", "out.jpg"], &args[..]].concat());
    std::fs::rename(bench.path("out.jpg"), bench.path("out.png")).unwrap();
    let again = [&["convert", "sky.png", "out.png", "--resume"], &args[..]].concat();
    let report: Value = serde_json::from_str(&bench.succeed(&again)).unwrap();
    assert_eq!(report["remade"][0]["reason"], "JPEG instead of PNG", "{report}");
    std::fs::remove_file(bench.path("out.png")).unwrap();
    // To read it would take for ever: nobody writes. And what is no file is not replaced.
    assert!(std::process::Command::new("mkfifo").arg(bench.path("out.png")).status().unwrap().success());
    let message = bench.fail(1, &again);
    assert_says(&message, &["cannot write out.png", "a pipe or a device"]);
}

#[test]
fn resume_knows_its_own_outputs_in_every_format() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let formats = ["png", "jpg", "tif", "tga", "hdr", "exr"].map(|end| (format!("out.{end}"), "--to=fisheye"));
    let textures = ["ktx2", "dds"].map(|end| (format!("out.{end}"), "--to=cube"));
    for (out, to) in formats.iter().chain(&textures) {
        resumed(&bench, &["convert", "sky.png", out, to, "--size", "16", "--from=equirect"]);
    }
    for depth in ["half", "float"] {
        let out = format!("{depth}.exr");
        let args = ["convert", "sky.png", &out, "--to=fisheye", "--size=16", "--from=equirect", "--st-map", "--depth"];
        resumed(&bench, &[&args[..], &[depth]].concat());
    }
    resumed(&bench, &["convert", "builtin:grid", "grid.png", "--to=fisheye", "--size=32"]);
    // Whether numbers without a picture are whole cannot be told.
    let args = ["convert", "builtin:direction-map", "map.exr", "--to=fisheye", "--size=32", "--resume"];
    crate::bench::assert_says(&bench.fail(2, &args), &["--resume", "builtin:direction-map", "--overwrite"]);
}

#[test]
fn frames_by_other_settings_or_of_other_inputs_are_no_part_of_it() {
    for end in ["png", "exr", "tif", "jpg", "hdr"] {
        let bench = Bench::new();
        for frame in 1..=3 {
            bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
        }
        let out = format!("out_#.{end}");
        let args = ["convert", "sky_#.png", &out, "--to", "fisheye", "--size", "16", "--from", "equirect"];
        bench.succeed(&args);
        let resume = [&args[..], &["--resume"]].concat();
        let report: Value = serde_json::from_str(&bench.succeed(&[&resume[..], &["--json"]].concat())).unwrap();
        assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &3.into()), "{end}: {report}");
        for (more, part) in [
            (["--yaw", "20"], "other geometry"),
            (["--filter", "point"], "other filter"),
            (["--background", "red"], "other colours"),
        ] {
            let told = bench.fail(1, &[&resume[..], &more].concat());
            assert_says(&told, &["--resume", &format!("out_1.{end} was made with"), part, "-y"]);
        }
        bench.save("sky_2.png", &picture(7, 64, 32));
        let told = bench.fail(1, &resume);
        assert_says(&told, &[&format!("out_2.{end} was made with other inputs")]);
        // A frame of another number, in its place.
        bench.save("sky_2.png", &picture(2, 64, 32));
        std::fs::copy(bench.path(&format!("out_3.{end}")), bench.path(&format!("out_1.{end}"))).unwrap();
        assert_says(&bench.fail(1, &resume), &[&format!("out_1.{end} was made with other inputs")]);
    }
}

/// Makes a picture; what is made is kept when it is asked for again.
#[track_caller]
fn resumed(bench: &Bench, args: &[&str]) {
    bench.succeed(args);
    let report: Value =
        serde_json::from_str(&bench.succeed(&[args, &["--resume", "--json"]].concat())).expect("a report");
    assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &1.into()), "{args:?}: {report}");
}
