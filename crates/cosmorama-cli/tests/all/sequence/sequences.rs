//! What running promises: threads, frames, reports, interrupts.

use crate::bench::{Bench, assert_says, flat, picture, text};
use cosmorama::sphere::CubeFace;
use serde_json::Value;

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let bench = Bench::new();
    bench.faces("face_", 128);
    for filter in ["ewa", "ewa-pyramid", "bilinear", "reference:samples=2"] {
        let bytes = |threads: &str| {
            let args = ["convert", "face_{face}.png", "out.png", "--to", "omnimax", "--size", "200", "-y"];
            bench.succeed(&[&args[..], &["--filter", filter, "--threads", threads]].concat());
            bench.bytes("out.png")
        };
        let one = bytes("1");
        assert!(one == bytes("2") && one == bytes("7"), "{filter}");
    }
}

#[test]
fn a_sequence_is_the_same_as_its_frames() {
    let bench = Bench::new();
    for frame in 1..=3 {
        for face in CubeFace::ALL {
            bench.save(&format!("{face}/{face}_{frame:04}.png"), &picture(frame + face as usize, 48, 48));
        }
    }
    let args = ["convert", "{face}/{face}_####.png", "dome_%03d.png", "--to", "fulldome", "--size", "64"];
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--json"]].concat())).unwrap();
    assert_eq!((&report["frames"], report["inputs"].as_array().unwrap().len()), (&3.into(), 15));
    for frame in 1..=3 {
        let input = format!("{{face}}/{{face}}_{frame:04}.png");
        bench.succeed(&["convert", &input, "one.png", "--to", "fulldome", "--size", "64", "-y"]);
        assert!(bench.load("one.png") == bench.load(&format!("dome_{frame:03}.png")), "frame {frame}");
    }
}

#[test]
fn a_plan_that_does_not_fit_is_done_without() {
    let bench = Bench::new();
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 128, 64));
    }
    let bytes = |memory: &str| {
        let args =
            ["convert", "sky_#.png", "dome_#.png", "--to", "fulldome", "--size", "256", "-y", "--memory", memory];
        bench.succeed(&args);
        bench.bytes("dome_2.png")
    };
    assert!(bytes("3M") == bytes("1G"));
}

#[test]
fn what_is_not_needed_takes_no_memory() {
    let bench = Bench::new();
    bench.faces("face_", 256);
    // The light of six faces would take 3 MB, and their files 1 MB.
    let args = ["convert", "face_{face}.png", "out.png", "--to", "perspective:fov=60", "--size", "32x32"];
    bench.succeed(&[&args[..], &["--memory", "2M"]].concat());
    let message = bench.fail(1, &[&args[..], &["--memory", "500K", "-y"]].concat());
    assert!(message.contains("--memory"), "{message}");
}

#[test]
fn the_report_is_all_there() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let out = bench.succeed(&["convert", "sky.png", "out.png", "--to", "fulldome", "--size", "32", "--json"]);
    let report: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&report["inputs"][0], &report["outputs"][0]), (&"sky.png".into(), &"out.png".into()));
    assert_eq!(report["frames"], 1);
    for stage in ["decode", "plan", "filter", "encode"] {
        assert!(report["cpu_seconds"][stage].as_f64().unwrap() >= 0.0, "{stage}");
    }
    assert!(report["wall_seconds"].as_f64().unwrap() > 0.0);
    assert!(report["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
    assert_eq!(report["warnings"], Value::Array(Vec::new()));
    assert!(report["notes"][0].as_str().unwrap().contains("--from equirect"));
}

#[test]
fn progress_for_machines() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let progress = |style: &str| {
        let args = ["convert", "sky_#.png", "out_#.png", "--to", "fisheye", "--size", "16", "-y", "--from", "equirect"];
        crate::bench::text(&bench.run(&[&args[..], &["--progress", style]].concat()).stderr)
    };
    let openjd = "openjd_progress: 25.00\nopenjd_progress: 50.00\nopenjd_progress: 75.00\nopenjd_progress: 100.00\n";
    assert_eq!(progress("openjd"), openjd);
    let lines = progress("json");
    let last: Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
    assert_eq!((&last["done"], &last["total"], &last["frame"]), (&4.into(), &4.into(), &4.into()));
    assert_eq!(progress("none"), "");
    let told = progress("auto");
    assert!(told.contains("frame 2: 2 of 4 done") && told.contains("4 files of 4 frames in"), "{told}");
}

#[test]
#[cfg(target_os = "linux")]
fn an_interrupt_leaves_nothing_half_made_behind() {
    use std::path::PathBuf;
    use std::time::Duration;
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let bench = Bench::new();
        for frame in 1..=40 {
            bench.save(&format!("sky_{frame:02}.png"), &picture(frame, 256, 128));
        }
        let args = "convert sky_##.png out_##.png --from equirect --to fulldome --size 1500 --compression high";
        // A shell has interrupts ignored for all that it starts in the background, the tests among them.
        let mut command = std::process::Command::new("env");
        command.args(["--default-signal", env!("CARGO_BIN_EXE_cosmorama")]).args(args.split(' '));
        let mut child = command.current_dir(bench.path("")).stderr(std::process::Stdio::null()).spawn().unwrap();
        let is_half_made =
            |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        while !bench.files().iter().any(is_half_made) {
            assert!(child.try_wait().unwrap().is_none(), "a file is being written at some time");
            std::thread::sleep(Duration::from_millis(1));
        }
        let kill = std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(code));
        assert!(!bench.files().iter().any(is_half_made), "{:?}", bench.files());
    }
}

/// A sequence of panoramas of 64x32, frames 1 to `count`.
fn skies(bench: &Bench, count: usize) {
    for frame in 1..=count {
        bench.save(&format!("sky_{frame:02}.png"), &picture(frame, 64, 32));
    }
}

const SKIES: [&str; 6] = ["convert", "sky_##.png", "out_##.png", "--to", "fisheye", "--from=equirect"];

#[test]
fn sequences_are_the_same_for_any_number_of_threads_and_any_memory() {
    let bench = Bench::new();
    skies(&bench, 9);
    let outputs = |more: &[&str]| -> Vec<Vec<u8>> {
        bench.succeed(&[&SKIES[..], &["--size", "96", "-y"], more].concat());
        (1..=9).map(|frame| bench.bytes(&format!("out_{frame:02}.png"))).collect()
    };
    let one = outputs(&["--threads", "1"]);
    // In 900 kB there is room for a frame alone: none is read ahead of another.
    for more in [&["--threads", "2"][..], &["--threads", "7"], &["--threads", "3", "--memory", "900K"]] {
        assert!(outputs(more) == one, "{more:?}");
    }
}

#[test]
fn the_first_frame_that_fails_ends_a_sequence_and_is_named() {
    for threads in ["1", "2", "7"] {
        let bench = Bench::new();
        skies(&bench, 12);
        let whole = bench.bytes("sky_05.png");
        std::fs::write(bench.path("sky_05.png"), &whole[..whole.len() / 2]).unwrap();
        let output = bench.run(&[&SKIES[..], &["--size", "32", "--threads", threads]].concat());
        let message = crate::bench::text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        crate::bench::assert_says(&message, &["error: frame 5", "sky_05.png", "it ends too early"]);
        // Frames before it are finished, none after it is begun, and nothing else is left.
        let made: Vec<_> = bench.files().into_iter().filter(|path| !path.to_string_lossy().contains("sky_")).collect();
        let expected: Vec<_> = (1..=4).map(|frame| bench.path(&format!("out_{frame:02}.png"))).collect();
        assert_eq!(made, expected);
    }
}

#[test]
fn a_frame_that_cannot_be_written_ends_a_sequence_and_is_named() {
    let bench = Bench::new();
    skies(&bench, 12);
    // Of two that fail, one after the other, the first is named.
    for folder in ["out_03.png", "out_04.png"] {
        std::fs::create_dir(bench.path(folder)).unwrap();
    }
    let output = bench.run(&[&SKIES[..], &["--size", "32", "-y", "--threads", "2"]].concat());
    let message = crate::bench::text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    crate::bench::assert_says(&message, &["error: frame 3", "out_03.png", "there is a folder of this name"]);
    assert!(bench.path("out_02.png").is_file() && !bench.path("out_12.png").exists());
    assert!(!bench.files().iter().any(|path| path.to_string_lossy().contains(".part")));
}

#[test]
fn of_frames_that_fail_in_reading_and_in_writing_the_first_is_named() {
    for threads in ["1", "2", "7"] {
        let bench = Bench::new();
        skies(&bench, 12);
        std::fs::create_dir(bench.path("out_03.png")).unwrap();
        for later in ["sky_04.png", "sky_05.png"] {
            let whole = bench.bytes(later);
            std::fs::write(bench.path(later), &whole[..whole.len() / 2]).unwrap();
        }
        let output = bench.run(&[&SKIES[..], &["--size", "32", "-y", "--threads", threads]].concat());
        let message = crate::bench::text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        crate::bench::assert_says(&message, &["error: frame 3", "out_03.png", "there is a folder of this name"]);
        assert!(bench.path("out_02.png").is_file(), "{message}");
    }
}

#[test]
fn no_frame_is_begun_after_one_that_could_not_be_written() {
    let bench = Bench::new();
    skies(&bench, 12);
    std::fs::create_dir(bench.path("out_03.png")).unwrap();
    // A thread alone does one after the other.
    let output = bench.run(&[&SKIES[..], &["--size", "32", "-y", "--threads", "1"]].concat());
    assert_eq!(output.status.code(), Some(1));
    let made: Vec<_> = (1..=12).filter(|frame| bench.path(&format!("out_{frame:02}.png")).is_file()).collect();
    assert_eq!(made, [1, 2]);
}

#[test]
fn a_frame_of_another_kind_changes_no_other_frame() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    bench.save("sky_2.png", &flat(64, 32, &[9, 200, 40, 128]));
    bench.save("cap.png", &picture(7, 32, 32));
    let world = "[[view]]\nimage = \"sky_#.png\"\nspec = \"equirect\"\n\
                 [[view]]\nimage = \"cap.png\"\nspec = \"perspective:fov=60\"\npriority = 2\n";
    std::fs::write(bench.path("world.toml"), world).unwrap();
    let args = ["convert", "world.toml", "out_#.png", "--to", "fisheye", "--size", "64", "-y"];
    bench.succeed(&args);
    let together = bench.bytes("out_3.png");
    bench.succeed(&[&args[..], &["--frames", "3"]].concat());
    assert!(bench.bytes("out_3.png") == together);
}

#[test]
fn memory_that_other_frames_have_left_shows_nowhere() {
    let bench = Bench::new();
    for frame in 1..=7 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame * 5, 512, 256));
    }
    // Larger than what memory is kept for; one of another kind, which is held in floats.
    bench.save("sky_4.png", &flat(512, 256, &[9, 200, 40, 128]));
    let dome = ["fulldome", "--size", "600"];
    let outputs: [(&str, &[&str]); 5] = [
        ("#.png", &dome),
        ("#.png", &[&dome[..], &["--depth", "16"]].concat()),
        ("#.exr", &[&dome[..], &["--background", "transparent"]].concat()),
        ("{face}_#.png", &["cube", "--size", "300"]),
        ("#.png", &["cube:layout=cross-v", "--size", "900x1200"]),
    ];
    for (name, to) in outputs {
        let args = [&["--from", "equirect", "-y", "--to"], to].concat();
        let (all, one) = (format!("all_{name}"), format!("one_{name}"));
        // What is laid behind them all, whatever the first of them is.
        let opaque = if args.contains(&"--background") { &[][..] } else { &["--background", "#204060"] };
        // Frames enough to be made in what the first have left.
        bench.succeed(&[&["convert", "sky_#.png", &all, "--threads", "2"], &args[..], opaque].concat());
        for frame in 1..=7 {
            // A single frame finds nothing that is left. One with alpha is laid over the background where the first frame has none.
            let frames = if frame == 4 { "1,4".to_owned() } else { frame.to_string() };
            bench.succeed(&[&["convert", "sky_#.png", &one, "--frames", &frames], &args[..], opaque].concat());
        }
        let made = |prefix: &str| -> Vec<Vec<u8>> {
            let files = bench.files().into_iter().filter(|path| path.to_string_lossy().contains(prefix));
            files.map(|path| std::fs::read(path).unwrap()).collect()
        };
        let (together, alone) = (made("/all_"), made("/one_"));
        assert_eq!(together.len(), alone.len());
        let same: Vec<bool> = together.iter().zip(&alone).map(|(a, b)| a == b).collect();
        assert!(same.len() >= 7 && same.iter().all(|same| *same), "{name} {to:?}: {same:?}");
        let outputs = bench.files().into_iter().filter(|path| !path.to_string_lossy().contains("sky_"));
        outputs.for_each(|path| std::fs::remove_file(path).unwrap());
    }
}

#[test]
fn a_transparent_frame_among_opaque_ones_is_told() {
    let bench = Bench::new();
    bench.save("sky_1.png", &picture(1, 64, 32));
    bench.save("sky_2.png", &flat(64, 32, &[9, 200, 40, 128]));
    bench.save("sky_3.png", &flat(64, 32, &[9, 200, 40, 255]));
    bench.save("sky_4.png", &flat(64, 32, &[200, 0]));
    let args = ["convert", "sky_#.png", "out_#.png", "--to=fisheye", "--from=equirect", "--size", "32", "-y", "--json"];
    let warnings = |more: &[&str]| -> Vec<String> {
        let output = bench.run(&[&args[..], more].concat());
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let told = crate::bench::text(&output.stderr);
        let warnings = report["warnings"].as_array().unwrap().iter();
        warnings.map(|one| one.as_str().unwrap().to_owned()).inspect(|one| assert!(told.contains(one))).collect()
    };
    let told = warnings(&[]);
    assert_eq!(told.len(), 2, "{told:?}");
    for (warning, file) in told.iter().zip(["sky_2.png", "sky_4.png"]) {
        crate::bench::assert_says(warning, &[file, "transparent", "first frame", "--background transparent"]);
    }
    assert_eq!(warnings(&["--background", "transparent"]), [""; 0]);
    assert_eq!(warnings(&["--frames", "2,4"]), [""; 0], "the first frame has alpha");
}

#[test]
fn compression_changes_sizes_and_no_pixel() {
    let bench = Bench::new();
    // With stars, where filters of rows and levels of Deflate tell.
    let stars = cosmorama::raster::Image::from_fn(128, 64, |i, j| {
        let light = if (i * 31 + j * 17) % 53 == 0 { 0.8 } else { (i + j) as f32 / 400.0 };
        cosmorama::raster::Rgba::opaque(light, light * 0.7, 0.1)
    });
    let (channels, transfer) = (cosmorama::raster::Channels::Rgb, cosmorama::raster::Transfer::Srgb);
    let stars = cosmorama::raster::EncodedImage::encode(&stars, channels, cosmorama::raster::Depth::Eight, &transfer);
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame:02}.png"), &stars);
    }
    for extension in ["png", "tif", "exr"] {
        let one = format!("one.{extension}");
        let size = |compression: &[&str]| {
            let args = ["convert", "sky_01.png", &one, "--to", "fisheye", "--from=equirect", "--size", "96", "-y"];
            bench.succeed(&[&args[..], compression].concat());
            (bench.bytes(&one).len(), bench.load(&one))
        };
        let all = ["none", "fast", "balanced", "high"].map(|how| size(&["--compression", how]));
        assert!(all.iter().all(|(_, picture)| *picture == all[0].1), "{extension}");
        let [none, fast, balanced, high] = all.map(|(size, _)| size);
        let largest = [fast, balanced, high].into_iter().max().unwrap();
        assert!(largest < none && high <= balanced, "{extension}: {none} {fast} {balanced} {high}");
        assert_eq!(size(&[]).0, balanced, "stills are balanced");
        // As the help says: two of them are one.
        assert_eq!((fast == balanced, high == balanced), (extension == "tif", extension == "exr"), "{extension}");
    }
    // Frames are written fast, all of them or only some.
    let sequence = |more: &[&str]| {
        bench.succeed(&[&SKIES[..], &["--size", "96", "-y"], more].concat());
        bench.bytes("out_02.png")
    };
    let fast = sequence(&["--compression", "fast"]);
    assert!(sequence(&[]) == fast && sequence(&["--frames", "2"]) == fast);
    assert!(sequence(&["--compression", "balanced"]) != fast);
    let refused = ["convert", "sky_01.png", "out.tga", "--to", "fisheye", "--compression", "fast"];
    crate::bench::assert_says(&bench.fail(2, &refused), &["--compression", "out.tga", "TGA", "PNG, TIFF and OpenEXR"]);
}

#[test]
fn geometry_without_room_is_computed_anew_for_each_frame() {
    let bench = Bench::new();
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args =
        ["convert", "sky_#.png", "out_#.png", "--from=equirect", "--to=fisheye", "--size", "128", "-y", "--json"];
    let outputs = |more: &[&str]| -> (Vec<Vec<u8>>, Vec<String>) {
        let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], more].concat())).unwrap();
        let warnings = report["warnings"].as_array().unwrap().iter();
        let warnings = warnings.map(|warning| warning.as_str().unwrap().to_owned()).collect();
        ((1..=3).map(|frame| bench.bytes(&format!("out_{frame}.png"))).collect(), warnings)
    };
    for filter in ["ewa", "ewa-pyramid"] {
        let (plain, none) = outputs(&["--filter", filter]);
        let (anew, warnings) = outputs(&["--filter", filter, "--memory", "1200K"]);
        assert!(anew == plain && none.is_empty(), "{filter}: {none:?}");
        let told = "computed anew for each frame; give more with --memory";
        assert!(warnings.len() == 1 && warnings[0].ends_with(told), "{filter}: {warnings:?}");
    }
    // A single picture needs none that is held.
    assert_eq!(outputs(&["--memory", "1200K", "--frames", "1"]).1, [""; 0]);
}

#[test]
fn what_every_frame_has_is_told_once_with_the_sum() {
    let bench = Bench::new();
    for frame in 1..=3 {
        let glare = |i, j| if (i, j) == (frame, 5) { [f32::INFINITY; 3] } else { [0.5; 3] };
        bench.save(&format!("sky_{frame}.exr"), &crate::bench::floats(64, 32, glare));
    }
    let args =
        ["convert", "sky_#.exr", "out_#.exr", "--from", "equirect", "--to", "fulldome", "--size", "16", "--json"];
    let report: Value = serde_json::from_str(&bench.succeed(&args)).unwrap();
    let told = report["warnings"].as_array().unwrap();
    let told: Vec<&str> = told.iter().filter_map(Value::as_str).filter(|told| told.contains("infinite")).collect();
    assert_eq!(told, ["sky_1.exr and 2 other files: 3 pixels are infinite and count as 65504, the largest half float"]);
}

#[test]
fn light_that_integers_do_not_hold_is_told() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |i, _| if i < 8 { [9.0; 3] } else { [0.5; 3] }));
    bench.save("dim.exr", &crate::bench::floats(64, 32, |_, _| [1.0, 0.9, 0.0]));
    let to = ["--from", "equirect", "--to", "equirect:yaw=20", "--size", "64", "-y"];
    for (out, depth) in [("out.png", "8"), ("out.png", "16"), ("out.tif", "16")] {
        let convert =
            |input: &str| text(&bench.run(&[&["convert", input, out, "--depth", depth][..], &to].concat()).stderr);
        assert_says(&convert("sky.exr"), &[&format!("{out}: "), &format!("brighter than --depth {depth} holds")]);
        assert!(!convert("dim.exr").contains("warning"), "{out}");
    }
    let told = text(&bench.run(&[&["convert", "sky.exr", "out.exr"][..], &to].concat()).stderr);
    assert!(!told.contains("brighter"), "{told}");
}

#[test]
fn a_frame_far_from_all_others_is_no_part_of_a_sequence() {
    let bench = Bench::new();
    for frame in ["1", "2", "999999999"] {
        bench.save(&format!("sky_{frame}.png"), &picture(1, 64, 32));
    }
    let told = bench.fail(1, &["convert", "sky_#.png", "out_#.png", "--from", "equirect", "--to", "fulldome"]);
    assert_says(&told, &["the first frame is 1 and the last 999999999", "too far apart", "--frames"]);
}

/// Without a video, nobody needs an answer to its damaged frames.
#[test]
fn an_answer_to_damaged_frames_of_pictures_is_told_to_be_idle() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 32, 16));
    let args = ["convert", "sky.png", "o.png", "--from", "equirect", "--to", "fulldome", "--size", "16", "--damaged"];
    let held = bench.run(&[&args[..], &["hold"]].concat());
    assert!(held.status.success());
    assert_says(&text(&held.stderr), &["warning: --damaged has no effect: no input is a film; a damaged picture"]);
    let default = bench.run(&[&args[..], &["error", "-y"]].concat());
    assert!(default.status.success() && !text(&default.stderr).contains("--damaged"), "{}", text(&default.stderr));
    // Nor does a stream of pictures.
    bench.succeed(&["convert", "sky.png", "sky.y4m", "--from", "equirect", "--to", "equirect", "--size", "32"]);
    let stream = ["convert", "sky.y4m", "o_#.png", "--from", "equirect", "--to", "fulldome", "--size", "16"];
    let skipped = bench.run(&[&stream[..], &["--damaged", "skip"]].concat());
    assert!(skipped.status.success(), "{}", text(&skipped.stderr));
    assert_says(&text(&skipped.stderr), &["--damaged has no effect", "a stream of pictures that is cut"]);
}

/// Frames that are to be made yet have a cost, too, but are not taken for those that are there.
#[test]
fn explain_tells_of_frames_that_do_not_exist() {
    let bench = Bench::new();
    (1..=3).for_each(|frame| bench.save(&format!("sky_{frame}.png"), &picture(frame, 32, 16)));
    let explained = |frames: &str| {
        let args =
            ["explain", "sky_#.png", "--from", "equirect", "--to", "fulldome", "--size", "16", "--frames", frames];
        let told = bench.run(&args);
        assert!(told.status.success(), "{}", text(&told.stderr));
        (text(&told.stdout), text(&told.stderr))
    };
    let (costs, told) = explained("2-9");
    assert_says(&costs, &["8 frames: about"]);
    assert_says(&told, &["warning: sky_#.png: 6 frames are missing: 4-9; the first that exists is 1, the last 3"]);
    let (_, told) = explained("1-3");
    assert!(!told.contains("missing"), "{told}");
}

/// Numbered pictures have no times, so that a film of them at one rate leaves its sound.
#[cfg(feature = "video")]
#[test]
fn pictures_of_a_film_of_varying_rate_are_told_to_lose_its_times() {
    if !super::films::has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=128x64:rate=25,trim=end_frame=20,settb=1/1000,setpts=N*40+mod(N\\,3)*10";
    let coding = ["-vsync", "passthrough", "-enc_time_base", "1:1000", "-c:v", "libx264", "-bf", "0", "film.mp4"];
    super::films::ffmpeg(&bench, &[&["-f", "lavfi", "-i", source][..], &coding].concat());
    let to = |output: &str| {
        let args = ["convert", "film.mp4", output, "--from", "equirect", "--to", "fulldome", "--size", "64"];
        let made = bench.run(&args);
        assert!(made.status.success(), "{}", text(&made.stderr));
        text(&made.stderr)
    };
    assert_says(&to("f_##.png"), &["warning: film.mp4: its rate varies, and numbered pictures have no times"]);
    assert!(!to("dome.mkv").contains("have no times"));
}

/// What a file holds counts, and not its name; and a film of one frame is rarely meant.
#[cfg(feature = "video")]
#[test]
fn films_and_pictures_that_are_taken_for_each_other_are_told() {
    if !super::films::has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    super::films::film(&bench, "film.avi", 3);
    std::fs::copy(bench.path("film.avi"), bench.path("film.png")).unwrap();
    std::fs::copy(bench.path("sky.png"), bench.path("sky.mp4")).unwrap();
    let run = |input: &str, output: &str, further: &[&str]| {
        let done = bench.run(&[&["convert", input, output, "--to", "fulldome", "--size", "16"], further].concat());
        (done.status.code(), text(&done.stderr))
    };
    let (code, told) = run("film.png", "a.png", &[]);
    assert_eq!(code, Some(1));
    assert_says(&told, &["error: film.png: a video by its first bytes", "whose name ends with .avi"]);
    let (code, told) = run("sky.mp4", "b.png", &[]);
    assert_eq!(code, Some(1));
    assert_says(&told, &["error: sky.mp4: a PNG file by its first bytes", "name it sky.png"]);
    let (code, told) = run("sky.png", "one.mkv", &[]);
    assert_eq!(code, Some(0));
    assert_says(&told, &["warning: one.mkv: a film of a single frame, since no input has more"]);
    let (code, told) = run("film.avi", "two.mkv", &["--frames", "1"]);
    assert!(code == Some(0) && !told.contains("a single frame"), "{told}");
}
