use rayon::prelude::*;

use crate::raster::{Image, Rgba};

/// Weighted sum of pictures of one size: what a film has gathered so far. Light is linear and premultiplied.
///
/// ```
/// use cosmorama::motion::LightSum;
/// use cosmorama::raster::{Image, Rgba};
///
/// let mut sum = LightSum::new(Image::filled(2, 1, Rgba::opaque(1.0, 1.0, 1.0)), 0.25);
/// sum.add(&Image::filled(2, 1, Rgba::BLACK), 0.75);
/// assert_eq!(sum.into_image(), Image::filled(2, 1, Rgba::opaque(0.25, 0.25, 0.25)));
/// ```
#[derive(Clone, Debug)]
pub struct LightSum(Image<Rgba>);

impl LightSum {
    /// Creates the sum of one picture with its weight.
    pub fn new(mut image: Image<Rgba>, weight: f32) -> Self {
        image.pixels_mut().par_iter_mut().for_each(|pixel| *pixel = *pixel * weight);
        Self(image)
    }

    /// Adds a picture with a weight.
    pub fn add(&mut self, image: &Image<Rgba>, weight: f32) {
        let pixels = self.0.pixels_mut().par_iter_mut().zip(image.pixels().par_iter());
        pixels.for_each(|(sum, pixel)| *sum += *pixel * weight);
    }

    /// Returns the sum.
    pub fn into_image(self) -> Image<Rgba> {
        self.0
    }
}
