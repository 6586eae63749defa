use bytemuck::Zeroable;
use rayon::prelude::*;
use thiserror::Error;

use super::{Depth, Rgba};

/// Reason why an image cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ImageError {
    /// The pixels given are not width × height of them.
    #[error("{width}x{height} pixels were expected, {found} given")]
    WrongLength {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Pixels given.
        found: usize,
    },
    /// The samples given are of another type.
    #[error("samples of depth {depth} were expected, others given")]
    WrongDepth {
        /// What the samples were said to be.
        depth: Depth,
    },
}

/// A rectangle of pixels, row by row from the top left.
///
/// Pixel (i, j) has its centre at (i + ½, j + ½); column 0 is left, row 0 is top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<P> {
    width: usize,
    height: usize,
    pixels: Vec<P>,
}

impl<P: Clone> Image<P> {
    /// An image of one colour.
    pub fn filled(width: usize, height: usize, pixel: P) -> Self {
        Self { width, height, pixels: vec![pixel; width * height] }
    }
}

impl<P: Zeroable> Image<P> {
    /// An image of zeros, in memory that is not touched before it is written.
    pub(crate) fn zeroed(width: usize, height: usize) -> Self {
        Self { width, height, pixels: bytemuck::zeroed_vec(width * height) }
    }
}

impl Image<Rgba> {
    /// Lays all pixels in front of a background, linear and premultiplied as they are.
    pub fn lay_over(&mut self, background: Rgba) {
        if background != Rgba::TRANSPARENT {
            self.pixels.par_iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        }
    }
}

impl<P> Image<P> {
    /// An image of the given pixels.
    ///
    /// # Errors
    /// When their number is not `width × height`.
    pub fn new(width: usize, height: usize, pixels: Vec<P>) -> Result<Self, ImageError> {
        if width.checked_mul(height) != Some(pixels.len()) {
            return Err(ImageError::WrongLength { width, height, found: pixels.len() });
        }
        Ok(Self { width, height, pixels })
    }

    /// An image computed pixel by pixel from column and row.
    pub fn from_fn(width: usize, height: usize, mut pixel: impl FnMut(usize, usize) -> P) -> Self {
        let pixels = (0..height).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| pixel(i, j)).collect();
        Self { width, height, pixels }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &[P] {
        &self.pixels
    }

    /// All pixels, row by row.
    pub fn pixels_mut(&mut self) -> &mut [P] {
        &mut self.pixels
    }

    /// All pixels, row by row, by value.
    pub fn into_pixels(self) -> Vec<P> {
        self.pixels
    }

    /// One row.
    pub fn row(&self, j: usize) -> &[P] {
        &self.pixels[j * self.width..][..self.width]
    }

    /// The pixel in column `i` of row `j`.
    ///
    /// # Panics
    /// Outside the image.
    pub fn get(&self, i: usize, j: usize) -> &P {
        &self.row(j)[i]
    }
}
