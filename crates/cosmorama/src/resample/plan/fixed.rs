//! Plans in integers: for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights 16; their products are added in 32, so that the result is the same on every machine. Eight
//! texels of a row are worked on together, red, green, blue and nothing of each, two beside each other in every block of 128
//! bits: a product of pairs is then a weighted sum of two texels.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch, i16x8, i16x32, i32x4, i32x16, prelude::*, u8x64};

use super::band::{Band, Run};
use super::canvas::Canvas;
use super::mirrors::{MOST_IMAGES, Mirrors, Walk};
use super::weights::Weights;
use crate::raster::{FixedCodec, FixedLight};
use crate::resample::patch::SIDE;
use crate::resample::taps::average;
use crate::resample::window::Windows;

/// Texels of a row that are worked on together.
const GROUP: usize = 8;

/// The weights of windows as integers, pixel by pixel and row by row. Before each group of a row's weights stands which of its
/// texels lie under the pixel, a bit for each; before those of a run, by how many bits they are scaled.
#[derive(Clone, Debug, Default)]
pub(in crate::resample) struct FixedWeights {
    /// As many zeros follow as a group has: it is read as a whole.
    numbers: Vec<i16>,
    /// Without those.
    length: usize,
    /// Weights of a run before they are sorted by pixel.
    rounded: Vec<[i16; SIDE]>,
}

/// A number so large that what is added to it is rounded to an integer, which its last bits then hold.
const ROUNDER: f32 = 12_582_912.0;

impl FixedWeights {
    /// Rounds the weights of all lanes; by how many bits they are scaled, `None` if they are too large. What rounding takes from
    /// one texel the next one has: each lane's sum is exactly one.
    fn round(&mut self, windows: &Windows) -> Option<u32> {
        let (mut largest, mut size) = ([0f32; SIDE], [0f32; SIDE]);
        for (weights, _) in windows.texels() {
            for lane in 0..SIDE {
                largest[lane] = largest[lane].max(weights[lane].abs());
                size[lane] += weights[lane].abs();
            }
        }
        let [largest, size] = [largest, size].map(|lanes| lanes.into_iter().fold(0f32, f32::max));
        // Sums must fit into 32 bits.
        let bits = if largest < 1.0 && size < 1.9 {
            15
        } else if largest < 1.99 && size < 3.9 {
            14
        } else {
            return None;
        };
        let scale = (1 << bits) as f32;
        let (mut sums, mut before) = ([0f32; SIDE], [ROUNDER.to_bits(); SIDE]);
        self.rounded.clear();
        for (weights, _) in windows.texels() {
            let mut rounded = [0; SIDE];
            for lane in 0..SIDE {
                sums[lane] += weights[lane] * scale;
                let sum = (sums[lane] + ROUNDER).to_bits();
                rounded[lane] = (sum.wrapping_sub(before[lane]) as i32).min(i32::from(i16::MAX)) as i16;
                before[lane] = sum;
            }
            self.rounded.push(rounded);
        }
        Some(bits)
    }
}

impl Weights for FixedWeights {
    fn len(&self) -> usize {
        self.length
    }

    fn keep(&mut self, windows: &Windows, run: &Run) -> bool {
        let Some(bits) = self.round(windows) else { return false };
        let width = usize::from(run.width);
        let under: Vec<[u8; SIDE]> =
            windows.texels().map(|(_, beyond)| beyond.map(|beyond| u8::from(beyond == 0.0))).collect();
        self.numbers.truncate(self.length);
        self.numbers.push(bits as i16);
        for lane in run.lanes() {
            for (weights, under) in self.rounded.chunks_exact(width).zip(under.chunks_exact(width)) {
                for (weights, under) in weights.chunks(GROUP).zip(under.chunks(GROUP)) {
                    let bits = under.iter().enumerate().fold(0, |bits, (k, under)| bits | under[lane] << k);
                    self.numbers.push(i16::from(bits));
                    self.numbers.extend(weights.iter().map(|weights| weights[lane]));
                }
            }
        }
        self.length = self.numbers.len();
        self.numbers.resize(self.length + GROUP, 0);
        true
    }

    fn clear(&mut self) {
        self.numbers.clear();
        self.length = 0;
    }

    fn shrink(&mut self) {
        self.numbers.shrink_to_fit();
        self.rounded = Vec::new();
    }

    fn bytes(&self) -> usize {
        self.numbers.capacity() * size_of::<i16>()
    }
}

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
            let taps = &band.taps[single.first as usize..][..single.taps as usize];
            let colour = average(taps, single.bound, |texel| self.light.rgba(texel as usize), self.anti_ringing);
            let image = &self.mirrors.images[usize::from(single.image)];
            let pixel = (colour * single.coverage).over(background);
            *canvas.pixel(image, [single.column as usize, usize::from(single.row)]) = self.codec.codes_of(pixel);
        }
    }

    // No closures below: the compiler gives them no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
        for run in &band.runs {
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

    /// The pixels of a run in each mirror, whose windows have W × H texels: the sizes that there are where a kernel is as small
    /// as may be. N numbers are read of each: the last row's as a whole group. What mirrors share is done once.
    #[inline(always)]
    fn small<S: Simd, const W: usize, const H: usize, const N: usize>(&self, simd: S, made: Made) -> Pixels {
        let Made { run, bits, mut numbers } = made;
        let samples = self.light.samples();
        let mut pixels = [[[0; 3]; SIDE]; MOST_IMAGES];
        for lane in run.lanes() {
            let window = &numbers[..N];
            for is_reversed in [false, true] {
                let mut weights = None;
                for (pixels, image) in pixels.iter_mut().zip(&self.mirrors.images) {
                    let walk = image.view(usize::from(run.view)).walk(run.texel(lane));
                    if walk.is_reversed == is_reversed {
                        let weights = weights.get_or_insert_with(
                            #[inline(always)]
                            || SmallWindow::<S, H>::new::<W>(simd, window, is_reversed),
                        );
                        let first = if is_reversed { walk.first + 1 - W } else { walk.first };
                        pixels[lane] = self.codec.codes(weights.average(samples, first, walk.down, bits));
                    }
                }
            }
            numbers = &numbers[(W + 1) * H..];
        }
        pixels
    }

    /// The pixels of any run in each mirror.
    #[inline(always)]
    fn any<S: Simd>(&self, simd: S, made: Made) -> Pixels {
        let Made { run, bits, mut numbers } = made;
        let window = Window::new(run, self.anti_ringing, bits);
        let mut pixels = [[[0; 3]; SIDE]; MOST_IMAGES];
        for lane in run.lanes() {
            for (pixels, image) in pixels.iter_mut().zip(&self.mirrors.images) {
                let walk = image.view(usize::from(run.view)).walk(run.texel(lane));
                pixels[lane] = self.codec.codes(window.average(simd, numbers, self.light.samples(), walk));
            }
            numbers = &numbers[window.numbers..];
        }
        pixels
    }
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
    fn average(&self, samples: &[i16], first: usize, down: isize, bits: u32) -> [i16; 4] {
        let mut sums = Sums::zero(self.simd);
        let mut at = first;
        for row in 0..H {
            sums.add::<true>(&samples[4 * at..][..4 * GROUP], self.weights[row], self.under[row]);
            at = at.wrapping_add_signed(down);
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
            for group in 0..self.groups {
                let count = if group + 1 == self.groups { self.rest } else { GROUP };
                let first = if walk.is_reversed { end + 1 - count } else { end };
                let spread = Spread::of(simd, walk.is_reversed, count);
                let weights = spread.of_block(i16x8::from_slice(simd, &numbers[at + 1..][..GROUP])) & spread.counts;
                let samples = &samples[4 * first..][..4 * GROUP];
                if self.under.contains(&row) {
                    let under = i16x8::load_array_ref(simd, &MASKS[usize::from(numbers[at] as u8)]);
                    sums.add::<true>(samples, weights, spread.of_block(under));
                } else {
                    sums.add::<false>(samples, weights, weights);
                }
                at += 1 + count;
                end = if walk.is_reversed { end.wrapping_sub(GROUP) } else { end + GROUP };
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

/// How the weights of a row's texels come to stand where those are.
struct Spread<S: Simd> {
    /// From where in the block that holds all of them.
    order: u8x64<S>,
    /// All bits where there is a texel, none beyond the last.
    counts: i16x32<S>,
}

impl<S: Simd> Spread<S> {
    #[inline(always)]
    fn of(simd: S, is_reversed: bool, count: usize) -> Self {
        let table = &SPREADS[usize::from(is_reversed)][count - 1];
        Self { order: u8x64::load_array_ref(simd, &table.order), counts: i16x32::load_array_ref(simd, &table.counts) }
    }

    #[inline(always)]
    fn of_block(&self, block: i16x8<S>) -> i16x32<S> {
        self.counts.simd.swizzle_dyn_within_blocks_i16x32(i16x32::block_splat(block), self.order)
    }
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

/// From two texels in a block to pairs of one channel each.
const PAIRS: [u8; 64] = {
    let block = [0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15];
    let mut order = [0; 64];
    let mut at = 0;
    while at < 64 {
        order[at] = block[at % 16];
        at += 1;
    }
    order
};

/// A [`Spread`] in memory.
struct SpreadTable {
    order: [u8; 64],
    counts: [i16; 32],
}

/// By whether texels run the other way, and by how many there are.
static SPREADS: [[SpreadTable; GROUP]; 2] = {
    let mut spreads = [const { [const { SpreadTable { order: [14; 64], counts: [0; 32] } }; GROUP] }; 2];
    let mut way = 0;
    while way < 2 {
        let mut count = 1;
        while count <= GROUP {
            let mut sample = 0;
            while sample < 32 {
                // Blocks hold two texels, of which those of one channel stand beside each other.
                let texel = sample / 8 * 2 + sample % 2;
                // What lies beyond has no weight, and the bit of its place in a mask is zero.
                let mut weight = GROUP - 1;
                if texel < count {
                    weight = if way == 1 { count - 1 - texel } else { texel };
                    spreads[way][count - 1].counts[sample] = -1;
                }
                spreads[way][count - 1].order[2 * sample] = 2 * weight as u8;
                spreads[way][count - 1].order[2 * sample + 1] = 2 * weight as u8 + 1;
                sample += 1;
            }
            count += 1;
        }
        way += 1;
    }
    spreads
};

/// All bits of a texel that lies under the pixel, by the bits that tell which do.
static MASKS: [[i16; GROUP]; 256] = {
    let mut masks = [[0; GROUP]; 256];
    let mut bits = 0;
    while bits < 256 {
        let mut texel = 0;
        while texel < GROUP {
            if bits >> texel & 1 == 1 {
                masks[bits][texel] = -1;
            }
            texel += 1;
        }
        bits += 1;
    }
    masks
};
