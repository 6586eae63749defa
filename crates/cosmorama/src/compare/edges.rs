use rayon::prelude::*;

use super::pair::Pair;
use super::{CompareError, Mask};
use crate::raster::{Image, Rgba};

/// Range of a channel among a pixel and its eight neighbours, in linear light, above which there is an edge.
const RANGE: f32 = 0.06;

/// Steps around an edge that a filter may have affected.
const REACH: u8 = 2;

/// Returns the compared pixels away from edges of the second picture.
///
/// At edges the filters of two renderers differ most; away from them their values must agree closely.
pub(super) fn edge_free(pair: &Pair<'_>) -> Result<Mask, CompareError> {
    pair.mask().without(&edges(pair.second()).grown(REACH))
}

fn edges(picture: &Image<Rgba>) -> Mask {
    let (width, height) = (picture.width(), picture.height());
    let mut edges = Image::filled(width, height, false);
    edges.pixels_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(j, row)| {
        let columns = columns_range(picture, j);
        for (i, edge) in row.iter_mut().enumerate() {
            let near = &columns[i.saturating_sub(1)..width.min(i + 2)];
            *edge = near.iter().copied().reduce(Range::with).is_some_and(|range| range.spread() > RANGE);
        }
    });
    edges.into()
}

/// Returns, by column, the range of the pixel in row `j` and those above and below it.
fn columns_range(picture: &Image<Rgba>, j: usize) -> Vec<Range> {
    let rows = j.saturating_sub(1)..picture.height().min(j + 2);
    let mut ranges: Vec<Range> = picture.row(j).iter().map(|&pixel| Range::of(pixel)).collect();
    for above_or_below in rows.filter(|&row| row != j) {
        for (range, &pixel) in ranges.iter_mut().zip(picture.row(above_or_below)) {
            *range = range.with(Range::of(pixel));
        }
    }
    ranges
}

/// Least and greatest values of red, green and blue.
#[derive(Clone, Copy)]
struct Range {
    low: [f32; 3],
    high: [f32; 3],
}

impl Range {
    fn of(pixel: Rgba) -> Self {
        let [red, green, blue, _] = pixel.finite().0;
        Self { low: [red, green, blue], high: [red, green, blue] }
    }

    fn with(self, other: Self) -> Self {
        Self {
            low: std::array::from_fn(|c| self.low[c].min(other.low[c])),
            high: std::array::from_fn(|c| self.high[c].max(other.high[c])),
        }
    }

    fn spread(self) -> f32 {
        (0..3).map(|c| self.high[c] - self.low[c]).fold(0.0, f32::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_reaches_three_pixels_to_each_side() {
        let step = Image::from_fn(12, 9, |i, _| if i < 6 { Rgba::BLACK } else { Rgba::opaque(0.0, 0.07, 0.0) });
        let mask = Mask::everything(12, 9);
        let smooth = edge_free(&Pair::new(&step, &step, &mask).unwrap()).unwrap();
        assert_eq!(smooth, Mask::from_fn(12, 9, |i, _| !(3..9).contains(&i)));
    }
}
