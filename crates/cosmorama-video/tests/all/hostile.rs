//! Files and names from strangers.

use cosmorama_video::{ReadOptions, VideoError, WriteSettings};

use crate::common::{ffmpeg, frames, moving, names, run};
use crate::writing::{rate, write};

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
