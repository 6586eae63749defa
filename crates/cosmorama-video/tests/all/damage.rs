//! What ffmpeg takes for a whole video: frames that are damaged, missing, or behind the end of a file. It ends with success on all.

use std::path::Path;

use cosmorama_video::{Damaged, Fault, Ffmpeg, FrameCondition, ReadOptions, VideoError, VideoReader};

use crate::common::{difference, ffmpeg, frames, moving, of, probed, run};

pub(crate) fn with(damaged: Damaged) -> ReadOptions {
    ReadOptions { damaged, ..ReadOptions::default() }
}

/// Place and size of the coded frame that is stored at a number.
pub(crate) fn packet(path: &Path, number: usize) -> (usize, usize) {
    let lines = probed(path, "-select_streams v:0 -show_entries packet=pos,size -of csv=p=0");
    // Side data of a transport stream has lines of its own.
    let line = lines.lines().filter(|line| !line.is_empty()).nth(number).unwrap();
    let mut fields = line.split(',').map(|field| field.parse::<usize>().unwrap());
    let (size, place) = (fields.next().unwrap(), fields.next().unwrap());
    (place, size)
}

/// Overwrites the second half of a coded frame, as a broken disk does.
pub(crate) fn damage(path: &Path, number: usize) {
    let (place, size) = packet(path, number);
    let mut bytes = std::fs::read(path).unwrap();
    for (index, byte) in bytes[place + size / 2..place + size].iter_mut().enumerate() {
        *byte = if index % 3 == 0 { byte.wrapping_mul(7).wrapping_add(91) } else { 0 };
    }
    std::fs::write(path, bytes).unwrap();
}

fn cut(path: &Path, part: f64) {
    let bytes = std::fs::read(path).unwrap();
    std::fs::write(path, &bytes[..(bytes.len() as f64 * part) as usize]).unwrap();
}

/// The first trap: a damaged picture is replaced by its neighbour, or left out.
#[test]
fn a_damaged_frame_is_named_held_or_skipped() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, arguments) in
        [("png.mov", "-c:v png"), ("mjpeg.mov", "-c:v mjpeg -pix_fmt yuvj420p"), ("prores.mov", "-c:v prores_ks")]
    {
        let path = folder.path().join(name);
        run(&format!("{} {arguments}", moving(128, 64, "25", 50)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        assert_eq!(whole.len(), 50, "{name}");
        damage(&path, 25);

        let error = frames(&ffmpeg, &path, with(Damaged::Error)).unwrap_err();
        assert!(matches!(error, VideoError::DamagedFrame { frame: 25, .. }), "{name}: {error}");
        let held = frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap();
        assert_eq!(held.len(), 50, "{name}");
        assert_eq!(held[25].condition, FrameCondition::Held, "{name}");
        assert_eq!((held[25].index, held[25].time), (25, whole[25].time), "{name}");
        assert!(held[25].image == whole[24].image, "{name}");
        assert!(held[26..] == whole[26..] && held[..25] == whole[..25], "{name}");
        let skipped = frames(&ffmpeg, &path, with(Damaged::Skip)).unwrap();
        assert!(skipped[..25] == whole[..25] && skipped[25..] == whole[26..], "{name}");

        // Frames before and behind it are whole.
        assert!(frames(&ffmpeg, &path, of(0, 20)).unwrap() == whole[..21], "{name}");
        assert!(frames(&ffmpeg, &path, of(30, 49)).unwrap() == whole[30..], "{name}");
    }
}

/// FFV1 has sums of its own, and its decoder paints over what does not fit them.
#[test]
fn a_damaged_frame_of_ffv1_is_named_held_or_skipped() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mkv");
    run(&format!("{} -c:v ffv1 -level 3 -g 1 -slicecrc 1 -pix_fmt bgr0", moving(128, 64, "25", 30)), &path);
    let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    // Its end tells where its parts lie: what is damaged before is painted over, and without it the frame is left out.
    let (place, size) = packet(&path, 11);
    let mut bytes = std::fs::read(&path).unwrap();
    bytes[place + size / 2..place + size / 2 + 8].fill(0x5a);
    std::fs::write(&path, bytes).unwrap();
    for number in [17, 29] {
        damage(&path, number);
    }
    let error = frames(&ffmpeg, &path, with(Damaged::Error)).unwrap_err();
    assert!(matches!(error, VideoError::DamagedFrame { frame: 11, .. }), "{error}");
    if ffmpeg.version() >= (cosmorama_video::Version { major: 7, minor: 0 }) {
        eprintln!("SKIPPED: this ffmpeg decodes ahead, and does not tell which frame it means");
        return;
    }
    let held = frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap();
    assert_eq!(held.len(), 30);
    for (number, frame) in held.iter().enumerate() {
        let is_held = [11, 17, 29].contains(&number);
        assert_eq!(frame.condition == FrameCondition::Held, is_held, "{number}");
        assert!(frame.image == whole[if is_held { number - 1 } else { number }].image, "{number}");
    }
    let skipped = frames(&ffmpeg, &path, with(Damaged::Skip)).unwrap();
    let numbers: Vec<u64> = skipped.iter().map(|frame| frame.index).collect();
    assert_eq!(numbers, (0..29).filter(|number| ![11, 17].contains(number)).collect::<Vec<_>>());
}

/// Faults are told with their reason.
#[test]
fn faults_are_listed() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mov");
    run(&format!("{} -c:v png", moving(128, 64, "25", 20)), &path);
    // The first, two in a row, and the last.
    for number in [0, 7, 8, 19] {
        damage(&path, number);
    }
    let mut reader = VideoReader::open(&ffmpeg, &ffmpeg.probe(&path).unwrap(), with(Damaged::Hold)).unwrap();
    let mut found = Vec::new();
    while let Some(frame) = reader.next_frame().unwrap() {
        found.push(frame);
    }
    assert_eq!(found.iter().map(|frame| frame.index).collect::<Vec<_>>(), (0..20).collect::<Vec<_>>());
    assert!(found[0].image == found[1].image && found[8].image == found[6].image && found[19].image == found[18].image);
    let faults: Vec<(u64, u64)> = reader.faults().iter().map(|fault| (fault.frame, fault.count)).collect();
    assert_eq!(faults, [(0, 1), (7, 2), (19, 1)]);
    assert!(reader.faults().iter().all(|fault| !fault.reason.is_empty()));
}

/// Damaged H.264: the decoder would paint it over.
#[test]
fn damage_in_h264_is_named() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    run(&format!("{} -c:v libx264 -bf 0 -g 10", moving(256, 128, "25", 50)), &path);
    damage(&path, 30);
    let error = frames(&ffmpeg, &path, with(Damaged::Error)).unwrap_err();
    assert!(matches!(error, VideoError::DamagedFrame { frame: 30, .. }), "{error}");
}

/// What takes after a damaged frame is not given for whole because that frame is not asked for.
#[test]
fn damage_before_the_first_frame_that_is_asked_for_is_told_as_far_as_it_reaches() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    // With a seek, and without.
    for (number, key) in [(85, 100), (31, 40)] {
        let path = folder.path().join(format!("{number}.mp4"));
        run(&format!("{} -c:v libx264 -bf 0 -g 20", moving(256, 128, "25", 150)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        damage(&path, number);
        let damaged = number as u64;
        let read = |first: u64, last: u64, damaged: Damaged| {
            let options = ReadOptions { damaged, ..of(first, last) };
            let mut reader = VideoReader::open(&ffmpeg, &ffmpeg.probe(&path)?, options)?;
            let mut found = Vec::new();
            while let Some(frame) = reader.next_frame()? {
                found.push(frame.index);
            }
            let numbers = |faults: &[Fault]| faults.iter().map(|fault| fault.frame).collect::<Vec<_>>();
            Ok((found, numbers(reader.faults()), numbers(reader.faults_beside())))
        };
        let error = read(damaged + 3, key + 5, Damaged::Error).unwrap_err();
        assert!(matches!(error, VideoError::DamagedFrame { frame, .. } if frame == damaged), "{error}");
        assert!(error.to_string().contains(&format!("frame {}, which is asked for", damaged + 3)), "{error}");
        for answer in [Damaged::Hold, Damaged::Skip] {
            let (found, own, before) = read(damaged + 3, key + 5, answer).unwrap();
            assert_eq!((found, own, before), ((damaged + 3..=key + 5).collect(), vec![], vec![damaged]));
        }
        // It is the first that is asked for itself.
        let error = read(damaged, key, Damaged::Error).unwrap_err();
        assert!(matches!(error, VideoError::DamagedFrame { frame, .. } if frame == damaged), "{error}");
        let (found, own, before) = read(damaged, key, Damaged::Skip).unwrap();
        assert_eq!((found, own, before), ((damaged + 1..=key).collect(), vec![damaged], vec![]));
        // From the next key frame on, and before it, all is whole.
        assert!(frames(&ffmpeg, &path, of(key, key + 30)).unwrap() == whole[key as usize..=key as usize + 30]);
        assert!(frames(&ffmpeg, &path, of(damaged - 15, damaged - 1)).unwrap() == whole[number - 15..number]);
    }
}

/// A damaged key frame, and codecs whose decoders paint over what is damaged: what they say of it comes with no missing frame.
#[test]
fn damage_of_a_key_frame_is_told_of_the_frames_behind_it() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, arguments) in [
        ("a.mkv", "-c:v libx264 -bf 0 -g 20 -x264-params scenecut=0"),
        ("b.mkv", "-c:v mpeg2video -bf 0 -g 20 -sc_threshold 1000000000 -b:v 2M"),
    ] {
        let path = folder.path().join(name);
        run(&format!("{} {arguments}", moving(256, 128, "25", 120)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        damage(&path, 80);
        let all = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
        assert!(matches!(all, VideoError::DamagedFrame { frame: 79..=80, .. }), "{name}: {all}");
        for first in [81, 85, 90] {
            let Err(error) = frames(&ffmpeg, &path, of(first, 95)) else { panic!("{name}: {first} is whole") };
            assert!(matches!(error, VideoError::DamagedFrame { frame: 79..=80, .. }), "{name}, {first}: {error}");
            assert!(error.to_string().contains(&format!("frame {first}, which is asked for")), "{name}: {error}");
        }
        for (first, last) in [(70, 95), (80, 80)] {
            let Err(error) = frames(&ffmpeg, &path, of(first, last)) else { panic!("{name}: {first} is whole") };
            assert!(matches!(error, VideoError::DamagedFrame { frame: 79..=80, .. }), "{name}, {first}: {error}");
        }
        assert!(frames(&ffmpeg, &path, of(101, 119)).unwrap() == whole[101..], "{name}");
        assert!(frames(&ffmpeg, &path, of(61, 78)).unwrap() == whole[61..=78], "{name}");
        // Of frames that nobody looks at, nothing is told.
        let apart = ReadOptions { looked_at: Some([60, 101].into()), ..of(60, 101) };
        let found = frames(&ffmpeg, &path, ReadOptions { damaged: Damaged::Skip, ..apart }).unwrap();
        assert!(found.first() == Some(&whole[60]) && found.last() == Some(&whole[101]), "{name}");
    }
}

/// MPEG's decoders lose a frame that they hold back when the next that is no B frame is damaged, and paint that one over.
#[test]
fn what_a_decoder_painted_over_is_among_the_traces() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, codec) in [("a.mkv", "mpeg2video"), ("b.avi", "mpeg4"), ("c.mpg", "mpeg2video")] {
        let path = folder.path().join(name);
        let coding = "-bf 2 -g 12 -sc_threshold 1000000000 -b:v 4M";
        run(&format!("{} -c:v {codec} {coding}", moving(128, 64, "25", 40)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        assert_eq!(whole.len(), 40, "{name}");
        let bytes = std::fs::read(&path).unwrap();
        // Key frames, one before, and a B frame.
        for (number, last) in [(10, 23), (22, 35), (19, 35), (11, 23)] {
            damage(&path, number);
            let info = ffmpeg.probe(&path).unwrap();
            let mut reader = VideoReader::open(&ffmpeg, &info, with(Damaged::Hold)).unwrap();
            let mut wrong = Vec::new();
            while let Some(frame) = reader.next_frame().unwrap() {
                let is_other = frame.image != whole[frame.index as usize].image;
                wrong.extend((frame.condition == FrameCondition::Whole && is_other).then_some(frame.index));
            }
            let damaged: Vec<_> = reader.faults().iter().map(|fault| fault.frame..fault.frame + fault.count).collect();
            assert!(!damaged.is_empty(), "{name}, {number}");
            let traces = ffmpeg.coded_order(&info).unwrap().unwrap().traces(&damaged);
            let untold: Vec<u64> = wrong.into_iter().filter(|frame| !traces.contains(frame)).collect();
            assert!(untold.is_empty(), "{name}, {number}: {untold:?} are wrong, and not among {traces:?}");
            assert!(traces.iter().all(|frame| *frame <= last), "{name}, {number}: {traces:?}");
            std::fs::write(&path, &bytes).unwrap();
        }
    }
}

/// Its decoder gives the picture a time behind all frames.
#[test]
fn the_last_frame_of_mpeg4_is_damaged() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, coding) in [("a.avi", "-bf 0"), ("b.avi", "-bf 1"), ("c.mp4", "-bf 1")] {
        let path = folder.path().join(name);
        run(&format!("{} -c:v mpeg4 {coding} -g 12 -b:v 4M", moving(128, 64, "25", 30)), &path);
        damage(&path, 29);
        let read = |damaged: Damaged| {
            let options = ReadOptions { threads: 1, ..with(damaged) };
            let mut reader = VideoReader::open(&ffmpeg, &ffmpeg.probe(&path)?, options)?;
            let mut found = Vec::new();
            while let Some(frame) = reader.next_frame()? {
                found.push(frame.index);
            }
            let faults = reader.faults().iter().flat_map(|fault| fault.frame..fault.frame + fault.count);
            Ok((found, faults.collect::<Vec<u64>>()))
        };
        let (found, faults) = read(Damaged::Hold).unwrap();
        assert_eq!(found, (0..30).collect::<Vec<_>>(), "{name}");
        assert!(!faults.is_empty() && faults.iter().all(|frame| (27..30).contains(frame)), "{name}: {faults:?}");
        let (found, skipped) = read(Damaged::Skip).unwrap();
        assert!(found.len() < 30 && found.iter().all(|frame| *frame < 30), "{name}: {found:?}");
        assert!(skipped.iter().all(|frame| (27..30).contains(frame)), "{name}: {skipped:?}");
        if coding == "-bf 0" {
            assert_eq!((faults, skipped), (vec![29], vec![29]), "{name}");
        }
        let error = read(Damaged::Error).unwrap_err();
        assert!(matches!(error, VideoError::DamagedFrame { frame: 27..30, .. }), "{name}: {error}");
    }
}

/// A transport stream tells that packets are lacking, and decoders paint over what they lack, some without an error.
#[test]
fn packets_that_a_transport_stream_lost_are_damage() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let hevc = "-c:v libx265 -preset ultrafast -x265-params log-level=none:crf=12:keyint=20:bframes=0";
    for (name, coding) in [("a.ts", "-c:v libx264 -bf 2 -g 20 -crf 12"), ("b.ts", hevc)] {
        let path = folder.path().join(name);
        run(&format!("{} {coding}", moving(128, 64, "25", 40)), &path);
        assert_eq!(frames(&ffmpeg, &path, ReadOptions::default()).unwrap().len(), 40, "{name}");
        let (place, _) = packet(&path, 25);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes.drain(place + 188..place + 3 * 188);
        std::fs::write(&path, bytes).unwrap();
        let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
        assert!(matches!(error, VideoError::DamagedFrame { frame: 18..30, .. }), "{name}: {error}");
        assert_eq!(frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap().len(), 40, "{name}");
    }
}

/// Decoders that begin within a film complain of frames that lack others before that place, which is no damage. In a transport stream a
/// seek ends anywhere, and the decoder of HEVC makes up what it lacks there.
#[test]
fn frames_are_true_wherever_reading_begins() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let open = "-c:v libx264 -g 12 -bf 3 -x264-params open_gop=1:b-pyramid=2:scenecut=0";
    let hevc =
        "-c:v libx265 -preset ultrafast -x265-params log-level=none:keyint=60:min-keyint=60:scenecut=0:bframes=0";
    let cases: [(&str, &str, &[u64]); 2] =
        [("open.mp4", open, &[1, 23, 24, 25, 47, 59, 60, 61, 73]), ("hevc.ts", hevc, &[55, 84, 110])];
    for (name, arguments, starts) in cases {
        let path = folder.path().join(name);
        run(&format!("{} {arguments}", moving(128, 64, "25", 120)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        for first in starts.iter().copied() {
            let some = frames(&ffmpeg, &path, of(first, first + 5)).unwrap();
            assert!(some == whole[first as usize..=first as usize + 5], "{name}, {first}");
        }
    }
}

/// The second and the fourth trap: the file ends early, and with it, silently, the video.
#[test]
fn a_cut_file_is_refused_and_its_missing_frames_are_named() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, arguments) in [
        ("a.mkv", "-c:v ffv1 -g 1"),
        ("b.mp4", "-c:v libx264 -g 10 -movflags +faststart"),
        ("c.avi", "-c:v mjpeg -pix_fmt yuvj420p"),
        ("d.webm", "-c:v libvpx-vp9 -g 10"),
        ("h.flv", "-c:v libx264 -bf 0 -g 10"),
        // Sound that begins before the first frame and ends after the last.
        ("e.mkv", "-f lavfi -i sine=duration=3 -c:v libx264 -bf 0 -g 10 -c:a aac"),
        ("f.mkv", "-f lavfi -i sine=duration=3 -c:v libx264 -g 10 -c:a aac"),
        // A rate that varies: times are listed as far as frames are there.
        (
            "g.mp4",
            "-vf settb=1/1000,setpts=N*40+mod(N\\,3)*10 -vsync passthrough -enc_time_base 1:1000 -c:v libx264 -bf 0 -g 10 -movflags +faststart",
        ),
    ] {
        let path = folder.path().join(name);
        run(&format!("{} {arguments}", moving(128, 64, "25", 50)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        // Where frames are coded in another order, one before the last that is left is missing.
        cut(&path, if name == "f.mkv" { 0.45 } else { 0.6 });
        let info = ffmpeg.probe(&path).unwrap();
        assert!(info.cut.is_some(), "{name}");
        let is_told = info.announced.is_some_and(|announced| announced.frames == 50);
        assert!(is_told || !name.ends_with(".mkv"), "{name}: {:?}", info.announced);
        let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
        assert!(matches!(error, VideoError::Cut { .. }), "{name}: {error}");
        assert!(error.to_string().contains("--damaged"), "{name}: {error}");
        // Frames before the cut can be had, those behind it are named.
        assert!(frames(&ffmpeg, &path, of(0, 9)).unwrap() == whole[..10], "{name}");
        let error = frames(&ffmpeg, &path, of(0, 49)).unwrap_err();
        let is_named = matches!(error, VideoError::DamagedFrame { .. } | VideoError::FewerFrames { announced: 50, .. });
        assert!(is_named && error.to_string().contains("frame"), "{name}: {error}");
        let skipped = frames(&ffmpeg, &path, with(Damaged::Skip)).unwrap();
        assert!((10..50).contains(&skipped.len()), "{name}: {}", skipped.len());
        let same = skipped.iter().zip(&whole).take_while(|(a, b)| difference(&a.image, &b.image) == 0.0).count();
        assert!(same + 1 >= skipped.len(), "{name}: {same} of {}", skipped.len());
        if info.announced.is_some() {
            let held = frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap();
            assert_eq!(held.len(), 50, "{name}");
            assert_eq!(held[49].condition, FrameCondition::Held, "{name}");
        }
    }
}

/// However little is left of a film, it tells how many frames there were.
#[test]
fn what_is_left_does_not_change_what_was_announced() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mkv");
    run(&format!("{} -f lavfi -i sine=duration=3 -c:v libx264 -bf 0 -g 10 -c:a aac", moving(128, 64, "25", 50)), &path);
    for part in [0.9, 0.8, 0.7, 0.6, 0.5] {
        cut(&path, part);
        let announced = ffmpeg.probe(&path).unwrap().announced.expect("a number of frames");
        assert_eq!(announced.frames, 50, "{} bytes", std::fs::metadata(&path).unwrap().len());
    }
    // Of few frames ffprobe tells no beginning, or guesses one. That of the sound is before it, by more than a frame.
    run(&format!("{} -f lavfi -i sine=duration=3 -c:v libx264 -g 10 -c:a aac", moving(128, 64, "60", 120)), &path);
    let bytes = std::fs::read(&path).unwrap();
    for frame in 0..6 {
        let (place, size) = packet(&path, frame);
        std::fs::write(&path, &bytes[..place + size + 20]).unwrap();
        let announced = ffmpeg.probe(&path).unwrap().announced.expect("a number of frames");
        assert_eq!(announced.frames, 120, "frame {frame}");
        std::fs::write(&path, &bytes).unwrap();
    }
    // Without a picture, nothing tells what its pixels are.
    cut(&path, 0.03);
    let error = ffmpeg.probe(&path).unwrap_err();
    assert!(matches!(error, VideoError::Cut { is_described: false, .. }), "{error}");
}

/// A file whose description is behind the cut.
#[test]
fn a_file_without_its_end_is_called_cut() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    run(&format!("{} -c:v libx264", moving(128, 64, "25", 50)), &path);
    cut(&path, 0.5);
    let error = ffmpeg.probe(&path).unwrap_err();
    assert!(matches!(error, VideoError::Cut { .. }), "{error}");
    // Nothing of it can be had.
    assert!(!error.to_string().contains("--damaged"), "{error}");
    // Those that count no frames then.
    for (name, size, codec) in [
        ("b.wmv", (128, 64), "-c:v wmv2 -g 10"),
        ("c.ogv", (128, 64), "-c:v libtheora -q:v 9 -g 10"),
        ("d.nut", (128, 64), "-c:v ffv1 -g 1"),
        ("e.dv", (720, 576), "-pix_fmt yuv420p"),
    ] {
        let path = folder.path().join(name);
        run(&format!("{} {codec}", moving(size.0, size.1, "25", 50)), &path);
        assert_eq!(frames(&ffmpeg, &path, ReadOptions::default()).unwrap().len(), 50, "{name}");
        cut(&path, 0.609);
        let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err();
        assert!(matches!(error, VideoError::Cut { .. }) && error.to_string().contains("--damaged"), "{name}: {error}");
        assert!((10..50).contains(&frames(&ffmpeg, &path, with(Damaged::Skip)).unwrap().len()), "{name}");
    }
    // One that counts them, to the one that is cut.
    let path = folder.path().join("f.gif");
    run(&moving(128, 64, "25", 50), &path);
    cut(&path, 0.5);
    let held = frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap();
    assert!(held.len() > 10 && held.last().unwrap().condition == FrameCondition::Held, "{}", held.len());
}

/// The third trap, of a count: fewer frames than the file announces, though its end is there.
#[test]
fn fewer_frames_than_announced_are_an_error() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mov");
    run(&format!("{} -c:v png", moving(128, 64, "25", 50)), &path);
    for number in 40..50 {
        damage(&path, number);
    }
    let told = |ffmpeg: &Ffmpeg| frames(ffmpeg, &path, ReadOptions::default()).unwrap_err().to_string();
    assert!(told(&ffmpeg).contains("frame 40"), "{}", told(&ffmpeg));
    assert_eq!(frames(&ffmpeg, &path, with(Damaged::Skip)).unwrap().len(), 40);
    assert_eq!(frames(&ffmpeg, &path, with(Damaged::Hold)).unwrap().len(), 50);
}

/// A frame that is there for others alone is not missed: a video that was cut without coding it anew.
#[test]
fn a_video_cut_without_coding_is_whole() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (long, path) = (folder.path().join("long.mp4"), folder.path().join("short.mp4"));
    run(&format!("{} -c:v libx264 -g 25 -bf 0", moving(128, 64, "25", 100)), &long);
    run(&format!("-ss 1.4 -i {} -c copy", long.to_str().unwrap()), &path);
    let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    assert!(found.windows(2).all(|pair| pair[1].index == pair[0].index + 1));
    assert!((60..=65).contains(&found.len()), "{}", found.len());
}

/// Recordings begin at key frames, before whose open group some frames are lost without a word, as players do.
#[test]
fn what_begins_at_a_key_frame_is_whole() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let hevc =
        "-c:v libx265 -preset ultrafast -x265-params log-level=none:keyint=25:min-keyint=25:bframes=2:scenecut=0";
    // In c.ts, frames that are shown before a key frame take after that alone.
    let radl = format!("{}:open-gop=0:radl=2:bframes=3", hevc.replace(":bframes=2", ""));
    let mpeg = "-c:v mpeg2video -bf 2 -g 25 -sc_threshold 1000000000";
    for (name, coding, count) in [("a.ts", mpeg, 23..26), ("b.ts", hevc, 23..26), ("c.ts", &*radl, 27..28)] {
        let path = folder.path().join(name);
        run(&format!("{} {coding}", moving(128, 64, "25", 75)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let lines = probed(&path, "-select_streams v:0 -show_entries packet=flags -of csv=p=0");
        let is_key = |line: &str| line.starts_with('K');
        let lines: Vec<&str> = lines.lines().filter(|line| !line.is_empty()).collect();
        let (key, _) = lines.iter().enumerate().filter(|(_, line)| is_key(line)).nth(2).unwrap();
        let (place, _) = packet(&path, key);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[place..]).unwrap();
        let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        assert!(count.contains(&found.len()), "{name}: {}", found.len());
        let first = whole.len() - found.len();
        let same = found.iter().zip(&whole[first..]).all(|(part, whole)| part.image == whole.image);
        assert!(same, "{name}");
    }
}

/// A recording that was cut out begins with frames that take after others before it.
#[test]
fn what_begins_between_key_frames_is_damaged_up_to_the_first() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let hevc =
        "-c:v libx265 -preset ultrafast -x265-params log-level=none:keyint=25:min-keyint=25:bframes=2:scenecut=0";
    for (name, coding, key) in [
        ("a.ts", "-c:v libx264 -bf 2 -g 25 -x264-params scenecut=0", 25),
        ("b.ts", "-c:v mpeg2video -bf 2 -g 25 -sc_threshold 1000000000", 27),
        ("c.ts", hevc, 25),
    ] {
        let path = folder.path().join(name);
        run(&format!("{} {coding}", moving(128, 64, "25", 75)), &path);
        let whole = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let (place, _) = packet(&path, 10);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[place..]).unwrap();
        let info = ffmpeg.probe(&path).unwrap();
        let mut reader = VideoReader::open(&ffmpeg, &info, with(Damaged::Hold)).unwrap();
        let mut found = Vec::new();
        while let Some(frame) = reader.next_frame().unwrap() {
            found.push(frame);
        }
        let lost = whole.len() - found.len();
        assert!((8..=12).contains(&lost), "{name}: {lost}");
        let numbers: Vec<u64> = found.iter().map(|frame| frame.index).collect();
        assert_eq!(numbers, (0..found.len() as u64).collect::<Vec<_>>(), "{name}");
        for frame in &found {
            let number = frame.index as usize + lost;
            let is_whole = frame.condition == FrameCondition::Whole;
            assert_eq!(is_whole, number >= key, "{name}: frame {number}");
            assert!(!is_whole || frame.image == whole[number].image, "{name}: frame {number}");
        }
        let damaged: Vec<_> = reader.faults().iter().map(|fault| fault.frame..fault.frame + fault.count).collect();
        assert_eq!(ffmpeg.coded_order(&info).unwrap().unwrap().traces(&damaged), [0; 0], "{name}");
        let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("frame 0") && error.contains("cut out between key frames"), "{name}: {error}");
        assert!(frames(&ffmpeg, &path, of(20, 40)).unwrap() == found[20..=40], "{name}");
    }
}
