//! Sequences with faults, each of which `verify` names by its frame.

use std::collections::BTreeSet;

use crate::bench::{Bench, assert_says, flat, picture, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use serde_json::{Value, json};

#[cfg(feature = "video")]
use super::films::{ffmpeg, has_ffmpeg, said};

/// Frames 1 to `count`, each a little other than the one before.
fn sequence(bench: &Bench, count: usize) {
    for frame in 1..=count {
        bench.save(&format!("dome_{frame}.png"), &picture(frame, 32, 16));
    }
}

#[test]
fn a_whole_sequence_has_no_faults() {
    let bench = Bench::new();
    sequence(&bench, 4);
    assert_eq!(bench.succeed(&["verify", "dome_#.png"]), "4 frames are whole and alike\n");
    let report: Value =
        serde_json::from_str(&bench.succeed(&["verify", "dome_#.png", "--size", "32x16", "--json"])).unwrap();
    assert_eq!((&report["frames"], &report["whole"], &report["faults"]), (&4.into(), &4.into(), &json!([])));
}

/// Greys of frames: two that are equal, 5 and 6, and a flash, 11.
const GREYS: [u8; 12] = [101, 102, 103, 104, 105, 105, 107, 108, 109, 110, 200, 112];

/// Twelve frames by this program with one fault each, or none.
fn faulty_sequence(bench: &Bench) {
    for (frame, grey) in (1..).zip(GREYS) {
        bench.save(&format!("in_{frame}.png"), &flat(32, 16, &[grey; 3]));
    }
    let args = ["convert", "in_#.png", "dome_#.png", "--from", "equirect", "--to", "equirect", "--size", "32"];
    bench.succeed(&args);
    bench.succeed(&[&args[..], &["--frames", "7", "-y", "--yaw", "3"]].concat());
    std::fs::remove_file(bench.path("dome_2.png")).unwrap();
    let bytes = bench.bytes("dome_3.png");
    std::fs::write(bench.path("dome_3.png"), &bytes[..bytes.len() - 20]).unwrap();
    bench.save("dome_4.png", &flat(30, 15, &[104; 3]));
    let samples = Samples::U16(vec![108 * 257; 32 * 16 * 3]);
    bench.save("dome_8.png", &EncodedImage::new(32, 16, Channels::Rgb, Depth::Sixteen, samples).unwrap());
    bench.save("dome_9.png", &flat(32, 16, &[0; 3]));
}

#[test]
fn every_fault_is_named_by_its_frame() {
    let bench = Bench::new();
    faulty_sequence(&bench);
    let output = bench.run(&["verify", "dome_#.png", "--frames", "1-13", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let faults = report["faults"].as_array().unwrap().iter();
    let named: Vec<(u64, &str)> =
        faults.map(|fault| (fault["frame"].as_u64().unwrap(), fault["fault"].as_str().unwrap())).collect();
    let expected = [
        (2, "missing"),
        (3, "damaged"),
        // Another program's frames do not say how they were made.
        (4, "size"),
        (4, "settings"),
        (6, "frozen"),
        (7, "settings"),
        (8, "kind"),
        (8, "settings"),
        (9, "settings"),
        (9, "black"),
        // Nine is as far from both neighbours as a flash is.
        (9, "flash"),
        (11, "flash"),
        (13, "missing"),
    ];
    assert_eq!(named, expected, "{report}");
    assert_eq!((&report["frames"], &report["whole"]), (&13.into(), &4.into()));
    assert_eq!(report["frames_with_faults"], "2-4,6-9,11,13", "{report}");
    let told = text(&bench.run(&["verify", "dome_#.png", "--threads", "1"]).stdout);
    let (lines, last) = (told.lines().collect::<Vec<_>>(), "8 of 12 frames have faults: 2-4,6-9,11");
    assert_eq!((lines.len(), lines[0], lines[8]), (9, "missing: 2", last), "{told}");
    assert_says(
        &told,
        &[
            "it ends too early",
            "of size 30x15 instead of 32x16: 4\n",
            "equal to the frame before: 6\n",
            "made by other settings than most: 4,7-9\n",
            "unlike most, ",
            "black: 9\n",
            "a flash, far from both neighbours: 9,11\n",
        ],
    );
}

#[test]
fn one_frame_is_told_of_as_one() {
    let bench = Bench::new();
    sequence(&bench, 1);
    assert_eq!(bench.succeed(&["verify", "dome_#.png"]), "1 frame is whole\n");
    let told = text(&bench.run(&["verify", "dome_#.png", "--frames", "1,2"]).stdout);
    assert_eq!(told, "missing: 2\n1 of 2 frames has faults: 2\n");
}

#[test]
fn files_that_may_not_be_read_are_no_faults() {
    let bench = Bench::new();
    sequence(&bench, 4);
    let said = bench.fail(1, &["verify", "dome_#.png", "--memory", "10000"]);
    assert_says(&said, &["dome_1.png needs about 9.5 KiB of memory", "32x16 pixels", "--memory"]);
    let sheet = ["verify", "dome_#.png", "--sheet", "sheet.png", "--memory", "3M"];
    assert_says(&bench.fail(1, &sheet), &["the sheet needs about", "it shows 4 frames", "--every"]);
    bench.succeed(&[&sheet[..], &["--every", "2"]].concat());
    std::fs::remove_file(bench.path("dome_2.png")).unwrap();
    std::fs::create_dir(bench.path("dome_2.png")).unwrap();
    assert_says(&bench.fail(1, &["verify", "dome_#.png"]), &["cannot open dome_2.png"]);
}

#[test]
fn a_frame_by_other_settings_is_found() {
    let bench = Bench::new();
    sequence(&bench, 3);
    let args = ["convert", "dome_#.png", "out_#.png", "--from", "equirect", "--to", "fisheye", "--size", "16"];
    bench.succeed(&args);
    bench.succeed(&[&args[..], &["--frames", "2", "-y", "--yaw", "3"]].concat());
    let output = bench.run(&["verify", "out_#.png", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["faults"], json!([{ "frame": 2, "fault": "settings" }]));
}

#[test]
fn a_sheet_shows_every_so_many_frames() {
    let bench = Bench::new();
    sequence(&bench, 7);
    bench.succeed(&["verify", "dome_#.png", "--sheet", "sheet.png", "--every", "2"]);
    // Frames 1, 3, 5 and 7, two by two.
    let sheet = bench.load("sheet.png");
    assert_eq!((sheet.width(), sheet.height()), (32 + 4 + 32, 2 * (16 + 14) + 4));
    let told = bench.fail(1, &["verify", "dome_#.png", "--sheet", "sheet.png"]);
    assert_says(&told, &["sheet.png", "-y"]);
    bench.succeed(&["verify", "dome_#.png", "--sheet", "new/sheet.png"]);
    bench.fail(1, &["verify", "dome_#.png", "--sheet", "other/sheet.png", "--no-mkdir"]);
}

#[test]
fn a_sheet_takes_no_place_of_a_frame() {
    let bench = Bench::new();
    sequence(&bench, 2);
    std::os::unix::fs::symlink(bench.path("dome_1.png"), bench.path("link.png")).unwrap();
    let (here, folder) = (bench.path("").display().to_string(), bench.path("dome_#.png").display().to_string());
    let same = format!("{here}/dome_2.png");
    for sheet in ["dome_1.png", "./dome_1.png", "dome_9.png", "link.png", &same] {
        for pattern in ["dome_#.png", "./dome_#.png", &folder] {
            let said = bench.fail(2, &["verify", pattern, "--sheet", sheet, "-y"]);
            assert_says(&said, &["would replace a frame"]);
        }
    }
}

#[test]
fn what_is_no_sequence_is_refused() {
    let bench = Bench::new();
    sequence(&bench, 2);
    assert_says(&bench.fail(2, &["verify", "dome_1.png"]), &["no frame marker", "####"]);
    assert_says(&bench.fail(2, &["verify", "."]), &[". is a folder; ", "dome_#.png"]);
    let film = bench.fail(2, &["verify", "dome_#.png", "--sheet", "sheet.mp4"]);
    assert_says(&film, &["sheet.mp4: a sheet is one picture; name it sheet.png"]);
    for name in ["{face}", "%c", "{eye}", "{level}"] {
        assert_says(&bench.fail(2, &["verify", &format!("{name}_#.png")]), &[&format!("has {name}"), "by itself"]);
    }
    assert_says(&bench.fail(1, &["verify", "none_#.png"]), &["none_#.png"]);
    for frames in [&[][..], &["--frames", "1-3"]] {
        let said = bench.fail(1, &[&["verify", "gone/dome_#.png"], frames].concat());
        assert_says(&said, &["gone/dome_#.png", "no folder gone"]);
    }
    assert_says(&bench.fail(2, &["verify", "dome_#.png", "--sheet", "s.png", "--every", "0"]), &["1 at least"]);
    bench.save("dome_4000000000.png", &picture(1, 32, 16));
    let said = bench.fail(2, &["verify", "dome_#.png"]);
    assert_says(&said, &["first frame is 1 and the last 4000000000", "--frames 1-100"]);
    assert_says(&bench.fail(2, &["verify", "dome_#.png", "--every", "3"]), &["--sheet"]);
}

/// Frames of a video are read as those of a sequence are, and numbered from 0.
#[cfg(feature = "video")]
#[test]
fn frames_of_a_video_are_verified() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    for (frame, grey) in (0..).zip(GREYS) {
        bench.save(&format!("in_{frame:02}.png"), &flat(64, 32, &[if frame == 2 { 0 } else { grey }; 3]));
    }
    let codec = ["-c:v", "ffv1", "-pix_fmt", "bgr0", "-g", "1", "-slicecrc", "1"];
    ffmpeg(&bench, &[&["-framerate", "25", "-i", "in_%02d.png"][..], &codec, &["film.mkv"]].concat());
    let verify = |more: &[&str]| -> (Option<i32>, String) {
        let output = bench.run(&[&["verify", "--progress", "none"], more].concat());
        (output.status.code(), text(&output.stdout) + &text(&output.stderr))
    };
    let (code, told) = verify(&["film.mkv"]);
    assert_eq!(code, Some(1));
    assert_says(
        &told,
        &["black: 2\n", "equal to the frame before: 5\n", "far from both neighbours: 2,10\n", "faults: 2,5,10\n"],
    );
    assert_eq!(
        verify(&["film.mkv", "--frames", "6-9"]),
        (Some(0), "4 frames are whole and alike, as far as its decoder tells\n".to_owned())
    );
    let timed = verify(&["film.mkv", "--frames", "00:00:00.24-00:00:00.40"]);
    assert_eq!(timed, (Some(0), "4 frames are whole and alike, as far as its decoder tells\n".to_owned()));
    let (code, told) = verify(&["in_##.png", "--frames", "00:00:00-00:00:01"]);
    assert!(code == Some(2) && told.contains("in_##.png is no video, whose frames have times"), "{told}");
    let (code, told) = verify(&["film.mkv", "--frames", "6-8,12-13"]);
    assert_eq!((code, told.as_str()), (Some(1), "missing: 12,13\n2 of 5 frames have faults: 12,13\n"));
    assert_says(&verify(&["film.mkv", "--frames", "6-9", "--size", "99"]).1, &["of size 64x32 instead of 99"]);
    // Damage within a frame, and a file that is cut off: the frames are named, and those between are judged.
    let whole = bench.bytes("film.mkv");
    let mut damaged = whole.clone();
    let middle = whole.len() * 8 / 12;
    damaged[middle..middle + 20].fill(0x5a);
    std::fs::write(bench.path("damaged.mkv"), damaged).unwrap();
    let report: Value = serde_json::from_slice(&bench.run(&["verify", "damaged.mkv", "--json"]).stdout).unwrap();
    let faults: Vec<(u64, &str)> = report["faults"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fault| (fault["frame"].as_u64().unwrap(), fault["fault"].as_str().unwrap()))
        .collect();
    let broken: Vec<u64> = faults.iter().filter(|(_, fault)| *fault == "damaged").map(|(frame, _)| *frame).collect();
    assert!(matches!(broken[..], [6..=8]), "{faults:?}");
    assert!(faults.contains(&(2, "black")) && faults.contains(&(10, "flash")), "{faults:?}");
    std::fs::write(bench.path("cut.mkv"), &whole[..whole.len() * 2 / 3]).unwrap();
    let (code, told) = verify(&["cut.mkv", "--frames", "0-11"]);
    assert_eq!(code, Some(1));
    assert_says(&told, &["black: 2\n", "damaged (File ended prematurely): 7-11\n"]);
    // The sheet shows its frames, and never replaces it.
    verify(&["film.mkv", "--sheet", "sheet.png", "--every", "4"]);
    assert_eq!(bench.load("sheet.png").width(), 2 * 64 + 4);
    let (code, told) = verify(&["film.mkv", "--sheet", "film.mkv", "-y"]);
    assert!(code == Some(2) && bench.bytes("film.mkv") == whole, "{told}");
}

/// A cut file of Matroska says how many frames it has by its duration, which is not trusted where times are uneven, as where frames
/// are coded out of order. Then those that are left are not counted as if they were all.
#[cfg(feature = "video")]
#[test]
fn no_cut_of_a_film_passes_for_a_short_film() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    for (rate, codec) in [("25", "libx264"), ("30000/1001", "libx264"), ("25", "mpeg2video")] {
        let source = format!("testsrc2=size=192x96:rate={rate}:duration=2");
        let codec = ["-c:v", codec, "-bf", "2", "-g", "10", "-pix_fmt", "yuv420p"];
        ffmpeg(&bench, &[&["-y", "-f", "lavfi", "-i", &source], &codec[..], &["film.mkv"]].concat());
        let bytes = bench.bytes("film.mkv");
        for percent in [30, 45, 60, 75, 90, 98] {
            std::fs::write(bench.path("cut.mkv"), &bytes[..bytes.len() * percent / 100]).unwrap();
            let said = bench.run(&[
                "convert",
                "cut.mkv",
                "dome_####.png",
                "-y",
                "--from",
                "equirect",
                "--to",
                "fulldome",
                "--size",
                "16",
            ]);
            assert_eq!(said.status.code(), Some(1), "{percent} % of {codec:?}, {rate}: {}", text(&said.stderr));
            assert_says(&text(&said.stderr), &["cut.mkv"]);
            let told = bench.run(&["verify", "cut.mkv"]);
            assert_eq!(told.status.code(), Some(1), "{percent} % of {codec:?}, {rate}: {}", text(&told.stdout));
        }
    }
}

/// The last number of a film is that of its last frame, though one before it is lost.
#[cfg(feature = "video")]
#[test]
fn a_transport_stream_that_lost_a_frame_keeps_its_last() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=128x64:rate=25,trim=end_frame=30";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-c:v", "libx264", "-bf", "0", "-g", "10", "film.ts"]);
    let told = said(&bench, "film.ts", "v", "packet=pos");
    let places: Vec<usize> = told.lines().filter_map(|line| line.strip_prefix("pos=")?.parse().ok()).collect();
    let mut bytes = bench.bytes("film.ts");
    bytes.drain(places[13]..places[14]);
    std::fs::write(bench.path("film.ts"), bytes).unwrap();
    let report: Value = serde_json::from_slice(&bench.run(&["verify", "film.ts", "--json"]).stdout).unwrap();
    assert_eq!((&report["frames"], &report["frames_with_faults"]), (&json!(30), &json!("13-19")), "{report}");
    let args = ["convert", "film.ts", "f_##.png", "--from", "equirect", "--to", "fulldome", "--size", "16"];
    let held = bench.run(&[&args[..], &["--damaged", "hold"]].concat());
    assert!(held.status.success() && !text(&held.stderr).contains("announced"), "{}", text(&held.stderr));
    assert!(bench.path("f_29.png").exists());
}

/// Bare streams announce no number of frames: what was counted is missed.
#[cfg(feature = "video")]
#[test]
fn a_bare_stream_keeps_the_place_of_its_last_frame() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=64x32:rate=25,trim=end_frame=12";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-c:v", "libx264", "-bf", "0", "film.h264"]);
    let bytes = bench.bytes("film.h264");
    let last = bytes.windows(4).rposition(|start| start == [0, 0, 1, 0x41]).unwrap();
    std::fs::write(bench.path("film.h264"), &bytes[..last + 12]).unwrap();
    let convert = |damaged: &str| {
        let wanted = ["convert", "film.h264", "out_####.png", "--from", "equirect", "--to", "fulldome", "--size", "16"];
        bench.run(&[&wanted[..], &["--damaged", damaged]].concat())
    };
    let held = convert("hold");
    assert_says(&text(&held.stderr), &["1 frame is damaged or missing", "the first is frame 11"]);
    assert!(held.status.success() && bench.path("out_0011.png").exists());
    assert_eq!(convert("error").status.code(), Some(1));
}

/// Makes a film of 30 frames, every tenth a key frame, of which frame 13 is damaged.
fn damaged_film(bench: &Bench) {
    let source = "testsrc2=size=256x128:rate=25,trim=end_frame=30";
    ffmpeg(bench, &["-f", "lavfi", "-i", source, "-c:v", "libx264", "-bf", "0", "-g", "10", "film.mp4"]);
    let told = said(bench, "film.mp4", "v", "packet=pos,size");
    let of =
        |name: &str| told.lines().filter_map(|line| line.strip_prefix(name)?.parse::<usize>().ok()).nth(13).unwrap();
    let (place, size) = (of("pos="), of("size="));
    let mut bytes = std::fs::read(bench.path("film.mp4")).unwrap();
    bytes[place + 8..place + size].fill(0x5a);
    std::fs::write(bench.path("film.mp4"), bytes).unwrap();
}

/// Frames that take after a damaged one are not right either, though no decoder says so.
#[test]
fn frames_are_doubted_from_damage_to_the_next_key_frame() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    damaged_film(&bench);
    let report: Value = serde_json::from_slice(&bench.run(&["verify", "film.mp4", "--json"]).stdout).unwrap();
    assert_eq!((&report["frames_with_faults"], &report["whole"]), (&json!("13-19"), &json!(23)), "{report}");
    let args = ["convert", "film.mp4", "f_##.png", "--from", "equirect", "--to", "fulldome", "--size", "16"];
    let held = bench.run(&[&args[..], &["--damaged", "hold"]].concat());
    assert!(held.status.success(), "{}", text(&held.stderr));
    assert_says(&text(&held.stderr), &["the first is frame 13", "further frames may take after them, and show traces"]);
    // A frame that may show traces is shown, so that people can judge them.
    bench.run(&["verify", "film.mp4", "--sheet", "sheet.png", "--every", "15"]);
    let sheet = bench.load("sheet.png");
    let Samples::U8(samples) = sheet.samples() else { panic!("{:?}", sheet.depth()) };
    let bright = |column: usize| samples[(sheet.width() * 10 + column) * 3..][..3].iter().any(|sample| *sample > 64);
    assert!((70..120).filter(|column| bright(*column)).count() > 25);
    // Of frames that are not read, nothing is told.
    let some = bench.run(&["verify", "film.mp4", "--frames", "12-14", "--json"]);
    let report: Value = serde_json::from_slice(&some.stdout).unwrap();
    assert_eq!(report["frames_with_faults"], "13,14", "{report}");
    // Frames that take after one that is not read are not passed on for whole.
    let behind = bench.run(&["verify", "film.mp4", "--frames", "15-25", "--json"]);
    let report: Value = serde_json::from_slice(&behind.stdout).unwrap();
    assert_eq!((&report["frames_with_faults"], &report["whole"]), (&json!("15-19"), &json!(6)), "{report}");
    let refused = bench.fail(1, &[&args[..], &["-y", "--frames", "15-22"]].concat());
    assert_says(&refused, &["frame 13 is damaged", "frame 15, which is asked for, may take after it"]);
    let held = bench.run(&[&args[..], &["-y", "--frames", "18-22", "--damaged", "hold"]].concat());
    assert!(held.status.success(), "{}", text(&held.stderr));
    assert_says(&text(&held.stderr), &["2 frames may take after frame 13, which is damaged", "show traces"]);
    // What is damaged between frames that are asked for is no reason to fail, where none of them takes after it.
    let apart = bench.run(&[&args[..], &["-y", "--frames", "10-12,20-22"]].concat());
    assert!(apart.status.success() && !text(&apart.stderr).contains("damaged"), "{}", text(&apart.stderr));
    let refused = bench.fail(1, &[&args[..], &["-y", "--frames", "12,15"]].concat());
    assert_says(&refused, &["frame 13 is damaged", "frame 15, which is asked for, may take after it"]);
    // Of frames between that are not asked for, nothing is told.
    let apart = bench.run(&[&args[..], &["-y", "--frames", "12,24", "--damaged", "hold"]].concat());
    assert!(apart.status.success() && !text(&apart.stderr).contains("0 frames"), "{}", text(&apart.stderr));
    // A frame that is left out is no reason to fail, if it is the only one that is lacking.
    let skip = [&args[..], &["-y", "--frames", "10-15", "--damaged", "skip", "--json"]].concat();
    let skipped = bench.run(&skip);
    assert!(skipped.status.success());
    let report: Value = serde_json::from_slice(&skipped.stdout).unwrap();
    let made: Vec<&str> = report["outputs"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(made, ["f_10.png", "f_11.png", "f_12.png", "f_14.png", "f_15.png"]);
    assert_eq!(report["frames"], 5);
    assert!(!text(&skipped.stderr).contains("sound"), "{}", text(&skipped.stderr));
    assert_says(
        &text(&skipped.stderr),
        &["--damaged: of frames that are left out, there are files from an earlier run: 13;"],
    );
    std::fs::remove_file(bench.path("f_13.png")).unwrap();
    let resume = [&args[..], &["--resume", "--frames", "10-15", "--damaged", "skip"]].concat();
    let again = bench.run(&resume);
    assert!(again.status.success(), "{}", text(&again.stderr));
    let whole = bench.run(&[&args[..], &["-y", "--frames", "20-25"]].concat());
    assert!(whole.status.success() && !text(&whole.stderr).contains("damaged"), "{}", text(&whole.stderr));
}

#[test]
fn frames_that_damage_has_reached_are_kept_by_who_accepts_them_alone() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    damaged_film(&bench);
    // Each format tells it in a place of its own.
    for name in ["f_##.png", "f_##.exr", "f_##.tif", "f_##.jpg", "f_##.hdr"] {
        let args = ["convert", "film.mp4", name, "--from", "equirect", "--to", "fulldome", "--size", "16"];
        let resumed = |answer: &[&'static str]| [&args[..], &["--resume"], answer].concat();
        bench.succeed(&[&args[..], &["--damaged", "hold"]].concat());
        bench.succeed(&[&args[..], &["-y", "--frames", "20-25"]].concat());
        let report: Value = serde_json::from_slice(&bench.run(&["verify", name, "--json"]).stdout).unwrap();
        assert_eq!(report["frames_with_faults"], "13-19", "{report}");
        let of = |fault: &str| {
            let all = report["faults"].as_array().unwrap().iter().filter(|found| found["fault"] == fault);
            all.map(|found| found["frame"].as_u64().unwrap()).collect::<Vec<_>>()
        };
        assert_eq!((of("held"), of("traces")), (vec![13], (14..20).collect()), "{report}");
        let kept = bench.run(&resumed(&["--damaged", "hold"]));
        assert!(kept.status.success(), "{}", text(&kept.stderr));
        assert_says(&text(&kept.stderr), &["30"]);
        let refused = bench.fail(1, &resumed(&[]));
        assert_says(&refused, &["_13.", "by another --damaged; give the one that made it, or remove frames 13-19"]);
        let refused = bench.fail(1, &resumed(&["--damaged", "skip"]));
        assert_says(&refused, &["_13.", "by another --damaged; give the one that made it, or remove frames 13 and"]);
        // Without what is to be kept, the film's damage is told as ever.
        (13..20).for_each(|frame| std::fs::remove_file(bench.path(&name.replace("##", &frame.to_string()))).unwrap());
        assert_says(&bench.fail(1, &resumed(&[])), &["frame 13 is damaged"]);
        let held = bench.run(&resumed(&["--damaged", "hold"]));
        assert!(held.status.success(), "{}", text(&held.stderr));
    }
}

/// With B frames, some that are shown before the damaged one take after it; and where a run begins makes no difference.
#[test]
fn the_words_for_damage_are_the_same_in_whatever_parts_frames_are_made() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=256x128:rate=25,trim=end_frame=125";
    let codec = ["-c:v", "libx264", "-bf", "2", "-g", "20", "-x264-params", "b-pyramid=0:scenecut=0"];
    ffmpeg(&bench, &[&["-f", "lavfi", "-i", source][..], &codec, &["film.mkv"]].concat());
    let args = |name: &'static str, more: &[&'static str]| {
        let to = ["convert", "film.mkv", name, "--from", "equirect", "--to", "fulldome", "--size", "32"];
        [&to[..], more].concat()
    };
    bench.succeed(&args("whole_###.png", &[]));
    let bytes = std::fs::read(bench.path("film.mkv")).unwrap();
    let told = said(&bench, "film.mkv", "v", "packet=pos,size,pts_time");
    let of = |name: &str| {
        let all = told.lines().filter_map(|line| line.strip_prefix(name)?.parse::<f64>().ok());
        all.collect::<Vec<_>>()
    };
    let (times, places, sizes) = (of("pts_time="), of("pos="), of("size="));
    // A frame after which one that is shown before it takes.
    let at = (90..100).find(|at| times[*at] > times[at + 1]).unwrap();
    let (place, size) = (places[at] as usize, sizes[at] as usize);
    let mut damaged = bytes.clone();
    damaged[place + 20..place + size].fill(0x5a);
    std::fs::write(bench.path("film.mkv"), damaged).unwrap();
    bench.succeed(&args("all_###.png", &["--damaged", "hold"]));
    let faulty = |name: &str| {
        let report: Value = serde_json::from_slice(&bench.run(&["verify", name, "--json"]).stdout).unwrap();
        let faults = report["faults"].as_array().unwrap().iter().map(|fault| fault["frame"].as_u64().unwrap());
        faults.collect::<BTreeSet<_>>()
    };
    let (marked, doubted) = (faulty("all_###.png"), faulty("film.mkv"));
    assert!(marked.iter().all(|frame| doubted.contains(frame)), "{marked:?}, {doubted:?}");
    let picture = |name: &str, frame: u64| bench.load(&format!("{name}_{frame:03}.png"));
    let changed: Vec<u64> = (0..125).filter(|frame| picture("all", *frame) != picture("whole", *frame)).collect();
    assert!(changed.len() > 3 && changed.iter().all(|frame| marked.contains(frame)), "{changed:?}, {marked:?}");
    // Each begins somewhere else, at a frame that is held, and at those that take after it.
    for part in ["0-88", "89-90", "91-91", "92-92", "93-93", "94-124"] {
        bench.run(&args("part_###.png", &["--damaged", "hold", "--frames", part]));
    }
    for frame in 0..125 {
        let [all, part] = ["all", "part"].map(|name| bench.bytes(&format!("{name}_{frame:03}.png")));
        assert!(all == part, "frame {frame}: {marked:?}");
    }
    // Without an answer none of these is passed on, and those before bear no word.
    for part in ["80-90", "90-90", "92-93", "93-98"] {
        let refused = bench.run(&args("plain_###.png", &["-y", "--frames", part]));
        assert_eq!(refused.status.code(), Some(1), "{part}: {}", text(&refused.stderr));
    }
    bench.succeed(&args("plain_###.png", &["-y", "--frames", "60-86"]));
    assert!(bench.run(&["verify", "plain_###.png", "--frames", "60-86"]).status.success());
}

#[test]
fn a_cut_film_that_counts_no_frames_is_told_to_be_cut() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    // Frame N at N² · 20 ms.
    let source = "testsrc2=size=64x32:rate=50,trim=end_frame=120,settb=1/1000,setpts=N*N*20";
    let vary = ["-fps_mode", "passthrough", "-enc_time_base", "1:1000", "-c:v", "libx264", "-bf", "0", "-g", "10"];
    ffmpeg(&bench, &[&["-f", "lavfi", "-i", source][..], &vary, &["film.mkv"]].concat());
    let bytes = std::fs::read(bench.path("film.mkv")).unwrap();
    std::fs::write(bench.path("film.mkv"), &bytes[..bytes.len() * 6 / 10]).unwrap();
    for damaged in ["hold", "skip"] {
        let out = format!("{damaged}_##.png");
        let args = ["convert", "film.mkv", &out, "--from", "equirect", "--to", "fulldome", "--size", "16"];
        let made = bench.run(&[&args[..], &["--damaged", damaged]].concat());
        assert!(made.status.success(), "{}", text(&made.stderr));
        assert_says(&text(&made.stderr), &["warning: film.mkv", "cut"]);
    }
    let report: Value = serde_json::from_slice(&bench.run(&["verify", "film.mkv", "--json"]).stdout).unwrap();
    let number = |name: &str| report[name].as_u64().unwrap();
    assert!(number("whole") < number("frames") && number("frames") < 120, "{report}");
}

/// The end of a film that was cut out lacks frames before its last one, whether its container counts them or not.
#[cfg(feature = "video")]
#[test]
fn a_film_that_was_cut_out_has_its_last_frame_in_every_container() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let pictures = ["-f", "lavfi", "-i", "testsrc2=size=64x32:rate=25:duration=4"];
    let sound = ["-f", "lavfi", "-i", "sine=duration=4", "-c:v", "libx264", "-bf", "8", "-b_strategy", "0"];
    ffmpeg(&bench, &[&pictures[..], &sound, &["-threads", "2", "-c:a", "mp3", "film.mkv"]].concat());
    let counts = ["mp4", "flv", "nut", "ts", "mkv"].map(|container| {
        let cut = format!("cut.{container}");
        ffmpeg(&bench, &["-i", "film.mkv", "-t", "3.24", "-c", "copy", &cut]);
        let report: Value = serde_json::from_str(&text(&bench.run(&["verify", &cut, "--json"]).stdout)).unwrap();
        assert!(!report.to_string().contains("damaged"), "{container}: {report}");
        report["frames"].as_u64().unwrap()
    });
    assert!(counts[0] > 81 && counts == [counts[0]; 5], "{counts:?}");
    // Nobody knows whether one that Matroska lacks elsewhere was ever there.
    ffmpeg(&bench, &["-i", "film.mkv", "-c", "copy", "-bsf:v", "noise=drop=eq(n\\,41)", "lost.mkv"]);
    let told = text(&bench.run(&["verify", "lost.mkv"]).stderr);
    assert_says(&told, &["warning: lost.mkv: of the first places for 25/1 frames a second it leaves some empty"]);
}
