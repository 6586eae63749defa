use fearless_simd::{Simd, f32x8, prelude::*};

use crate::render::apply::lane_shapes::LaneShapes;
use crate::render::batch::window::Windows;
use crate::render::plan::window_format::{COLUMNS_UNDER, Format, Header, Place, ROWS_UNDER, Shape, SmallShapes};
use crate::render::scan::tile::SIDE;

/// Format of weights as the bits of floats: first those of a window's blocks, row by row, then those of the columns
/// that make no whole block.
#[derive(Clone, Debug, Default)]
pub(crate) struct FloatFormat {
    shapes: LaneShapes,
}

/// Sizes of small windows.
pub(crate) const SMALL: SmallShapes = Shape::small([4, 5]);

/// Number of neighbouring texels that are weighted together.
pub(crate) const BLOCK: usize = 4;

/// Returns the number of columns of a window in whole blocks, which come first.
#[inline(always)]
pub(crate) fn in_blocks(shape: Shape) -> usize {
    shape.width / BLOCK * BLOCK
}

/// Returns the index of a texel's weight among those of its window.
#[inline(always)]
pub(crate) fn weight_index(shape: Shape, [row, column]: [usize; 2]) -> usize {
    let whole = in_blocks(shape);
    if column < whole {
        row * whole + column
    } else {
        shape.height * whole + row * (shape.width - whole) + column - whole
    }
}

impl Format for FloatFormat {
    const SMALL: SmallShapes = SMALL;
    const TOGETHER: usize = 1;

    fn pitch(width: usize) -> usize {
        width
    }

    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, windows: &Windows) -> bool {
        let size = [windows.width(), windows.height()];
        if size[0] == 0 || size.iter().any(|length| *length > SIDE) {
            self.shapes.clear();
            return true;
        }
        let (mut columns, mut rows, mut under) = ([0; SIDE], [0; SIDE], [[0; SIDE]; SIDE]);
        let all = windows.weights().chunks_exact(size[0]).zip(windows.under().chunks_exact(size[0]));
        for (row, (weights, lanes)) in all.enumerate() {
            let mut any = 0;
            for (column, (weights, &lanes)) in weights.iter().zip(lanes).enumerate() {
                let counts = !(f32x8::load_array_ref(simd, weights).simd_eq(0.0).to_bitmask() as u8) | lanes;
                columns[column % SIDE] |= counts;
                under[row % SIDE][column % SIDE] = lanes;
                any |= counts;
            }
            rows[row % SIDE] = any;
        }
        self.shapes.find(simd, (&SMALL, 0), size, [columns, rows], &under);
        true
    }

    #[inline(always)]
    fn write(&self, windows: &Windows, place: Place, corner: &mut [u32; 2], numbers: &mut Vec<u32>) -> bool {
        let Some((index, origin)) = self.shapes.shape(place.lane) else {
            write_large(windows, place, numbers);
            return true;
        };
        *corner = [corner[0] + origin[0] as u32, corner[1] + origin[1] as u32];
        let Shape { width, height, under } = SMALL[index];
        let marks = (0..ROWS_UNDER).fold(0, |marks, at| {
            let columns = u32::from(self.shapes.under(place.lane, origin[1] + under + at)) >> origin[0];
            marks | (columns & ((1 << COLUMNS_UNDER) - 1)) << (COLUMNS_UNDER * at)
        });
        let header = Header::new(Some(index), place, marks << 16);
        if width == BLOCK {
            write_small::<BLOCK>(windows, place.lane, origin, (header, height), numbers);
        } else {
            write_small::<{ BLOCK + 1 }>(windows, place.lane, origin, (header, height), numbers);
        }
        true
    }
}

#[inline(always)]
fn write_small<const WIDTH: usize>(
    windows: &Windows,
    lane: usize,
    [column, row]: [usize; 2],
    (header, height): (Header, usize),
    numbers: &mut Vec<u32>,
) {
    // One header, and at most five rows. A fixed length is written, since a copy of unknown length would be slow.
    let mut all = [0; 1 + 5 * 5];
    all[0] = header.0;
    let pitch = windows.width();
    let (blocks, rest) = all[1..].split_at_mut(BLOCK * height);
    let rows = windows.weights()[row * pitch..].chunks_exact(pitch);
    for ((block, rest), weights) in blocks.as_chunks_mut::<BLOCK>().0.iter_mut().zip(rest).zip(rows) {
        let weights: &[[f32; SIDE]; WIDTH] = weights[column..].first_chunk().expect("a small window lies in its run's");
        *block = std::array::from_fn(|at| weights[at][lane % SIDE].to_bits());
        if WIDTH > BLOCK {
            *rest = weights[WIDTH - 1][lane % SIDE].to_bits();
        }
    }
    let length = numbers.len() + 1 + WIDTH * height;
    numbers.extend_from_slice(&all);
    numbers.truncate(length);
}

fn write_large(windows: &Windows, place: Place, numbers: &mut Vec<u32>) {
    let (lane, shape) = (place.lane, Shape::large::<FloatFormat>([windows.width(), windows.height()]));
    numbers.push(Header::new(None, place, 0).0);
    for row in windows.rows_under() {
        let under = windows.under()[row * shape.width..][..shape.width].chunks(32);
        let marks = |lanes: &[u8]| {
            lanes.iter().enumerate().fold(0, |marks, (at, lanes)| marks | u32::from(lanes >> lane & 1) << at)
        };
        numbers.extend(under.map(marks));
    }
    let first = numbers.len();
    numbers.resize(first + shape.area(), 0);
    for (row, weights) in windows.weights().chunks_exact(shape.width).enumerate() {
        for (column, weights) in weights.iter().enumerate() {
            numbers[first + weight_index(shape, [row, column])] = weights[lane].to_bits();
        }
    }
}
