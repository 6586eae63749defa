//! Plans in integers: for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights 16; their products are added in 32, so that the result is the same on every machine. Two texels
//! beside each other are worked on together, red, green, blue and nothing of each, in a block of 128 bits for each mirror: the
//! product of pairs is then a weighted sum of two texels, and weights are spread once for all mirrors.

use fearless_simd::{Level, Simd, dispatch, i16x8, i16x16, i16x32, prelude::*};

use super::band::{Band, Run};
use super::blocks::{self, Blocks};
use super::canvas::Canvas;
use super::fixed_weights::{FixedWeights, Header, Shape, mark_words};
use super::mirrors::{MOST_IMAGES, Mirrors, Ways};
use super::prefetch::prefetch;
use super::texels::Texels;
use crate::raster::{FixedCodec, FixedLight};
use crate::resample::patch::SIDE;
use crate::resample::taps::average;

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
        dispatch!(level, simd => self.runs(simd, band, canvas));
        let background = self.codec.background_light();
        for single in &band.singles {
            let colour = average(band.taps(single), |texel| self.light.rgba(texel as usize), self.anti_ringing);
            let image = &self.mirrors.images[usize::from(single.image)];
            let pixel = (colour * single.coverage).over(background);
            *canvas.pixel(image, [single.column as usize, usize::from(single.row)]) = self.codec.codes_of(pixel);
        }
    }

    // No closures below: the compiler gives them no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
        let mut ahead = band.patches().skip(1);
        let texels = self.light.samples().as_chunks::<4>().0;
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                prefetch(texels, self.mirrors, ahead.next().unwrap_or(&[]));
            }
            let numbers = &band.weights.numbers[run.weights as usize..];
            let pixels = self.pixels(simd, run, numbers);
            for (image, pixels) in self.mirrors.images.iter().zip(&pixels) {
                canvas.put(image, run, pixels);
            }
        }
    }

    /// The pixels of a run in each mirror.
    #[inline(always)]
    fn pixels<S: Simd>(&self, simd: S, run: &Run, numbers: &[u32]) -> Pixels {
        let mut pixels = [[[0; 3]; SIDE]; MOST_IMAGES];
        let ways = self.mirrors.ways(usize::from(run.view));
        let run_filter = RunFilter { simd, filter: self, ways, run, numbers };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match (ways.forward, ways.count) {
            (2, 4) if ways.down[..2] == ways.down[2..] => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x32<S>, 4, 2>(0, &mut pixels),
            ),
            (1, 2) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x16<S>, 2, 1>(0, &mut pixels),
            ),
            (forward, count) => simd.vectorize(
                #[inline(always)]
                || {
                    for at in 0..forward {
                        run_filter.pixels::<i16x8<S>, 1, 0>(at, &mut pixels);
                    }
                    for at in forward..count {
                        run_filter.pixels::<i16x8<S>, 1, 1>(at, &mut pixels);
                    }
                },
            ),
        }
        pixels
    }
}

/// The pixels of a run in each mirror, from left to right as that shows them.
type Pixels = [[[u8; 3]; SIDE]; MOST_IMAGES];

/// What makes the pixels of a run.
#[derive(Clone, Copy)]
struct RunFilter<'a, S> {
    simd: S,
    filter: &'a FixedFilter<'a>,
    ways: &'a Ways,
    run: &'a Run,
    /// Its weights, and more.
    numbers: &'a [u32],
}

impl<S: Simd> RunFilter<'_, S> {
    /// The pixels in N mirrors from this one on; in the last R of them windows are walked through from right to left. Of four,
    /// every other one goes from row to row alike.
    #[inline(always)]
    fn pixels<V: Blocks<S, N>, const N: usize, const R: usize>(self, start: usize, pixels: &mut Pixels) {
        let Self { simd, filter, ways, run, mut numbers } = self;
        let order: [(usize, usize); N] = std::array::from_fn(|image| ways.order[start + image]);
        let mut corners = [0; N];
        for image in 0..N {
            let seen = filter.mirrors.images[order[image].0].view(usize::from(run.view));
            corners[image] = seen.walk(run.corner()).first;
        }
        let down = [ways.down[start], ways.down[start + 1 % N]];
        let large = Shape { pairs: usize::from(run.width).div_ceil(2), height: usize::from(run.height), under: 0 };
        let codes = filter.codec.tables();
        let samples = filter.light.samples();
        // Of each lane, in each mirror.
        let mut light = [[[0; 4]; MOST_IMAGES]; SIDE];
        let pairs = V::Bytes::from_slice(simd, blocks::order::<N, R>());
        for lane in run.lanes() {
            let [column, row] = run.offset(lane);
            let rows = [down[0].wrapping_mul(row), down[1].wrapping_mul(row)];
            let mut first = [0; N];
            for image in 0..N {
                let columns = if image < N - R { column } else { -column };
                first[image] = corners[image].wrapping_add_signed(rows[image % 2] + columns);
            }
            let window = Window::<S, V, N, R> { simd, order: pairs, samples, first, down };
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
        for (image, (index, flip)) in order.iter().enumerate() {
            for (lane, light) in light.iter().enumerate() {
                pixels[index % MOST_IMAGES][(lane ^ flip) % SIDE] = codes.of(light[image]);
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
    /// Those of all texels.
    samples: &'a [i16],
    /// Where it begins.
    first: [u32; N],
    /// From one row to the next, in turn.
    down: [i32; 2],
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
        let mut texels = [self.texels::<PAIRS, HEIGHT>(0); N];
        for (image, texels) in texels.iter_mut().enumerate().skip(1) {
            *texels = self.texels(image);
        }
        let (mut sums, marks, weights) = (Sums::zero(self.simd), header.marks(), &numbers[1..][..PAIRS * HEIGHT]);
        let Self { simd, order, .. } = self;
        let row = SmallRow::<S, V, N, R, PAIRS, HEIGHT> { simd, order, texels };
        let marks = |row: usize| marks >> (2 * PAIRS * (row - UNDER));
        if UNDER == 0 {
            row.add::<true>(&mut sums, weights, 0, marks(0));
        } else {
            row.add::<false>(&mut sums, weights, 0, 0);
        }
        row.add::<true>(&mut sums, weights, 1, marks(1));
        row.add::<true>(&mut sums, weights, 2, marks(2));
        if UNDER == 1 {
            row.add::<true>(&mut sums, weights, 3, marks(3));
        } else {
            row.add::<false>(&mut sums, weights, 3, 0);
        }
        if HEIGHT == 5 {
            row.add::<false>(&mut sums, weights, 4, 0);
        }
        (sums, 1 + PAIRS * HEIGHT)
    }

    /// The texels of a mirror.
    #[inline(always)]
    fn texels<const PAIRS: usize, const HEIGHT: usize>(&self, image: usize) -> Texels<'a, PAIRS, HEIGHT> {
        Texels::new(self.samples, self.leftmost(image, PAIRS), self.down[image % 2])
    }

    /// The first texel of a row, whichever way it is walked through.
    #[inline(always)]
    fn leftmost(&self, image: usize, pairs: usize) -> u32 {
        if image < N - R { self.first[image] } else { self.first[image].wrapping_sub(2 * pairs as u32 - 1) }
    }

    /// The same of any size, and how many numbers tell of it.
    #[inline(always)]
    fn large(self, Shape { pairs, height, .. }: Shape, run: &Run, numbers: &[u32]) -> (Sums<S, V, N>, usize) {
        let (rows, words) = (run.rows_under(), mark_words(pairs));
        let (all_marks, weights) = numbers[1..].split_at(rows.len() * words);
        let mut sums = Sums::zero(self.simd);
        for row in 0..height {
            let (texels, weights) = (self.row(row, pairs), &weights[row * pairs..][..pairs]);
            for pair in 0..pairs {
                let mut blocks = [i16x8::splat(self.simd, 0); N];
                for image in 0..N {
                    let pair = if image < N - R { pair } else { pairs - 1 - pair };
                    blocks[image] = i16x8::from_slice(self.simd, &texels[image][8 * pair..][..8]);
                }
                let texels = V::join(blocks).swizzle_dyn_within_blocks(self.order);
                sums.add(texels, V::weights(self.simd, weights[pair]));
                if rows.contains(&row) {
                    let marks = all_marks[(row - rows.start) * words + pair / 16] >> (pair % 16 * 2);
                    sums.bound(texels, V::mask(self.simd, marks));
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
            let down = self.down[image % 2].wrapping_mul(row as i32);
            let first = 4 * self.leftmost(image, pairs).wrapping_add_signed(down) as usize;
            *samples = &self.samples[first..first + 8 * pairs];
        }
        rows
    }
}

/// The rows of a window of a small size.
#[derive(Clone, Copy)]
struct SmallRow<'a, S: Simd, V: Blocks<S, N>, const N: usize, const R: usize, const PAIRS: usize, const HEIGHT: usize> {
    simd: S,
    order: V::Bytes,
    texels: [Texels<'a, PAIRS, HEIGHT>; N],
}

impl<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize, const PAIRS: usize, const HEIGHT: usize>
    SmallRow<'_, S, V, N, R, PAIRS, HEIGHT>
{
    /// Adds a row, some of whose texels may lie under the pixel.
    #[inline(always)]
    fn add<const UNDER: bool>(&self, sums: &mut Sums<S, V, N>, weights: &[u32], row: usize, marks: u32) {
        self.pair::<UNDER>(sums, weights, row, 0, marks);
        self.pair::<UNDER>(sums, weights, row, 1, marks);
        if PAIRS == 3 {
            self.pair::<UNDER>(sums, weights, row, 2, marks);
        }
    }

    #[inline(always)]
    fn pair<const UNDER: bool>(&self, sums: &mut Sums<S, V, N>, weights: &[u32], row: usize, pair: usize, marks: u32) {
        let mut blocks = [i16x8::splat(self.simd, 0); N];
        for (image, block) in blocks.iter_mut().enumerate() {
            let pair = if image < N - R { pair } else { PAIRS - 1 - pair };
            *block = i16x8::load_array_ref(self.simd, self.texels[image].pair(row, pair));
        }
        let texels = V::join(blocks).swizzle_dyn_within_blocks(self.order);
        sums.add(texels, V::weights(self.simd, weights[row * PAIRS + pair]));
        if UNDER {
            sums.bound(texels, V::mask(self.simd, marks >> (2 * pair)));
        }
    }
}

/// What adds up over a window.
struct Sums<S: Simd, V: Blocks<S, N>, const N: usize> {
    sum: V::Widened,
    /// The largest samples under the pixel, and the largest of what the others lack of white.
    greatest: V,
    least: V,
}

impl<S: Simd, V: Blocks<S, N>, const N: usize> Sums<S, V, N> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = V::splat(simd, 0);
        Self { sum: V::Widened::splat(simd, 0), greatest: zero, least: zero }
    }

    /// Adds pairs of texels.
    #[inline(always)]
    fn add(&mut self, texels: V, weights: V) {
        self.sum += texels.pairwise_dot_product(weights);
    }

    /// Notes those of a pair that lie under the pixel, where the mask has all bits but the sign's.
    #[inline(always)]
    fn bound(&mut self, texels: V, mask: V) {
        self.greatest = self.greatest.max(texels & mask);
        self.least = self.least.max(!texels & mask);
    }

    /// The sum as light; within what lies under the pixel, if that is asked for.
    #[inline(always)]
    fn average(self, simd: S, bits: u32, is_bounded: bool) -> V::Widened {
        let average = (self.sum + (1 << (bits - 1))) >> bits;
        let white = V::Widened::splat(simd, i32::from(i16::MAX));
        let (most, fewest) = if is_bounded {
            (largest(self.greatest), white - largest(self.least))
        } else {
            (white, V::Widened::splat(simd, 0))
        };
        average.max(fewest).min(most)
    }
}

/// The larger sample of each pair, none of which is negative.
#[inline(always)]
fn largest<S: Simd, V: Blocks<S, N>, const N: usize>(samples: V) -> V::Widened {
    let pairs: V::Widened = samples.bitcast();
    (pairs & i32::from(i16::MAX)).max(pairs >> 16)
}
