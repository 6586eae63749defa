use super::*;
use crate::render::apply::tap_lists::Palette;

/// Returns the light of a texel as each level's instructions use it.
fn lights(palette: &impl Palette, texel: u32) -> impl Iterator<Item = [f32; 4]> {
    crate::filter::rim::simd_levels::levels()
        .into_iter()
        .map(move |level| dispatch!(level, simd => of(simd, palette, texel)))
}

#[inline(always)]
fn of<S: Simd>(simd: S, palette: &impl Palette, texel: u32) -> [f32; 4] {
    palette.light(simd, texel).into()
}

#[test]
fn texels_have_one_light_whoever_asks() {
    const WHITE: i16 = i16::MAX;
    let size = [1 << 8, 1 << 7];
    let mut light = FixedLight::black([size]);
    // All possible samples, in each channel.
    for (sample, texel) in (0..=WHITE).zip(light.texels_mut()) {
        *texel = [sample, WHITE - sample, sample ^ 0x55, 0];
    }
    let texels = floats(&light);
    let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
    let fixed = FixedArithmetic { light: &light, codec: &codec };
    let float = FloatArithmetic { texels: &texels, background: Rgba::TRANSPARENT, pixels: Uncoded };
    let pitch = FixedLight::pitch(size[0]);
    for (at, expected) in texels.iter().enumerate() {
        assert!(lights(&float, at as u32).all(|light| light == expected.0), "{expected:?}");
        let laid_out = (at / size[0] * pitch + at % size[0]) as u32;
        assert!(lights(&fixed, laid_out).all(|light| light == expected.0), "{expected:?}");
    }
}
