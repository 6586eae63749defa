//! What is wrong is said once, clearly, with the right exit code, and leaves nothing behind.

use crate::bench::{Bench, assert_says, flat, floats, picture};
use cosmorama::sphere::CubeFace;

fn remove(bench: &Bench, name: &str) {
    std::fs::remove_file(bench.path(name)).unwrap();
}

#[test]
fn a_missing_face_is_named_with_what_is_needed_of_it() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    remove(&bench, "face_right.png");
    let message = bench.fail(1, &["convert", "face_{face}.png", "out.png", "--to", "omnimax"]);
    // Half of it and the pixels at the lens's rim, 0.162° further.
    assert_says(&message, &["right: 33x62+0+0 of its 64x64 pixels", "face_right.png is missing", "--missing"]);
    assert!(!message.contains("left:") && !message.contains("back:"), "{message}");
}

#[test]
fn a_face_that_is_a_folder_is_called_so() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    remove(&bench, "face_right.png");
    std::fs::create_dir(bench.path("face_right.png")).unwrap();
    let message = bench.fail(1, &["convert", "face_{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["right: 33x62+0+0 of its 64x64 pixels", "face_right.png is a folder, not an image"]);
    let told = bench.succeed(&["explain", "face_{face}.png", "--to", "omnimax"]);
    assert_says(&told, &["missing  right: no face_right.png, but a folder of this name"]);
    bench.faces("shot/front/", 16);
    let message = bench.fail(1, &["convert", "shot/{face}", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["shot/front: a folder", "shot/{face}/{face}.png"]);
}

#[test]
fn a_face_that_is_not_needed_may_be_missing() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    remove(&bench, "face_back.png");
    remove(&bench, "face_bottom.png");
    bench.succeed(&["convert", "face_{face}.png", "out.png", "--to", "omnimax"]);
}

#[test]
fn a_crop_that_is_too_small_is_named() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    bench.save("face_left.png", &picture(3, 20, 64));
    let from = "cube:canvas.left=64x64+44+0";
    let message = bench.fail(1, &["convert", "face_{face}.png", "out.png", "--to", "omnimax", "--from", from]);
    assert_says(&message, &["left: 33x62+31+0", "holds only 20x64+44+0"]);
}

#[test]
fn no_input_at_all() {
    let bench = Bench::new();
    let message = bench.fail(1, &["convert", "{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["{face}.png", "front right back left top bottom"]);
    let message = bench.fail(1, &["convert", "nothing/{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["cannot open nothing:", "No such file"]);
    let message = bench.fail(1, &["convert", "nothing.png", "out.png", "--to", "omnimax", "--from", "equirect"]);
    assert_says(&message, &["nothing.png", "No such file"]);
    assert_eq!(message.matches("No such file").count(), 1, "{message}");
}

#[test]
fn a_face_that_is_no_image() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    std::fs::write(bench.path("face_left.png"), "not a picture").unwrap();
    let message = bench.fail(1, &["convert", "face_{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["face_left.png", "not an image"]);
}

#[test]
fn a_face_of_the_wrong_shape() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    bench.face("face_top.png", CubeFace::Up, 64, 40);
    let message = bench.fail(1, &["convert", "face_{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["face_top.png", "the up face is 64x40", "expected 64x64", "canvas.up="]);
    for face in CubeFace::ALL {
        bench.face(&format!("wide_{face}.png"), face, 128, 64);
        // Half faces without their windows; only the front is whole.
        let (width, height) = if face == CubeFace::Front { (64, 64) } else { (32, 64) };
        bench.face(&format!("half_{face}.png"), face, width, height);
    }
    let message = bench.fail(1, &["convert", "half_{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(
        &message,
        &["half_right.png", "the right face is 32x64", "left is 32x64", "expected 64x64", "canvas.right="],
    );
    assert!(!message.contains("front"), "{message}");
    let message = bench.fail(1, &["convert", "wide_{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["128x64", "a square"]);
}

#[test]
fn truncated_files() {
    let bench = Bench::new();
    let panorama = picture(1, 64, 32);
    for name in ["cut.png", "cut.jpg", "cut.exr", "cut.tif", "cut.tga", "cut.hdr"] {
        let float = floats(64, 32, |i, j| [i as f32, j as f32, (i * j % 7) as f32]);
        let is_float = name.ends_with("exr") || name.ends_with("hdr");
        bench.save(name, if is_float { &float } else { &panorama });
        let whole = bench.bytes(name);
        std::fs::write(bench.path(name), &whole[..whole.len() * 2 / 3]).unwrap();
        let message =
            bench.fail(1, &["convert", name, "out.png", "--from", "equirect", "--to", "omnimax", "--size", "32"]);
        assert_says(&message, &[name, "damaged or truncated"]);
    }
}

/// A PNG header that declares 65535×65535 pixels of RGBA, 16 bits each, and nothing after it.
fn bomb() -> Vec<u8> {
    let mut header = b"IHDR".to_vec();
    header.extend(65535u32.to_be_bytes());
    header.extend(65535u32.to_be_bytes());
    header.extend([16, 6, 0, 0, 0]);
    let mut file = b"\x89PNG\r\n\x1a\n\0\0\0\r".to_vec();
    let checksum = header.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 })
    });
    file.extend(&header);
    file.extend((!checksum).to_be_bytes());
    // The start of pixel data, so that the header is all that a reader may look at.
    file.extend(b"\0\0\0\x08IDAT\x78\x9c\0\0\0\0\0\0");
    file
}

#[test]
fn an_absurd_size_is_refused_before_memory_is_taken() {
    let bench = Bench::new();
    std::fs::write(bench.path("bomb.png"), bomb()).unwrap();
    assert!(bomb().len() < 100);
    let args = [
        "convert",
        "bomb.png",
        "out.png",
        "--from",
        "equirect:hfov=360,vfov=180",
        "--to",
        "omnimax",
        "--size",
        "32",
        "--memory",
        "2G",
    ];
    let message = bench.fail(1, &args);
    let lie = ["bomb.png", "bytes cannot hold 65535x65535"];
    assert_says(&message, &lie);
    assert_says(&bench.fail(1, &["info", "bomb.png"]), &lie);
    bench.save("small.png", &picture(0, 64, 32));
    let message = bench.fail(1, &["compare", "bomb.png", "small.png"]);
    assert_says(&message, &lie);
    let explain = ["explain", "bomb.png", "--from", "equirect:hfov=360,vfov=180", "--to", "fisheye", "--size", "64"];
    assert_says(&bench.fail(1, &explain), &lie);
    let message =
        bench.fail(1, &["convert", "small.png", "out.png", "--to", "fulldome", "--size", "200000", "--memory", "500M"]);
    assert_says(&message, &["--memory", "200000x200000"]);
}

/// What an option promises is not there for that: taking it would end the program in the middle.
#[cfg(target_os = "linux")]
#[test]
fn memory_that_there_is_not_is_not_promised() {
    let bench = Bench::new();
    bench.save("small.png", &picture(0, 64, 32));
    let before = bench.files();
    let program = env!("CARGO_BIN_EXE_cosmorama");
    for (verb, what) in [
        ("convert small.png out.jpg --from equirect --to fulldome --size 40000 --filter two-pass", "40000x40000"),
        ("explain --from cube --input-size 26000 --to fulldome --size 64", "26000x26000"),
    ] {
        // Kibibytes of address space, as farms limit their jobs.
        let script = format!("ulimit -v 3000000; exec {program} {verb} --threads 2 --memory 100000G");
        let output =
            std::process::Command::new("sh").args(["-c", &script]).current_dir(bench.path("")).output().unwrap();
        let message = bench.check_failure(1, &output, &before);
        // The program itself takes some of the 2.9 GiB.
        assert_says(&message, &["there are 2.", " GiB, whatever --memory says (97.7 TiB)", what]);
    }
    // Where what is needed is there, a promise of more does no harm.
    let args = ["convert", "small.png", "out.png", "--from", "equirect", "--to", "fulldome", "--size", "64"];
    bench.succeed(&[&args[..], &["--memory", "100000G"]].concat());
}

#[test]
fn explain_is_told_that_its_picture_is_too_large_before_memory_is_taken() {
    let bench = Bench::new();
    let explain = |code: i32, to: &str, size: &str| {
        let sizes = ["--from", "cube", "--input-size", "64", "--to", to, "--size", size, "--memory", "500M"];
        bench.fail(code, &[&["explain"][..], &sizes].concat())
    };
    assert_says(&explain(2, "cylinder:vfov=90,hfov=1e-300", "8"), &["--size 8", "more than 1000000 pixels high"]);
    assert_says(
        &explain(1, "equirect", "1000000x500000"),
        &["the output alone", "its largest picture has 1000000x500000 pixels", "--memory"],
    );
}

#[test]
fn a_window_of_a_huge_canvas_is_refused_before_memory_is_taken() {
    let bench = Bench::new();
    bench.save("one.png", &flat(1, 1, &[9, 9, 9]));
    let to = ["--to", "omnimax", "--size", "32", "--memory", "100M"];
    let from = ["convert", "one.png", "out.png", "--from", "perspective:canvas=65535x65535+0+0"];
    assert_says(&bench.fail(1, &[&from[..], &to].concat()), &["one.png", "65535x65535", "--memory"]);
    let from = ["explain", "--from", "cube", "--input-size", "60000x60000"];
    assert_says(&bench.fail(1, &[&from[..], &to].concat()), &["60000x60000", "--memory"]);
    // A small file says so itself.
    bench.save("huge.exr", &floats(16, 16, |_, _| [0.5; 3]));
    let mut file = bench.bytes("huge.exr");
    let name = b"displayWindow\0box2i\0";
    let far_corner = file.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len() + 4 + 8;
    for at in [far_corner, far_corner + 4] {
        file[at..at + 4].copy_from_slice(&65534_i32.to_le_bytes());
    }
    std::fs::write(bench.path("huge.exr"), file).unwrap();
    let from = ["convert", "huge.exr", "out.png", "--from", "perspective"];
    assert_says(&bench.fail(1, &[&from[..], &to].concat()), &["huge.exr", "65535x65535", "--memory"]);
}

#[test]
fn a_view_as_fine_as_no_image_is() {
    let bench = Bench::new();
    bench.save("dot.png", &picture(1, 64, 64));
    let args = ["convert", "dot.png", "out.png", "--from", "perspective:fov=1e-300", "--to", "equirect"];
    assert_says(&bench.fail(2, &args), &["as fine as the input", "--size"]);
}

#[test]
fn a_face_of_nan() {
    let bench = Bench::new();
    for face in CubeFace::ALL {
        bench.save(&format!("face_{face}.exr"), &floats(32, 32, |_, _| [0.5; 3]));
    }
    bench.save("face_left.exr", &floats(32, 32, |_, _| [f32::NAN; 3]));
    let message = bench.fail(1, &["convert", "face_{face}.exr", "out.exr", "--to", "omnimax", "--size", "64"]);
    assert_says(&message, &["face_left.exr", "NaN"]);
    // Half of it only: the pixels that look there are missing, the rest is fine.
    bench.save("face_left.exr", &floats(32, 32, |_, j| if j < 16 { [f32::NAN; 3] } else { [0.5; 3] }));
    let message = bench.fail(1, &["convert", "face_{face}.exr", "out.exr", "--to", "omnimax", "--size", "64"]);
    assert_says(&message, &["face_left.exr (512)", "--missing"]);
    bench.succeed(&["convert", "face_{face}.exr", "out.exr", "--to", "omnimax", "--size", "64", "--missing", "black"]);
}

#[test]
fn a_window_larger_than_its_canvas() {
    let bench = Bench::new();
    bench.save("view.png", &flat(64, 64, &[10, 20, 30]));
    let from = "perspective:canvas=50x50+0+0";
    let message = bench.fail(2, &["convert", "view.png", "out.png", "--from", from, "--to", "perspective"]);
    assert_says(&message, &["view.png", "64x64", "50x50"]);
}

#[test]
fn a_face_beside_its_canvas() {
    let bench = Bench::new();
    bench.faces("face_", 32);
    for place in ["100+0", "0+-32"] {
        let from = format!("cube:canvas.left=64x64+{place}");
        let message = bench.fail(2, &["convert", "face_{face}.png", "out.png", "--from", &from, "--to", "omnimax"]);
        assert_says(&message, &["face_left.png", "beside their canvas of 64x64"]);
    }
}

#[test]
fn two_namings_that_match() {
    let bench = Bench::new();
    for name in ["front", "left", "f", "l"] {
        bench.face(&format!("{name}.png"), CubeFace::Front, 16, 16);
    }
    let message = bench.fail(1, &["convert", "{face}.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["two namings", "naming="]);
}

#[test]
fn an_input_that_does_not_tell_its_projection() {
    let bench = Bench::new();
    bench.save("odd.png", &picture(1, 50, 40));
    let message = bench.fail(1, &["convert", "odd.png", "out.png", "--to", "omnimax"]);
    assert_says(&message, &["50x40", "perspective", "fisheye", "fulldome", "omnimax", "{face}"]);
}

#[test]
fn frames_missing_in_the_middle_are_all_named_before_work_starts() {
    let bench = Bench::new();
    for frame in [1, 2, 4, 7, 8] {
        for face in CubeFace::ALL {
            if frame != 2 || face != CubeFace::Left {
                bench.face(&format!("{face}/{face}_{frame:04}.png"), face, 16, 16);
            }
        }
    }
    let args = ["convert", "{face}/{face}_####.png", "dome_####.png", "--to", "omnimax"];
    let message = bench.fail(1, &args);
    let five = "{face}/{face}_####.png (front, right, back, up, down): 3 frames are missing: 3,5,6";
    assert_says(&message, &[five, "left/left_####.png: 4 frames are missing: 2,3,5,6"]);
    let message = bench.fail(1, &[&args[..], &["--frames", "4-9"]].concat());
    assert_says(&message, &["5,6,9"]);
    let message =
        bench.fail(2, &["convert", "{face}/{face}_####.png", "dome.png", "--to", "omnimax", "--frames", "7-8"]);
    assert_says(&message, &["2 frames", "dome.png", "####"]);
    bench.succeed(&[&args[..], &["--frames", "7-8"]].concat());
}

#[test]
fn a_frame_of_another_size() {
    let bench = Bench::new();
    bench.save("sky_1.png", &picture(1, 64, 32));
    bench.save("sky_2.png", &picture(2, 128, 64));
    let args = ["convert", "sky_#.png", "out_#.png", "--to", "omnimax", "--size", "32"];
    let output = bench.run(&args);
    assert_eq!(output.status.code(), Some(1));
    assert_says(&crate::bench::text(&output.stderr), &["sky_2.png", "128x64", "64x32"]);
    // Its header tells before any frame is converted.
    assert!(!bench.path("out_1.png").exists() && !bench.path("out_2.png").exists());
}

#[test]
fn nothing_of_the_input_in_view() {
    let bench = Bench::new();
    bench.save("ahead.png", &flat(32, 32, &[9, 9, 9]));
    let args = [
        "convert",
        "ahead.png",
        "out.png",
        "--from",
        "perspective:fov=20",
        "--to",
        "perspective:fov=20",
        "--yaw",
        "180",
    ];
    let message = bench.fail(1, &args);
    assert_says(&message, &["empty", "--yaw"]);
}

#[test]
fn pictures_too_small_to_be_seen_and_canvases_too_long_are_told() {
    let bench = Bench::new();
    bench.save("two.png", &flat(2, 1, &[200, 100, 50]));
    for from in ["mollweide", "mirror-ball"] {
        let told = bench.fail(1, &["convert", "two.png", "out.png", "--from", from, "--to", "equirect", "--size", "8"]);
        assert_says(&told, &["the output would be empty", "none of its pixels sees a texel of the input"]);
    }
    let long = "equirect:canvas=16252960x1+0+0";
    let told = bench.fail(1, &["convert", "two.png", "out.png", "--from", long, "--to", "fisheye", "--size", "8"]);
    assert_says(&told, &["two.png: its canvas of 16252960x1 pixels is longer than any picture", "1 to 1000000 pixels"]);
}
