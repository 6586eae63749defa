use std::ops::Range;

use half::f16;

use super::{Channels, Depth, FramePool, Image, ImageError, Samples};

/// Relation of a file's colour samples to its alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AlphaMode {
    /// Colours are not multiplied by alpha, as in PNG and TGA. Integer samples are always straight.
    #[default]
    Straight,
    /// Colours are multiplied by alpha, as in OpenEXR. Only this mode can hold light with an alpha of zero, such as a
    /// glow or a flame.
    Premultiplied,
}

/// An image as it is in a file.
///
/// [`decode`](Self::decode) converts it to light, [`encode`](Self::encode) makes it from light.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedImage {
    width: usize,
    height: usize,
    channels: Channels,
    depth: Depth,
    alpha_mode: AlphaMode,
    samples: Samples,
}

impl EncodedImage {
    /// Creates an image of samples; alpha is straight if there is any.
    ///
    /// # Errors
    /// When the number of samples is not `width × height × channels`, or their type differs from `depth`.
    pub fn new(
        width: usize,
        height: usize,
        channels: Channels,
        depth: Depth,
        samples: Samples,
    ) -> Result<Self, ImageError> {
        let expected = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(channels.count()));
        if expected != Some(samples.len()) {
            return Err(ImageError::WrongLength { width, height, found: samples.len() / channels.count() });
        }
        if !samples.suit(depth) {
            return Err(ImageError::WrongDepth { depth });
        }
        Ok(Self { width, height, channels, depth, alpha_mode: AlphaMode::Straight, samples })
    }

    /// Creates an opaque image of 8-bit codes.
    pub fn of_codes(codes: Image<[u8; 3]>) -> Self {
        let (width, height) = (codes.width(), codes.height());
        let samples = Samples::U8(codes.into_pixels().into_flattened());
        Self::from_parts(width, height, Channels::Rgb, Depth::Eight, AlphaMode::Straight, samples)
    }

    /// Creates an image from parts that are known to fit.
    pub(crate) fn from_parts(
        width: usize,
        height: usize,
        channels: Channels,
        depth: Depth,
        alpha_mode: AlphaMode,
        samples: Samples,
    ) -> Self {
        debug_assert!(samples.len() == width * height * channels.count() && samples.suit(depth));
        Self { width, height, channels, depth, alpha_mode, samples }
    }

    /// Reinterprets float samples as straight or premultiplied, without changing them.
    ///
    /// Integer samples stay straight: premultiplied, they would lose bits that a transfer function needs.
    #[must_use]
    pub fn with_alpha_mode(self, alpha_mode: AlphaMode) -> Self {
        let alpha_mode = if self.depth.is_float() { alpha_mode } else { AlphaMode::Straight };
        Self { alpha_mode, ..self }
    }

    /// Keeps the first rows, at most `count`, and gives the memory of all others back: where light replaces samples, both
    /// need not be held.
    ///
    /// ```
    /// use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
    ///
    /// let mut image = EncodedImage::new(1, 3, Channels::Grey, Depth::Eight, Samples::U8(vec![5, 6, 7]))?;
    /// image.keep_rows(2);
    /// assert_eq!((image.height(), image.samples()), (2, &Samples::U8(vec![5, 6])));
    /// # Ok::<(), cosmorama::raster::ImageError>(())
    /// ```
    pub fn keep_rows(&mut self, count: usize) {
        self.height = self.height.min(count);
        self.samples.keep(self.width * self.height * self.channels.count());
    }

    /// Returns the image without its alpha. Colours that were multiplied by it are divided, except where it is 0.
    #[must_use]
    pub fn without_alpha(self) -> Self {
        fn colours<S: Copy>(samples: &[S], count: usize, colour: impl Fn(S, S) -> S) -> Vec<S> {
            let pixels = samples.chunks_exact(count).filter_map(<[S]>::split_last);
            pixels.flat_map(|(alpha, colours)| colours.iter().map(|code| colour(*code, *alpha))).collect()
        }
        if !self.channels.has_alpha() {
            return self;
        }
        let divided = |code: f32, alpha: f32| {
            if self.alpha_mode == AlphaMode::Premultiplied && alpha > 0.0 { code / alpha } else { code }
        };
        let count = self.channels.count();
        let samples = match &self.samples {
            Samples::U8(samples) => Samples::U8(colours(samples, count, |code, _| code)),
            Samples::U16(samples) => Samples::U16(colours(samples, count, |code, _| code)),
            Samples::Half(samples) => Samples::Half(colours(samples, count, |code, alpha| {
                f16::from_f32(divided(code.to_f32(), alpha.to_f32()))
            })),
            Samples::Float(samples) => Samples::Float(colours(samples, count, divided)),
        };
        Self { channels: self.channels.without_alpha(), samples, ..self }
    }

    /// Returns whether every pixel has an alpha of one, or there is no alpha. An alpha of NaN is not opaque.
    pub fn is_opaque(&self) -> bool {
        fn all<S: Copy>(samples: &[S], count: usize, is_one: impl Fn(S) -> bool) -> bool {
            samples.iter().skip(count - 1).step_by(count).all(|alpha| is_one(*alpha))
        }
        let count = self.channels.count();
        !self.channels.has_alpha()
            || match &self.samples {
                Samples::U8(samples) => all(samples, count, |alpha| alpha == u8::MAX),
                Samples::U16(samples) => all(samples, count, |alpha| alpha == u16::MAX),
                Samples::Half(samples) => all(samples, count, |alpha| alpha >= f16::ONE),
                Samples::Float(samples) => all(samples, count, |alpha| alpha >= 1.0),
            }
    }

    /// Copies a part of the image: columns from `left`, rows from `top`.
    ///
    /// # Panics
    /// When the part is not inside the image.
    #[must_use]
    pub fn cropped(&self, corner: (usize, usize), size: (usize, usize)) -> Self {
        self.cropped_in(corner, size, &FramePool::default())
    }

    /// Copies a part of the image, as [`cropped`](Self::cropped) does, into memory of a pool.
    ///
    /// # Panics
    /// When the part is not inside the image.
    #[must_use]
    pub fn cropped_in(&self, (left, top): (usize, usize), (width, height): (usize, usize), pool: &FramePool) -> Self {
        let count = self.channels.count();
        assert!(left + width <= self.width && top + height <= self.height, "the part is not inside the image");
        let rows = move || {
            (top..top + height).map(move |j| (j * self.width + left) * count).map(move |at| at..at + width * count)
        };
        fn parts<S: Copy>(samples: &[S], rows: impl Iterator<Item = Range<usize>>, mut into: Vec<S>) -> Vec<S> {
            into.clear();
            rows.for_each(|row| into.extend_from_slice(&samples[row]));
            into
        }
        let all = width * height * count;
        let samples = match &self.samples {
            Samples::U8(samples) => Samples::U8(parts(samples, rows(), pool.take(all))),
            Samples::U16(samples) => Samples::U16(parts(samples, rows(), pool.take(all))),
            Samples::Half(samples) => Samples::Half(parts(samples, rows(), pool.take(all))),
            Samples::Float(samples) => Samples::Float(parts(samples, rows(), pool.take(all))),
        };
        Self { width, height, samples, ..*self }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the channels of a pixel.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// Returns the sample type.
    pub fn depth(&self) -> Depth {
        self.depth
    }

    /// Returns the relation of colour to alpha.
    pub fn alpha_mode(&self) -> AlphaMode {
        self.alpha_mode
    }

    /// Returns all samples, interleaved, row by row.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Returns all samples by value.
    pub fn into_samples(self) -> Samples {
        self.samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_outlive_their_alpha() {
        let codes = Samples::U8(vec![10, 20, 30, 0, 40, 50, 60, 255]);
        let image = EncodedImage::new(2, 1, Channels::Rgba, Depth::Eight, codes).unwrap().without_alpha();
        assert_eq!((image.channels(), image.samples()), (Channels::Rgb, &Samples::U8(vec![10, 20, 30, 40, 50, 60])));
        let glow = Samples::Float(vec![0.25, 0.5, 3.0, 0.0]);
        let image = EncodedImage::new(2, 1, Channels::GreyAlpha, Depth::Float, glow).unwrap();
        let premultiplied = image.clone().with_alpha_mode(AlphaMode::Premultiplied).without_alpha();
        assert_eq!(premultiplied.samples(), &Samples::Float(vec![0.5, 3.0]));
        assert_eq!(image.without_alpha().samples(), &Samples::Float(vec![0.25, 3.0]));
    }

    #[test]
    fn one_pixel_tells_that_an_image_is_not_opaque() {
        let is_opaque =
            |depth, samples: Samples| EncodedImage::new(2, 1, Channels::GreyAlpha, depth, samples).unwrap().is_opaque();
        assert!(is_opaque(Depth::Eight, Samples::U8(vec![0, 255, 0, 255])));
        assert!(!is_opaque(Depth::Eight, Samples::U8(vec![255, 255, 255, 254])));
        assert!(is_opaque(Depth::Ten, Samples::U16(vec![0, 65535, 0, 65535])));
        assert!(!is_opaque(Depth::Sixteen, Samples::U16(vec![65535, 65534, 65535, 65535])));
        assert!(is_opaque(Depth::Half, Samples::Half(vec![f16::ZERO, f16::ONE, f16::ZERO, f16::ONE])));
        assert!(!is_opaque(Depth::Float, Samples::Float(vec![1.0, f32::NAN, 1.0, 1.0])));
        let grey = EncodedImage::new(1, 1, Channels::Grey, Depth::Eight, Samples::U8(vec![0])).unwrap();
        assert!(grey.is_opaque());
    }

    #[test]
    fn codes_keep_the_memory_that_they_were_in() {
        let codes = Image::from_fn(3, 2, |i, j| [i as u8, j as u8, 9]);
        let place = codes.pixels().as_ptr().addr();
        let Samples::U8(samples) = EncodedImage::of_codes(codes).into_samples() else { panic!("8 bits") };
        assert_eq!(samples.as_ptr().addr(), place);
        assert_eq!(samples, [0, 0, 9, 1, 0, 9, 2, 0, 9, 0, 1, 9, 1, 1, 9, 2, 1, 9]);
    }
}
