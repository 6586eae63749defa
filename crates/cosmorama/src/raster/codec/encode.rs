use half::f16;
use rayon::prelude::*;

use super::byte_codes::RgbTables;
use super::decode::CHUNK;
use super::quantizer::Quantizer;
use crate::raster::{
    AlphaMode, Channels, ColourChannel, Depth, EncodedImage, FramePool, Image, Rgba, Sample, Samples, Transfer,
};

impl EncodedImage {
    /// Encodes an image of light, with an [`Encoder`] of its own and all threads.
    pub fn encode(light: &Image<Rgba>, channels: Channels, depth: Depth, transfer: &Transfer) -> Self {
        Encoder::new(channels, depth, transfer).encode(light, Threads::All)
    }
}

impl Image<Rgba> {
    /// Encodes linear light as a file's samples: red, green and blue, and alpha where any pixel is transparent.
    ///
    /// ```
    /// use cosmorama::raster::{Channels, Depth, Image, Rgba, Transfer};
    ///
    /// let codes = Image::filled(2, 2, Rgba::opaque(1.0, 0.5, 0.0)).to_codes(Depth::Eight, &Transfer::Srgb);
    /// assert_eq!(codes.channels(), Channels::Rgb);
    /// ```
    pub fn to_codes(&self, depth: Depth, transfer: &Transfer) -> EncodedImage {
        let is_opaque = self.pixels().iter().all(|pixel| pixel.alpha() >= 1.0);
        let channels = if is_opaque { Channels::Rgb } else { Channels::Rgba };
        EncodedImage::encode(self, channels, depth, transfer)
    }
}

/// Threads that work on an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// Only the calling thread: other threads have images of their own.
    One,
    /// All threads.
    All,
}

/// Encodes light as samples. Its tables are reused for further images.
///
/// Integers are rounded and clamped, with straight alpha; floats are premultiplied and keep light beyond white. Without
/// an alpha channel, alpha is ignored: composite over a background first. Grey is the luminance of Rec. 709. NaN
/// becomes zero.
#[derive(Debug)]
pub struct Encoder {
    channels: Channels,
    depth: Depth,
    transfer: Transfer,
    /// Quantizer for integer samples; `None` for floats.
    quantizer: Option<Quantizer>,
}

impl Encoder {
    /// Creates the encoder for samples of one kind.
    pub fn new(channels: Channels, depth: Depth, transfer: &Transfer) -> Self {
        let last = match depth {
            Depth::Eight => Some(255),
            Depth::Ten => Some(1023),
            Depth::Twelve => Some(4095),
            Depth::Sixteen => Some(65535),
            Depth::Half | Depth::Float => None,
        };
        let quantizer = last.map(|last| Quantizer::new(transfer, last));
        Self { channels, depth, transfer: transfer.clone(), quantizer }
    }

    /// Returns the samples of a pixel, if they are red, green and blue of 8 bits.
    pub fn rgb(&self, light: Rgba) -> Option<[u8; 3]> {
        self.rgb_codes().map(|codes| codes.rgb(light))
    }

    /// Returns the conversion to opaque pixels of 8 bits; `None` if samples are of another kind.
    pub(crate) fn rgb_codes(&self) -> Option<RgbCodes<'_>> {
        let is_rgb8 = self.channels == Channels::Rgb && self.depth == Depth::Eight;
        let quantizer = self.quantizer.as_ref().filter(|_| is_rgb8)?;
        Some(quantizer.byte_tables().map_or(RgbCodes::Search(quantizer), RgbCodes::Tables))
    }

    /// Encodes an image.
    pub fn encode(&self, light: &Image<Rgba>, threads: Threads) -> EncodedImage {
        self.encode_in(light, threads, &FramePool::default())
    }

    /// Encodes an image, into memory of a pool.
    pub fn encode_in(&self, light: &Image<Rgba>, threads: Threads, pool: &FramePool) -> EncodedImage {
        let work = &Work { light, channels: self.channels, threads, pool };
        let samples = match (&self.quantizer, self.depth) {
            (Some(codes), Depth::Ten) => Samples::U16(self.integers(codes, 1023, work, |code| code << 6 | code >> 4)),
            (Some(codes), Depth::Twelve) => {
                Samples::U16(self.integers(codes, 4095, work, |code| code << 4 | code >> 8))
            }
            (Some(codes), Depth::Sixteen) => Samples::U16(self.integers(codes, 65535, work, |code| code)),
            (Some(codes), _) => Samples::U8(self.integers(codes, 255, work, |code| code as u8)),
            (None, Depth::Half) => Samples::Half(self.floats(work, to_half)),
            (None, _) => Samples::Float(self.floats(work, |sample| sample)),
        };
        let (width, height) = (light.width(), light.height());
        EncodedImage::from_parts(width, height, self.channels, self.depth, self.alpha_mode(), samples)
    }

    /// Returns how the colours of encoded images relate to their alpha.
    pub fn alpha_mode(&self) -> AlphaMode {
        if self.depth.is_float() { AlphaMode::Premultiplied } else { AlphaMode::Straight }
    }

    /// Returns the channels of encoded images.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// Returns the depth of encoded images.
    pub fn depth(&self) -> Depth {
        self.depth
    }

    fn integers<S: Sample + Send>(
        &self,
        codes: &Quantizer,
        last: u16,
        work: &Work,
        spread: impl Fn(u16) -> S + Sync,
    ) -> Vec<S> {
        let channels = self.channels;
        let quantize = |light: f32, channel| spread(codes.code(light, channel));
        let straight = |pixel: Rgba| {
            let [red, green, blue, _] = pixel.0;
            if channels.has_alpha() { pixel.unpremultiplied() } else { [red, green, blue] }
        };
        let grey = |pixel: Rgba| quantize(luminance(straight(pixel)), ColourChannel::Green);
        let colour = |pixel: Rgba| {
            let colour = straight(pixel);
            ColourChannel::ALL.map(|channel| quantize(colour[channel.index()], channel))
        };
        let alpha = |pixel: Rgba| spread((pixel.alpha().clamp(0.0, 1.0) * f32::from(last)).round() as u16);
        work.interleaved(grey, colour, alpha)
    }

    fn floats<S: Sample + Send>(&self, work: &Work, sample: impl Fn(f32) -> S + Sync) -> Vec<S> {
        let channels = self.channels;
        let code = |light, alpha, channel| sample(code_of(light, alpha, channels, &self.transfer, channel));
        let grey = |pixel: Rgba| {
            let [red, green, blue, alpha] = pixel.finite().0;
            code(luminance([red, green, blue]), alpha, ColourChannel::Green)
        };
        let colour = |pixel: Rgba| {
            let light = pixel.finite().0;
            ColourChannel::ALL.map(|channel| code(light[channel.index()], light[3], channel))
        };
        let alpha = |pixel: Rgba| sample(pixel.finite().alpha());
        work.interleaved(grey, colour, alpha)
    }
}

/// Conversion of light to opaque pixels of 8 bits.
#[derive(Clone, Copy)]
pub(crate) enum RgbCodes<'a> {
    /// By small tables of red, green and blue.
    Tables(RgbTables<'a>),
    /// By a search, for curves that have no such tables.
    Search(&'a Quantizer),
}

impl RgbCodes<'_> {
    /// Returns the codes of light, whose alpha is ignored, from the low byte on.
    #[inline(always)]
    fn packed(self, Rgba(light): Rgba) -> u32 {
        match self {
            Self::Tables(tables) => tables.packed(light),
            Self::Search(quantizer) => {
                let code = |channel: ColourChannel| u32::from(quantizer.code(light[channel.index()], channel));
                code(ColourChannel::Red) | code(ColourChannel::Green) << 8 | code(ColourChannel::Blue) << 16
            }
        }
    }

    /// Returns the codes of eight lights, each from the low byte on.
    #[inline(always)]
    pub(crate) fn packed_eight(self, light: &[Rgba; 8]) -> [u32; 8] {
        match self {
            Self::Tables(tables) => tables.packed_eight(bytemuck::cast_ref(light)),
            Self::Search(_) => light.map(|light| self.packed(light)),
        }
    }

    /// Returns the codes of light, whose alpha is ignored.
    #[inline(always)]
    pub(crate) fn rgb(self, light: Rgba) -> [u8; 3] {
        let [red, green, blue, _] = self.packed(light).to_le_bytes();
        [red, green, blue]
    }
}

/// Image to encode, with the threads for it and the pool of memory for its samples.
struct Work<'a> {
    light: &'a Image<Rgba>,
    channels: Channels,
    threads: Threads,
    pool: &'a FramePool,
}

impl Work<'_> {
    /// Returns the samples of the image's channels, pixel by pixel.
    fn interleaved<S: Sample + Send>(
        &self,
        grey: impl Fn(Rgba) -> S + Sync,
        colour: impl Fn(Rgba) -> [S; 3] + Sync,
        alpha: impl Fn(Rgba) -> S + Sync,
    ) -> Vec<S> {
        match self.channels {
            Channels::Grey => self.by_pixels(|pixel| [grey(pixel)]),
            Channels::GreyAlpha => self.by_pixels(|pixel| [grey(pixel), alpha(pixel)]),
            Channels::Rgb => self.by_pixels(colour),
            Channels::Rgba => self.by_pixels(|pixel| {
                let [red, green, blue] = colour(pixel);
                [red, green, blue, alpha(pixel)]
            }),
        }
    }

    /// Fills the samples of each pixel.
    fn by_pixels<S: Sample + Send, const COUNT: usize>(&self, samples: impl Fn(Rgba) -> [S; COUNT] + Sync) -> Vec<S> {
        let light = self.light.pixels();
        let mut list = self.pool.take(COUNT * light.len());
        let encode = |list: &mut [S], light: &[Rgba]| {
            let (pixels, _) = list.as_chunks_mut::<COUNT>();
            pixels.iter_mut().zip(light).for_each(|(into, pixel)| *into = samples(*pixel));
        };
        match self.threads {
            Threads::One => encode(&mut list, light),
            Threads::All => in_chunks(&mut list, COUNT, light, &encode),
        }
        list
    }
}

/// Encodes chunks of pixels at once. The closure is dynamic so that this is compiled once for each type of samples.
fn in_chunks<S: Sample + Send>(
    list: &mut [S],
    count: usize,
    light: &[Rgba],
    encode: &(dyn Fn(&mut [S], &[Rgba]) + Sync),
) {
    let chunks = list.par_chunks_mut(count * CHUNK).zip(light.par_chunks(CHUNK));
    chunks.for_each(|(list, light)| encode(list, light));
}

/// Rec. 709 luminance weights.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

fn luminance([red, green, blue]: [f32; 3]) -> f32 {
    if red == green && green == blue {
        return green;
    }
    LUMINANCE[0] * red + LUMINANCE[1] * green + LUMINANCE[2] * blue
}

fn to_half(sample: f32) -> f16 {
    // Larger values would become infinite.
    f16::from_f32(sample.clamp(f16::MIN.to_f32(), f16::MAX.to_f32()))
}

/// Returns the premultiplied code value of premultiplied light.
fn code_of(light: f32, alpha: f32, channels: Channels, transfer: &Transfer, channel: ColourChannel) -> f32 {
    if *transfer == Transfer::Linear {
        return light;
    }
    // The transfer function applies to the unmultiplied colour. A glow (alpha zero) has no colour, only light.
    let alpha = if channels.has_alpha() && alpha > 0.0 { alpha } else { 1.0 };
    transfer.encode(f64::from(light / alpha), channel) as f32 * alpha
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::ToneCurve;
    use std::sync::Arc;

    fn transfers() -> Vec<Transfer> {
        let table = |gamma: f32| (0..4096).map(|i| (i as f32 / 4095.0).powf(gamma)).collect::<Vec<_>>();
        let curve = ToneCurve::new([table(1.8), table(2.0), table(2.2)]).unwrap();
        let gammas = [1.0, 1.8, 2.2, 2.6].map(Transfer::Gamma);
        let mut all = vec![Transfer::Srgb, Transfer::Linear, Transfer::Bt1886, Transfer::Pq, Transfer::Hlg];
        all.extend(gammas);
        all.push(Transfer::Curve(Arc::new(curve)));
        all
    }

    fn round_trip(image: &EncodedImage, transfer: &Transfer) -> EncodedImage {
        EncodedImage::encode(&image.to_light(transfer), image.channels(), image.depth(), transfer)
    }

    #[test]
    fn every_8_bit_code_comes_back() {
        let codes: Vec<u8> = (0..=255).flat_map(|code| [code, code, code]).collect();
        let image = EncodedImage::new(256, 1, Channels::Rgb, Depth::Eight, Samples::U8(codes)).unwrap();
        for transfer in transfers() {
            assert_eq!(round_trip(&image, &transfer), image, "{transfer:?}");
        }
    }

    #[test]
    fn every_16_bit_code_comes_back() {
        let codes: Vec<u16> = (0..=65535).flat_map(|code| [code, code, code]).collect();
        let image = EncodedImage::new(256, 256, Channels::Rgb, Depth::Sixteen, Samples::U16(codes)).unwrap();
        for transfer in transfers() {
            assert!(round_trip(&image, &transfer) == image, "{transfer:?}");
        }
    }

    #[test]
    fn every_10_and_12_bit_code_comes_back_and_fills_the_range() {
        for (depth, bits) in [(Depth::Ten, 10), (Depth::Twelve, 12)] {
            let spread = |code: u32| (code << (16 - bits) | code >> (2 * bits - 16)) as u16;
            let codes: Vec<u16> = (0..1 << bits).map(spread).collect();
            assert_eq!(codes.last(), Some(&u16::MAX));
            let image = EncodedImage::new(codes.len(), 1, Channels::Grey, depth, Samples::U16(codes)).unwrap();
            assert!(round_trip(&image, &Transfer::Srgb) == image, "{depth}");
        }
    }

    #[test]
    fn grey_and_alpha_come_back() {
        let samples: Vec<u8> = (0..=255).flat_map(|code: u8| [code, code.max(1)]).collect();
        let image = EncodedImage::new(256, 1, Channels::GreyAlpha, Depth::Eight, Samples::U8(samples)).unwrap();
        assert_eq!(round_trip(&image, &Transfer::Srgb), image);
    }

    #[test]
    fn floats_come_back_through_every_transfer() {
        let light = Image::new(1, 1, vec![Rgba([0.25, 0.125, 0.0625, 0.5])]).unwrap();
        for transfer in transfers() {
            let back = EncodedImage::encode(&light, Channels::Rgba, Depth::Float, &transfer).to_light(&transfer);
            for channel in 0..4 {
                let (a, b) = (back.get(0, 0).0[channel], light.get(0, 0).0[channel]);
                assert!((a - b).abs() < 1e-5, "{transfer:?}: {a} is not {b}");
            }
        }
    }

    #[test]
    fn nothing_that_is_not_finite_gets_out() {
        let light = Image::new(2, 1, vec![Rgba::opaque(f32::NAN, -1.0, 9.0), Rgba::opaque(f32::INFINITY, 1e30, 0.0)]);
        let light = light.unwrap();
        let Samples::U8(bytes) =
            EncodedImage::encode(&light, Channels::Rgb, Depth::Eight, &Transfer::Srgb).into_samples()
        else {
            panic!("8 bits")
        };
        assert_eq!(bytes, [0, 0, 255, 255, 255, 0]);
        let Samples::Half(halves) =
            EncodedImage::encode(&light, Channels::Rgb, Depth::Half, &Transfer::Linear).into_samples()
        else {
            panic!("halves")
        };
        assert!(halves.iter().all(|sample| sample.is_finite()));
    }

    #[test]
    fn grey_is_luminance() {
        let light = Image::new(1, 1, vec![Rgba::opaque(0.0, 1.0, 0.0)]).unwrap();
        let grey = EncodedImage::encode(&light, Channels::Grey, Depth::Float, &Transfer::Linear);
        assert_eq!(*grey.samples(), Samples::Float(vec![0.7152]));
    }
}
