//! Detection of straight alpha in files whose format says that colours are premultiplied.

use cosmorama::raster::Rgba;

use super::thin_alpha::FULL;

/// Counts of pixels of partial alpha. Those of alpha 0 are not: their colour is light that glows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StraightAlpha {
    partial: usize,
    /// Pixels of these that are brighter than the part that they cover can be.
    above: usize,
}

impl StraightAlpha {
    /// Counts some pixels of premultiplied light. What is covered is as bright as the brightest opaque pixel at most, or as white.
    pub(crate) fn of(pixels: impl Iterator<Item = Rgba> + Clone) -> Self {
        let opaque = pixels.clone().filter(|pixel| pixel.alpha() >= FULL);
        let white = opaque.map(brightness).fold(1.0, f32::max);
        let partial = pixels.filter(|pixel| pixel.alpha() > 0.0 && pixel.alpha() < FULL);
        partial.fold(Self::default(), |Self { partial, above }, pixel| {
            // Half floats have digits to a two-thousandth.
            let is_above = brightness(pixel) > (pixel.alpha() * 1.001 + 1e-4) * white;
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

/// Returns the greatest of a pixel's colours.
fn brightness(pixel: Rgba) -> f32 {
    let [red, green, blue, _] = pixel.0;
    red.max(green).max(blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(colour: f32, alpha: f32) -> Rgba {
        Rgba([colour, colour, colour, alpha])
    }

    /// Makes pixels of all alphas, of which one is opaque and one transparent.
    fn edge(colour: fn(f32) -> f32) -> Vec<Rgba> {
        (0..=20_u8).map(|k| f32::from(k) / 20.0).map(|alpha| grey(colour(alpha), alpha)).collect()
    }

    fn told(pixels: &[Rgba]) -> Option<String> {
        StraightAlpha::of(pixels.iter().copied()).told()
    }

    #[test]
    fn colours_above_alpha_are_told_of() {
        assert!(told(&edge(|_| 0.9)).is_some_and(|told| told.contains("in 89 % of the pixels")));
        assert!(told(&edge(|_| 4.0)).is_some_and(|told| told.contains("in 100 % of the pixels")));
        assert_eq!(told(&edge(|alpha| 0.9 * alpha)), None);
        assert_eq!(told(&edge(|alpha| alpha)), None);
        assert_eq!(told(&[]), None);
    }

    #[test]
    fn bright_edges_are_premultiplied() {
        assert_eq!(told(&edge(|alpha| 4.0 * alpha)), None);
        // Beside a lamp of 4, edges of a wall.
        let wall = [vec![grey(4.0, 1.0)], edge(|alpha| 0.9 * alpha)].concat();
        assert_eq!(told(&wall), None);
    }

    #[test]
    fn glow_is_not_straight() {
        let glow = [edge(|alpha| 0.9 * alpha), vec![grey(0.5, 0.0); 1000]].concat();
        assert_eq!(told(&glow), None);
        assert_eq!(told(&vec![grey(0.5, 0.0); 1000]), None);
    }
}
