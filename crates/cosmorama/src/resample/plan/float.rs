//! Plans in single precision: for light of any range.

use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};

use super::band::{Band, Corners, Run};
use super::canvas::Canvas;
use super::mirrors::{MirrorImage, Mirrors, Walk};
use super::stored::Stored;
use super::weights::Weights;
use crate::raster::Rgba;
use crate::resample::patch::SIDE;
use crate::resample::taps::average;
use crate::resample::window::Windows;

/// The weights of windows, a lane for each of the pixels beside each other. Their last bit tells whether the texel lies under
/// the pixel.
#[derive(Clone, Debug, Default)]
pub(in crate::resample) struct FloatWeights(Vec<[f32; SIDE]>);

impl Stored for FloatWeights {
    const LEAST: usize = Vec::<[f32; SIDE]>::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        self.0.store(into);
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        Vec::load(from).map(Self)
    }
}

impl Weights for FloatWeights {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn keep(&mut self, windows: &Windows, _: &mut Corners) -> bool {
        let texels = windows.texels();
        self.0.extend(texels.map(|(weights, under)| std::array::from_fn(|k| marked(weights[k], under >> k & 1 == 1))));
        true
    }

    fn truncate(&mut self, length: usize) {
        self.0.truncate(length);
    }

    fn shrink(&mut self) {
        self.0.shrink_to_fit();
    }

    fn are_sound(&self, run: &Run, view: [usize; 2]) -> bool {
        let window = [usize::from(run.width), usize::from(run.height)];
        let weights = self.0.get(run.weights as usize..).and_then(|from| from.get(..window[0] * window[1]));
        let is_sound = |lane: usize, weights: &[[f32; SIDE]]| {
            run.is_within(lane, window, view) && weights.iter().all(|weights| weights[lane].is_finite())
        };
        weights.is_some_and(|weights| run.lanes().all(|lane| is_sound(lane, weights)))
    }

    fn bytes(&self) -> usize {
        self.0.capacity() * size_of::<[f32; SIDE]>()
    }

    fn used_bytes(&self) -> usize {
        self.0.len() * size_of::<[f32; SIDE]>()
    }
}

/// Makes the pixels of a band.
pub(super) struct FloatFilter<'a> {
    pub(super) level: Level,
    pub(super) mirrors: &'a Mirrors,
    pub(super) texels: &'a [Rgba],
    pub(super) anti_ringing: bool,
}

impl FloatFilter<'_> {
    pub(super) fn fill(&self, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        let level = self.level;
        dispatch!(level, simd => self.runs(simd, band, canvas));
        for single in &band.singles {
            let colour = average(band.taps(single), |texel| self.texels[texel as usize], self.anti_ringing);
            let image = &self.mirrors.images[usize::from(single.image)];
            *canvas.pixel(image, [single.column as usize, usize::from(single.row)]) = colour * single.coverage;
        }
    }

    // No closures below: the compiler gives them no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        for runs in band.patches() {
            for image in &self.mirrors.images {
                for run in runs {
                    self.run(simd, band, run, image, canvas);
                }
            }
        }
    }

    #[inline(always)]
    fn run<S: Simd>(
        &self,
        simd: S,
        band: &Band<FloatWeights>,
        run: &Run,
        image: &MirrorImage,
        canvas: &mut Canvas<Rgba>,
    ) {
        let texels = usize::from(run.width) * usize::from(run.height);
        let weights = &band.weights.0[run.weights as usize..][..texels];
        let corner = image.view(usize::from(run.view)).walk(run.corner());
        for lane in run.lanes() {
            let walk = run.walk(corner, lane);
            *canvas.pixel(image, run.pixel(lane)) = if walk.is_reversed {
                self.average::<S, true>(simd, run, weights, lane, walk)
            } else {
                self.average::<S, false>(simd, run, weights, lane, walk)
            };
        }
    }

    #[inline(always)]
    fn average<S: Simd, const REVERSED: bool>(
        &self,
        simd: S,
        run: &Run,
        weights: &[[f32; SIDE]],
        lane: usize,
        walk: Walk,
    ) -> Rgba {
        let width = usize::from(run.width);
        let under = if self.anti_ringing { run.rows_under() } else { 0..0 };
        let mut sum = f32x4::splat(simd, 0.0);
        let mut least = f32x4::splat(simd, f32::INFINITY);
        let mut greatest = f32x4::splat(simd, f32::NEG_INFINITY);
        let first = walk.first as usize;
        let mut first = if REVERSED { first + 1 - width } else { first };
        for (row, weights) in weights.chunks_exact(width).enumerate() {
            let texels = &self.texels[first..][..width];
            let is_under = under.contains(&row);
            let mut part = f32x4::splat(simd, 0.0);
            for column in 0..width {
                let texel = texels[if REVERSED { width - 1 - column } else { column }];
                let (texel, weight) = (f32x4::load_array(simd, texel.0), weights[column][lane]);
                part += texel * weight;
                if is_under {
                    let beyond = beyond(weight);
                    least = least.min(texel + beyond);
                    greatest = greatest.max(texel - beyond);
                }
            }
            sum += part;
            first = first.wrapping_add_signed(walk.down as isize);
        }
        if self.anti_ringing {
            sum = sum.max(least).min(greatest);
        }
        Rgba(sum.to_array())
    }
}

/// A weight that says whether its texel lies under the pixel.
fn marked(weight: f32, is_under: bool) -> f32 {
    f32::from_bits(weight.to_bits() & !1 | u32::from(is_under))
}

/// Zero for a texel under the pixel, infinity for one around it.
#[inline(always)]
fn beyond(weight: f32) -> f32 {
    const INFINITY: u32 = f32::INFINITY.to_bits();
    f32::from_bits((weight.to_bits() & 1).wrapping_sub(1) & INFINITY)
}
