use fearless_simd::Simd;

use super::quantize::{Origin, Rounded};
use crate::raster::FixedLight;
use crate::render::batch::window::Windows;
use crate::render::plan::window_format::{COLUMNS_UNDER, Format, Header, Place, ROWS_UNDER, Shape, SmallShapes};
use crate::render::scan::tile::SIDE;

/// Format of weights as integers, with the weights of two neighbouring texels in each number: row by row in a large
/// window, in the order of [`weight_index`] in a small one. In a large window, texels under the pixel are marked pair
/// by pair ([`mark`]).
#[derive(Clone, Debug, Default)]
pub(crate) struct FixedFormat(Rounded);

/// Sizes of small windows.
pub(crate) const SMALL: SmallShapes = Shape::small([4, 6]);

/// Number of rows of the highest small window, and of pairs of the widest.
pub(crate) const HIGHEST: usize = 5;
pub(crate) const WIDEST: usize = 3;

/// Number of pairs of a row of a small window, from the first, that may lie under the pixel.
pub(crate) const PAIRS_UNDER: usize = COLUMNS_UNDER / 2;

/// Count of numbers that hold any small window with its header, and the excess written after its last row.
const MOST: usize = 1 + WIDEST * (HIGHEST - 1) + SIDE / 2;

/// All marks of a small window: of [`PAIRS_UNDER`] pairs of [`ROWS_UNDER`] rows, row by row.
const MARKS: u32 = {
    let pairs = (1 << (ROWS_UNDER * PAIRS_UNDER)) - 1;
    pairs << 16 | pairs
};

/// Returns the index of a pair's weights in a small window with so many pairs a row: the first two pairs of the first
/// four rows, row by row, then their third ones, then the fifth row. So the weights of two rows, and of four third
/// pairs, are read at once.
#[inline(always)]
pub(crate) const fn weight_index(pairs: usize, row: usize, pair: usize) -> usize {
    if row == HIGHEST - 1 {
        (HIGHEST - 1) * pairs + pair
    } else if pair < PAIRS_UNDER {
        PAIRS_UNDER * row + pair
    } else {
        PAIRS_UNDER * (HIGHEST - 1) + row
    }
}

/// Returns the number of bits by which the weights of a window are scaled.
#[inline(always)]
pub(crate) fn bits(header: Header) -> u32 {
    header.0 >> 25 & 15
}

/// Returns the mark of a texel among 16 pairs. Marks of first texels are in the lower half of a number, in the order of
/// the pairs, and marks of second texels in the upper half. So where the halves stand for a pair's two samples, each
/// has one bit of it.
#[inline(always)]
pub(crate) const fn mark(texel: usize) -> u32 {
    1 << (texel / 2 + texel % 2 * 16)
}

/// Returns the marks of the pairs of a small window's row, given a bit for each texel.
#[inline(always)]
fn marks_of(texels: u8) -> u32 {
    const TEXELS: usize = 2 * PAIRS_UNDER;
    const MARKS: [u32; 1 << TEXELS] = {
        let mut marks = [0; 1 << TEXELS];
        let mut at = 0;
        while at < TEXELS << TEXELS {
            if (at / TEXELS) >> (at % TEXELS) & 1 == 1 {
                marks[at / TEXELS] |= mark(at % TEXELS);
            }
            at += 1;
        }
        marks
    };
    MARKS[usize::from(texels) % MARKS.len()]
}

impl Format for FixedFormat {
    const SMALL: SmallShapes = SMALL;
    const TOGETHER: usize = 2;

    fn pitch(width: usize) -> usize {
        FixedLight::pitch(width)
    }

    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, windows: &Windows) -> bool {
        self.0.fill(simd, windows)
    }

    #[inline(always)]
    fn write(&self, windows: &Windows, place: Place, corner: &mut [u32; 2], numbers: &mut Vec<u32>) -> bool {
        let Rounded { width, height, .. } = self.0;
        let (whole, left) = (windows.columns_within(), corner[0] as isize);
        // A window of whole pairs may reach beyond the view. Then it begins earlier, if it can.
        let within = |shape: Shape, Origin { column, row }| {
            let beyond = left + column + shape.width as isize - whole.end as isize;
            Origin { column: column - beyond.max(0), row }
        };
        let small = self.0.shape(place.lane);
        let small = small.map(|(index, origin)| (index, within(SMALL[index], origin)));
        let is_small = |origin: Origin| origin.column < -1 || self.0.are_marks_early(place.lane, origin);
        let small = small.filter(|(_, origin)| is_small(*origin));
        let large = Shape::large::<Self>([width, height]);
        let origin = small.map_or_else(|| within(large, Origin { column: 0, row: 0 }), |(_, origin)| origin);
        if origin.column < -1 || left + origin.column < whole.start as isize {
            return false;
        }
        *corner = [(left + origin.column) as u32, corner[1] + origin.row as u32];
        match small {
            Some((index, _)) => self.write_small(place, origin, index, numbers),
            None => self.write_large(windows, place, (large, origin), numbers),
        }
        true
    }
}

impl FixedFormat {
    #[inline(always)]
    fn write_small(&self, place: Place, origin: Origin, index: usize, numbers: &mut Vec<u32>) {
        let Self(rounded) = self;
        let Shape { width, height, under } = SMALL[index];
        let pairs = width / 2;
        let marks = |row| marks_of(rounded.small_marks(place.lane, origin, under + row)) << (PAIRS_UNDER * row);
        let under = (0..ROWS_UNDER).fold(0, |all, row| all | marks(row));
        // The marks stored are those of texels not under the pixel: a mark becomes the sign that keeps a texel out of
        // the bounds.
        let header = Header::new(Some(index), place, rounded.bits << 25 | !under & MARKS);
        // A fixed length is written, whatever the shape: each row overwrites what followed the one before.
        let length = numbers.len();
        numbers.extend_from_slice(&[0; MOST]);
        let room: &mut [u32; MOST] = numbers[length..].first_chunk_mut().expect("there is as much room");
        room[0] = header.0;
        let rows = rounded.small_pairs(place.lane, origin);
        for (row, weights) in rows[..HIGHEST - 1].iter().enumerate() {
            room[1 + weight_index(pairs, row, 0)..][..2].copy_from_slice(&weights[..2]);
            // Where there is no third pair, the last row comes over it.
            room[1 + weight_index(pairs, row, 2)] = weights[2];
        }
        room[1 + weight_index(pairs.min(WIDEST), HIGHEST - 1, 0)..][..SIDE / 2].copy_from_slice(&rows[HIGHEST - 1]);
        numbers.truncate(length + 1 + pairs * height);
    }

    fn write_large(
        &self,
        windows: &Windows,
        place: Place,
        (Shape { width, height, .. }, origin): (Shape, Origin),
        numbers: &mut Vec<u32>,
    ) {
        let (Self(rounded), lane, pairs) = (self, place.lane, width / 2);
        numbers.push(Header::new(None, place, rounded.bits << 25).0);
        let words = |row| (0..pairs).step_by(16).map(move |first| (row, first..pairs.min(first + 16)));
        let words = windows.rows_under().flat_map(words);
        numbers.extend(words.map(|(row, pairs)| !rounded.marks(lane, origin, row, pairs)));
        for row in 0..height {
            numbers.extend(rounded.pairs(lane, origin, row, pairs));
        }
    }
}
