//! Messages on standard error: what was decided and why, for people and for programs.

use serde_json::Value;

use crate::bench::{Bench, assert_says, picture, text};

const TO: [&str; 6] = ["--to", "fulldome", "--size", "16", "-y", "--progress"];

/// What a conversion of a panorama says, with more words and a `RUST_LOG`.
fn said(bench: &Bench, more: &[&str], asked: &str) -> String {
    let args = [&["convert", "sky.png", "dome.png"][..], &TO, &["none"], more].concat();
    let output = bench.command(&args).env("RUST_LOG", asked).output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout), "");
    text(&output.stderr)
}

fn records(lines: &str) -> Vec<Value> {
    lines.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"))).collect()
}

#[test]
fn decisions_are_told_with_their_reasons() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    assert_eq!(said(&bench, &[], ""), "");
    let told = said(&bench, &["-v", "--threads", "2", "--memory", "500M"], "");
    let expected = [
        "note: sky.png is taken for a panorama",
        "input: sky.png: 1 view of 1 world, 1 used, 2048 texels",
        "projection: sky.png is taken for a panorama (--from equirect), because it is twice as wide as high",
        "projection: dome.png is fulldome, as --to says; size 16x16, as --size says",
        "colour: sky.png: PNG, 64x32, RGB of 8, srgb as it says, Rec. 709",
        "colour: dome.png: RGB of 8, srgb, Rec. 709, as the first input",
        "filter: ewa, kernel adaptive, anti-ringing on, in integers, because inputs and outputs are opaque and of 8 bits",
        "memory: 500.0 MiB may be used, as --memory says",
        "2 threads, as --threads says",
        "frames: 1 frame to make",
        "geometry: computed with the picture, and not kept, because it is the only one",
    ];
    assert_says(&told, &expected);
    assert!(!told.contains("from sky.png"), "no detail without -vv: {told}");
    assert_says(&said(&bench, &["-vv"], ""), &["frames: the picture: dome.png (", "from sky.png"]);
    let other = said(&bench, &["-v", "--from", "equirect", "--filter", "bilinear", "--transfer", "linear"], "");
    assert_says(
        &other,
        &["sky.png is equirect, as --from says", "linear by --transfer", "filter: bilinear", "in integers"],
    );
    let float = said(&bench, &["-v", "--depth", "16"], "");
    assert_says(&float, &["RGB of 16", "in floats"]);
}

#[test]
fn sequences_tell_of_plans_and_queues() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args =
        [&["convert", "sky_#.png", "dome_#.png", "--from", "equirect", "-vv", "--threads", "2"][..], &TO].concat();
    let told = text(&bench.run(&[&args[..], &["openjd"]].concat()).stderr);
    let expected = [
        "geometry: kept in 1 plan of",
        "frames: 3 read and 3 made or written at once",
        "frames: frame 3: dome_3.png (",
    ];
    assert_says(&told, &expected);
    // Whatever else is said, lines for the engine begin where lines begin.
    assert_eq!(told.lines().filter(|line| line.starts_with("openjd_progress: ")).count(), 4, "{told}");
    assert_eq!(told.matches("openjd_").count(), 4, "{told}");
    let resumed = [
        &["convert", "sky_#.png", "dome_#.png", "--from", "equirect", "-v"][..],
        &TO[..4],
        &["--resume", "--progress", "openjd"],
    ]
    .concat();
    let told = text(&bench.run(&resumed).stderr);
    assert_says(&told, &["frames: 0 frames to make, 4 outputs kept, because they are whole and made alike"]);
    // An engine waits for the end, though there is nothing to do.
    assert_says(&told, &["openjd_progress: 100.00\n"]);
}

#[test]
fn records_for_programs_are_an_object_a_line() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args = [&["convert", "sky_#.png", "dome_#.png", "--log-format", "json", "-v"][..], &TO[..5]].concat();
    let told = text(&bench.run(&args).stderr);
    let records = records(&told);
    let of = |target: &str| records.iter().filter(|record| record["target"] == target).collect::<Vec<_>>();
    let [filter] = of("cosmorama::filter")[..] else { panic!("{told}") };
    assert_eq!(filter["level"], "INFO");
    assert!(filter["message"].as_str().unwrap().starts_with("ewa, kernel adaptive"), "{filter}");
    assert!(filter["timestamp"].as_str().unwrap().ends_with('Z'), "{filter}");
    assert_eq!(of("cosmorama::message")[0]["code"], "Detected");
    assert!(of("cosmorama::report")[0]["message"].as_str().unwrap().starts_with("3 files of 3 frames in "), "{told}");
    // Progress is JSON by itself there.
    assert_eq!(records.iter().filter(|record| record["done"] == 2).count(), 1, "{told}");
    let failed = bench.run(&["convert", "none.png", "out.png", "--to", "fulldome", "--log-format", "json"]);
    let [record] = &self::records(&text(&failed.stderr))[..] else { panic!("{}", text(&failed.stderr)) };
    assert_eq!((failed.status.code(), &record["level"]), (Some(1), &"ERROR".into()));
    assert!(record["message"].as_str().unwrap().contains("none.png"), "{record}");
}

#[test]
fn the_environment_chooses_by_topic_and_hides_no_warning() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let told = said(&bench, &[], "cosmorama::memory=info");
    assert!(told.starts_with("memory: ") && told.lines().count() == 1, "{told}");
    assert_says(&said(&bench, &[], "info"), &["filter: ", "note: sky.png"]);
    assert!(said(&bench, &[], "cosmorama=debug").contains("from sky.png"));
    assert_eq!(said(&bench, &[], "some_other_program=trace"), "");
    // What is asked for by name is heeded beside -v.
    let told = said(&bench, &["-v"], "cosmorama::filter=off");
    assert!(told.contains("memory: ") && !told.contains("filter: "), "{told}");
    let warned = said(&bench, &["--kernel", "mitchell", "--filter", "point"], "off");
    assert_says(&warned, &["warning: --kernel and --anti-ringing have no effect"]);
    let wrong = said(&bench, &[], "cosmorama=loud");
    assert_says(&wrong, &["warning: RUST_LOG=cosmorama=loud is ignored", "RUST_LOG=info"]);
    let unknown = said(&bench, &[], "info,cosmorama::memroy=debug");
    assert_says(
        &unknown,
        &["warning: RUST_LOG=info,cosmorama::memroy=debug: cosmorama::memroy is no topic", "filter: "],
    );
    for topic in
        ["input", "projection", "colour", "filter", "geometry", "memory", "frames", "conversion", "mess", "rep"]
    {
        let told = said(&bench, &[], &format!("cosmorama::{topic}=debug"));
        assert!(!told.contains("no topic"), "{topic}: {told}");
        let has_records = !["conversion", "mess", "rep"].contains(&topic);
        assert_eq!(told.contains(&format!("{topic}: ")), has_records, "{topic}: {told}");
    }
    let failed = bench.command(&["convert", "none.png", "out.png", "--to", "fulldome"]).env("RUST_LOG", "off").output();
    assert_says(&text(&failed.unwrap().stderr), &["error: ", "none.png"]);
}

/// An engine is told of a failure in one line, whether work had begun or not.
#[test]
fn an_engine_is_told_why_a_job_fails() {
    let bench = Bench::new();
    bench.save("sky_1.png", &picture(1, 64, 32));
    std::fs::write(bench.path("sky_2.png"), &std::fs::read(bench.path("sky_1.png")).unwrap()[..60]).unwrap();
    for input in ["sky_#.png", "none_#.png"] {
        let args = [&["convert", input, "dome_#.png", "--from", "equirect"][..], &TO, &["openjd"]].concat();
        let told = text(&bench.run(&args).stderr);
        let of_engine: Vec<&str> = told.lines().filter(|line| line.starts_with("openjd_fail: ")).collect();
        assert_eq!(of_engine.len(), 1, "{told}");
        assert!(told.contains(&of_engine[0].replace("openjd_fail: ", "error: ")), "{told}");
    }
    let told = text(&bench.run(&["verify", "sky_#.png", "--progress", "openjd"]).stderr);
    assert!(told.ends_with("openjd_fail: frames with faults: 2\n"), "{told}");
    let wrong = "one\nopenjd_status: two";
    let args = [&["convert", "sky_#.png", "dome_#.png", "--frames", wrong][..], &TO, &["openjd"]].concat();
    let told = text(&bench.run(&args).stderr);
    assert!(told.contains("\nopenjd_fail: invalid value 'one   openjd_status: two' for '--frames"), "{told}");
    assert_eq!(told.lines().filter(|line| line.starts_with("openjd_")).count(), 1, "{told}");
}

/// A name may hold what a terminal obeys, or what looks like a line for an engine.
#[test]
#[cfg(unix)]
fn no_name_of_a_file_passes_for_a_line() {
    let bench = Bench::new();
    let name = "sky\nopenjd_fail: no\u{1b}[2J\u{9b}.png";
    bench.save("sky.png", &picture(1, 64, 32));
    std::fs::rename(bench.path("sky.png"), bench.path(name)).unwrap();
    for more in [&["-v"][..], &["-v", "--log-format", "json"]] {
        let args = [&["convert", name, "dome.png"][..], &TO, &["none"], more].concat();
        let told = text(&bench.run(&args).stderr);
        assert!(told.contains("openjd_fail: no"), "{told}");
        assert!(!told.lines().any(|line| line.starts_with("openjd_")), "{told}");
        assert!(!told.contains(|c: char| c.is_control() && c != '\n'), "{told:?}");
    }
}
