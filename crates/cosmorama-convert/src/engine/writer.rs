use std::path::Path;

use cosmorama::raster::{EncodedImage, Encoder, Image, Rgba, Threads};
use cosmorama_io::{WriteOptions, write_levels};

use crate::colour::Light;
use crate::diagnostic::Result;

/// A picture and its mip levels.
pub(crate) enum Levels {
    /// Light to be encoded.
    Light(Vec<Image<Rgba>>),
    /// Code values of 8 bits.
    Codes(Vec<Image<[u8; 3]>>),
}

impl Levels {
    /// Returns the images if they are of light.
    pub(crate) fn into_light(self) -> Option<Vec<Image<Rgba>>> {
        if let Self::Light(images) = self { Some(images) } else { None }
    }

    /// Returns the images if they are of code values.
    pub(crate) fn into_codes(self) -> Option<Vec<Image<[u8; 3]>>> {
        if let Self::Codes(images) = self { Some(images) } else { None }
    }
}

/// Writer of pictures that share one kind of samples.
pub(crate) struct Writer {
    encoder: Encoder,
    options: WriteOptions,
}

impl Writer {
    pub(crate) fn new(light: &Light, options: WriteOptions) -> Self {
        Self { encoder: Encoder::new(light.channels, light.depth, &light.transfer), options }
    }

    /// Writes an output: a picture and its mip levels.
    pub(crate) fn save(&self, levels: Levels, path: &Path) -> Result<()> {
        let encoded: Vec<EncodedImage> = match levels {
            // Each picture of light goes as soon as it is encoded.
            Levels::Light(images) => {
                images.into_iter().map(|image| self.encoder.encode(&image, Threads::All)).collect()
            }
            Levels::Codes(images) => images.into_iter().map(EncodedImage::of_codes).collect(),
        };
        self.write(&encoded, path)
    }

    /// Encodes and writes images on the calling thread, and returns them for reuse: new ones would have to be zeroed.
    pub(crate) fn save_and_hand_on(&self, levels: Levels, path: &Path) -> Result<Levels> {
        match levels {
            Levels::Light(images) => {
                let encoded: Vec<_> = images.iter().map(|image| self.encoder.encode(image, Threads::One)).collect();
                self.write(&encoded, path)?;
                Ok(Levels::Light(images))
            }
            Levels::Codes(images) => {
                let encoded: Vec<_> = images.into_iter().map(EncodedImage::of_codes).collect();
                self.write(&encoded, path)?;
                // All of them or none: each level has its place.
                let images: Option<Vec<_>> = encoded.into_iter().map(EncodedImage::into_codes).collect();
                Ok(Levels::Codes(images.unwrap_or_default()))
            }
        }
    }

    fn write(&self, encoded: &[EncodedImage], path: &Path) -> Result<()> {
        write_levels(path, encoded, &self.options)?;
        Ok(())
    }
}
