//! Plans in integers: for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights 16; their products are added in 32, so that the result is the same on every machine. Eight
//! texels of a row are worked on together, red, green, blue and nothing of each, two beside each other in every block of 128
//! bits: a product of pairs is then a weighted sum of two texels.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch, i16x8, i16x32, i32x4, i32x16, prelude::*, u8x64};

use super::band::{Band, Run};
use super::canvas::Canvas;
use super::fixed_weights::FixedWeights;
use super::mirrors::{MOST_IMAGES, Mirrors, Walk};
use super::spread::{GROUP, MASKS, PAIRS, Spread};
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
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                self.read_ahead(ahead.next().unwrap_or(&[]));
            }
            let numbers = &band.weights.numbers[run.weights as usize..];
            let made = Made { run, bits: numbers[0] as u32, numbers: &numbers[1..] };
            let pixels = match (run.width, run.height, self.anti_ringing) {
                (4, 4, true) => self.small::<S, 4, 4, 24>(simd, made),
                (4, 5, true) => self.small::<S, 4, 5, 29>(simd, made),
                (5, 4, true) => self.small::<S, 5, 4, 27>(simd, made),
                (5, 5, true) => self.small::<S, 5, 5, 33>(simd, made),
                _ => self.any(simd, made),
            };
            for (image, pixels) in self.mirrors.images.iter().zip(&pixels) {
                canvas.put(image, run, pixels);
            }
        }
    }

    /// Reads a little of what these runs will read, so that it is near by then: lines of memory that are asked for one after the
    /// other, as they are needed, take most of the time.
    #[inline(always)]
    fn read_ahead(&self, runs: &[Run]) {
        let samples = self.light.samples();
        let mut read = 0;
        for image in &self.mirrors.images {
            for run in runs {
                let walk = image.view(usize::from(run.view)).walk(run.corner());
                let span = run.span() as u32;
                let mut first = walk.first;
                for _ in 0..run.height {
                    let last = if walk.is_reversed { first.wrapping_sub(span) } else { first.wrapping_add(span) };
                    for texel in [first, last] {
                        read |= samples.get(4 * texel as usize).copied().unwrap_or(0);
                    }
                    first = first.wrapping_add_signed(walk.down);
                }
            }
        }
        std::hint::black_box(read);
    }

    /// The pixels of a run in each mirror, whose windows have W × H texels: the sizes that there are where a kernel is as small
    /// as may be. N numbers are read of each: the last row's as a whole group. What mirrors share is done once.
    #[inline(always)]
    fn small<S: Simd, const W: usize, const H: usize, const N: usize>(&self, simd: S, made: Made) -> Pixels {
        let Made { run, bits, mut numbers } = made;
        let samples = self.light.samples();
        let mut pixels = [[[0; 3]; SIDE]; MOST_IMAGES];
        let ways = self.ways(run);
        for lane in run.lanes() {
            let window = &numbers[..N];
            for (is_reversed, way) in [false, true].into_iter().zip(&ways) {
                if way.count == 0 {
                    continue;
                }
                let weights = SmallWindow::<S, H>::new::<W>(simd, window, is_reversed);
                for (image, corner) in &way.corners[..way.count] {
                    let mut walk = run.walk(*corner, lane);
                    if is_reversed {
                        walk.first = walk.first.wrapping_sub(W as u32 - 1);
                    }
                    pixels[*image][lane] = self.codec.codes(weights.average(samples, walk, bits));
                }
            }
            numbers = &numbers[(W + 1) * H..];
        }
        pixels
    }

    /// How windows of a run are walked through in each mirror: those from left to right, and those from right to left.
    #[inline(always)]
    fn ways(&self, run: &Run) -> [Way; 2] {
        let mut ways = [Way::default(), Way::default()];
        for (index, image) in self.mirrors.images.iter().enumerate() {
            let walk = image.view(usize::from(run.view)).walk(run.corner());
            let way = &mut ways[usize::from(walk.is_reversed)];
            way.corners[way.count] = (index, walk);
            way.count += 1;
        }
        ways
    }

    /// The pixels of any run in each mirror.
    #[inline(always)]
    fn any<S: Simd>(&self, simd: S, made: Made) -> Pixels {
        let Made { run, bits, mut numbers } = made;
        let window = Window::new(run, self.anti_ringing, bits);
        let mut pixels = [[[0; 3]; SIDE]; MOST_IMAGES];
        for lane in run.lanes() {
            for (pixels, image) in pixels.iter_mut().zip(&self.mirrors.images) {
                let walk = run.walk(image.view(usize::from(run.view)).walk(run.corner()), lane);
                pixels[lane] = self.codec.codes(window.average(simd, numbers, self.light.samples(), walk));
            }
            numbers = &numbers[window.numbers..];
        }
        pixels
    }
}

/// Mirrors that go through windows the same way: which, and how through one at the run's corner.
#[derive(Default)]
struct Way {
    corners: [(usize, Walk); MOST_IMAGES],
    count: usize,
}

/// What is known of a run.
#[derive(Clone, Copy)]
struct Made<'a> {
    run: &'a Run,
    /// By how many bits weights are scaled.
    bits: u32,
    /// Its weights, and more.
    numbers: &'a [i16],
}

/// The pixels of a run in each mirror, by lane.
type Pixels = [[[u8; 3]; SIDE]; MOST_IMAGES];

/// The weights of a window with H rows, as they stand beside texels, and all bits of those that lie under the pixel.
struct SmallWindow<S: Simd, const H: usize> {
    simd: S,
    weights: [i16x32<S>; H],
    under: [i16x32<S>; H],
}

impl<S: Simd, const H: usize> SmallWindow<S, H> {
    #[inline(always)]
    fn new<const W: usize>(simd: S, numbers: &[i16], is_reversed: bool) -> Self {
        let spread = Spread::of(simd, is_reversed, W);
        let mut this = Self { simd, weights: [i16x32::splat(simd, 0); H], under: [i16x32::splat(simd, 0); H] };
        for row in 0..H {
            let at = row * (W + 1);
            let weights = i16x8::from_slice(simd, &numbers[at + 1..][..GROUP]);
            this.weights[row] = spread.of_block(weights) & spread.counts;
            this.under[row] = spread.of_block(i16x8::load_array_ref(simd, &MASKS[usize::from(numbers[at] as u8)]));
        }
        this
    }

    #[inline(always)]
    fn average(&self, samples: &[i16], walk: Walk, bits: u32) -> [i16; 4] {
        let mut sums = Sums::zero(self.simd);
        let mut first = walk.first;
        for row in 0..H {
            sums.add::<true>(group(samples, first), self.weights[row], self.under[row]);
            first = first.wrapping_add_signed(walk.down);
        }
        sums.average(bits, true)
    }
}

/// What the windows of a run have in common.
struct Window {
    height: usize,
    /// Groups of texels in a row, all but the last of them whole.
    groups: usize,
    /// Texels of the last one.
    rest: usize,
    /// Rows with texels under the pixel.
    under: Range<usize>,
    /// Numbers that are kept of each.
    numbers: usize,
    /// By how many bits weights are scaled.
    bits: u32,
}

impl Window {
    #[inline(always)]
    fn new(run: &Run, anti_ringing: bool, bits: u32) -> Self {
        let (width, height) = (usize::from(run.width), usize::from(run.height));
        let groups = width.div_ceil(GROUP);
        let under = if anti_ringing { run.rows_under() } else { 0..0 };
        Self { height, groups, rest: width - GROUP * (groups - 1), under, numbers: height * (width + groups), bits }
    }

    /// The weighted average of a window's texels, held to those under the pixel; `samples` are those of all texels.
    #[inline(always)]
    fn average<S: Simd>(&self, simd: S, numbers: &[i16], samples: &[i16], walk: Walk) -> [i16; 4] {
        let mut sums = Sums::zero(simd);
        let (mut row_first, mut at) = (walk.first, 0);
        for row in 0..self.height {
            let mut end = row_first;
            for index in 0..self.groups {
                let count = if index + 1 == self.groups { self.rest } else { GROUP };
                let first = if walk.is_reversed { end.wrapping_sub(count as u32 - 1) } else { end };
                let spread = Spread::of(simd, walk.is_reversed, count);
                let weights = spread.of_block(i16x8::from_slice(simd, &numbers[at + 1..][..GROUP])) & spread.counts;
                let samples = group(samples, first);
                if self.under.contains(&row) {
                    let under = i16x8::load_array_ref(simd, &MASKS[usize::from(numbers[at] as u8)]);
                    sums.add::<true>(samples, weights, spread.of_block(under));
                } else {
                    sums.add::<false>(samples, weights, weights);
                }
                at += 1 + count;
                let group = GROUP as u32;
                end = if walk.is_reversed { end.wrapping_sub(group) } else { end.wrapping_add(group) };
            }
            row_first = row_first.wrapping_add_signed(walk.down);
        }
        sums.average(self.bits, !self.under.is_empty())
    }
}

/// What adds up over a window.
struct Sums<S: Simd> {
    simd: S,
    sum: i32x16<S>,
    /// The largest samples under the pixel, and the largest of what the others lack of white.
    greatest: i16x32<S>,
    least: i16x32<S>,
    /// How texels are sorted by channel.
    pairs: u8x64<S>,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = i16x32::splat(simd, 0);
        let (sum, pairs) = (i32x16::splat(simd, 0), u8x64::load_array(simd, PAIRS));
        Self { simd, sum, greatest: zero, least: zero, pairs }
    }

    /// Adds a group of texels, with all bits of those that lie under the pixel if any may.
    #[inline(always)]
    fn add<const UNDER: bool>(&mut self, samples: &[i16], weights: i16x32<S>, under: i16x32<S>) {
        let texels = self.simd.swizzle_dyn_within_blocks_i16x32(i16x32::from_slice(self.simd, samples), self.pairs);
        self.sum += texels.pairwise_dot_product(weights);
        if UNDER {
            self.greatest = self.greatest.max(texels & under);
            self.least = self.least.max((texels ^ i16::MAX) & under);
        }
    }

    /// The sum as light; within what lies under the pixel, if anything does.
    #[inline(always)]
    fn average(self, bits: u32, is_bounded: bool) -> [i16; 4] {
        let average = (total(self.sum) + (1 << (bits - 1))) >> bits;
        let white = i32x4::splat(self.simd, i32::from(i16::MAX));
        let (most, fewest) = if is_bounded {
            (largest(self.simd, self.greatest), white - largest(self.simd, self.least))
        } else {
            (white, i32x4::splat(self.simd, 0))
        };
        average.max(fewest).min(most).to_array().map(|light| light as i16)
    }
}

/// A group of texels. The index has 32 bits, so that no sum can overflow and one comparison is enough.
#[inline(always)]
fn group(samples: &[i16], first: u32) -> &[i16] {
    let first = 4 * first as usize;
    &samples[first..first + 4 * GROUP]
}

/// The sum of all blocks.
#[inline(always)]
fn total<S: Simd>(sums: i32x16<S>) -> i32x4<S> {
    let (a, b) = sums.split();
    let (a, b) = (a + b).split();
    a + b
}

/// The largest of each channel, none of which is negative.
#[inline(always)]
fn largest<S: Simd>(simd: S, samples: i16x32<S>) -> i32x4<S> {
    let (a, b) = samples.split();
    let (a, b) = a.max(b).split();
    let pairs: i32x4<S> = a.max(b).bitcast();
    let low = i32x4::splat(simd, i32::from(i16::MAX));
    (pairs & low).max(pairs >> 16)
}
