//! Conversion of 8-bit codes to 15-bit linear light, and back.

pub(crate) mod light;

use rayon::prelude::*;

use super::codec::quantizer::Quantizer;
use super::fixed_point::light::FixedLight;
use super::{Channels, ColourChannel, EncodedImage, Image, Rgba, Samples, Transfer};

/// Texels by code, packed into numbers.
type ByCode = [u64; 256];

/// Decoder of 8-bit codes to 15-bit linear light.
#[derive(Clone, Debug)]
pub struct FixedDecoder {
    /// Contribution of each code of a channel to a packed texel, which is the sum of three contributions.
    channels: [ByCode; 3],
    grey: ByCode,
}

impl FixedDecoder {
    /// Creates the decoder; `None` where 15 bits cannot separate all codes, or light goes beyond white.
    pub fn new(transfer: &Transfer) -> Option<Self> {
        let light = |code: usize, channel| transfer.decode(code as f64 / 255.0, channel);
        let quantizer = Quantizer::new(transfer, 255);
        let comes_back = |channel: ColourChannel| {
            (0..256).all(|code| {
                let light = (light(code, channel) * f64::from(FixedLight::WHITE)).round() as f32;
                (0.0..=FixedLight::WHITE).contains(&light)
                    && usize::from(quantizer.code(light / FixedLight::WHITE, channel)) == code
            })
        };
        let level = |code, channel| (light(code, channel) * f64::from(FixedLight::WHITE)).round() as i16;
        let alone = |channel: ColourChannel| {
            by_code(|code| {
                let mut texel = [0; 4];
                texel[channel.index()] = level(code, channel);
                texel
            })
        };
        // Where the channels' curves differ, green's is used for grey.
        let grey = |code| level(code, ColourChannel::Green);
        ColourChannel::ALL.into_iter().all(comes_back).then(|| Self {
            channels: ColourChannel::ALL.map(alone),
            grey: by_code(|code| [grey(code), grey(code), grey(code), 0]),
        })
    }

    /// Returns whether the decoder can decode an image: an opaque one of 8 bits.
    pub fn takes(&self, image: &EncodedImage) -> bool {
        matches!(image.samples(), Samples::U8(_)) && !image.channels().has_alpha()
    }

    /// Decodes an opaque image of 8 bits into a view of [`FixedLight`]. Returns false, and changes nothing, for other
    /// images.
    ///
    /// # Panics
    /// When the view's columns and rows differ from the image's.
    pub fn decode(&self, image: &EncodedImage, into: &mut [[i16; 4]]) -> bool {
        let pitch = FixedLight::pitch(image.width());
        assert_eq!(into.len(), pitch * image.height(), "one texel for each pixel of the file");
        let some = image.rows_at_once();
        let parts = into.par_chunks_mut((some * pitch).max(1)).enumerate();
        parts.map(|(part, into)| self.decode_rows(image, part * some, into)).all(|is_light| is_light)
    }

    /// Decodes rows from `first` on until `into` is full, on the calling thread; see [`Self::decode`].
    ///
    /// # Panics
    /// When `into` does not hold whole rows, or the image has fewer rows.
    pub fn decode_rows(&self, image: &EncodedImage, first: usize, into: &mut [[i16; 4]]) -> bool {
        let Samples::U8(samples) = image.samples() else { return false };
        let pitch = FixedLight::pitch(image.width()).max(1);
        assert!(into.len().is_multiple_of(pitch), "whole rows of light");
        let samples = &samples[image.samples_of_rows(first, into.len() / pitch * image.width())];
        // The padding of a row is left unchanged.
        let into = into.chunks_exact_mut(pitch).map(|row| &mut row[..image.width()]);
        let [red, green, blue] = &self.channels;
        let of = |table: &ByCode, code: u8| table[usize::from(code)];
        match image.channels() {
            Channels::Grey => fill(into, samples, |&[s]| of(&self.grey, s)),
            Channels::Rgb => fill(into, samples, |&[r, g, b]| of(red, r) | of(green, g) | of(blue, b)),
            Channels::GreyAlpha | Channels::Rgba => return false,
        }
        true
    }
}

fn by_code(texel: impl Fn(usize) -> [i16; 4]) -> ByCode {
    std::array::from_fn(|code| bytemuck::cast(texel(code)))
}

fn fill<'a, const N: usize>(
    rows: impl Iterator<Item = &'a mut [[i16; 4]]>,
    samples: &[u8],
    texel: impl Fn(&[u8; N]) -> u64,
) {
    let (mut samples, _) = samples.as_chunks::<N>();
    for row in rows {
        let (of_row, rest) = samples.split_at(row.len());
        samples = rest;
        for (into, sample) in row.iter_mut().zip(of_row) {
            *into = bytemuck::cast(texel(sample));
        }
    }
}

/// Code of each light value. The table has twice as many entries as there are values, so that any 16-bit index is
/// valid.
type Codes = [u8; 1 << 16];

/// Largest error of a rounded weighted sum, in steps of 15-bit light; it must stay within one code.
const ERROR: usize = 4;

/// Returns the difference between the last and the first of some codes.
fn rise(codes: &[u8]) -> i16 {
    i16::from(codes[codes.len() - 1]) - i16::from(codes[0])
}

/// Number of light values, including black and white.
const LIGHT: usize = 1 << 15;

/// Encoder of 15-bit linear light to 8-bit codes.
#[derive(Clone, Debug)]
pub struct FixedCodec {
    /// Codes of all light values: one table for all channels, or one for each.
    codes: Vec<Codes>,
    #[cfg(target_arch = "x86_64")]
    is_srgb: bool,
    background: Rgba,
}

impl FixedCodec {
    /// Creates the encoder; `background` is linear light behind the picture. `None` where codes are closer together
    /// than the error of sums.
    pub fn new(transfer: &Transfer, background: Rgba) -> Option<Self> {
        let quantizer = Quantizer::new(transfer, 255);
        let code = |light: usize, channel| quantizer.code(light as f32 / FixedLight::WHITE, channel) as u8;
        let channels = transfer.channels();
        let mut codes = vec![[0; 1 << 16]; channels.len()];
        for (channel, codes) in channels.iter().zip(&mut codes) {
            codes[..LIGHT].iter_mut().enumerate().for_each(|(light, into)| *into = code(light, *channel));
        }
        let is_fine = |codes: &Codes| codes[..LIGHT].windows(1 + ERROR).all(|some| (0..=1).contains(&rise(some)));
        codes.iter().all(is_fine).then_some(Self {
            codes,
            #[cfg(target_arch = "x86_64")]
            is_srgb: *transfer == Transfer::Srgb,
            background,
        })
    }

    /// Returns the codes of the background.
    pub fn background(&self) -> [u8; 3] {
        self.codes_of(self.background)
    }

    /// Returns the background's light.
    pub(crate) fn background_light(&self) -> Rgba {
        self.background
    }

    /// Returns the codes of all light values.
    #[inline(always)]
    pub(crate) fn codes(&self) -> FixedCodes<'_> {
        let last = self.codes.len() - 1;
        FixedCodes {
            channels: [&self.codes[0], &self.codes[last / 2], &self.codes[last]],
            #[cfg(target_arch = "x86_64")]
            are_srgb: self.is_srgb,
        }
    }

    /// Encodes a picture in front of the background.
    pub fn encode(&self, light: &Image<Rgba>) -> Image<[u8; 3]> {
        let mut codes = Image::filled(light.width(), light.height(), [0; 3]);
        let pixels = codes.pixels_mut().par_iter_mut().zip(light.pixels());
        pixels.for_each(|(codes, light)| *codes = self.codes_of(light.over(self.background)));
        codes
    }

    /// Returns the codes of a light value in floats.
    pub(crate) fn codes_of(&self, light: Rgba) -> [u8; 3] {
        let light = light.0.map(|light| ((light * FixedLight::WHITE).clamp(0.0, FixedLight::WHITE) + 0.5) as i32);
        let [red, green, blue, _] = self.codes().of(light).to_le_bytes();
        [red, green, blue]
    }
}

/// Codes of all light values, by channel.
#[derive(Clone, Copy)]
pub(crate) struct FixedCodes<'a> {
    /// Tables of red, green and blue.
    channels: [&'a Codes; 3],
    /// Whether the codes are those of sRGB, which AVX-512 computes.
    #[cfg(target_arch = "x86_64")]
    are_srgb: bool,
}

impl FixedCodes<'_> {
    /// Returns whether the codes are those of sRGB.
    #[cfg(target_arch = "x86_64")]
    pub(crate) fn are_srgb(self) -> bool {
        self.are_srgb
    }

    /// Returns the codes of a light value, red, green and blue from 0 to 32767, in the bytes of a number from the
    /// lowest on.
    #[inline(always)]
    pub(crate) fn of(self, light: [i32; 4]) -> u32 {
        let [red, green, blue] = self.channels;
        let code = |codes: &Codes, light: i32| u32::from(codes[usize::from(light as u16)]);
        code(red, light[0]) | code(green, light[1]) << 8 | code(blue, light[2]) << 16
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::Depth;

    #[test]
    fn transfer_functions_are_taken_where_15_bits_are_enough() {
        for transfer in [Transfer::Srgb, Transfer::Linear, Transfer::Gamma(1.6)] {
            assert!(FixedDecoder::new(&transfer).is_some(), "{transfer:?}");
            assert!(FixedCodec::new(&transfer, Rgba::BLACK).is_some(), "{transfer:?}");
        }
        // All codes survive a round trip, but an error of two steps of light near black is an error of two codes.
        assert!(FixedDecoder::new(&Transfer::Gamma(1.8)).is_some());
        assert!(FixedCodec::new(&Transfer::Gamma(1.8), Rgba::BLACK).is_none());
        for transfer in [Transfer::Gamma(2.2), Transfer::Bt1886, Transfer::Pq] {
            assert!(FixedDecoder::new(&transfer).is_none(), "{transfer:?}");
            assert!(FixedCodec::new(&transfer, Rgba::BLACK).is_none(), "{transfer:?}");
        }
    }

    fn decode(decoder: &FixedDecoder, image: &EncodedImage, light: &mut FixedLight) -> bool {
        light.views_mut().all(|view| decoder.decode(image, view))
    }

    #[test]
    fn every_code_comes_back() {
        let codes: Vec<u8> = (0..=255).flat_map(|code| [code, 255 - code, code / 2]).collect();
        let image = EncodedImage::new(256, 1, Channels::Rgb, Depth::Eight, Samples::U8(codes.clone())).unwrap();
        let mut light = FixedLight::black([[256, 1]]);
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            let decoder = FixedDecoder::new(&transfer).expect("a decoder");
            assert!(decode(&decoder, &image, &mut light));
            let codec = FixedCodec::new(&transfer, Rgba::BLACK).expect("a codec");
            let back: Vec<u8> = (0..256).flat_map(|texel| codec.codes_of(light.rgba(texel))).collect();
            assert_eq!(back, codes);
        }
    }

    #[test]
    fn grey_is_the_light_of_three_equal_codes() {
        let decoder = FixedDecoder::new(&Transfer::Srgb).expect("a decoder");
        let light = |channels, codes: Vec<u8>| {
            let image = EncodedImage::new(256, 1, channels, Depth::Eight, Samples::U8(codes)).unwrap();
            let mut light = FixedLight::black([[256, 1]]);
            assert!(decode(&decoder, &image, &mut light));
            light.as_laid_out().to_vec()
        };
        let grey = light(Channels::Grey, (0..=255).collect());
        assert_eq!(grey, light(Channels::Rgb, (0..=255).flat_map(|code| [code; 3]).collect()));
    }

    #[test]
    fn rows_of_any_width_become_rows_of_light() {
        let decoder = FixedDecoder::new(&Transfer::Linear).expect("a decoder");
        for (width, height) in [(1, 9), (127, 5), (128, 700), (133, 4), (256, 300)] {
            let codes: Vec<u8> = (0..3 * width * height).map(|sample| (sample % 251) as u8).collect();
            let image = EncodedImage::new(width, height, Channels::Rgb, Depth::Eight, Samples::U8(codes.clone()));
            let mut light = FixedLight::black([[width, height]]);
            assert!(decode(&decoder, &image.expect("an image"), &mut light));
            let codec = FixedCodec::new(&Transfer::Linear, Rgba::BLACK).expect("a codec");
            let back = (0..width * height).flat_map(|texel| codec.codes_of(light.rgba(texel)));
            assert!(back.eq(codes), "{width}x{height}");
        }
    }

    #[test]
    fn pictures_with_alpha_or_of_more_bits_are_not_taken() {
        let decoder = FixedDecoder::new(&Transfer::Srgb).expect("a decoder");
        let mut light = FixedLight::black([[1, 1]]);
        for (channels, depth, samples) in [
            (Channels::Rgba, Depth::Eight, Samples::U8(vec![9; 4])),
            (Channels::GreyAlpha, Depth::Eight, Samples::U8(vec![9; 2])),
            (Channels::Rgb, Depth::Sixteen, Samples::U16(vec![9; 3])),
        ] {
            let image = EncodedImage::new(1, 1, channels, depth, samples).unwrap();
            assert!(!decode(&decoder, &image, &mut light));
            assert_eq!(light.as_laid_out()[0], [0; 4]);
        }
    }
}
