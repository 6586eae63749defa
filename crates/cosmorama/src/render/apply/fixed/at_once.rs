//! Windows that are applied as soon as they are weighed, if no plan is kept and nothing is mirrored.
//!
//! Pixels are those that a plan makes: weights are rounded likewise, and integers have the same sum in any order.

use std::ops::Range;

use fearless_simd::{Simd, i16x8, i16x16, i16x32, i32x4, i32x16, prelude::*, u8x64, u16x16};

use super::quantize::{Rounding, scale, turned};
use crate::render::apply::lane_shapes::turned_bits;
use crate::render::apply::texels::{Strips, Texels, prefetch};
use crate::render::batch::window::Windows;
use crate::render::scan::tile::SIDE;

/// Rounded weights of the windows of a run, which have at most [`SIDE`] columns and rows. Each row is filled up with
/// zeros to [`SIDE`] weights.
#[derive(Default)]
pub(crate) struct FreshWeights {
    /// Number of bits by which weights are scaled.
    bits: u32,
    size: [usize; 2],
    /// Weights by lane, row and column.
    weights: [[[i16; SIDE]; SIDE]; SIDE],
    /// Bits of the columns with texels under the pixel, by row and lane.
    under: [[u8; SIDE]; SIDE],
    /// Rows that have some, and those between.
    rows_under: Range<usize>,
}

/// Number of samples of a row of [`SIDE`] texels, and of half of it.
const ROW: usize = 4 * SIDE;
const HALF: usize = ROW / 2;

/// Order of the bytes of two texels as pairs of one channel.
static PAIRS: [u8; 16] = [0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15];

/// Order of the bytes of eight weights: each pair of them once for each channel.
static SPREAD: [u8; 2 * ROW] = {
    let (mut bytes, mut at) = ([0; 2 * ROW], 0);
    while at < bytes.len() {
        bytes[at] = (at / 16 * 4 + at % 4) as u8;
        at += 1;
    }
    bytes
};

/// Signs of the samples of those of four texels that do not lie under the pixel, for each set of those that do.
static BEYOND: [[i16; HALF]; 16] = {
    let (mut signs, mut at) = ([[0; HALF]; 16], 0);
    while at < 16 * HALF {
        let (under, sample) = (at / HALF, at % HALF);
        signs[under][sample] = if under >> (sample / 4) & 1 == 1 { 0 } else { i16::MIN };
        at += 1;
    }
    signs
};

impl FreshWeights {
    /// Rounds weights; false if the windows or their weights are too large, or too near the right edge of their view.
    #[inline(always)]
    pub(crate) fn take<S: Simd>(
        &mut self,
        simd: S,
        texels: &Texels<i16, 1, 0>,
        (lanes, windows): (u8, &Windows),
    ) -> bool {
        let (width, height) = (windows.width(), windows.height());
        let Some(bits) = scale(windows.size()).filter(|_| width.max(height) <= SIDE) else { return false };
        let end = windows.columns_within().end;
        for lane in 0..SIDE {
            if lanes >> lane & 1 == 1 && windows.corner(lane).is_none_or(|[column, _]| column + SIDE as u32 > end) {
                return false;
            }
        }
        // Texels come while weights are rounded. Rows of three windows lie on nearly all cache lines of the eight.
        for first in [0, SIDE / 2, SIDE - 1].into_iter().filter_map(|lane| windows.corner(lane)) {
            if first[0] + SIDE as u32 <= end {
                for [row] in texels.strips::<SIDE, ROW>(first, height) {
                    prefetch(row, 0);
                    prefetch(row, ROW as u32 - 1);
                }
            }
        }
        let mut rounding = Rounding::new(simd, bits);
        let rows = windows.weights().chunks_exact(width).zip(windows.under().chunks_exact(width));
        for (row, (weights, under)) in rows.enumerate().take(SIDE) {
            let (mut columns, mut columns_under) = ([i16x8::splat(simd, 0); SIDE], [0; SIDE]);
            for column in 0..SIDE {
                if column < width {
                    columns[column] = rounding.next(simd, &weights[column]);
                    columns_under[column] = under[column];
                }
            }
            for (lane, weights) in turned(columns).into_iter().enumerate() {
                weights.store_array(&mut self.weights[lane][row]);
            }
            self.under[row] = turned_bits(columns_under);
        }
        (self.bits, self.size, self.rows_under) = (bits, [width, height], windows.rows_under());
        true
    }

    /// Sums the light of the windows in these lanes.
    #[inline(always)]
    pub(crate) fn light<S: Simd>(
        &self,
        simd: S,
        texels: &Texels<i16, 1, 0>,
        (lanes, windows): (u8, &Windows),
        is_bounded: bool,
    ) -> [[i32; 4]; SIDE] {
        let mut light = [[0; 4]; SIDE];
        let rows_under = if is_bounded { self.rows_under.clone() } else { 0..0 };
        let all_under = self.under[rows_under.clone()].as_flattened().iter().fold(0, |all, columns| all | columns);
        for (lane, light) in light.iter_mut().enumerate() {
            if let Some(first) = windows.corner(lane).filter(|_| lanes >> lane & 1 == 1) {
                let rows = texels.strips::<SIDE, ROW>(first, self.size[1]);
                *light = if all_under < 16 {
                    self.average::<S, 1>(simd, lane, rows, &rows_under)
                } else {
                    self.average::<S, 2>(simd, lane, rows, &rows_under)
                };
            }
        }
        light
    }

    /// Sums the light of a lane's window, within the bounds of the texels under the pixel, if any rows have some. They
    /// lie in the first `HALVES` halves of each row.
    #[inline(always)]
    fn average<S: Simd, const HALVES: usize>(
        &self,
        simd: S,
        lane: usize,
        rows: Strips<i16, 1, ROW>,
        rows_under: &Range<usize>,
    ) -> [i32; 4] {
        let pairs = u8x64::block_splat(PAIRS.simd_into(simd));
        let spread = u8x64::load_array_ref(simd, &SPREAD);
        let mut sums = i32x16::splat(simd, 0);
        let [least, greatest] = if rows_under.is_empty() { [0, i16::MAX] } else { [i16::MAX, 0] };
        let mut greatest = i16x16::splat(simd, greatest);
        let mut least = u16x16::splat(simd, least.cast_unsigned());
        for (row, [texels]) in rows.enumerate() {
            let texels = i16x32::load_array_ref(simd, texels);
            let weights = i16x32::block_splat(i16x8::load_array_ref(simd, &self.weights[lane][row % SIDE]));
            let weights = weights.swizzle_dyn_within_blocks(spread);
            sums += texels.swizzle_dyn_within_blocks(pairs).pairwise_dot_product(weights);
            if rows_under.contains(&row) {
                let (first, last) = texels.split();
                let under = usize::from(self.under[row % SIDE][lane]);
                for (half, texels) in [first, last].into_iter().enumerate().take(HALVES) {
                    // The sign makes samples less than all those under the pixel, or greater in unsigned numbers.
                    let samples = texels | i16x16::load_array_ref(simd, &BEYOND[under >> (4 * half) & 15]);
                    greatest = greatest.max(samples);
                    least = least.min(samples.bitcast::<u16x16<S>>());
                }
            }
        }
        let (a, b) = sums.split();
        let (a, b) = (a + b).split();
        let sum: i32x4<S> = (a + b + (1 << (self.bits - 1))) >> self.bits;
        let (a, b) = greatest.split();
        let (a, b) = a.max(b).widen();
        let most = a.max(b);
        let (a, b) = least.split();
        let (a, b) = a.min(b).widen();
        let fewest = a.min(b).bitcast::<i32x4<S>>();
        sum.max(fewest).min(most).to_array()
    }
}
