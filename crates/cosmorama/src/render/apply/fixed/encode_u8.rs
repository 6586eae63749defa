//! Encoding of windows' light as codes of 8 bits. Light has 15 bits of red, green and blue, and an unused fourth
//! number.

#[cfg(target_arch = "x86_64")]
use fearless_simd::{Avx512, i32x4, prelude::*};

use crate::raster::FixedCodes;
use crate::render::apply::tile_writer::Develop;
#[cfg(target_arch = "x86_64")]
use crate::render::apply::x86::srgb;
use crate::render::scan::tile::SIDE;

/// Encoder that looks codes up in a table.
#[derive(Clone, Copy)]
pub(crate) struct LookUp<'a>(pub(crate) FixedCodes<'a>);

impl Develop for LookUp<'_> {
    type Light = [i32; 4];
    type Pixel = [u8; 3];

    #[inline(always)]
    fn one(&self, light: [i32; 4]) -> [u8; 3] {
        let [red, green, blue, _] = self.0.of(light).to_le_bytes();
        [red, green, blue]
    }

    #[inline(always)]
    fn eight(&self, light: [&[i32; 4]; SIDE]) -> [[u8; 3]; SIDE] {
        let mut codes = [0; SIDE];
        for (codes, light) in codes.iter_mut().zip(light) {
            *codes = self.0.of(*light);
        }
        unpacked(codes)
    }
}

/// Returns pixels whose codes are packed, from the low byte on. Eight bytes at once are written faster than one by one.
#[inline(always)]
pub(crate) fn unpacked(codes: [u32; SIDE]) -> [[u8; 3]; SIDE] {
    let two = |at: usize| u64::from(codes[at]) | u64::from(codes[at + 1]) << 24;
    let (a, b, c, d) = (two(0), two(2), two(4), two(6));
    bytemuck::cast([(a | b << 48).to_le(), (b >> 16 | c << 32).to_le(), (c >> 32 | d << 16).to_le()])
}

/// Encoder that computes the codes of sRGB, which is faster. A table look-up spends most of its time moving samples out
/// of vectors and codes together.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct Compute<'a> {
    pub(crate) level: Avx512,
    /// Table of codes, for pixels that come singly.
    pub(crate) codes: LookUp<'a>,
}

#[cfg(target_arch = "x86_64")]
impl Develop for Compute<'_> {
    type Light = [i32; 4];
    type Pixel = [u8; 3];

    #[inline(always)]
    fn one(&self, light: [i32; 4]) -> [u8; 3] {
        self.codes.one(light)
    }

    #[inline(always)]
    fn eight(&self, light: [&[i32; 4]; SIDE]) -> [[u8; 3]; SIDE] {
        let mut pixels = [i32x4::splat(self.level, 0); SIDE];
        for (pixel, light) in pixels.iter_mut().zip(light) {
            *pixel = i32x4::load_array_ref(self.level, light);
        }
        let [a, b, c, d, e, f, g, h] = pixels;
        let (first, last) = (a.combine(b).combine(c.combine(d)), e.combine(f).combine(g.combine(h)));
        srgb::eight_codes(self.level, first.into(), last.into())
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;

    use super::*;
    use crate::raster::{FixedCodec, Rgba, Transfer};

    /// Returns pixels whose channels are this light or its difference from white.
    fn pixels(light: i32) -> [[i32; 4]; SIDE] {
        std::array::from_fn(|at| {
            let (light, other) = if at % 2 == 0 { (light, 0x7fff - light) } else { (0x7fff - light, light) };
            [light, other, light, -1 - light]
        })
    }

    fn assert_codes(codec: &FixedCodec, develop: &impl Develop<Light = [i32; 4], Pixel = [u8; 3]>) {
        for light in (0..1 << 15).map(pixels) {
            let expected = light.map(|light| codec.codes_of(Rgba(light.map(|light| light as f32 / 32767.0))));
            assert_eq!(develop.eight(light.each_ref()), expected, "{light:?}");
            assert_eq!(light.map(|light| develop.one(light)), expected, "{light:?}");
        }
    }

    #[test]
    fn codes_are_those_of_all_light() {
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            let codec = FixedCodec::new(&transfer, Rgba::BLACK).expect("a codec");
            assert_codes(&codec, &LookUp(codec.codes()));
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn computed_codes_of_srgb_are_those_of_all_light() {
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("a codec");
        // Where there is no AVX-512, there is nothing to check.
        if let Some(level) = Level::new().as_avx512() {
            assert_codes(&codec, &Compute { level, codes: LookUp(codec.codes()) });
        }
    }
}
