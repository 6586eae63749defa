use super::*;

/// Samples of single pixels are added up and then divided; here each is divided before.
#[test]
fn sums_of_samples_are_those_of_light_but_where_codes_are_rounded() {
    let codec = FixedCodec::new(&Transfer::Srgb, Rgba::opaque(0.25, 0.5, 0.0)).expect("sRGB has 8 bits");
    let level = Level::new();
    let (mut equal, mut count) = (0, 0);
    for (world, target, _) in conversions() {
        let (light, resampler) = (light(&world), resampler(&world, &target));
        let mirrors = Mirrors::of(&resampler);
        for anti_ringing in [true, false] {
            let filter = FixedFilter { level, mirrors: &mirrors, light: &light, codec: &codec, anti_ringing };
            let mut pixels = vec![None; target.width() * target.height()];
            let make = |band: &Band<NoWindows>, canvas: &mut Canvas<Option<[[u8; 3]; 2]>>| {
                // Others are made of light as it is.
                for single in band.singles.iter().filter(|single| band.taps(single).places.is_empty()) {
                    let each = average(band.taps(single), |texel| light.rgba(texel as usize), anti_ringing);
                    let codes = [filter.single(band.taps(single)), each]
                        .map(|colour| codec.codes_of((colour * single.coverage).over(codec.background_light())));
                    let image = &mirrors.images[usize::from(single.image)];
                    *canvas.pixel(image, [single.column as usize, usize::from(single.row)]) = Some(codes);
                }
            };
            each_band((&resampler, None), &mirrors, (&mut pixels, None), level, make);
            for [made, expected] in pixels.into_iter().flatten() {
                let is_close = made.iter().zip(&expected).all(|(a, b)| a.abs_diff(*b) <= 1);
                assert!(is_close, "{made:?} is not {expected:?} in {:?}", target.projection);
                equal += usize::from(made == expected);
                count += 1;
            }
        }
    }
    assert!(count > 100_000 && equal * 1000 >= count * 999, "{equal} of {count} are equal");
}
