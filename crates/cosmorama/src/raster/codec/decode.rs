use std::iter::Sum;
use std::ops::{Add, Range};
use std::sync::{Arc, Mutex, PoisonError};

use half::f16;
use rayon::prelude::*;

use crate::raster::{AlphaMode, Channels, ColourChannel, EncodedImage, Image, Rgba, Samples, Transfer};

/// Numbers of pixels whose samples are no light. Only files of floats can hold such samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IrregularPixels {
    /// Pixels with a sample that is NaN. They count as missing.
    pub missing: usize,
    /// Pixels with an infinite sample, which is decoded as 65504, the largest half float.
    pub infinite: usize,
    /// Pixels whose alpha is below 0 or above 1, which is decoded as 0 or 1.
    pub alpha: usize,
    /// Pixels with a negative colour. Finite ones stay as they are.
    pub negative: usize,
}

impl IrregularPixels {
    /// Counts what is irregular in a pixel's samples, 0 or 1 of each kind.
    fn of(raw: &Rgba) -> Self {
        if raw.0.iter().any(|sample| sample.is_nan()) {
            return Self { missing: 1, ..Self::default() };
        }
        let [red, green, blue, alpha] = raw.0;
        Self {
            missing: 0,
            infinite: raw.0.iter().any(|sample| sample.is_infinite()).into(),
            alpha: (!(0.0..=1.0).contains(&alpha)).into(),
            negative: (red < 0.0 || green < 0.0 || blue < 0.0).into(),
        }
    }
}

impl Add for IrregularPixels {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            missing: self.missing + other.missing,
            infinite: self.infinite + other.infinite,
            alpha: self.alpha + other.alpha,
            negative: self.negative + other.negative,
        }
    }
}

impl Sum for IrregularPixels {
    fn sum<I: Iterator<Item = Self>>(counts: I) -> Self {
        counts.fold(Self::default(), Self::add)
    }
}

impl EncodedImage {
    /// Decodes every pixel to linear light, premultiplied by alpha. Grey becomes red = green = blue, and alpha is 1
    /// without an alpha channel. Float samples follow the rule of [`Rgba::finite`], and alpha is limited to 0–1. Returns how
    /// many pixels were not light.
    ///
    /// # Panics
    /// When the length of `into` is not the image's number of pixels.
    pub fn decode(&self, transfer: &Transfer, into: &mut [Rgba]) -> IrregularPixels {
        Decoder::default().decode(self, transfer, into)
    }

    /// Decodes to a new image; see [`decode`](Self::decode).
    pub fn to_light(&self, transfer: &Transfer) -> Image<Rgba> {
        let mut light = Image::filled(self.width(), self.height(), Rgba::TRANSPARENT);
        self.decode(transfer, light.pixels_mut());
        light
    }
}

/// Decodes many images. Its tables of code values are reused for images of the same kind.
#[derive(Debug, Default)]
pub struct Decoder {
    /// Tables by transfer function and number of codes; the most recently used last.
    tables: Mutex<Vec<(Transfer, u32, Arc<Tables>)>>,
}

impl Decoder {
    /// Number of tables that are kept: more than a set of faces needs, in less memory than a small image.
    const MOST: usize = 8;

    /// Decodes one of many images; see [`EncodedImage::decode`].
    ///
    /// # Panics
    /// When the length of `into` is not the image's number of pixels.
    pub fn decode(&self, image: &EncodedImage, transfer: &Transfer, into: &mut [Rgba]) -> IrregularPixels {
        assert_eq!(into.len(), image.width() * image.height(), "one pixel of light for each pixel of the file");
        let some = image.rows_at_once();
        let parts = into.par_chunks_mut((some * image.width()).max(1)).enumerate();
        parts.map(|(part, into)| self.decode_rows(image, transfer, part * some, into)).sum()
    }

    /// Decodes rows from `first` on until `into` is full, on the calling thread; see [`Self::decode`].
    ///
    /// # Panics
    /// When `into` does not hold whole rows, or the image has fewer rows.
    pub fn decode_rows(
        &self,
        image: &EncodedImage,
        transfer: &Transfer,
        first: usize,
        into: &mut [Rgba],
    ) -> IrregularPixels {
        let rows = image.samples_of_rows(first, into.len());
        match image.samples() {
            Samples::U8(samples) => decode_integers(&samples[rows], image, &self.tables(transfer, 256), into),
            Samples::U16(samples) => decode_integers(&samples[rows], image, &self.tables(transfer, 65536), into),
            Samples::Half(samples) => decode_floats(&samples[rows], f16::to_f32, image, transfer, into),
            Samples::Float(samples) => decode_floats(&samples[rows], |sample| sample, image, transfer, into),
        }
    }

    /// Returns the tables of a transfer function. Other threads that need the same ones wait for them.
    fn tables(&self, transfer: &Transfer, codes: u32) -> Arc<Tables> {
        // The list is whole after every step, even if a thread panicked.
        let mut known = self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., tables)) = known.iter().find(|(of, count, _)| (of, *count) == (transfer, codes)) {
            return Arc::clone(tables);
        }
        let tables = Arc::new(Tables::new(transfer, codes));
        if known.len() == Self::MOST {
            known.remove(0);
        }
        known.push((transfer.clone(), codes, Arc::clone(&tables)));
        tables
    }
}

/// Linear light of every code value: one table if all channels share a curve, else one for each channel.
#[derive(Debug)]
struct Tables {
    colour: Vec<Vec<f32>>,
    last: f32,
}

impl Tables {
    fn new(transfer: &Transfer, codes: u32) -> Self {
        let last = f64::from(codes - 1);
        let table = |channel: &ColourChannel| {
            (0..codes).map(|code| transfer.decode(f64::from(code) / last, *channel) as f32).collect()
        };
        Self { colour: transfer.channels().iter().map(table).collect(), last: last as f32 }
    }

    /// Returns the table of a channel.
    fn of(&self, channel: ColourChannel) -> &[f32] {
        &self.colour[channel.index() % self.colour.len()]
    }
}

/// Approximate number of pixels that a thread processes at once.
pub(crate) const CHUNK: usize = 1 << 14;

impl EncodedImage {
    /// Returns the number of rows that a thread processes at once.
    pub(crate) fn rows_at_once(&self) -> usize {
        CHUNK.div_ceil(self.width().max(1))
    }

    /// Returns the range of samples of so many pixels, in whole rows from `first` on.
    pub(crate) fn samples_of_rows(&self, first: usize, pixels: usize) -> Range<usize> {
        assert!(pixels.is_multiple_of(self.width().max(1)), "whole rows of {} pixels", self.width());
        let count = self.channels().count();
        let start = first * self.width() * count;
        start..start + pixels * count
    }
}

fn by_pixels<S>(samples: &[S], channels: Channels, into: &mut [Rgba], mut pixel: impl FnMut(&[S]) -> Rgba) {
    for (into, sample) in into.iter_mut().zip(samples.chunks_exact(channels.count())) {
        *into = pixel(sample);
    }
}

fn decode_integers<S: Copy + Into<u32>>(
    samples: &[S],
    image: &EncodedImage,
    tables: &Tables,
    into: &mut [Rgba],
) -> IrregularPixels {
    let [red, green, blue] = ColourChannel::ALL.map(|channel| tables.of(channel));
    let code = |sample: S| sample.into() as usize;
    let alpha = |sample: S| sample.into() as f32 / tables.last;
    let channels = image.channels();
    match channels {
        Channels::Grey => by_pixels(samples, channels, into, |s| {
            let light = green[code(s[0])];
            Rgba::opaque(light, light, light)
        }),
        Channels::GreyAlpha => by_pixels(samples, channels, into, |s| {
            let light = green[code(s[0])];
            Rgba::opaque(light, light, light) * alpha(s[1])
        }),
        Channels::Rgb => {
            by_pixels(samples, channels, into, |s| Rgba::opaque(red[code(s[0])], green[code(s[1])], blue[code(s[2])]))
        }
        Channels::Rgba => by_pixels(samples, channels, into, |s| {
            Rgba::opaque(red[code(s[0])], green[code(s[1])], blue[code(s[2])]) * alpha(s[3])
        }),
    }
    // An integer is always a number.
    IrregularPixels::default()
}

fn decode_floats<S: Copy>(
    samples: &[S],
    float: impl Fn(S) -> f32,
    image: &EncodedImage,
    transfer: &Transfer,
    into: &mut [Rgba],
) -> IrregularPixels {
    let (channels, mode) = (image.channels(), image.alpha_mode());
    let mut irregular = IrregularPixels::default();
    by_pixels(samples, channels, into, |s| {
        let raw = match channels {
            Channels::Grey => Rgba::opaque(float(s[0]), float(s[0]), float(s[0])),
            Channels::GreyAlpha => Rgba([float(s[0]), float(s[0]), float(s[0]), float(s[1])]),
            Channels::Rgb => Rgba::opaque(float(s[0]), float(s[1]), float(s[2])),
            Channels::Rgba => Rgba([float(s[0]), float(s[1]), float(s[2]), float(s[3])]),
        };
        irregular = irregular + IrregularPixels::of(&raw);
        light_of(raw.finite(), mode, transfer)
    });
    irregular
}

fn light_of(code: Rgba, mode: AlphaMode, transfer: &Transfer) -> Rgba {
    let [red, green, blue, alpha] = code.0;
    let alpha = alpha.clamp(0.0, 1.0);
    // Straight colour is multiplied by alpha; premultiplied colour is divided before its transfer function
    // and multiplied after, except where alpha is zero: a glow has no colour of its own, only light.
    let (before, after) = match mode {
        AlphaMode::Straight => (1.0, alpha),
        AlphaMode::Premultiplied if *transfer == Transfer::Linear || alpha == 0.0 => (1.0, 1.0),
        AlphaMode::Premultiplied => (alpha, alpha),
    };
    let decode = |code: f32, channel| match transfer {
        Transfer::Linear => code / before * after,
        _ => transfer.decode(f64::from(code / before), channel) as f32 * after,
    };
    // Again: a power may have overflowed.
    Rgba([
        decode(red, ColourChannel::Red),
        decode(green, ColourChannel::Green),
        decode(blue, ColourChannel::Blue),
        alpha,
    ])
    .finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::Depth;

    fn decode_one(channels: Channels, depth: Depth, samples: Samples, transfer: &Transfer) -> Rgba {
        *EncodedImage::new(1, 1, channels, depth, samples).unwrap().to_light(transfer).get(0, 0)
    }

    #[test]
    fn straight_alpha_is_multiplied_in() {
        let pixel = decode_one(Channels::Rgba, Depth::Eight, Samples::U8(vec![255, 0, 255, 51]), &Transfer::Srgb);
        assert_eq!(pixel, Rgba([0.2, 0.0, 0.2, 0.2]));
    }

    #[test]
    fn what_was_worked_out_once_serves_again() {
        let decoder = Decoder::default();
        let decode = |transfer: &Transfer| {
            let image = EncodedImage::new(1, 1, Channels::Grey, Depth::Sixteen, Samples::U16(vec![31_000])).unwrap();
            let mut light = [Rgba::TRANSPARENT];
            decoder.decode(&image, transfer, &mut light);
            assert_eq!(light[0].0[0], transfer.decode(31_000.0 / 65_535.0, ColourChannel::Green) as f32);
        };
        let kept = || -> Vec<Arc<Tables>> {
            decoder.tables.lock().unwrap().iter().map(|(.., tables)| Arc::clone(tables)).collect()
        };
        let is_same = |a: &[Arc<Tables>], b: &[Arc<Tables>]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
        };
        let kinds: Vec<Transfer> =
            (0..Decoder::MOST + 2).map(|step| Transfer::Gamma(1.0 + step as f64 / 10.0)).collect();
        let (first, others) = kinds.split_at(Decoder::MOST);
        first.iter().for_each(decode);
        let before = kept();
        assert_eq!(before.len(), Decoder::MOST);
        first.iter().for_each(decode);
        assert!(is_same(&before, &kept()));
        // More tables than are kept, so that the oldest are dropped.
        others.iter().for_each(decode);
        let after = kept();
        assert_eq!(after.len(), Decoder::MOST);
        assert!(is_same(&before[others.len()..], &after[..Decoder::MOST - others.len()]));
    }

    #[test]
    fn nan_is_missing_and_infinity_is_finite() {
        let nan = Samples::Float(vec![1.0, f32::NAN, 0.0]);
        assert_eq!(decode_one(Channels::Rgb, Depth::Float, nan, &Transfer::Linear), Rgba::TRANSPARENT);
        let half = Samples::Half(vec![f16::INFINITY, f16::NEG_INFINITY, f16::ONE]);
        let pixel = decode_one(Channels::Rgb, Depth::Half, half, &Transfer::Linear);
        assert_eq!(pixel, Rgba::opaque(65504.0, -65504.0, 1.0));
        let overflow = Samples::Float(vec![1e38; 3]);
        let pixel = decode_one(Channels::Rgb, Depth::Float, overflow, &Transfer::Gamma(3.0));
        assert!(pixel.0.iter().all(|c| c.is_finite()), "{pixel:?}");
    }

    #[test]
    fn missing_pixels_are_counted_with_and_without_alpha() {
        let mut light = [Rgba::TRANSPARENT; 3];
        let nan = f32::NAN;
        let veiled = Samples::Float(vec![1.0, 0.5, nan, 1.0, 0.0, nan]);
        let image = EncodedImage::new(3, 1, Channels::GreyAlpha, Depth::Float, veiled).unwrap();
        assert_eq!(image.decode(&Transfer::Linear, &mut light).missing, 2);
        // A transparent pixel is not missing.
        let clear = Samples::Half(vec![f16::ONE, f16::ZERO, f16::NAN, f16::ONE, f16::ZERO, f16::ZERO]);
        let image = EncodedImage::new(3, 1, Channels::GreyAlpha, Depth::Half, clear).unwrap();
        assert_eq!(image.decode(&Transfer::Linear, &mut light).missing, 1);
        let opaque = EncodedImage::new(3, 1, Channels::Grey, Depth::Eight, Samples::U8(vec![0, 1, 2])).unwrap();
        assert_eq!(opaque.decode(&Transfer::Srgb, &mut light), IrregularPixels::default());
    }

    #[test]
    fn infinite_samples_and_impossible_alpha_are_counted() {
        let mut light = [Rgba::TRANSPARENT; 4];
        let (infinity, nan) = (f32::INFINITY, f32::NAN);
        let samples = vec![infinity, -1.0, -1.0, 0.5, 2.0, 1.5, nan, infinity];
        let image = EncodedImage::new(4, 1, Channels::GreyAlpha, Depth::Float, Samples::Float(samples)).unwrap();
        let expected = IrregularPixels { missing: 1, infinite: 1, alpha: 2, negative: 1 };
        assert_eq!(image.decode(&Transfer::Linear, &mut light), expected);
        assert_eq!(light.map(Rgba::alpha), [0.0, 0.5, 1.0, 0.0]);
    }

    #[test]
    fn a_glow_without_alpha_keeps_its_light() {
        let glow = Samples::Float(vec![3.0, 2.0, 1.0, 0.0]);
        let image = EncodedImage::new(1, 1, Channels::Rgba, Depth::Float, glow).unwrap();
        let premultiplied = image.with_alpha_mode(AlphaMode::Premultiplied).to_light(&Transfer::Linear);
        assert_eq!(*premultiplied.get(0, 0), Rgba([3.0, 2.0, 1.0, 0.0]));
    }
}
