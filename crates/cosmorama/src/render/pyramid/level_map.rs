use rayon::prelude::*;

use crate::camera::{PixelPoint, PixelRect, View};
use crate::filter::Kernel;
use crate::filter::ewa_pyramid::level::{LevelNeed, LevelRule, is_before, is_beyond, width};
use crate::filter::rim::field_edge::FieldEdge;
use crate::world::World;

/// Distance in pixels from the edge of the field of view within which levels are finer. Texels that the edge cuts have
/// the light of their remaining part, not of their centres.
const BESIDE_EDGE: usize = 3;

/// Least number of points along a picture's longer side between which levels are interpolated.
const POINTS: usize = 512;

/// Levels of a pyramid from which each pixel of a target is made.
///
/// A level is a number. From 2 on, a pixel is made from the second halved world; from [`BLENDED`] before 3, the third
/// is blended in more and more. The number is the logarithm of the footprint's minor axis among the texels of the view
/// that shows it. In large pictures it is interpolated between points a few pixels apart, so it is continuous across
/// the edges of views as well.
#[derive(Clone, Debug)]
pub(crate) struct LevelMap {
    /// Number of pixels from point to point, a power of two.
    step: usize,
    /// Number of points in a row.
    columns: usize,
    levels: Vec<f32>,
}

impl LevelMap {
    /// Computes the levels for a target whose field of view may end at an edge.
    pub(crate) fn new(world: &World, target: &View, kernel: &Kernel, edge: Option<FieldEdge>) -> Self {
        let rule = LevelRule::new(world, kernel);
        let longer = target.width().max(target.height());
        let step = 1 << (longer / POINTS).clamp(1, 8).ilog2();
        let [columns, rows] = [target.width(), target.height()].map(|size| size.div_ceil(step) + 1);
        let mut levels = vec![f32::NAN; columns * rows];
        levels.par_chunks_mut(columns).enumerate().for_each(|(j, row)| {
            for (i, level) in row.iter_mut().enumerate() {
                let at = PixelPoint::new((i * step) as f64 + first(step), (j * step) as f64 + first(step));
                let found = target.footprint(at).and_then(|footprint| {
                    let reach = (BESIDE_EDGE + step) as f64 * width(&footprint);
                    let is_cut = edge.is_some_and(|edge| edge.is_near(footprint.direction, reach));
                    rule.level(
                        world.owner_view(footprint.direction),
                        &footprint,
                        LevelNeed { is_cut, pixels_around: (step - 1) as f64 },
                    )
                });
                *level = found.map_or(f32::NAN, |level| level as f32);
            }
        });
        let mut map = Self { step, columns, levels };
        map.fill_gaps();
        map
    }

    /// Returns a map with the finest level everywhere.
    pub(crate) fn finest(target: &View) -> Self {
        let step = target.width().max(target.height()).max(1).next_power_of_two();
        Self { step, columns: 2, levels: vec![0.0; 4] }
    }

    /// Fills points that see nothing with the least level around them. Either some points beside them see something, or
    /// no pixel around them does.
    fn fill_gaps(&mut self) {
        for _ in 0..2 {
            let known = self.levels.clone();
            let rows = known.len() / self.columns;
            for (at, level) in self.levels.iter_mut().enumerate().filter(|(at, _)| known[*at].is_nan()) {
                let (i, j) = (at % self.columns, at / self.columns);
                let around = (j.saturating_sub(1)..rows.min(j + 2))
                    .flat_map(|j| (i.saturating_sub(1)..self.columns.min(i + 2)).map(move |i| (i, j)));
                let known = around.map(|(i, j)| known[j * self.columns + i]).filter(|level| !level.is_nan());
                *level = known.fold(f32::NAN, f32::min);
            }
        }
        self.levels.iter_mut().filter(|level| level.is_nan()).for_each(|level| *level = 0.0);
    }

    /// Limits the levels to the `coarsest`.
    pub(crate) fn limit(&mut self, coarsest: usize) {
        self.levels.iter_mut().for_each(|level| *level = level.min(coarsest as f32));
    }

    /// Returns the number of the coarsest level that is needed.
    pub(crate) fn coarsest(&self) -> usize {
        let most = self.levels.iter().fold(0f32, |most, level| most.max(*level));
        (0..).find(|level| is_beyond(most, *level)).map_or(0, |level| level - 1)
    }

    /// Returns the levels of the pixels of a row.
    pub(crate) fn row(&self, row: usize) -> impl Iterator<Item = f32> {
        let [above, below] = self.rows_around(row);
        let (_, t) = self.place(row);
        let points: Vec<f32> = above.iter().zip(below).map(|(above, below)| between([*above, *below], t)).collect();
        (0..).map(move |column| {
            let (i, s) = self.place(column);
            between([points[i], points[i + 1]], s)
        })
    }

    /// Interpolates the level at one pixel.
    pub(crate) fn at(&self, row: usize, column: usize) -> f32 {
        let [above, below] = self.rows_around(row);
        let ((_, t), (i, s)) = (self.place(row), self.place(column));
        between([between([above[i], below[i]], t), between([above[i + 1], below[i + 1]], t)], s)
    }

    /// Returns the rows of points above and below a row of pixels.
    fn rows_around(&self, row: usize) -> [&[f32]; 2] {
        let (j, _) = self.place(row);
        [j, j + 1].map(|j| &self.levels[j * self.columns..][..self.columns])
    }

    /// Returns the point before a pixel's centre, and the part of the way to the next point.
    fn place(&self, pixel: usize) -> (usize, f32) {
        // A shift, since a division would take longer than all else.
        let within = pixel & (self.step - 1);
        (pixel >> self.step.ilog2(), (within as f32 + 0.5 - first(self.step) as f32) / self.step as f32)
    }

    /// Returns bounds of the levels of the pixels in a rectangle: the least and the greatest, or somewhat less and
    /// more.
    fn range(&self, rect: PixelRect) -> [f32; 2] {
        let (left, right) = (rect.left / self.step, (rect.right - 1) / self.step + 2);
        let rows = rect.top / self.step..(rect.bottom - 1) / self.step + 2;
        rows.flat_map(|j| &self.levels[j * self.columns..][left..right])
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[least, most], &level| [least.min(level), most.max(level)])
    }

    /// Returns whether a pixel in a rectangle may be made from a level.
    pub(crate) fn needs(&self, level: usize, rect: PixelRect) -> bool {
        let [least, most] = self.range(rect);
        !is_beyond(most, level) && !is_before(least, level)
    }
}

/// Returns the position of the first of the points at which levels are measured, in pixels from the picture's edge.
///
/// It is the edge itself, so that points lie symmetrically. Where each pixel has a point of its own, as in small
/// pictures, it is the pixel's centre: there a pixel may be so wide that its corners look elsewhere.
fn first(step: usize) -> f64 {
    if step == 1 { 0.5 } else { 0.0 }
}

fn between([from, to]: [f32; 2], part: f32) -> f32 {
    from + (to - from) * part
}
