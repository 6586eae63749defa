use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use cosmorama::raster::{ColourChannel, Depth, EncodedImage, Encoder, Image, Rgba, Threads};
use cosmorama_io::pending::Hidden;
use cosmorama_io::{
    Carried, LayeredImage, LayeredRows, MadeLayers, MadeRows, Plane, Remark, WriteOptions, write_hidden,
    write_layer_rows_hidden, write_layers_hidden, write_rows_hidden,
};
use rayon::prelude::*;

use crate::colour::{LayerPlan, Light, LightConversion, PictureNames};
use crate::diagnostic::Result;
use crate::source::video::MadeVideos;

/// A picture and its mip levels.
pub(crate) enum Levels {
    /// Light to be encoded.
    Light(Vec<Image<Rgba>>),
    /// Code values of 8 bits.
    Codes(Vec<Image<[u8; 3]>>),
    /// Samples of a file.
    Encoded(Vec<EncodedImage>),
    /// File that is written, but for its name.
    Written(Hidden),
    /// Samples, if the picture is written, with further channels.
    Layered { size: (usize, usize), picture: Option<EncodedImage>, planes: Vec<Plane> },
}

/// Options of a writer.
#[derive(Clone, Debug, Default)]
pub(crate) struct WriterOptions {
    /// Options of files of pictures.
    pub(crate) files: WriteOptions,
    /// Outputs that are videos.
    pub(crate) videos: Arc<MadeVideos>,
}

/// Words about a frame that is written.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameWords {
    /// Place of the frame among all that are made, from 0.
    pub(crate) place: usize,
    /// Metadata of the frame's inputs.
    pub(crate) carried: Option<Arc<Carried>>,
    /// Words about how the frame was made.
    pub(crate) origin: Option<Arc<str>>,
}

/// Writer of pictures that share one kind of samples.
pub(crate) struct Writer {
    /// Conversion of light before it is encoded.
    conversion: Option<LightConversion>,
    encoder: Encoder,
    /// Names of the picture's channels, if they are not the usual ones.
    names: Vec<String>,
    options: WriteOptions,
    videos: Arc<MadeVideos>,
    /// Statement about the pixels that is known once they are made.
    said: OnceLock<Remark>,
    /// The brightest light that samples hold, but for rounding.
    most: f32,
    /// Samples so far that were brighter.
    overflowed: AtomicUsize,
}

impl Writer {
    pub(crate) fn new(light: &Light, names: &PictureNames, options: WriterOptions) -> Self {
        let names = match names {
            PictureNames::Given(names) => names.clone(),
            PictureNames::Usual | PictureNames::LeftOut => Vec::new(),
        };
        let encoder = encoder_of(light);
        let most = most_of(light);
        let (conversion, said, overflowed) = (light.output(), OnceLock::new(), AtomicUsize::new(0));
        let WriterOptions { files: options, videos } = options;
        Self { conversion, encoder, names, options, videos, said, most, overflowed }
    }

    /// Returns the encoder, if all that becomes of light is encoding.
    pub(crate) fn encoder_alone(&self) -> Option<&Encoder> {
        self.conversion.is_none().then_some(&self.encoder)
    }

    /// Returns the encoder of a writer of light, if all that becomes of it is encoding.
    pub(crate) fn encoder_alone_of(light: &Light) -> Option<Encoder> {
        light.output().is_none().then(|| encoder_of(light))
    }

    /// Returns the number of samples so far that are written as the largest of their type, because they are brighter.
    pub(crate) fn overflowed(&self) -> usize {
        self.overflowed.load(Ordering::Relaxed)
    }

    /// Adds a statement about the pixels to outputs that are written from now on.
    pub(crate) fn say(&self, remark: Option<Remark>) {
        if let Some(remark) = remark {
            self.said.get_or_init(|| remark);
        }
    }

    /// Leaves a frame out of outputs that are videos.
    pub(crate) fn leave_out(&self, place: usize) -> Result<()> {
        Ok(self.videos.leave_out(place, &self.options.pool)?)
    }

    /// Returns the number of samples of a picture that are brighter than their type holds. Colours of integers are divided by alpha.
    fn brighter(&self, image: &Image<Rgba>) -> usize {
        let has_alpha = self.encoder.channels().has_alpha() && !self.encoder.depth().is_float();
        let most = self.most;
        if most == f32::MAX {
            return 0;
        }
        let is_brighter = |sample: f32, alpha: f32| sample.abs() > most * if has_alpha { alpha } else { 1.0 };
        let of_pixel = |Rgba([red, green, blue, alpha]): &Rgba| {
            [red, green, blue].into_iter().filter(|sample| is_brighter(**sample, *alpha)).count()
        };
        image.pixels().par_iter().with_min_len(1 << 14).map(of_pixel).sum()
    }

    /// Encodes light, whose memory goes back to the pool.
    pub(crate) fn encode(&self, mut image: Image<Rgba>, threads: Threads) -> EncodedImage {
        if let Some(conversion) = &self.conversion {
            conversion.convert_all(image.pixels_mut(), threads);
        }
        self.overflowed.fetch_add(self.brighter(&image), Ordering::Relaxed);
        let encoded = self.encoder.encode_in(&image, threads, &self.options.pool);
        self.options.pool.give_image(image);
        encoded
    }

    /// Encodes the light of a frame's pictures, so that those which wait to be written hold none.
    pub(crate) fn encode_all(&self, pictures: &mut [Levels]) {
        for levels in pictures {
            if let Levels::Light(images) = levels {
                let encoded = images.drain(..).map(|image| self.encode(image, Threads::All)).collect();
                *levels = Levels::Encoded(encoded);
            }
        }
    }

    /// Adds further channels to a picture of light.
    pub(crate) fn with_planes(&self, picture: Levels, size: (usize, usize), planes: Vec<Plane>) -> Levels {
        match picture {
            Levels::Light(levels) => {
                let picture = levels.into_iter().next().map(|image| self.encode(image, Threads::All));
                Levels::Layered { size, picture, planes }
            }
            other => other,
        }
    }

    /// Writes a picture of that size but for its name, while its rows are made, as many at once.
    pub(crate) fn save_rows(
        &self,
        words: FrameWords,
        path: &Path,
        (size, at_once): ((usize, usize), usize),
        make: &mut (dyn FnMut(Range<usize>) -> Option<EncodedImage> + Send),
    ) -> Result<Hidden> {
        let (channels, depth, alpha_mode) = (self.encoder.channels(), self.encoder.depth(), self.encoder.alpha_mode());
        let rows = MadeRows { size, channels, depth, alpha_mode, at_once, make };
        Ok(write_rows_hidden(path, rows, &self.options_of(words))?)
    }

    /// Writes a picture with further channels, like [`save_rows`](Self::save_rows).
    pub(crate) fn save_layer_rows(
        &self,
        words: FrameWords,
        path: &Path,
        (size, at_once): ((usize, usize), usize),
        layers: &LayerPlan,
        make: &mut (dyn FnMut(Range<usize>) -> Option<LayeredRows> + Send),
    ) -> Result<Hidden> {
        let form = (self.encoder.channels(), self.encoder.depth());
        let picture = (!layers.leaves_picture_out()).then_some(form);
        let further = layers.groups.iter().flat_map(|group| &group.channels);
        let planes = further.map(|channel| (channel.name.clone(), channel.kind)).collect();
        let made = MadeLayers { size, picture, names: self.names.clone(), planes, at_once, make };
        Ok(write_layer_rows_hidden(path, made, &self.options_of(words))?)
    }

    /// Returns the options of a file, with what its own frame says.
    fn options_of(&self, words: FrameWords) -> WriteOptions {
        let mut options = self.options.clone();
        if let Some(carried) = words.carried {
            options.metadata.carried = carried;
        }
        options.metadata.origin = words.origin.as_deref().map(str::to_owned);
        options.metadata.remarks.extend(self.said.get().cloned());
        options
    }

    /// Writes an output of a frame, a picture and its mip levels, with what its own frame says. Their memory goes back to the pool.
    pub(crate) fn save(&self, words: FrameWords, levels: Levels, path: &Path, threads: Threads) -> Result<()> {
        let hidden = self.save_hidden(words, levels, path, threads)?;
        Ok(hidden.map_or(Ok(()), Hidden::appear)?)
    }

    /// Writes an output like [`save`](Self::save), but for its name; `None` if it goes into a video.
    pub(crate) fn save_hidden(
        &self,
        words: FrameWords,
        levels: Levels,
        path: &Path,
        threads: Threads,
    ) -> Result<Option<Hidden>> {
        let (place, options) = (words.place, &self.options_of(words));
        let pool = &*self.options.pool;
        let encode = |image: Image<Rgba>| self.encode(image, threads);
        let encoded: Vec<EncodedImage> = match levels {
            Levels::Light(images) => images.into_iter().map(encode).collect(),
            Levels::Codes(images) => images.into_iter().map(EncodedImage::of_codes).collect(),
            Levels::Encoded(images) => images,
            Levels::Written(file) => return Ok(Some(file)),
            Levels::Layered { size, picture, planes } => {
                let layered = LayeredImage { size, picture: picture.as_ref(), names: self.names.clone(), planes };
                let written = write_layers_hidden(path, layered, options);
                picture.into_iter().for_each(|image| pool.give(image.into_samples()));
                return Ok(Some(written?));
            }
        };
        if self.videos.holds(path) {
            // A frame has no levels.
            let frame = encoded.into_iter().next();
            frame.map_or(Ok(()), |frame| self.videos.put(path, place, frame, pool))?;
            return Ok(None);
        }
        let written = write_hidden(path, &encoded, options);
        encoded.into_iter().for_each(|image| pool.give(image.into_samples()));
        Ok(Some(written?))
    }
}

/// Returns the brightest light that samples hold, but for rounding: the code of one, in integers.
fn most_of(Light { depth, transfer, .. }: &Light) -> f32 {
    const ROUNDING: f32 = 1.002;
    match depth {
        Depth::Half | Depth::Float => depth.most(),
        Depth::Eight | Depth::Ten | Depth::Twelve | Depth::Sixteen => {
            ROUNDING * transfer.decode(1.0, ColourChannel::Green) as f32
        }
    }
}

fn encoder_of(light: &Light) -> Encoder {
    Encoder::new(light.channels, light.depth, &light.transfer)
}
