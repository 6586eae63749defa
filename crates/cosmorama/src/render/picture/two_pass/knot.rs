use glam::DVec2;

use crate::filter::Passes;

/// Greatest difference between the step to the next pixel and what derivatives say, as a part of the step.
const BENT: f64 = 0.5;

/// A pixel of a line, as one view sees it. Axes of the view are exchanged where its columns come first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    /// Index of the pixel in its line.
    pub(super) at: usize,
    /// Place in the view: along the first pass, and along the second.
    pub(super) place: DVec2,
    /// Step along the first pass for a step along the second.
    pub(super) shear: f64,
    /// Texels in a pixel, in each pass.
    pub(super) units: DVec2,
    /// Texels along the second pass to the next pixel.
    step: f64,
    pub(super) columns_first: bool,
}

impl Knot {
    pub(super) fn new(at: usize, passes: &Passes) -> Self {
        let Passes { units, step, shear, columns_first, .. } = *passes;
        Self { at, place: passes.turned(passes.place), shear, units, step, columns_first }
    }

    /// Returns the knot of the next pixel if it goes on from here: the same way, not back, and without a jump. Of a
    /// panorama's turns it is in the nearest.
    pub(super) fn next(&self, next: Self, period: Option<usize>) -> Option<Self> {
        if next.columns_first != self.columns_first || next.step * self.step <= 0.0 {
            return None;
        }
        let ahead = 0.5 * (self.step + next.step);
        let expected = self.place + ahead * DVec2::new(0.5 * (self.shear + next.shear), 1.0);
        let mut place = next.place;
        if let Some(period) = period.map(|period| period as f64) {
            let across = if self.columns_first { &mut place.y } else { &mut place.x };
            let there = if self.columns_first { expected.y } else { expected.x };
            *across += period * ((there - *across) / period).round();
        }
        let is_near = (place - expected).abs().max_element() <= BENT * ahead.abs();
        is_near.then_some(Self { place, ..next })
    }
}
