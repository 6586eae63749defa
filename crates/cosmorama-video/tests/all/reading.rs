//! Frames by their numbers.

use cosmorama::raster::{Channels, Depth, Samples};
use cosmorama_video::{AnnouncedBy, FrameCondition, ReadOptions, StreamKind, VideoError, VideoFrame, VideoReader};

use crate::common::{ffmpeg, frames, moving, of, probed, raw, run};

#[test]
fn properties_are_read() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    let sound = "-f lavfi -i sine=duration=1";
    run(&format!("{} {sound} -c:v libx264 -c:a aac -metadata title=Sky", moving(64, 32, "30000/1001", 30)), &path);
    let info = ffmpeg.probe(&path).unwrap();
    assert_eq!((info.size(), info.codec.as_str(), info.bits, info.has_alpha), ((64, 32), "h264", 8, false));
    assert_eq!((info.rate.to_string(), info.is_variable), ("30000/1001".to_owned(), false));
    let announced = info.announced.unwrap();
    assert_eq!((announced.frames, announced.by), (30, AnnouncedBy::Count));
    assert_eq!(
        info.others.iter().map(|other| (other.kind, other.codec.as_str())).collect::<Vec<_>>(),
        [(StreamKind::Audio, "aac")]
    );
    assert!(info.metadata.contains(&("title".to_owned(), "Sky".to_owned())), "{:?}", info.metadata);
    assert!(info.notes.iter().any(|note| note.contains("no matrix")), "{:?}", info.notes);
    assert_eq!((info.cut, info.spatial), (None, None));
}

/// In a film that was cut out, sound may begin seconds before the pictures, whose first one must be a key frame.
#[test]
fn pictures_may_begin_long_after_the_sound() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (container, codec) in [("mkv", "libx264"), ("mp4", "libx264"), ("ts", "libx264"), ("mkv", "mpeg2video")] {
        let [film, cut] = ["film", "cut"].map(|name| folder.path().join(name).with_extension(container));
        let sound = "-f lavfi -i sine=duration=12";
        run(&format!("{} {sound} -c:v {codec} -g 250 -bf 0 -c:a mp2", moving(64, 32, "25", 300)), &film);
        run(&format!("-i {} -ss 1 -c copy", film.display()), &cut);
        let (whole, found) =
            (frames(&ffmpeg, &film, ReadOptions::default()), frames(&ffmpeg, &cut, ReadOptions::default()));
        let (whole, found) = (whole.unwrap(), found.unwrap());
        assert_eq!(found.len(), 50, "{container}, {codec}");
        let pairs = whole[250..].iter().zip(&found);
        assert!(pairs.into_iter().all(|(a, b)| a.image.samples() == b.image.samples()), "{container}, {codec}");
    }
}

/// Theora repeats a frame by a packet without a byte, which ffmpeg passes over.
#[test]
fn frames_that_theora_repeats_are_no_damage() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ogv");
    run("-f lavfi -i color=gray:s=64x32:r=25:d=2 -c:v libtheora -g 12", &path);
    let info = ffmpeg.probe(&path).unwrap();
    let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    assert!(info.is_variable && (2..50).contains(&found.len()), "{}", found.len());
    assert!(found.iter().all(|frame| frame.condition == FrameCondition::Whole));
    let seconds = found.last().unwrap().time as f64 * info.time_base.to_f64();
    assert!((1.0..2.0).contains(&seconds), "{seconds}");
}

/// RGB through FFV1 is equal, by both ways of ffmpeg to it.
#[test]
fn what_is_stored_without_loss_comes_without_loss() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (format, as_raw, channels, depth) in [
        ("bgr0", "rgb24", Channels::Rgb, Depth::Eight),
        ("bgra", "rgba", Channels::Rgba, Depth::Eight),
        ("gbrp16le", "rgb48le", Channels::Rgb, Depth::Sixteen),
        ("gbrap16le", "rgba64le", Channels::Rgba, Depth::Sixteen),
        ("gbrp10le", "rgb48le", Channels::Rgb, Depth::Sixteen),
    ] {
        let path = folder.path().join(format!("{format}.mkv"));
        run(&format!("{} -c:v ffv1 -pix_fmt {format}", moving(46, 34, "25", 4)), &path);
        let expected = raw(&path, as_raw);
        let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        assert_eq!(found.len(), 4);
        let mut bytes = Vec::new();
        for frame in &found {
            assert_eq!((frame.image.channels(), frame.image.depth()), (channels, depth), "{format}");
            match frame.image.samples() {
                Samples::U8(samples) => bytes.extend(samples),
                Samples::U16(samples) => bytes.extend(samples.iter().flat_map(|sample| sample.to_le_bytes())),
                _ => panic!("floats"),
            }
        }
        assert!(bytes == expected, "{format}");
    }
}

/// Ten bits become sixteen by repetition of the upper bits: black stays black, and white white.
#[test]
fn ten_bits_are_scaled_exactly() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (input, path) = (folder.path().join("codes.raw"), folder.path().join("codes.mkv"));
    let codes: Vec<u16> = (0..1024).collect();
    let bytes: Vec<u8> = codes.iter().cycle().take(3 * 1024).flat_map(|code| code.to_le_bytes()).collect();
    std::fs::write(&input, bytes).unwrap();
    let source = format!("-f rawvideo -pix_fmt gbrp10le -s 32x32 -i {}", input.to_str().unwrap());
    run(&format!("{source} -c:v ffv1"), &path);
    let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    let Samples::U16(samples) = found[0].image.samples() else { panic!("16 bits") };
    for (code, pixel) in codes.iter().zip(samples.chunks(3)) {
        assert_eq!(pixel, [code << 6 | code >> 4; 3], "{code}");
    }
}

#[test]
fn ranges_are_exact() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    // B-frames, key frames far apart, open groups; a clock that does not fit the rate; sound that begins before.
    for (name, arguments) in [
        ("a.mp4", "-c:v libx264 -g 40 -bf 3"),
        ("b.mkv", "-c:v libx264 -g 90 -bf 2 -x264-params open-gop=1"),
        ("c.mkv", "-c:v ffv1 -g 1"),
        ("d.ts", "-c:v libx264 -g 50 -bf 2"),
        ("e.avi", "-c:v mjpeg -q:v 2"),
    ] {
        let path = folder.path().join(name);
        run(&format!("{} {arguments} -pix_fmt yuvj420p -threads 2", moving(64, 32, "30000/1001", 200)), &path);
        let all = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        assert_eq!(all.iter().map(|frame| frame.index).collect::<Vec<_>>(), (0..200).collect::<Vec<_>>(), "{name}");
        assert!(all.windows(2).all(|pair| pair[0].time < pair[1].time), "{name}");
        for (first, last) in [(0, 0), (7, 13), (49, 51), (61, 63), (120, 122), (198, 199)] {
            let part = frames(&ffmpeg, &path, of(first, last)).unwrap();
            assert!(part == all[first as usize..=last as usize], "{name} {first} to {last}");
        }
    }
}

/// Containers that tell no times of their frames, or only those at which they are decoded, and AVI, which leaves places empty. There the
/// frame before is shown on: an encoder of sound that begins early is enough for that.
#[test]
fn every_frame_is_read_whatever_its_container_tells() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, arguments, empty) in [
        ("a.avi", "SOUND -c:v mpeg4 -g 12 -bf 0 -c:a libmp3lame", 1),
        ("b.avi", "SOUND -c:v libx264 -bf 0 -c:a libmp3lame", 1),
        ("c.avi", "SOUND -c:v libx264 -bf 2 -c:a libmp3lame", 0),
        ("d.avi", "SOUND -c:v mpeg4 -bf 2 -c:a libmp3lame", 0),
        ("e.wmv", "-c:v libx264 -bf 2", 0),
        ("f.h264", "-c:v libx264 -bf 2", 0),
        ("g.m2v", "-c:v mpeg2video -bf 2", 0),
        ("l.m1v", "-c:v mpeg1video -bf 2", 0),
        ("m.m1v", "-c:v mpeg1video -bf 0", 0),
        ("h.m2p", "-c:v mpeg2video -bf 2 -f mpeg", 0),
        ("i.avi", "-c:v mpeg1video", 0),
        ("j.flv", "-c:v libx264 -bf 2", 0),
        // Sound that ends after the last frame.
        ("k.wmv", "-f lavfi -i sine=duration=6 -c:v wmv2 -c:a wmav2", 0),
    ] {
        let path = folder.path().join(name);
        let arguments = arguments.replace("SOUND", "-f lavfi -i sine=duration=4");
        run(&format!("{} {arguments} -threads 2", moving(64, 32, "25", 100)), &path);
        let all = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let numbers: Vec<u64> = all.iter().map(|frame| frame.index).collect();
        assert_eq!(numbers, (0..100 + empty).collect::<Vec<_>>(), "{name}");
        assert!(all.iter().all(|frame| frame.condition == FrameCondition::Whole), "{name}");
        assert!(empty == 0 || all[1].image == all[0].image, "{name}");
        for (first, last) in [(0, 1), (1, 3), (20, 21), (60, 62), (97, 99)] {
            let part = frames(&ffmpeg, &path, of(first, last)).unwrap();
            assert!(part == all[first as usize..=last as usize], "{name} {first} to {last}");
        }
    }
}

/// Behind a cut without coding anew, frames of open groups come that took after others: no player shows them, and whatever the container tells,
/// the film begins behind them.
#[test]
fn films_that_were_cut_out_begin_with_the_first_frame_that_can_be_decoded() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let x264 = "-c:v libx264 -bf 3 -x264-params open-gop=1:keyint=12:min-keyint=12:scenecut=0:b-pyramid=strict";
    let x265 = "-c:v libx265 -bf 3 -x265-params open-gop=1:keyint=12:min-keyint=12:scenecut=0:log-level=error";
    let mpeg = "-bf 2 -g 12 -sc_threshold 1000000000 -c:v";
    for (codec, arguments, source, cuts) in [
        ("h264", x264, "mp4", &["mp4", "mkv", "avi"][..]),
        ("hevc", x265, "mp4", &["mp4", "mkv", "avi", "ts"]),
        ("mpeg2", &format!("{mpeg} mpeg2video"), "mkv", &["mkv", "avi", "ts"]),
        ("mpeg4", &format!("{mpeg} mpeg4"), "mp4", &["mkv", "avi", "mov"]),
        ("mpeg4", &format!("{mpeg} mpeg4"), "avi", &["avi"]),
    ] {
        let film = folder.path().join(format!("{codec}.{source}"));
        run(&format!("{} {arguments} -threads 2", moving(64, 32, "25", 100)), &film);
        let all = frames(&ffmpeg, &film, ReadOptions::default()).unwrap();
        for container in cuts {
            let cut = folder.path().join(format!("{codec}-{source}.{container}"));
            // As ffmpeg copies it from a film by mkvmerge.
            let count = "-metadata:s:v NUMBER_OF_FRAMES=100 -metadata:s:v _STATISTICS_WRITING_APP=mkvmerge";
            run(&format!("-i {} -ss 0.5 -c copy {count}", film.display()), &cut);
            let name = format!("{codec} from {source} in {container}");
            let info = ffmpeg.probe(&cut).unwrap();
            // MP4 and MOV tell themselves that they are not to be shown.
            assert_eq!(info.left_out > 0, !["mp4", "mov"].contains(container), "{name}: {}", info.left_out);
            let left = frames(&ffmpeg, &cut, ReadOptions::default()).unwrap();
            assert!(left.len() > 60 && left.len() < 88, "{name}: {}", left.len());
            let pictures = left.iter().zip(&all[100 - left.len()..]);
            assert!(pictures.clone().all(|(left, all)| left.image == all.image), "{name}");
            assert!(left.iter().all(|frame| frame.condition == FrameCondition::Whole), "{name}");
            let last = left.len() as u64 - 1;
            for (first, last) in [(0, 1), (20, 21), (55, 57), (last - 1, last)] {
                let part = frames(&ffmpeg, &cut, of(first, last)).unwrap();
                assert!(part == left[first as usize..=last as usize], "{name} {first} to {last}");
            }
        }
    }
}

/// A film that was cut out ends where its coded frames do: some that would be shown before the last are not in it, and the frame before them
/// is shown on, as in players.
#[test]
fn films_that_were_cut_out_end_with_their_last_frame() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("a.mp4");
    run(&format!("{} -c:v libx264 -bf 3 -threads 2", moving(256, 128, "25", 100)), &film);
    let all = frames(&ffmpeg, &film, ReadOptions::default()).unwrap();
    let mut lacking = 0;
    for (container, seconds) in [("mp4", "1.3"), ("mkv", "1.3"), ("ts", "1.3"), ("mp4", "2.1"), ("mkv", "2.1")] {
        let cut = folder.path().join(format!("b.{container}"));
        run(&format!("-i {} -t {seconds} -c copy", film.display()), &cut);
        let packets = probed(&cut, "-select_streams v -show_entries packet=pts -of csv=p=0");
        let coded = packets.lines().filter(|line| !line.is_empty()).count();
        let left = frames(&ffmpeg, &cut, ReadOptions::default()).unwrap();
        let told = ffmpeg.probe(&cut).unwrap().announced.filter(|told| told.by == AnnouncedBy::Count);
        assert!(told.is_none_or(|told| told.frames == left.len() as u64), "{container}: {told:?}");
        lacking += left.len() - coded;
        let (mut shown, mut originals) = (0, all.iter());
        for frame in &left {
            let is_repeated = frame.index > 0 && frame.image == left[frame.index as usize - 1].image;
            let is_next = is_repeated || originals.any(|original| original.image == frame.image);
            assert!(is_next, "{container} {seconds} {}", frame.index);
            assert_eq!(frame.condition, FrameCondition::Whole);
            shown += usize::from(!is_repeated);
        }
        assert_eq!(shown, coded, "{container} {seconds}");
        let last = left.len() as u64 - 1;
        for (first, last) in [(0, 1), (last - 4, last), (last - 2, last - 1), (last, last)] {
            let part = frames(&ffmpeg, &cut, of(first, last)).unwrap();
            assert!(part == left[first as usize..=last as usize], "{container} {seconds} {first} to {last}");
        }
    }
    assert!(lacking > 0, "none is lacking anywhere");
}

/// An MP4 that hides its first frames and lacks some at its end has a rate that varies, and counts the hidden ones.
#[test]
fn a_film_that_hides_and_lacks_frames_has_those_that_it_shows() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (film, cut) = (folder.path().join("a.mkv"), folder.path().join("b.mp4"));
    run(&format!("{} -c:v libx264 -bf 3 -b_strategy 0 -g 25 -threads 2", moving(64, 32, "30000/1001", 150)), &film);
    run(&format!("-ss 0.1 -i {} -t 2.10 -c copy", film.display()), &cut);
    let shown = probed(&cut, "-select_streams v -show_entries frame=pts -of csv=p=0").lines().count();
    let info = ffmpeg.probe(&cut).unwrap();
    assert_eq!(info.announced.map(|told| told.frames), Some(shown as u64));
    let left = frames(&ffmpeg, &cut, ReadOptions::default()).unwrap();
    assert!(left.len() == shown && left.iter().all(|frame| frame.condition == FrameCondition::Whole), "{}", left.len());
}

/// Behind a key frame of an open group that none comes before, H.264 names frames that were cut off, and takes after none of them.
#[test]
fn films_that_begin_with_an_open_group_are_whole() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("a.mkv");
    let x264 = "-c:v libx264 -bf 3 -b_strategy 0 -x264-params open-gop=1:keyint=21:min-keyint=21:scenecut=0";
    run(&format!("{} {x264} -threads 2", moving(160, 80, "25", 100)), &film);
    let all = frames(&ffmpeg, &film, ReadOptions::default()).unwrap();
    for container in ["mkv", "mp4", "flv"] {
        let cut = folder.path().join(format!("b.{container}"));
        run(&format!("-ss 1.1 -to 2.1 -i {} -c copy", film.display()), &cut);
        let left = frames(&ffmpeg, &cut, ReadOptions::default()).unwrap();
        assert!(left.iter().all(|frame| frame.condition == FrameCondition::Whole), "{container}");
        let mut originals = all.iter();
        let mut is_next = |frame: &VideoFrame| originals.any(|original| original.image == frame.image);
        let is_repeated = |at: usize| at > 0 && left[at].image == left[at - 1].image;
        assert!((0..left.len()).all(|at| is_repeated(at) || is_next(&left[at])), "{container}");
        // It begins with frame 21, or 28 where the edit list leaves out what is not asked for.
        assert!(left.len() >= 25 && (left[0].image == all[21].image || left[0].image == all[28].image), "{container}");
        let part = frames(&ffmpeg, &cut, of(18, 20)).unwrap();
        assert!(part == left[18..=20], "{container}");
    }
}

/// The end of a film that was cut out lacks the last of its coded frames, and no others.
#[test]
fn a_frame_that_is_lost_near_the_end_is_no_cut() {
    let Some(ffmpeg) = ffmpeg().filter(|ffmpeg| ffmpeg.version().major >= 5) else { return };
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("a.mkv");
    for (rate, number, expected) in [("25", 146, 146), ("1", 112, 111)] {
        run(&format!("{} -c:v libx264 -bf 3 -b_strategy 0 -g 60 -threads 2", moving(64, 32, rate, 149)), &film);
        for container in ["mkv", "flv"] {
            let lost = folder.path().join(format!("b.{container}"));
            run(&format!("-i {} -c copy -bsf:v noise=drop=eq(n\\,{number})", film.display()), &lost);
            let read = frames(&ffmpeg, &lost, ReadOptions::default()).map(|frames| frames.len());
            let is_told = matches!(read, Err(VideoError::DamagedFrame { frame, .. }) if frame == expected);
            assert!(is_told, "{container} {rate}: {read:?}");
        }
    }
}

/// Other programs write no tag of the stream's duration into Matroska: that of the file begins before the first frame.
#[test]
fn a_cut_matroska_without_tags_has_no_more_frames() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (film, cut) = (folder.path().join("a.mkv"), folder.path().join("b.mkv"));
    run(&format!("{} -c:v mpeg4 -bf 2 -g 12 -sc_threshold 1000000000", moving(64, 32, "25", 100)), &film);
    run(&format!("-i {} -ss 0.5 -c copy -write_crc32 0", film.display()), &cut);
    let mut bytes = std::fs::read(&cut).unwrap();
    let at = bytes.windows(8).position(|name| name == b"DURATION").unwrap();
    bytes[at..at + 8].copy_from_slice(b"ANYTHING");
    std::fs::write(&cut, bytes).unwrap();
    let info = ffmpeg.probe(&cut).unwrap();
    let left = frames(&ffmpeg, &cut, ReadOptions::default()).unwrap().len() as u64;
    assert_eq!((info.announced.map(|told| told.frames), left < 88), (Some(left), true));
}

/// Where its key frame is damaged, a film that was cut out does not begin with a later one.
#[test]
fn a_damaged_key_frame_is_no_cut() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let x264 = "-c:v libx264 -bf 3 -x264-params open-gop=1:keyint=12:min-keyint=12:scenecut=0";
    let (film, cut) = (folder.path().join("a.mp4"), folder.path().join("b"));
    run(&format!("{} {x264}", moving(256, 128, "25", 50)), &film);
    // The edit list of an MP4 that is cut before its name is given leaves out the key frame itself.
    for (container, is_hidden) in [("mp4", false), ("mkv", false), ("avi", false), ("mp4", true), ("mkv", true)] {
        let cut = cut.with_extension(container);
        let film = film.display();
        let from = if is_hidden { format!("-ss 0.6 -i {film}") } else { format!("-i {film} -ss 0.5") };
        run(&format!("{from} -c copy"), &cut);
        let told = probed(&cut, "-show_entries packet=pos,size -of csv=p=0");
        let mut numbers = told.lines().next().unwrap().split(',').map(|number| number.parse::<usize>().unwrap());
        let (size, at) = (numbers.next().unwrap(), numbers.next().unwrap());
        let whole = std::fs::read(&cut).unwrap();
        // Behind its mark and the first words of its first part, or in its middle.
        for damaged in [at + 16..at + size, at + size / 2..at + size / 2 + 200] {
            let mut bytes = whole.clone();
            bytes[damaged].fill(0);
            std::fs::write(&cut, bytes).unwrap();
            let read = frames(&ffmpeg, &cut, ReadOptions::default()).map(|frames| frames.len());
            let is_told = matches!(read, Err(VideoError::DamagedFrame { frame: 0, .. }));
            assert!(is_told, "{container} {is_hidden}: {read:?}");
        }
    }
}

#[test]
fn frames_that_are_not_there_are_named() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    run(&format!("{} -c:v libx264", moving(64, 32, "25", 50)), &path);
    for (first, last, asked) in [(50, 60, 50), (0, 50, 50), (49, 70, 70)] {
        let error = frames(&ffmpeg, &path, of(first, last)).unwrap_err();
        assert!(matches!(error, VideoError::NoSuchFrame { asked: found, last: 49, .. } if found == asked), "{error}");
    }
}

/// A rate that varies: each frame has its own time, and its own number.
#[test]
fn times_are_kept_where_the_rate_varies() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, tick) in [("a.mp4", 90_000), ("b.mkv", 1000)] {
        let path = folder.path().join(name);
        // Frame N at N² · 20 ms.
        let source = "-f lavfi -i testsrc2=size=64x32:rate=50 -frames:v 30 -vf settb=1/1000,setpts=N*N*20";
        let vary = "-vsync passthrough -enc_time_base 1:1000 -c:v libx264 -bf 2 -video_track_timescale 90000";
        run(
            &format!(
                "{source} {}",
                if name == "a.mp4" { vary.to_owned() } else { vary.replace(" -video_track_timescale 90000", "") }
            ),
            &path,
        );
        let info = ffmpeg.probe(&path).unwrap();
        assert!(info.is_variable, "{name}: {info:?}");
        let all = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let first = all[0].time;
        let times: Vec<i64> = all.iter().map(|frame| frame.time - first).collect();
        assert_eq!(times, (0..30).map(|n| n * n * 20 * tick / 1000).collect::<Vec<_>>(), "{name}");
        assert_eq!(ffmpeg.timeline(&info).unwrap().frame_at(0.5), 5, "{name}");
        for (first, last) in [(0, 2), (3, 4), (20, 29)] {
            assert!(frames(&ffmpeg, &path, of(first, last)).unwrap() == all[first as usize..=last as usize], "{name}");
        }
    }
}

#[test]
fn a_frame_larger_than_permitted_is_refused_before_it_is_decoded() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mkv");
    run(&format!("{} -c:v ffv1 -pix_fmt yuv420p10le", moving(64, 32, "25", 2)), &path);
    let info = ffmpeg.probe(&path).unwrap();
    let options = |memory| ReadOptions { memory, ..ReadOptions::default() };
    // Planes, and the picture that is made of them.
    let needed = 64 * 32 * (3 + 3) * 2;
    let error = VideoReader::open(&ffmpeg, &info, options(needed - 1)).unwrap_err().to_string();
    assert!(error.contains("24576 bytes") && error.contains("64x32"), "{error}");
    assert!(VideoReader::open(&ffmpeg, &info, options(needed)).is_ok());
}

#[test]
fn interlaced_frames_are_refused() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mkv");
    run(&format!("{} -vf setfield=tff -c:v ffv1 -field_order tt -flags +ildct", moving(64, 32, "25", 2)), &path);
    let error = frames(&ffmpeg, &path, ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("interlaced") && error.contains("bwdif"), "{error}");
}

/// A reader that is dropped leaves no process behind.
#[cfg(target_os = "linux")]
#[test]
fn a_reader_that_is_dropped_ends_its_ffmpeg() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dropped-reader.mkv");
    run(&format!("{} -c:v ffv1", moving(640, 320, "25", 100)), &path);
    let mut reader = VideoReader::open(&ffmpeg, &ffmpeg.probe(&path).unwrap(), ReadOptions::default()).unwrap();
    reader.next_frame().unwrap().unwrap();
    let running = || crate::hostile::processes_with(path.to_str().unwrap());
    assert_eq!(running(), 1);
    drop(reader);
    assert_eq!(running(), 0);
}
