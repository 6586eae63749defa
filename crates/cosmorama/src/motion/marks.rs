use crate::camera::PixelRect;

/// Pixels along a cell's side.
pub(super) const CELL: usize = 8;

/// Cells of 8 × 8 pixels of a picture, some of which are marked.
#[derive(Clone, Debug)]
pub(super) struct Marks {
    across: usize,
    /// Row by row.
    marks: Vec<bool>,
}

impl Marks {
    /// Marks some cells, which are given row by row, of a picture that has so many `across`.
    pub(super) fn new(marks: Vec<bool>, across: usize) -> Self {
        Self { across, marks }
    }

    /// Returns the number of marked cells.
    pub(super) fn count(&self) -> usize {
        self.marks.iter().filter(|mark| **mark).count()
    }

    /// Returns the marks of the cells that a row of pixels crosses.
    pub(super) fn row(&self, row: usize) -> &[bool] {
        &self.marks[row / CELL * self.across..][..self.across]
    }

    /// Returns whether any cell that has a part of a rectangle is marked.
    pub(super) fn meet(&self, rect: PixelRect) -> bool {
        let mut rows = rect.top / CELL..rect.bottom.div_ceil(CELL);
        rows.any(|row| self.row(row * CELL)[rect.left / CELL..rect.right.div_ceil(CELL)].contains(&true))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_meet_the_cells_of_which_they_have_a_part() {
        // 9 × 10 cells, the last of each row and column cut.
        let marked = [[0, 0], [8, 3], [4, 4], [8, 9]];
        let marks = Marks::new((0..90).map(|at| marked.contains(&[at % 9, at / 9])).collect(), 9);
        assert_eq!(marks.count(), 4);
        let (width, height) = (70, 75);
        for (i, j) in (0..width * height).map(|at| (at % width, at / width)) {
            assert_eq!(marks.row(j)[i / 8], marked.contains(&[i / 8, j / 8]));
            let rect = PixelRect { left: i, top: j, right: width.min(i + 8), bottom: height.min(j + 8) };
            let mut pixels = (rect.left..rect.right).flat_map(|i| (rect.top..rect.bottom).map(move |j| [i, j]));
            assert_eq!(marks.meet(rect), pixels.any(|[i, j]| marks.row(j)[i / 8]), "{rect:?}");
        }
    }
}
