use super::Difference;
use super::pair::Pair;

/// Differences of linear light relative to the reference's own light, for pictures that are brighter than 1: the usual
/// PSNR takes 1 as the peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnPeak {
    /// Greatest sample of the second picture, the reference.
    pub peak: f64,
    /// Peak signal-to-noise ratio for that peak, in decibels.
    pub psnr: f64,
    /// Root mean square of the differences, divided by the root mean square of the reference's samples.
    pub relative: f64,
}

impl OwnPeak {
    /// Measures the differences; `None` if the reference is nowhere brighter than 1.
    pub(super) fn of(pair: &Pair<'_>, linear: &Difference) -> Option<Self> {
        let (mut peak, mut squares) = (0.0_f64, 0.0);
        let (_, height) = pair.size();
        let colours = (0..height).flat_map(|j| pair.row(j)).flat_map(|site| site.second.0.into_iter().take(3));
        for sample in colours.map(f64::from) {
            peak = peak.max(sample);
            squares += sample * sample;
        }
        let rms = (squares / (3 * pair.mask().count()) as f64).sqrt();
        let psnr = linear.psnr + 20.0 * peak.log10();
        (peak > 1.0).then_some(Self { peak, psnr, relative: linear.rms / rms })
    }
}
