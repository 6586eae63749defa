//! Tests that windows make the same pixels as soon as they are weighed and by a plan.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::filter::rim::simd_levels::levels;

/// Maker that counts the pixels that it makes at once.
struct Counted<'a, M>(&'a M, AtomicUsize);

impl<F: Format, P: NoUninit, M: Maker<F, P>> Maker<F, P> for Counted<'_, M> {
    type Memory = M::Memory;

    fn fill(&self, band: &Band<F>, canvas: &mut Canvas<P>) {
        self.0.fill(band, canvas);
    }

    fn put_at_once(
        &self,
        memory: &mut M::Memory,
        pixels: ([usize; 2], u8),
        windows: &Windows,
        canvas: &mut Canvas<P>,
    ) -> bool {
        let is_put = self.0.put_at_once(memory, pixels, windows, canvas);
        self.1.fetch_add(if is_put { pixels.1.count_ones() as usize } else { 0 }, Ordering::Relaxed);
        is_put
    }
}

/// Checks a still against a plan's frame, with and without anti-ringing. Returns how many pixels are made at once.
fn at_once(world: &World, target: &View) -> usize {
    let mut count = 0;
    for (light, anti_ringing) in [(light(world), true), (black_and_white(world), true), (black_and_white(world), false)]
    {
        let filter = FilterSettings { anti_ringing, ..FilterSettings::DEFAULT };
        let resampler = Resampler { filter, ..resampler(world, target) };
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        let arithmetic = FixedArithmetic { light: &light, codec: &codec };
        let mut frame = Image::filled(target.width(), target.height(), codec.background());
        fixed(&resampler).fill(arithmetic, Level::new(), &mut frame);
        let mirrors = Mirrors::of::<FixedFormat>(&resampler);
        for level in levels() {
            let maker =
                Counted(&BandFilter { level, mirrors: &mirrors, anti_ringing, arithmetic }, AtomicUsize::new(0));
            let mut still = Image::zeroed(target.width(), target.height());
            let pixels = (still.pixels_mut(), codec.background());
            each_band((&resampler, Sampling::default()), &mirrors, pixels, (level, Watch::NONE), &maker);
            assert!(still == frame, "{:?} with anti-ringing {anti_ringing}", target.projection);
            count = maker.1.into_inner();
        }
    }
    count
}

#[test]
fn windows_make_the_same_pixels_at_once_and_by_a_plan() {
    for (world, target, images) in conversions() {
        let count = at_once(&world, &target);
        assert!(images == 1 || count == 0, "{count} pixels of a picture with mirror images");
    }
}

#[test]
fn most_pixels_of_a_turned_view_are_made_at_once_whatever_their_windows() {
    // Windows of five to eight texels across.
    for size in [200, 260, 320, 400] {
        let target = view(ProjectionKind::PERSPECTIVE, (96, 64), (0.5, 0.33), turned(3.0, 2.0, 10.0));
        let count = at_once(&cube(&[CubeFace::Front], size), &target);
        assert!(count > 96 * 64 / 2, "{count} pixels from a face of {size}²");
    }
}
