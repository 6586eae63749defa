use super::span::Run;
use super::tap_lists::Singles;
use super::weights::Weights;
use super::window_format::Format;
use crate::render::scan::tile::SIDE;

/// Geometry of a few rows of a target.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band<F> {
    pub(crate) runs: Vec<Run>,
    pub(crate) weights: Weights<F>,
    pub(crate) singles: Singles,
}

impl<F: Format> Band<F> {
    /// Clears the band but keeps its memory.
    pub(crate) fn clear(&mut self) {
        self.runs.clear();
        self.weights.truncate(0);
        self.singles.clear();
    }

    /// Sorts the windows into the order in which they are processed fastest, and frees unused memory.
    pub(crate) fn settle(&mut self) {
        self.runs.shrink_to_fit();
        self.weights.settle(groups(&self.runs));
        self.singles.shrink();
    }

    /// Returns the groups: runs of one patch that lie in one view, at most [`SIDE`] each. In each mirror image, the
    /// runs of a group share most of their texels.
    pub(crate) fn groups(&self) -> impl Iterator<Item = &[Run]> + Clone {
        groups(&self.runs)
    }

    /// Returns the last group if a run in this view that begins at this pixel belongs to it; else nothing.
    pub(crate) fn open_group(&self, pixel: [usize; 2], view: usize) -> &[Run] {
        let last = self.runs.chunk_by(are_grouped).next_back().unwrap_or_default();
        let is_open = |run: &Run| run.shares_patch(pixel) && usize::from(run.view) == view && last.len() < SIDE;
        if last.first().is_some_and(is_open) { last } else { &[] }
    }

    /// Returns the number of bytes that the band takes.
    pub(crate) fn bytes(&self) -> usize {
        self.runs.capacity() * size_of::<Run>() + self.weights.bytes() + self.singles.bytes()
    }

    /// Returns the number of bytes in use, without spare capacity.
    pub(crate) fn used_bytes(&self) -> usize {
        size_of_val(&*self.runs) + self.weights.used_bytes() + self.singles.used_bytes()
    }
}

fn groups(runs: &[Run]) -> impl Iterator<Item = &[Run]> + Clone {
    runs.chunk_by(are_grouped)
}

/// Returns whether the weights of two runs are kept together.
fn are_grouped(a: &Run, b: &Run) -> bool {
    a.weights == b.weights
}
