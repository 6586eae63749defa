//! Frames of 8 bits made planes of YUV with a quarter of the chroma samples, in integers.

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::Coding;

/// Relation of pixels of RGB to planes of YUV, of which those of chroma have half the columns and half the rows. Their samples lie at the
/// left one of two columns, between two rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RgbToYuv420 {
    luma: Sum,
    chroma: [Sum; 2],
}

/// Sum of red, green and blue, in parts of [`ONE`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sum {
    /// Constant part, with half a code for rounding.
    zero: i32,
    factors: [i32; 3],
}

/// Bits of the fraction of a sum, and a code in it.
const FRACTION: u32 = 16;
const ONE: i32 = 1 << FRACTION;

/// Weights of the pixels of a chroma sample together: 1, 2 and 1 in a row, of two rows.
const WEIGHTS: f32 = 8.0;

/// Rows that a thread converts at a time: an even number.
const ROWS: usize = 32;

impl Sum {
    /// Creates the sum that is an axis of YUV, of red, green and blue with so many codes for each.
    fn new(coding: &Coding, axis: usize, weights: f32) -> Self {
        let parts = |value: f32| (value * ONE as f32).round() as i32;
        let zero = coding.yuv([0.0; 3])[axis];
        let factor = |channel: usize| {
            let mut colour = [0.0; 3];
            colour[channel] = 1.0;
            parts((coding.yuv(colour)[axis] - zero) / (255.0 * weights))
        };
        Self { zero: parts(zero) + ONE / 2, factors: [factor(0), factor(1), factor(2)] }
    }

    #[inline(always)]
    fn code(&self, red: i32, green: i32, blue: i32) -> u8 {
        let [of_red, of_green, of_blue] = self.factors;
        ((self.zero + of_red * red + of_green * green + of_blue * blue) >> FRACTION).clamp(0, 255) as u8
    }
}

impl RgbToYuv420 {
    /// Creates the relation from one of 8 bits.
    pub(crate) fn new(coding: &Coding) -> Self {
        let chroma = |axis| Sum::new(coding, axis, WEIGHTS);
        Self { luma: Sum::new(coding, 0, 1.0), chroma: [chroma(1), chroma(2)] }
    }

    /// Converts pixels to planes of luma and two of chroma, one behind the other.
    pub(crate) fn planes(&self, pixels: &[u8], (width, height): (usize, usize)) -> Vec<u8> {
        let (columns, rows) = (width.div_ceil(2), height.div_ceil(2));
        let mut planes = vec![0; width * height + 2 * columns * rows];
        let (luma, chroma) = planes.split_at_mut(width * height);
        let (u, v) = chroma.split_at_mut(columns * rows);
        let level = Level::new();
        let chroma = u.par_chunks_mut(ROWS / 2 * columns).zip(v.par_chunks_mut(ROWS / 2 * columns));
        let parts = pixels.par_chunks(3 * ROWS * width).zip(luma.par_chunks_mut(ROWS * width)).zip(chroma);
        parts.for_each(|((pixels, luma), (u, v))| {
            let mut pair = Pair::new(width);
            let chroma = u.chunks_exact_mut(columns).zip(v.chunks_exact_mut(columns));
            let pairs = pixels.chunks(6 * width).zip(luma.chunks_mut(2 * width)).zip(chroma);
            for ((pixels, luma), (u, v)) in pairs {
                dispatch!(level, _simd => self.convert(&mut pair, pixels, luma, [u, v]));
            }
        });
        planes
    }

    /// Converts two rows, or one.
    #[inline(always)]
    fn convert(&self, pair: &mut Pair, pixels: &[u8], luma: &mut [u8], chroma: [&mut [u8]; 2]) {
        let width = pair.colours[0].len();
        for (row, (pixels, luma)) in pixels.chunks_exact(3 * width).zip(luma.chunks_exact_mut(width)).enumerate() {
            pair.take(pixels);
            pair.fill_luma(&self.luma, luma);
            pair.add(row == 0);
        }
        if luma.len() == width {
            // The last of an odd number of rows counts twice.
            pair.add(false);
        }
        pair.repeat();
        pair.fill(&self.chroma, chroma);
    }
}

/// Two rows, of which chroma is made.
struct Pair {
    /// Red, green and blue of a row.
    colours: [Vec<u8>; 3],
    /// Sums of red, green and blue in both rows, with the first column before it once more, and the last of an odd number behind it.
    sums: [Vec<u16>; 3],
}

impl Pair {
    fn new(width: usize) -> Self {
        let colour = || vec![0; width];
        let sums = || vec![0; 2 * width.div_ceil(2) + 1];
        Self { colours: [colour(), colour(), colour()], sums: [sums(), sums(), sums()] }
    }

    /// Takes a row apart into its colours.
    #[inline(always)]
    fn take(&mut self, pixels: &[u8]) {
        let [red, green, blue] = &mut self.colours;
        let count = red.len();
        let (pixels, _) = pixels.as_chunks::<3>();
        let (pixels, red, green, blue) = (&pixels[..count], &mut red[..count], &mut green[..count], &mut blue[..count]);
        for i in 0..count {
            [red[i], green[i], blue[i]] = pixels[i];
        }
    }

    /// Makes the luma of the row.
    #[inline(always)]
    fn fill_luma(&self, sum: &Sum, luma: &mut [u8]) {
        let [red, green, blue] = &self.colours;
        let count = luma.len();
        let (red, green, blue) = (&red[..count], &green[..count], &blue[..count]);
        for i in 0..count {
            luma[i] = sum.code(i32::from(red[i]), i32::from(green[i]), i32::from(blue[i]));
        }
    }

    /// Adds the row to the sums, or begins them with it.
    #[inline(always)]
    fn add(&mut self, is_first: bool) {
        for (colours, sums) in self.colours.iter().zip(&mut self.sums) {
            let sums = &mut sums[1..=colours.len()];
            if is_first {
                sums.fill(0);
            }
            for (sum, colour) in sums.iter_mut().zip(colours) {
                *sum += u16::from(*colour);
            }
        }
    }

    /// Repeats the first and the last of so many columns.
    #[inline(always)]
    fn repeat(&mut self) {
        let width = self.colours[0].len();
        for sums in &mut self.sums {
            let last = sums[width];
            sums[width..].fill(last);
            sums[0] = sums[1];
        }
    }

    /// Makes the samples of both axes.
    #[inline(always)]
    fn fill(&self, [of_u, of_v]: &[Sum; 2], [u, v]: [&mut [u8]; 2]) {
        let count = u.len();
        let [red, green, blue] = &self.sums;
        let (red, green, blue) = (&red[..=2 * count], &green[..=2 * count], &blue[..=2 * count]);
        let v = &mut v[..count];
        for k in 0..count {
            let (red, green, blue) = (mixed(red, k), mixed(green, k), mixed(blue, k));
            u[k] = of_u.code(red, green, blue);
            v[k] = of_v.code(red, green, blue);
        }
    }
}

/// Returns the sum of three columns around the first of a pair.
#[inline(always)]
fn mixed(sums: &[u16], k: usize) -> i32 {
    i32::from(sums[2 * k]) + 2 * i32::from(sums[2 * k + 1]) + i32::from(sums[2 * k + 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SignalRange;

    fn assert_near(found: u8, expected: f32) {
        assert!((f32::from(found) - expected).abs() < 0.51, "{found} {expected}");
    }

    #[test]
    fn a_constant_frame_has_the_codes_of_the_closed_form() {
        for (matrix, range) in [(1, SignalRange::Narrow), (6, SignalRange::Full), (9, SignalRange::Narrow)] {
            for at in 0..300_usize {
                let rgb = [at * 7 % 256, at * 31 % 256, at * 57 % 256].map(|code| code as u8);
                let (width, height) = (1 + at % 40, 1 + at % 70);
                let coding = Coding::new(matrix, range, 8).unwrap();
                let planes = RgbToYuv420::new(&coding).planes(&rgb.repeat(width * height), (width, height));
                let (luma, chroma) = planes.split_at(width * height);
                let (u, v) = chroma.split_at(width.div_ceil(2) * height.div_ceil(2));
                let expected = coding.yuv(rgb.map(|code| f32::from(code) / 255.0)).map(|code| code.clamp(0.0, 255.0));
                for (plane, expected) in [luma, u, v].into_iter().zip(expected) {
                    assert!(plane.iter().all(|code| *code == plane[0]));
                    assert_near(plane[0], expected);
                }
            }
        }
    }

    #[test]
    fn chroma_lies_at_the_left_column_between_two_rows() {
        let (width, height) = (40, 2 * ROWS);
        let coding = Coding::new(1, SignalRange::Full, 8).unwrap();
        let blue = |x: f32, y: f32| 60.0 + 2.0 * x + y;
        let pixels: Vec<u8> =
            (0..width * height).flat_map(|at| [40, 40, blue((at % width) as f32, (at / width) as f32) as u8]).collect();
        let planes = RgbToYuv420::new(&coding).planes(&pixels, (width, height));
        for (at, u) in planes[width * height..].iter().take(width * height / 4).enumerate() {
            let (column, row) = (at % (width / 2), at / (width / 2));
            if column > 0 {
                let blue = blue(2.0 * column as f32, 2.0 * row as f32 + 0.5);
                assert_near(*u, coding.yuv([40.0, 40.0, blue].map(|code| code / 255.0))[1]);
            }
        }
    }
}
