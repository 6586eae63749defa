//! Skies: half worlds, what stands beyond their edge, templates to paint them, and how far is distant.

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Samples, Transfer};
use cosmorama_io::{Limits, read};

use crate::bench::{Bench, assert_says, flat};

fn light(bench: &Bench, name: &str) -> Image<Rgba> {
    read(bench.path(name), &Limits::NONE).unwrap().to_light()
}

/// Makes a photograph of the sky of the demo world, and its panorama.
fn sky(bench: &Bench) {
    bench.succeed(&["convert", "builtin:demo", "sky.png", "--to", "fisheye:fov=180", "--pitch", "90", "--size", "512"]);
}

#[test]
fn a_photograph_of_the_sky_is_half_a_cube() {
    let bench = Bench::new();
    sky(&bench);
    let from = ["--from", "fisheye:fov=180,pitch=90", "--size", "128"];
    bench.succeed(&[&["convert", "sky.png", "sky_{face}.png", "--to", "cube:half=up"], &from[..]].concat());
    bench.succeed(&["convert", "builtin:demo", "true_{face}.png", "--to", "cube:half=up", "--size", "128"]);
    for face in ["top", "front", "left", "back", "right"] {
        let found = bench.succeed(&["compare", &format!("sky_{face}.png"), &format!("true_{face}.png"), "--json"]);
        let report: serde_json::Value = serde_json::from_str(&found).unwrap();
        let (psnr, shift) = (report["linear"]["psnr"].as_f64().unwrap(), report["shift"]["pixels"].as_f64());
        println!("{face}: {psnr:.1} dB, {shift:?}");
        assert!(psnr > 24.0, "{face}: {psnr} dB");
    }
    assert!(!bench.path("sky_bottom.png").exists());
    // A half world stands behind a scene.
    bench.save("glass.png", &flat(64, 32, &[255, 255, 255, 0]));
    let behind = ["--backdrop", "sky_{face}.png", "--backdrop-from", "cube:half=up"];
    let over = ["convert", "glass.png", "out.png", "--to", "perspective:fov=60,pitch=40", "--size", "64"];
    bench.succeed(&[&over[..], &behind].concat());
    bench.succeed(&["convert", "builtin:demo", "true.png", "--to", "perspective:fov=60,pitch=40", "--size", "64"]);
    bench.succeed(&["compare", "out.png", "true.png", "--min-psnr", "22"]);
}

#[test]
fn below_the_horizon_the_sky_is_mirrored_or_stretched() {
    let bench = Bench::new();
    sky(&bench);
    let made = |missing: &str| {
        let args = ["convert", "sky.png", "out.exr", "-y", "--from", "fisheye:fov=180,pitch=90", "--to", "equirect"];
        bench.succeed(&[&args[..], &["--size", "256", "--missing", missing, "--depth", "float"]].concat());
        light(&bench, "out.exr")
    };
    let (mirrored, stretched) = (made("mirror"), made("stretch"));
    let far = |a: &Rgba, b: &Rgba| (0..3).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max);
    for image in [&mirrored, &stretched] {
        assert!(image.pixels().iter().all(|pixel| (pixel.alpha() - 1.0).abs() < 1e-5), "everything is covered");
    }
    let (mut sum, mut most) = (0.0, 0_f32);
    for (i, j) in (0..256).flat_map(|i| (0..60).map(move |j| (i, j))) {
        let off = far(mirrored.get(i, j), mirrored.get(i, 127 - j));
        (sum, most) = (sum + off, most.max(off));
        let horizon = stretched.get(i, 66);
        // Everything below is that of the horizon; around the nadir, pixels see it all round.
        let below = stretched.get(i, 127 - j);
        assert!(!(20..=40).contains(&j) || far(below, horizon) < 0.12, "column {i}, row {}", 127 - j);
    }
    println!("mirror: {} in the mean, {most} at most", sum / (256.0 * 60.0));
    assert!(sum / (256.0 * 60.0) < 4e-3 && most < 0.1);
    // A colour is laid by the part of a pixel that lies outside: a flat view in a panorama has smooth edges.
    bench.save("view.png", &flat(64, 48, &[255; 3]));
    let to = [
        "--from",
        "perspective:fov=60",
        "--to",
        "equirect",
        "--size",
        "257",
        "--roll",
        "13",
        "--missing",
        "transparent",
    ];
    bench.succeed(&[&["convert", "view.png", "part.png"], &to[..]].concat());
    let edge = light(&bench, "part.png");
    let soft = edge.pixels().iter().filter(|pixel| pixel.alpha() > 0.05 && pixel.alpha() < 0.95).count();
    let whole = edge.pixels().iter().filter(|pixel| pixel.alpha() == 1.0).count();
    assert!(soft > 60 && whole > 1000, "{soft} of {whole} pixels are soft");
    // White stays white where it is seen at all.
    let bright = |pixel: &Rgba| (pixel.unpremultiplied()[0] - 1.0).abs() < 0.03;
    assert!(edge.pixels().iter().filter(|pixel| pixel.alpha() > 0.1).all(bright));
    assert_says(
        &bench
            .fail(2, &["light", "diffuse", "view.png", "o.exr", "--from", "perspective:fov=60", "--missing", "mirror"]),
        &["for pictures"],
    );
}

#[test]
fn templates_are_layers_with_alpha() {
    let bench = Bench::new();
    let text = bench.succeed(&["explain", "--template", "sky", "--to", "cube:half=up", "--size", "64"]);
    let names = bench.files().len();
    assert_eq!(names, 5 * 4, "{text}");
    assert_says(
        &text,
        &["sky/front-horizon.png", "sky/up-grid.png", "sky/left-overlaps.png", "sky/back-safe-area.png"],
    );
    for name in ["front-horizon", "up-grid", "left-overlaps", "back-safe-area"] {
        let image = bench.load(&format!("sky/{name}.png"));
        assert_eq!(image.channels(), Channels::Rgba);
        let Samples::U8(samples) = image.samples() else { panic!("8 bits are 8 bits") };
        let (clear, drawn) = samples.chunks(4).fold((0, 0), |(clear, drawn), pixel| {
            (clear + usize::from(pixel[3] == 0), drawn + usize::from(pixel[3] > 60))
        });
        assert!(clear > 500 && drawn > 30, "{name}: {clear} clear, {drawn} drawn");
    }
    assert_says(&bench.fail(1, &["explain", "--template", "sky", "--to", "cube:half=up", "--size", "64"]), &["exist"]);
    assert_says(&bench.fail(2, &["explain", "--template", "other"]), &["--to is missing"]);
    bench.succeed(&["explain", "--template", "dome", "--to", "fulldome", "--size", "64"]);
    assert!(bench.path("dome/grid.png").is_file());
}

#[test]
fn explain_tells_how_far_is_distant() {
    let bench = Bench::new();
    std::fs::write(bench.path("shot.csv"), "frame,yaw,pitch,roll,fov\n1,0,0,0,60\n3,10,0,0,20\n").unwrap();
    let explain = ["explain", "--from", "cube", "--to", "perspective:fov=60", "--size", "1920x1080"];
    let told = |more: &[&str]| bench.succeed(&[&explain[..], more].concat());
    let still = told(&["--travel", "0.5", "--nearest", "50"]);
    // asin 0.01 in pixels of 1/(960/tan 30°) at the middle, smaller towards the corners.
    assert_says(&still, &["things 50 m away are off by up to", "(0.573°)", "less than half a pixel"]);
    let pixels = |text: &str| {
        let report: serde_json::Value = serde_json::from_str(text).unwrap();
        report[0]["parallax"]["pixels"].as_f64().unwrap()
    };
    let distances = ["--travel", "0.5", "--nearest", "50", "--json"];
    let (still, moving) =
        (pixels(&told(&distances)), pixels(&told(&[&distances[..], &["--path", "shot.csv"]].concat())));
    // The narrowest frame has the finest pixels.
    assert!(still > 16.6 && still < 25.0 && moving > 2.2 * still, "{still}, {moving}");
    let cases: [(&[&str], &[&str]); 3] = [
        (&["--travel", "5", "--nearest", "5"], &["--travel 5 is not less than --nearest 5"]),
        (&["--travel", "5"], &["--nearest"]),
        (&["--travel", "-1", "--nearest", "5"], &["0 or more"]),
    ];
    for (args, parts) in cases {
        assert_says(&bench.fail(2, &[&explain[..], args].concat()), parts);
    }
}

#[test]
fn layers_lie_before_one_another() {
    let bench = Bench::new();
    bench.save("red.png", &flat(64, 32, &[255, 0, 0]));
    bench.save("blue.png", &flat(64, 32, &[0, 0, 255]));
    let hole = Image::from_fn(64, 32, |i, _| if i < 32 { Rgba::opaque(0.0, 1.0, 0.0) } else { Rgba::TRANSPARENT });
    bench.save("half.png", &EncodedImage::encode(&hole, Channels::Rgba, Depth::Eight, &Transfer::Srgb));
    std::fs::write(bench.path("turn.csv"), "frame,yaw,pitch,roll\n1,0,0,0\n3,180,0,0\n").unwrap();
    let file = "[[layer]]\nimage = \"half.png\"\npath = \"turn.csv\"\n\n[[layer]]\nimage = \"red.png\"\nopacity = 0.25\n\n[[layer]]\nimage = \"blue.png\"\n";
    std::fs::write(bench.path("world.toml"), file).unwrap();
    let to = ["--to", "equirect", "--size", "64", "--depth", "float"];
    bench.succeed(&[&["convert", "world.toml", "out_#.exr"], &to[..]].concat());
    let pixel = |frame: u32, column: usize| light(&bench, &format!("out_{frame}.exr")).get(column, 16).0;
    let near = |found: [f32; 4], expected: [f32; 4]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4);
    let (green, mixed) = ([0.0, 1.0, 0.0, 1.0], [0.25, 0.0, 0.75, 1.0]);
    assert!(near(pixel(1, 16), green) && near(pixel(1, 48), mixed), "{:?} {:?}", pixel(1, 16), pixel(1, 48));
    assert!(near(pixel(3, 16), mixed) && near(pixel(3, 48), green), "{:?} {:?}", pixel(3, 16), pixel(3, 48));
    // The last layer may have one behind it still.
    std::fs::write(bench.path("one.toml"), "[[layer]]\nimage = \"red.png\"\nopacity = 0.5\n").unwrap();
    bench.succeed(&[&["convert", "one.toml", "two.exr", "--backdrop", "blue.png"], &to[..]].concat());
    assert!(near(light(&bench, "two.exr").get(5, 5).0, [0.5, 0.0, 0.5, 1.0]));
    bench.succeed(&["convert", "one.toml", "thin.png", "--to", "equirect", "--size", "64"]);
    assert_eq!(bench.load("thin.png").channels(), Channels::Rgba);
    let cases = [
        ("[[layer]]\nimage = \"red.png\"\nopacity = 2.0\n", "line 3: opacity = 2: expected a number from 0 to 1"),
        ("[[layer]]\nimage = \"red.png\"\nframes = \"hold\"\n", "line 3: frames is for the layers behind"),
        ("[[layer]]\nimage = \"red.png\"\n[[view]]\nimage = \"blue.png\"\n", "both [[view]] and [[layer]]"),
        ("[[layer]]\nimage = \"no.png\"\n", "no.png"),
        ("[[layer]]\nimage = \"red.png\"\nmask = \"m.png\"\n", "unknown field `mask`"),
    ];
    for (text, words) in cases {
        std::fs::write(bench.path("wrong.toml"), text).unwrap();
        assert_says(&bench.fail(1, &["convert", "wrong.toml", "o.png", "--to", "fulldome", "--size", "16"]), &[words]);
    }
    assert_says(&bench.fail(2, &["light", "diffuse", "one.toml", "o.exr"]), &["one.toml has layers", "one world"]);
}
