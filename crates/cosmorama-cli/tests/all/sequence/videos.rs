//! Videos in the place of frames: the same pictures, all of them, and one output that is whole or not there.

use std::process::Stdio;
use std::time::{Duration, Instant};

use super::films::{ffmpeg, film, has_ffmpeg, miscounted, said, taken_apart};
use crate::bench::{Bench, assert_says, eight_bits, text};

/// A conversion that is quick, and differs from frame to frame.
const DOME: [&str; 6] = ["--from", "equirect", "--to", "fulldome", "--size", "16"];

fn convert(bench: &Bench, files: [&str; 2], more: &[&str]) -> String {
    bench.succeed(&[&["convert"], &files[..], &DOME, more].concat())
}

fn refused(bench: &Bench, code: i32, files: [&str; 2], more: &[&str]) -> String {
    bench.fail(code, &[&["convert"], &files[..], &DOME, more].concat())
}

/// Asserts that two folders of frames have the same pixels.
fn assert_same(bench: &Bench, one: &str, other: &str, frames: std::ops::Range<usize>) {
    for frame in frames {
        let [one, other] = [one, other].map(|folder| bench.load(&format!("{folder}/{frame:04}.png")));
        assert!(eight_bits(&one) == eight_bits(&other), "frame {frame}");
    }
}

#[test]
fn a_video_becomes_the_video_of_its_frames() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 50);
    assert_eq!(taken_apart(&bench, "film.mkv", "frames"), 50);
    convert(&bench, ["frames/####.png", "domes/####.png"], &[]);
    convert(&bench, ["film.mkv", "dome.mkv"], &[]);
    assert_eq!(taken_apart(&bench, "dome.mkv", "made"), 50);
    assert_same(&bench, "domes", "made", 0..50);
    assert_says(&said(&bench, "dome.mkv", "v", "stream=codec_name,r_frame_rate"), &["ffv1", "25/1"]);
    // Video to frames, and frames to video.
    convert(&bench, ["film.mkv", "out/####.png"], &[]);
    assert_same(&bench, "domes", "out", 0..50);
    convert(&bench, ["frames/####.png", "again.mkv"], &["--fps", "24000/1001"]);
    assert_eq!(taken_apart(&bench, "again.mkv", "remade"), 50);
    assert_same(&bench, "domes", "remade", 0..50);
    assert_says(&said(&bench, "again.mkv", "v", "stream=r_frame_rate"), &["24000/1001"]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 12);
    for threads in ["1", "2", "7"] {
        convert(&bench, ["film.mkv", &format!("dome{threads}.mkv")], &["--threads", threads]);
        taken_apart(&bench, &format!("dome{threads}.mkv"), threads);
        assert_same(&bench, "1", threads, 0..12);
    }
}

#[test]
fn frames_are_chosen_exactly() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 40);
    convert(&bench, ["film.mkv", "all/####.png"], &[]);
    convert(&bench, ["film.mkv", "some/####.png"], &["--frames", "39,7-20:2,3"]);
    let made = bench.files().into_iter().filter(|path| path.starts_with(bench.path("some"))).count();
    assert_eq!(made, 9);
    for frame in [7, 9, 11, 13, 15, 17, 19, 3, 39] {
        assert_same(&bench, "all", "some", frame..frame + 1);
    }
    // At 25 frames a second these are 10 to 14.
    convert(&bench, ["film.mkv", "timed/####.png"], &["--frames", "00:00:00.4-00:00:00.6"]);
    let made = bench.files().into_iter().filter(|path| path.starts_with(bench.path("timed"))).count();
    assert_eq!(made, 5);
    assert_same(&bench, "all", "timed", 10..15);
    convert(&bench, ["film.mkv", "one.png"], &["--frames", "23"]);
    assert!(eight_bits(&bench.load("one.png")) == eight_bits(&bench.load("all/0023.png")));
    assert_says(
        &refused(&bench, 1, ["film.mkv", "none/####.png"], &["--frames", "38-41"]),
        &["film.mkv", "40,41", "last 39"],
    );
    assert_says(
        &refused(&bench, 1, ["film.mkv", "none/####.png"], &["--frames", "00:01:00-00:02:00"]),
        &["film.mkv", "ends before that", "40 frames", "until 00:00:01.6"],
    );
    assert_says(
        &refused(&bench, 2, ["all/####.png", "none/####.png"], &["--frames", "00:00:00"]),
        &["--frames 00:00:00", "is no video"],
    );
    assert_says(&refused(&bench, 2, ["film.mkv", "none.png"], &[]), &["40 frames cannot go into the one file"]);
}

#[test]
fn a_cut_video_fails_and_names_the_frame() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 50);
    let bytes = bench.bytes("film.mkv");
    std::fs::write(bench.path("cut.mkv"), &bytes[..bytes.len() * 27 / 100]).unwrap();
    for output in ["dome.mkv", "dome_####.png"] {
        let message = bench.run(&[&["convert", "cut.mkv", output], &DOME[..]].concat());
        assert_eq!(message.status.code(), Some(1), "{}", text(&message.stderr));
        assert_says(&text(&message.stderr), &["cut.mkv"]);
        assert!(!bench.path("dome.mkv").exists());
    }
    // What there is can be had.
    let said = bench.run(&[&["convert", "cut.mkv", "held.mkv", "--damaged", "skip"], &DOME[..]].concat());
    assert_eq!(said.status.code(), Some(0), "{}", text(&said.stderr));
    assert_says(&text(&said.stderr), &["warning: cut.mkv", "left out"]);
    let left = taken_apart(&bench, "held.mkv", "held");
    assert!((10..20).contains(&left), "{left} frames");
}

/// Of a video with few chroma samples, a sequence decodes the rows that its pictures show alone; a single picture decodes all.
#[test]
fn rows_that_nothing_shows_are_not_missed() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let pictures = ["-f", "lavfi", "-i", "testsrc2=size=76x38:rate=25", "-frames:v", "3", "-pix_fmt", "yuv420p"];
    ffmpeg(&bench, &[&pictures[..], &["-c:v", "ffv1", "film.mkv"]].concat());
    for (folder, pitch) in [("up", "0"), ("down", "-150"), ("level", "-80")] {
        let to = ["--from", "equirect", "--to", "fulldome", "--pitch", pitch, "--size", "32"];
        for (files, frames) in [("all/####.png", "0-2"), ("one/####.png", "1")] {
            let output = format!("{folder}/{files}");
            bench.succeed(&[&["convert", "film.mkv", &output], &to[..], &["--frames", frames]].concat());
        }
        assert_same(&bench, &format!("{folder}/all"), &format!("{folder}/one"), 1..2);
    }
}

/// Frames beyond those that a file counts are left out, and told of.
#[test]
fn frames_that_are_not_announced_are_told() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    miscounted(&bench, "film.mkv");
    let said = bench.run(&[&["convert", "film.mkv", "dome.mkv"], &DOME[..]].concat());
    assert_eq!(said.status.code(), Some(0), "{}", text(&said.stderr));
    assert_says(&text(&said.stderr), &["warning: film.mkv", "more frames than the 3", "left out"]);
    assert_eq!(taken_apart(&bench, "dome.mkv", "dome"), 3);
    let said = bench.run(&["verify", "film.mkv"]);
    assert_eq!(said.status.code(), Some(1));
    assert_says(&text(&said.stdout), &["more frames than the 3"]);
    // Whoever asks for some of them alone reads no further.
    let said = bench.run(&[&["convert", "film.mkv", "part_####.png", "--frames", "0-1"], &DOME[..]].concat());
    assert!(!text(&said.stderr).contains("announces"), "{}", text(&said.stderr));
}

#[test]
fn sound_goes_along_and_is_cut_with_the_frames() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let pictures = ["-f", "lavfi", "-i", "testsrc2=size=64x32:rate=25:duration=2"];
    let sound = ["-f", "lavfi", "-i", "sine=duration=2", "-c:v", "mpeg4", "-q:v", "1", "-c:a", "flac", "film.mkv"];
    ffmpeg(&bench, &[&pictures[..], &sound].concat());
    convert(&bench, ["film.mkv", "dome.mkv"], &[]);
    assert_says(&said(&bench, "dome.mkv", "a", "stream=codec_name"), &["flac"]);
    convert(&bench, ["film.mkv", "part.mkv"], &["--frames", "25-49"]);
    assert_says(&said(&bench, "part.mkv", "v", "stream=nb_read_frames"), &["=25\n"]);
    assert_says(&said(&bench, "part.mkv", "a", "stream=codec_name"), &["flac"]);
    // Frames that do not follow each other have no sound.
    let output = bench.run(&[&["convert", "film.mkv", "thin.mkv", "--frames", "0-48:2"], &DOME[..]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_says(&text(&output.stderr), &["warning: film.mkv", "sound", "--frames"]);
    assert_eq!(said(&bench, "thin.mkv", "a", "stream=codec_name"), "");
}

#[test]
fn spherical_tags_are_written_read_and_told() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    for (to, size, told) in [
        ("equirect", "64x32", "equirect (spherical tags)"),
        ("equirect:stereo=tb", "64x64", "equirect:stereo=tb (spherical tags)"),
        ("equirect:hfov=180,stereo=sbs", "64x32", "equirect:hfov=180,stereo=sbs (spherical tags)"),
    ] {
        let made = [
            "convert",
            "builtin:demo",
            "sky.mp4",
            "--to",
            to,
            "--size",
            size,
            "-y",
            "--yaw",
            "0..90",
            "--frames",
            "0-2",
        ];
        bench.succeed(&made);
        assert_says(
            &bench.succeed(&["info", "sky.mp4"]),
            &[&format!("projection: {told}"), "frames: 0-2", "codec: h264", "spherical: "],
        );
        // No --from is needed.
        bench.succeed(&["convert", "sky.mp4", "view_#.png", "--to", "perspective:fov=60", "--size", "16", "-y"]);
    }
    bench.succeed(&["convert", "builtin:demo", "dome.mp4", "--to", "fulldome", "--size", "32"]);
    assert!(!bench.succeed(&["info", "dome.mp4"]).contains("spherical"));
}

/// Frames of more than 8 bits are converted by the same threads that ask for them.
#[test]
fn deep_frames_never_wait_for_each_other() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=256x128:rate=25,format=yuv444p10le,trim=end_frame=40";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-c:v", "ffv1", "film.mkv"]);
    for threads in ["1", "2", "8"] {
        let args = [&["convert", "film.mkv", "dome.mkv", "-y", "--threads", threads], &DOME[..]].concat();
        let mut child = bench.command(&args).stderr(Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if begun.elapsed() > Duration::from_secs(120) {
                child.kill().unwrap();
                child.wait().unwrap();
                panic!("{threads} threads wait for each other");
            }
            std::thread::sleep(Duration::from_millis(20));
        };
        assert!(status.success());
        assert_says(&said(&bench, "dome.mkv", "v", "stream=nb_read_frames,pix_fmt"), &["=40\n", "gbrp16le"]);
    }
}

/// Frames that cannot be what is said of them are refused for that, not as if they were files of pictures.
#[test]
fn a_film_of_another_shape_is_no_damaged_picture() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    ffmpeg(&bench, &["-f", "lavfi", "-i", "testsrc2=size=64x64:rate=25,trim=end_frame=2", "-c:v", "ffv1", "film.mkv"]);
    let told = refused(&bench, 2, ["film.mkv", "dome.mkv"], &[]);
    assert_says(&told, &["film.mkv", "64"]);
    assert!(!told.contains("known format"), "{told}");
}

/// What a decoder says behind the last frame still keeps the output from appearing.
#[test]
fn damage_of_the_last_frame_is_heard() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=256x128:rate=25,trim=end_frame=30";
    let codec = ["-c:v", "libx264", "-bf", "0", "-g", "10", "-pix_fmt", "yuv420p"];
    ffmpeg(&bench, &[&["-f", "lavfi", "-i", source], &codec[..], &["film.mp4"]].concat());
    let packets = said(&bench, "film.mp4", "v", "packet=pos,size");
    let number = |name: &str| -> usize {
        let line = packets.lines().rev().find_map(|line| line.strip_prefix(name)).unwrap();
        line.trim().parse().unwrap()
    };
    let (place, size) = (number("pos="), number("size="));
    let mut bytes = bench.bytes("film.mp4");
    bytes[place + size / 2..place + size].fill(0);
    std::fs::write(bench.path("film.mp4"), bytes).unwrap();
    let told = refused(&bench, 1, ["film.mp4", "dome.mkv"], &[]);
    assert_says(&told, &["film.mp4", "frame 29"]);
    assert!(!bench.path("dome.mkv").exists());
}

/// Mastering display and light levels belong to the light of their video, and to no other.
#[test]
fn tags_of_high_dynamic_range_stay_out_of_other_outputs() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=64x32:rate=25,format=yuv420p10le,trim=end_frame=3";
    let display = "master-display=G(13250,34500)B(7500,3000)R(34000,16000)WP(15635,16450)L(10000000,50)";
    let x265 = format!("log-level=error:hdr10=1:repeat-headers=1:{display}:max-cll=1000,400");
    let tags =
        ["-color_primaries", "bt2020", "-color_trc", "smpte2084", "-colorspace", "bt2020nc", "-color_range", "tv"];
    let codec = ["-f", "lavfi", "-i", source, "-c:v", "libx265", "-x265-params", &x265];
    ffmpeg(&bench, &[&codec[..], &tags, &["hdr.mp4"]].concat());
    let side_data =
        |video: &str| said(&bench, video, "v", "stream=color_transfer:stream_side_data_list:frame=side_data_list");
    for name in ["kept.mkv", "kept.mp4"] {
        convert(&bench, ["hdr.mp4", name], &[]);
        assert_says(&side_data(name), &["smpte2084", "max_content=1000"]);
    }
    for name in ["sdr.mkv", "sdr.mp4"] {
        convert(&bench, ["hdr.mp4", name], &["--out-transfer", "bt1886"]);
        let told = side_data(name);
        assert!(!told.contains("max_content") && !told.contains("smpte2084"), "{name}: {told}");
    }
}

/// Pictures with alpha keep it where the codec has room, and it is said where not.
#[test]
fn alpha_goes_into_videos_that_hold_it() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source =
        "testsrc2=size=64x32:rate=25,format=gbrap,geq=r='p(X,Y)':g='p(X,Y)':b='p(X,Y)':a='X*4',trim=end_frame=3";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-c:v", "ffv1", "-pix_fmt", "bgra", "film.mkv"]);
    convert(&bench, ["film.mkv", "frames_#.png"], &[]);
    for (name, format, worst) in [("a.mkv", "bgra", 1), ("a.mov", "yuva444p1", 6), ("a.webm", "yuva420p", 40)] {
        convert(&bench, ["film.mkv", name], &[]);
        let told = said(&bench, name, "v", "stream=pix_fmt:stream_tags=alpha_mode");
        assert!(told.contains(format) || (name == "a.webm" && told.contains("alpha_mode=1")), "{name}: {told}");
        if name == "a.webm" {
            continue;
        }
        bench.succeed(&[
            "convert",
            name,
            "back_#.png",
            "-y",
            "--from",
            "fulldome",
            "--to",
            "fulldome",
            "--size",
            "16",
            "--filter",
            "point",
        ]);
        let (one, other) = (bench.load("frames_2.png"), bench.load("back_2.png"));
        assert_eq!(one.channels(), other.channels(), "{name}");
        let alphas = |image: &cosmorama::raster::EncodedImage| -> Vec<i32> {
            match image.samples() {
                cosmorama::raster::Samples::U8(samples) => {
                    samples.iter().skip(3).step_by(4).map(|a| i32::from(*a)).collect()
                }
                cosmorama::raster::Samples::U16(samples) => {
                    samples.iter().skip(3).step_by(4).map(|a| i32::from(*a >> 8)).collect()
                }
                _ => panic!("floats"),
            }
        };
        let distance = alphas(&one).into_iter().zip(alphas(&other)).map(|(one, other)| (one - other).abs()).max();
        assert!(distance <= Some(worst), "{name}: {distance:?}");
    }
    let output = bench.run(&[&["convert", "film.mkv", "a.mp4"], &DOME[..]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_says(&text(&output.stderr), &["no alpha"]);
}

/// An MP4 that was cut without encoding it again counts frames that it does not show.
#[test]
fn frames_that_an_edit_list_hides_are_not_asked_for() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=64x32:rate=25,trim=end_frame=60";
    ffmpeg(
        &bench,
        &["-f", "lavfi", "-i", source, "-c:v", "libx264", "-bf", "0", "-g", "20", "-pix_fmt", "yuv420p", "whole.mp4"],
    );
    ffmpeg(&bench, &["-ss", "1.2", "-i", "whole.mp4", "-t", "0.6", "-c", "copy", "short.mp4"]);
    let shown = taken_apart(&bench, "short.mp4", "shown");
    convert(&bench, ["short.mp4", "made/####.png"], &[]);
    assert_eq!(std::fs::read_dir(bench.path("made")).unwrap().count(), shown);
    convert(&bench, ["short.mp4", "dome.mkv"], &[]);
    assert_says(&said(&bench, "dome.mkv", "v", "stream=nb_read_frames"), &[&format!("={shown}\n")]);
}

/// Frames of a variable rate are found by their own times.
#[test]
fn times_choose_frames_of_a_variable_rate() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    // Frames at 0, 0.04, 0.16, 0.36, 0.64, 1 seconds, and so on.
    let source = "testsrc2=size=64x32:rate=25,trim=end_frame=12,setpts=N*N/25/TB";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-fps_mode", "vfr", "-c:v", "ffv1", "-pix_fmt", "bgr0", "film.mkv"]);
    convert(&bench, ["film.mkv", "all/####.png"], &[]);
    convert(&bench, ["film.mkv", "some/####.png"], &["--frames", "00:00:00.3-00:00:02,00:00:04"]);
    let mut names: Vec<_> =
        std::fs::read_dir(bench.path("some")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["0003.png", "0004.png", "0005.png", "0006.png", "0007.png", "0010.png"]);
    assert_same(&bench, "all", "some", 3..8);
    assert_says(
        &refused(&bench, 1, ["film.mkv", "no_#.png"], &["--frames", "00:00:00.2-00:00:00.3"]),
        &["rate that varies"],
    );
}

/// Seconds from a video's first frame to the first loud sample of its sound.
fn click_of(bench: &Bench, video: &str) -> f64 {
    let began = |streams: &str| -> f64 {
        let told = said(bench, video, streams, "stream=start_time");
        told.trim().rsplit('=').next().unwrap().lines().next().unwrap().parse().unwrap()
    };
    ffmpeg(bench, &["-i", video, "-map", "0:a", "-ac", "1", "-ar", "48000", "-f", "f32le", "sound.raw"]);
    let bytes = bench.bytes("sound.raw");
    let samples = bytes.chunks_exact(4).map(|sample| f32::from_le_bytes(sample.try_into().unwrap()));
    let loud = samples.enumerate().find(|(_, sample)| sample.abs() > 0.4).expect("a click").0;
    began("a") + loud as f64 / 48000.0 - began("v")
}

/// Sound of a part begins where the part does, by the times of its frames.
#[test]
fn sound_of_a_variable_rate_begins_with_its_part() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    // Frames at 0, 0.04, 0.16, 0.36, 0.64, 1, 1.44, 1.96, 2.56, 3.24, 4 and 4.84 seconds, and a click at 2.1.
    let pictures = "testsrc2=size=64x32:rate=25,trim=end_frame=12,setpts=N*N/25/TB";
    let click = "aevalsrc='if(between(t,2.1,2.12),0.9,0)':s=48000:d=5";
    let inputs = ["-f", "lavfi", "-i", pictures, "-f", "lavfi", "-i", click];
    let coded = ["-fps_mode", "vfr", "-c:v", "ffv1", "-pix_fmt", "bgr0", "-c:a", "pcm_s16le"];
    ffmpeg(&bench, &[&inputs[..], &coded, &["film.mkv"]].concat());
    let coded = ["-fps_mode", "vfr", "-c:v", "mpeg4", "-q:v", "1", "-g", "4", "-c:a", "alac"];
    ffmpeg(&bench, &[&inputs[..], &coded, &["film.mp4"]].concat());
    let begins = [0.0, 0.04, 0.16, 0.36, 0.64, 1.0, 1.44, 1.96];
    for film in ["film.mkv", "film.mp4"] {
        assert!((click_of(&bench, film) - 2.1).abs() < 0.001, "{film}");
        for (first, last) in [(0, 11), (0, 8), (3, 9), (5, 8), (7, 11)] {
            let (frames, part) = (format!("{first}-{last}"), format!("part_{first}_{film}"));
            convert(&bench, [film, &part], &["--frames", &frames, "-y"]);
            let (found, expected) = (click_of(&bench, &part), 2.1 - begins[first]);
            // Packets of sound are copied whole, each at its own time.
            assert!((found - expected).abs() < 0.002, "{film} {frames}: {found} s instead of {expected}");
            assert_says(&said(&bench, &part, "v", "stream=nb_read_frames"), &[&format!("={}\n", last - first + 1)]);
        }
    }
}

#[test]
fn settings_of_videos_are_checked_before_work() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 3);
    assert_says(
        &refused(&bench, 2, ["film.mkv", "a.mkv"], &["--video-codec", "divx"]),
        &["--video-codec divx", "ffv1"],
    );
    assert_says(
        &refused(&bench, 2, ["film.mkv", "a_#.png"], &["--video-codec", "h264"]),
        &["--video-codec", "a_#.png is none"],
    );
    let [small, odd] = ["128", "101"].map(|size| {
        let codec = ["--video-codec", "dnxhr"];
        bench.fail(2, &[&["convert", "film.mkv", "a.mov", "--to", "fulldome", "--size", size], &codec[..]].concat())
    });
    assert_says(
        &small,
        &["a.mov: dnxhr takes no frames of 128x128 pixels; expected 256x120 to", "--size", "--video-codec"],
    );
    assert_says(&odd, &["101x101 pixels; expected an even number of columns", "give such a --size"]);
    assert_says(&refused(&bench, 2, ["film.mkv", "a_#.png"], &["--fps", "24"]), &["--fps", "name the output .mp4"]);
    assert_says(&refused(&bench, 2, ["film.mkv", "a.mkv"], &["--resume"]), &["--resume", "whole or not at all"]);
    assert_says(&refused(&bench, 2, ["film.mkv", "a.avi"], &[]), &["a.avi", ".mkv"]);
    assert_says(&refused(&bench, 2, ["film.mkv", "film.mkv"], &["-y"]), &["would replace its own input"]);
    std::fs::write(bench.path("a.mkv"), "kept").unwrap();
    let told = refused(&bench, 1, ["film.mkv", "a.mkv"], &[]);
    assert_says(&told, &["a.mkv exists; replace it with -y"]);
    assert!(!told.contains("--resume"), "{told}");
    assert_eq!(bench.bytes("a.mkv"), b"kept");
    assert_says(&refused(&bench, 1, ["none.mkv", "b.mkv"], &[]), &["none.mkv"]);
    convert(&bench, ["film.mkv", "a.mkv"], &["-y", "--video-args", "-metadata 'title=A dome'"]);
    assert_says(&said(&bench, "a.mkv", "v", "format_tags=title"), &["A dome"]);
}

#[test]
fn without_ffmpeg_the_message_says_how_to_get_it() {
    let bench = Bench::new();
    std::fs::write(bench.path("film.mkv"), "no matter").unwrap();
    let args = [&["convert", "film.mkv", "dome_#.png"], &DOME[..]].concat();
    let output = bench.command(&args).env("PATH", bench.path("")).output().unwrap();
    let files = bench.files();
    assert_says(&bench.check_failure(1, &output, &files), &["ffmpeg", "install"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_killed_run_leaves_no_video_and_no_ffmpeg() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    let source = "testsrc2=size=512x256:rate=25,format=gbrp,trim=end_frame=200";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-c:v", "ffv1", "film.mkv"]);
    for signal in ["TERM", "KILL"] {
        let args = ["convert", "film.mkv", "dome.mkv", "--from", "equirect", "--to", "fulldome", "--size", "512"];
        let mut child = bench.command(&args).stderr(Stdio::null()).spawn().unwrap();
        let folder = bench.path("").canonicalize().unwrap();
        let begun = Instant::now();
        while ffmpegs_in(&folder).len() < 2 {
            assert!(begun.elapsed() < Duration::from_secs(60), "none was begun");
            std::thread::sleep(Duration::from_millis(20));
        }
        std::process::Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        let code = child.wait().unwrap().code();
        assert_eq!(code, if signal == "TERM" { Some(143) } else { None });
        assert!(!bench.path("dome.mkv").exists(), "{signal}");
        let begun = Instant::now();
        while !ffmpegs_in(&folder).is_empty() {
            assert!(begun.elapsed() < Duration::from_secs(20), "{signal}: an ffmpeg goes on");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

/// A program that never ends, in place of an encoder or a decoder, is ended and waited for with the job.
#[cfg(target_os = "linux")]
#[test]
fn programs_that_hang_end_with_the_job() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 60);
    let found = std::process::Command::new("sh").args(["-c", "command -v ffmpeg"]).output().unwrap();
    for (number, (hangs, signal)) in [("pipe:0", "TERM"), ("pipe:1", "INT")].into_iter().enumerate() {
        let folder = format!("bin_{number}");
        std::fs::create_dir(bench.path(&folder)).unwrap();
        let script = format!(
            "#!/bin/sh\ncase \"$*\" in *{hangs}*) exec sleep 60;; esac\nexec {} \"$@\"\n",
            text(&found.stdout).trim()
        );
        let program = bench.path(&format!("{folder}/ffmpeg"));
        std::fs::write(&program, script).unwrap();
        std::fs::set_permissions(&program, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
        let path = format!("{}:{}", bench.path(&folder).display(), std::env::var("PATH").unwrap());
        let args = [&["convert", "film.mkv", "dome.mkv"], &DOME[..]].concat();
        let mut child = bench.command(&args).env("PATH", path).stderr(Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        let sleeper = loop {
            if let Some(found) = children_of(child.id()).into_iter().find(|(_, name)| name == "sleep") {
                break found.0;
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "none was begun");
            std::thread::sleep(Duration::from_millis(20));
        };
        let others = children_of(child.id());
        let sent = Instant::now();
        std::process::Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        let code = child.wait().unwrap().code();
        assert!(sent.elapsed() < Duration::from_secs(2), "{hangs}: {:?}", sent.elapsed());
        assert_eq!(code, Some(if signal == "TERM" { 143 } else { 130 }), "{hangs}");
        assert!(others.iter().any(|(other, _)| *other == sleeper));
        for (process, name) in others {
            assert!(!std::path::Path::new(&format!("/proc/{process}")).exists(), "{hangs}: {name} goes on");
        }
        assert!(!bench.path("dome.mkv").exists());
    }
}

/// Returns the number and the name of each process that another has started.
#[cfg(target_os = "linux")]
fn children_of(parent: u32) -> Vec<(u32, String)> {
    let processes =
        std::fs::read_dir("/proc").unwrap().filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    let child = |process: u32| {
        let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        // The name stands in parentheses, the parent is the second word behind them.
        let (name, rest) = stat.split_once('(')?.1.rsplit_once(')')?;
        let is_child = rest.split_whitespace().nth(1)? == parent.to_string();
        is_child.then(|| (process, name.to_owned()))
    };
    processes.filter_map(child).collect()
}

/// Returns the processes called ffmpeg that work in a folder.
#[cfg(target_os = "linux")]
fn ffmpegs_in(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let processes = std::fs::read_dir("/proc").unwrap().filter_map(|entry| Some(entry.ok()?.path()));
    let is_one = |process: &std::path::PathBuf| {
        let name = std::fs::read_to_string(process.join("comm")).unwrap_or_default();
        name.trim() == "ffmpeg" && std::fs::read_link(process.join("cwd")).is_ok_and(|place| place == folder)
    };
    processes.filter(is_one).collect()
}
