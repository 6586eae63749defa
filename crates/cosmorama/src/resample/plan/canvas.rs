use super::band::Run;
use super::mirrors::{MirrorImage, Mirrors};
use crate::resample::patch::SIDE;

/// The rows of a picture that one band makes: its own, and those that mirror it from below.
pub(super) struct Canvas<'a, P> {
    width: usize,
    own: &'a mut [P],
    mirrored: &'a mut [P],
}

impl<'a, P> Canvas<'a, P> {
    /// Cuts a picture, `width` pixels wide, into what bands of `rows` rows make. Each is filled with a background when it is its
    /// turn, so that it is at hand when its pixels are made.
    pub(super) fn bands(
        pixels: &'a mut [P],
        width: usize,
        rows: usize,
        mirrors: &Mirrors,
        background: P,
    ) -> impl rayon::iter::IndexedParallelIterator<Item = Self>
    where
        P: Copy + Send + Sync,
    {
        use rayon::prelude::*;
        let (own, mirrored) = pixels.split_at_mut(mirrors.rows * width);
        // Below, the rows of the first band are the last ones; where nothing is mirrored there is nothing.
        // A picture without columns has no bands.
        let chunk = (rows * width).max(1);
        let own = own.par_chunks_mut(chunk);
        let bands = own.len();
        let mut below: Vec<&mut [P]> = mirrored.rchunks_mut(chunk).collect();
        below.resize_with(bands, Default::default);
        own.zip(below).map(move |(own, mirrored)| {
            own.fill(background);
            mirrored.fill(background);
            Self { width, own, mirrored }
        })
    }

    /// Writes the pixels of a run, from left to right as a mirror image shows them.
    #[inline(always)]
    pub(super) fn put(&mut self, image: &MirrorImage, run: &Run, pixels: &[P; SIDE])
    where
        P: Copy,
    {
        if !run.is_whole() {
            for lane in run.lanes() {
                *self.pixel(image, run.pixel(lane)) = pixels[if image.flips[0] { SIDE - 1 - lane } else { lane }];
            }
            return;
        }
        let [column, row] = run.pixel(0);
        let column = if image.flips[0] { self.width - SIDE - column } else { column };
        let (rows, row) = if image.flips[1] {
            let last = self.mirrored.len() / self.width - 1;
            (&mut *self.mirrored, last - row)
        } else {
            (&mut *self.own, row)
        };
        rows[row * self.width + column..][..SIDE].copy_from_slice(pixels);
    }

    /// The pixel that a mirror image shows in place of the one in this column and row of the band.
    #[inline(always)]
    pub(super) fn pixel(&mut self, image: &MirrorImage, [column, row]: [usize; 2]) -> &mut P {
        let column = if image.flips[0] { self.width - 1 - column } else { column };
        if image.flips[1] {
            let rows = self.mirrored.len() / self.width;
            &mut self.mirrored[(rows - 1 - row) * self.width + column]
        } else {
            &mut self.own[row * self.width + column]
        }
    }
}
