//! What is refused says what was found and what to do.

use cosmorama::sphere::CubeFace;

use crate::bench::{Bench, assert_says, floats, picture, text};

const TO: [&str; 5] = ["-y", "--to", "fulldome", "--size", "32"];

fn refused(bench: &Bench, code: i32, args: &[&str], parts: &[&str]) {
    assert_says(&bench.fail(code, &[&["convert"], args, &TO[..]].concat()), parts);
}

#[test]
fn circles_that_are_not_on_the_picture() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 200, 100));
    let off = ["radius 10 pixels around 900:90", "200x100", "center=X:Y"];
    for from in
        ["fisheye:center=900:90,radius=10", "mirror-ball:center=900:90,radius=10", "omnimax:center=900:90,radius=10"]
    {
        refused(&bench, 2, &["a.png", "b.png", "--from", from], &off);
    }
    refused(&bench, 2, &["a.png", "b.png", "--from", "dual-fisheye:front.center=50:900,front.radius=9"], &["lies off"]);
    let message = bench
        .fail(2, &["convert", "a.png", "b.png", "--from", "equirect", "--to", "fisheye:center=900:9", "--size", "64"]);
    assert_says(&message, &["--to", "900:9", "64x64"]);
    let halves = ["200x100", "no two circles one above the other", "layout=side-by-side"];
    refused(&bench, 2, &["a.png", "b.png", "--from", "dual-fisheye:layout=top-bottom"], &halves);
}

#[test]
fn a_cube_is_not_stretched_into_a_panorama() {
    let Some(data) = testkit::shared("data/openexr_envmap") else { return };
    let bench = Bench::new();
    let cube = data.join("KernerEnvCube.exr").to_string_lossy().into_owned();
    refused(&bench, 2, &[&cube, "b.png", "--from", "equirect"], &["256x1536", "no panorama", "256x128 were expected"]);
    let output = bench.run(&[
        "convert",
        &cube,
        "b.png",
        "--from",
        "mercator",
        "--to",
        "equirect",
        "--size",
        "32",
        "--missing",
        "black",
    ]);
    assert_says(&text(&output.stderr), &["warning: ", "six faces of a cube", "--from says otherwise"]);
}

#[test]
fn world_files_say_where_and_what() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 50, 37));
    let world = |text: &[u8], parts: &[&str]| {
        std::fs::write(bench.path("w.toml"), text).unwrap();
        let message = bench.fail(1, &[&["convert", "w.toml", "b.png"], &TO[..]].concat());
        assert_says(&message, parts);
        message
    };
    world(b"[[view]]\nimage = \"builtin:grid\"\n", &["w.toml, line 2", "formula", "cosmorama convert builtin:grid"]);
    let message =
        world(b"[[view]]\nimage = \"a.png\"\n", &["w.toml, line 2", "50x37", "spec = perspective:fov=DEGREES"]);
    assert!(!message.contains("--from"), "{message}");
    world(
        b"[[view]]\nimage = \"a.png\"\npriority = \"a\"\n",
        &["line 3", "expected a whole number", "priority = WHOLE"],
    );
    world(b"[[view]]\nspec = \"equirect\"\n", &["line 1", "image", "image = \"FILE\""]);
    world(b"\xff\xfe\0\0", &["w.toml: not a text", "[[view]]"]);
    std::fs::write(bench.path("a.pto"), b"i w\0\x01\xff").unwrap();
    assert_says(&bench.fail(1, &["info", "a.pto"]), &["a.pto", "not a text", "Hugin"]);
}

#[test]
fn a_frame_that_is_not_like_the_first() {
    let bench = Bench::new();
    let sequence = |third: &dyn Fn()| {
        (1..=3).for_each(|frame| bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32)));
        third();
        let output = bench.run(&[&["convert", "sky_#.png", "out_#.png", "--from", "equirect"], &TO[..]].concat());
        assert_eq!(output.status.code(), Some(1));
        text(&output.stderr)
    };
    let message = sequence(&|| std::fs::write(bench.path("sky_3.png"), "").unwrap());
    assert_says(&message, &["frame 3: sky_3.png: an empty file (0 bytes), where an image was expected; make it again"]);
    let message = sequence(&|| bench.save("sky_3.png", &picture(3, 32, 16)));
    let parts =
        ["frame 3: sky_3.png: 32x16 pixels", "sky_1.png, of the first frame, has 64x32; render it again", "--frames"];
    assert_says(&message, &parts);
    // As it advises.
    bench.succeed(&[&["convert", "sky_#.png", "out_#.png", "--from", "equirect", "--frames", "3"], &TO[..]].concat());
    std::fs::write(bench.path("sky_1.png"), "").unwrap();
    assert_says(&bench.fail(1, &["info", "sky_1.png"]), &["sky_1.png: an empty file (0 bytes)"]);
}

#[test]
fn files_that_end_too_early_say_so_in_info() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 64, 32));
    for name in ["a.exr", "a.hdr", "a.jpg", "a.tif", "a.ktx2", "a.dds"] {
        let cube = name.ends_with("ktx2") || name.ends_with("dds");
        let to = if cube { "cube" } else { "equirect" };
        bench.succeed(&["convert", "a.png", name, "--from", "equirect", "--to", to, "--size", "64"]);
        assert!(!bench.succeed(&["info", name]).contains("damaged"), "{name}");
        let whole = bench.bytes(name);
        for part in [2, 3] {
            std::fs::write(bench.path(name), &whole[..whole.len() * (part - 1) / part]).unwrap();
            let output = bench.run(&["info", name]);
            assert_eq!(output.status.code(), Some(1), "{name}");
            let told = text(&output.stdout) + &text(&output.stderr);
            assert_says(&told, &[name, "damaged or truncated"]);
        }
    }
}

#[test]
fn a_face_that_ends_too_early_is_told_of_in_info() {
    let bench = Bench::new();
    bench.faces("face_", 32);
    assert!(!bench.succeed(&["info", "face_{face}.png"]).contains("damaged"));
    let whole = bench.bytes("face_left.png");
    std::fs::write(bench.path("face_left.png"), &whole[..whole.len() / 2]).unwrap();
    let output = bench.run(&["info", "face_{face}.png"]);
    assert_eq!(output.status.code(), Some(1));
    let told = text(&output.stdout);
    assert_eq!(told.matches("damaged: ").count(), 1, "{told}");
    assert_says(&told, &["damaged: face_left.png: damaged or truncated"]);
}

#[test]
fn every_frame_is_read_where_that_is_asked_for() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let whole = bench.bytes("sky_2.png");
    std::fs::write(bench.path("sky_2.png"), &whole[..whole.len() / 2]).unwrap();
    bench.succeed(&["info", "sky_#.png"]);
    let output = bench.run(&["info", "sky_#.png", "--check"]);
    assert_eq!(output.status.code(), Some(1));
    let told = text(&output.stdout);
    assert_says(&told, &["damaged: sky_2.png: damaged or truncated"]);
    assert!(!told.contains("sky_1.png:") && !told.contains("sky_3.png:"), "{told}");
}

#[test]
fn frames_whose_header_says_what_they_are_are_read_only_for_a_check() {
    let bench = Bench::new();
    let damage = |name: &str| {
        let whole = bench.bytes(name);
        std::fs::write(bench.path(name), &whole[..whole.len() / 2]).unwrap();
    };
    // A strip by its shape; the first face by its name.
    bench.save("strip_1.png", &picture(1, 192, 32));
    bench.save("strip_2.png", &picture(2, 192, 32));
    bench.faces("world", 32);
    for face in CubeFace::ALL {
        let word = crate::bench::word(face);
        std::fs::rename(bench.path(&format!("world{word}.png")), bench.path(&format!("{word}_1.png"))).unwrap();
    }
    damage("strip_1.png");
    damage("front_1.png");
    for (pattern, name) in [("strip_#.png", "strip_1.png"), ("{face}_#.png", "front_1.png")] {
        let told = bench.succeed(&["info", pattern]);
        assert_says(&told, &["read: the first frame alone; --check decodes every frame", "projection: cube"]);
        assert!(!told.contains("damaged") && !told.contains("arrangement"), "{told}");
        let output = bench.run(&["info", pattern, "--check"]);
        let told = text(&output.stdout);
        assert_eq!((output.status.code(), told.matches("damaged: ").count()), (Some(1), 1), "{told}");
        assert_says(&told, &[&format!("damaged: {name}: damaged or truncated"), "read: every frame"]);
    }
}

/// Headers alone tell of a part of a larger picture, of channels that form none, and of a world; damage is sought all the same.
#[test]
fn damage_behind_a_whole_header_is_found() {
    let bench = Bench::new();
    let halve = |name: &str| {
        let whole = bench.bytes(name);
        std::fs::write(bench.path(name), &whole[..whole.len() - whole.len() / 8]).unwrap();
    };
    let is_damaged = |args: &[&str]| {
        let output = bench.run(&[&["info"], args].concat());
        assert_says(&text(&output.stdout), &["damaged: "]);
        assert_eq!(output.status.code(), Some(1), "{args:?}");
    };
    bench.succeed(&["convert", "builtin:direction-map", "map.exr", "--to", "fulldome", "--size", "64"]);
    bench.save("part.exr", &floats(64, 64, |i, j| [i as f32, j as f32, 0.5]));
    let mut part = bench.bytes("part.exr");
    let name = b"displayWindow\0box2i\0";
    let right = part.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len() + 4 + 8;
    part[right..right + 4].copy_from_slice(&99_i32.to_le_bytes());
    std::fs::write(bench.path("part.exr"), part).unwrap();
    bench.save("view.png", &picture(1, 64, 64));
    std::fs::write(bench.path("a.toml"), "[[view]]\nimage = \"view.png\"\nspec = \"perspective:fov=90\"\n").unwrap();
    for name in ["map.exr", "part.exr"] {
        bench.succeed(&["info", name]);
        halve(name);
        is_damaged(&[name]);
    }
    bench.succeed(&["info", "a.toml", "--check"]);
    halve("view.png");
    assert_says(&bench.succeed(&["info", "a.toml"]), &["read: headers alone; --check decodes every picture"]);
    is_damaged(&["a.toml", "--check"]);
}

#[test]
fn a_plain_shape_is_a_note_and_no_warning() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let to = ["--to", "fulldome", "--size", "16", "--overwrite"];
    let said = |more: &[&str]| text(&bench.run(&[&["convert", "sky.png", "out.png"][..], &to, more].concat()).stderr);
    assert!(!said(&[]).contains("taken for a panorama"));
    assert_says(&said(&["-v"]), &["note: sky.png is taken for a panorama", "--from equirect"]);
}

#[test]
fn faces_of_several_sizes_are_told_of() {
    let bench = Bench::new();
    bench.faces("face_", 32);
    bench.save("face_left.png", &picture(1, 16, 16));
    let output = bench.run(&["convert", "face_{face}.png", "out.png", "--to", "fulldome", "--size", "16"]);
    assert_says(&text(&output.stderr), &["different sizes", "left 16x16", "the others 32x32"]);
}

#[test]
fn tilts_beyond_a_quarter_turn_are_refused() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    for (spec, key) in [("fulldome:tilt=200", "tilt"), ("omnimax:axis=120", "axis"), ("fulldome:tilt=-91", "tilt")] {
        let message = bench.fail(2, &["convert", "sky.png", "out.png", "--to", spec]);
        assert_says(&message, &[key, "-90 to 90"]);
    }
}

#[test]
fn what_a_cube_file_holds_is_told_with_its_name() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 64, 32));
    let message = bench.fail(2, &["convert", "a.png", "sky.ktx2", "--from", "equirect", "--to", "equirect"]);
    assert_says(&message, &["sky.ktx2", "six whole faces", "--to is equirect", "--to cube"]);
}

/// Viewers take GPano's word for how much of the sphere a picture shows.
#[test]
fn a_part_of_a_panorama_says_which() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 64, 32));
    for (to, size, canvas) in [
        ("equirect:hfov=180,vfov=90", "64x32", "128x64+32+16"),
        ("equirect:hfov=180", "64x64", "128x64+32+0"),
        ("equirect:vfov=90", "64x16", "64x32+0+8"),
    ] {
        for name in ["b.jpg", "b.png"] {
            bench.succeed(&["convert", "a.png", name, "-y", "--from", "equirect", "--to", to, "--size", size]);
            let told = bench.succeed(&["info", name]);
            assert_says(&told, &[&format!("equirect:canvas={canvas} (GPano metadata)")]);
            // Both say the same of each pixel.
            let view = ["--to", "perspective:fov=40", "--size", "40x30"];
            bench.succeed(&[&["convert", name, "said.png", "-y"], &view[..]].concat());
            bench.succeed(&[&["convert", name, "given.png", "-y", "--from", to], &view[..]].concat());
            bench.succeed(&["compare", "said.png", "given.png", "--min-psnr", "60", "--max-shift", "0.001"]);
        }
    }
    // Pixels that are not square, and parts that are no whole numbers of pixels, it cannot describe.
    for (to, size) in [("equirect:hfov=180,vfov=90", "64x40"), ("equirect:hfov=100,vfov=50", "64x32")] {
        bench.succeed(&["convert", "a.png", "b.png", "-y", "--from", "equirect", "--to", to, "--size", size]);
        assert!(!text(&bench.bytes("b.png")).contains("GPano"), "{to}");
    }
}
