//! Videos that are written, whole or not at all.

use std::path::Path;

use cosmorama::raster::{Channels, Depth, Primaries, Transfer};
use cosmorama_io::pending::Unfinished;
use cosmorama_video::{
    Codec, ColourTags, ContentLight, Ffmpeg, FrameTimes, HdrTags, MasteringDisplay, Ratio, ReadOptions, VideoError,
    VideoWriter, WriteSettings, Written,
};

use crate::common::{ffmpeg, frames, names, picture};

pub(crate) fn rate() -> Ratio {
    Ratio::new(30_000, 1001).unwrap()
}

/// Writes pictures of noise, and returns what is told of them.
pub(crate) fn write(ffmpeg: &Ffmpeg, path: &Path, settings: &WriteSettings, count: u32) -> Result<Written, VideoError> {
    let channels = if settings.has_alpha { Channels::Rgba } else { Channels::Rgb };
    let mut writer = VideoWriter::create(ffmpeg, path, settings.clone(), &Unfinished::default())?;
    for number in 0..count {
        let time = matches!(settings.times, FrameTimes::Stamps { .. }).then_some(i64::from(number * number) * 40);
        writer.write(&picture(settings.size, channels, settings.depth, number), time)?;
    }
    writer.finish()
}

#[test]
fn ffv1_gives_back_what_it_was_given() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (depth, has_alpha) in
        [(Depth::Eight, false), (Depth::Eight, true), (Depth::Sixteen, false), (Depth::Sixteen, true)]
    {
        let path = folder.path().join("a.mkv");
        // Odd sizes, too.
        let settings = WriteSettings { depth, has_alpha, ..WriteSettings::new((51, 33), rate()) };
        let written = write(&ffmpeg, &path, &settings, 7).unwrap();
        assert_eq!((written.frames, written.encoder.as_str()), (7, "ffv1"));
        let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let channels = if has_alpha { Channels::Rgba } else { Channels::Rgb };
        assert_eq!(found.len(), 7);
        for (number, frame) in found.iter().enumerate() {
            assert!(frame.image == picture((51, 33), channels, depth, number as u32), "{depth} {has_alpha} {number}");
        }
        assert_eq!(names(folder.path()), ["a.mkv"]);
    }
}

#[test]
fn every_preset_makes_a_video_of_the_same_frames_and_rate() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let known = ffmpeg.encoders().unwrap().to_vec();
    let folder = tempfile::tempdir().unwrap();
    for (codec, names, size) in [
        (Codec::H264, ["mp4", "mkv"], (64, 32)),
        (Codec::Hevc, ["mp4", "mov"], (64, 32)),
        (Codec::ProRes, ["mov", "mkv"], (64, 32)),
        (Codec::DnxHr, ["mov", "mkv"], (256, 128)),
        (Codec::Av1, ["mp4", "webm"], (64, 64)),
        (Codec::Vp9, ["webm", "mkv"], (64, 32)),
    ] {
        if !codec.encoders().iter().any(|name| known.iter().any(|known| known == name)) {
            eprintln!("SKIPPED: this ffmpeg cannot make {}", codec.name());
            continue;
        }
        for (extension, depth) in names.iter().zip([Depth::Eight, Depth::Sixteen]) {
            let path = folder.path().join(format!("{}.{extension}", codec.name()));
            let settings =
                WriteSettings { depth, codec: Some(codec), frames: Some(5), ..WriteSettings::new(size, rate()) };
            write(&ffmpeg, &path, &settings, 5).unwrap();
            let info = ffmpeg.probe(&path).unwrap();
            assert_eq!((info.rate, info.is_variable, info.size()), (rate(), false, size), "{codec:?} {extension}");
            assert_eq!(
                (info.colour.primaries, info.colour.transfer, info.colour.matrix),
                (Some(1), Some(1), Some(1)),
                "{codec:?} {extension}"
            );
            assert!(depth == Depth::Eight || info.bits >= 10, "{codec:?} {extension}: {}", info.bits);
            assert_eq!(frames(&ffmpeg, &path, ReadOptions::default()).unwrap().len(), 5, "{codec:?} {extension}");
        }
    }
}

#[test]
fn the_extension_chooses_the_codec() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let pq = ColourTags::of(&Primaries::REC2020, &Transfer::Pq);
    let sdr = ColourTags::of(&Primaries::REC709, &Transfer::Bt1886);
    for (name, depth, colour, codec, format) in [
        ("a.mp4", Depth::Eight, sdr, "h264", "yuv420p"),
        ("a.m4v", Depth::Ten, sdr, "hevc", "yuv420p10le"),
        ("b.mp4", Depth::Sixteen, pq, "hevc", "yuv420p10le"),
        ("a.mov", Depth::Eight, sdr, "prores", "yuv422p10le"),
        ("a.mkv", Depth::Eight, sdr, "ffv1", "bgr0"),
        ("a.webm", Depth::Eight, sdr, "vp9", "yuv420p"),
    ] {
        let path = folder.path().join(name);
        write(&ffmpeg, &path, &WriteSettings { depth, colour, ..WriteSettings::new((64, 32), rate()) }, 3).unwrap();
        let info = ffmpeg.probe(&path).unwrap();
        assert_eq!((info.codec.as_str(), info.pixel_format.as_str()), (codec, format), "{name}");
    }
}

/// The tags of HDR10 and HLG go into the file, and come out of it.
#[test]
fn tags_of_high_dynamic_range_are_kept() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mastering = MasteringDisplay {
        red: [34000, 16000],
        green: [13250, 34500],
        blue: [7500, 3000],
        white: [15635, 16450],
        brightest: 10_000_000,
        darkest: 50,
    };
    let light = ContentLight { brightest: 1000, mean: 400 };
    for (name, transfer, number) in [
        ("pq.mp4", Transfer::Pq, 16),
        ("pq.mkv", Transfer::Pq, 16),
        ("hlg.mov", Transfer::Hlg, 18),
        ("pq.webm", Transfer::Pq, 16),
    ] {
        let path = folder.path().join(name);
        let colour = ColourTags::of(&Primaries::REC2020, &transfer);
        let hdr = HdrTags { mastering: Some(mastering), light: Some(light) };
        let settings = WriteSettings { depth: Depth::Sixteen, colour, hdr, ..WriteSettings::new((64, 32), rate()) };
        write(&ffmpeg, &path, &settings, 3).unwrap();
        let info = ffmpeg.probe(&path).unwrap();
        assert_eq!((info.colour.primaries, info.colour.transfer), (Some(9), Some(number)), "{name}");
        assert!(info.colour.is_hdr() && info.colour.known_transfer() == Some(transfer), "{name}");
        assert_eq!(info.hdr, hdr, "{name}");
    }
}

/// Times of frames, in any unit.
#[test]
fn times_are_written_where_the_rate_varies() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, time_base) in [("a.mp4", Ratio::new(1, 90_000).unwrap()), ("a.mkv", Ratio::new(1, 1000).unwrap())] {
        let path = folder.path().join(name);
        let times = FrameTimes::Stamps { time_base, rate: Ratio::new(25, 1).unwrap() };
        let settings = WriteSettings { times, codec: Some(Codec::H264), ..WriteSettings::new((64, 32), rate()) };
        write(&ffmpeg, &path, &settings, 12).unwrap();
        let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let times: Vec<i64> = found.iter().map(|frame| frame.time - found[0].time).collect();
        assert_eq!(times, (0..12).map(|number| number * number * 40).collect::<Vec<_>>(), "{name}");
    }
}

#[test]
fn what_a_file_cannot_hold_is_refused_before_anything_is_written() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let settings = || WriteSettings::new((64, 32), rate());
    let cases = [
        ("a.mp4", WriteSettings { codec: Some(Codec::Ffv1), ..settings() }, "h264, hevc"),
        ("a.png", settings(), ".mkv"),
        ("a.mp4", WriteSettings { size: (63, 32), ..settings() }, "63x32"),
        ("a.mp4", WriteSettings { size: (0, 32), ..settings() }, "0x32"),
        ("a.mov", WriteSettings { codec: Some(Codec::DnxHr), ..settings() }, "256x120"),
        ("a.mov", WriteSettings { codec: Some(Codec::Hevc), size: (14, 32), ..settings() }, "16x16"),
        ("a.mp4", WriteSettings { size: (16386, 32), ..settings() }, "16384x16384"),
        ("a.mkv", WriteSettings { size: (9460, 9460), ..settings() }, "9459x9459"),
        ("a.mp4", WriteSettings { has_alpha: true, ..settings() }, "alpha"),
        ("a.mkv", WriteSettings { depth: Depth::Float, ..settings() }, "float"),
        ("missing/a.mkv", settings(), "does not exist"),
    ];
    for (name, settings, word) in cases {
        let path = folder.path().join(name);
        let checked = VideoWriter::check(&ffmpeg, &path, &settings);
        let error = VideoWriter::create(&ffmpeg, &path, settings, &Unfinished::default());
        let error = error.unwrap_err().to_string();
        assert!(error.contains(word), "{name}: {error}");
        // Of folders, only what writes there knows.
        if !name.starts_with("missing") {
            assert_eq!(checked.unwrap_err().to_string(), error, "{name}");
        }
    }
    assert!(names(folder.path()).is_empty());
}

/// The least frames that each encoder takes.
#[test]
fn small_frames_are_written() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (codec, name, size) in [
        (Codec::H264, "a.mp4", (2, 2)),
        (Codec::Hevc, "a.mp4", (16, 16)),
        (Codec::ProRes, "a.mov", (2, 1)),
        (Codec::DnxHr, "a.mov", (256, 120)),
        (Codec::Ffv1, "a.mkv", (4, 4)),
        (Codec::Ffv1, "a.mkv", (5, 7)),
        (Codec::Vp9, "a.webm", (2, 2)),
        (Codec::Av1, "a.mp4", (2, 2)),
        (Codec::Av1, "a.webm", (64, 64)),
    ] {
        let path = folder.path().join(name);
        let settings = WriteSettings { codec: Some(codec), ..WriteSettings::new(size, rate()) };
        match write(&ffmpeg, &path, &settings, 2) {
            Ok(written) => assert_eq!(written.frames, 2, "{codec:?}"),
            Err(VideoError::UnfitSize { .. }) if codec == Codec::Av1 => {
                assert!(!ffmpeg.encoders().unwrap().iter().any(|name| name == "libaom-av1"));
            }
            Err(error) => panic!("{codec:?}: {error}"),
        }
    }
}

#[test]
fn frames_unlike_the_settings_are_refused() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mkv");
    let settings = WriteSettings::new((8, 6), rate());
    let mut writer = VideoWriter::create(&ffmpeg, &path, settings, &Unfinished::default()).unwrap();
    writer.write(&picture((8, 6), Channels::Rgb, Depth::Eight, 0), None).unwrap();
    for (frame, word) in [
        (picture((6, 8), Channels::Rgb, Depth::Eight, 1), "6x8"),
        (picture((8, 6), Channels::Rgba, Depth::Eight, 1), "RGBA"),
        (picture((8, 6), Channels::Rgb, Depth::Sixteen, 1), "depth 16"),
    ] {
        let error = writer.write(&frame, None).unwrap_err().to_string();
        assert!(error.contains(word) && error.contains("frame 1"), "{error}");
    }
    let timed = writer.write(&picture((8, 6), Channels::Rgb, Depth::Eight, 1), Some(3)).unwrap_err().to_string();
    assert!(timed.contains("time"), "{timed}");
    assert_eq!(writer.finish().unwrap().frames, 1);
}

/// Other frames than announced, and none at all: nothing appears.
#[test]
fn an_incomplete_video_does_not_appear() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    std::fs::write(&path, "old").unwrap();
    let settings = WriteSettings { frames: Some(4), ..WriteSettings::new((64, 32), rate()) };
    let error = write(&ffmpeg, &path, &settings, 3).unwrap_err().to_string();
    assert!(error.contains("3 frames") && error.contains('4'), "{error}");
    assert!(write(&ffmpeg, &path, &WriteSettings { frames: None, ..settings.clone() }, 0).is_err());
    // Dropped in the middle.
    let mut writer = VideoWriter::create(&ffmpeg, &path, settings, &Unfinished::default()).unwrap();
    writer.write(&picture((64, 32), Channels::Rgb, Depth::Eight, 0), None).unwrap();
    drop(writer);
    assert_eq!(names(folder.path()), ["a.mp4"]);
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    if cfg!(target_os = "linux") {
        assert_eq!(crate::hostile::processes_with(folder.path().to_str().unwrap()), 0);
    }
}

/// Arguments of the user's that ffmpeg refuses, or by which frames are lost.
#[test]
fn what_goes_wrong_in_ffmpeg_is_told() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    let with = |arguments: &[&str]| WriteSettings {
        arguments: arguments.iter().map(|&argument| argument.to_owned()).collect(),
        ..WriteSettings::new((64, 32), rate())
    };
    let error = write(&ffmpeg, &path, &with(&["-preset", "nonsense"]), 200).unwrap_err().to_string();
    assert!(error.contains("ffmpeg failed") && error.ends_with("were -preset nonsense"), "{error}");
    let error = write(&ffmpeg, &path, &with(&["-frames:v", "3"]), 5).unwrap_err().to_string();
    assert!(error.contains("3 frames") || error.contains("ffmpeg failed"), "{error}");
    assert!(names(folder.path()).is_empty());
}

/// The bytes are the same each time.
#[test]
fn the_same_frames_make_the_same_bytes() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.mkv", "a.mp4", "a.mov"] {
        let path = folder.path().join(name);
        let bytes = [0; 2].map(|_| {
            write(&ffmpeg, &path, &WriteSettings::new((64, 32), rate()), 6).unwrap();
            std::fs::read(&path).unwrap()
        });
        assert!(bytes[0] == bytes[1], "{name}");
    }
}

#[cfg(unix)]
#[test]
fn programs_that_are_absent_old_or_poor_are_told() {
    let Some(found) = ffmpeg() else { return };
    drop(found);
    let folder = tempfile::tempdir().unwrap();
    let at = |ffmpeg: &Path| Ffmpeg::at(ffmpeg.to_owned(), "ffprobe".into());
    let error = at(Path::new("/nowhere/ffmpeg")).unwrap_err().to_string();
    assert!(error.contains("apt install ffmpeg") && error.contains("brew") && error.contains("winget"), "{error}");
    let old = crate::common::script(folder.path(), "old", "echo ffmpeg version 4.3.1 Copyright");
    let error = at(&old).unwrap_err().to_string();
    assert!(error.contains("4.3") && error.contains("4.4 or later"), "{error}");
    let answers = "case \"$*\" in *-encoders*) echo ' ------'; echo ' V.... ffv1 FFV1';; *) exec ffmpeg \"$@\";; esac";
    let poor = at(&crate::common::script(folder.path(), "poor", answers)).unwrap();
    let error = write(&poor, &folder.path().join("a.mp4"), &WriteSettings::new((64, 32), rate()), 1).unwrap_err();
    assert!(matches!(error, VideoError::NoEncoder { codec: "h264", .. }), "{error}");
    assert!(error.to_string().contains("libx264") && error.to_string().contains("ffv1"), "{error}");
    assert_eq!(write(&poor, &folder.path().join("a.mkv"), &WriteSettings::new((64, 32), rate()), 1).unwrap().frames, 1);
}

/// No room on the disk: nothing is left behind. The limit on the size of a file stands in for the disk.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing_behind() {
    let Some(found) = ffmpeg() else { return };
    drop(found);
    let folder = tempfile::tempdir().unwrap();
    let limited = "trap '' XFSZ; ulimit -f 64; exec ffmpeg \"$@\"";
    let limited = Ffmpeg::at(crate::common::script(folder.path(), "limited", limited), "ffprobe".into()).unwrap();
    let output = tempfile::tempdir().unwrap();
    let error = write(&limited, &output.path().join("a.mkv"), &WriteSettings::new((256, 256), rate()), 20).unwrap_err();
    assert!(matches!(error, VideoError::Encode { .. } | VideoError::NotAsGiven { .. }), "{error}");
    assert!(names(output.path()).is_empty());
}
