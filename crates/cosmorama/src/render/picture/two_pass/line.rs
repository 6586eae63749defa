use super::branch::Branch;
use super::knot::Knot;
use super::sweep::{Sum, Sweep};
use crate::camera::Footprint;
use crate::filter::traits::bounded;
use crate::world::Source;

/// A line of the screen that second passes follow.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line {
    Column(usize),
    Row(usize),
}

impl Line {
    /// Returns the place of a pixel of the line on the screen.
    fn pixel(self, k: usize) -> (usize, usize) {
        match self {
            Self::Column(i) => (i, k),
            Self::Row(j) => (k, j),
        }
    }
}

impl Sweep<'_> {
    /// Sums all views along a line, in the pixels whose second pass follows it.
    pub(super) fn line(&self, line: Line) -> Vec<Sum> {
        let length = match line {
            Line::Column(_) => self.target.height(),
            Line::Row(_) => self.target.width(),
        };
        let footprint = |k: usize| {
            let (i, j) = line.pixel(k);
            bounded(&self.target.screen_pixel(i, j)?.footprint)
        };
        let footprints: Vec<Option<Footprint>> = (0..length).map(footprint).collect();
        let mut sums = vec![Sum::default(); length];
        for source in self.world.sources() {
            let mut branch: Vec<Knot> = Vec::new();
            for (at, footprint) in footprints.iter().enumerate() {
                let knot = footprint.as_ref().and_then(|footprint| self.knot(source, line, at, footprint));
                let next = match (knot, branch.last()) {
                    (Some(knot), Some(last)) => last.next(knot, source.period),
                    _ => None,
                };
                if next.is_none() && !branch.is_empty() {
                    Branch::new(self, source, std::mem::take(&mut branch)).sweep(&mut sums);
                }
                branch.extend(next.or(knot));
            }
            if !branch.is_empty() {
                Branch::new(self, source, branch).sweep(&mut sums);
            }
        }
        sums
    }

    /// Returns how a view makes a pixel of a line; `None` if it shows nothing there, or if the pixel follows a line of the other
    /// direction.
    fn knot(&self, source: &Source, line: Line, at: usize, footprint: &Footprint) -> Option<Knot> {
        let passes = self.kernel.passes(source, footprint)?;
        let is_along = passes.follows_columns == matches!(line, Line::Column(_));
        is_along.then(|| Knot::new(at, &passes))
    }
}
