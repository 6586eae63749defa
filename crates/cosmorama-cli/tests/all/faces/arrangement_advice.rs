//! What is advised for faces that lie wrongly is what happened to them.

use crate::bench::{Bench, assert_says, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Transfer};
use serde_json::{Value, json};

/// The faces of the demo's arcade.
fn world() -> Bench {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "{face}.png", "--to", "cube:naming=words", "--size", "96"]);
    bench
}

/// They in one image.
fn sheet(to: &str) -> Bench {
    let bench = world();
    bench.succeed(&["convert", "{face}.png", "sheet.png", "--to", to, "--size", "96"]);
    bench
}

fn report(bench: &Bench, input: &str) -> Value {
    serde_json::from_str(&bench.succeed(&["info", input, "--json"])).unwrap()
}

fn arrangement(bench: &Bench, input: &str) -> Value {
    report(bench, input)["arrangement"].clone()
}

fn rename(bench: &Bench, cycle: &[&str]) {
    let path = |name: &str| bench.path(&format!("{name}.png"));
    std::fs::rename(path(cycle[0]), path("between")).unwrap();
    cycle.windows(2).for_each(|pair| std::fs::rename(path(pair[1]), path(pair[0])).unwrap());
    std::fs::rename(path("between"), path(cycle[cycle.len() - 1])).unwrap();
}

#[test]
fn layouts_of_one_shape_are_told_from_each_other() {
    for (made, given) in [("eac", "3x2"), ("3x2", "eac")] {
        for flip in ["", ",flip=x"] {
            let spec = format!("cube:layout={made}{flip}");
            let bench = sheet(&spec);
            let from = format!("cube:layout={given}");
            let run =
                bench.run(&["convert", "sheet.png", "out.png", "--from", &from, "--to", "equirect", "--size", "64"]);
            let message = text(&run.stderr);
            assert_says(&message, &["warning: ", &format!("layout={made} has them"), &format!("--from {spec}")]);
            // The mirror image is read in that layout, too.
            assert_eq!(message.contains("order="), !flip.is_empty(), "{message}");
            assert!(!message.contains(&format!("--from {from}")), "{message}");
        }
        let bench = sheet(&format!("cube:layout={made}"));
        let report = report(&bench, "sheet.png");
        let spec = format!("cube:layout={made}");
        assert_eq!((&report["arrangement"]["fits"], &report["arrangement"]["spec"]), (&json!(true), &json!(spec)));
        assert!(report["projection"].as_str().unwrap().starts_with(&format!("{spec} (by its shape")), "{report}");
    }
}

#[test]
fn two_swaps_are_not_a_world_upside_down() {
    let bench = world();
    rename(&bench, &["left", "right"]);
    rename(&bench, &["top", "bottom"]);
    let swaps = json!(["right and left are swapped", "up and down are swapped"]);
    let told = arrangement(&bench, "{face}.png");
    assert_eq!(told["changes"], swaps);
    assert_says(told["told"].as_str().unwrap(), &["do that with the files"]);
    let bench = sheet("cube:layout=strip-h,order=lrdufb");
    let told = arrangement(&bench, "sheet.png");
    assert_eq!(told["changes"], swaps);
    assert_eq!(told["spec"], "cube:layout=strip-h,order=lrdufb,rotate=000000");
}

#[test]
fn faces_that_move_and_turn_are_called_by_what_they_were_given_as() {
    let bench = world();
    rename(&bench, &["front", "top"]);
    let light = bench.load("back.png").to_light(&Transfer::Srgb);
    let turned = Image::from_fn(96, 96, |i, j| *light.get(j, 95 - i));
    bench.save("back.png", &EncodedImage::encode(&turned, Channels::Rgb, Depth::Eight, &Transfer::Srgb));
    let told = arrangement(&bench, "{face}.png");
    let parts =
        ["front and up are swapped, back has to be turned clockwise by 270", "by the face that it was given as"];
    assert_says(told["told"].as_str().unwrap(), &parts);
    rename(&bench, &["front", "top"]);
    assert!(!arrangement(&bench, "{face}.png")["told"].as_str().unwrap().contains("given as"));
}

#[test]
fn orders_are_for_one_image() {
    let bench = world();
    let to = ["--to", "equirect", "--size", "32"];
    for (from, parts) in [
        ("cube:order=envutil", ["order= is for faces in one image", "naming=", "rename it"]),
        ("cube:layout=3x2", ["a file for each face", "layout=3x2", "in one image"]),
    ] {
        assert_says(&bench.fail(2, &[&["convert", "{face}.png", "out.png", "--from", from], &to[..]].concat()), &parts);
    }
}

#[test]
fn samples_are_not_said_to_lie_on_edges_without_need() {
    for (order, spec) in [("envutil", "order=envutil"), ("openexr,samples=centres", "order=envutil")] {
        let bench = sheet(&format!("cube:layout=strip-h,order={order}"));
        assert_eq!(arrangement(&bench, "sheet.png")["spec"], format!("cube:layout=strip-h,{spec}"));
    }
    // A file that says so is believed.
    let bench = world();
    bench.succeed(&["convert", "{face}.png", "cube.exr", "--to", "cube:samples=edges", "--size", "96"]);
    let args = ["convert", "cube.exr", "out.png", "--from", "cube:layout=strip-v,order=rludfb"];
    let run = bench.run(&[&args[..], &["--to", "equirect", "--size", "64"]].concat());
    assert_says(&text(&run.stderr), &["--from cube:layout=strip-v,order=openexr"]);
}
