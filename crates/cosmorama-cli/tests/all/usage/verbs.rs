//! The other verbs: `info`, `explain`, `compare`, `demo`, `plates`.

use crate::bench::{Bench, assert_says, eight_bits, flat, picture, text};
use serde_json::Value;

#[test]
fn info_of_a_file() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let info: Value = serde_json::from_str(&bench.succeed(&["info", "sky.png", "--json"])).unwrap();
    let expected = serde_json::json!({
        "input": "sky.png", "format": "PNG", "width": 64, "height": 32, "channels": "RGB", "depth": "8",
        "transfer": "srgb", "projection": "equirect (2:1)",
    });
    for (key, value) in expected.as_object().unwrap() {
        assert_eq!(&info[key], value, "{key}");
    }
    assert!(bench.succeed(&["info", "sky.png"]).contains("\nwidth: 64\nheight: 32\n"));
    assert!(bench.fail(1, &["info", "nothing.png"]).contains("nothing.png"));
}

#[test]
fn info_of_faces() {
    let bench = Bench::new();
    bench.faces("face_", 16);
    std::fs::remove_file(bench.path("face_back.png")).unwrap();
    let info: Value = serde_json::from_str(&bench.succeed(&["info", "face_{face}.png", "--json"])).unwrap();
    assert_eq!(info["naming"], "words");
    assert_eq!(info["faces"]["up"]["file"], "face_top.png");
    assert_eq!(info["faces"]["up"]["width"], 16);
    assert_eq!(info["faces"]["back"]["present"], false);
    assert!(bench.succeed(&["info", "face_{face}.png"]).contains("  back: missing (face_back.png)\n"));
}

#[test]
fn info_of_a_sequence() {
    let bench = Bench::new();
    for frame in [1, 2, 3, 7] {
        bench.save(&format!("sky_{frame:04}.png"), &picture(frame, 64, 32));
    }
    let info: Value = serde_json::from_str(&bench.succeed(&["info", "sky_####.png", "--json"])).unwrap();
    assert_eq!(info["frames"], "1-3,7");
}

#[test]
fn compare_is_a_check() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 64, 64));
    bench.save("b.png", &flat(64, 64, &[128, 128, 128]));
    bench.save("small.png", &picture(1, 32, 32));
    assert!(bench.succeed(&["compare", "a.png", "a.png", "--min-psnr", "60"]).contains("PSNR linear        inf dB"));
    let output = bench.run(&["compare", "a.png", "b.png", "--min-psnr", "60", "--diff", "d.png", "--region", "disc"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(crate::bench::text(&output.stdout).contains("PSNR sRGB-encoded"));
    assert!(crate::bench::text(&output.stderr).contains("less than --min-psnr 60"));
    assert_eq!((bench.load("d.png").width(), bench.load("d.png").height()), (64, 64));
    let report: Value = serde_json::from_str(&bench.succeed(&["compare", "a.png", "b.png", "--json"])).unwrap();
    assert!(report["linear"]["psnr"].as_f64().unwrap() < 30.0);
    assert!(report["shift"].is_null(), "they show different things");
    let report: Value = serde_json::from_str(&bench.succeed(&["compare", "a.png", "a.png", "--json"])).unwrap();
    assert_eq!(report["shift"]["pixels"].as_f64(), Some(0.0));
    let output = bench.run(&["compare", "a.png", "b.png", "--max-shift", "100"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(crate::bench::text(&output.stderr).contains("the shift is not measurable"));
    let message = bench.fail(1, &["compare", "a.png", "small.png"]);
    assert!(message.contains("64x64") && message.contains("32x32"), "{message}");
    assert!(bench.fail(2, &["compare", "a.png", "b.png", "--diff", "d.bmp"]).contains("d.bmp"));
    for many in ["{face}.png", "a_####.png"] {
        let message = bench.fail(2, &["compare", "a.png", many]);
        assert!(message.contains(&format!("{many} is a pattern")) && message.contains("name one file"), "{message}");
    }
    assert!(bench.fail(2, &["compare", ".", "a.png"]).contains(". is a folder"));
    let message = bench.fail(2, &["compare", "a.png", "b.png", "--max-shift", "-1"]);
    assert!(message.contains("--max-shift") && message.contains("not less than 0"), "{message}");
}

#[test]
fn explain_needs_no_files() {
    let bench = Bench::new();
    let args = ["explain", "--from", "cube", "--to", "omnimax", "--size", "1966x1436", "--input-size", "1024x960"];
    let text = bench.succeed(&args);
    assert!(text.contains("right  1024x960  needs 515x960+0+0"), "{text}");
    assert!(text.contains("back   1024x960  not needed"), "{text}");
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--json"]].concat())).unwrap();
    assert_eq!(report[0]["views"][1]["needed"], "514x960+0+0");
    let message = bench.fail(2, &["explain", "--from", "cube", "--to", "omnimax"]);
    assert!(message.contains("--size is missing"), "{message}");
    assert!(bench.fail(2, &["explain", "--to", "omnimax"]).contains("--from"));
}

#[test]
fn explain_draws() {
    let bench = Bench::new();
    bench.faces("face_", 32);
    std::fs::remove_file(bench.path("face_right.png")).unwrap();
    let text = bench.succeed(&["explain", "face_{face}.png", "--to", "omnimax", "--output", "diagrams"]);
    assert!(text.contains("missing  right: no face_right.png"), "{text}");
    for name in ["unfolded", "ownership", "footprints"] {
        assert!(text.contains(&format!("diagrams/{name}.svg")));
        assert!(bench.bytes(&format!("diagrams/{name}.svg")).starts_with(b"<svg"), "{name}");
        assert!(bench.load(&format!("diagrams/{name}.png")).width() > 500);
    }
}

/// Names of files are bytes; reports are text.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let bench = Bench::new();
    let run = |args: &[&str], name: &[u8]| bench.command(args).arg(OsStr::from_bytes(name)).output().unwrap();
    let explain = ["explain", "--from", "cube", "--input-size", "16", "--to", "omnimax", "--size", "32"];
    for args in [&[&explain[..], &["--output"]].concat()[..], &[&explain[..], &["--json", "-y", "--output"]].concat()] {
        let output = run(args, b"bad\xffdir");
        assert!(output.status.success(), "{}", crate::bench::text(&output.stderr));
        assert!(crate::bench::text(&output.stdout).contains("bad\u{fffd}dir/unfolded.svg"));
    }
    assert!(bench.path("").join(OsStr::from_bytes(b"bad\xffdir/footprints.png")).exists());
    bench.save("a.png", &picture(1, 16, 16));
    std::fs::copy(bench.path("a.png"), bench.path("").join(OsStr::from_bytes(b"b\xff.png"))).unwrap();
    let output = run(&["compare", "--json", "a.png"], b"b\xff.png");
    assert!(
        crate::bench::text(&output.stdout).contains("\"second\": \"b\u{fffd}.png\""),
        "{}",
        crate::bench::text(&output.stderr)
    );
    let output = run(&["demo"], b"demo\xff");
    assert_eq!(output.status.code(), Some(2));
    assert!(crate::bench::text(&output.stderr).contains("UTF-8"));
}

#[test]
fn a_demo_replaces_what_a_demo_left_and_nothing_else() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("mine/faces")).unwrap();
    for name in ["mine/omnimax.png", "mine/faces/front.png", "mine/unfolded.svg"] {
        std::fs::write(bench.path(name), "mine").unwrap();
        let message = bench.fail(1, &["demo", "mine"]);
        assert!(message.contains(&format!("{name} exists")) && message.contains("-y"), "{message}");
        assert_eq!(bench.bytes(name), b"mine");
        std::fs::remove_file(bench.path(name)).unwrap();
    }
}

#[test]
fn the_demo_can_be_repeated() {
    let bench = Bench::new();
    // Its own folder's files are replaced unasked.
    std::fs::create_dir(bench.path("cosmorama-demo")).unwrap();
    std::fs::write(bench.path("cosmorama-demo/omnimax.png"), "old").unwrap();
    let told = bench.succeed(&["demo", "--animation", "1"]);
    assert_says(&told, &["the frames in", "--in-path", "--backdrop", "ffmpeg"]);
    assert!(bench.path("cosmorama-demo/animation/frame_0001.png").exists());
    let command = told.lines().find(|line| line.starts_with("  cosmorama convert")).unwrap();
    let first = bench.bytes("cosmorama-demo/omnimax.png");
    std::fs::remove_file(bench.path("cosmorama-demo/omnimax.png")).unwrap();
    // The command that it prints makes the same frame, in a shell.
    let program = format!("\"{}\"", env!("CARGO_BIN_EXE_cosmorama"));
    let script = command.trim().replacen("cosmorama", &program, 1);
    let status = std::process::Command::new("sh").args(["-c", &script]).current_dir(bench.path("")).status().unwrap();
    assert!(status.success(), "{script}");
    assert!(bench.bytes("cosmorama-demo/omnimax.png") == first);
    for name in ["faces/front.png", "faces/up.png", "omnimax-point.png", "unfolded.svg", "unfolded.png"] {
        assert!(told.contains(name) && bench.path(&format!("cosmorama-demo/{name}")).exists(), "{name}");
    }
    assert!(!bench.path("cosmorama-demo/faces/back.png").exists());
}

#[test]
fn all_plates_and_figures_are_made_and_none_is_replaced_unasked() {
    let bench = Bench::new();
    let told = bench.succeed(&["plates", "made", "--size", "48"]);
    let plates = (1..=7).map(|number| format!("plate{number}.png")).chain(["figure1.png".to_owned()]);
    for name in plates {
        let image = bench.load(&format!("made/{name}"));
        let pixels = eight_bits(&image);
        let (least, greatest) = (pixels.iter().min().unwrap(), pixels.iter().max().unwrap());
        assert!(told.contains(&name) && greatest - least > 20, "{name}: {least} to {greatest}");
    }
    for name in ["figure2-mercator.svg", "figure2-cube.png", "world/sky.png", "world/mercator.png", "world/up.png"] {
        assert!(bench.path(&format!("made/{name}")).exists(), "{name}");
    }
    let frame = bench.load("made/plate7.png");
    assert_eq!((frame.width(), frame.height()), (122, 89));
    let output = bench.command(&["plates", "made", "--size", "32", "-y", "--progress", "plain"]).output().unwrap();
    assert_says(&text(&output.stderr), &["picture: 1 of 11 done", "picture: 11 of 11 done"]);
    assert_says(&bench.fail(1, &["plates", "made", "--size", "48"]), &["outputs exist", "made/plate1.png", "-y"]);
    assert_says(&bench.fail(2, &["plates", "others", "--size", "9"]), &["--size", "from 32 to 8192"]);
}

/// Whatever a verb makes: an interrupt ends it soon, and nothing half made is left.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_ends_every_verb() {
    use std::time::{Duration, Instant};
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 2048, 1024));
    let all = [
        "shade sky.png out.exr --from equirect --material roughness=0.3,metallic=1 --size 8192x8192",
        "light diffuse sky.png out.exr --from equirect --to equirect --size 8192 --exact",
        "plates plates",
        "filters sky.png --from equirect --to fulldome --size 2048 --output filters",
        "explain sky.png --from equirect --to fulldome --size 8192 --template template",
    ];
    for (args, (signal, code)) in all.iter().zip([("INT", 130), ("TERM", 143)].iter().cycle()) {
        let before = bench.files();
        // A shell has interrupts ignored for all that it starts in the background, the tests among them.
        let mut command = std::process::Command::new("env");
        command.args(["--default-signal", env!("CARGO_BIN_EXE_cosmorama")]).args(args.split(' '));
        let mut child = command.current_dir(bench.path("")).stderr(std::process::Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(700));
        assert!(child.try_wait().unwrap().is_none(), "{args} has ended by itself");
        let kill = std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        let asked = Instant::now();
        assert_eq!(child.wait().unwrap().code(), Some(*code), "{args}");
        assert!(asked.elapsed() < Duration::from_secs(2), "{args} took {:?} to end", asked.elapsed());
        let made: Vec<_> = bench.files().into_iter().filter(|path| !before.contains(path)).collect();
        assert!(made.iter().all(|path| !path.to_string_lossy().contains("/.cosmorama-")), "{args}: {made:?}");
    }
}
