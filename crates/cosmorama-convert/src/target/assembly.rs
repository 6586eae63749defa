//! Sheets put together from the images of their views.

use cosmorama::raster::{FramePool, Image, Pixel};

use crate::diagnostic::Result;
use crate::target::Sheet;

impl Sheet {
    /// Assembles a picture: one image, or several in their places on a background.
    pub(crate) fn assemble<P: Copy>(
        &self,
        background: P,
        image: impl FnMut(usize) -> Result<Image<P>>,
    ) -> Result<Image<P>> {
        let (width, height) = self.size;
        self.assemble_by(|| Image::filled(width, height, background), image, drop)
    }

    /// Assembles a picture in memory of a pool, and gives the memory of its pieces back.
    pub(crate) fn assemble_in<P: Pixel>(
        &self,
        pool: &FramePool,
        background: P,
        image: impl FnMut(usize) -> Result<Image<P>>,
    ) -> Result<Image<P>> {
        let (width, height) = self.size;
        let blank = || {
            let mut blank = pool.take_image(width, height);
            blank.pixels_mut().fill(background);
            blank
        };
        self.assemble_by(blank, image, |image| pool.give_image(image))
    }

    fn assemble_by<P: Copy>(
        &self,
        blank: impl Fn() -> Image<P>,
        mut image: impl FnMut(usize) -> Result<Image<P>>,
        done: impl Fn(Image<P>),
    ) -> Result<Image<P>> {
        let mut picture = None;
        for &(index, (left, top)) in &self.pieces {
            let piece = image(index)?;
            if (piece.width(), piece.height()) == self.size {
                return Ok(piece);
            }
            let picture = picture.get_or_insert_with(&blank);
            for j in 0..piece.height() {
                picture.pixels_mut()[(top + j) * self.size.0 + left..][..piece.width()].copy_from_slice(piece.row(j));
            }
            done(piece);
        }
        Ok(picture.unwrap_or_else(blank))
    }
}
