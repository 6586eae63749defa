use crate::camera::View;
use crate::filter::FilterSettings;
use crate::raster::{Image, Rgba};
use crate::render::{Progress, Resampler, Sampling, Share, Stopped, wanted};
use crate::world::World;

/// Pixels along a cell's side.
pub(super) const CELL: usize = 8;

/// Rows of cells in a strip.
const ROWS: usize = 4;

/// Cells of a picture that are made moment by moment: some of those in a few rows of cells.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    /// First column and first row of the rectangle that holds them, in pixels.
    first: [usize; 2],
    size: [usize; 2],
    /// First column and first row of each cell in the rectangle, in pixels.
    cells: Vec<[usize; 2]>,
}

impl Strip {
    /// Gathers the marked cells of a picture of this many columns and rows of pixels; they are marked row by row.
    pub(super) fn all(is_marked: &[bool], [width, height]: [usize; 2]) -> Vec<Self> {
        let across = width.div_ceil(CELL).max(1);
        let strip = |(index, marks): (usize, &[bool])| {
            let marked =
                || marks.iter().enumerate().filter(|(_, mark)| **mark).map(|(at, _)| [at % across, at / across]);
            let (left, right) = (marked().map(|[i, _]| i).min()?, marked().map(|[i, _]| i).max()?);
            let first = [left * CELL, index * ROWS * CELL];
            let size = [width.min((right + 1) * CELL) - first[0], (height - first[1]).min(ROWS * CELL)];
            Some(Self { first, size, cells: marked().map(|[i, j]| [(i - left) * CELL, j * CELL]).collect() })
        };
        is_marked.chunks(across * ROWS).enumerate().filter_map(strip).collect()
    }

    /// Fills the cells with the mean of some views.
    pub(super) fn fill(
        &self,
        image: &mut Image<Rgba>,
        views: &[(View, f32)],
        (world, filter): (&World, FilterSettings),
        texels: &[Rgba],
        progress: &dyn Progress,
    ) -> Result<(), Stopped> {
        let total: f32 = views.iter().map(|(_, weight)| weight).sum();
        let whole = image.width();
        self.each_pixel(|_, at| image.pixels_mut()[at] = Rgba::TRANSPARENT, whole);
        for (index, (view, weight)) in views.iter().enumerate() {
            let done = |index: usize| index as f64 / views.len() as f64;
            let share = Share { whole: progress, from: done(index), to: done(index + 1) };
            let ([width, height], [x, y]) = (self.size, self.first);
            let part = View { grid: view.grid.window(width, height, x as f64, y as f64), ..view.clone() };
            let resampler = Resampler { world, target: &part, filter };
            let wanted = wanted(&resampler, |rect| {
                self.cells
                    .iter()
                    .any(|[i, j]| rect.left < i + CELL && *i < rect.right && rect.top < j + CELL && *j < rect.bottom)
            });
            let made = resampler.render_sampled(Sampling::only(&wanted), texels, &share)?;
            self.each_pixel(|from, at| image.pixels_mut()[at] += made.pixels()[from] * (weight / total), whole);
        }
        Ok(())
    }

    /// Visits each pixel of the cells: its index in a picture of the rectangle, and in one of the given width.
    fn each_pixel(&self, mut visit: impl FnMut(usize, usize), width: usize) {
        for [i, j] in &self.cells {
            for row in *j..self.size[1].min(j + CELL) {
                for column in *i..self.size[0].min(i + CELL) {
                    visit(row * self.size[0] + column, (row + self.first[1]) * width + column + self.first[0]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_hold_the_marked_cells_and_no_others() {
        // 9 × 10 cells, the last of each row and column cut.
        let [width, height] = [70, 75];
        let marked = [[0, 0], [8, 3], [4, 4], [8, 9]];
        let is_marked: Vec<bool> = (0..90).map(|at| marked.contains(&[at % 9, at / 9])).collect();
        let mut found = vec![0; width * height];
        for strip in Strip::all(&is_marked, [width, height]) {
            let mut inside = vec![false; strip.size[0] * strip.size[1]];
            strip.each_pixel(
                |from, at| {
                    inside[from] = true;
                    found[at] += 1;
                },
                width,
            );
        }
        for (at, count) in found.iter().enumerate() {
            assert_eq!(*count == 1, marked.contains(&[at % width / 8, at / width / 8]), "{at}: {count}");
        }
    }
}
