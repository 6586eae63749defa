//! Outputs that cannot be, or may not: nothing that is there is lost, and nothing in parts is left.

use crate::bench::{Bench, assert_says, flat, picture};

#[test]
fn compare_replaces_nothing_unasked() {
    let bench = Bench::new();
    bench.save("a.png", &picture(1, 16, 16));
    bench.save("b.png", &picture(2, 16, 16));
    bench.save("c.png", &picture(3, 16, 16));
    let before = [bench.bytes("a.png"), bench.bytes("c.png")];
    let message = bench.fail(2, &["compare", "a.png", "b.png", "--diff", "./a.png", "-y"]);
    assert_says(&message, &["--diff", "a.png", "another name"]);
    let message = bench.fail(1, &["compare", "a.png", "b.png", "--diff", "c.png"]);
    assert_says(&message, &["c.png exists", "--overwrite"]);
    assert_eq!([bench.bytes("a.png"), bench.bytes("c.png")], before);
    bench.succeed(&["compare", "a.png", "b.png", "--diff", "c.png", "-y"]);
    assert_ne!(bench.bytes("c.png"), before[1]);
    let message = bench.fail(1, &["compare", "a.png", "b.png", "--memory", "100"]);
    assert_says(&message, &["a.png", "--memory"]);
}

#[test]
fn explain_replaces_nothing_unasked() {
    let bench = Bench::new();
    bench.faces("face_", 32);
    std::fs::create_dir(bench.path("diagrams")).unwrap();
    std::fs::write(bench.path("diagrams/ownership.png"), "mine").unwrap();
    let args = ["explain", "face_{face}.png", "--to", "omnimax", "--output", "diagrams"];
    assert_says(&bench.fail(1, &args), &["diagrams/ownership.png exists", "--overwrite"]);
    assert_eq!(bench.bytes("diagrams/ownership.png"), b"mine");
    bench.succeed(&[&args[..], &["-y"]].concat());
    assert_ne!(bench.bytes("diagrams/ownership.png"), b"mine");
}

#[test]
fn a_diagram_replaces_no_input() {
    let bench = Bench::new();
    bench.save("unfolded.png", &picture(1, 64, 32));
    let before = bench.bytes("unfolded.png");
    let args = ["explain", "unfolded.png", "--to", "omnimax", "--size", "32", "--output", ".", "-y"];
    assert_says(&bench.fail(2, &args), &["unfolded.png", "replace its own input"]);
    assert_eq!(bench.bytes("unfolded.png"), before);
}

#[test]
fn a_folder_that_is_missing_or_read_only() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let args = ["convert", "sky.png", "nowhere/out.png", "--to", "omnimax", "--size", "32", "--no-mkdir"];
    assert_says(&bench.fail(1, &args), &["nowhere/out.png", "does not exist", "make it first"]);
    let message = bench.fail(1, &["convert", "sky.png", "sky.png/a/out.png", "--to", "omnimax", "--size", "32"]);
    assert_says(&message, &["the folder sky.png/a cannot be made", "choose another"]);
    // Not even root can write here.
    let message = bench.fail(1, &["convert", "sky.png", "/proc/out.png", "--to", "omnimax", "--size", "32"]);
    assert_says(&message, &["cannot write /proc/out.png", "takes no new files"]);
    assert!(!message.contains("not exist"), "{message}");
    let message = bench.fail(1, &["convert", "sky.png", "sky.png/out.png", "--to", "omnimax", "--size", "32"]);
    assert_says(&message, &["cannot write sky.png/out.png", "sky.png is no folder"]);
    // A name that is too long is found out like a folder that is missing, not when the file is to get it.
    let name = format!("{}.png", "x".repeat(300));
    let message = bench.fail(1, &["convert", "sky.png", &name, "--to", "omnimax", "--size", "32"]);
    assert_says(&message, &["cannot write xxx", "choose another name"]);
    let message = bench.fail(2, &["explain", "sky.png", "--to", "omnimax", "--output", "sky.png/diagrams"]);
    assert_says(&message, &["sky.png is a file, where a folder was expected", "name another"]);
    let piped = bench
        .command(&["convert", "sky.png", "-", "--format", "png", "--to", "omnimax"])
        .env("TMPDIR", bench.path("sky.png"))
        .output()
        .unwrap();
    let message = bench.check_failure(1, &piped, &bench.files());
    assert_says(&message, &["no folder for what is piped can be made in", "TMPDIR="]);
    assert!(!message.contains(".cosmorama-"), "{message}");
}

#[test]
fn folders_of_outputs_are_made() {
    let bench = Bench::new();
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let from = ["--from", "equirect", "--size", "16"];
    bench.succeed(&[&["convert", "sky_1.png", "a/b/dome.png", "--to", "fulldome"], &from[..]].concat());
    bench.succeed(&[&["convert", "sky_#.png", "frames/#/{face}/face.png", "--to", "cube"], &from[..]].concat());
    bench.succeed(&["compare", "sky_1.png", "sky_2.png", "--diff", "c/d/difference.png"]);
    bench.succeed(&[
        "explain",
        "sky_1.png",
        "--from",
        "equirect",
        "--to",
        "fulldome",
        "--size",
        "16",
        "--output",
        "e/f",
    ]);
    let made = ["a/b/dome.png", "frames/2/front/face.png", "c/d/difference.png", "e/f/unfolded.svg"];
    made.into_iter().for_each(|name| assert!(bench.path(name).is_file(), "{name}"));
    let args = ["compare", "sky_1.png", "sky_2.png", "--no-mkdir", "--diff", "g/difference.png"];
    assert_says(&bench.fail(1, &args), &["g/difference.png", "does not exist"]);
}

#[test]
fn a_run_that_fails_leaves_no_new_folder() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let whole = bench.bytes("sky.png");
    std::fs::write(bench.path("cut.png"), &whole[..whole.len() * 2 / 3]).unwrap();
    bench.save("front.png", &picture(1, 16, 16));
    std::fs::create_dir(bench.path("old")).unwrap();
    let to = ["--to", "fulldome", "--size", "16"];
    for (input, output) in [
        // Found out before any work, and while a picture is read.
        ("{face}.png", "new/folder/a.png"),
        ("cut.png", "new/folder/a.png"),
        ("cut.png", "old/new/a.png"),
        ("cut.png", "old/a.png"),
    ] {
        let from = if input == "cut.png" { "equirect" } else { "cube" };
        bench.fail(1, &[&["convert", input, output, "--from", from], &to[..]].concat());
        let is_left = bench.path("new").exists() || bench.path("old/new").exists();
        assert!(!is_left && bench.path("old").is_dir(), "{input} {output}");
    }
    // A frame that fails later leaves what was made before it.
    bench.save("sky_1.png", &picture(1, 64, 32));
    std::fs::copy(bench.path("cut.png"), bench.path("sky_2.png")).unwrap();
    let output = bench.run(&[&["convert", "sky_#.png", "frames/#/a.png", "--from", "equirect"], &to[..]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(bench.path("frames/1/a.png").is_file() && !bench.path("frames/2").exists());
}

/// Only Linux has `/sys`, where not even root can make a file.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_named_without_the_temporary_file() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let message = bench.fail(1, &["convert", "sky.png", "/sys/out.png", "--to", "omnimax", "--size", "32"]);
    assert_says(&message, &["cannot write /sys/out.png", "no files can be made in its folder /sys", "choose another"]);
    assert!(!message.contains(".part"), "{message}");
}

#[test]
fn an_output_that_is_an_input() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let before = bench.bytes("sky.png");
    let message = bench.fail(2, &["convert", "sky.png", "./sky.png", "--to", "omnimax", "--size", "32", "-y"]);
    assert_says(&message, &["replace its own input"]);
    bench.faces("face_", 16);
    let message = bench.fail(2, &["convert", "face_{face}.png", "face_{face}.png", "-y"]);
    assert_says(&message, &["face_front.png", "replace its own input"]);
    assert_eq!(bench.bytes("sky.png"), before);
}

#[test]
fn existing_outputs_are_found_before_work_starts() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    bench.save("out_2.png", &picture(0, 4, 4));
    let args = ["convert", "sky_#.png", "out_#.png", "--to", "omnimax", "--size", "32"];
    let message = bench.fail(1, &args);
    assert_says(&message, &["out_2.png exists", "--overwrite", "--resume"]);
}

/// A limit on the size of files fails as a full disk does: in the middle of writing, or when the last bytes are flushed.
#[cfg(unix)]
#[test]
fn a_full_disk() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    std::fs::create_dir(bench.path("diagrams")).unwrap();
    let before = bench.files();
    let program = env!("CARGO_BIN_EXE_cosmorama");
    let explain = "explain sky.png --to omnimax --output diagrams";
    // Blocks of 512 bytes: for nothing, or for all diagrams but the last.
    for (blocks, verb, file) in [
        (8, "convert sky.png out.png --to equirect --size 800 --depth 16", "out.png"),
        (8, explain, "diagrams/unfolded.svg"),
        (800, explain, "diagrams/footprints.png"),
    ] {
        // Whether or not whoever started the program has it ignore the signal of a limit reached.
        for trap in ["trap '' XFSZ; ", ""] {
            let script = format!("{trap}ulimit -f {blocks}; exec {program} {verb}");
            let output =
                std::process::Command::new("sh").args(["-c", &script]).current_dir(bench.path("")).output().unwrap();
            let message = bench.check_failure(1, &output, &before);
            assert_says(&message, &[&format!("cannot write {file}")]);
        }
    }
}

/// Whoever reads what a program says may be gone, and its disk full: what it does and how it ends is the same.
#[test]
#[cfg(target_os = "linux")]
fn nobody_has_to_listen() {
    let bench = Bench::new();
    for name in ["sky_1.png", "sky_2.png"] {
        bench.save(name, &flat(64, 32, &[90, 120, 180]));
    }
    let code = |args: &[&str]| {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        bench.command(args).stderr(full).output().unwrap().status.code()
    };
    let to = ["--to", "fulldome", "--size", "16", "-y"];
    assert_eq!(code(&[&["convert", "sky_1.png", "one.png"][..], &to].concat()), Some(0));
    for style in ["auto", "plain", "bar", "json", "openjd"] {
        let progress = ["--progress", style];
        assert_eq!(code(&[&["convert", "sky_#.png", "dome_#.png"][..], &to, &progress].concat()), Some(0), "{style}");
    }
    assert!(bench.path("one.png").is_file() && bench.path("dome_2.png").is_file());
    assert_eq!(code(&["info", "none.png"]), Some(1));
    assert_eq!(code(&["convert", "sky_1.png", "two.png", "--to", "nowhere"]), Some(2));
}

/// A link stays, and what it leads to is made or replaced; what is no file stays as it is.
#[test]
#[cfg(unix)]
fn links_are_followed_and_pipes_left_alone() {
    use std::os::unix::fs::symlink;

    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[90, 120, 180]));
    std::fs::create_dir(bench.path("made")).unwrap();
    let args = |output: &'static str| ["convert", "sky.png", output, "--to", "fulldome", "--size", "16", "-y"];
    symlink("made/dome.png", bench.path("near.png")).unwrap();
    symlink("near.png", bench.path("far.png")).unwrap();
    for output in ["near.png", "far.png"] {
        // First the link leads nowhere.
        bench.succeed(&args(output));
        assert!(bench.path(output).is_symlink() && bench.path("made/dome.png").is_file(), "{output}");
        assert_eq!(bench.load("made/dome.png").width(), 16);
        bench.save("made/dome.png", &flat(1, 1, &[0, 0, 0]));
    }
    symlink("round.png", bench.path("round.png")).unwrap();
    assert_says(&bench.fail(1, &args("round.png")), &["cannot write round.png", "nowhere but to each other"]);
    assert!(std::process::Command::new("mkfifo").arg(bench.path("pipe.png")).status().unwrap().success());
    symlink("/dev/null", bench.path("null.png")).unwrap();
    for output in ["pipe.png", "null.png"] {
        assert_says(&bench.fail(1, &args(output)), &[&format!("cannot write {output}"), "a pipe or a device"]);
    }
    assert_says(
        &bench.fail(2, &["explain", "sky.png", "--to", "omnimax", "--output", "sky.png"]),
        &["sky.png is a file"],
    );
}

/// Two outputs never become one file, and a folder that a link leads to is there before the first frame.
#[test]
#[cfg(unix)]
fn outputs_that_links_lead_astray_are_refused_before_the_work() {
    use std::os::unix::fs::symlink;

    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &flat(64, 32, &[90, 120, 180]));
    }
    let args = ["convert", "sky_#.png", "dome_#.png", "--from", "equirect", "--to", "fulldome", "--size", "16", "-y"];
    for (link, other) in [("dome_2.png", "dome_3.png"), ("dome_3.png", "dome_2.png")] {
        symlink(other, bench.path(link)).unwrap();
        assert_says(&bench.fail(2, &args), &["dome_3.png and dome_2.png lead to one file", "remove the link"]);
        std::fs::remove_file(bench.path(link)).unwrap();
    }
    symlink("none/dome.png", bench.path("dome_3.png")).unwrap();
    assert_says(&bench.fail(1, &args), &["none", "does not exist"]);
    assert!(!bench.path("dome_1.png").exists());
}

/// What only its owner could read stays so when it is made anew.
#[test]
#[cfg(unix)]
fn a_replaced_file_is_for_the_same_people() {
    use std::fs::{Permissions, metadata, set_permissions};
    use std::os::unix::fs::PermissionsExt;

    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[90, 120, 180]));
    for mode in [0o600, 0o640, 0o664, 0o444] {
        bench.save("dome.png", &flat(1, 1, &[0, 0, 0]));
        set_permissions(bench.path("dome.png"), Permissions::from_mode(mode)).unwrap();
        bench.succeed(&["convert", "sky.png", "dome.png", "--to", "fulldome", "--size", "16", "-y"]);
        assert_eq!(metadata(bench.path("dome.png")).unwrap().permissions().mode() & 0o777, mode);
        std::fs::remove_file(bench.path("dome.png")).unwrap();
    }
}
