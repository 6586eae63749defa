//! What running promises: threads, frames, resuming, reports, interrupts.

mod bench;

use bench::{Bench, flat, picture};
use cosmorama::sphere::CubeFace;
use serde_json::Value;

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let bench = Bench::new();
    bench.faces("face_", 128);
    for filter in ["ewa", "ewa-pyramid", "bilinear", "reference:samples=2"] {
        let bytes = |threads: &str| {
            let args = ["convert", "face_{face}.png", "out.png", "--to", "omnimax", "--size", "200", "-y"];
            bench.succeed(&[&args[..], &["--filter", filter, "--threads", threads]].concat());
            bench.bytes("out.png")
        };
        let one = bytes("1");
        assert!(one == bytes("2") && one == bytes("7"), "{filter}");
    }
}

#[test]
fn a_sequence_is_the_same_as_its_frames() {
    let bench = Bench::new();
    for frame in 1..=3 {
        for face in CubeFace::ALL {
            bench.save(&format!("{face}/{face}_{frame:04}.png"), &picture(frame + face as usize, 48, 48));
        }
    }
    let args = ["convert", "{face}/{face}_####.png", "dome_%03d.png", "--to", "fulldome", "--size", "64"];
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--json"]].concat())).unwrap();
    assert_eq!((&report["frames"], report["inputs"].as_array().unwrap().len()), (&3.into(), 15));
    for frame in 1..=3 {
        let input = format!("{{face}}/{{face}}_{frame:04}.png");
        bench.succeed(&["convert", &input, "one.png", "--to", "fulldome", "--size", "64", "-y"]);
        assert!(bench.bytes("one.png") == bench.bytes(&format!("dome_{frame:03}.png")), "frame {frame}");
    }
}

#[test]
fn a_plan_that_does_not_fit_is_done_without() {
    let bench = Bench::new();
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 128, 64));
    }
    let bytes = |memory: &str| {
        let args =
            ["convert", "sky_#.png", "dome_#.png", "--to", "fulldome", "--size", "256", "-y", "--memory", memory];
        bench.succeed(&args);
        bench.bytes("dome_2.png")
    };
    assert!(bytes("3M") == bytes("1G"));
}

#[test]
fn what_is_not_needed_takes_no_memory() {
    let bench = Bench::new();
    bench.faces("face_", 256);
    // The light of six faces would take 8 MB.
    let args = ["convert", "face_{face}.png", "out.png", "--to", "perspective:fov=60", "--size", "32x32"];
    bench.succeed(&[&args[..], &["--memory", "4M"]].concat());
    let message = bench.fail(1, &[&args[..], &["--memory", "1M", "-y"]].concat());
    assert!(message.contains("--memory"), "{message}");
}

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
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--resume"]].concat())).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&4.into(), &1.into()));
    assert_eq!(bench.load("out_1.png"), flat(32, 32, &[1, 2, 3]));
    for frame in 2..=5 {
        assert!(bench.bytes(&format!("out_{frame}.png")) == made[frame - 1], "frame {frame}");
    }
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--resume"]].concat())).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &5.into()));
    bench.succeed(&[&args[..], &["-y"]].concat());
    assert!(bench.bytes("out_1.png") == made[0]);
}

#[test]
fn the_report_is_all_there() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let out = bench.succeed(&["convert", "sky.png", "out.png", "--to", "fulldome", "--size", "32", "--json"]);
    let report: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&report["inputs"][0], &report["outputs"][0]), (&"sky.png".into(), &"out.png".into()));
    assert_eq!(report["frames"], 1);
    for stage in ["decode", "plan", "filter", "encode"] {
        assert!(report["cpu_seconds"][stage].as_f64().unwrap() >= 0.0, "{stage}");
    }
    assert!(report["wall_seconds"].as_f64().unwrap() > 0.0);
    assert!(report["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
    assert!(report["warnings"][0].as_str().unwrap().contains("--from equirect"));
}

#[test]
fn progress_for_machines() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let progress = |style: &str| {
        let args = ["convert", "sky_#.png", "out_#.png", "--to", "fisheye", "--size", "16", "-y", "--from", "equirect"];
        bench::text(&bench.run(&[&args[..], &["--progress", style]].concat()).stderr)
    };
    let openjd = "openjd_progress: 25.00\nopenjd_progress: 50.00\nopenjd_progress: 75.00\nopenjd_progress: 100.00\n";
    assert_eq!(progress("openjd"), openjd);
    let lines = progress("json");
    let last: Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
    assert_eq!((&last["done"], &last["total"], &last["frame"]), (&4.into(), &4.into(), &4.into()));
    assert_eq!(progress("none"), "");
    let told = progress("auto");
    assert!(told.contains("frame 2: 2 of 4 done") && told.contains("4 files of 4 frames in"), "{told}");
}

#[test]
#[cfg(unix)]
fn an_interrupt_leaves_nothing_behind() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let bench = Bench::new();
        bench.save("sky.png", &picture(1, 256, 128));
        let before = bench.files();
        let args =
            ["convert", "sky.png", "out.png", "--to", "fulldome", "--size", "3000", "--filter", "reference:samples=8"];
        let mut child = bench.command(&args).stderr(std::process::Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(700));
        let kill = std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(code));
        assert_eq!(bench.files(), before);
    }
}
