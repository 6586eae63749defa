//! Detection of alpha that is nowhere full. Such pictures are rare, and some files hold a multiplier there.

use cosmorama::raster::Rgba;

/// Alpha from which a pixel counts as full; allows for floats that were made from codes.
pub(super) const FULL: f32 = 0.999;

/// Range of alpha in pixels of which none is full.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinAlpha {
    least: f32,
    greatest: f32,
}

impl ThinAlpha {
    /// Finds the range of alpha over some pixels; `None` where one has full alpha.
    pub fn of(mut pixels: impl Iterator<Item = Rgba>) -> Option<Self> {
        let none = Self { least: 1.0, greatest: 0.0 };
        pixels.try_fold(none, |Self { least, greatest }, pixel| {
            let alpha = pixel.alpha();
            (alpha < FULL).then(|| Self { least: least.min(alpha), greatest: greatest.max(alpha) })
        })
    }

    /// Returns the warning; `None` if alpha is the same everywhere, because a multiplier varies.
    pub fn told(self) -> Option<String> {
        (self.least < self.greatest).then(|| {
            format!(
                "no pixel's alpha is full: it is from {:.0} to {:.0} %. If it is a multiplier of the colours, as in RGBM and \
                 RGBD, and no coverage, what is made of it is almost transparent: make plain colours of it first, with the \
                 tool that wrote it",
                100.0 * self.least,
                100.0 * self.greatest
            )
        })
    }
}
