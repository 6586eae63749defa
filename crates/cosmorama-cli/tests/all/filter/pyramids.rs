//! `--filter ewa-pyramid`, from files to files.

use crate::bench::{Bench, picture};
use serde_json::Value;

/// A face set of 256², so that a dome of 40² has ten texels a pixel.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.faces("face_", 256);
    bench
}

/// Two levels, interpolated, of a detailed world, where a pixel holds 4, 16 and 64 texels each way.
#[test]
fn the_demo_is_within_forty_decibels_of_ewa_at_any_shrink() {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "{face}.png", "--to", "cube", "--size", "512"]);
    for size in ["201", "50", "13"] {
        for filter in ["ewa", "ewa-pyramid"] {
            let output = format!("{filter}.exr");
            let turned = ["--yaw", "20", "--pitch", "35", "--roll", "10", "--depth", "float", "-y"];
            let args = ["convert", "{face}.png", &output, "--to", "fulldome", "--size", size, "--filter", filter];
            bench.succeed(&[&args[..], &turned].concat());
        }
        bench.succeed(&["compare", "ewa.exr", "ewa-pyramid.exr", "--region", "disc", "--min-psnr", "40"]);
    }
}

#[test]
fn a_small_dome_is_near_to_ewa_and_takes_fewer_texels() {
    let bench = bench();
    let target = ["--to", "fulldome", "--size", "40"];
    for (depth, extension) in [("8", "png"), ("16", "png"), ("half", "exr")] {
        for filter in ["ewa", "ewa-pyramid"] {
            let output = format!("{filter}.{extension}");
            let args = ["convert", "face_{face}.png", &output, "--filter", filter, "--depth", depth, "-y"];
            bench.succeed(&[&args[..], &target].concat());
        }
        bench.succeed(&[
            "compare",
            &format!("ewa.{extension}"),
            &format!("ewa-pyramid.{extension}"),
            "--min-psnr",
            "40",
        ]);
    }
    let gathered = |filter| -> Value {
        let args = ["explain", "face_{face}.png", "--filter", filter, "--json"];
        serde_json::from_str(&bench.succeed(&[&args[..], &target].concat())).unwrap()
    };
    let [exact, pyramid] = ["ewa", "ewa-pyramid"].map(gathered);
    assert_eq!(exact[0]["memory_bytes"]["levels"], 0);
    assert!(pyramid[0]["memory_bytes"]["levels"].as_u64() > Some(100_000));
    let text = bench.succeed(&[&["explain", "face_{face}.png", "--filter", "ewa-pyramid"][..], &target].concat());
    assert!(text.contains("the filter's own tables"), "{text}");
}

#[test]
fn where_a_pixel_holds_one_texel_it_is_ewa() {
    let bench = bench();
    for filter in ["ewa", "ewa-pyramid"] {
        let args = ["convert", "face_{face}.png", &format!("{filter}.exr"), "--to", "fulldome", "--size", "400"];
        bench.succeed(&[&args[..], &["--filter", filter, "--depth", "float"]].concat());
    }
    assert!(bench.bytes("ewa.exr") == bench.bytes("ewa-pyramid.exr"));
}

#[test]
fn a_sequence_by_pyramid_is_the_same_as_its_frames() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 400, 200));
    }
    let how = ["--to", "fulldome", "--size", "24", "--filter", "ewa-pyramid", "--compression", "balanced", "-y"];
    // With the geometry that all frames share, and without room for it.
    for memory in ["1G", "4M"] {
        bench.succeed(&[&["convert", "sky_#.png", "dome_#.png", "--memory", memory][..], &how].concat());
        for frame in 1..=3 {
            bench.succeed(&[&["convert", &format!("sky_{frame}.png"), "one.png"][..], &how].concat());
            assert!(bench.load("one.png") == bench.load(&format!("dome_{frame}.png")), "frame {frame}, {memory}");
        }
    }
}

#[test]
fn every_kernel_and_source_goes_with_it() {
    let bench = bench();
    for kernel in ["gaussian", "lanczos3", "box:scale=2", "mitchell:floor=3"] {
        let args = ["convert", "face_{face}.png", "out.png", "--to", "equirect", "--size", "64", "-y"];
        bench.succeed(&[&args[..], &["--filter", "ewa-pyramid", "--kernel", kernel]].concat());
    }
    for from in
        ["mirror-ball", "hammer", "stereographic:fov=350", "octahedral", "dual-fisheye", "mercator", "cube:layout=3x2"]
    {
        let size = if from.ends_with("3x2") { "300x200" } else { "240" };
        bench.succeed(&["convert", "face_{face}.png", "way.png", "--to", from, "--size", size, "-y"]);
        for filter in ["ewa", "ewa-pyramid"] {
            let output = format!("{filter}.png");
            let args = ["convert", "way.png", &output, "--from", from, "--to", "fulldome", "--size", "24", "-y"];
            bench.succeed(&[&args[..], &["--missing", "black", "--filter", filter]].concat());
        }
        bench.succeed(&["compare", "ewa.png", "ewa-pyramid.png", "--min-psnr", "30"]);
    }
}

#[test]
fn memory_for_the_levels_is_asked_for_before_it_is_taken() {
    let bench = bench();
    let args = ["convert", "face_{face}.png", "out.png", "--to", "equirect", "--size", "64", "--filter", "ewa-pyramid"];
    let output = bench.run(&[&args[..], &["--memory", "8M"]].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.code() == Some(1) && said.contains("what is prepared of the input") && said.contains("--memory"),
        "{said}"
    );
}
