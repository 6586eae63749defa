//! Sound, subtitles, chapters, time code and metadata of the source.

use std::path::Path;

use cosmorama_io::pending::Unfinished;
use cosmorama_video::{Carried, Ffmpeg, Ratio, StreamKind, VideoInfo, WriteSettings};

use crate::common::{ffmpeg, moving, probed, run};
use crate::writing::write;

const CHAPTERS: &str = ";FFMETADATA1\ntitle=Sky\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=1000\ntitle=One\n[CHAPTER]\n\
                        TIMEBASE=1/1000\nSTART=1000\nEND=2000\ntitle=Two\n";
const SUBTITLES: &str = "1\n00:00:00,200 --> 00:00:00,900\nHello\n\n2\n00:00:01,200 --> 00:00:01,800\nWorld\n";

/// A video of two seconds, 25 frames each, with all.
fn source(ffmpeg: &Ffmpeg, folder: &Path) -> VideoInfo {
    let (chapters, subtitles) = (folder.join("chapters.txt"), folder.join("words.srt"));
    std::fs::write(&chapters, CHAPTERS).unwrap();
    std::fs::write(&subtitles, SUBTITLES).unwrap();
    let path = folder.join("source.mp4");
    let inputs =
        format!("-f lavfi -i sine=duration=2 -i {} -i {}", chapters.to_str().unwrap(), subtitles.to_str().unwrap());
    let codecs = "-c:v libx264 -c:a aac -c:s mov_text -metadata:s:a language=deu -timecode 01:00:00:00";
    run(
        &format!(
            "{} {inputs} -map 0:v -map 1:a -map 3:s -map_metadata 2 -map_chapters 2 {codecs}",
            moving(64, 32, "25", 50)
        ),
        &path,
    );
    ffmpeg.probe(&path).unwrap()
}

fn settings(info: &VideoInfo, seconds: Option<std::ops::Range<f64>>) -> WriteSettings {
    let source = Some(Carried { info: info.clone(), seconds });
    WriteSettings { source, ..WriteSettings::new((64, 32), Ratio::new(25, 1).unwrap()) }
}

/// Bytes of a stream of sound, as a digest.
fn sound(path: &Path) -> Vec<u8> {
    run(&format!("-i {} -map 0:a:0 -c copy -f md5", path.to_str().unwrap()), Path::new("-"))
}

#[test]
fn all_but_the_pictures_is_copied() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let info = source(&ffmpeg, folder.path());
    assert_eq!((info.chapters, info.timecode.as_deref()), (2, Some("01:00:00:00")));
    for name in ["a.mp4", "a.mov", "a.mkv"] {
        let path = folder.path().join(name);
        let written = write(&ffmpeg, &path, &settings(&info, None), 50).unwrap();
        let found = ffmpeg.probe(&path).unwrap();
        let of = |kind| found.others.iter().filter(move |other| other.kind == kind);
        assert_eq!(of(StreamKind::Audio).map(|other| other.codec.as_str()).collect::<Vec<_>>(), ["aac"], "{name}");
        // MOV knows fewer languages.
        let language = of(StreamKind::Audio).next().unwrap().language.as_deref();
        assert_eq!(language, if name == "a.mov" { None } else { Some("deu") }, "{name}");
        assert_eq!(of(StreamKind::Subtitle).count(), 1, "{name}");
        assert_eq!(found.chapters, 2, "{name}");
        assert_eq!(found.timecode.as_deref(), Some("01:00:00:00"), "{name}");
        let has = |key: &str, value: &str| {
            found.metadata.iter().any(|(name, text)| name.eq_ignore_ascii_case(key) && text == value)
        };
        assert!(has("title", "Sky"), "{name}: {:?}", found.metadata);
        assert_eq!(sound(&path), sound(&info.path), "{name}");
        assert_eq!(written.notes.is_empty(), name != "a.mkv", "{name}: {:?}", written.notes);
    }
}

/// A part of the source: sound, subtitles, chapters and time code of that part.
#[test]
fn a_part_has_its_own_sound_and_time_code() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let info = source(&ffmpeg, folder.path());
    let path = folder.path().join("a.mp4");
    write(&ffmpeg, &path, &settings(&info, Some(1.2..1.8)), 15).unwrap();
    let found = ffmpeg.probe(&path).unwrap();
    assert_eq!(found.timecode.as_deref(), Some("01:00:01:05"));
    assert_eq!(found.chapters, 1);
    let seconds = probed(&path, "-select_streams a -show_entries stream=duration -of csv=p=0");
    let seconds: f64 = seconds.trim().parse().unwrap();
    // Whole packets of 1024 samples.
    assert!((0.55..0.68).contains(&seconds), "{seconds}");
}

/// Sound that a container cannot hold is coded anew, and that is told.
#[test]
fn what_cannot_be_copied_is_told() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("raw.mov");
    run(&format!("{} -f lavfi -i sine=duration=1 -c:v libx264 -c:a pcm_s16le", moving(64, 32, "25", 25)), &path);
    let info = ffmpeg.probe(&path).unwrap();
    let output = folder.path().join("a.mp4");
    let written = write(&ffmpeg, &output, &settings(&info, None), 25).unwrap();
    assert!(written.notes.iter().any(|note| note.contains("alac") && note.contains("MP4")), "{:?}", written.notes);
    assert_eq!(ffmpeg.probe(&output).unwrap().others[0].codec, "alac");
    let output = folder.path().join("a.webm");
    let written = write(&ffmpeg, &output, &settings(&info, None), 25).unwrap();
    assert!(written.notes.iter().any(|note| note.contains("libopus")), "{:?}", written.notes);
}

/// The list of temporary files is empty again at the end.
#[test]
fn no_temporary_file_is_left_beside_the_source() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let info = source(&ffmpeg, folder.path());
    let before = crate::common::names(folder.path()).len();
    let unfinished = Unfinished::default();
    let writer =
        cosmorama_video::VideoWriter::create(&ffmpeg, &folder.path().join("a.mp4"), settings(&info, None), &unfinished);
    drop(writer.unwrap());
    assert_eq!(crate::common::names(folder.path()).len(), before);
}
