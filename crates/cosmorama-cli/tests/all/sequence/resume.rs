//! What `--resume` promises: nothing that is complete is made again, and all else is.

use crate::bench::{Bench, assert_says, flat, picture, text};
use serde_json::Value;

#[test]
fn resume_keeps_what_is_complete_and_makes_the_rest() {
    let bench = Bench::new();
    for frame in 1..=5 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args = ["convert", "sky_#.png", "out_#.png", "--to", "fisheye", "--size", "32", "--json"];
    bench.succeed(&args);
    let made: Vec<Vec<u8>> = (1..=5).map(|frame| bench.bytes(&format!("out_{frame}.png"))).collect();
    // Complete but different, truncated, of another size, gone, of other channels: only the first may stay.
    bench.save("out_1.png", &flat(32, 32, &[1, 2, 3]));
    std::fs::write(bench.path("out_2.png"), &made[1][..made[1].len() / 2]).unwrap();
    bench.save("out_3.png", &flat(16, 16, &[1, 2, 3]));
    std::fs::remove_file(bench.path("out_4.png")).unwrap();
    bench.save("out_5.png", &flat(32, 32, &[1]));
    let output = bench.run(&[&args[..], &["--resume"]].concat());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&4.into(), &1.into()));
    // What was there and is not kept is told, each with its reason; what was not there is no news.
    let reasons = [
        ("out_2.png", "damaged or truncated PNG: it ends too early"),
        ("out_3.png", "16x16 instead of 32x32"),
        ("out_5.png", "grey instead of RGB"),
    ];
    let told = crate::bench::text(&output.stderr);
    let remade = report["remade"].as_array().unwrap();
    assert_eq!(remade.len(), reasons.len(), "{remade:?}");
    for ((file, reason), one) in reasons.into_iter().zip(remade) {
        assert_eq!((&one["output"], &one["reason"]), (&file.into(), &reason.into()));
        crate::bench::assert_says(&told, &["warning: --resume: 3 outputs", &format!("{file} ({reason})")]);
        assert!(report["warnings"].to_string().contains(file), "{report}");
    }
    assert_eq!(bench.load("out_1.png"), flat(32, 32, &[1, 2, 3]));
    for frame in 2..=5 {
        assert!(bench.bytes(&format!("out_{frame}.png")) == made[frame - 1], "frame {frame}");
    }
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--resume"]].concat())).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &5.into()));
    // Nothing is made again, and the frame of another program, which does not say how it was made, is told.
    let warnings = report["warnings"].to_string();
    assert!(report["remade"].as_array().unwrap().is_empty() && !warnings.contains("made again"), "{warnings}");
    assert!(warnings.contains("--resume: 1 output is kept by size, samples and date alone"), "{warnings}");
    bench.succeed(&[&args[..], &["-y"]].concat());
    assert!(bench.bytes("out_1.png") == made[0]);
}

#[cfg(unix)]
#[test]
fn resume_makes_again_what_is_of_another_format_or_no_file() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let args = ["--to", "fisheye", "--size", "32", "--json"];
    bench.succeed(&[&["convert", "sky.png", "out.jpg"], &args[..]].concat());
    std::fs::rename(bench.path("out.jpg"), bench.path("out.png")).unwrap();
    let again = [&["convert", "sky.png", "out.png", "--resume"], &args[..]].concat();
    let report: Value = serde_json::from_str(&bench.succeed(&again)).unwrap();
    assert_eq!(report["remade"][0]["reason"], "JPEG instead of PNG", "{report}");
    std::fs::remove_file(bench.path("out.png")).unwrap();
    // To read it would take for ever: nobody writes. And what is no file is not replaced.
    assert!(std::process::Command::new("mkfifo").arg(bench.path("out.png")).status().unwrap().success());
    let message = bench.fail(1, &again);
    assert_says(&message, &["cannot write out.png", "a pipe or a device"]);
}

#[test]
fn resume_knows_its_own_outputs_in_every_format() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let formats = ["png", "jpg", "tif", "tga", "hdr", "exr"].map(|end| (format!("out.{end}"), "--to=fisheye"));
    let textures = ["ktx2", "dds"].map(|end| (format!("out.{end}"), "--to=cube"));
    for (out, to) in formats.iter().chain(&textures) {
        resumed(&bench, &["convert", "sky.png", out, to, "--size", "16", "--from=equirect"]);
    }
    for depth in ["half", "float"] {
        let out = format!("{depth}.exr");
        let args = ["convert", "sky.png", &out, "--to=fisheye", "--size=16", "--from=equirect", "--st-map", "--depth"];
        resumed(&bench, &[&args[..], &[depth]].concat());
    }
    resumed(&bench, &["convert", "builtin:grid", "grid.png", "--to=fisheye", "--size=32"]);
    // Whether numbers without a picture are whole cannot be told.
    let args = ["convert", "builtin:direction-map", "map.exr", "--to=fisheye", "--size=32", "--resume"];
    crate::bench::assert_says(&bench.fail(2, &args), &["--resume", "builtin:direction-map", "--overwrite"]);
}

/// Faces that no frame needs, or only some of a camera's path, are inputs all the same: in whatever parts frames are made.
#[test]
fn frames_of_a_cube_of_which_some_faces_are_needed_are_kept() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.faces(&format!("sky{frame}_"), 16);
    }
    let still = ["convert", "sky#_{face}.png", "out_#.png", "--to", "fulldome", "--size", "16"];
    let turn = ["convert", "sky1_{face}.png", "turn_#.png", "--to", "perspective:fov=40", "--size", "16", "--frames"];
    std::fs::write(bench.path("path.csv"), "frame,yaw,pitch,roll\n1,0,0,0\n4,120,0,0\n").unwrap();
    let path = ["--path", "path.csv", "--json"];
    let kept = |args: &[&str]| {
        let report: Value = serde_json::from_str(&bench.succeed(args)).unwrap();
        [&report["frames"], &report["skipped"]].map(|count| count.as_u64().unwrap())
    };
    bench.succeed(&still);
    assert_eq!(kept(&[&still[..], &["--resume", "--json"]].concat()), [0, 4]);
    bench.succeed(&[&turn[..], &["1"], &path].concat());
    assert_eq!(kept(&[&turn[..], &["1-3"], &path, &["--resume"]].concat()), [2, 1]);
    assert_eq!(kept(&[&turn[..], &["2-4"], &path, &["--resume"]].concat()), [1, 2]);
    // A still cube as backdrop has frames of its own chunk, too.
    bench.save("hole.png", &picture(1, 16, 8));
    let over = ["convert", "hole.png", "over_#.png", "--from", "perspective:fov=20", "--backdrop", "sky1_{face}.png"];
    let over = [&over[..], &["--to", "perspective:fov=40", "--size", "16", "--frames"]].concat();
    bench.succeed(&[&over[..], &["1"], &path].concat());
    assert_eq!(kept(&[&over[..], &["1-4"], &path, &["--resume"]].concat()), [3, 1]);
}

#[test]
fn frames_by_other_settings_or_of_other_inputs_are_no_part_of_it() {
    for end in ["png", "exr", "tif", "jpg", "hdr"] {
        let bench = Bench::new();
        for frame in 1..=3 {
            bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
        }
        let out = format!("out_#.{end}");
        let args = ["convert", "sky_#.png", &out, "--to", "fisheye", "--size", "16", "--from", "equirect"];
        bench.succeed(&args);
        let resume = [&args[..], &["--resume"]].concat();
        let report: Value = serde_json::from_str(&bench.succeed(&[&resume[..], &["--json"]].concat())).unwrap();
        assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &3.into()), "{end}: {report}");
        for (more, part) in [
            (["--yaw", "20"], "other geometry"),
            (["--filter", "point"], "other filter"),
            (["--background", "red"], "other colours"),
        ] {
            let told = bench.fail(1, &[&resume[..], &more].concat());
            assert_says(&told, &["--resume", &format!("out_1.{end} was made with"), part, "-y"]);
        }
        bench.save("sky_2.png", &picture(7, 64, 32));
        let told = bench.fail(1, &resume);
        assert_says(&told, &[&format!("out_2.{end} was made with other inputs")]);
        // A frame of another number, in its place.
        bench.save("sky_2.png", &picture(2, 64, 32));
        std::fs::copy(bench.path(&format!("out_3.{end}")), bench.path(&format!("out_1.{end}"))).unwrap();
        assert_says(&bench.fail(1, &resume), &[&format!("out_1.{end} was made with other inputs")]);
        std::fs::remove_file(bench.path(&format!("out_1.{end}"))).unwrap();
        bench.succeed(&resume);
        // A digit of a digest is damage, not other settings, and so is a bit of any letter, or of the program's name.
        for (word, bit) in [("geometry ", 1), ("geome", 0x80), ("cosmorama", 0x10), ("cosmo", 0x80), (", chec", 0x80)] {
            let path = bench.path(&format!("out_2.{end}"));
            let mut file = std::fs::read(&path).unwrap();
            let behind = file.windows(word.len()).position(|found| found == word.as_bytes()).unwrap() + word.len();
            file[behind] ^= bit;
            std::fs::write(&path, file).unwrap();
            let verified = bench.run(&["verify", &out, "--frames", "1-3"]);
            assert_says(&text(&verified.stdout), &["damaged", ": 2\n"]);
            let report: Value = serde_json::from_str(&bench.succeed(&[&resume[..], &["--json"]].concat())).unwrap();
            assert_eq!((&report["frames"], &report["skipped"]), (&1.into(), &2.into()), "{end}, {word}: {report}");
        }
    }
}

/// Runs a command again with `--resume`; all frames that it wants are kept.
#[track_caller]
fn kept(bench: &Bench, args: &[&str]) {
    let report: Value = serde_json::from_str(&bench.succeed(&[args, &["--resume", "--json"]].concat())).unwrap();
    assert_eq!(&report["frames"], &0, "{args:?}: {report}");
}

#[test]
fn digests_are_of_what_is_computed() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args = ["convert", "sky_#.png", "out_#.png", "--to", "fulldome", "--size", "16", "--from", "equirect"];
    let with = |more: &[&'static str]| [&args[..], more].concat();
    bench.succeed(&with(&["--yaw", "90"]));
    let same: [&[&str]; 4] =
        [&["--yaw", "450"], &["--yaw=-270"], &["--yaw", "90", "--pitch", "0"], &["--yaw", "90", "--threads", "1"]];
    for same in same {
        kept(&bench, &with(same));
    }
    kept(
        &bench,
        &["convert", "sky_#.png", "out_#.png", "--to", "fulldome:yaw=90", "--size", "16x16", "--kernel", "adaptive"],
    );
    // Frames may be moved.
    for frame in 1..=4 {
        std::fs::copy(bench.path(&format!("out_{frame}.png")), bench.path(&format!("moved_{frame}.png"))).unwrap();
    }
    let moved = with(&["--yaw", "90"]);
    kept(&bench, &[&moved[..2], &["moved_#.png"], &moved[3..]].concat());
    for (more, part) in [
        (&["--yaw", "90", "--transfer", "gamma:2.2"][..], "other colours"),
        (&["--yaw", "90", "--in-transfer", "linear"], "other colours"),
        (&["--yaw", "91"], "other geometry"),
        (&["--yaw", "90", "--pitch", "1"], "other geometry"),
        (&["--yaw", "90", "--kernel", "light"], "other filter"),
    ] {
        let told = bench.fail(1, &[&with(more)[..], &["--resume"]].concat());
        assert_says(&told, &["out_1.png was made with", part]);
    }
    for other in [["fulldome", "24"], ["fulldome:tilt=1", "16"]] {
        let [to, size] = other;
        let more = ["--to", to, "--size", size, "--from", "equirect", "--yaw", "90", "--resume"];
        let told = bench.fail(1, &[&args[..3], &more].concat());
        assert_says(&told, &["out_1.png was made with other geometry"]);
    }
}

#[test]
fn frames_of_a_turn_over_other_frames_are_no_part_of_it() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let args = |frames: &'static str, yaw: &'static str| {
        let args = ["convert", "sky.png", "out_#.png", "--to", "fisheye", "--size", "16", "--from", "equirect"];
        [&args[..], &["--frames", frames, "--yaw", yaw]].concat()
    };
    bench.succeed(&args("1-4", "0..90"));
    kept(&bench, &args("1-4", "0..90"));
    kept(&bench, &args("1-4", "360..450"));
    // The first frame is the same; the second has moved less.
    let told = bench.fail(1, &[&args("1-8", "0..90")[..], &["--resume"]].concat());
    assert_says(&told, &["out_2.png was made with other poses", "and 2 more were made otherwise", "--frames 2-4 "]);
    // The same degrees a frame, over more of them, go on.
    let longer = [&args("1-7", "0..180")[..], &["--resume", "--json"]].concat();
    let report: Value = serde_json::from_str(&bench.succeed(&longer)).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&3.into(), &4.into()), "{report}");
    let told = bench.fail(1, &[&args("1-4", "0..90")[..], &["--resume", "--shutter", "0.5"]].concat());
    assert_says(&told, &["out_1.png was made with other"]);
}

#[test]
fn files_behind_and_beside_are_inputs_too() {
    let bench = Bench::new();
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame}.tga"), &picture(frame, 96, 48));
        bench.save(&format!("cap_{frame}.png"), &picture(frame + 5, 32, 32));
    }
    let world = |spec: &str| {
        let views = format!(
            "[[view]]\nimage = \"sky_#.tga\"\nspec = \"equirect\"\n\
             [[view]]\nimage = \"cap_#.png\"\nspec = \"{spec}\"\npriority = 2\n"
        );
        std::fs::write(bench.path("world.toml"), views).unwrap();
    };
    world("perspective:fov=60");
    let args = ["convert", "world.toml", "out_#.png", "--to", "fisheye", "--size", "16"];
    bench.succeed(&args);
    kept(&bench, &args);
    let resume = [&args[..], &["--resume"]].concat();
    world("perspective:fov=61");
    assert_says(&bench.fail(1, &resume), &["out_1.png was made with other geometry"]);
    world("perspective:fov=60");
    kept(&bench, &args);
    // In the middle of a file without compression.
    let mut bytes = bench.bytes("sky_2.tga");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    std::fs::write(bench.path("sky_2.tga"), bytes).unwrap();
    assert_says(&bench.fail(1, &resume), &["out_2.png was made with other inputs"]);
    // Only the frame's own files of a backdrop count.
    let args =
        ["convert", "cap_#.png", "over_#.png", "--from", "perspective:fov=60", "--to", "fisheye", "--size", "16"];
    let args = [&args[..], &["--backdrop", "sky_#.tga"]].concat();
    bench.succeed(&args);
    kept(&bench, &args);
    bench.save("sky_2.tga", &picture(9, 96, 48));
    let told = bench.fail(1, &[&args[..], &["--resume"]].concat());
    assert_says(&told, &["over_2.png was made with other inputs"]);
    assert!(!told.contains("over_1.png"), "{told}");
}

#[test]
fn stripped_frames_say_nothing_of_how_they_were_made() {
    let bench = Bench::new();
    bench.save("sky_1.png", &picture(1, 64, 32));
    let args =
        ["convert", "sky_1.png", "out_1.png", "--to", "fisheye", "--size", "16", "--from", "equirect", "--strip"];
    let args = [&args[..], &["--frames", "1"]].concat();
    let sequence = args.iter().map(|word| word.replace("_1.", "_#.")).collect::<Vec<_>>();
    let sequence: Vec<&str> = sequence.iter().map(String::as_str).collect();
    bench.succeed(&sequence);
    let path = bench.path("out_1.png");
    assert_eq!(cosmorama_io::probe(&path).unwrap().metadata.origin, None);
    kept(&bench, &[&sequence[..], &["--yaw", "20"]].concat());
    let said = bench.run(&[&sequence[..], &["--yaw", "20", "--resume"]].concat());
    let told = crate::bench::text(&said.stderr);
    crate::bench::assert_says(
        &told,
        &["warning: --resume: 1 output is kept by size, samples and date alone", "--overwrite"],
    );
    // One that says how it was made is compared, and made again without these words.
    let telling: Vec<&str> = sequence.iter().copied().filter(|word| *word != "--strip").collect();
    bench.succeed(&[&telling[..], &["-y"]].concat());
    let told = bench.fail(1, &[&sequence[..], &["--yaw", "20", "--resume"]].concat());
    crate::bench::assert_says(&told, &["out_1.png was made with other geometry"]);
    bench.succeed(&[&sequence[..], &["--resume"]].concat());
    assert_eq!(cosmorama_io::probe(&path).unwrap().metadata.origin, None);
}

/// A format that has no room for words: what is older than its input is made again.
#[test]
fn frames_that_say_nothing_are_made_again_if_an_input_is_newer() {
    use std::time::{Duration, SystemTime};

    let bench = Bench::new();
    let args = ["convert", "sky_#.png", "out_#.tga", "--to", "fisheye", "--size", "16", "--from", "equirect"];
    let resume = [&args[..], &["--resume", "--json"]].concat();
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    bench.succeed(&args);
    let made = bench.bytes("out_2.tga");
    bench.save("sky_2.png", &picture(7, 64, 32));
    // Not by the clock, whose ticks may be longer than this test.
    let set = |name: &str, seconds: u64| {
        let file = std::fs::File::options().write(true).open(bench.path(name)).unwrap();
        file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(seconds)).unwrap();
    };
    for (name, seconds) in [("sky_1.png", 1000), ("out_1.tga", 1000), ("out_2.tga", 1000), ("sky_2.png", 1001)] {
        set(name, seconds);
    }
    let report: Value = serde_json::from_str(&bench.succeed(&resume)).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&1.into(), &1.into()), "{report}");
    assert_eq!(report["remade"][0]["reason"], "older than its input sky_2.png", "{report}");
    assert!(report["warnings"].to_string().contains("1 output is kept by size, samples and date alone"), "{report}");
    assert!(bench.bytes("out_2.tga") != made);
}

#[test]
fn frames_of_a_formula_say_which_it_is() {
    let bench = Bench::new();
    let frames = ["out_#.png", "--to", "fisheye", "--size", "32", "--frames", "1-3", "--yaw", "0..9"];
    bench.succeed(&[&["convert", "builtin:checker"], &frames[..]].concat());
    let made: Vec<Vec<u8>> = (1..=3).map(|frame| bench.bytes(&format!("out_{frame}.png"))).collect();
    std::fs::remove_file(bench.path("out_2.png")).unwrap();
    let told = bench.fail(1, &[&["convert", "builtin:demo", "--resume"], &frames[..]].concat());
    assert_says(&told, &["out_1.png was made with other inputs"]);
    let again = bench.succeed(&[&["convert", "builtin:checker", "--resume", "--json"], &frames[..]].concat());
    let report: Value = serde_json::from_str(&again).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&1.into(), &2.into()));
    assert!((1..=3).all(|frame| bench.bytes(&format!("out_{frame}.png")) == made[frame - 1]));
}

/// Makes a picture; what is made is kept when it is asked for again.
#[track_caller]
fn resumed(bench: &Bench, args: &[&str]) {
    bench.succeed(args);
    let report: Value =
        serde_json::from_str(&bench.succeed(&[args, &["--resume", "--json"]].concat())).expect("a report");
    assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &1.into()), "{args:?}: {report}");
}

#[test]
fn some_frames_of_a_turn_alone_are_another_turn() {
    let bench = Bench::new();
    for frame in 1..=5 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let dome = ["convert", "sky_#.png", "out_#.png", "--from", "equirect", "--to", "fulldome:tilt=20", "--size", "16"];
    let turn = [&dome[..], &["--yaw", "0..60"]].concat();
    bench.succeed(&turn);
    let expected = bench.bytes("out_3.png");
    let told = text(&bench.run(&[&turn[..], &["--frames", "4,3", "-y"]].concat()).stderr);
    assert_says(&told, &["out_1.png and 2 more exist", "--frames 3,4", "--resume", "--path"]);
    let told = bench.fail(1, &[&turn[..], &["--resume"]].concat());
    assert_says(&told, &["out_3.png was made with other poses", "remove frame", "would be another turn"]);
    for name in ["out_3.png", "out_4.png"] {
        std::fs::remove_file(bench.path(name)).unwrap();
    }
    let resumed = bench.run(&[&turn[..], &["--resume"]].concat());
    let told = text(&resumed.stderr);
    assert!(resumed.status.success() && !told.contains("no part of this turn"), "{told}");
    assert!(bench.bytes("out_3.png") == expected);
    // Of a path, frames have their own poses; one of another tilt is found.
    std::fs::write(bench.path("path.csv"), "frame,yaw,pitch,roll\n1,0,0,0\n5,60,0,0\n").unwrap();
    bench.succeed(&[&dome[..], &["--path", "path.csv", "-y"]].concat());
    bench.succeed(&[&dome[..], &["--path", "path.csv", "-y", "--frames", "2"]].concat());
    assert_eq!(bench.succeed(&["verify", "out_#.png"]), "5 frames are whole and alike\n");
    let tilted = dome.map(|word| if word == "fulldome:tilt=20" { "fulldome:tilt=25" } else { word });
    bench.succeed(&[&tilted[..], &["--path", "path.csv", "-y", "--frames", "2"]].concat());
    let verified = text(&bench.run(&["verify", "out_#.png"]).stdout);
    assert_says(&verified, &["made by other settings than most: 2"]);
}

/// Frames of one video are made from one file, and are told apart all the same.
#[test]
fn a_frame_in_the_place_of_another_is_made_again() {
    if !super::films::has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    super::films::film(&bench, "film.mkv", 4);
    let args = ["convert", "film.mkv", "out_#.png", "--from", "equirect", "--to", "fulldome", "--size", "16"];
    bench.succeed(&args);
    kept(&bench, &args);
    std::fs::copy(bench.path("out_1.png"), bench.path("out_2.png")).unwrap();
    let told = bench.fail(1, &[&args[..], &["--resume"]].concat());
    assert_says(&told, &["out_2.png was made with other inputs"]);
}
