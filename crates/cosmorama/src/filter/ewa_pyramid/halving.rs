//! Halving of a world's light: one level of a mip pyramid, with half as many columns and rows in each view.

use std::ops::Range;

use rayon::prelude::*;

use crate::camera::PixelPoint;
use crate::filter::rim::field_edge::FieldEdge;
use crate::raster::{Image, Rgba};
use crate::world::{Source, World, held};

/// Finer texels that make up each texel of a halved world. All of their area that counts contributes evenly.
///
/// A halved texel takes only texels of its own view that lie inside it. The filter blends across the edges of views,
/// among the texels of one level. Texels contribute by area in the image, not by solid angle, since the light must be
/// that of the halved texel's centre.
#[derive(Clone, Debug)]
pub(crate) struct Halving {
    views: Vec<HalvedView>,
}

#[derive(Clone, Debug)]
struct HalvedView {
    /// Index of the view's first texel, and the distance from one row to the next, in texels.
    offset: usize,
    stride: usize,
    columns: Vec<Parts>,
    rows: Vec<Parts>,
    /// Whether each halved texel is exactly 2 × 2 texels.
    is_even: bool,
    /// Parts that count, for each halved row in which some do not. Each halved texel has nine bits: three rows of three
    /// parts.
    counting: Vec<Option<Box<[u16]>>>,
}

/// Bits of a halved texel in which all parts count.
const ALL: u16 = 0b111_111_111;

/// Texels along one axis that overlap a halved texel: three at most, each with its share of the halved texel.
#[derive(Clone, Copy, Debug)]
struct Parts {
    first: usize,
    parts: [f32; MOST],
}

/// Greatest number of texels along one axis that overlap a halved texel. If five texels become three, the middle one
/// overlaps three.
const MOST: usize = 3;

impl Parts {
    fn of(size: usize, half: usize, index: usize) -> Self {
        let held = held(size, half, index);
        // In units of a texel divided by `half`, all edges are whole numbers.
        let (from, to) = (index * size, (index + 1) * size);
        let part =
            |texel: usize| to.min((texel + 1) * half).saturating_sub(from.max(texel * half)) as f32 / size as f32;
        let parts = std::array::from_fn(|k| if held.contains(&(held.start + k)) { part(held.start + k) } else { 0.0 });
        Self { first: held.start, parts }
    }

    fn all(size: usize) -> Vec<Self> {
        let half = size.div_ceil(2);
        (0..half).map(|index| Self::of(size, half, index)).collect()
    }

    /// Visits the parts: the number of each, its texel and its share.
    fn each(self) -> impl Iterator<Item = (usize, usize, f32)> {
        (0..MOST).filter(move |&k| self.parts[k] > 0.0).map(move |k| (k, self.first + k, self.parts[k]))
    }
}

/// Halves a flat picture: each texel is the mean of its area.
pub(super) fn halved(picture: &Image<Rgba>) -> Image<Rgba> {
    let (columns, rows) = (Parts::all(picture.width()), Parts::all(picture.height()));
    Image::from_fn(columns.len(), rows.len(), |i, j| {
        let cells = rows[j].each().flat_map(|(_, row, down)| {
            columns[i].each().map(move |(_, column, across)| *picture.get(column, row) * (across * down))
        });
        cells.fold(Rgba::TRANSPARENT, |sum, cell| sum + cell)
    })
}

impl Halving {
    /// Prepares the halving of a world. In a halved texel that the target's field of view cuts, only parts inside the
    /// field count.
    pub(crate) fn new(world: &World, halved: &World, edge: Option<FieldEdge>) -> Self {
        let views = world.sources().iter().zip(halved.sources());
        Self { views: views.map(|(source, coarse)| HalvedView::new(source, coarse, edge)).collect() }
    }

    /// Computes the light of the halved world.
    pub(crate) fn light(&self, texels: &[Rgba]) -> Vec<Rgba> {
        let size = |view: &HalvedView| view.columns.len() * view.rows.len();
        // Zeroed without touching the memory: each page is first touched by the thread that fills it.
        let mut halved: Vec<Rgba> = bytemuck::zeroed_vec(self.views.iter().map(size).sum());
        let mut rest = halved.as_mut_slice();
        for view in &self.views {
            let (these, others) = rest.split_at_mut(size(view));
            let rows = these.par_chunks_mut(view.columns.len()).enumerate();
            rows.for_each(|(row, into)| view.fill_row(row, texels, into));
            rest = others;
        }
        halved
    }

    /// Returns the number of bytes that the halving occupies.
    pub(crate) fn bytes(&self) -> usize {
        let bits = |view: &HalvedView| view.counting.iter().flatten().map(|bits| size_of_val(&**bits)).sum::<usize>();
        self.views.iter().map(bits).sum()
    }
}

/// Number of neighbouring halved texels that are tested together for the edge of the field of view.
const BLOCK: usize = 32;

impl HalvedView {
    fn new(source: &Source, coarse: &Source, edge: Option<FieldEdge>) -> Self {
        let (columns, rows) = (Parts::all(source.columns()), Parts::all(source.view.height()));
        let is_even = [source.columns(), source.view.height()].iter().all(|size| size.is_multiple_of(2));
        let (offset, stride) = (source.offset, source.view.width());
        let mut view = Self { offset, stride, columns, rows, is_even, counting: Vec::new() };
        let rows = (0..view.rows.len()).into_par_iter();
        view.counting = rows.map(|row| view.counting_of_row(row, (source, coarse), edge)).collect();
        view
    }

    /// Returns the bits of the parts that count in each texel of a halved row; `None` if all parts count.
    fn counting_of_row(
        &self,
        row: usize,
        (source, coarse): (&Source, &Source),
        edge: Option<FieldEdge>,
    ) -> Option<Box<[u16]>> {
        let width = self.columns.len();
        let has_light = |(_, j, _): (usize, usize, f32)| {
            source.solid_angles[j * self.stride..][..source.columns()].iter().all(|angle| *angle > 0.0)
        };
        let mut bits = if self.rows[row].each().all(has_light) {
            None
        } else {
            Some((0..width).map(|column| self.bits(source, [column, row], |_| true)).collect::<Box<[u16]>>())
        };
        let Some(edge) = edge else { return bits };
        for first in (0..width).step_by(BLOCK) {
            let columns = first..width.min(first + BLOCK);
            if !is_near_edge(&edge, coarse, row, &columns) {
                continue;
            }
            for column in columns {
                let seen = self.bits(source, [column, row], |texel| edge.touches(source, texel));
                // A halved texel wholly outside the field keeps its parts as they are.
                if seen > 0 {
                    bits.get_or_insert_with(|| vec![ALL; width].into())[column] = seen;
                }
            }
        }
        bits
    }

    /// Returns the bits of the parts that count in the halved texel at this column and row. `is_seen` takes the column
    /// and row of a finer texel.
    fn bits(&self, source: &Source, [column, row]: [usize; 2], is_seen: impl Fn([usize; 2]) -> bool) -> u16 {
        let mut bits = 0;
        for (y, j, _) in self.rows[row].each() {
            for (x, i, _) in self.columns[column].each() {
                let texel = j * self.stride + i;
                let counts = source.solid_angles[texel] > 0.0 && is_seen([i, j]);
                bits |= u16::from(counts) << (y * MOST + x);
            }
        }
        bits
    }

    fn fill_row(&self, row: usize, texels: &[Rgba], into: &mut [Rgba]) {
        match &self.counting[row] {
            Some(bits) => self.fill_counting(row, texels, into, bits.iter().copied()),
            None if self.is_even => self.fill_even(row, texels, into),
            None => self.fill_counting(row, texels, into, std::iter::repeat(ALL)),
        }
    }

    fn fill_even(&self, row: usize, texels: &[Rgba], into: &mut [Rgba]) {
        let [above, below] = [2 * row, 2 * row + 1].map(|j| &texels[self.offset + j * self.stride..][..2 * into.len()]);
        for ((pixel, above), below) in into.iter_mut().zip(above.chunks_exact(2)).zip(below.chunks_exact(2)) {
            *pixel = ((above[0] + above[1]) + (below[0] + below[1])) * 0.25;
        }
    }

    fn fill_counting(&self, row: usize, texels: &[Rgba], into: &mut [Rgba], counting: impl Iterator<Item = u16>) {
        for ((pixel, columns), bits) in into.iter_mut().zip(&self.columns).zip(counting) {
            let (mut sum, mut area) = (Rgba::TRANSPARENT, 0f32);
            for (y, j, height) in self.rows[row].each() {
                let first = self.offset + j * self.stride;
                for (x, i, width) in columns.each() {
                    let part = width * height * f32::from(bits >> (y * MOST + x) & 1);
                    sum += texels[first + i] * part;
                    area += part;
                }
            }
            *pixel = if area > 0.0 { sum * area.recip() } else { Rgba::TRANSPARENT };
        }
    }
}

/// Factor by which texels of a block may lie farther from its middle than its ends do, because mappings bend.
const BEND: f64 = 1.25;

/// Returns whether the edge of a field of view may cut any halved texel in these columns of a row.
fn is_near_edge(edge: &FieldEdge, coarse: &Source, row: usize, columns: &Range<usize>) -> bool {
    let direction = |column: usize| coarse.view.direction(PixelPoint::centre(column, row));
    let (first, last) = (columns.start, columns.end - 1);
    let [Some(from), Some(middle), Some(to)] = [first, (first + last) / 2, last].map(direction) else { return true };
    let reach = BEND * middle.angle_to(from).radians().max(middle.angle_to(to).radians());
    let reach = reach + coarse.texel_pitch_within(middle, reach);
    // Where all texels lie outside the field, the edge cuts none.
    edge.is_near(middle, reach) && !edge.is_far_beyond(middle, reach)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_what_lies_in_a_texel() {
        let parts = |size| Parts::all(size).iter().map(|parts| (parts.first, parts.parts)).collect::<Vec<_>>();
        assert_eq!(parts(4), [(0, [0.5, 0.5, 0.0]), (2, [0.5, 0.5, 0.0])]);
        let third = 1.0 / 3.0;
        assert_eq!(parts(3), [(0, [2.0 * third, third, 0.0]), (1, [third, 2.0 * third, 0.0])]);
        assert_eq!(parts(1), [(0, [1.0, 0.0, 0.0])]);
        for size in [5, 7, 99, 1001] {
            let mut sums = vec![0.0; size];
            for parts in Parts::all(size) {
                assert!((parts.parts.iter().sum::<f32>() - 1.0).abs() < 1e-6);
                parts.each().for_each(|(_, texel, part)| sums[texel] += part * size as f32 / size.div_ceil(2) as f32);
            }
            assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-5), "{size}: {sums:?}");
        }
    }
}
