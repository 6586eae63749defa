//! Plans in integers: for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights 16; their products are added in 32, so that the result is the same on every machine. Two texels
//! beside each other are worked on together, red, green, blue and nothing of each, in a block of 128 bits for each mirror: the
//! product of pairs is then a weighted sum of two texels, and weights are spread once for all mirrors.

use fearless_simd::{Level, Simd, dispatch, f32x4, i16x8, i16x16, i16x32, i32x4, prelude::*};

use super::band::{Band, Run};
use super::blocks::{self, Blocks};
use super::canvas::Canvas;
use super::fixed_weights::{FixedWeights, Header, ROWS_UNDER, Shape, mark_words};
use super::mirrors::{MOST_IMAGES, Mirrors};
use super::prefetch::{prefetch_patch, prefetch_weights};
use super::singles::Palette;
use super::texels::{PairWindow, Texels, prefetch};
use super::view_texels::ViewTexels;
use crate::raster::{FixedCodec, FixedLight, Rgba};
use crate::resample::patch::SIDE;

/// Makes the pixels of a band.
pub(super) struct FixedFilter<'a> {
    pub(super) level: Level,
    pub(super) mirrors: &'a Mirrors,
    pub(super) light: &'a FixedLight,
    pub(super) codec: &'a FixedCodec,
    pub(super) anti_ringing: bool,
}

impl FixedFilter<'_> {
    pub(super) fn fill(&self, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
        let level = self.level;
        dispatch!(level, simd => {
            self.runs(simd, band, canvas);
            band.singles.fill(simd, self.mirrors, (self, self.anti_ringing), canvas);
        });
    }

    // No closures below but those that `vectorize` takes: the compiler gives others no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
        if band.runs.is_empty() {
            return;
        }
        let mut ahead = band.patches().skip(1);
        let texels = self.light.as_laid_out();
        let views = ViewTexels::all(self.mirrors, self.light.samples());
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                let next = ahead.next().unwrap_or(&[]);
                prefetch_patch(texels, self.mirrors, next);
                // Of a frame by plan this gains nothing, of a single picture a fiftieth.
                canvas.prefetch(self.mirrors, next);
            }
            let numbers = &band.weights.numbers[run.weights as usize..];
            let pixels = self.pixels(simd, run, &views[usize::from(run.view)], numbers);
            for (image, pixels) in self.mirrors.images.iter().zip(&pixels) {
                canvas.put(image, run, pixels);
            }
        }
    }

    /// The pixels of a run in each mirror. What is called from here on is compiled by itself: among all that makes a band its loop
    /// would lack registers.
    #[inline(never)]
    fn pixels<S: Simd>(&self, simd: S, run: &Run, texels: &ViewTexels<i16>, numbers: &[u32]) -> Pixels {
        let mut pixels = [[[0; 3]; SIDE]; MOST_IMAGES];
        let order = &self.mirrors.ways(usize::from(run.view)).order;
        let run_filter = RunFilter { simd, filter: self, run, numbers };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match texels {
            ViewTexels::Four(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x32<S>, 4, 2>(texels, order, &mut pixels),
            ),
            ViewTexels::Two(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x16<S>, 2, 1>(texels, order, &mut pixels),
            ),
            ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
                #[inline(always)]
                || {
                    for (texels, order) in forward.iter().zip(order) {
                        run_filter.pixels::<i16x8<S>, 1, 0>(texels, std::slice::from_ref(order), &mut pixels);
                    }
                    for (texels, order) in reversed.iter().zip(&order[forward.len()..]) {
                        run_filter.pixels::<i16x8<S>, 1, 1>(texels, std::slice::from_ref(order), &mut pixels);
                    }
                },
            ),
        }
        pixels
    }
}

impl Palette for FixedFilter<'_> {
    type Pixel = [u8; 3];

    fn rgba(&self, texel: u32) -> Rgba {
        FixedLight::light(self.light.as_laid_out()[texel as usize])
    }

    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S> {
        let [red, green, blue, _] = self.light.as_laid_out()[texel as usize];
        let samples = i32x4::load_array(simd, [red, green, blue, 0].map(i32::from));
        let light = f32x4::float_from(samples) / FixedLight::WHITE;
        light + f32x4::load_array(simd, [0.0, 0.0, 0.0, 1.0])
    }

    fn pixel(&self, light: Rgba, coverage: f32) -> [u8; 3] {
        self.codec.codes_of((light * coverage).over(self.codec.background_light()))
    }

    #[inline(always)]
    fn prefetch(&self, texel: u32) {
        prefetch(self.light.as_laid_out(), texel);
    }
}

/// The pixels of a run in each mirror, from left to right as that shows them.
type Pixels = [[[u8; 3]; SIDE]; MOST_IMAGES];

/// What makes the pixels of a run.
#[derive(Clone, Copy)]
struct RunFilter<'a, S> {
    simd: S,
    filter: &'a FixedFilter<'a>,
    run: &'a Run,
    /// Its weights, and more.
    numbers: &'a [u32],
}

impl<S: Simd> RunFilter<'_, S> {
    /// The pixels in N mirrors, which `order` tells; in the last R of them windows are walked through from right to left.
    #[inline(always)]
    fn pixels<V: Blocks<S, N>, const N: usize, const R: usize>(
        self,
        texels: &Texels<i16, N, R>,
        order: &[(usize, usize)],
        pixels: &mut Pixels,
    ) {
        let Self { simd, filter, run, mut numbers } = self;
        let large = Shape { pairs: usize::from(run.width).div_ceil(2), height: usize::from(run.height), under: 0 };
        let codes = filter.codec.tables();
        // Of each lane, in each mirror.
        let mut light = [[[0; 4]; MOST_IMAGES]; SIDE];
        let pairs = V::Bytes::from_slice(simd, blocks::order::<N, R>());
        for lane in run.lanes() {
            let window = Window::<S, V, N, R> { simd, order: pairs, texels, first: run.first(lane) };
            prefetch_weights(numbers);
            let header = Header(numbers[0]);
            let (sums, length) = match header.shape() {
                0 => window.small::<2, 4, 0>(header, numbers),
                1 => window.small::<2, 4, 1>(header, numbers),
                2 => window.small::<2, 5, 1>(header, numbers),
                3 => window.small::<3, 4, 0>(header, numbers),
                4 => window.small::<3, 4, 1>(header, numbers),
                5 => window.small::<3, 5, 1>(header, numbers),
                _ => window.large(large, run, numbers),
            };
            numbers = &numbers[length..];
            let average = sums.average(simd, header.bits(), filter.anti_ringing);
            average.store_slice(&mut light[lane].as_flattened_mut()[..4 * N]);
        }
        // Looked up together, from memory: taken out of vectors one by one, samples would wait for each pixel's sum.
        for (image, (index, flip)) in order.iter().enumerate().take(N) {
            let pixels = &mut pixels[index % MOST_IMAGES];
            // A loop for each direction: that of `lane ^ flip` would find the place of each pixel anew.
            if *flip == 0 {
                for (light, pixel) in light.iter().zip(pixels) {
                    *pixel = codes.of(light[image]);
                }
            } else {
                for (light, pixel) in light.iter().zip(pixels.iter_mut().rev()) {
                    *pixel = codes.of(light[image]);
                }
            }
        }
    }
}

/// A pixel's window in N mirrors, R of them from right to left.
#[derive(Clone, Copy)]
struct Window<'a, S: Simd, V: Blocks<S, N>, const N: usize, const R: usize> {
    simd: S,
    /// From texels to pairs of a channel.
    order: V::Bytes,
    /// Those of the view.
    texels: &'a Texels<'a, i16, N, R>,
    /// Where it begins.
    first: [u32; 2],
}

impl<'a, S: Simd, V: Blocks<S, N>, const N: usize, const R: usize> Window<'a, S, V, N, R> {
    /// Sums over a window of one of the sizes of [`Shape::SMALL`], and how many numbers tell of it. Written out: loops would stay
    /// loops.
    #[inline(always)]
    fn small<const PAIRS: usize, const HEIGHT: usize, const UNDER: usize>(
        self,
        header: Header,
        numbers: &[u32],
    ) -> (Sums<S, V, N>, usize) {
        debug_assert_eq!(
            Shape::SMALL.get(header.shape() as usize),
            Some(&Shape { pairs: PAIRS, height: HEIGHT, under: UNDER }),
            "the table's order is that of the match"
        );
        let (mut sums, weights) = (Sums::new(self.simd), &numbers[1..][..PAIRS * HEIGHT]);
        let Self { simd, order, .. } = self;
        let (texels, marks) = (self.texels.windows::<2, PAIRS, HEIGHT>(self.first), V::pair(simd, header.0));
        let window = SmallWindow::<S, V, N, R, PAIRS, HEIGHT, UNDER> { simd, order, texels, weights, marks };
        window.add_row(&mut sums, 0);
        window.add_row(&mut sums, 1);
        window.add_row(&mut sums, 2);
        window.add_row(&mut sums, 3);
        if HEIGHT == 5 {
            window.add_row(&mut sums, 4);
        }
        (sums, 1 + PAIRS * HEIGHT)
    }

    /// The same of any size, and how many numbers tell of it.
    #[inline(always)]
    fn large(self, Shape { pairs, height, .. }: Shape, run: &Run, numbers: &[u32]) -> (Sums<S, V, N>, usize) {
        let (under, words) = (run.rows_under(), mark_words(pairs));
        let (all_marks, weights) = numbers[1..].split_at(under.len() * words);
        let mut sums = Sums::new(self.simd);
        for row in 0..height {
            let (rows, weights) = (self.row(row, pairs), &weights[row * pairs..][..pairs]);
            for pair in 0..pairs {
                let mut blocks = [i16x8::splat(self.simd, 0); N];
                for image in 0..N {
                    let pair = if image < N - R { pair } else { pairs - 1 - pair };
                    blocks[image] = i16x8::from_slice(self.simd, &rows[image][8 * pair..][..8]);
                }
                let texels = V::join(blocks).swizzle_dyn_within_blocks(self.order);
                sums.add(texels, V::pair(self.simd, weights[pair]));
                if under.contains(&row) {
                    let marks = V::pair(self.simd, all_marks[(row - under.start) * words + pair / 16]);
                    sums.bound(self.simd, texels, marks, pair % 16);
                }
            }
        }
        (sums, 1 + all_marks.len() + height * pairs)
    }

    /// The samples of a row's texels, so many pairs, in each mirror.
    #[inline(always)]
    fn row(&self, row: usize, pairs: usize) -> [&'a [i16]; N] {
        let mut rows: [&'a [i16]; N] = [&[]; N];
        for (image, samples) in rows.iter_mut().enumerate() {
            *samples = self.texels.row(image, [self.first[0], self.first[1] + row as u32], 2 * pairs);
        }
        rows
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
    const PAIRS: usize,
    const HEIGHT: usize,
    const UNDER: usize,
> {
    simd: S,
    order: V::Bytes,
    texels: [PairWindow<'a, PAIRS, HEIGHT>; N],
    weights: &'a [u32],
    marks: V,
}

impl<
    S: Simd,
    V: Blocks<S, N>,
    const N: usize,
    const R: usize,
    const PAIRS: usize,
    const HEIGHT: usize,
    const UNDER: usize,
> SmallWindow<'_, S, V, N, R, PAIRS, HEIGHT, UNDER>
{
    #[inline(always)]
    fn add_row(&self, sums: &mut Sums<S, V, N>, row: usize) {
        let mut rows = [self.texels[0].samples::<16>(row, 0); N];
        for (image, samples) in rows.iter_mut().enumerate() {
            *samples = self.texels[image].samples(row, if image < N - R { 0 } else { PAIRS - 2 });
        }
        let [first, second] = V::two_pairs::<R>(self.simd, rows);
        self.add_pair(sums, row, 0, first);
        self.add_pair(sums, row, 1, second);
        if PAIRS == 3 {
            let mut third = [i16x8::splat(self.simd, 0); N];
            for (image, third) in third.iter_mut().enumerate() {
                let pair = if image < N - R { 2 } else { 0 };
                *third = i16x8::load_array_ref(self.simd, self.texels[image].samples(row, pair));
            }
            self.add_pair(sums, row, 2, V::join(third));
        }
    }

    #[inline(always)]
    fn add_pair(&self, sums: &mut Sums<S, V, N>, row: usize, pair: usize, texels: V) {
        let texels = texels.swizzle_dyn_within_blocks(self.order);
        sums.add(texels, V::pair(self.simd, self.weights[row * PAIRS + pair]));
        if (UNDER..UNDER + ROWS_UNDER).contains(&row) {
            sums.bound(self.simd, texels, self.marks, (row - UNDER) * PAIRS + pair);
        }
    }
}

/// What adds up over a window.
struct Sums<S: Simd, V: Blocks<S, N>, const N: usize> {
    sum: V::Widened,
    /// The largest samples under the pixel, and the smallest.
    greatest: V,
    least: V,
}

impl<S: Simd, V: Blocks<S, N>, const N: usize> Sums<S, V, N> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let (black, white) = (V::splat(simd, 0), V::splat(simd, i16::MAX));
        Self { sum: V::Widened::splat(simd, 0), greatest: black, least: white }
    }

    /// Adds pairs of texels.
    #[inline(always)]
    fn add(&mut self, texels: V, weights: V) {
        self.sum = V::add_products(self.sum, texels, weights);
    }

    /// Notes those of a pair that lie under the pixel: whose bit is not set.
    #[inline(always)]
    fn bound(&mut self, simd: S, texels: V, marks: V, bit: usize) {
        let bit = V::splat(simd, 1 << bit);
        let is_under = (marks & bit).simd_eq(V::splat(simd, 0));
        self.greatest = is_under.select(self.greatest.max(texels), self.greatest);
        self.least = is_under.select(self.least.min(texels), self.least);
    }

    /// The sum as light; within what lies under the pixel, if that is asked for.
    #[inline(always)]
    fn average(self, simd: S, bits: u32, is_bounded: bool) -> V::Widened {
        let average = (self.sum + (1 << (bits - 1))) >> bits;
        let (fewest, most) = if is_bounded {
            let ([a, b], [c, d]) = (halves(self.least), halves(self.greatest));
            (a.min(b), c.max(d))
        } else {
            (V::Widened::splat(simd, 0), V::Widened::splat(simd, i32::from(i16::MAX)))
        };
        average.max(fewest).min(most)
    }
}

/// The samples of each pair, none of which is negative.
#[inline(always)]
fn halves<S: Simd, V: Blocks<S, N>, const N: usize>(samples: V) -> [V::Widened; 2] {
    let pairs: V::Widened = samples.bitcast();
    [pairs & i32::from(i16::MAX), pairs >> 16]
}
