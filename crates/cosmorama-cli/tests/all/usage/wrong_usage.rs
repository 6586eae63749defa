//! What is typed wrongly is said in our own words, with exit code 2.

use crate::bench::{Bench, assert_says, flat, picture};

#[test]
fn wrong_usage() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let convert = |extra: &[&str]| {
        let mut args = vec!["convert", "sky.png"];
        args.extend(extra);
        bench.fail(2, &args)
    };
    assert_says(&convert(&["out.bmp", "--to", "omnimax"]), &["out.bmp", "png, jpg", "for a video mp4"]);
    assert_says(&convert(&["out", "--to", "omnimax"]), &["extension"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "--size", "0"]), &["--size", "1966x1436"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "--frames", "9-3"]), &["--frames", "9-3", "3-9"]);
    assert_says(&convert(&["out.png"]), &["--to", "omnimax"]);
    assert_says(&convert(&["out.png", "--to", "omnimx"]), &["did you mean 'omnimax'"]);
    assert_says(&convert(&["out.png", "--to", "fisheye:fvo=180"]), &["unknown key 'fvo' for fisheye", "'fov'"]);
    assert_says(&convert(&["out.png", "--to", "perspective:fov=180"]), &["less than 180"]);
    assert_says(&convert(&["out.png", "--to", "fisheye:lens=orthographic,fov=200"]), &["200°", "at most 180°"]);
    assert_says(&convert(&["out.png", "--to", "equirect:fov=180"]), &["unknown key 'fov' for equirect", "hfov"]);
    assert_says(
        &convert(&["out.png", "--to", "omnimax:framing=fit,center=9:9"]),
        &["framing= and center= cannot both"],
    );
    assert_says(&convert(&["out.png", "--to", "fisheye:fit=width,radius=9"]), &["fit= and radius= cannot both"]);
    assert_says(&convert(&["out.png", "--to", "cube"]), &["{face}"]);
    assert_says(&convert(&["{face}.png", "--to", "omnimax"]), &["names the faces of a cube"]);
    assert_says(&convert(&["out_####.png", "--to", "omnimax"]), &["frame marker"]);
    assert_says(&convert(&["out_##.mp4", "--to", "omnimax"]), &["out_##.mp4 is a video", "without a frame marker"]);
    assert_says(&convert(&["out.jpg", "--to", "omnimax", "--depth", "16"]), &["JPEG", "8"]);
    assert_says(&convert(&["out.jpg", "--to", "omnimax", "--background", "transparent"]), &["JPEG", "transparent"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "--kernel", "gauss"]), &["There are adaptive, gaussian"]);
    assert_says(
        &convert(&["out.png", "--to", "omnimax", "--filter", "ewa-pyramids"]),
        &["ewa-pyramid, point, bilinear"],
    );
    assert_says(&convert(&["out.png", "--to", "omnimax:center=3:4"]), &["--size"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "--from", "cube"]), &["{face}"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "-y", "--resume"]), &["--resume"]);
    for (name, marker) in [("out_{fce}.png", "{fce}"), ("*.png", "*"), ("none/{frame}/out.png", "{frame}")] {
        let message = convert(&[name, "--to", "omnimax"]);
        assert_says(&message, &[&format!("{name}: {marker} stands for nothing"), "{face}", "####"]);
    }
    let transfers = ["--transfer", "srgb", "--in-transfer", "pq", "--out-transfer", "hlg"];
    assert_says(&convert(&[&["out.png", "--to", "omnimax"][..], &transfers].concat()), &["--transfer has no effect"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "--transfer", "gamma:0"]), &["G from 0.1 to 10"]);
    assert_says(&convert(&["out.png", "--to", "omnimax", "--quality", "80"]), &["--quality", "JPEG", "out.png", "PNG"]);
}

#[test]
fn pictures_that_cannot_be_are_refused_before_the_work() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let refused = |args: &[&str], parts: &[&str]| {
        assert_says(&bench.fail(2, &[&["convert", "sky.png"], args].concat()), parts);
    };
    for name in ["out.jpg", "out.tga"] {
        refused(&[name, "--to", "equirect", "--size", "70000x3"], &[name, "65535", "70000x3", "--size", "png"]);
    }
    for to in ["cylinder:vfov=179.9999", "equirect:hfov=0.001,vfov=180"] {
        refused(
            &["out.png", "--to", to, "--size", "100"],
            &["--to", "--size 100", "more than 1000000 pixels", "--size WxH"],
        );
    }
    let beside = ["equirect:canvas=128x64+900+0", "perspective:canvas=100x100-5000+0"];
    for spec in beside {
        refused(&["out.png", "--from", spec, "--to", "fulldome"], &["sky.png", "64x32", "beside", "canvas=WxH+X+Y"]);
        refused(&["out.png", "--to", spec, "--size", "64x32"], &["--to", "64x32", "beside", "canvas=WxH+X+Y"]);
    }
    refused(&["out.png", "--to", "fisheye:sensor=36"], &["sensor=36", "lens=polynomial", "focal="]);
}

#[test]
fn numbers_that_are_none_or_absurd() {
    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[10, 20, 30]));
    let convert = ["convert", "sky.png", "out.png", "--from", "equirect", "--to", "perspective"];
    for (option, value, expected) in [
        ("--yaw", "nan", "angle in degrees"),
        ("--roll", "inf", "angle in degrees"),
        ("--size", "-3", "1966x1436"),
        ("--size", "-3x4", "1966x1436"),
        ("--threads", "-2", "from 1 to 1024"),
        ("--memory", "-1G", "--memory"),
        ("--memory", "0", "1 byte or more"),
        ("--memory", "150%", "at most 100%"),
        ("--frames", "-4", "expected a list"),
        ("--frames", "1:3", "for frames 1 to 3 write 1-3"),
        ("--frames", "1..3", "for frames 1 to 3 write 1-3"),
        ("--frames", "all", "all frames are the default"),
        ("--compression", "nonsense", "one of none, fast, balanced, high"),
        ("--compression", "9", "for PNG, TIFF and OpenEXR; JPEG has --quality"),
        ("--quality", "-1", "from 1 to 100"),
        ("--kernel", "mitchell:scale=1000", "at most 32"),
        ("--kernel", "tent:floor=1e300", "at most 32"),
    ] {
        assert_says(&bench.fail(2, &[&convert[..], &[option, value]].concat()), &[value, expected]);
    }
    // Clap's own tip was the value that is spelled most alike.
    let message = bench.fail(2, &[&convert[..], &["--compression", "nonsense"]].concat());
    assert!(!message.contains("tip:"), "{message}");
    assert_says(&bench.succeed(&["convert", "--help"]), &["- balanced: Between the two"]);
    let message = bench.fail(1, &[&convert[..], &["--memory", "1"]].concat());
    assert_says(&message, &["only 1 byte may be used"]);
    assert_says(&bench.fail(2, &["compare", "sky.png", "sky.png", "--min-psnr", "nan"]), &["expected a number"]);
    for gain in ["nan", "inf", "0", "-2", "1e60"] {
        let message = bench.fail(2, &["compare", "sky.png", "sky.png", "--diff", "d.png", "--gain", gain]);
        assert_says(&message, &["--gain", gain, "expected a number more than 0"]);
    }
}

#[test]
fn a_map_of_another_shape_is_stretched_only_where_that_is_said() {
    let bench = Bench::new();
    bench.save("wide.png", &picture(1, 96, 64));
    let to = ["out.png", "-y", "--to", "perspective", "--size", "32"];
    let args = |from: &'static str| [&["convert", "wide.png", "--from", from], &to[..]].concat();
    for (from, expected) in [
        ("equirect", "96x48 were expected"),
        ("equirect:vfov=90", "96x24 were expected"),
        ("hammer", "96x48 were expected"),
        ("octahedral", "96x96 were expected"),
    ] {
        assert_says(&bench.fail(2, &args(from)), &["wide.png", "96x64", expected, "canvas="]);
    }
    for from in
        ["equirect:hfov=360,vfov=180", "equirect:canvas=96x64+0+0", "hammer:canvas=96x64+0+0", "equirect:hfov=270"]
    {
        bench.succeed(&args(from));
    }
    // A row more or less is a matter of rounding.
    bench.save("wide.png", &picture(1, 97, 48));
    bench.succeed(&args("equirect"));
}

#[test]
fn what_was_meant_for_a_face_pattern() {
    let bench = Bench::new();
    bench.faces("faces/", 16);
    let convert = |input: &str| bench.fail(2, &["convert", input, "out.png", "--to", "omnimax", "--size", "32"]);
    assert_says(&convert("faces"), &["is a folder", "faces/{face}.png"]);
    assert_says(&convert("faces/*.png"), &["names no file", "{face}"]);
    assert_says(&convert("faces/{Face}.png"), &["names no file", "{face}"]);
    assert_says(&convert(""), &["INPUT"]);
    assert_says(&bench.fail(1, &["info", "none/{face}.png"]), &["cannot open none: "]);
    // Its frames are in folders that are there.
    bench.save("shot_0001/a.png", &picture(1, 16, 16));
    assert_says(&bench.fail(1, &["info", "shot_####/{face}.png"]), &["shot_####/{face}.png", "front"]);
    assert_says(&bench.fail(1, &["info", "none/shot_####/{face}.png"]), &["cannot open none: "]);
    assert_says(&convert("faces/sky_$F4.png"), &["names no file", "for frames ####"]);
}

#[test]
fn what_was_meant_for_a_frame_pattern() {
    let bench = Bench::new();
    for frame in 8..=10 {
        bench.save(&format!("shot/sky_{frame:04}.png"), &picture(frame, 16, 8));
    }
    let convert = |code: i32, input: &str| bench.fail(code, &["convert", input, "out_##.png", "--to", "omnimax"]);
    let there = "shot/sky_####.png (8-10)";
    assert_says(&convert(2, "shot"), &["shot is a folder; for the frames in it, write", there]);
    assert_says(&bench.fail(2, &["info", "shot/"]), &["is a folder", there]);
    assert_says(&convert(2, "shot/*.png"), &["names no file", "for frames ####", there]);
    assert_says(&convert(1, "shot/sky_###.png"), &["no frame found in shot", "sky_001.png", "but there are", there]);
    assert_says(&convert(1, "shot/sky_0011.png"), &["no such file", there]);
    let listed = bench.fail(2, &["convert", "shot/sky_0008.png", "shot/sky_0009.png", "shot/sky_0010.png", "o_##.png"]);
    assert_says(&listed, &["shot/sky_0010.png", "one pattern, in quotes: '####'"]);
    let message = bench.fail(1, &["convert", "shot/sky_####.png", "o_#.png", "--to", "omnimax", "--frames", "9-11"]);
    assert_says(&message, &["1 frame is missing: 11; the first that exists is 8, the last 10; make it, or choose"]);
    assert_says(
        &bench.fail(2, &["convert", "shot/sky_####.png", "shot", "--to", "omnimax"]),
        &["shot: a folder", "shot/out.png"],
    );
    for frame in 1..=2 {
        bench.save(&format!("dusk_{frame}.png"), &picture(frame, 16, 8));
    }
    assert_says(&convert(1, "dusk_3.png"), &["dusk_3.png: there is no such file; there are dusk_#.png (1,2)"]);
    assert_says(&convert(2, "*.png"), &["names no file", "there are dusk_#.png (1,2)"]);
    assert_says(&convert(1, "dusk_##.png"), &["but there are dusk_#.png (1,2)"]);
    // Of the frames of a cube, the faces are told, not one frame or one face of them.
    for frame in 1..=2 {
        for name in ["front", "right", "back", "left", "up", "down"] {
            bench.save(&format!("cube/{name}_{frame}.png"), &picture(frame, 8, 8));
        }
    }
    assert_says(&convert(2, "cube"), &["for the faces of a cube in it, write cube/{face}_#.png"]);
    bench.save("one/a.png", &picture(0, 8, 8));
    assert_says(&convert(2, "one"), &["one is a folder; write which file in it, as in one/a.png"]);
    std::fs::create_dir(bench.path("none")).unwrap();
    assert_says(&convert(2, "none"), &["no image is in it", "none/{face}.png", "none/####.png"]);
}
