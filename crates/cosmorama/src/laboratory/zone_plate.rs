use super::pattern::Probe;
use crate::raster::{Image, Rgba};

/// Highest frequency along rows or along columns that a picture holds, in cycles a pixel. Diagonally it holds more.
const NYQUIST: f64 = 0.5;

/// Highest frequency of the gratings that are counted, in cycles a pixel.
const HIGHEST: f64 = 1.0;

/// Highest frequency that texels hold, in cycles a texel, with room for their own rounding.
const HELD: f64 = 0.45;

/// Least number of pixels that make a mean.
const FEWEST: usize = 64;

/// Returns the mean energy that is left of gratings that a picture cannot hold, in decibels below that of the gratings.
pub(super) fn aliasing(probes: &[Probe], image: &Image<Rgba>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0usize);
    for probe in probes.iter().filter(|probe| aliases(probe)) {
        let Rgba([cosine, sine, ..]) = image.pixels()[probe.pixel];
        let [cosine, sine] = [cosine, sine].map(|part| 2.0 * f64::from(part) - 1.0);
        sum += cosine * cosine + sine * sine;
        count += 1;
    }
    (count >= FEWEST).then(|| 10.0 * (sum / count as f64).log10())
}

/// Returns whether a grating is too fine for the picture, and not for the texels.
fn aliases(Probe { frequency: [x, y], texels, .. }: &Probe) -> bool {
    let frequency = x.hypot(*y);
    x.max(*y) > NYQUIST && frequency < HIGHEST && frequency < HELD * texels
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns probes of one frequency, in a row.
    fn probes(frequency: [f64; 2], texels: f64) -> Vec<Probe> {
        (0..100).map(|pixel| Probe { pixel, frequency, from_edge: 0.0, rises: true, texels }).collect()
    }

    /// Draws a grating of an amplitude, in two phases.
    fn grating(amplitude: f32) -> Image<Rgba> {
        Image::from_fn(100, 1, |i, _| {
            let (sin, cos) = (i as f32 * 0.7).sin_cos();
            Rgba::opaque(0.5 + 0.5 * amplitude * cos, 0.5 + 0.5 * amplitude * sin, 0.0)
        })
    }

    #[test]
    fn energy_is_that_of_what_is_left() {
        for (amplitude, expected) in [(1.0, 0.0), (0.1, -20.0), (0.5, -6.0206)] {
            let found = aliasing(&probes([0.7, 0.1], 4.0), &grating(amplitude)).expect("gratings too fine");
            assert!((found - expected).abs() < 1e-3, "{amplitude}: {found}");
        }
    }

    #[test]
    fn gratings_that_a_picture_holds_do_not_count() {
        let counts = |frequency, texels| aliasing(&probes(frequency, texels), &grating(1.0)).is_some();
        // Diagonals hold up to 0.71 cycles a pixel.
        assert!(!counts([0.49, 0.49], 4.0) && counts([0.51, 0.0], 4.0) && !counts([0.8, 0.7], 4.0));
        // A texel each way holds no more than a picture's pixel does.
        assert!(!counts([0.6, 0.0], 1.2) && counts([0.6, 0.0], 1.5));
        assert!(aliasing(&probes([0.7, 0.0], 4.0)[..50], &grating(1.0)).is_none(), "too few pixels");
    }
}
