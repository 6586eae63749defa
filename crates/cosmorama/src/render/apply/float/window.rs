//! Windows of floats, in mirror images of either direction.
//!
//! Four texels of a row are weighted together, as they lie in memory. The sums of the four columns are added at the
//! end. The order of summation does not depend on the instructions.
//!
//! The bounds of the texels under a pixel are found even without anti-ringing. To leave them out, all this code would
//! be needed twice, for each size, direction and number of mirror images. Rendering takes as long without anti-ringing
//! as with it.

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*, u8x64, u32x4, u32x16};

use super::turned::TurnedWindow;
use super::weights::{BLOCK, FloatFormat, SMALL};
use crate::render::apply::driver::Window;
use crate::render::apply::texels;
use crate::render::plan::window_format::{Kept, ROWS_UNDER, Shape};

/// Number of samples of a texel, and of a block of texels.
pub(crate) const SAMPLES: usize = 4;
pub(crate) const BLOCK_SAMPLES: usize = BLOCK * SAMPLES;

impl<S: Simd, const N: usize, const R: usize> Window<'_, S, f32, N, R> {
    /// Computes the weighted sums of a small window, whose size is one of [`SMALL`], in each mirror image. Returns the
    /// sums, and how many numbers the window takes: a header, and a weight for each texel.
    ///
    /// With `TURNED`, all mirror images have exchanged rows and columns. The code is unrolled by hand, because the
    /// compiler would keep the loops.
    #[inline(always)]
    pub(crate) fn small<const WIDTH: usize, const HEIGHT: usize, const UNDER: usize, const TURNED: bool>(
        self,
    ) -> ([Sum<S>; N], usize) {
        debug_assert_eq!(
            SMALL.get(self.header().shape() as usize),
            Some(&Shape { width: WIDTH, height: HEIGHT, under: UNDER }),
            "the table's order is that of the match"
        );
        let length = 1 + WIDTH * HEIGHT;
        let (marks, weights) = (Marks::new(self.simd, self.header().0 >> 16), &self.numbers[1..length]);
        if TURNED {
            let texels = self.texels.windows([self.first[1], self.first[0]]);
            let window = TurnedWindow::<S, N, R, WIDTH, HEIGHT> { simd: self.simd, texels, weights, marks };
            return (window.sums::<UNDER>(), length);
        }
        let texels = self.texels.windows::<WIDTH, HEIGHT>(self.first);
        let row = SmallRow::<S, N, R, WIDTH, HEIGHT> { simd: self.simd, texels };
        let mut sums = row.first::<UNDER>(weights, marks);
        const { assert!(ROWS_UNDER == 3 && UNDER <= 1 && (HEIGHT == 4 || HEIGHT == 5)) };
        if UNDER == 0 {
            row.add_bounding(&mut sums, weights, 1, marks.beside(1));
        }
        row.add_bounding(&mut sums, weights, 2, marks.beside(2 - UNDER));
        if UNDER == 1 {
            row.add_bounding(&mut sums, weights, 3, marks.beside(2));
        } else {
            row.add(&mut sums, weights, 3);
        }
        if HEIGHT == 5 {
            row.add(&mut sums, weights, 4);
        }
        if WIDTH > BLOCK {
            row.add_last_column(&mut sums, &weights[BLOCK * HEIGHT..]);
        }
        (sums, length)
    }

    /// Sums over a window of any size. Returns the sums, and how many numbers the window takes. If `TURNED`, its rows
    /// are columns in all mirror images.
    #[inline(always)]
    pub(crate) fn large<const TURNED: bool>(self) -> ([Sum<S>; N], usize) {
        let Self { simd, texels, first, .. } = self;
        let kept = Kept::large::<FloatFormat>(self.run, self.numbers);
        let sums = if TURNED { kept.turned(simd, texels, first) } else { kept.upright(simd, texels, first) };
        (sums, kept.length())
    }
}

/// Rows of a window of a small size.
#[derive(Clone, Copy)]
struct SmallRow<'a, S, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize> {
    simd: S,
    texels: [texels::Window<'a, f32, WIDTH, HEIGHT>; N],
}

impl<S: Simd, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize>
    SmallRow<'_, S, N, R, WIDTH, HEIGHT>
{
    /// Index in a row of the texels of the first four columns, and of the column after them: in forward and in reversed
    /// order.
    const BLOCK_AT: [usize; 2] = [0, WIDTH - BLOCK];
    const LAST_AT: [usize; 2] = [WIDTH - 1, 0];

    /// Sums over the first row, and over the first row in which texels may lie under the pixel, if that is another.
    #[inline(always)]
    fn first<const UNDER: usize>(&self, weights: &[u32], marks: Marks<S>) -> [Sum<S>; N] {
        let mut sums = [Sum::zero(self.simd); N];
        let (first, is_beside) = (self.weights(weights, 0), marks.beside(0));
        for (image, sum) in sums.iter_mut().enumerate() {
            let way = way::<N, R>(image);
            sum.blocks = self.block(image, 0) * first[way];
            let texels = self.block(image, UNDER);
            sum.least = is_beside[way].select(sum.least, texels);
            sum.greatest = is_beside[way].select(sum.greatest, texels);
        }
        if UNDER > 0 {
            let weights = self.weights(weights, UNDER);
            for (image, sum) in sums.iter_mut().enumerate() {
                sum.blocks += self.block(image, UNDER) * weights[way::<N, R>(image)];
            }
        }
        sums
    }

    /// Adds a block of a row in which no texel lies under the pixel.
    #[inline(always)]
    fn add(&self, sums: &mut [Sum<S>; N], weights: &[u32], row: usize) {
        let weights = self.weights(weights, row);
        for (image, sum) in sums.iter_mut().enumerate() {
            sum.blocks += self.block(image, row) * weights[way::<N, R>(image)];
        }
    }

    /// Adds a block of a row in which some texels may lie under the pixel.
    #[inline(always)]
    fn add_bounding(&self, sums: &mut [Sum<S>; N], weights: &[u32], row: usize, is_beside: [mask32x16<S>; 2]) {
        let weights = self.weights(weights, row);
        for (image, sum) in sums.iter_mut().enumerate() {
            let texels = self.block(image, row);
            let way = way::<N, R>(image);
            sum.blocks += texels * weights[way];
            sum.bound(texels, is_beside[way]);
        }
    }

    #[inline(always)]
    fn weights(&self, weights: &[u32], row: usize) -> [f32x16<S>; 2] {
        spread(self.simd, &weights.as_chunks().0[row])
    }

    #[inline(always)]
    fn block(&self, image: usize, row: usize) -> f32x16<S> {
        f32x16::load_array_ref(
            self.simd,
            self.texels[image].samples::<BLOCK_SAMPLES>(row, Self::BLOCK_AT[way::<N, R>(image)]),
        )
    }

    /// Adds the column after the blocks.
    #[inline(always)]
    fn add_last_column(&self, sums: &mut [Sum<S>; N], weights: &[u32]) {
        self.add_last(sums, weights, 0);
        self.add_last(sums, weights, 1);
        self.add_last(sums, weights, 2);
        self.add_last(sums, weights, 3);
        if HEIGHT == 5 {
            self.add_last(sums, weights, 4);
        }
    }

    #[inline(always)]
    fn add_last(&self, sums: &mut [Sum<S>; N], weights: &[u32], row: usize) {
        let weight = f32x4::splat(self.simd, f32::from_bits(weights[row]));
        for (image, sum) in sums.iter_mut().enumerate() {
            let texel = self.texels[image].samples::<SAMPLES>(row, Self::LAST_AT[way::<N, R>(image)]);
            sum.last += f32x4::load_array_ref(self.simd, texel) * weight;
        }
    }
}

/// Returns the direction in which a mirror image traverses windows: 1 means from right to left, as the last R of N do.
#[inline(always)]
pub(crate) const fn way<const N: usize, const R: usize>(image: usize) -> usize {
    if image < N - R { 0 } else { 1 }
}

/// Repeats each of four weights for all samples of its texel, in forward and in reversed order.
#[inline(always)]
pub(crate) fn spread<S: Simd>(simd: S, weights: &[u32; BLOCK]) -> [f32x16<S>; 2] {
    let weights: f32x4<S> = u32x4::load_array_ref(simd, weights).bitcast();
    let all = f32x16::block_splat(weights);
    [
        all.swizzle_dyn_within_blocks(u8x64::load_array_ref(simd, &ORDER[0])),
        all.swizzle_dyn_within_blocks(u8x64::load_array_ref(simd, &ORDER[1])),
    ]
}

/// Byte orders that repeat one of four numbers in each block, in forward and in reversed order.
static ORDER: [[u8; 64]; 2] = {
    let mut order = [[0; 64]; 2];
    let mut at = 0;
    while at < 64 {
        let within = (at % 4) as u8;
        order[0][at] = 4 * (at / 16) as u8 + within;
        order[1][at] = 4 * (3 - at / 16) as u8 + within;
        at += 1;
    }
    order
};

/// Bits of the texels of a block that lie under a pixel, for some rows; other bits may follow.
#[derive(Clone, Copy)]
pub(crate) struct Marks<S: Simd>(u32x16<S>);

impl<S: Simd> Marks<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, marks: u32) -> Self {
        Self(u32x16::splat(simd, marks))
    }

    /// Returns the samples of a row's texels that do not lie under the pixel, in forward and in reversed order.
    #[inline(always)]
    pub(crate) fn beside(self, row: usize) -> [mask32x16<S>; 2] {
        [self.without(&MARK.0[0][row]), self.without(&MARK.0[1][row])]
    }

    /// Returns the samples whose bits are not among the marks.
    #[inline(always)]
    pub(crate) fn without(self, bits: &[u32; BLOCK_SAMPLES]) -> mask32x16<S> {
        (self.0 & u32x16::load_array_ref(self.0.token(), bits)).simd_eq(0)
    }
}

/// A value aligned to cache lines.
#[repr(align(64))]
pub(crate) struct Lines<T>(pub(crate) T);

/// Mark bit of the texel of each sample of a block, by order (forward or reversed) and row.
static MARK: Lines<[[[u32; BLOCK_SAMPLES]; ROWS_UNDER]; 2]> = {
    let mut mark = [[[0; BLOCK_SAMPLES]; ROWS_UNDER]; 2];
    let mut at = 0;
    while at < BLOCK_SAMPLES * ROWS_UNDER {
        let (row, sample) = (at / BLOCK_SAMPLES, at % BLOCK_SAMPLES);
        let texel = sample / SAMPLES;
        mark[0][row][sample] = 1 << (BLOCK * row + texel);
        mark[1][row][sample] = 1 << (BLOCK * row + BLOCK - 1 - texel);
        at += 1;
    }
    Lines(mark)
};

/// Sums over a window in a mirror image, and the bounds of the texels under the pixel, by column of the blocks.
#[derive(Clone, Copy)]
pub(crate) struct Sum<S: Simd> {
    pub(crate) blocks: f32x16<S>,
    /// Sum of the texels that are in no block.
    pub(crate) last: f32x4<S>,
    least: f32x16<S>,
    greatest: f32x16<S>,
}

impl<S: Simd> Sum<S> {
    #[inline(always)]
    pub(crate) fn zero(simd: S) -> Self {
        Self {
            blocks: f32x16::splat(simd, 0.0),
            last: f32x4::splat(simd, 0.0),
            least: f32x16::splat(simd, f32::INFINITY),
            greatest: f32x16::splat(simd, f32::NEG_INFINITY),
        }
    }

    /// Updates the bounds by texels, except those that do not lie under the pixel.
    #[inline(always)]
    pub(crate) fn bound(&mut self, texels: f32x16<S>, is_beside: mask32x16<S>) {
        self.least = is_beside.select(self.least, self.least.min(texels));
        self.greatest = is_beside.select(self.greatest, self.greatest.max(texels));
    }

    /// Adds the partial sums of all columns, which makes the filtered pixel. With `is_bounded` it is clamped to the
    /// least and greatest texel under the pixel, which prevents ringing.
    #[inline(always)]
    pub(crate) fn average(&self, is_bounded: bool) -> f32x4<S> {
        let (a, b) = self.blocks.split();
        let (a, b) = (a + b).split();
        let sum = a + b + self.last;
        if !is_bounded {
            return sum;
        }
        let (a, b) = self.least.split();
        let (a, b) = a.min(b).split();
        let least = a.min(b);
        let (a, b) = self.greatest.split();
        let (a, b) = a.max(b).split();
        sum.max(least).min(a.max(b))
    }
}
