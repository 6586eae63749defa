//! Whole frames between planes of YUV and pixels of RGB. ffmpeg's own conversion of more than 8 bits ends at 65280 in the place of white.

use cosmorama::raster::Samples;
use rayon::prelude::*;

use super::Coding;

/// Pixels that a thread converts at a time.
const PIECE: usize = 1 << 14;

/// White of 16 bits.
const WHITE: f32 = 65535.0;

impl Coding {
    /// Converts planes of luma, two of chroma and, if pixels have four samples, alpha, to pixels of RGB.
    pub(crate) fn pixels(&self, planes: &[u16], samples: usize, pixels: &mut [u16]) {
        let count = pixels.len() / samples;
        let nearest = |value: f32| (value * WHITE).round().clamp(0.0, WHITE) as u16;
        let plane = |number: usize, at: usize| f32::from(planes[number * count + at]);
        pixels.par_chunks_mut(PIECE * samples).enumerate().for_each(|(piece, pixels)| {
            for (at, pixel) in pixels.chunks_exact_mut(samples).enumerate() {
                let at = piece * PIECE + at;
                let rgb = self.rgb([plane(0, at), plane(1, at), plane(2, at)]);
                pixel.iter_mut().zip(rgb).for_each(|(sample, value)| *sample = nearest(value));
                if let [_, _, _, alpha] = pixel {
                    *alpha = nearest(plane(3, at) / self.most());
                }
            }
        });
    }

    /// Converts a plane of grey to pixels of RGB.
    pub(crate) fn grey_pixels(&self, plane: &[u16], pixels: &mut [u16]) {
        let nearest = |value: f32| (value * WHITE).round().clamp(0.0, WHITE) as u16;
        let pairs = pixels.par_chunks_exact_mut(3).zip(plane.par_iter());
        pairs.for_each(|(pixel, grey)| pixel.fill(nearest(self.grey(f32::from(*grey)))));
    }

    /// Converts pixels of three or four integers to planes of luma, chroma and alpha, one behind the other.
    pub(crate) fn planes(&self, samples: &Samples, channels: usize) -> Vec<u16> {
        match samples {
            Samples::U8(samples) => self.planes_of(samples, channels, |sample| f32::from(sample) / 255.0),
            Samples::U16(samples) => self.planes_of(samples, channels, |sample| f32::from(sample) / WHITE),
            // Frames of floats are refused before.
            Samples::Half(_) | Samples::Float(_) => Vec::new(),
        }
    }

    fn planes_of<S: Copy + Sync>(&self, samples: &[S], channels: usize, value: impl Fn(S) -> f32 + Sync) -> Vec<u16> {
        let count = samples.len() / channels;
        let pixel = |at: usize| &samples[at * channels..(at + 1) * channels];
        let code = |plane: usize, at: usize| match *pixel(at) {
            [_, _, _, alpha] if plane == 3 => self.code(value(alpha) * self.most()),
            [red, green, blue, ..] => self.code(self.yuv([red, green, blue].map(&value))[plane]),
            _ => 0,
        };
        let mut planes = vec![0; count * channels];
        planes.par_chunks_mut(count.max(1)).enumerate().for_each(|(plane, codes)| {
            codes.par_iter_mut().enumerate().with_min_len(PIECE).for_each(|(at, found)| *found = code(plane, at));
        });
        planes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SignalRange;

    #[test]
    fn frames_go_to_planes_and_come_back() {
        let coding = Coding::new(9, SignalRange::Narrow, 10).unwrap();
        let pixels = [[65535, 65535, 65535, 65535], [0, 0, 0, 0], [65535, 0, 0, 32768], [0, 0, 65535, 64]];
        let planes = coding.planes(&Samples::U16(pixels.as_flattened().to_vec()), 4);
        assert_eq!(planes[..2], [940, 64]);
        assert_eq!((planes[4], planes[8], planes[12], planes[13]), (512, 512, 1023, 0));
        let mut back = vec![0; 16];
        coding.pixels(&planes, 4, &mut back);
        for (found, expected) in back.iter().zip(pixels.as_flattened()) {
            assert!(found.abs_diff(*expected) <= 110, "{back:?}");
        }
        assert_eq!(back[..4], [65535; 4]);
        let grey = Coding::new(1, SignalRange::Narrow, 12).unwrap();
        let mut back = vec![0; 6];
        grey.grey_pixels(&[256, 3760], &mut back);
        assert_eq!(back, [0, 0, 0, 65535, 65535, 65535]);
    }
}
