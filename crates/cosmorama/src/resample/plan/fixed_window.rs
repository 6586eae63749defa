//! Windows of integers, in mirrors that go through them one way or the other, pair by pair.

use std::ops::Range;

use fearless_simd::{Simd, i16x8, prelude::*};

use super::blocks::Blocks;
use super::fixed_turned::TurnedWindow;
use super::fixed_weights::{Header, PAIRS_UNDER, ROWS_UNDER, Shape, mark_words};
use super::texels::{self, Texels};

/// A pixel's window in G times N mirrors, in the last R of each N from right to left; in the last N, if these are `TURNED`, its rows are
/// columns.
#[derive(Clone, Copy)]
pub(super) struct Window<
    'a,
    S: Simd,
    V: Blocks<S, N>,
    const N: usize,
    const R: usize,
    const G: usize,
    const TURNED: bool,
> {
    pub(super) simd: S,
    /// From texels to pairs of a channel.
    pub(super) order: V::Bytes,
    /// Those of the view.
    pub(super) texels: &'a [Texels<'a, i16, N, R>; G],
    /// Where it begins.
    pub(super) first: [u32; 2],
}

impl<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize, const G: usize, const TURNED: bool>
    Window<'_, S, V, N, R, G, TURNED>
{
    /// Sums over a window of one of the sizes of [`Shape::SMALL`], and how many numbers tell of it. Written out: loops would stay
    /// loops.
    #[inline(always)]
    pub(super) fn small<const WIDTH: usize, const HEIGHT: usize, const UNDER: usize>(
        self,
        header: Header,
        numbers: &[u32],
    ) -> ([Sums<S, V, N>; G], usize) {
        debug_assert_eq!(
            Shape::SMALL.get(header.shape() as usize),
            Some(&Shape { pairs: WIDTH / 2, height: HEIGHT, under: UNDER }),
            "the table's order is that of the match"
        );
        let Self { simd, order, texels, first } = self;
        let (weights, marks) = (&numbers[1..][..WIDTH / 2 * HEIGHT], V::pair(simd, header.0));
        let mut sums = [Sums::new(simd); G];
        let upright = |group: usize| SmallWindow::<S, V, N, R, WIDTH, HEIGHT, UNDER> {
            simd,
            order,
            texels: texels[group].windows(first),
            weights,
            marks,
        };
        if G > 1 || !TURNED {
            upright(0).add(&mut sums[0]);
        }
        if TURNED {
            let texels = texels[G - 1].windows([first[1], first[0]]);
            TurnedWindow::<S, V, N, R, WIDTH, HEIGHT, UNDER> { simd, texels, weights, marks }.add(&mut sums[G - 1]);
        } else if G > 1 {
            upright(G - 1).add(&mut sums[G - 1]);
        }
        (sums, 1 + WIDTH / 2 * HEIGHT)
    }

    /// The same of any size, whose rows `under` may hold texels under the pixel.
    #[inline(always)]
    pub(super) fn large(self, shape: Shape, under: Range<usize>, numbers: &[u32]) -> ([Sums<S, V, N>; G], usize) {
        let words = mark_words(shape.pairs);
        let (marks, weights) = numbers[1..].split_at(under.len() * words);
        let large = Large { shape, under, words, marks, weights: &weights[..shape.pairs * shape.height] };
        let Self { simd, order, texels, first } = self;
        let mut sums = [Sums::new(simd); G];
        // Written out: what a loop adds to would lie in memory.
        if G > 1 || !TURNED {
            large.add(simd, (&texels[0], order), first, &mut sums[0]);
        }
        if TURNED {
            large.add_turned(simd, &texels[G - 1], first, &mut sums[G - 1]);
        } else if G > 1 {
            large.add(simd, (&texels[G - 1], order), first, &mut sums[G - 1]);
        }
        (sums, 1 + marks.len() + shape.pairs * shape.height)
    }
}

/// What is known of a window of any size.
pub(super) struct Large<'a> {
    pub(super) shape: Shape,
    under: Range<usize>,
    /// How many numbers tell of a row which texels lie under the pixel.
    words: usize,
    marks: &'a [u32],
    weights: &'a [u32],
}

impl Large<'_> {
    #[inline(always)]
    fn add<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize>(
        &self,
        simd: S,
        (texels, order): (&Texels<i16, N, R>, V::Bytes),
        first: [u32; 2],
        sums: &mut Sums<S, V, N>,
    ) {
        let Shape { pairs, height, .. } = self.shape;
        for row in 0..height {
            let mut rows: [&[i16]; N] = [&[]; N];
            for (image, samples) in rows.iter_mut().enumerate() {
                *samples = texels.row(image, [first[0], first[1] + row as u32], 2 * pairs);
            }
            for pair in 0..pairs {
                let mut blocks = [i16x8::splat(simd, 0); N];
                for image in 0..N {
                    let pair = if image < N - R { pair } else { pairs - 1 - pair };
                    blocks[image] = i16x8::from_slice(simd, &rows[image][8 * pair..][..8]);
                }
                self.add_pair(simd, sums, [row, pair], V::join(blocks).swizzle_dyn_within_blocks(order));
            }
        }
    }

    /// Adds a pair of texels of a row.
    #[inline(always)]
    pub(super) fn add_pair<S: Simd, V: Blocks<S, N>, const N: usize>(
        &self,
        simd: S,
        sums: &mut Sums<S, V, N>,
        [row, pair]: [usize; 2],
        texels: V,
    ) {
        sums.add(texels, V::pair(simd, self.weights[row * self.shape.pairs + pair]), 0);
        if self.under.contains(&row) {
            let marks = V::pair(simd, self.marks[(row - self.under.start) * self.words + pair / 16]);
            sums.bound(simd, texels, marks, pair % 16);
        }
    }
}

/// A window of a small size.
#[derive(Clone, Copy)]
struct SmallWindow<
    'a,
    S: Simd,
    V: Blocks<S, N>,
    const N: usize,
    const R: usize,
    const WIDTH: usize,
    const HEIGHT: usize,
    const UNDER: usize,
> {
    simd: S,
    order: V::Bytes,
    texels: [texels::Window<'a, i16, WIDTH, HEIGHT>; N],
    weights: &'a [u32],
    marks: V,
}

impl<
    S: Simd,
    V: Blocks<S, N>,
    const N: usize,
    const R: usize,
    const WIDTH: usize,
    const HEIGHT: usize,
    const UNDER: usize,
> SmallWindow<'_, S, V, N, R, WIDTH, HEIGHT, UNDER>
{
    #[inline(always)]
    fn add(&self, sums: &mut Sums<S, V, N>) {
        self.add_row(sums, 0);
        self.add_row(sums, 1);
        self.add_row(sums, 2);
        self.add_row(sums, 3);
        if HEIGHT == 5 {
            self.add_row(sums, 4);
        }
    }

    #[inline(always)]
    fn add_row(&self, sums: &mut Sums<S, V, N>, row: usize) {
        let mut rows = [self.texels[0].samples::<16>(row, 0); N];
        for (image, samples) in rows.iter_mut().enumerate() {
            *samples = self.texels[image].samples(row, if image < N - R { 0 } else { WIDTH - 4 });
        }
        let [first, second] = V::two_pairs::<R>(self.simd, rows);
        self.add_pair(sums, row, 0, first);
        self.add_pair(sums, row, 1, second);
        if WIDTH == 6 {
            let mut third = [i16x8::splat(self.simd, 0); N];
            for (image, third) in third.iter_mut().enumerate() {
                let column = if image < N - R { 4 } else { 0 };
                *third = i16x8::load_array_ref(self.simd, self.texels[image].samples(row, column));
            }
            self.add_pair(sums, row, 2, V::join(third));
        }
    }

    #[inline(always)]
    fn add_pair(&self, sums: &mut Sums<S, V, N>, row: usize, pair: usize, texels: V) {
        let texels = texels.swizzle_dyn_within_blocks(self.order);
        let at = WIDTH / 2 * row + pair;
        sums.add(texels, V::pair(self.simd, self.weights[at]), at);
        if (UNDER..UNDER + ROWS_UNDER).contains(&row) && pair < PAIRS_UNDER {
            sums.bound(self.simd, texels, self.marks, (row - UNDER) * PAIRS_UNDER + pair);
        }
    }
}

/// Sums that are made beside each other where a product and a sum are one instruction, so that each waits for others than the last.
/// Elsewhere sums alone are fast, and registers few.
const CHAINS: usize = 3;

/// What adds up over a window.
#[derive(Clone, Copy)]
pub(super) struct Sums<S: Simd, V: Blocks<S, N>, const N: usize> {
    sums: [V::Widened; CHAINS],
    /// The largest samples under the pixel, and the smallest.
    greatest: V,
    least: V,
}

impl<S: Simd, V: Blocks<S, N>, const N: usize> Sums<S, V, N> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        let (black, white) = (V::splat(simd, 0), V::splat(simd, i16::MAX));
        Self { sums: [V::Widened::splat(simd, 0); CHAINS], greatest: black, least: white }
    }

    /// Adds pairs of texels, the ones after the others to another chain.
    #[inline(always)]
    pub(super) fn add(&mut self, texels: V, weights: V, chain: usize) {
        let sum = &mut self.sums[if V::are_products_added(texels.token()) { chain % CHAINS } else { 0 }];
        *sum = V::add_products(*sum, texels, weights);
    }

    /// Notes those of a pair that lie under the pixel: whose bit is not set.
    #[inline(always)]
    pub(super) fn bound(&mut self, simd: S, texels: V, marks: V, bit: usize) {
        let bit = V::splat(simd, 1 << bit);
        let is_under = (marks & bit).simd_eq(V::splat(simd, 0));
        self.greatest = is_under.select(self.greatest.max(texels), self.greatest);
        self.least = is_under.select(self.least.min(texels), self.least);
    }

    /// The sum as light; within what lies under the pixel, if that is asked for.
    #[inline(always)]
    pub(super) fn average(self, simd: S, bits: u32, is_bounded: bool) -> V::Widened {
        let [a, b, c] = self.sums;
        let average = (a + b + c + (1 << (bits - 1))) >> bits;
        // Without a branch: one would be moved to where bounds begin to be found, and keep all texels in registers until then.
        let free = V::Widened::splat(simd, if is_bounded { 0 } else { -1 });
        let ([a, b], [c, d]) = (halves(self.least), halves(self.greatest));
        let (fewest, most) = (a.min(b) & !free, c.max(d) | free & i32::from(i16::MAX));
        average.max(fewest).min(most)
    }
}

/// The samples of each pair, none of which is negative.
#[inline(always)]
fn halves<S: Simd, V: Blocks<S, N>, const N: usize>(samples: V) -> [V::Widened; 2] {
    let pairs: V::Widened = samples.bitcast();
    [pairs & i32::from(i16::MAX), pairs >> 16]
}
