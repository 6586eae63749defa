//! `--plan-cache`: the same pictures, whatever is in the folder.

use std::path::PathBuf;

use crate::bench::{Bench, flat, picture};
use serde_json::Value;

const ARGS: [&str; 9] =
    ["convert", "face_{face}.png", "out.png", "--to", "fulldome", "--size", "64", "-y", "--plan-cache=plans"];

/// Six faces, the picture that is made of them, and what a conversion with a cache makes and says.
struct Cached {
    bench: Bench,
    expected: Vec<u8>,
}

impl Cached {
    fn new() -> Self {
        let bench = Bench::new();
        bench.faces("face_", 48);
        bench.succeed(&ARGS[..8]);
        let expected = bench.bytes("out.png");
        Self { bench, expected }
    }

    /// Converts; the picture must be what it is without a cache. What was warned of.
    #[track_caller]
    fn convert(&self, more: &[&str]) -> Vec<String> {
        let out = self.bench.succeed(&[&ARGS[..], &["--json"], more].concat());
        assert!(self.bench.bytes("out.png") == self.expected, "another picture");
        let report: Value = serde_json::from_str(&out).unwrap();
        report["warnings"].as_array().unwrap().iter().map(|warning| warning.as_str().unwrap().to_owned()).collect()
    }

    fn plans(&self) -> Vec<PathBuf> {
        self.bench.files().into_iter().filter(|path| path.to_string_lossy().contains("/plans/")).collect()
    }
}

#[test]
fn a_plan_is_kept_and_serves_again() {
    let cached = Cached::new();
    assert_eq!(cached.convert(&[]), [""; 0]);
    let [plan] = &cached.plans()[..] else { panic!("one plan: {:?}", cached.plans()) };
    let (bytes, time) = (std::fs::read(plan).unwrap(), plan.metadata().unwrap().modified().unwrap());
    assert_eq!(cached.convert(&["--threads", "1"]), [""; 0]);
    assert_eq!(plan.metadata().unwrap().modified().unwrap(), time, "it is not written again");
    // Another conversion has a plan of its own, and so has a picture of more bits.
    cached.bench.succeed(&[&ARGS[..], &["--yaw", "1"]].concat());
    cached.bench.succeed(&[&ARGS[..], &["--depth", "16"]].concat());
    assert_eq!((cached.plans().len(), std::fs::read(plan).unwrap()), (3, bytes));
    std::fs::remove_dir_all(cached.bench.path("plans")).unwrap();
    assert_eq!(cached.convert(&[]), [""; 0]);
}

#[test]
fn sequences_and_memory_are_the_same_with_plans_that_are_kept() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args = ["convert", "sky_#.png", "out_#.png", "--from=equirect", "--to", "fisheye", "--size", "128", "-y"];
    let outputs = |more: &[&str]| -> Vec<Vec<u8>> {
        bench.succeed(&[&args[..], more].concat());
        (1..=3).map(|frame| bench.bytes(&format!("out_{frame}.png"))).collect()
    };
    let plain = outputs(&[]);
    for more in [&["--memory", "1200K"][..], &[], &["--memory", "1200K"], &[]] {
        assert!(outputs(&[more, &["--plan-cache", "a/b"]].concat()) == plain, "{more:?}");
    }
    assert_eq!(bench.files().iter().filter(|path| path.extension().is_some_and(|end| end == "plan")).count(), 1);
}

#[test]
fn plans_that_are_not_kept_are_told_of() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args =
        ["convert", "sky_#.png", "out_#.png", "--from=equirect", "--to=fisheye", "--size", "128", "-y", "--json"];
    let warnings = |more: &[&str]| -> Vec<String> {
        let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], more].concat())).unwrap();
        report["warnings"].as_array().unwrap().iter().map(|warning| warning.as_str().unwrap().to_owned()).collect()
    };
    let cache = "--plan-cache=plans";
    for (more, told) in [
        (&["--memory", "1200K"][..], "computed anew for each frame; give more with --memory"),
        (&["--memory", "1200K", "--filter", "ewa-pyramid"], "computed anew for each frame; give more with --memory"),
        (&["--memory", "1200K", cache], "none is kept; give more with --memory"),
        (&["--filter", "reference", "--frames", "1", cache], "with --filter ewa they are"),
        (&["--filter", "ewa-pyramid", cache], "with --filter ewa they are"),
    ] {
        let warnings = warnings(more);
        assert!(warnings.len() == 1 && warnings[0].ends_with(told), "{more:?}: {warnings:?}");
    }
    assert_eq!([warnings(&[]), warnings(&["--memory", "1200K", "--frames", "1"])], [[""; 0], [""; 0]]);
}

#[test]
fn what_is_wrong_with_a_plan_is_told_and_mended() {
    let cached = Cached::new();
    cached.convert(&[]);
    let plan = cached.plans().remove(0);
    let whole = std::fs::read(&plan).unwrap();
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 4;
        bytes
    };
    cached.bench.succeed(&[&ARGS[..], &["--yaw", "1"]].concat());
    let other = cached.plans().into_iter().find(|path| *path != plan).unwrap();
    for (bytes, told) in [
        (whole[..whole.len() / 2].to_vec(), "damaged or truncated"),
        (Vec::new(), "not a plan"),
        (b"cosmorama plan, but not one of ours, and long enough to be one\n".to_vec(), "not a plan"),
        (flipped(whole.len() - 9), "damaged or truncated"),
        (flipped(16), "a plan of version"),
        (std::fs::read(&other).unwrap(), "the plan of another conversion"),
    ] {
        std::fs::write(&plan, bytes).unwrap();
        let warnings = cached.convert(&[]);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        crate::bench::assert_says(
            &warnings[0],
            &[&plan.file_name().unwrap().to_string_lossy(), told, "the plan is computed"],
        );
        assert!(std::fs::read(&plan).unwrap() == whole, "{told}: it is whole again");
        assert_eq!(cached.convert(&[]), [""; 0]);
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_told_and_done_without() {
    let cached = Cached::new();
    std::fs::write(cached.bench.path("plans"), "a file").unwrap();
    let warnings = cached.convert(&[]);
    assert!(warnings.len() == 1 && warnings[0].contains("--plan-cache plans is no folder"), "{warnings:?}");
    // Nor can there be one below it: that is told once.
    let output = cached.bench.succeed(&[&ARGS[..8], &["--plan-cache=plans/new", "--json"]].concat());
    let report: Value = serde_json::from_str(&output).unwrap();
    let [warning] = &report["warnings"].as_array().unwrap()[..] else { panic!("one warning: {report}") };
    let parts =
        ["--plan-cache plans/new: the plan is not kept", "the folder plans/new cannot be made", "choose another"];
    crate::bench::assert_says(warning.as_str().unwrap(), &parts);
    std::fs::remove_file(cached.bench.path("plans")).unwrap();
    cached.convert(&[]);
    let plan = cached.plans().remove(0);
    // Where the plan should be there is a folder: neither read nor replaced.
    std::fs::remove_file(&plan).unwrap();
    std::fs::create_dir(&plan).unwrap();
    let warnings = cached.convert(&[]);
    assert!(
        warnings[0].contains("the plan is computed") && warnings[1].contains("the plan is not kept"),
        "{warnings:?}"
    );
}

#[test]
fn programs_that_keep_the_same_plan_do_not_disturb_each_other() {
    let cached = Cached::new();
    let start = |k: usize| {
        let out = format!("many_{k}.png");
        let args = [&ARGS[..2], &[&out], &ARGS[3..]].concat();
        cached.bench.command(&args).stderr(std::process::Stdio::null()).spawn().unwrap()
    };
    let programs: Vec<_> = (0..6).map(start).collect();
    for (k, mut program) in programs.into_iter().enumerate() {
        assert!(program.wait().unwrap().success());
        assert!(cached.bench.bytes(&format!("many_{k}.png")) == cached.expected);
    }
    assert_eq!(cached.plans().len(), 1, "one plan and nothing half written");
    assert_eq!(cached.convert(&[]), [""; 0]);
}

#[test]
fn where_no_picture_is_filtered_there_is_nothing_to_keep() {
    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[9, 9, 9]));
    for args in [
        &["convert", "builtin:grid", "out.png", "--to", "fisheye", "--size", "32", "--plan-cache", "plans"][..],
        &["convert", "sky.png", "out.exr", "--to", "fisheye", "--size", "32", "--st-map", "--plan-cache", "plans"],
    ] {
        crate::bench::assert_says(&bench.fail(2, args), &["--plan-cache"]);
    }
}
