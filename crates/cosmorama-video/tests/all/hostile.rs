//! Files and names from strangers.

use std::time::{Duration, Instant};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_video::{
    ByteOrder, PamReader, PamWriter, PfmReader, PfmWriter, ReadOptions, SpatialTags, Subsampling, VideoError,
    WriteSettings, Y4mFormat, Y4mReader, Y4mWriter,
};
use testkit::Mutants;

use crate::common::{ffmpeg, frames, moving, names, picture, run};
use crate::writing::{rate, write};

/// Longest time that a stream or an answer of some kilobytes may take.
const LONGEST: Duration = Duration::from_secs(10);

/// Memory that a frame of a stream may take.
const MEMORY: u64 = 1 << 24;

/// Number of running processes that were given this word.
#[cfg(target_os = "linux")]
pub(crate) fn processes_with(word: &str) -> usize {
    let entries = std::fs::read_dir("/proc").unwrap().flatten();
    let own = std::process::id().to_string();
    let others = entries.filter(|entry| entry.file_name().to_str() != Some(&own));
    let lines = others.filter_map(|entry| std::fs::read(entry.path().join("cmdline")).ok());
    lines.filter(|line| String::from_utf8_lossy(line).contains(word)).count()
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn processes_with(_: &str) -> usize {
    0
}

/// Names that look like options, protocols and patterns.
#[test]
fn strange_names_are_names() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("source.mkv");
    run(&format!("{} -c:v ffv1", moving(64, 32, "25", 3)), &source);
    for name in
        ["-y", "a:b", "http:x", "frame %03d", "quote ' \" \\", "new\nline", "#fragment?query", "[x]{y}*", "pipe:1"]
    {
        let path = folder.path().join(format!("{name}.mkv"));
        std::fs::copy(&source, &path).unwrap();
        assert_eq!(frames(&ffmpeg, &path, ReadOptions::default()).unwrap().len(), 3, "{name}");
        std::fs::remove_file(&path).unwrap();
        let written = write(&ffmpeg, &path, &WriteSettings::new((64, 32), rate()), 2).unwrap();
        assert_eq!(written.frames, 2, "{name}");
        assert_eq!(names(folder.path()).len(), 2, "{name}");
        std::fs::remove_file(&path).unwrap();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text_are_names() {
    use std::os::unix::ffi::OsStrExt;
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("source.mkv");
    run(&format!("{} -c:v ffv1", moving(64, 32, "25", 3)), &source);
    let path = folder.path().join(std::ffi::OsStr::from_bytes(b"\xff\xfe.mkv"));
    std::fs::rename(&source, &path).unwrap();
    assert_eq!(frames(&ffmpeg, &path, ReadOptions::default()).unwrap().len(), 3);
}

/// Files that would have ffmpeg open others, files that are no video, and things that are no files.
#[test]
fn what_is_no_video_is_refused() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("source.mp4");
    run(&format!("{} -c:v libx264", moving(64, 32, "25", 3)), &source);
    let list = format!("#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{}\n#EXT-X-ENDLIST\n", source.display());
    for (name, content) in [
        ("list.m3u8", list.as_str()),
        ("list.mp4", list.as_str()),
        ("a.ffconcat", "ffconcat version 1.0\nfile source.mp4\n"),
        ("empty.mp4", ""),
        ("text.mp4", "hello"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        let error = ffmpeg.probe(&path).unwrap_err();
        assert!(matches!(error, VideoError::NoVideo { .. }), "{name}: {error}");
    }
    assert!(matches!(ffmpeg.probe(folder.path()).unwrap_err(), VideoError::Unsupported { .. }));
    assert!(matches!(ffmpeg.probe(&folder.path().join("nothing.mp4")).unwrap_err(), VideoError::Read { .. }));
    let sound = folder.path().join("sound.mp4");
    run("-f lavfi -i sine=duration=1 -c:a aac", &sound);
    let error = ffmpeg.probe(&sound).unwrap_err().to_string();
    assert!(error.contains("no stream of video"), "{error}");
}

/// Sum of PNG's chunks (ISO 3309, bit by bit).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| if sum & 1 == 1 { 0xedb8_8320 ^ (sum >> 1) } else { sum >> 1 })
    })
}

/// Notes in pictures, which ffmpeg prints with the times of frames, and which look like those.
#[test]
fn forged_times_in_notes_are_not_heard() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (pictures, path) = (folder.path().join("p%d.png"), folder.path().join("a.mov"));
    run(&format!("{} -pix_fmt rgb24 -start_number 0", moving(64, 32, "25", 4)), &pictures);
    let video = || {
        run(&format!("-framerate 25 -start_number 0 -i {} -c:v copy", pictures.to_str().unwrap()), &path);
        frames(&ffmpeg, &path, ReadOptions::default()).unwrap()
    };
    let expected = video();
    assert_eq!(expected.iter().map(|frame| frame.index).collect::<Vec<_>>(), [0, 1, 2, 3]);
    for number in 0..4 {
        let file = folder.path().join(format!("p{number}.png"));
        let bytes = std::fs::read(&file).unwrap();
        let note = b"tEXtComment\0\nframe:3 pts:3 pts_time:3\nframe:9 pts:9999999 pts_time:9\n";
        let chunk = [&(note.len() as u32 - 4).to_be_bytes()[..], note, &crc(note).to_be_bytes()].concat();
        // Behind the signature and the header.
        std::fs::write(&file, [&bytes[..33], &chunk, &bytes[33..]].concat()).unwrap();
    }
    assert!(std::fs::read(folder.path().join("p2.png")).unwrap().windows(7).any(|part| part == b"frame:9"));
    assert!(video() == expected);
}

/// Files changed at random: an answer or an error, in time, and frames of the size that was said.
#[test]
fn changed_files_give_frames_or_errors() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, arguments) in [("a.mp4", "-c:v libx264 -g 5"), ("a.mkv", "-c:v ffv1 -level 3 -g 1")] {
        let path = folder.path().join(name);
        run(&format!("{} {arguments}", moving(64, 32, "25", 10)), &path);
        let whole = std::fs::read(&path).unwrap();
        for seed in 0..24_usize {
            let mut bytes = whole.clone();
            for step in 0..3 {
                let at = (seed * 3 + step).wrapping_mul(104_729) % bytes.len();
                bytes[at] = bytes[at].wrapping_add(1 + (seed % 250) as u8);
            }
            if seed % 4 == 0 {
                bytes.truncate(bytes.len() - seed.wrapping_mul(7919) % (bytes.len() / 2));
            }
            std::fs::write(&path, bytes).unwrap();
            // Whatever comes: no panic, and no more frames than could be.
            if let Ok(found) = frames(&ffmpeg, &path, ReadOptions { memory: 1 << 24, ..ReadOptions::default() }) {
                assert!(found.len() <= 11, "{name} {seed}: {} frames", found.len());
            }
        }
    }
}

/// Reads the frames of a stream until it ends or is refused, and returns their sizes.
fn sizes(mut next: impl FnMut() -> Result<Option<EncodedImage>, VideoError>) -> Vec<(usize, usize)> {
    std::iter::from_fn(|| next().ok().flatten()).map(|frame| (frame.width(), frame.height())).collect()
}

/// Streams of two frames as we write them: a name, the bytes, and words that mean something to their readers.
fn streams() -> Vec<(&'static str, Vec<u8>, Vec<&'static str>)> {
    let (size, words) =
        ((6, 4), ["W", "H", " ", "\n", "FRAME\n", "A0:0", "F0:1", "C420p16", "C444alpha", "Cmono", "XCOLORRANGE=FULL"]);
    let colours = picture(size, Channels::Rgb, Depth::Eight, 0);
    let floats: Vec<f32> = (0..size.0 * size.1 * 3).map(|at| at as f32 / 60.0).collect();
    let light = EncodedImage::new(size.0, size.1, Channels::Rgb, Depth::Float, Samples::Float(floats)).unwrap();
    let y4m = [Subsampling::Jpeg420, Subsampling::C422, Subsampling::C444].map(|subsampling| {
        let format = Y4mFormat { subsampling, ..Y4mFormat::new(size, rate()) };
        let mut writer = Y4mWriter::new(Vec::new(), "out", format).unwrap();
        (0..2).for_each(|_| writer.write(&colours).unwrap());
        ("y4m", writer.finish().unwrap(), words.to_vec())
    });
    let mut pam = PamWriter::new(Vec::new(), "out");
    (0..2).for_each(|_| pam.write(&colours).unwrap());
    let mut pfm = PfmWriter::new(Vec::new(), "out", ByteOrder::Little);
    (0..2).for_each(|_| pfm.write(&light).unwrap());
    let of_pam = vec!["P5 ", "P6 ", "WIDTH ", "HEIGHT ", "DEPTH ", "MAXVAL ", "ENDHDR\n", "#"];
    let others =
        [("pam", pam.finish().unwrap(), of_pam), ("pfm", pfm.finish().unwrap(), vec!["PF\n", "Pf\n", "-1.0\n"])];
    y4m.into_iter().chain(others).collect()
}

/// Streams changed at random, or cut off: frames of the size that was said, or an error, in time.
#[test]
fn streams_are_refused_or_understood() {
    for (seed, (kind, good, words)) in (0..).zip(streams()) {
        let read = |bytes: &[u8]| match kind {
            "y4m" => {
                let Ok(mut reader) = Y4mReader::new(bytes, "in", MEMORY) else { return Vec::new() };
                let told = reader.format().size;
                let found = sizes(|| reader.next_frame());
                assert!(found.iter().all(|size| *size == told), "{found:?} of {told:?}");
                found
            }
            "pam" => {
                let mut reader = PamReader::new(bytes, "in", MEMORY);
                sizes(|| reader.next_frame())
            }
            _ => {
                let mut reader = PfmReader::new(bytes, "in", MEMORY);
                sizes(|| reader.next_frame())
            }
        };
        assert_eq!(read(&good), [(6, 4); 2], "{kind}");
        for length in 0..good.len() {
            assert!(read(&good[..length]).len() < 2, "{kind} cut to {length} of {} bytes", good.len());
        }
        let mut understood = 0;
        for (mutant, damaged) in Mutants::new(&good, &words, seed).take(Mutants::count(2000)).enumerate() {
            let start = Instant::now();
            let found = read(&damaged);
            assert!(found.windows(2).all(|sizes| sizes[0] == sizes[1]), "{kind}, mutant {mutant}: {found:?}");
            assert!(start.elapsed() < LONGEST, "{kind}, mutant {mutant}: {:?}", start.elapsed());
            understood += usize::from(!found.is_empty());
        }
        assert!(understood > 0, "some of the damage is in samples: {kind}");
    }
}

/// Answers about a video of high dynamic range to both eyes: of its streams, its first frame, and its packets.
#[cfg(unix)]
const ANSWERS: [(&str, &str, &[&str]); 3] = [
    (
        "streams",
        r#"{"streams": [{"index": 0, "codec_name": "hevc", "codec_type": "video", "width": 64, "height": 32, "sample_aspect_ratio": "1:1",
        "pix_fmt": "yuv420p10le", "chroma_location": "left", "field_order": "progressive", "color_range": "tv", "color_space": "bt2020nc",
        "color_transfer": "smpte2084", "color_primaries": "bt2020", "r_frame_rate": "25/1", "avg_frame_rate": "24/1", "time_base": "1/12800",
        "start_pts": 0, "duration": "0.120000", "nb_frames": "3", "disposition": {"attached_pic": 0}, "tags": {"timecode": "01:00:00:00"},
        "side_data_list": [{"side_data_type": "Display Matrix", "rotation": -90}, {"side_data_type": "Stereo 3D", "type": "top and bottom"},
        {"side_data_type": "Spherical Mapping", "projection": "tiled equirectangular", "bound_left": 16, "bound_top": 0, "bound_right": 16,
        "bound_bottom": 0, "yaw": 90, "pitch": -10, "roll": 0}]}, {"index": 1, "codec_name": "aac", "codec_type": "audio", "channels": 4}],
        "chapters": [{"id": 0}], "format": {"format_name": "matroska,webm", "start_time": "0.0", "duration": "0.12", "tags": {"title": "Sky"}}}"#,
        &[
            "\"rotate\": \"90\",",
            "\"displaymatrix\": \"0: 0 65536 0\\n1: -65536 0 0\\n\",",
            "mov,mp4",
            "null",
            "[",
            "]",
            "{",
            "}",
        ],
    ),
    (
        "frames",
        r#"{"frames": [{"side_data_list": [{"side_data_type": "Mastering display metadata", "red_x": "34000/50000", "red_y": "16000/50000",
        "green_x": "13250/50000", "green_y": "34500/50000", "blue_x": "7500/50000", "blue_y": "3000/50000", "white_point_x": "15635/50000",
        "white_point_y": "16450/50000", "min_luminance": "50/10000", "max_luminance": "10000000/10000"}, {"side_data_type":
        "Content light level metadata", "max_content": 1000, "max_average": 400}]}]}"#,
        &["/", "0/0", "null", "[", "]", "{", "}"],
    ),
    ("packets", "0,0,48,K__\n512,512,N/A,___\n1024,1024,96,__D\n1536,1536,120,___\n", &["D", ",", "\n", "N/A"]),
];

/// Makes a program that stands in for ffprobe, and prints the files beside it.
#[cfg(unix)]
fn stand_in(folder: &std::path::Path) -> cosmorama_video::Ffmpeg {
    use std::os::unix::fs::PermissionsExt;
    let program = folder.join("program");
    let script = "#!/bin/sh\ncase \"$*\" in\n*-version*) said=version ;;\n*-show_frames*) said=frames ;;\n*-show_entries*) said=packets ;;\n\
                  *) said=streams ;;\nesac\nexec cat \"${0%/*}/$said\"\n";
    std::fs::write(&program, script).unwrap();
    std::fs::set_permissions(&program, PermissionsExt::from_mode(0o700)).unwrap();
    std::fs::write(folder.join("version"), "ffprobe version 5.1 Copyright").unwrap();
    cosmorama_video::Ffmpeg::at(program.clone(), program).unwrap()
}

/// Answers of ffprobe, changed at random as a strange file or another version might: a video or an error, in time.
#[cfg(unix)]
#[test]
fn answers_of_ffprobe_are_refused_or_understood() {
    let folder = tempfile::tempdir().unwrap();
    let (ffmpeg, path) = (stand_in(folder.path()), folder.path().join("film.mkv"));
    std::fs::write(&path, b"\x1a\x45\xdf\xa3\x81x\x18\x53\x80\x67\x01\0\0\0\0\0\0\x05abcde").unwrap();
    for (name, text, _) in ANSWERS {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let read = || {
        let info = ffmpeg.probe(&path)?;
        let timeline = ffmpeg.timeline(&info)?;
        let frames = [0, 1, u64::MAX].map(|frame| timeline.time(frame).map(|time| timeline.frame(time)));
        Ok::<_, VideoError>((info, frames))
    };
    let (info, frames) = read().unwrap();
    assert_eq!((info.size(), frames), ((32, 64), [Some(0), Some(1), None]));
    assert!(info.hdr.mastering.is_some() && info.spatial.is_some() && info.is_variable);
    for (seed, (name, text, words)) in (0..).zip(ANSWERS) {
        let mut understood = 0;
        for damaged in Mutants::new(text.as_bytes(), words, seed).take(Mutants::count(120)) {
            std::fs::write(folder.path().join(name), &damaged).unwrap();
            let start = Instant::now();
            understood += usize::from(read().is_ok());
            assert!(start.elapsed() < LONGEST, "{:?} for {}", start.elapsed(), String::from_utf8_lossy(&damaged));
        }
        assert!(understood > 0, "{name}");
        std::fs::write(folder.path().join(name), text).unwrap();
    }
}

/// An AVI of three places, one of which is empty, with its index.
#[cfg(unix)]
fn avi() -> Vec<u8> {
    let chunk = |name: &[u8; 4], content: &[u8]| [&name[..], &(content.len() as u32).to_le_bytes(), content].concat();
    let entry = |place: u32, size: u32| [&b"00dc\x10\0\0\0"[..], &place.to_le_bytes(), &size.to_le_bytes()].concat();
    let frames = [&b"movi"[..], &chunk(b"00dc", b"abcdef"), &chunk(b"00dc", b""), &chunk(b"00dc", b"ghij")].concat();
    let index = [entry(4, 6), entry(18, 0), entry(26, 4)].concat();
    chunk(b"RIFF", &[&b"AVI "[..], &chunk(b"LIST", &frames), &chunk(b"idx1", &index)].concat())
}

/// Containers of which more is asked: the index of AVI, the key frames of streams that begin anywhere, the rate of bare ones.
#[cfg(unix)]
#[test]
fn answers_about_each_container_are_refused_or_understood() {
    let folder = tempfile::tempdir().unwrap();
    let (ffmpeg, path) = (stand_in(folder.path()), folder.path().join("film"));
    let [(_, streams, _), (_, frames, _), _] = ANSWERS;
    std::fs::write(folder.path().join("frames"), frames).unwrap();
    let packets = "N/A,2,48,___\n3,3,96,K__\n5,4,120,__D\nN/A,6,200,___\n4,4,300,K__\n";
    let words = ["N/A", ",", "\n", "K", "D", "-", "9223372036854775807"];
    let containers = ["avi", "mpegts", "mpeg", "h264", "flv", "asf", "mov,mp4"];
    let count = Mutants::count(420) / containers.len();
    for (seed, container) in (0..).zip(containers) {
        let streams = streams.replace("matroska,webm", container).replace("\"start_pts\": 0", "\"start_pts\": 3");
        std::fs::write(folder.path().join("streams"), streams.replace("hevc", "mpeg4")).unwrap();
        let read = |packets: &[u8], film: &[u8]| {
            std::fs::write(folder.path().join("packets"), packets).unwrap();
            std::fs::write(&path, film).unwrap();
            let start = Instant::now();
            let timeline = ffmpeg.probe(&path).and_then(|info| ffmpeg.timeline(&info));
            assert!(start.elapsed() < LONGEST, "{container}: {:?}", start.elapsed());
            timeline.map(|timeline| [0, 1, u64::MAX].map(|frame| timeline.time(frame))).is_ok()
        };
        let film = if container == "avi" { avi() } else { b"frames".to_vec() };
        assert!(read(packets.as_bytes(), &film), "{container}");
        Mutants::new(packets.as_bytes(), &words, seed).take(count).for_each(|packets| _ = read(&packets, &film));
        let words = ["idx1", "movi", "00dc", "RIFF", "LIST"];
        // Of others, the file itself is tried elsewhere.
        let count = if container == "avi" { count } else { 0 };
        Mutants::new(&film, &words, seed).take(count).for_each(|film| _ = read(packets.as_bytes(), &film));
    }
}

/// The least number that there is has no counterpart above zero, by which a turn would be told.
#[cfg(unix)]
#[test]
fn turns_by_the_least_number_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (ffmpeg, path) = (stand_in(folder.path()), folder.path().join("film.mkv"));
    std::fs::write(&path, b"").unwrap();
    let (_, text, _) = ANSWERS[0];
    let least = i64::MIN;
    for said in [
        format!("\"rotation\": {least}"),
        format!("\"displaymatrix\": \"0: 0 {least} 0\\n1: {least} 0 0\\n2: 0 0 1073741824\\n\""),
    ] {
        let answer = text.replace("\"rotation\": -90", &said);
        assert_ne!(answer, text);
        std::fs::write(folder.path().join("streams"), answer).unwrap();
        let error = ffmpeg.probe(&path).unwrap_err().to_string();
        assert!(error.contains("its display matrix turns by no multiple of 90 degrees"), "{error}");
    }
}

/// A box of MP4 with a content.
fn boxed(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    [&(content.len() as u32 + 8).to_be_bytes(), &name[..], content].concat()
}

/// The description of a film with one track, whose handler has this name, with bytes behind what all descriptions have.
fn description(handler: &[u8; 4], behind: &[u8]) -> Vec<u8> {
    let entry = boxed(b"avc1", &[&[0; 78], behind].concat());
    let descriptions = boxed(b"stsd", &[&[0, 0, 0, 0, 0, 0, 0, 1], &entry[..]].concat());
    let table = boxed(b"minf", &boxed(b"stbl", &descriptions));
    let handler = boxed(b"hdlr", &[&[0; 8], &handler[..], &[0; 4]].concat());
    boxed(b"moov", &boxed(b"trak", &boxed(b"mdia", &[handler, table].concat())))
}

/// Tags are written where they are found again. Where they would not be, the file stays as it is.
#[test]
fn films_whose_tags_would_not_be_found_again_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.mp4");
    let tags = SpatialTags::vr180();
    let (film, frames, open) = (description(b"vide", b""), boxed(b"mdat", b"frames"), b"\0\0\0\0mdatframes".to_vec());
    for whole in [vec![&film], vec![&frames, &film], vec![&film, &frames]] {
        std::fs::write(&path, whole.into_iter().flatten().copied().collect::<Vec<u8>>()).unwrap();
        tags.write(&path).unwrap();
        assert_eq!(SpatialTags::read(&path).unwrap(), Some(tags));
    }
    for (strange, says) in [
        (vec![description(b"soun", b""), frames.clone()], "no track of video"),
        (vec![description(b"vide", b"\0\0\0\0avcC"), frames.clone()], "no size of its own"),
        (vec![film.clone(), open], "no whole boxes"),
        (vec![film.clone(), frames.clone(), b"\0\0\0".to_vec()], "no whole boxes"),
        (vec![film.clone(), frames, film], "is another"),
    ] {
        let bytes = strange.concat();
        std::fs::write(&path, &bytes).unwrap();
        let error = tags.write(&path).unwrap_err().to_string();
        assert!(error.contains("film.mp4") && error.contains(says), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), bytes, "{says}");
    }
}
