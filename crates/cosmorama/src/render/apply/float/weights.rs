use fearless_simd::{Simd, dispatch};

use super::lanes::Lanes;
use super::shape::{BLOCK, Header, Shape, Small, mark_words};
use crate::render::batch::window::Windows;
use crate::render::plan::span::{Corners, Run};
use crate::render::plan::weights::Weights;
use crate::render::plan::window_order::{self, Place};
use crate::render::scan::tile::SIDE;

/// The weights of windows, pixel by pixel, as the bits of floats.
///
/// Before those of a pixel stands a [`Header`]; then, if its window is not one of [`Small::ALL`], which texels lie under the pixel,
/// [`mark_words`] numbers for each row that has some.
#[derive(Clone, Debug, Default)]
pub(crate) struct FloatWeights {
    pub(crate) numbers: Vec<u32>,
}

/// A pixel's window as it is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept<'a> {
    pub(crate) shape: Shape,
    /// As many as it has texels.
    weights: &'a [u32],
}

impl<'a> Kept<'a> {
    /// Takes the next window of a run from its numbers; `None` if they end before.
    fn take(numbers: &mut &'a [u32], run: &Run) -> Option<Self> {
        let header = Header(*numbers.split_off_first()?);
        let shape = match Small::ALL.get(header.index() as usize) {
            Some(small) => small.shape,
            None => {
                numbers.split_off(..run.rows_under().len() * mark_words(usize::from(run.width)))?;
                Shape::of_run(run)
            }
        };
        Some(Self { shape, weights: numbers.split_off(..shape.area())? })
    }

    pub(crate) fn weight(&self, row: usize, column: usize) -> f32 {
        f32::from_bits(self.weights[self.shape.index(row, column)])
    }
}

impl FloatWeights {
    /// The windows of a group, each with its run and its lane.
    pub(crate) fn windows<'a>(&'a self, group: &'a [Run]) -> impl Iterator<Item = (&'a Run, usize, Kept<'a>)> {
        let mut numbers = &self.numbers[group[0].weights as usize..];
        group.iter().flat_map(Run::lanes).map_while(move |_| {
            let Place { run, lane } = Place::of(*numbers.first()?);
            let run = group.get(run)?;
            Some((run, lane, Kept::take(&mut numbers, run)?))
        })
    }

    #[inline(always)]
    fn keep_lanes<S: Simd>(&mut self, simd: S, windows: &Windows, corners: &mut Corners, run: usize) {
        let lanes = Lanes::of(simd, windows);
        for (lane, corner) in corners.iter_mut().enumerate() {
            let Some(corner) = corner else { continue };
            let place = Place { run, lane };
            let small = lanes.as_ref().and_then(|lanes| Some((lanes, lanes.small(lane)?)));
            let Some((lanes, (index, origin))) = small else {
                self.write_large(windows, place);
                continue;
            };
            *corner = [corner[0] + origin[0] as u32, corner[1] + origin[1] as u32];
            let small = &Small::ALL[index];
            let header = Header::small(index, lanes.marks(lane, origin, small), place);
            if small.shape.width == BLOCK {
                self.write_small::<BLOCK>(windows, lane, origin, (header, small.shape.height));
            } else {
                self.write_small::<{ BLOCK + 1 }>(windows, lane, origin, (header, small.shape.height));
            }
        }
    }

    #[inline(always)]
    fn write_small<const WIDTH: usize>(
        &mut self,
        windows: &Windows,
        lane: usize,
        [column, row]: [usize; 2],
        (header, height): (Header, usize),
    ) {
        // One number, and rows of which five are the most. What is written is always as much: no copy of unknown length.
        let mut all = [0; 1 + 5 * 5];
        all[0] = header.0;
        let pitch = windows.width();
        let (blocks, rest) = all[1..].split_at_mut(BLOCK * height);
        let rows = windows.weights()[row * pitch..].chunks_exact(pitch);
        for ((block, rest), weights) in blocks.as_chunks_mut::<BLOCK>().0.iter_mut().zip(rest).zip(rows) {
            let weights: &[[f32; SIDE]; WIDTH] =
                weights[column..].first_chunk().expect("a small window lies in its run's");
            *block = std::array::from_fn(|at| weights[at][lane % SIDE].to_bits());
            if WIDTH > BLOCK {
                *rest = weights[WIDTH - 1][lane % SIDE].to_bits();
            }
        }
        let length = self.numbers.len() + 1 + WIDTH * height;
        self.numbers.extend_from_slice(&all);
        self.numbers.truncate(length);
    }

    fn write_large(&mut self, windows: &Windows, place: Place) {
        let shape = Shape { width: windows.width(), height: windows.height() };
        let lane = place.lane;
        self.numbers.push(Header::large(place).0);
        for row in windows.rows_under() {
            let under = windows.under()[row * shape.width..][..shape.width].chunks(32);
            let marks = |lanes: &[u8]| {
                lanes.iter().enumerate().fold(0, |marks, (at, lanes)| marks | u32::from(lanes >> lane & 1) << at)
            };
            self.numbers.extend(under.map(marks));
        }
        let first = self.numbers.len();
        self.numbers.resize(first + shape.area(), 0);
        for (row, weights) in windows.weights().chunks_exact(shape.width).enumerate() {
            for (column, weights) in weights.iter().enumerate() {
                self.numbers[first + shape.index(row, column)] = weights[lane].to_bits();
            }
        }
    }
}

impl Weights for FloatWeights {
    fn pitch(width: usize) -> usize {
        width
    }

    fn len(&self) -> usize {
        self.numbers.len()
    }

    fn keep(&mut self, windows: &Windows, corners: &mut Corners, run: usize) -> bool {
        let level = windows.level();
        dispatch!(level, simd => self.keep_lanes(simd, windows, corners, run));
        true
    }

    fn truncate(&mut self, length: usize) {
        self.numbers.truncate(length);
    }

    fn settle<'a>(&mut self, groups: impl Iterator<Item = &'a [Run]>) {
        window_order::sort(&mut self.numbers, groups, |run, header| Header(header).told(run));
    }

    fn bytes(&self) -> usize {
        self.numbers.capacity() * size_of::<u32>()
    }

    fn used_bytes(&self) -> usize {
        self.numbers.len() * size_of::<u32>()
    }
}
