use super::pattern::Probe;
use crate::raster::{Image, Rgba};

/// Frequencies that a picture cannot hold, in cycles a pixel.
const BEYOND: std::ops::Range<f64> = 0.5..1.0;

/// Highest frequency that texels hold, in cycles a texel, with room for their own rounding.
const HELD: f64 = 0.45;

/// Least number of pixels that make a mean.
const FEWEST: usize = 64;

/// Returns the mean energy of gratings above half a cycle a pixel that is left, in decibels below that of the gratings.
pub(super) fn aliasing(probes: &[Probe], image: &Image<Rgba>) -> Option<f64> {
    let counts = |probe: &&Probe| BEYOND.contains(&probe.frequency) && probe.frequency < HELD * probe.texels;
    let (mut sum, mut count) = (0.0, 0usize);
    for probe in probes.iter().filter(counts) {
        let Rgba([cosine, sine, ..]) = image.pixels()[probe.pixel];
        let [cosine, sine] = [cosine, sine].map(|part| 2.0 * f64::from(part) - 1.0);
        sum += cosine * cosine + sine * sine;
        count += 1;
    }
    (count >= FEWEST).then(|| 10.0 * (sum / count as f64).log10())
}
