//! Videos for tests, made by the installed ffmpeg.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_video::{Ffmpeg, ReadOptions, VideoError, VideoFrame, VideoReader};

/// The installed ffmpeg; `None`, loudly, where there is none. In CI it must be.
pub(crate) fn ffmpeg() -> Option<Ffmpeg> {
    match Ffmpeg::find() {
        Ok(found) => Some(found),
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "{error}");
            eprintln!("SKIPPED: {error}");
            None
        }
    }
}

/// Runs ffmpeg with words between spaces and, last, an output; returns what it prints.
pub(crate) fn run(words: &str, output: &Path) -> Vec<u8> {
    let mut command = Command::new("ffmpeg");
    command.args(["-nostdin", "-v", "error", "-y"]).args(words.split(' ').filter(|word| !word.is_empty()));
    let done = command.arg(output).stdin(Stdio::null()).output().unwrap();
    assert!(done.status.success(), "{words}: {}", String::from_utf8_lossy(&done.stderr));
    done.stdout
}

/// Raw frames of a file, in a pixel format of ffmpeg.
pub(crate) fn raw(path: &Path, format: &str) -> Vec<u8> {
    let input = path.to_str().unwrap();
    run(&format!("-i {input} -map 0:v:0 -f rawvideo -pix_fmt {format}"), Path::new("pipe:1"))
}

/// A moving picture as input of ffmpeg.
pub(crate) fn moving(width: usize, height: usize, rate: &str, frames: u64) -> String {
    format!("-f lavfi -i testsrc2=size={width}x{height}:rate={rate},trim=end_frame={frames}")
}

/// All frames, or the error.
pub(crate) fn frames(ffmpeg: &Ffmpeg, path: &Path, options: ReadOptions) -> Result<Vec<VideoFrame>, VideoError> {
    let mut reader = VideoReader::open(ffmpeg, &ffmpeg.probe(path)?, options)?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame()? {
        frames.push(frame);
    }
    Ok(frames)
}

/// Frames of a range.
pub(crate) fn of(first: u64, last: u64) -> ReadOptions {
    ReadOptions { frames: Some(first..=last), ..ReadOptions::default() }
}

/// Codes of a frame as floats, 1 the greatest.
pub(crate) fn values(image: &EncodedImage) -> Vec<f64> {
    match image.samples() {
        Samples::U8(samples) => samples.iter().map(|sample| f64::from(*sample) / 255.0).collect(),
        Samples::U16(samples) => samples.iter().map(|sample| f64::from(*sample) / 65535.0).collect(),
        Samples::Half(_) | Samples::Float(_) => panic!("floats"),
    }
}

/// Largest difference of two frames, of 1.
pub(crate) fn difference(a: &EncodedImage, b: &EncodedImage) -> f64 {
    assert_eq!((a.width(), a.height(), a.channels()), (b.width(), b.height(), b.channels()));
    values(a).iter().zip(values(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A frame that no codec finds easy, another one for each number.
pub(crate) fn picture(size: (usize, usize), channels: Channels, depth: Depth, number: u32) -> EncodedImage {
    let count = size.0 * size.1 * channels.count();
    let noise = |i: usize| (i as u32 ^ number.wrapping_mul(0x9e37_79b9)).wrapping_mul(2_654_435_761) >> 16;
    let samples = match depth {
        Depth::Eight => Samples::U8((0..count).map(|i| (noise(i) >> 8) as u8).collect()),
        _ => Samples::U16((0..count).map(|i| noise(i) as u16).collect()),
    };
    EncodedImage::new(size.0, size.1, channels, depth, samples).unwrap()
}

/// A picture of RGB from values, 1 the greatest code.
pub(crate) fn rgb_picture(size: (usize, usize), depth: Depth, values: impl Iterator<Item = f64>) -> EncodedImage {
    let samples = match depth {
        Depth::Eight => Samples::U8(values.map(|value| (value * 255.0).round() as u8).collect()),
        _ => Samples::U16(values.map(|value| (value * 65535.0).round() as u16).collect()),
    };
    EncodedImage::new(size.0, size.1, Channels::Rgb, depth, samples).unwrap()
}

/// Names in a folder, in order.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// ffprobe's words about the streams of a file.
pub(crate) fn probed(path: &Path, arguments: &str) -> String {
    let done = Command::new("ffprobe").args(["-v", "error"]).args(arguments.split(' ')).arg(path).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// A program that answers by a script, for programs that are old, absent or poor.
#[cfg(unix)]
pub(crate) fn script(folder: &Path, name: &str, text: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join(name);
    std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}
