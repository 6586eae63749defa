use bytemuck::Zeroable;
use rayon::prelude::*;
use thiserror::Error;

use super::{Depth, Rgba};

/// Reason why an image cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ImageError {
    /// The number of pixels is not width × height.
    #[error("{width}x{height} pixels were expected, {found} given")]
    WrongLength {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Number of pixels that were given.
        found: usize,
    },
    /// The samples have another type than the stated depth.
    #[error("samples of depth {depth} were expected, others given")]
    WrongDepth {
        /// Stated depth.
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
    /// Creates an image of one colour.
    pub fn filled(width: usize, height: usize, pixel: P) -> Self {
        Self { width, height, pixels: vec![pixel; width * height] }
    }
}

impl<P: Zeroable> Image<P> {
    /// Creates an image of zeros, in memory that is not touched before it is written.
    pub(crate) fn zeroed(width: usize, height: usize) -> Self {
        Self { width, height, pixels: bytemuck::zeroed_vec(width * height) }
    }
}

impl Image<Rgba> {
    /// Composites all pixels over a background; both are linear and premultiplied.
    pub fn lay_over(&mut self, background: Rgba) {
        if background != Rgba::TRANSPARENT {
            self.pixels.par_iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        }
    }
}

impl<P> Image<P> {
    /// Creates an image of pixels, row by row.
    ///
    /// # Errors
    /// When their number is not `width × height`.
    pub fn new(width: usize, height: usize, pixels: Vec<P>) -> Result<Self, ImageError> {
        if width.checked_mul(height) != Some(pixels.len()) {
            return Err(ImageError::WrongLength { width, height, found: pixels.len() });
        }
        Ok(Self { width, height, pixels })
    }

    /// Creates an image by computing each pixel from column and row.
    pub fn from_fn(width: usize, height: usize, mut pixel: impl FnMut(usize, usize) -> P) -> Self {
        let mut pixels = Vec::with_capacity(width * height);
        pixels.extend((0..height).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| pixel(i, j)));
        Self { width, height, pixels }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns all pixels, row by row.
    pub fn pixels(&self) -> &[P] {
        &self.pixels
    }

    /// Returns all pixels, row by row, for changes.
    pub fn pixels_mut(&mut self) -> &mut [P] {
        &mut self.pixels
    }

    /// Returns all pixels by value, row by row.
    pub fn into_pixels(self) -> Vec<P> {
        self.pixels
    }

    /// Returns one row.
    pub fn row(&self, j: usize) -> &[P] {
        &self.pixels[j * self.width..][..self.width]
    }

    /// Returns the pixel in column `i` of row `j`.
    ///
    /// # Panics
    /// When the pixel is outside the image.
    pub fn get(&self, i: usize, j: usize) -> &P {
        &self.row(j)[i]
    }
}
