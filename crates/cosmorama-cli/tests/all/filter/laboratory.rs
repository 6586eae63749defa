//! `filters`: every filter on one conversion.

use crate::bench::{Bench, assert_says, picture, text};
use serde_json::Value;

const TARGET: [&str; 4] = ["--to", "perspective:fov=60", "--size", "96"];

fn bench() -> Bench {
    let bench = Bench::new();
    bench.faces("face_", 512);
    bench
}

fn filters(bench: &Bench, more: &[&str]) -> String {
    bench.succeed(&[&["filters", "face_{face}.png"], &TARGET[..], more].concat())
}

#[test]
fn a_table_of_error_aliasing_blur_and_cost() {
    let bench = bench();
    let report: Value =
        serde_json::from_str(&filters(&bench, &["--only", "ewa,catmull,summed-area,point", "--json"])).unwrap();
    let of = |name: &str| report["filters"].as_array().unwrap().iter().find(|trial| trial["filter"] == name).unwrap();
    let number = |name: &str, key: &str| of(name)[key].as_f64().unwrap();
    assert!(number("ewa", "psnr_to_reference") > number("point", "psnr_to_reference") + 3.0, "{report}");
    assert!(number("ewa", "aliasing_db") < number("point", "aliasing_db") - 6.0, "{report}");
    assert!(number("ewa", "edge_width_px") > number("point", "edge_width_px"), "{report}");
    assert_eq!(number("point", "texels_a_pixel"), 1.0);
    assert!(of("ewa")["psnr_to_truth"].is_null());
    assert!(of("summed-area")["setup"]["bytes"].as_u64().unwrap() > 6 * 512 * 512);
    let csv = filters(&bench, &["--only", "ewa", "--csv"]);
    let lines: Vec<&str> = csv.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("filter,reference_dB,") && lines[1].starts_with("ewa,"), "{csv}");
    assert_eq!(lines[0].matches(',').count(), lines[1].matches(',').count());
    assert!(lines[0].contains(",setup_bytes,"), "{csv}");
    // A filter that is named twice has one row. People read memory in MiB.
    let table = filters(&bench, &["--only", "point,point"]);
    assert!(table.lines().count() == 2 && table.contains("setup MiB"), "{table}");
}

#[test]
fn one_frame_of_a_sequence() {
    let bench = Bench::new();
    (1..=2).for_each(|frame| bench.save(&format!("sky_{frame:02}.png"), &picture(frame, 64, 32)));
    let args =
        ["filters", "sky_##.png", "--from", "equirect", "--to", "perspective", "--size", "32", "--only", "point"];
    assert_says(&bench.fail(2, &args), &["2 frames", "--frames 1"]);
    assert_says(&bench.succeed(&[&args[..], &["--frames", "2"]].concat()), &["point"]);
}

#[test]
fn all_filters_in_one_table_with_crops_side_by_side() {
    let bench = bench();
    let table = filters(&bench, &["--output", "lab"]);
    for (name, _) in cosmorama_spec::FilterName::NAMES {
        assert!(table.lines().any(|line| line.split_whitespace().next() == Some(name)), "{name}: {table}");
    }
    assert!(bench.load("lab/crops.png").height() > 16 * 128);
    let args = [&["filters", "face_{face}.png"], &TARGET[..], &["--only", "point", "--output", "lab"]].concat();
    assert_says(&bench.fail(1, &args), &["crops.png", "exist"]);
    // A picture of no crop's size has none, and says so.
    let args =
        ["filters", "face_{face}.png", "--to", "perspective", "--size", "32", "--only", "point", "--output", "none"];
    let output = bench.run(&args);
    assert!(output.status.success() && !bench.path("none/crops.png").exists());
    assert_says(&text(&output.stderr), &["no crops", "64"]);
}

#[test]
fn a_direct_render_is_the_truth() {
    let bench = bench();
    bench.succeed(&[&["convert", "face_{face}.png", "direct.png", "--depth", "16"], &TARGET[..]].concat());
    let report: Value =
        serde_json::from_str(&filters(&bench, &["--only", "ewa,point", "--truth", "direct.png", "--json"])).unwrap();
    let psnr = |index: usize| report["filters"][index]["psnr_to_truth"].as_f64().unwrap();
    // Rounded to 16 bits.
    assert!(psnr(0) > 90.0 && psnr(1) < 60.0, "{report}");
    let args = ["filters", "face_{face}.png", "--to", "perspective", "--size", "64", "--truth", "direct.png"];
    assert_says(&bench.fail(2, &args), &["direct.png", "96x72", "--size"]);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let bench = bench();
    let fail = |args: &[&str], parts: &[&str]| assert_says(&bench.fail(2, &[&["filters"], args].concat()), parts);
    fail(&["builtin:demo", "--to", "fulldome"], &["formula", "convert"]);
    fail(&["face_{face}.png"], &["--to is missing"]);
    fail(&["face_{face}.png", "--to", "cube"], &["6 pictures", "one"]);
    fail(&["face_{face}.png", "--to", "fulldome", "--only", "ewa,sinc"], &["sinc"]);
    fail(&["face_{face}.png", "--to", "fulldome", "--json", "--csv"], &["--csv"]);
    fail(&["face_{face}.png", "--to", "fulldome", "--size", "1"], &["--size", "'1'", "16 pixels or more"]);
    fail(&["face_{face}.png", "--to", "fulldome", "--size", "64x9"], &["--size", "64x9", "16 pixels or more"]);
}

#[test]
fn figures_are_made() {
    let bench = Bench::new();
    bench.succeed(&["figures", "figures"]);
    for name in ["figure-5.png", "figure-6.png"] {
        let figure = bench.load(&format!("figures/{name}"));
        assert!(figure.width() > 400 && figure.height() > 200, "{name}: {} x {}", figure.width(), figure.height());
    }
    for name in ["figure-3", "figure-4", "figure-7-screen", "figure-7-texture", "figure-8", "figure-9"] {
        let svg = text(&bench.bytes(&format!("figures/{name}.svg")));
        let shapes = ["<path", "<rect", "<ellipse", "<image"].map(|shape| svg.matches(shape).count());
        assert!(svg.starts_with("<svg") && shapes.iter().sum::<usize>() > 10, "{name}: {shapes:?}");
    }
}

#[test]
fn figures_replace_nothing_unasked() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("figures")).unwrap();
    std::fs::write(bench.path("figures/figure-8.svg"), "mine").unwrap();
    assert_says(&bench.fail(1, &["figures", "figures"]), &["figure-8.svg", "exist", "-y"]);
}

#[test]
fn pictures_of_papers_need_a_folder_and_memory() {
    let bench = Bench::new();
    std::fs::write(bench.path("mine"), "mine").unwrap();
    for verb in ["figures", "plates", "demo"] {
        let message = bench.fail(2, &[verb, "mine"]);
        assert_says(&message, &["mine is a file, where a folder was expected", "name another"]);
    }
    assert_says(&bench.fail(1, &["figures", "new", "--memory", "1M"]), &["96.0 MiB", "raise --memory"]);
    let message = bench.fail(1, &["plates", "new", "--memory", "1G", "--size", "4k"]);
    assert_says(&message, &["6.0 GiB", "raise --memory"]);
    assert!(!bench.path("new").exists());
}
