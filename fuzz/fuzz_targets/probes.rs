//! What ffprobe prints about a video, its frames and its packets, by a function that answers for it; and the file's own outermost
//! structure. Programs are started by a test of cosmorama-video instead: they would take hundreds of times as long as their readers.
#![no_main]

use std::cell::RefCell;

use cosmorama_fuzz::{prepare, written};
use cosmorama_video::Ffmpeg;
use libfuzzer_sys::fuzz_target;

/// Sign between the parts of an input: no JSON has it.
const BETWEEN: u8 = 0x1e;

/// The parts: what is said of the file, of the times of its packets and of its first frame, and the file itself.
const PARTS: usize = 4;

thread_local! {
    /// What is said of the file, of the times of its packets and of its first frame.
    static SAID: RefCell<[Vec<u8>; PARTS - 1]> = RefCell::default();
}

/// Answers for ffprobe.
fn answer(arguments: &[&str]) -> Vec<u8> {
    let asks = |option: &str| arguments.contains(&option);
    let part = if asks("-show_frames") { 2 } else { usize::from(asks("-show_entries")) };
    SAID.with_borrow(|said| said[part].clone())
}

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    let mut parts = bytes.splitn(PARTS, |byte| *byte == BETWEEN).map(<[u8]>::to_vec);
    let mut next = || parts.next().unwrap_or_default();
    SAID.set([next(), next(), next()]);
    let (ffmpeg, film) = (Ffmpeg::answered_by(answer), written("film.mov", &next()));
    let Ok(info) = ffmpeg.probe(&film) else { return };
    let _ = (info.size(), info.matrix(), info.range());
    let Ok(timeline) = ffmpeg.timeline(&info) else { return };
    for frame in [0, 1, 2, u64::MAX] {
        let _ = timeline.time(frame).map(|time| timeline.frame(time));
    }
});
