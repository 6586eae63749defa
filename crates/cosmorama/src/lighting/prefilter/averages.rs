use rayon::prelude::*;

use super::Lobe;
use crate::camera::View;
use crate::raster::{Image, Rgba};
use crate::sphere::Direction;

/// Averages of a world's light under lobes.
///
/// An average is premultiplied by the part of the lobe in which the world shows something. Where it shows all, alpha is one.
pub trait LobeAverages: Sync {
    /// Returns the solid angle in which the world shows something, in steradians.
    fn shown(&self) -> f64;

    /// Returns whether the world shows the whole sphere, but for what the rims of lenses may lack.
    fn is_complete(&self) -> bool {
        Normalisation::of(self.shown()) == Normalisation::Complete
    }

    /// Returns the average under a lobe about each axis.
    fn averages(&self, axes: &[Direction], lobe: &Lobe) -> Vec<Rgba>;

    /// Returns the average under a lobe about an axis.
    fn average(&self, axis: Direction, lobe: &Lobe) -> Rgba {
        self.averages(&[axis], lobe)[0]
    }

    /// Makes a picture in which each pixel is the average about its direction. `unseen` is the light of directions in which the
    /// world shows nothing. Pixels outside the target's field of view are transparent.
    fn picture(&self, target: &View, lobe: &Lobe, unseen: Rgba) -> Image<Rgba> {
        let mut image = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
        let (mut pixels, mut seen) = (by_tiles(target.width(), target.height()), Vec::new());
        loop {
            let some: Vec<[usize; 2]> = pixels.by_ref().take(AT_ONCE).collect();
            let is_end = some.is_empty();
            seen.par_extend(some.into_par_iter().filter_map(|pixel| SeenPixel::of(target, pixel)));
            // Pixels that share their work stay together, whatever is held at once.
            let count = if is_end { seen.len() } else { seen.len() - seen.len() % TOGETHER };
            let axes: Vec<Direction> = seen[..count].iter().map(|pixel| pixel.axis).collect();
            for (pixel, average) in seen.drain(..count).zip(self.averages(&axes, lobe)) {
                image.pixels_mut()[pixel.index] = average.over(unseen) * pixel.coverage;
            }
            if is_end {
                return image;
            }
        }
    }
}

/// Pixels of a picture whose averages are made at once: enough for all threads.
const AT_ONCE: usize = 1 << 16;

/// Multiple of the numbers of axes that share work.
const TOGETHER: usize = 1 << 12;

/// A pixel that shows something.
struct SeenPixel {
    /// Place in the image, row by row.
    index: usize,
    axis: Direction,
    /// Part of the pixel inside the field of view.
    coverage: f32,
}

impl SeenPixel {
    fn of(target: &View, [i, j]: [usize; 2]) -> Option<Self> {
        let screen = target.screen_pixel(i, j)?;
        let index = j * target.width() + i;
        Some(Self { index, axis: screen.footprint.direction, coverage: screen.coverage as f32 })
    }
}

/// Columns and rows of the tiles in which pixels follow one another: near axes share most of their work.
const TILE: [usize; 2] = [4, 2];

/// Returns the columns and rows of an image's pixels, tile by tile.
fn by_tiles(width: usize, height: usize) -> impl Iterator<Item = [usize; 2]> {
    let [across, down] = TILE;
    let tiles = (0..height).step_by(down).flat_map(move |top| (0..width).step_by(across).map(move |left| (left, top)));
    tiles.flat_map(move |(left, top)| {
        let rows = top..(top + down).min(height);
        rows.flat_map(move |j| (left..(left + across).min(width)).map(move |i| [i, j]))
    })
}

/// Rule by which sums become averages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::lighting) enum Normalisation {
    /// The world shows all the sphere: sums are divided by the weights that were summed.
    Complete,
    /// It does not: sums are divided by the lobe's integral, and alpha is what is shown of that.
    Partial,
}

/// Largest part of the sphere that a complete world may lack: pixels at the rims of lenses are not exact.
const LACKING: f64 = 1e-3;

impl Normalisation {
    /// Returns the rule for a world that shows so much, in steradians.
    pub(in crate::lighting) fn of(shown: f64) -> Self {
        let whole = 4.0 * std::f64::consts::PI;
        if shown > whole * (1.0 - LACKING) { Self::Complete } else { Self::Partial }
    }

    /// Returns the average of sums of red, green, blue and opacity.
    pub(in crate::lighting) fn average(self, [red, green, blue, shown]: [f64; 4], lobe: &Lobe) -> Rgba {
        let whole = match self {
            Self::Complete => shown,
            Self::Partial => shown.max(lobe.integral()),
        };
        if whole <= 0.0 {
            return Rgba::TRANSPARENT;
        }
        Rgba([red, green, blue, shown].map(|sum| (sum / whole) as f32))
    }
}
