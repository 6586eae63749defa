//! What ffprobe prints about a video, its frames and its packets, by a program that prints what is tried; and the file's own
//! outermost structure.
#![no_main]

use std::os::unix::fs::PermissionsExt;
use std::sync::LazyLock;

use cosmorama_fuzz::{path, prepare, written};
use cosmorama_video::Ffmpeg;
use libfuzzer_sys::fuzz_target;

/// Sign between the parts of an input: no JSON has it.
const BETWEEN: u8 = 0x1e;

/// The parts: what is said of the file, of the times of its packets and of its first frame, and the file itself.
const PARTS: [&str; 4] = ["streams", "packets", "frames", "film.mov"];

/// Stands in for ffprobe and ffmpeg. No process but the shell is started.
const PROGRAM: &str = r#"#!/bin/sh
case "$*" in
    *-version*) said=version ;;
    *-show_frames*) said=frames ;;
    *-show_entries*) said=packets ;;
    *) said=streams ;;
esac
exec cat "${0%/*}/$said"
"#;

static FFMPEG: LazyLock<Ffmpeg> = LazyLock::new(|| {
    written("version", b"ffprobe version 5.1 Copyright");
    let program = written("program", PROGRAM.as_bytes());
    std::fs::set_permissions(&program, PermissionsExt::from_mode(0o700)).expect("it is ours");
    Ffmpeg::at(program.clone(), program).expect("it tells a version")
});

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    let mut parts = bytes.splitn(PARTS.len(), |byte| *byte == BETWEEN);
    for name in PARTS {
        written(name, parts.next().unwrap_or_default());
    }
    let Ok(info) = FFMPEG.probe(&path("film.mov")) else { return };
    let _ = (info.size(), info.matrix(), info.range());
    let Ok(timeline) = FFMPEG.timeline(&info) else { return };
    for frame in [0, 1, 2, u64::MAX] {
        let _ = timeline.time(frame).map(|time| timeline.frame(time));
    }
});
