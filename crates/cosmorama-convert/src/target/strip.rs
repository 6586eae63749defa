//! Strips of pictures that are too large to be made at once.

use std::ops::Range;

use cosmorama::camera::View;

use crate::target::{Sheet, Target, TargetView};

/// Rows of a file's picture, with the parts of views that lie there.
#[derive(Clone, Debug)]
pub(crate) struct Strip {
    /// Index of the file.
    pub(crate) file: usize,
    /// Rows.
    pub(crate) rows: Range<usize>,
    /// Sheet of these rows alone, whose pieces are the parts.
    pub(crate) sheet: Sheet,
    /// Index of a view, and its rows.
    parts: Vec<(usize, Range<usize>)>,
}

impl Strip {
    /// Returns the strip of these rows of one of a target's files.
    pub(crate) fn of(target: &Target, file: usize, rows: Range<usize>) -> Self {
        let whole = &target.files[file].sheet;
        let (mut pieces, mut parts) = (Vec::new(), Vec::new());
        for &(index, (left, top)) in &whole.pieces {
            let (first, end) = (rows.start.max(top), rows.end.min(top + target.views[index].view.height()));
            if first < end {
                pieces.push((parts.len(), (left, first - rows.start)));
                parts.push((index, first - top..end - top));
            }
        }
        let sheet = Sheet { size: (whole.size.0, rows.len()), pieces };
        Self { file, rows, sheet, parts }
    }

    /// Visits the strips of all of a target's files, of so many rows.
    pub(crate) fn all(target: &Target, rows: usize) -> impl Iterator<Item = Self> {
        let sizes = target.files.iter().map(|file| file.sheet.size).enumerate();
        sizes.flat_map(move |(file, (_, height))| {
            (0..height).step_by(rows).map(move |top| Self::of(target, file, top..height.min(top + rows)))
        })
    }

    /// Returns the parts of the target's views, in whatever pose these are.
    pub(crate) fn views(&self, whole: &[TargetView]) -> Vec<TargetView> {
        self.parts.iter().map(|(index, rows)| whole[*index].rows(rows.clone())).collect()
    }

    /// Visits the indices of the views of which it has parts.
    pub(crate) fn indices(&self) -> impl Iterator<Item = usize> {
        self.parts.iter().map(|(index, _)| *index)
    }
}

impl TargetView {
    /// Returns the view of some of its rows.
    pub(crate) fn rows(&self, rows: Range<usize>) -> Self {
        let grid = self.view.grid.window(self.view.width(), rows.len(), 0.0, rows.start as f64);
        Self { view: View { grid, ..self.view.clone() }, ..self.clone() }
    }
}
