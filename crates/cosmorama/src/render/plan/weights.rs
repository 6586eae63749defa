use fearless_simd::{Simd, dispatch};

use super::span::{Corners, Run};
use super::window_format::{Format, Header, Kept, Place};
use super::window_order;
use crate::render::batch::window::Windows;

/// Weights of a band's windows, one group of runs after the other, pixel by pixel.
///
/// The weights of a pixel follow its [`Header`]. If its window is not small, marks of the texels under the pixel lie
/// between header and weights: [`Shape::mark_words`](super::window_format::Shape::mark_words) numbers for each row that
/// has some.
#[derive(Clone, Debug, Default)]
pub(crate) struct Weights<F> {
    pub(crate) numbers: Vec<u32>,
    format: F,
}

impl<F: Format> Weights<F> {
    /// Returns the count of numbers, which is the index at which the next run's numbers begin.
    pub(crate) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Keeps the weights of the windows that have a corner; `run` is the place of their run in its group. Moves the
    /// corners to where the kept windows begin. Returns false, keeping nothing, if the weights do not fit the format.
    pub(crate) fn keep(&mut self, windows: &Windows, corners: &mut Corners, run: usize) -> bool {
        let level = windows.level();
        dispatch!(level, simd => self.keep_lanes(simd, windows, corners, run))
    }

    #[inline(always)]
    fn keep_lanes<S: Simd>(&mut self, simd: S, windows: &Windows, corners: &mut Corners, run: usize) -> bool {
        if !self.format.take(simd, windows) {
            return false;
        }
        let length = self.numbers.len();
        for (lane, corner) in corners.iter_mut().enumerate() {
            let Some(corner) = corner else { continue };
            if !self.format.write(windows, Place { run, lane }, corner, &mut self.numbers) {
                self.numbers.truncate(length);
                return false;
            }
        }
        true
    }

    /// Drops all numbers but the first `length`, keeping the memory.
    pub(crate) fn truncate(&mut self, length: usize) {
        self.numbers.truncate(length);
    }

    /// Sorts the windows of each group by shape, and frees memory that is not needed.
    pub(crate) fn settle<'a>(&mut self, groups: impl Iterator<Item = &'a [Run]>) {
        window_order::sort(&mut self.numbers, groups, |run, numbers| {
            (Header(numbers[0]).shape(), Kept::of::<F>(run, numbers).length())
        });
        self.format = F::default();
    }

    /// Returns the windows of a group, each with its run and its header.
    pub(crate) fn windows<'a>(&'a self, group: &'a [Run]) -> impl Iterator<Item = (&'a Run, Header, Kept<'a>)> {
        let mut numbers = &self.numbers[group[0].weights as usize..];
        group.iter().flat_map(Run::lanes).map(move |_| {
            let header = Header(numbers[0]);
            let run = &group[header.place().run];
            let kept = Kept::of::<F>(run, numbers);
            numbers = &numbers[kept.length()..];
            (run, header, kept)
        })
    }

    /// Returns the number of bytes that the weights take.
    pub(crate) fn bytes(&self) -> usize {
        self.numbers.capacity() * size_of::<u32>()
    }

    /// Returns the number of bytes in use, without spare capacity.
    pub(crate) fn used_bytes(&self) -> usize {
        size_of_val(&*self.numbers)
    }
}
