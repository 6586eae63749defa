use std::ops::Range;

use fearless_simd::dispatch;

use super::band::{Corners, Run};
use super::fixed_check::is_sound;
use super::stored::Stored;
use super::weights::Weights;
use crate::resample::patch::SIDE;
use crate::resample::window::Windows;

/// The weights of windows as integers, pixel by pixel, row by row, two beside each other in each number.
///
/// Before those of a pixel stands a [`Header`]; then, if its window is not of one of the [`Shape::SMALL`] sizes, which texels lie under
/// the pixel, [`mark_words`] numbers for each row that has some.
#[derive(Clone, Debug, Default)]
pub(in crate::resample) struct FixedWeights {
    pub(super) numbers: Vec<u32>,
    rounded: Rounded,
}

/// The size of a pixel's window: how many pairs of texels across, and how many rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape {
    pub(super) pairs: usize,
    pub(super) height: usize,
    /// The first of the [`ROWS_UNDER`] rows outside which no texel of a small window lies under the pixel.
    pub(super) under: usize,
}

/// Rows of a small window that may hold texels under the pixel.
pub(super) const ROWS_UNDER: usize = 3;

impl Shape {
    /// Where a kernel is as small as may be.
    pub(super) const SMALL: [Self; 6] = [
        Self::new(2, 4, 0),
        Self::new(2, 4, 1),
        Self::new(2, 5, 1),
        Self::new(3, 4, 0),
        Self::new(3, 4, 1),
        Self::new(3, 5, 1),
    ];

    const fn new(pairs: usize, height: usize, under: usize) -> Self {
        Self { pairs, height, under }
    }
}

/// What is known of a pixel's window.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header(pub(super) u32);

impl Header {
    /// In place of an index of [`Shape::SMALL`]: as large as the run's windows are.
    const LARGE: u32 = 7;

    fn new(small: Option<usize>, bits: u32, marks: u32) -> Self {
        Self(small.map_or(Self::LARGE, |index| index as u32) | bits << 3 | marks << 8)
    }

    /// The index of its shape among the small ones; more, if it is none.
    #[inline(always)]
    pub(super) fn shape(self) -> u32 {
        self.0 & 7
    }

    /// By how many bits the weights are scaled.
    #[inline(always)]
    pub(super) fn bits(self) -> u32 {
        self.0 >> 3 & 31
    }

    /// Which texels of a small window lie under the pixel: a bit for each of those rows' texels.
    #[inline(always)]
    pub(super) fn marks(self) -> u32 {
        self.0 >> 8
    }
}

/// How many numbers tell of a row of so many pairs which texels lie under the pixel.
#[inline(always)]
pub(super) fn mark_words(pairs: usize) -> usize {
    pairs.div_ceil(16)
}

/// The windows of a run before they are sorted by pixel. Bits of bytes are lanes, until they are turned.
#[derive(Clone, Debug, Default)]
struct Rounded {
    width: usize,
    height: usize,
    /// By how many bits weights are scaled.
    bits: u32,
    /// Row by row, by lane. On both sides of each row stands a zero.
    weights: Vec<[i16; SIDE]>,
    /// In which lanes a texel lies under the pixel; the same zeros beside.
    under: Vec<u8>,
    /// Where small windows are.
    small: Option<Small>,
}

/// Of windows with eight columns and rows at most, by lane.
#[derive(Clone, Copy, Debug)]
struct Small {
    /// The columns and rows with a weight or a texel under the pixel, and the rows with a texel under it, a bit for each.
    columns: [u8; SIDE],
    rows: [u8; SIDE],
    rows_under: [u8; SIDE],
    /// The columns of the texels under the pixel, by row.
    under: [[u8; SIDE]; SIDE],
}

/// A number so large that what is added to it is rounded to an integer, which its last bits then hold.
const ROUNDER: f32 = 12_582_912.0;

/// Where a lane's window begins among those of a run, one to the left of them at the least.
#[derive(Clone, Copy, Debug)]
struct Place {
    column: isize,
    row: usize,
}

impl Rounded {
    /// Rounds the weights of all lanes; false if they are too large. What rounding takes from one texel the next one has: each
    /// lane's sum is exactly one, but where the last weight would be one itself, which 16 bits do not hold.
    #[inline(always)]
    fn fill(&mut self, windows: &Windows) -> bool {
        let Some(bits) = scale(windows) else { return false };
        (self.width, self.height, self.bits) = (windows.width(), windows.height(), bits);
        let (pitch, height) = (self.pitch(), self.height);
        refill(&mut self.under, pitch * height, 0);
        refill(&mut self.weights, pitch * height, [0; SIDE]);
        let (mut columns, mut rows) = ([0; SIDE], [0; SIDE]);
        let scale = (1 << bits) as f32;
        let (mut sums, mut before) = ([0f32; SIDE], [ROUNDER.to_bits(); SIDE]);
        let mut texels = windows.texels();
        for row in 0..height {
            let into = self.weights[row * pitch + 1..][..self.width].iter_mut();
            let under = self.under[row * pitch + 1..][..self.width].iter_mut();
            for (column, (into, under)) in into.zip(under).enumerate() {
                let Some((weights, beyond)) = texels.next() else { break };
                for lane in 0..SIDE {
                    sums[lane] += weights[lane] * scale;
                    let sum = (sums[lane] + ROUNDER).to_bits();
                    let step = (sum.wrapping_sub(before[lane]) as i32).min(i32::from(i16::MAX));
                    into[lane] = step as i16;
                    before[lane] = before[lane].wrapping_add_signed(step);
                }
                *under = lanes(&beyond.map(|beyond| beyond == 0.0));
                let counts = lanes(&into.map(|weight| weight != 0)) | *under;
                columns[column % SIDE] |= counts;
                rows[row % SIDE] |= counts;
            }
        }
        self.small = (self.width <= SIDE && height <= SIDE).then(|| self.turned(columns, rows));
        true
    }

    /// Numbers from one row to the next.
    fn pitch(&self) -> usize {
        self.width + 2
    }

    /// What is known of small windows, sorted by lane.
    #[inline(always)]
    fn turned(&self, columns: [u8; SIDE], rows: [u8; SIDE]) -> Small {
        let (mut under, mut rows_under) = ([[0; SIDE]; SIDE], [0; SIDE]);
        for (row, from) in self.under.chunks_exact(self.pitch()).enumerate().take(SIDE) {
            under[row][..self.width].copy_from_slice(&from[1..=self.width]);
            rows_under[row] = from.iter().fold(0, |all, lanes| all | lanes);
            under[row] = transposed(under[row]);
        }
        Small { columns: transposed(columns), rows: transposed(rows), rows_under: transposed(rows_under), under }
    }

    /// The smallest of the small shapes that holds a lane's window, by its index, and where it begins.
    #[inline(always)]
    fn small(&self, lane: usize) -> Option<(usize, Place)> {
        let small = self.small.as_ref()?;
        let [columns, rows, under] = [small.columns[lane], small.rows[lane], small.rows_under[lane]].map(span);
        for (index, shape) in Shape::SMALL.iter().enumerate() {
            let (width, height) = (2 * shape.pairs, shape.height);
            let is_inside = columns.len() <= width && rows.len() <= height;
            let has_room = width <= self.width + 1 && height <= self.height;
            let column = columns.start.min(self.width.saturating_sub(width));
            let row = rows.start.min(self.height.saturating_sub(height));
            let first = row + shape.under;
            if is_inside && has_room && first <= under.start && under.end <= first + ROWS_UNDER {
                return Some((index, Place { column: column as isize, row }));
            }
        }
        None
    }

    /// Which texels of a row of a lane's small window lie under the pixel, a bit for each.
    #[inline(always)]
    fn small_marks(&self, lane: usize, place: Place, row: usize, pairs: usize) -> u32 {
        let columns = self.small.as_ref().map_or(0, |small| u32::from(small.under[(place.row + row) % SIDE][lane]));
        columns << 1 >> (place.column + 1) & ((1 << (2 * pairs)) - 1)
    }

    /// The same of 16 pairs at most of any window.
    fn marks(&self, lane: usize, place: Place, row: usize, pairs: Range<usize>) -> u32 {
        let first = (place.row + row) * self.pitch() + (place.column + 1) as usize;
        let under = &self.under[first + 2 * pairs.start..first + 2 * pairs.end];
        under.iter().enumerate().fold(0, |marks, (at, lanes)| marks | u32::from(lanes >> lane & 1) << at)
    }

    /// The weights of a row of a lane's window, pair by pair.
    #[inline(always)]
    fn pairs(&self, lane: usize, place: Place, row: usize, pairs: usize) -> impl Iterator<Item = u32> {
        let first = (place.row + row) * self.pitch() + (place.column + 1) as usize;
        let weights = self.weights[first..][..2 * pairs].as_chunks().0;
        weights.iter().map(move |[a, b]| u32::from(a[lane] as u16) | u32::from(b[lane] as u16) << 16)
    }
}

/// Fills all of a vector anew.
fn refill<T: Copy>(vector: &mut Vec<T>, length: usize, value: T) {
    vector.clear();
    vector.resize(length, value);
}

/// A bit for each lane of which something is so.
#[inline(always)]
fn lanes(are_so: &[bool; SIDE]) -> u8 {
    (0..SIDE).fold(0, |lanes, lane| lanes | u8::from(are_so[lane]) << lane)
}

/// From the first bit to the last.
#[inline(always)]
fn span(bits: u8) -> Range<usize> {
    bits.trailing_zeros() as usize % 8..8 - bits.leading_zeros() as usize
}

/// Bits of eight bytes turned: the first of each in the first byte (Warren, Hacker's Delight, 7-3).
#[inline(always)]
fn transposed(bytes: [u8; SIDE]) -> [u8; SIDE] {
    let mut bits = u64::from_le_bytes(bytes);
    for (shift, mask) in [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)] {
        let changed = (bits ^ bits >> shift) & mask;
        bits ^= changed ^ changed << shift;
    }
    bits.to_le_bytes()
}

/// By how many bits weights are scaled, so that sums of products fit into 32.
#[inline(always)]
fn scale(windows: &Windows) -> Option<u32> {
    let (mut largest, mut size) = ([0f32; SIDE], [0f32; SIDE]);
    for (weights, _) in windows.texels() {
        for lane in 0..SIDE {
            largest[lane] = largest[lane].max(weights[lane].abs());
            size[lane] += weights[lane].abs();
        }
    }
    let [largest, size] = [largest, size].map(|lanes| lanes.into_iter().fold(0f32, f32::max));
    if largest < 1.0 && size < 1.9 {
        Some(15)
    } else if largest < 1.99 && size < 3.9 {
        Some(14)
    } else {
        None
    }
}

impl FixedWeights {
    /// Writes down a lane's window, and where it begins; false if that cannot be.
    #[inline(always)]
    fn write(&mut self, windows: &Windows, lane: usize, corner: &mut [u32; 2]) -> bool {
        let Rounded { width, height, bits, .. } = self.rounded;
        let small = self.rounded.small(lane);
        let (shape, mut place) = match small {
            Some((index, place)) => (Shape::SMALL[index], place),
            None => (Shape::new(width.div_ceil(2), height, 0), Place { column: 0, row: 0 }),
        };
        let pairs = shape.pairs;
        // A window of whole pairs may reach beyond the view; then it begins earlier, if it can.
        let (whole, left) = (windows.columns_within(), corner[0] as isize);
        place.column -= (left + place.column + 2 * pairs as isize - whole.end as isize).max(0);
        if place.column < -1 || left + place.column < whole.start as isize {
            return false;
        }
        *corner = [(left + place.column) as u32, corner[1] + place.row as u32];
        let Self { numbers, rounded } = self;
        if let Some((index, _)) = small {
            let marks = |row| rounded.small_marks(lane, place, shape.under + row, pairs) << (2 * pairs * row);
            numbers.push(Header::new(Some(index), bits, (0..ROWS_UNDER).fold(0, |all, row| all | marks(row))).0);
        } else {
            numbers.push(Header::new(None, bits, 0).0);
            let words = |row| (0..pairs).step_by(16).map(move |first| (row, first..pairs.min(first + 16)));
            let words = windows.rows_under().flat_map(words);
            numbers.extend(words.map(|(row, pairs)| rounded.marks(lane, place, row, pairs)));
        }
        for row in 0..shape.height {
            numbers.extend(rounded.pairs(lane, place, row, pairs));
        }
        true
    }

    #[inline(always)]
    fn keep_lanes(&mut self, windows: &Windows, corners: &mut Corners) -> bool {
        if !self.rounded.fill(windows) {
            return false;
        }
        let length = self.numbers.len();
        for (lane, corner) in corners.iter_mut().enumerate() {
            let Some(corner) = corner else { continue };
            if !self.write(windows, lane, corner) {
                self.numbers.truncate(length);
                return false;
            }
        }
        true
    }
}

impl Stored for FixedWeights {
    const LEAST: usize = Vec::<u32>::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        self.numbers.store(into);
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        Some(Self { numbers: Vec::load(from)?, rounded: Rounded::default() })
    }
}

impl Weights for FixedWeights {
    fn len(&self) -> usize {
        self.numbers.len()
    }

    fn keep(&mut self, windows: &Windows, corners: &mut Corners) -> bool {
        let level = windows.level();
        dispatch!(level, _simd => self.keep_lanes(windows, corners))
    }

    fn truncate(&mut self, length: usize) {
        self.numbers.truncate(length);
    }

    fn shrink(&mut self) {
        self.numbers.shrink_to_fit();
        self.rounded = Rounded::default();
    }

    fn are_sound(&self, run: &Run, view: [usize; 2]) -> bool {
        self.numbers.get(run.weights as usize..).is_some_and(|numbers| is_sound(numbers, run, view))
    }

    fn bytes(&self) -> usize {
        self.numbers.capacity() * size_of::<u32>()
    }

    fn used_bytes(&self) -> usize {
        self.numbers.len() * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_turned() {
        let bytes = [0x81, 0x02, 0xff, 0x00, 0x10, 0x7e, 0x55, 0xa0];
        let turned = transposed(bytes);
        for (row, byte) in bytes.iter().enumerate() {
            for (column, turned) in turned.iter().enumerate() {
                assert_eq!(byte >> column & 1, turned >> row & 1, "bit {column} of byte {row}");
            }
        }
        assert_eq!([0, 1, 0x80, 0x3c].map(span), [0..0, 0..1, 7..8, 2..6]);
    }
}
