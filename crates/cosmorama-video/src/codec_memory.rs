//! Memory that ffmpeg holds, with its codecs: measured of version 5.1, with frames of 1024² to 4096² and 1 to 16 threads
//! (docs/video-codecs.md, "Memory of ffmpeg").

use std::thread::available_parallelism;

use crate::{Codec, VideoInfo};

/// Bytes for each pixel of a frame.
#[derive(Clone, Copy)]
struct PixelBytes {
    alone: u64,
    /// For each thread.
    thread: u64,
}

impl PixelBytes {
    const fn new(alone: u64, thread: u64) -> Self {
        Self { alone, thread }
    }

    /// Returns the bytes for a frame, with those that go with no size: tables, queues of packets.
    fn of_frame(self, (width, height): (usize, usize), threads: usize, fixed: u64) -> u64 {
        let pixel = self.alone + self.thread * threads as u64;
        fixed.saturating_add((width as u64).saturating_mul(height as u64).saturating_mul(pixel))
    }
}

impl Codec {
    /// Returns the bytes that its encoder holds with the arguments of its preset, about, for frames of so many columns and rows: those that
    /// it looks ahead to, and those that its threads work on.
    pub fn encoding_bytes(self, size: (usize, usize), is_deep: bool, has_alpha: bool) -> u64 {
        self.encoding_bytes_on(cores(), size, is_deep, has_alpha)
    }

    fn encoding_bytes_on(self, cores: usize, size: (usize, usize), is_deep: bool, has_alpha: bool) -> u64 {
        let pixel = match (self, is_deep) {
            (Self::H264, false) => PixelBytes::new(190, 12),
            (Self::H264, true) => PixelBytes::new(340, 20),
            (Self::Hevc, false) => PixelBytes::new(200, 12),
            (Self::Hevc, true) => PixelBytes::new(310, 20),
            (Self::ProRes, _) if has_alpha => PixelBytes::new(45, 12),
            (Self::ProRes, _) => PixelBytes::new(9, 5),
            (Self::DnxHr, _) => PixelBytes::new(50, 34),
            (Self::Ffv1, _) => PixelBytes::new(182, 0),
            (Self::Av1, false) => PixelBytes::new(250, 5),
            (Self::Av1, true) => PixelBytes::new(380, 7),
            (Self::Vp9, false) if has_alpha => PixelBytes::new(300, 13),
            (Self::Vp9, false) => PixelBytes::new(155, 7),
            (Self::Vp9, true) => PixelBytes::new(300, 15),
        };
        let threads = match self {
            // One for two rows of macroblocks at most (x264, `encoder/encoder.c`).
            Self::H264 => (cores * 3 / 2).min(size.1.div_ceil(16) / 2).clamp(1, 128),
            // It works on no more frames at a time.
            Self::Hevc => cores.min(6),
            // A frame each (ffmpeg, `frame_thread_encoder.c`).
            Self::ProRes | Self::DnxHr => cores.min(64),
            Self::Ffv1 | Self::Av1 | Self::Vp9 => cores.min(MOST_THREADS),
        };
        let fixed = match self {
            Self::Hevc | Self::Av1 => 60 << 20,
            Self::Vp9 => 66 << 20,
            _ => FIXED,
        };
        pixel.of_frame(size, threads, fixed)
    }
}

impl VideoInfo {
    /// Returns the bytes that its decoder holds with so many threads, about; 0 threads are as many as ffmpeg thinks right.
    pub fn decoding_bytes(&self, threads: usize) -> u64 {
        let is_deep = self.bits > 8;
        let pixel = match self.codec.as_str() {
            "prores" => PixelBytes::new(38, 4),
            "dnxhd" => PixelBytes::new(12, 4),
            "mjpeg" | "rawvideo" => PixelBytes::new(10, 0),
            "ffv1" | "huffyuv" | "ffvhuff" | "utvideo" => PixelBytes::new(22, 0),
            "av1" => PixelBytes::new(30, 1),
            _ => PixelBytes::new(22, 3),
        };
        // Samples take twice as much, and filters make a frame of all of them beside. ProRes has no others.
        let is_doubled = is_deep && self.codec != "prores";
        let pixel = if is_doubled { PixelBytes::new(pixel.alone + 44, pixel.thread + 2) } else { pixel };
        let threads = if threads == 0 { (cores() + 1).min(MOST_THREADS) } else { threads };
        pixel.of_frame(self.coded_size, threads, FIXED)
    }
}

/// Bytes of ffmpeg itself, of whose libraries two that run at once share half, and of most codecs beside what goes with the size.
const FIXED: u64 = 38 << 20;

/// Threads of a decoder at most, where nobody tells.
const MOST_THREADS: usize = 16;

/// Returns the processors on which a program may run, as ffmpeg counts them: it does not know that a control group has fewer.
fn cores() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
    list.and_then(listed).unwrap_or_else(|| available_parallelism().map_or(1, usize::from))
}

/// Counts the numbers of a list such as `0-3,6`.
fn listed(list: &str) -> Option<usize> {
    let count = |range: &str| {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        let (first, last): (usize, usize) = (first.parse().ok()?, last.parse().ok()?);
        (last.checked_sub(first)?).checked_add(1)
    };
    list.trim().split(',').map(count).try_fold(0_usize, |all, count| all.checked_add(count?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_frames_take_gigabytes_and_more_on_many_processors() {
        let bytes = |codec: Codec, cores| codec.encoding_bytes_on(cores, (8192, 8192), false, false) >> 30;
        assert_eq!([2, 16, 256].map(|cores| bytes(Codec::H264, cores)), [14, 29, 107]);
        assert_eq!([2, 16, 256].map(|cores| bytes(Codec::ProRes, cores)), [1, 5, 20]);
        let small = |codec: Codec| codec.encoding_bytes((64, 32), true, false);
        assert!(Codec::ALL.iter().all(|codec| (FIXED..80 << 20).contains(&small(*codec))));
        assert_eq!(Codec::H264.encoding_bytes((usize::MAX, usize::MAX), true, false), u64::MAX);
    }

    #[test]
    fn processors_are_counted() {
        assert_eq!(
            ["\t0", "0-3,6", "2-2,4-5", "x", "3-1", ""].map(listed),
            [Some(1), Some(5), Some(3), None, None, None]
        );
        assert!(cores() > 0);
    }
}
