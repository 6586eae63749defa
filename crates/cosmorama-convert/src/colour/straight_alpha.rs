//! Detection of straight alpha in files whose format says that colours are premultiplied.

use cosmorama::raster::Rgba;

use super::thin_alpha::FULL;

/// Counts of pixels of partial alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StraightAlpha {
    partial: usize,
    /// Pixels of these whose colour exceeds their alpha. Light that glows may do so.
    above: usize,
}

impl StraightAlpha {
    /// Counts some pixels of premultiplied light. Those that are black and transparent do not count.
    pub(crate) fn of(pixels: impl Iterator<Item = Rgba>) -> Self {
        let partial = pixels.filter(|pixel| pixel.alpha() < FULL && pixel.0.iter().any(|sample| *sample > 0.0));
        partial.fold(Self::default(), |Self { partial, above }, pixel| {
            let [red, green, blue, alpha] = pixel.0;
            // Half floats have digits to a two-thousandth.
            let is_above = red.max(green).max(blue) > alpha * 1.001 + 1e-4;
            Self { partial: partial + 1, above: above + usize::from(is_above) }
        })
    }

    /// Returns the warning; `None` if most pixels of partial alpha have no more colour than that.
    pub(crate) fn told(self) -> Option<String> {
        (2 * self.above > self.partial).then(|| {
            format!(
                "colour exceeds alpha in {:.0} % of the pixels that are partly transparent, as if alpha were straight; here it \
                 counts as premultiplied. If its edges come out too bright, write the file again with premultiplied colours",
                100.0 * self.above as f64 / self.partial as f64
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_above_alpha_are_told_of() {
        let edge = |colour: fn(f32) -> f32| {
            (0..=20_u8).map(move |k| f32::from(k) / 20.0).map(move |alpha| {
                let colour = colour(alpha);
                Rgba([colour, colour, colour, alpha])
            })
        };
        let straight = StraightAlpha::of(edge(|_| 0.9)).told();
        assert!(straight.is_some_and(|told| told.contains("in 90 % of the pixels")));
        assert_eq!(StraightAlpha::of(edge(|alpha| 0.9 * alpha)).told(), None);
        assert_eq!(StraightAlpha::of(edge(|alpha| alpha)).told(), None);
        assert_eq!(StraightAlpha::of(std::iter::empty()).told(), None);
    }
}
