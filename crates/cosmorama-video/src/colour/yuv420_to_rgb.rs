//! Frames of 8 bits with a quarter of the chroma samples, made RGB in integers: cubics through the samples as by ffmpeg's own exact
//! conversion, in a fifth of its time.

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::Coding;
use crate::ChromaPlace;

/// Relation of planes of YUV, of which those of chroma have half the columns and half the rows, to pixels of RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Yuv420ToRgb {
    factors: Factors,
    place: ChromaPlace,
}

/// Terms of red, green and blue, in parts of [`ONE`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Factors {
    /// Sum's constant part, with half a code for rounding.
    zero: i32,
    luma: i32,
    /// Terms of a step of chroma, of which a code has [`STEPS`].
    red_v: i32,
    green_u: i32,
    green_v: i32,
    blue_u: i32,
}

/// Bits of the fraction of a sum, and a code in it.
const FRACTION: u32 = 16;
const ONE: i32 = 1 << FRACTION;

/// Parts of a code in which chroma is interpolated.
const STEPS: i16 = 16;

/// Chroma code of no colour.
const NEUTRAL: i16 = 128;

/// Samples by which a row of chroma is continued at either end.
const BEYOND: usize = 2;

/// Rows that a thread converts at a time.
const ROWS: usize = 32;

/// Sample between two others, by these and the next ones on both sides: a cubic through them (Catmull and Rom).
#[derive(Clone, Copy)]
struct Between {
    /// First of the four samples, seen from that of the pair to which the pixel belongs.
    first: isize,
    /// Weights in parts of [`WHOLE`].
    weights: [i16; 4],
}

/// Sum of four weights.
const WHOLE: i16 = 128;

impl Between {
    /// Returns the interpolation for the first or second pixel of a pair, whose sample lies between them, or on the first.
    fn of(is_second: bool, is_between: bool) -> Self {
        match (is_second, is_between) {
            (false, true) => Self { first: -2, weights: [-3, 29, 111, -9] },
            (true, true) => Self { first: -1, weights: [-9, 111, 29, -3] },
            (false, false) => Self { first: -1, weights: [0, WHOLE, 0, 0] },
            (true, false) => Self { first: -1, weights: [-8, 72, 72, -8] },
        }
    }

    /// Returns the place of the first sample of a continued row.
    #[inline(always)]
    fn begin(self) -> usize {
        BEYOND.saturating_add_signed(self.first)
    }

    /// Returns the sum of four samples from this one on.
    #[inline(always)]
    fn step(self, samples: &[i16], k: usize) -> i16 {
        let [a, b, c, d] = self.weights;
        let near = i32::from(b) * i32::from(samples[k + 1]) + i32::from(c) * i32::from(samples[k + 2]);
        let far = i32::from(a) * i32::from(samples[k]) + i32::from(d) * i32::from(samples[k + 3]);
        ((near + far + i32::from(WHOLE / 2)) >> WHOLE.trailing_zeros()) as i16
    }
}

impl Yuv420ToRgb {
    /// Creates the relation from one of 8 bits.
    pub(crate) fn new(coding: &Coding, place: ChromaPlace) -> Self {
        let neutral = f32::from(NEUTRAL);
        let (black, white) = (coding.grey(0.0), coding.grey(255.0));
        let of_chroma = |u: f32, v: f32| coding.rgb([0.0, neutral + u, neutral + v]).map(|value| value - black);
        let ([_, green_u, blue_u], [red_v, green_v, _]) = (of_chroma(127.0, 0.0), of_chroma(0.0, 127.0));
        let of_code = |value: f32| (value * 255.0 * ONE as f32).round() as i32;
        let of_step = |value: f32| of_code(value / (127.0 * f32::from(STEPS)));
        Self {
            factors: Factors {
                zero: of_code(black) + ONE / 2,
                luma: of_code((white - black) / 255.0),
                red_v: of_step(red_v),
                green_u: of_step(green_u),
                green_v: of_step(green_v),
                blue_u: of_step(blue_u),
            },
            place,
        }
    }

    /// Converts planes of luma and two of chroma, one behind the other, to pixels.
    pub(crate) fn pixels(&self, planes: &[u8], (width, height): (usize, usize), pixels: &mut [u8]) {
        let (luma, chroma) = planes.split_at(width * height);
        let (columns, rows) = (width.div_ceil(2), height.div_ceil(2));
        let (u, v) = chroma.split_at(columns * rows);
        let level = Level::new();
        pixels.par_chunks_mut(3 * width * ROWS).enumerate().for_each(|(part, pixels)| {
            let mut row = Row::new(columns);
            for (index, pixels) in pixels.chunks_exact_mut(3 * width).enumerate() {
                let j = part * ROWS + index;
                let luma = &luma[j * width..][..width];
                dispatch!(level, _simd => {
                    row.interpolate([u, v], j, self.place);
                    row.convert(luma, &self.factors, pixels);
                });
            }
        });
    }
}

/// A row while it is converted.
struct Row {
    /// Chroma of the row in half the columns, continued at both ends.
    narrow: Vec<i16>,
    /// U and V in all columns.
    chroma: [Vec<i16>; 2],
    /// Red, green and blue.
    colours: [Vec<u8>; 3],
}

impl Row {
    fn new(columns: usize) -> Self {
        let chroma = || vec![0; 2 * columns];
        let colour = || vec![0; 2 * columns];
        Self {
            narrow: vec![0; columns + 2 * BEYOND],
            chroma: [chroma(), chroma()],
            colours: [colour(), colour(), colour()],
        }
    }

    /// Interpolates the chroma of a row of luma.
    #[inline(always)]
    fn interpolate(&mut self, planes: [&[u8]; 2], j: usize, place: ChromaPlace) {
        let columns = self.narrow.len() - 2 * BEYOND;
        let down = Between::of(j % 2 == 1, place != ChromaPlace::TopLeft);
        for (plane, chroma) in planes.into_iter().zip(&mut self.chroma) {
            let last = plane.len() / columns - 1;
            let rows = [0, 1, 2, 3].map(|index| {
                let row = (j / 2).saturating_add_signed(down.first + index).min(last);
                &plane[row * columns..][..columns]
            });
            mix_rows(rows, down.weights, &mut self.narrow[BEYOND..BEYOND + columns]);
            let (first, last) = (self.narrow[BEYOND], self.narrow[columns + BEYOND - 1]);
            self.narrow[..BEYOND].fill(first);
            self.narrow[columns + BEYOND..].fill(last);
            let is_between = place == ChromaPlace::Centre;
            mix_columns(&self.narrow, Between::of(false, is_between), Between::of(true, is_between), chroma);
        }
    }

    /// Converts the row to pixels.
    #[inline(always)]
    fn convert(&mut self, luma: &[u8], factors: &Factors, pixels: &mut [u8]) {
        let [u, v] = &self.chroma;
        let [red, green, blue] = &mut self.colours;
        let width = luma.len();
        let (u, v) = (&u[..width], &v[..width]);
        let (red, green, blue) = (&mut red[..width], &mut green[..width], &mut blue[..width]);
        for i in 0..width {
            let (u, v) = (i32::from(u[i]), i32::from(v[i]));
            let grey = i32::from(luma[i]) * factors.luma + factors.zero;
            red[i] = code_of(grey + v * factors.red_v);
            green[i] = code_of(grey + u * factors.green_u + v * factors.green_v);
            blue[i] = code_of(grey + u * factors.blue_u);
        }
        let (pixels, _) = pixels.as_chunks_mut::<3>();
        let colours = red.iter().zip(green.iter()).zip(blue.iter());
        for (pixel, ((red, green), blue)) in pixels.iter_mut().zip(colours) {
            *pixel = [*red, *green, *blue];
        }
    }
}

/// Returns the nearest code.
#[inline(always)]
fn code_of(sum: i32) -> u8 {
    (sum >> FRACTION).clamp(0, 255) as u8
}

/// Mixes four rows of codes into steps around no colour.
#[inline(always)]
fn mix_rows([a, b, c, d]: [&[u8]; 4], weights: [i16; 4], into: &mut [i16]) {
    let count = into.len();
    let (a, b, c, d) = (&a[..count], &b[..count], &c[..count], &d[..count]);
    for k in 0..count {
        let near = weights[1] * (i16::from(b[k]) - NEUTRAL) + weights[2] * (i16::from(c[k]) - NEUTRAL);
        let far = weights[0] * (i16::from(a[k]) - NEUTRAL) + weights[3] * (i16::from(d[k]) - NEUTRAL);
        into[k] = (near + far + WHOLE / STEPS / 2) >> (WHOLE / STEPS).trailing_zeros();
    }
}

/// Mixes four columns into each of two.
#[inline(always)]
fn mix_columns(narrow: &[i16], even: Between, odd: Between, into: &mut [i16]) {
    let (pairs, _) = into.as_chunks_mut::<2>();
    let count = pairs.len();
    let (even_at, odd_at) = (&narrow[even.begin()..], &narrow[odd.begin()..]);
    let (even_at, odd_at) = (&even_at[..count + 3], &odd_at[..count + 3]);
    for (k, pair) in pairs.iter_mut().enumerate() {
        *pair = [even.step(even_at, k), odd.step(odd_at, k)];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SignalRange;

    const PLACES: [ChromaPlace; 3] = [ChromaPlace::Left, ChromaPlace::Centre, ChromaPlace::TopLeft];

    fn coding(matrix: u8, range: SignalRange) -> Coding {
        Coding::new(matrix, range, 8).unwrap()
    }

    /// Asserts that pixels are those of the closed form, to a hundredth of a code beside the rounding.
    fn assert_near(coding: &Coding, yuv: [f32; 3], pixel: &[u8]) {
        for (found, value) in pixel.iter().zip(coding.rgb(yuv)) {
            let expected = (255.0 * value).clamp(0.0, 255.0);
            assert!((f32::from(*found) - expected).abs() < 0.51, "{yuv:?}: {pixel:?}");
        }
    }

    #[test]
    fn a_constant_frame_stays_constant_to_the_code() {
        for (matrix, range) in [(1, SignalRange::Narrow), (6, SignalRange::Full), (9, SignalRange::Narrow)] {
            for (at, place) in (0..300_usize).zip(PLACES.into_iter().cycle()) {
                let yuv = [at * 7 % 256, at * 31 % 256, at * 57 % 256].map(|code| code as u8);
                let (width, height) = (1 + at % 40, 1 + at % 7);
                let chroma = width.div_ceil(2) * height.div_ceil(2);
                let planes = [vec![yuv[0]; width * height], vec![yuv[1]; chroma], vec![yuv[2]; chroma]].concat();
                let mut pixels = vec![0; 3 * width * height];
                let coding = coding(matrix, range);
                Yuv420ToRgb::new(&coding, place).pixels(&planes, (width, height), &mut pixels);
                assert!(pixels.chunks(3).all(|pixel| *pixel == pixels[..3]), "{yuv:?}");
                assert_near(&coding, yuv.map(f32::from), &pixels[..3]);
            }
        }
    }

    #[test]
    fn chroma_that_rises_evenly_is_read_where_it_lies() {
        let (width, height) = (64, 2 * ROWS + 6);
        let at = |x: f32, y: f32| [100.0 + x / 2.0, 100.0 + y / 2.0];
        for place in PLACES {
            let beside = if place == ChromaPlace::Centre { 0.5 } else { 0.0 };
            let below = if place == ChromaPlace::TopLeft { 0.0 } else { 0.5 };
            let sample = |axis: usize, index: usize| {
                let (column, row) = (index % (width / 2), index / (width / 2));
                at(2.0 * column as f32 + beside, 2.0 * row as f32 + below)[axis].round() as u8
            };
            let chroma = |axis: usize| (0..width * height / 4).map(|index| sample(axis, index)).collect();
            let planes = [vec![120; width * height], chroma(0), chroma(1)].concat();
            let mut pixels = vec![0; 3 * width * height];
            let coding = coding(1, SignalRange::Full);
            Yuv420ToRgb::new(&coding, place).pixels(&planes, (width, height), &mut pixels);
            for (index, pixel) in pixels.chunks(3).enumerate() {
                let (i, j) = (index % width, index / width);
                if !(4..width - 4).contains(&i) || !(4..height - 4).contains(&j) {
                    continue;
                }
                let [u, v] = at(i as f32, j as f32);
                let expected = coding.rgb([120.0, u, v]);
                // Samples are rounded to whole codes, of which blue takes 1.9.
                let error = pixel.iter().zip(expected).map(|(found, value)| (f32::from(*found) - 255.0 * value).abs());
                assert!(error.fold(0.0, f32::max) < 1.6, "{place:?} {i} {j}: {pixel:?} {expected:?}");
            }
        }
    }
}
