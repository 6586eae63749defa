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

/// Writer of pictures that share one kind of samples.
pub(crate) struct Writer {
    encoder: Encoder,
    options: WriteOptions,
}

impl Writer {
    pub(crate) fn new(light: &Light, options: WriteOptions) -> Self {
        Self { encoder: Encoder::new(light.channels, light.depth, &light.transfer), options }
    }

    /// Writes an output: a picture and its mip levels. Their memory goes back to the pool.
    pub(crate) fn save(&self, levels: Levels, path: &Path, threads: Threads) -> Result<()> {
        let pool = &*self.options.pool;
        let encode = |image: Image<Rgba>| {
            let encoded = self.encoder.encode_in(&image, threads, pool);
            pool.give_image(image);
            encoded
        };
        let encoded: Vec<EncodedImage> = match levels {
            Levels::Light(images) => images.into_iter().map(encode).collect(),
            Levels::Codes(images) => images.into_iter().map(EncodedImage::of_codes).collect(),
        };
        let written = write_levels(path, &encoded, &self.options);
        encoded.into_iter().for_each(|image| pool.give(image.into_samples()));
        Ok(written?)
    }
}
