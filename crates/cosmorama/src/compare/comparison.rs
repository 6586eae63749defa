use super::edges::edge_free;
use super::pair::Pair;
use super::{CompareError, Difference, Mask, OwnPeak, Registration};
use crate::raster::{ColourChannel, Image, Rgba, Transfer};

/// Result of a comparison of two pictures: their differences, and the shift between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Number of pixels compared.
    pub pixels: usize,
    /// Differences of linear light.
    pub linear: Difference,
    /// Differences of linear light by the second picture's own peak; `None` where that is at most 1.
    pub own_peak: Option<OwnPeak>,
    /// Differences of sRGB code values, which are closer to perception; light beyond 0–1 is clipped.
    pub srgb: Difference,
    /// Differences of linear light away from edges; `None` where every pixel is near an edge.
    pub edge_free: Option<EdgeFree>,
    /// Largest absolute difference of alpha.
    pub alpha: f32,
    /// Place of the first picture on the second. `None` if every compared pixel is near one that is not, or if the
    /// pictures differ by more than a shift of about a pixel explains.
    pub registration: Option<Registration>,
}

/// Differences of linear light away from edges, where the filters of two renderers should agree.
///
/// Do not judge by these figures alone: they hide shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeFree {
    /// Number of compared pixels away from edges of the second picture.
    pub pixels: usize,
    /// Differences of linear light in those pixels.
    pub linear: Difference,
}

/// Compares the first picture with the second, the reference, whose edges define the edge-free figures.
///
/// Colours are compared as stored, premultiplied by alpha. Pixels with a NaN are transparent, and infinities are the
/// largest half float.
///
/// # Errors
/// When the pictures or the mask differ in size, or no pixel is left to compare.
pub fn compare(first: &Image<Rgba>, second: &Image<Rgba>, mask: &Mask) -> Result<Comparison, CompareError> {
    let pair = Pair::new(first, second, mask)?;
    let nothing = || CompareError::NothingCounts { size: pair.size() };
    let linear = Difference::between(&pair, |light| light).ok_or_else(nothing)?;
    Ok(Comparison {
        pixels: mask.count(),
        linear,
        own_peak: OwnPeak::of(&pair, &linear),
        srgb: Difference::between(&pair, |light| Transfer::Srgb.encode(light.clamp(0.0, 1.0), ColourChannel::Green))
            .ok_or_else(nothing)?,
        edge_free: EdgeFree::between(first, second, &edge_free(&pair)?)?,
        alpha: alpha_difference(&pair),
        registration: Registration::between(&pair),
    })
}

/// Returns the differences of linear light alone, as [`compare`] does.
pub(crate) fn linear_difference(
    first: &Image<Rgba>,
    second: &Image<Rgba>,
    mask: &Mask,
) -> Result<Difference, CompareError> {
    let pair = Pair::new(first, second, mask)?;
    Difference::between(&pair, |light| light).ok_or_else(|| CompareError::NothingCounts { size: pair.size() })
}

impl EdgeFree {
    fn between(first: &Image<Rgba>, second: &Image<Rgba>, mask: &Mask) -> Result<Option<Self>, CompareError> {
        let linear = Difference::between(&Pair::new(first, second, mask)?, |light| light);
        Ok(linear.map(|linear| Self { pixels: mask.count(), linear }))
    }
}

fn alpha_difference(pair: &Pair<'_>) -> f32 {
    let (_, height) = pair.size();
    let sites = (0..height).flat_map(|j| pair.row(j));
    sites.map(|site| (site.second.alpha() - site.first.alpha()).abs()).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: usize, height: usize, value: f32) -> Image<Rgba> {
        Image::filled(width, height, Rgba::opaque(value, value, value))
    }

    #[test]
    fn a_tenth_is_twenty_decibels() {
        let comparison = compare(&grey(30, 20, 0.5), &grey(30, 20, 0.6), &Mask::everything(30, 20)).unwrap();
        assert_eq!(comparison.pixels, 600);
        assert!((comparison.linear.psnr - 20.0).abs() < 1e-5);
        assert!((comparison.linear.rms - 0.1).abs() < 1e-6 && (comparison.linear.mean - 0.1).abs() < 1e-6);
        let code = 1.055 * (0.6_f64.powf(1.0 / 2.4) - 0.5_f64.powf(1.0 / 2.4));
        assert!((comparison.srgb.rms - code).abs() < 1e-6);
    }

    #[test]
    fn light_beyond_one_is_measured_by_its_own_peak() {
        // Off by 1 everywhere, a twentieth of the peak.
        let comparison = compare(&grey(30, 20, 19.0), &grey(30, 20, 20.0), &Mask::everything(30, 20)).unwrap();
        let own = comparison.own_peak.unwrap();
        assert!(comparison.linear.psnr.abs() < 1e-9);
        assert!((own.psnr - 20.0 * 20.0_f64.log10()).abs() < 1e-9 && own.peak == 20.0);
        assert!((own.relative - 0.05).abs() < 1e-12);
        let dim = compare(&grey(30, 20, 0.5), &grey(30, 20, 1.0), &Mask::everything(30, 20)).unwrap();
        assert_eq!(dim.own_peak, None);
    }

    #[test]
    fn one_wrong_channel_is_found_in_its_pixel() {
        let flat = grey(30, 20, 0.25);
        let mut spoilt = flat.clone();
        spoilt.pixels_mut()[7 * 30 + 3] = Rgba::opaque(0.25, 0.0, 0.25);
        let comparison = compare(&spoilt, &flat, &Mask::everything(30, 20)).unwrap();
        assert_eq!((comparison.linear.largest.value, comparison.linear.largest.pixel), (0.25, (3, 7)));
        // One of 1800 samples is off by a quarter.
        assert!((comparison.linear.psnr - 10.0 * (1800.0 * 16.0_f64).log10()).abs() < 1e-9);
        let without = Mask::from_fn(30, 20, |i, j| (i, j) != (3, 7));
        assert_eq!(compare(&spoilt, &flat, &without).unwrap().linear.psnr, f64::INFINITY);
    }

    #[test]
    fn a_picture_equals_itself() {
        let mut picture = Image::from_fn(30, 20, |i, j| Rgba::opaque(i as f32 / 30.0, j as f32 / 20.0, 0.5));
        picture.pixels_mut()[40] = Rgba([0.5, f32::NAN, f32::INFINITY, 1.0]);
        let comparison = compare(&picture, &picture, &Mask::everything(30, 20)).unwrap();
        assert_eq!((comparison.linear.psnr, comparison.srgb.psnr), (f64::INFINITY, f64::INFINITY));
        assert_eq!(comparison.registration.map(|r| r.shift()), Some(0.0));
    }

    #[test]
    fn a_missing_pixel_shows_in_alpha() {
        let black = Image::filled(4, 1, Rgba::BLACK);
        let mut holed = black.clone();
        holed.pixels_mut()[2] = Rgba::TRANSPARENT;
        let comparison = compare(&holed, &black, &Mask::everything(4, 1)).unwrap();
        assert_eq!((comparison.linear.psnr, comparison.alpha), (f64::INFINITY, 1.0));
    }

    #[test]
    fn sizes_must_agree() {
        let error = compare(&grey(3, 2, 0.0), &grey(2, 3, 0.0), &Mask::everything(3, 2)).unwrap_err();
        assert_eq!(error, CompareError::SizesDiffer { first: (3, 2), second: (2, 3) });
        assert!(error.to_string().contains("3x2") && error.to_string().contains("2x3"));
        let error = compare(&grey(3, 2, 0.0), &grey(3, 2, 0.0), &Mask::everything(2, 2)).unwrap_err();
        assert_eq!(error, CompareError::MaskSize { mask: (2, 2), pictures: (3, 2) });
        let nothing = Mask::from_fn(3, 2, |_, _| false);
        let error = compare(&grey(3, 2, 0.0), &grey(3, 2, 0.0), &nothing).unwrap_err();
        assert_eq!(error, CompareError::NothingCounts { size: (3, 2) });
    }

    /// Returns a parabolic picture with a brighter disc; its values are exact in single precision.
    fn parabola(shift: i32, grain: i32) -> Image<Rgba> {
        Image::from_fn(64, 48, |i, j| {
            let (i, j) = (i as i32, j as i32);
            let x = 4 * i + shift;
            let disc = if (x - 82).pow(2) + (4 * j - 60).pow(2) < 1300 { 30_000 } else { 0 };
            let value = |c| x * x + x * j * c + 40 * j * j + grain * ((5 * i + 3 * j) % 7) + disc;
            let [red, green, blue] = [1, 2, 3].map(|c| value(c) as f32 / 262_144.0);
            Rgba::opaque(red, green, blue)
        })
    }

    /// Expects the figures that numpy and scipy give, in double precision, for the same measures.
    #[test]
    fn figures_agree_with_scipy() {
        let mask = Mask::from_fn(64, 48, |i, j| (i as i32 - 32).pow(2) + (j as i32 - 24).pow(2) < 500);
        let found = compare(&parabola(1, 0), &parabola(0, 64), &mask).unwrap();
        let edge_free = found.edge_free.unwrap();
        let registration = found.registration.unwrap();
        assert_eq!((found.pixels, edge_free.pixels), (1565, 1288));
        for (name, found, expected) in [
            ("PSNR", found.linear.psnr, 41.752_386_750_693_23),
            ("PSNR of sRGB", found.srgb.psnr, 38.407_518_713_245_24),
            ("PSNR off edges", edge_free.linear.psnr, 62.073_667_575_811_31),
            ("mean", found.linear.mean, -0.000_434_492_799_801_567_5),
            ("largest", found.linear.largest.value, 0.114_528_656_005_859_38),
            ("99.9 %", found.linear.percentile_99_9, 0.114_166_000_366_210_93),
            ("dx", registration.dx, -0.035_750_152_333_009_835),
            ("dy", registration.dy, -0.054_970_878_379_822_35),
            ("scale x", registration.scale_x, 0.026_336_802_032_001_436),
            ("scale y", registration.scale_y, 0.004_525_759_678_100_573),
            ("rotation", registration.rotation, -0.005_519_113_803_191_767),
        ] {
            assert!((found - expected).abs() < 1e-6, "{name}: {found}, not {expected}");
        }
    }
}
