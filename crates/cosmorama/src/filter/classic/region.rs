use glam::{DMat2, DVec2};

use crate::camera::{Footprint, PixelPoint};
use crate::filter::gather::ellipse::widened;
use crate::filter::reference::look;
use crate::filter::traits::{Prepared, bounded};
use crate::raster::Rgba;
use crate::world::{Source, World};

/// A rule that weighs the texels of one view under a footprint.
pub(super) trait Region: Send + Sync {
    /// Calls `visit` with each texel that counts, at its column and row, and with its weight.
    fn texels(&self, seen: &Seen, visit: impl FnMut([i64; 2], f64));
}

/// A footprint as one view sees it.
pub(super) struct Seen<'a> {
    pub(super) source: &'a Source,
    pub(super) footprint: &'a Footprint,
    /// Place of its middle in the image.
    pub(super) place: DVec2,
    /// Derivatives of the place by screen x and y, in texels.
    pub(super) jacobian: DMat2,
}

/// Columns and rows, of a view or beyond its edges.
pub(super) struct Rectangle {
    pub(super) columns: std::ops::RangeInclusive<i64>,
    pub(super) rows: std::ops::RangeInclusive<i64>,
}

/// Greatest reach of a footprint in texels, beyond which an image has repeated itself, or ended, long before.
const FARTHEST: f64 = 1e6;

impl<'a> Seen<'a> {
    fn new(source: &'a Source, footprint: &'a Footprint) -> Option<Self> {
        let (pixel, jacobian) = source.view.texel_footprint(footprint)?;
        let place = DVec2::new(pixel.x, pixel.y);
        (place.is_finite() && jacobian.is_finite()).then_some(Self { source, footprint, place, jacobian })
    }

    /// Returns half the size of the box around the parallelogram whose sides are the derivatives.
    pub(super) fn half_box(&self) -> DVec2 {
        0.5 * (self.jacobian.x_axis.abs() + self.jacobian.y_axis.abs())
    }

    /// Returns the derivatives with short ones raised, so that a footprint has at least the size of a texel each way.
    pub(super) fn widened(&self) -> DMat2 {
        widened(self.jacobian, 1.0)
    }

    /// Returns the texels whose squares reach into a box around the footprint's middle, as far as the view has some.
    pub(super) fn texels_within(&self, half: DVec2) -> Rectangle {
        let half = half.min(DVec2::splat(FARTHEST));
        let (first, last) = ((self.place - half).floor(), (self.place + half).ceil());
        let (width, height) = (self.source.view.width() as i64, self.source.view.height() as i64);
        let columns = match self.source.period {
            // Once around is enough: further columns repeat the first.
            Some(period) => first.x as i64..=(last.x as i64 - 1).min(first.x as i64 + period as i64 - 1),
            None => (first.x as i64).max(0)..=(last.x as i64 - 1).min(width - 1),
        };
        Rectangle { columns, rows: (first.y as i64).max(0)..=(last.y as i64 - 1).min(height - 1) }
    }

    /// Returns the offset of a texel's centre from the footprint's middle.
    pub(super) fn offset(&self, [i, j]: [i64; 2]) -> DVec2 {
        DVec2::new(i as f64 + 0.5, j as f64 + 0.5) - self.place
    }

    /// Returns the centre of a texel.
    pub(super) fn centre([i, j]: [i64; 2]) -> PixelPoint {
        PixelPoint::new(i as f64 + 0.5, j as f64 + 0.5)
    }
}

/// A rule that weighs the texels of a world under a footprint.
pub(super) trait Weighing: Send + Sync {
    /// Calls `visit` with each texel that counts, by its place in the world's light, and with its weight.
    fn for_each_texel(&self, world: &World, footprint: &Footprint, visit: impl FnMut(usize, f64));
}

impl<R: Region> Weighing for R {
    fn for_each_texel(&self, world: &World, footprint: &Footprint, mut visit: impl FnMut(usize, f64)) {
        for source in world.sources() {
            let Some(seen) = reached(source, footprint) else { continue };
            self.texels(&seen, |[i, j], weight| {
                let Some(column) = source.column(i) else { return };
                let texel = j as usize * source.view.width() + column as usize;
                // Views that show one direction share it, so that nothing counts twice where they meet.
                let weight = weight * f64::from(source.solid_angles[texel]);
                if weight != 0.0 {
                    visit(source.offset + texel, weight);
                }
            });
        }
    }
}

/// Texels of a world's light, to be weighed.
pub(super) struct Weighed<'w, W> {
    pub(super) world: &'w World,
    pub(super) light: &'w [Rgba],
    pub(super) weighing: W,
}

impl<W: Weighing> Prepared for Weighed<'_, W> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        let Some(footprint) = bounded(footprint) else { return 0 };
        let mut count = 0;
        self.weighing.for_each_texel(self.world, &footprint, |_, _| count += 1);
        count
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let (mut sum, mut weights) = ([0f64; 4], 0f64);
        self.weighing.for_each_texel(self.world, &footprint, |texel, weight| {
            for (sum, channel) in sum.iter_mut().zip(self.light[texel].0) {
                *sum += weight * f64::from(channel);
            }
            weights += weight;
        });
        let mean = || Rgba(sum.map(|channel| (channel / weights) as f32));
        if weights > 0.0 { mean() } else { look(self.world, footprint.direction, self.light).unwrap_or_default() }
    }
}

/// Returns how a view sees a footprint; `None` if it shows nothing near it.
pub(super) fn reached<'a>(source: &'a Source, footprint: &'a Footprint) -> Option<Seen<'a>> {
    let width = footprint.jacobian.dx.length() + footprint.jacobian.dy.length();
    let reach = 2.0 * (width + source.texel_pitch);
    source.reaches(footprint.direction, reach).then(|| Seen::new(source, footprint))?
}
