//! Memory that ffmpeg's codecs hold beside the program itself: measured of version 5.1, with frames of 1024² to 4096² and 1 to 16 threads
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
    /// Bytes that go with no size: tables, queues of packets.
    const FIXED: u64 = 12 << 20;

    const fn new(alone: u64, thread: u64) -> Self {
        Self { alone, thread }
    }

    fn of_frame(self, (width, height): (usize, usize), threads: usize) -> u64 {
        let pixel = self.alone + self.thread * threads as u64;
        Self::FIXED.saturating_add((width as u64).saturating_mul(height as u64).saturating_mul(pixel))
    }
}

impl Codec {
    /// Returns the bytes that its encoder holds with the arguments of its preset, about, for frames of so many columns and rows: those that
    /// it looks ahead to, and those that its threads work on.
    pub fn encoding_bytes(self, size: (usize, usize), is_deep: bool, has_alpha: bool) -> u64 {
        let pixel = match (self, is_deep) {
            (Self::H264, false) => PixelBytes::new(190, 12),
            (Self::H264, true) => PixelBytes::new(340, 20),
            (Self::Hevc, false) => PixelBytes::new(200, 12),
            (Self::Hevc, true) => PixelBytes::new(340, 20),
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
        let cores = cores();
        let threads = match self {
            Self::H264 => cores + cores / 2,
            // It works on no more frames at a time.
            Self::Hevc => cores.min(6),
            _ => cores.min(MOST_THREADS),
        };
        pixel.of_frame(size, threads)
    }
}

impl VideoInfo {
    /// Returns the bytes that its decoder holds with so many threads, about; 0 threads are as many as ffmpeg thinks right.
    pub fn decoding_bytes(&self, threads: usize) -> u64 {
        let is_deep = self.bits > 8;
        let pixel = match self.codec.as_str() {
            "prores" | "dnxhd" => PixelBytes::new(12, 4),
            "mjpeg" | "rawvideo" => PixelBytes::new(10, 0),
            "ffv1" | "huffyuv" | "ffvhuff" | "utvideo" => PixelBytes::new(22, 0),
            "av1" => PixelBytes::new(30, 1),
            "vp9" | "vp8" => PixelBytes::new(22, 3),
            _ => PixelBytes::new(22, 3),
        };
        // Samples take twice as much, and filters make a frame of all of them beside.
        let pixel = if is_deep { PixelBytes::new(pixel.alone + 24, pixel.thread + 2) } else { pixel };
        let threads = if threads == 0 { (cores() + 1).min(MOST_THREADS) } else { threads };
        pixel.of_frame(self.coded_size, threads)
    }
}

/// Threads of one codec at most, where nobody tells.
const MOST_THREADS: usize = 16;

fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_frames_of_modern_codecs_take_gigabytes() {
        let bytes = |codec: Codec| codec.encoding_bytes((8192, 8192), false, false);
        assert!(bytes(Codec::H264) > 12 << 30 && bytes(Codec::ProRes) < 7 << 30);
        assert!(Codec::H264.encoding_bytes((64, 32), false, false) < 32 << 20);
        assert_eq!(Codec::H264.encoding_bytes((usize::MAX, usize::MAX), true, false), u64::MAX);
    }
}
