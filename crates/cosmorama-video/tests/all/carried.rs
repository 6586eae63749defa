//! Sound, subtitles, chapters, time code and metadata of the source.

use std::path::Path;

use cosmorama_io::pending::Unfinished;
use cosmorama_video::{Carried, Ffmpeg, Ratio, ReadOptions, StreamKind, VideoInfo, WriteSettings};

use crate::common::{ffmpeg, frames, moving, probed, run};
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
        // QuickTime knows it by its other code.
        let language = of(StreamKind::Audio).next().unwrap().labels.language.as_deref();
        assert_eq!(language, Some(if name == "a.mov" { "ger" } else { "deu" }), "{name}");
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

/// Sound that is coded anew is as long as the part that it goes with.
#[test]
fn a_part_has_all_its_sound_where_it_is_coded_anew() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let raw = folder.path().join("raw.mov");
    run(&format!("{} -f lavfi -i sine=duration=2 -c:v libx264 -c:a pcm_s16le", moving(64, 32, "25", 50)), &raw);
    let info = ffmpeg.probe(&raw).unwrap();
    for (name, part, frames) in [("a.webm", 0.0..1.6, 40), ("a.webm", 1.2..1.8, 15), ("a.mp4", 0.4..2.0, 40)] {
        let path = folder.path().join(name);
        let expected = part.end - part.start;
        write(&ffmpeg, &path, &settings(&info, Some(part)), frames).unwrap();
        let lengths = probed(&path, "-select_streams a -show_entries packet=duration_time -of csv=p=0");
        let seconds: f64 = lengths.split([',', '\n']).filter_map(|length| length.trim().parse::<f64>().ok()).sum();
        assert!((seconds - expected).abs() < 0.12, "{name}: {seconds} of {expected} s");
    }
}

/// So is sound that the user's own arguments code anew, from wherever the part is.
#[test]
fn a_part_has_all_its_sound_where_the_user_codes_it_anew() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.mkv");
    run(&format!("{} -f lavfi -i sine=duration=4 -c:v libx264 -c:a aac", moving(64, 32, "25", 100)), &film);
    let info = ffmpeg.probe(&film).unwrap();
    for arguments in [&["-c:a", "aac"][..], &["-acodec", "mp2", "-af", "volume=0.5"], &["-crf", "30"]] {
        let path = folder.path().join("a.mp4");
        let arguments = arguments.iter().map(|word| (*word).to_owned()).collect();
        write(&ffmpeg, &path, &WriteSettings { arguments, ..settings(&info, Some(2.4..3.6)) }, 30).unwrap();
        let lengths = probed(&path, "-select_streams a -show_entries packet=duration_time -of csv=p=0");
        let seconds: f64 = lengths.split([',', '\n']).filter_map(|length| length.trim().parse::<f64>().ok()).sum();
        assert!((seconds - 1.2).abs() < 0.12, "{seconds} s");
    }
}

/// Subtitles far behind a part make it no longer.
#[test]
fn subtitles_behind_a_part_are_left_out() {
    let Some(ffmpeg) = ffmpeg().filter(|ffmpeg| ffmpeg.version().major >= 5) else { return };
    let folder = tempfile::tempdir().unwrap();
    let words = folder.path().join("words.srt");
    std::fs::write(&words, format!("{SUBTITLES}\n3\n00:10:00,000 --> 00:10:01,000\nFar\n")).unwrap();
    for (name, codec, output) in
        [("film.mp4", "mov_text", "a.mp4"), ("film.mkv", "srt", "a.mkv"), ("film.mkv", "srt", "a.mp4")]
    {
        let film = folder.path().join(name);
        run(&format!("{} -i {} -c:v libx264 -c:s {codec}", moving(64, 32, "25", 50), words.display()), &film);
        let path = folder.path().join(output);
        write(&ffmpeg, &path, &settings(&ffmpeg.probe(&film).unwrap(), Some(0.0..1.0)), 25).unwrap();
        let seconds = probed(&path, "-show_entries format=duration -of csv=p=0");
        assert!(seconds.trim().parse::<f64>().unwrap() < 2.0, "{name} to {output}: {seconds}");
    }
}

/// Pictures of Matroska begin an instant after sound that is coded with a delay. Subtitles that the output cannot hold as they are become its own
/// also then, and those of a part begin with it.
#[test]
fn subtitles_are_coded_anew_whenever_the_pictures_begin() {
    let Some(ffmpeg) = ffmpeg().filter(|ffmpeg| ffmpeg.version().major >= 5) else { return };
    let folder = tempfile::tempdir().unwrap();
    let [film, words] = ["film.mkv", "words.srt"].map(|name| folder.path().join(name));
    std::fs::write(&words, SUBTITLES).unwrap();
    let inputs = format!("-f lavfi -i sine=duration=2 -i {}", words.display());
    run(&format!("{} {inputs} -map 0 -map 1 -map 2 -c:v libx264 -c:a aac -c:s srt", moving(64, 32, "25", 50)), &film);
    let info = ffmpeg.probe(&film).unwrap();
    for (name, codec) in [("a.mp4", "mov_text"), ("a.mov", "mov_text"), ("a.webm", "webvtt")] {
        for (part, begins) in [(None, &[0.2, 1.2][..]), (Some(1.0..2.0), &[0.2])] {
            let path = folder.path().join(name);
            let count = part.as_ref().map_or(50, |_| 25);
            let written = write(&ffmpeg, &path, &settings(&info, part), count).unwrap();
            let is_expected = |note: &String| note.contains("coded anew") || note.contains("begin with the part");
            assert!(written.notes.iter().all(is_expected), "{name}: {:?}", written.notes);
            let entries = "-show_entries stream=codec_name:packet=pts_time,size -of csv=p=0";
            let told = probed(&path, &format!("-select_streams s {entries}"));
            let lines: Vec<&str> = told.lines().filter(|line| !line.is_empty()).collect();
            let (packets, codecs): (Vec<&str>, Vec<&str>) = lines.iter().partition(|line| line.contains(','));
            assert_eq!(codecs, [codec], "{name}");
            // Between its texts, MP4 has empty ones, of two bytes.
            let texts = packets.iter().map(|line| line.split_once(',').unwrap()).filter(|(_, size)| *size != "2");
            let times: Vec<f64> = texts.map(|(time, _)| time.parse().unwrap()).collect();
            let are_near = times.iter().zip(begins).all(|(a, b)| (a - b).abs() < 0.04);
            assert!(times.len() == begins.len() && are_near, "{name}: {times:?}");
            let pictures = probed(&path, "-select_streams v -show_entries packet=pts_time -of csv=p=0");
            assert!(pictures.lines().next().unwrap().trim_end_matches(',').parse::<f64>().unwrap() < 0.01, "{name}");
        }
    }
}

/// Subtitles that stay on from before a part are left out of it, which is told.
#[test]
fn subtitles_from_before_a_part_are_told() {
    let Some(ffmpeg) = ffmpeg().filter(|ffmpeg| ffmpeg.version().major >= 5) else { return };
    let folder = tempfile::tempdir().unwrap();
    let info = source(&ffmpeg, folder.path());
    for name in ["a.mp4", "a.mkv"] {
        let path = folder.path().join(name);
        for (part, expected) in [(None, false), (Some(0.0..1.0), false), (Some(1.0..2.0), true)] {
            let count = part.as_ref().map_or(50, |_| 25);
            let written = write(&ffmpeg, &path, &settings(&info, part.clone()), count).unwrap();
            let is_told = written.notes.iter().any(|note| note.contains("begin with the part"));
            assert_eq!(is_told, expected, "{name}, {part:?}: {:?}", written.notes);
        }
    }
}

/// Languages, titles and roles go along, and what a container does not hold is told. A video without a language gets none.
#[test]
fn labels_of_streams_go_along() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [film, words] = ["film.mkv", "words.srt"].map(|name| folder.path().join(name));
    std::fs::write(&words, SUBTITLES).unwrap();
    let sound = "-f lavfi -i sine=duration=2";
    let inputs = format!("{} {sound} {sound} -i {}", moving(64, 32, "25", 50), words.display());
    let labels = "-metadata:s:a:0 language=deu -metadata:s:a:1 language=eng -metadata:s:a:1 title=Words \
                  -metadata:s:s language=gsw -disposition:a:0 default -disposition:a:1 comment -disposition:s:0 forced";
    run(&format!("{inputs} -map 0 -map 1 -map 2 -map 3 -c:v libx264 -c:a aac -c:s srt {labels}"), &film);
    let info = ffmpeg.probe(&film).unwrap();
    let lost = |notes: &[String]| notes.iter().filter(|note| note.contains("loses")).cloned().collect::<Vec<_>>();
    let told = |path: &Path| {
        let found = ffmpeg.probe(path).unwrap();
        assert_eq!(found.labels.language, None, "{}", path.display());
        let others = found.others.iter();
        others.map(|other| (other.labels.language.clone().unwrap(), other.labels.roles.join("+"))).collect::<Vec<_>>()
    };
    let expected = |languages: [&str; 3], roles: [&str; 3]| {
        languages.map(str::to_owned).into_iter().zip(roles.map(str::to_owned)).collect::<Vec<_>>()
    };
    let path = folder.path().join("a.mkv");
    let written = write(&ffmpeg, &path, &settings(&info, None), 50).unwrap();
    assert_eq!(lost(&written.notes), [""; 0]);
    assert_eq!(told(&path), expected(["deu", "eng", "gsw"], ["", "comment", "forced"]));
    assert_eq!(ffmpeg.probe(&path).unwrap().others[1].labels.title.as_deref(), Some("Words"));
    let path = folder.path().join("a.mp4");
    let written = write(&ffmpeg, &path, &settings(&info, None), 50).unwrap();
    assert_eq!(lost(&written.notes), [""; 0]);
    assert_eq!(told(&path), expected(["deu", "eng", "gsw"], ["", "comment", "forced"]));
    let handlers = probed(&path, "-select_streams a -show_entries stream_tags=handler_name -of csv=p=0");
    assert_eq!(handlers.lines().collect::<Vec<_>>(), ["SoundHandler", "Words"]);
    // From the name of the handler, the title comes back.
    let info = ffmpeg.probe(&path).unwrap();
    let again = folder.path().join("b.mkv");
    write(&ffmpeg, &again, &settings(&info, None), 50).unwrap();
    assert_eq!(ffmpeg.probe(&again).unwrap().others[1].labels.title.as_deref(), Some("Words"));
    let path = folder.path().join("a.mov");
    let info = ffmpeg.probe(&film).unwrap();
    let written = write(&ffmpeg, &path, &settings(&info, None), 50).unwrap();
    let told = lost(&written.notes);
    assert!(told.iter().any(|note| note.contains("its language (gsw)")), "{told:?}");
    assert!(told.iter().any(|note| note.contains("its role (comment)")), "{told:?}");
    assert!(!told.iter().any(|note| note.contains("deu")), "{told:?}");
}

/// Tags of the film and of its streams go along, or are told by their names, unless the user's own arguments decide on them.
#[test]
fn tags_go_along_or_are_told() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.mkv");
    let tags =
        "-metadata artist=Somebody -metadata mytag=mine -metadata:s:v custom=ours -metadata:s:a:0 language=por-BR";
    run(&format!("{} -f lavfi -i sine=duration=1 -c:v libx264 -c:a aac {tags}", moving(64, 32, "25", 25)), &film);
    let info = ffmpeg.probe(&film).unwrap();
    for (name, expected) in
        [("a.mkv", &[][..]), ("a.mp4", &["the film", "(mytag)", "(custom)", "(por-BR; it has por)"])]
    {
        let path = folder.path().join(name);
        let written = write(&ffmpeg, &path, &settings(&info, None), 25).unwrap();
        let told = written.notes.join("\n").to_ascii_lowercase();
        for part in expected {
            assert!(told.contains(&part.to_ascii_lowercase()), "{name}: {told}");
        }
        assert!(!expected.is_empty() || !told.contains("loses"), "{name}: {told}");
        let artist = probed(&path, "-show_entries format_tags=artist -of csv=p=0");
        assert_eq!(artist.trim(), "Somebody");
    }
    // One that is longer than arguments of programs may be.
    let tagged = folder.path().join("long.mkv");
    let long = folder.path().join("long.txt");
    std::fs::write(&long, format!(";FFMETADATA1\n[STREAM]\nlong={}\n", "x".repeat(200_000))).unwrap();
    let way = "-map 0:v -map_metadata 1 -map_metadata:s:v:0 1:s:0 -c:v libx264";
    run(&format!("{} -f ffmetadata -i {} {way}", moving(64, 32, "25", 25), long.display()), &tagged);
    let path = folder.path().join("own.mkv");
    let written = write(&ffmpeg, &path, &settings(&ffmpeg.probe(&tagged).unwrap(), None), 25).unwrap();
    let is_told = written.notes.iter().any(|note| note.to_ascii_lowercase().contains("(long)"));
    assert!(is_told, "{:?}", written.notes);
    for (name, codecs) in [("a.mxf", "-c:v mpeg2video -c:a pcm_s16le"), ("a.avi", "-c:v mpeg4 -c:a mp3")] {
        let film = folder.path().join(name);
        run(&format!("{} -f lavfi -i sine=duration=1:sample_rate=48000 {codecs}", moving(64, 32, "25", 25)), &film);
        let path = folder.path().join("own.mp4");
        let written = write(&ffmpeg, &path, &settings(&ffmpeg.probe(&film).unwrap(), None), 25).unwrap();
        assert!(!written.notes.iter().any(|note| note.contains("loses")), "{name}: {:?}", written.notes);
    }
    let own = ["-metadata:s:a:0", "language=fra"].map(str::to_owned).to_vec();
    let path = folder.path().join("own.mp4");
    let written = write(&ffmpeg, &path, &WriteSettings { arguments: own, ..settings(&info, None) }, 25).unwrap();
    assert!(!written.notes.iter().any(|note| note.contains("loses")), "{:?}", written.notes);
    assert_eq!(ffmpeg.probe(&path).unwrap().others[0].labels.language.as_deref(), Some("fra"));
}

/// Sound of which a part has nothing is told, and the rest is written.
#[test]
fn a_part_without_sound_is_written() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.mp4");
    run(&format!("{} -f lavfi -i sine=duration=1 -c:v libx264 -c:a aac", moving(64, 32, "25", 50)), &film);
    let info = ffmpeg.probe(&film).unwrap();
    for (name, part, is_told) in [("a.mp4", 1.2..2.0, true), ("a.mkv", 1.2..2.0, true), ("b.mp4", 0.8..1.6, false)] {
        let path = folder.path().join(name);
        let written = write(&ffmpeg, &path, &settings(&info, Some(part)), 20).unwrap();
        assert_eq!(
            written.notes.iter().any(|note| note.contains("has nothing")),
            is_told,
            "{name}: {:?}",
            written.notes
        );
    }
}

/// In a transport stream, times count from the first of its streams, whichever go along.
#[test]
fn late_sound_of_transport_streams_stays_late() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let sound = "-itsoffset 0.6 -f lavfi -i sine=duration=1";
    for name in ["film.ts", "film.mpg", "film.mkv"] {
        let film = folder.path().join(name);
        run(&format!("{} {sound} -c:v mpeg2video -bf 0 -c:a mp2", moving(64, 32, "25", 50)), &film);
        let info = ffmpeg.probe(&film).unwrap();
        for (part, expected) in [(None, 0.6), (Some(0.2..2.0), 0.4), (Some(0.8..2.0), 0.0)] {
            for output in ["a.mkv", "a.webm"] {
                let path = folder.path().join(output);
                let frames = part.as_ref().map_or(50, |part| ((part.end - part.start) * 25.0_f64).round() as u32);
                write(&ffmpeg, &path, &settings(&info, part.clone()), frames).unwrap();
                let times = probed(&path, "-select_streams a -show_entries packet=pts_time -of csv=p=0");
                let first: f64 = times.lines().next().unwrap().trim_end_matches(',').parse().unwrap();
                assert!((first - expected).abs() < 0.05, "{name} to {output}, {part:?}: {first} s");
            }
        }
    }
}

/// Files that are attached go along where there is room, and other data by its container's code is told.
#[test]
fn what_lies_beside_the_streams_is_kept_or_told() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [film, font] = ["film.mkv", "a.ttf"].map(|name| folder.path().join(name));
    std::fs::write(&font, "a font").unwrap();
    let attach = format!("-attach {} -metadata:s:t mimetype=application/x-truetype-font", font.display());
    run(&format!("{} {attach} -c:v libx264", moving(64, 32, "25", 25)), &film);
    let info = ffmpeg.probe(&film).unwrap();
    for (name, is_kept) in [("a.mkv", true), ("a.mp4", false)] {
        let path = folder.path().join(name);
        let written = write(&ffmpeg, &path, &settings(&info, Some(0.2..0.6)), 10).unwrap();
        assert_eq!(has(&path, b"a font"), is_kept, "{name}");
        let is_told = written.notes.iter().any(|note| note.contains("attached file") && note.contains("left out"));
        assert_eq!(is_told, !is_kept, "{name}: {:?}", written.notes);
    }
    // The stream of time codes, and that of sound, under other names.
    let raw = folder.path().join("raw.mov");
    run(&format!("{} -f lavfi -i sine=duration=2 -c:v libx264 -c:a pcm_s16le", moving(64, 32, "25", 50)), &raw);
    let with_chapters = source(&ffmpeg, folder.path()).path;
    for (film, from, to, expected) in [
        (&with_chapters, b"tmcd", b"camm", "(data, camm) is left out"),
        (&with_chapters, b"tmcd", b"gpmd", "(data, gpmd) is left out"),
        (&raw, b"sowt", b"zzzz", "(sound, ) is left out: nobody knows its codec"),
    ] {
        let path = folder.path().join("renamed.mov");
        std::fs::write(&path, renamed(&std::fs::read(film).unwrap(), from, to)).unwrap();
        let info = ffmpeg.probe(&path).unwrap();
        let written = write(&ffmpeg, &folder.path().join("b.mp4"), &settings(&info, None), 50).unwrap();
        assert!(written.notes.iter().any(|note| note.contains(expected)), "{expected}: {:?}", written.notes);
    }
}

/// A file with another name of a box, wherever it stands.
fn renamed(file: &[u8], from: &[u8; 4], to: &[u8; 4]) -> Vec<u8> {
    let places = (0..file.len() - 3).filter(|at| file[*at..*at + 4] == *from);
    let mut file = file.to_vec();
    places.collect::<Vec<_>>().into_iter().for_each(|at| file[at..at + 4].copy_from_slice(to));
    file
}

/// Seconds of a file at which its sound is loud first.
fn click(path: &Path) -> f64 {
    let start = probed(path, "-select_streams a -show_entries stream=start_time -of csv=p=0");
    let start: f64 = start.lines().find_map(|line| line.trim_end_matches(',').parse().ok()).unwrap();
    let bytes = run(&format!("-i {} -map 0:a -ac 1 -ar 48000 -f f32le", path.display()), Path::new("pipe:1"));
    let samples = bytes.chunks_exact(4).map(|sample| f32::from_le_bytes(sample.try_into().unwrap()));
    let before = samples.take_while(|sample| sample.abs() < 0.4).count();
    assert!(4 * before < bytes.len(), "a click");
    start + before as f64 / 48000.0
}

/// A film that was cut out begins behind frames that are left out, and its sound before them. In AVI, frames and sound count from elsewhere.
#[test]
fn sound_keeps_to_its_frames_where_the_first_are_cut_off() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let x264 = "libx264 -bf 3 -x264-params open-gop=1:keyint=12:min-keyint=12:scenecut=0";
    let mpeg4 = "mpeg4 -bf 2 -g 12 -sc_threshold 1000000000";
    let (film, cut) = (folder.path().join("film"), folder.path().join("cut"));
    for (container, codec) in [("avi", x264), ("avi", mpeg4), ("mkv", mpeg4)] {
        let [film, cut] = [&film, &cut].map(|path| path.with_extension(container));
        let sound = "-f lavfi -i aevalsrc='if(between(t,2,2.02),0.9,0)':s=48000:d=4";
        run(&format!("{} {sound} -c:v {codec} -c:a pcm_s16le", moving(64, 32, "25", 100)), &film);
        run(&format!("-i {} -ss 0.5 -c copy", film.display()), &cut);
        for (source, part) in [(&film, 1.0..3.0), (&cut, 0.0..3.04), (&cut, 1.0..2.0)] {
            let info = ffmpeg.probe(source).unwrap();
            let left = frames(&ffmpeg, source, ReadOptions::default()).unwrap().len();
            assert_eq!((info.left_out > 0, left), if source == &cut { (true, 76) } else { (false, 100) }, "{codec}");
            let expected = 2.0 - (100 - left) as f64 / 25.0 - part.start;
            let written = folder.path().join("written.mkv");
            let count = ((part.end - part.start) * 25.0).round() as u32;
            write(&ffmpeg, &written, &settings(&info, Some(part.clone())), count).unwrap();
            let found = click(&written);
            // AVI counts by frames.
            let is_near = (found - expected).abs() < 0.03;
            assert!(is_near, "{container} {codec} {part:?}: {found} s instead of {expected}");
        }
    }
}

/// A chapter of which a part has no frame is left out, at both ends.
#[test]
fn a_part_has_no_empty_chapters() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let info = source(&ffmpeg, folder.path());
    for name in ["a.mp4", "a.mkv"] {
        for (part, frames, title) in
            [(0.0..1.0, 25, "One"), (1.0..2.0, 25, "Two"), (0.4..0.6, 5, "One"), (0.4..1.0, 15, "One")]
        {
            let path = folder.path().join(name);
            write(&ffmpeg, &path, &settings(&info, Some(part.clone())), frames).unwrap();
            let titles = probed(&path, "-show_entries chapter_tags=title -of csv=p=0");
            assert_eq!(titles.split_whitespace().collect::<Vec<_>>(), [title], "{name}, {part:?}");
            let pictures =
                probed(&path, "-count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0");
            assert_eq!(pictures.trim(), frames.to_string(), "{name}, {part:?}");
        }
    }
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
    let flac = folder.path().join("flac.mkv");
    run(&format!("{} -f lavfi -i sine=duration=1 -c:v libx264 -c:a flac", moving(64, 32, "25", 25)), &flac);
    let output = folder.path().join("b.mp4");
    write(&ffmpeg, &output, &settings(&ffmpeg.probe(&flac).unwrap(), None), 25).unwrap();
    assert_eq!(ffmpeg.probe(&output).unwrap().others[0].codec, "alac");
}

/// Puts a box at the end of another one in a box of a file: `path` leads there. Of boxes with one name, the last is taken.
fn insert(boxes: &[u8], path: &[&[u8; 4]], child: &[u8]) -> Vec<u8> {
    let [name, rest @ ..] = path else { return [boxes, child].concat() };
    let mut starts = Vec::new();
    let mut at = 0;
    while at + 8 <= boxes.len() {
        let size = u32::from_be_bytes(boxes[at..at + 4].try_into().unwrap()) as usize;
        if boxes[at + 4..at + 8] == **name {
            starts.push((at, size));
        }
        at += size;
    }
    let (start, size) = *starts.last().unwrap();
    // Fields before the boxes inside.
    let fields = match *name {
        b"stsd" => 8,
        b"mp4a" => 28,
        _ => 0,
    };
    let content = &boxes[start + 8..start + size];
    let new = [&content[..fields], &insert(&content[fields..], rest, child)].concat();
    let head = [&(new.len() as u32 + 8).to_be_bytes()[..], *name].concat();
    [&boxes[..start], &head, &new, &boxes[start + size..]].concat()
}

/// A video with sound whose channels lie around the listener, as its box says.
fn ambisonic(ffmpeg: &Ffmpeg, folder: &Path) -> (VideoInfo, Vec<u8>) {
    let path = folder.join("around.mp4");
    let sound = "-f lavfi -i anoisesrc=duration=1,aformat=channel_layouts=quad -c:a aac";
    run(&format!("{} {sound} -c:v libx264", moving(64, 32, "25", 25)), &path);
    let channels: Vec<u8> = (0..4_u32).flat_map(u32::to_be_bytes).collect();
    let field = [b"\0\0\0\x1cSA3D\0\0\0\0\0\x01\0\0\0\0\0\x04".as_slice(), &channels].concat();
    let field = [&(field.len() as u32).to_be_bytes()[..], &field[4..]].concat();
    let way: [&[u8; 4]; 7] = [b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsd", b"mp4a"];
    std::fs::write(&path, insert(&std::fs::read(&path).unwrap(), &way, &field)).unwrap();
    (ffmpeg.probe(&path).unwrap(), field)
}

fn has(path: &Path, part: &[u8]) -> bool {
    std::fs::read(path).unwrap().windows(part.len()).any(|bytes| bytes == part)
}

/// The field of ambisonic sound goes along, where there is sound.
#[test]
fn sound_around_the_listener_keeps_its_field() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (info, field) = ambisonic(&ffmpeg, folder.path());
    for name in ["a.mp4", "a.mov"] {
        let path = folder.path().join(name);
        let written = write(&ffmpeg, &path, &settings(&info, None), 25).unwrap();
        assert!(has(&path, &field) && written.notes.is_empty(), "{name}: {:?}", written.notes);
    }
    // Left out by the user's own argument, there is none.
    let path = folder.path().join("silent.mp4");
    let silent = WriteSettings { arguments: vec!["-an".to_owned()], ..settings(&info, None) };
    write(&ffmpeg, &path, &silent, 25).unwrap();
    assert!(!has(&path, b"SA3D") && ffmpeg.probe(&path).unwrap().others.is_empty());
}

/// Waits until a program has opened a file.
#[cfg(target_os = "linux")]
fn wait_until_open(path: &Path) {
    let begun = std::time::Instant::now();
    let is_open = || {
        let processes = std::fs::read_dir("/proc").unwrap().flatten();
        let files =
            processes.filter_map(|process| std::fs::read_dir(process.path().join("fd")).ok()).flatten().flatten();
        files.filter_map(|file| std::fs::read_link(file.path()).ok()).any(|link| link == path)
    };
    while !is_open() {
        assert!(begun.elapsed() < std::time::Duration::from_secs(60), "it is not opened");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
}

/// The source changes while its sound is read: for a tag of it, a finished video is not thrown away.
#[cfg(target_os = "linux")]
#[test]
fn a_finished_video_is_kept_without_the_field_of_its_sound() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (info, _) = ambisonic(&ffmpeg, folder.path());
    let path = folder.path().join("b.mp4");
    let unfinished = Unfinished::default();
    let mut writer = cosmorama_video::VideoWriter::create(&ffmpeg, &path, settings(&info, None), &unfinished).unwrap();
    let (channels, depth) = (cosmorama::raster::Channels::Rgb, cosmorama::raster::Depth::Eight);
    for number in 0..25 {
        writer.write(&crate::common::picture((64, 32), channels, depth, number), None).unwrap();
    }
    wait_until_open(&info.path);
    std::fs::remove_file(&info.path).unwrap();
    std::fs::write(&info.path, "no video any more").unwrap();
    let written = writer.finish().unwrap();
    assert!(written.notes.iter().any(|note| note.contains("spatial sound")), "{:?}", written.notes);
    assert_eq!(ffmpeg.probe(&path).unwrap().others.len(), 1);
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
