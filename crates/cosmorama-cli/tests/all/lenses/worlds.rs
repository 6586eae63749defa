//! World files: views that overlap, blended; mistakes told with their line.

use cosmorama::raster::Samples;

use crate::bench::{Bench, assert_says, flat, floats, picture};

const VIEWS: &str = r#"
[[view]]
image = "left.png"
spec = "perspective:fov=90,yaw=-30"
feather = 10

[[view]]
image = "views/right.png"
spec = "perspective:fov=80,yaw=35,pitch=5,roll=10"
feather = 10.0
"#;

/// A panorama, two views of it that overlap, and a world file that has them.
fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("views")).unwrap();
    bench.save("sky.png", &picture(1, 512, 256));
    let view = ["convert", "sky.png", "--to"];
    bench.succeed(&[&view[..], &["perspective:fov=90", "--yaw", "-30", "--size", "300", "left.png"]].concat());
    let turned = ["--yaw", "35", "--pitch", "5", "--roll", "10", "--size", "200", "views/right.png"];
    bench.succeed(&[&view[..], &["perspective:fov=80"], &turned].concat());
    std::fs::write(bench.path("world.toml"), VIEWS).unwrap();
    std::fs::write(bench.path("hard.toml"), VIEWS.replace("feather = 10", "priority = 1 #")).unwrap();
    bench
}

#[test]
fn overlapping_views_make_one_picture() {
    let bench = bench();
    let to = ["--to", "perspective:fov=60", "--size", "240"];
    bench.succeed(&[&["convert", "sky.png", "direct.png"], &to[..]].concat());
    for world in ["world.toml", "hard.toml"] {
        bench.succeed(&[&["convert", world, "out.png", "-y"], &to[..]].concat());
        bench.succeed(&["compare", "out.png", "direct.png", "--min-psnr", "55"]);
    }
}

#[test]
fn what_no_view_shows_is_told_or_filled() {
    let bench = bench();
    let convert = ["convert", "world.toml", "out.png", "--to", "equirect", "--size", "64"];
    assert_says(&bench.fail(1, &convert), &["look where no view does", "--missing"]);
    bench.succeed(&[&convert[..], &["--missing", "black"]].concat());
}

/// A view of the sky behind, and one before it of which a mask leaves the middle: a poisoned one, since what is masked has
/// any colour.
fn masked(bench: &Bench, poison: [f32; 3], blend: &str) {
    let is_hidden = |i: usize, j: usize| !(60..140).contains(&i) || !(30..120).contains(&j);
    let colour = |i, j| if is_hidden(i, j) { poison } else { [0.25, 0.5, 0.125] };
    bench.save("front.exr", &floats(200, 150, colour));
    bench.save("mask.exr", &floats(200, 150, |i, j| [f32::from(u8::from(!is_hidden(i, j))); 3]));
    let world = format!(
        "[[view]]\nimage = \"grey.exr\"\nspec = \"equirect\"\n\n[[view]]\nimage = \"front.exr\"\nmask = \"mask.exr\"\n\
         spec = \"perspective:fov=90\"\npriority = 1\n{blend}\n"
    );
    bench.save("grey.exr", &floats(128, 64, |_, _| [0.5, 0.25, 0.125]));
    std::fs::write(bench.path("masked.toml"), world).unwrap();
}

#[test]
fn nothing_leaks_out_from_under_a_mask() {
    let bench = Bench::new();
    for blend in ["", "feather = 8"] {
        for (to, kernel) in
            [("perspective:fov=95", "adaptive"), ("fisheye:fov=150", "lanczos3"), ("equirect", "gaussian")]
        {
            let mut pictures = Vec::new();
            for poison in [[100.0, 0.0, 0.0], [0.0, 0.0, 3000.0]] {
                masked(&bench, poison, blend);
                let to = ["--to", to, "--kernel", kernel, "--size", "200x150", "-y"];
                bench.succeed(&[&["convert", "masked.toml", "out.exr"], &to[..]].concat());
                pictures.push(bench.load("out.exr"));
            }
            assert!(pictures[0] == pictures[1], "{to} by {kernel}, {blend}");
            // Both views are there, blue is alike in both, and all lies between them.
            let Samples::Float(samples) = pictures[0].samples() else { panic!("floats were expected") };
            let of = |channel: usize| samples.iter().skip(channel).step_by(3).copied();
            for (channel, least, greatest) in [(0, 0.25, 0.5), (1, 0.25, 0.5), (2, 0.125, 0.125)] {
                let (low, high) = of(channel).fold((9.0f32, 0.0f32), |(low, high), v| (low.min(v), high.max(v)));
                // Outside a fisheye's circle it is black.
                let low = if to.starts_with("fisheye") { least } else { low };
                assert!(
                    (low - least).abs() < 1e-3 && (high - greatest).abs() < 1e-3,
                    "{to}: {channel}: {low} to {high}"
                );
            }
        }
    }
}

#[test]
fn a_masked_view_fades_out_at_its_mask() {
    let bench = Bench::new();
    masked(&bench, [9.0; 3], "feather = 8");
    bench.succeed(&["convert", "masked.toml", "out.exr", "--to", "perspective:fov=90", "--size", "200x150"]);
    let image = bench.load("out.exr");
    let Samples::Float(samples) = image.samples() else { panic!("floats were expected") };
    let red = |i: usize| samples[(75 * 200 + i) * 3];
    // From the mask's border inwards red falls from what is behind to what is in front, without a step.
    assert!((red(58) - 0.5).abs() < 1e-3 && (red(90) - 0.25).abs() < 1e-3);
    for i in 58..90 {
        let step = red(i) - red(i + 1);
        assert!((-1e-3..0.04).contains(&step), "column {i}: {step}");
    }
}

#[test]
fn a_hole_that_a_mask_leaves_is_named_in_degrees() {
    let bench = Bench::new();
    masked(&bench, [9.0; 3], "");
    let world = std::fs::read_to_string(bench.path("masked.toml")).unwrap();
    std::fs::write(bench.path("masked.toml"), &world[world.rfind("[[view]]").unwrap()..]).unwrap();
    let convert = ["convert", "masked.toml", "out.exr", "--to", "perspective:fov=60", "--size", "100x75"];
    assert_says(&bench.fail(1, &convert), &["look where no view does, within yaw -", "°", "pitch -"]);
    bench.succeed(&[&convert[..], &["--missing", "black"]].concat());
    let small = ["convert", "masked.toml", "in.exr", "--to", "perspective:fov=20", "--size", "100x75"];
    bench.succeed(&small);
}

#[test]
fn no_output_replaces_what_its_world_is_made_of() {
    let bench = Bench::new();
    masked(&bench, [9.0; 3], "");
    let straight = ["--from", "fisheye:fov=150", "--to", "perspective:fov=70", "--size", "40x30", "--st-map"];
    bench.succeed(&[&["convert", "front.exr", "map.exr"][..], &straight].concat());
    let view = "image = \"grey.exr\"\nspec = \"st-map:file=map.exr,invert=yes,base=perspective:fov=70\"\n";
    std::fs::write(bench.path("mapped.toml"), format!("[[view]]\n{view}")).unwrap();
    let to = ["--to", "perspective:fov=20", "--size", "32", "--missing", "black", "-y"];
    for (world, read) in [("masked.toml", "mask.exr"), ("mapped.toml", "map.exr")] {
        let before = bench.bytes(read);
        let message = bench.fail(2, &[&["convert", world, read][..], &to].concat());
        assert_says(&message, &[read, "replace its own input"]);
        assert!(bench.bytes(read) == before, "{read}");
    }
}

#[test]
fn masks_that_do_not_fit_are_told_with_their_line() {
    let bench = bench();
    bench.save("small.png", &flat(8, 8, &[255]));
    bench.save("black.png", &flat(300, 225, &[0]));
    for (mask, expected) in [
        ("small.png", &["bad.toml, line 3", "small.png", "8x8", "300x225"][..]),
        ("black.png", &["bad.toml, line 3", "black all over"]),
        ("none.png", &["bad.toml, line 3", "none.png"]),
    ] {
        let world = format!("[[view]]\nimage = \"left.png\"\nmask = \"{mask}\"\nspec = \"perspective:fov=90\"\n");
        std::fs::write(bench.path("bad.toml"), world).unwrap();
        let convert = ["convert", "bad.toml", "out.png", "--to", "perspective:fov=30"];
        assert_says(&bench.fail(1, &convert), expected);
    }
}

#[test]
fn mistakes_are_told_with_their_line() {
    let bench = bench();
    for (code, world, expected) in [
        (1, "[[view]]\nimage = \"left.png\"\nspce = \"x\"\n", ["bad.toml, line 3", "`spce`"]),
        (1, "[[view]]\nimage = \"left.png\"\nspec = \"fisheye:fvo=3\"\n", ["bad.toml, line 3", "'fov'"]),
        (1, "[[view]]\n\nimage = \"none.png\"\nspec = \"fisheye\"\n", ["bad.toml, line 3", "none.png"]),
        (1, "[[view]]\nimage = \"left.png\"\nfeather = -2\n", ["bad.toml, line 3", "from 0 to 180"]),
        (1, "[[view]]\nimage = \"world.toml\"\n", ["bad.toml, line 2", "itself"]),
        (1, "[[view]\n", ["bad.toml", "line 1"]),
        (1, "# nothing\n", ["bad.toml", "[[view]]"]),
    ] {
        std::fs::write(bench.path("bad.toml"), world).unwrap();
        assert_says(&bench.fail(code, &["convert", "bad.toml", "out.png", "--to", "equirect"]), &expected);
    }
    let from = ["convert", "world.toml", "out.png", "--from", "cube", "--to", "equirect"];
    assert_says(&bench.fail(2, &from), &["world.toml", "leave out --from"]);
}

#[test]
fn a_world_file_of_millions_of_bytes_is_refused_before_it_is_parsed() {
    let bench = Bench::new();
    std::fs::write(bench.path("huge.toml"), "[[view]]\n".repeat(500_000)).unwrap();
    let message = bench.fail(1, &["convert", "huge.toml", "out.png", "--to", "equirect"]);
    assert_says(&message, &["huge.toml", "more than 4 MiB", "divide it"]);
}

#[test]
fn info_lists_the_views_of_a_world() {
    let bench = Bench::new();
    bench.save("left.png", &picture(1, 60, 60));
    bench.save("sky.png", &picture(2, 80, 40));
    let text = "[[view]]\nimage = \"left.png\"\nspec = \"perspective:fov=90,yaw=-30,pitch=10\"\nfeather = 5\n\n\
                [[view]]\nimage = \"sky.png\"\nspec = \"equirect:vfov=90,canvas=80x80+0+0\"\npriority = -1\n";
    std::fs::write(bench.path("world.toml"), text).unwrap();
    let told = bench.succeed(&["info", "world.toml"]);
    let parts = ["a world of 2 views", "left.png", "spec: perspective:fov=90,yaw=-30,pitch=10", "world.toml, line 2"];
    assert_says(&told, &parts);
    // A face of a cube is a sixth of the sphere.
    assert_says(
        &told,
        &["yaw -30.00, pitch 10.00, roll 0.00", "covers: 16.7 % of the sphere", "feather: 5.0", "priority: -1"],
    );
    assert_says(&told, &["lacks: directions within all yaws, pitch -90° to 90°"]);
    let json: serde_json::Value = serde_json::from_str(&bench.succeed(&["info", "world.toml", "--json"])).unwrap();
    assert_eq!(json["views"][0]["size"], "60x60");
    assert_eq!(json["views"].as_array().unwrap().len(), 2);
    let project = "p f2 w200 h100 v360\ni w60 h60 f0 v90 y45 p0 r20 n\"left.png\"\n";
    std::fs::write(bench.path("a.pto"), project).unwrap();
    let told = bench.succeed(&["info", "a.pto"]);
    assert_says(
        &told,
        &["a world of one view", "a.pto, line 2", "yaw 45.00, pitch 0.00, roll 20.00", "16.7 % of the sphere"],
    );
}
