//! Small videos for tests, made by the installed ffmpeg.

use std::process::Command;

use crate::bench::{Bench, text};

/// Returns whether ffmpeg is installed. Without it tests of videos say so and pass, except in CI.
pub(crate) fn has_ffmpeg() -> bool {
    let is_there = Command::new("ffmpeg").arg("-version").output().is_ok_and(|output| output.status.success());
    if !is_there {
        assert!(std::env::var_os("CI").is_none(), "ffmpeg is absent: CI must have it");
        println!("left out: ffmpeg is not installed");
    }
    is_there
}

/// Runs ffmpeg in the folder of a bench.
pub(crate) fn ffmpeg(bench: &Bench, arguments: &[&str]) {
    let output = Command::new("ffmpeg")
        .current_dir(bench.path(""))
        .args(["-v", "error", "-y", "-nostdin", "-bitexact"])
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
}

/// Makes a video without loss, in RGB, of so many frames of 64x32 that all differ.
pub(crate) fn film(bench: &Bench, name: &str, frames: usize) {
    let source = format!("testsrc2=size=64x32:rate=25,format=gbrp,trim=end_frame={frames}");
    ffmpeg(bench, &["-f", "lavfi", "-i", &source, "-c:v", "ffv1", "-g", "1", "-slicecrc", "1", name]);
}

/// Takes a video apart into `frames/%04d.png`, from 0 on.
pub(crate) fn taken_apart(bench: &Bench, video: &str, folder: &str) -> usize {
    std::fs::create_dir_all(bench.path(folder)).unwrap();
    let pattern = format!("{folder}/%04d.png");
    ffmpeg(bench, &["-i", video, "-fps_mode", "passthrough", "-start_number", "0", "-pix_fmt", "rgb24", &pattern]);
    std::fs::read_dir(bench.path(folder)).unwrap().count()
}

/// Returns what ffprobe says of the first stream of a kind; empty if there is none.
pub(crate) fn said(bench: &Bench, video: &str, stream: &str, entries: &str) -> String {
    let output = Command::new("ffprobe")
        .current_dir(bench.path(""))
        .args([
            "-v",
            "error",
            "-select_streams",
            stream,
            "-count_frames",
            "-show_entries",
            entries,
            "-of",
            "default=nw=1",
            video,
        ])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// Makes a film of five frames that counts three, as by another program: what ffmpeg tells of frames, it may have copied.
pub(super) fn miscounted(bench: &Bench, name: &str) {
    let pictures = ["-f", "lavfi", "-i", "testsrc2=size=64x32:rate=25", "-frames:v", "5", "-c:v", "ffv1"];
    let count = ["-metadata:s:v", "NUMBER_OF_FRAMES=3", "-write_crc32", "0", name];
    ffmpeg(bench, &[&pictures[..], &count].concat());
    let mut bytes = std::fs::read(bench.path(name)).unwrap();
    while let Some(at) = bytes.windows(4).position(|name| name == b"Lavf") {
        bytes[at] = b'X';
    }
    std::fs::write(bench.path(name), bytes).unwrap();
}
