/// The code value, 0 to 1, of linear light in the sRGB encoding (IEC 61966-2-1); light beyond 0–1 is clipped, as in
/// an integer file.
pub(super) fn srgb_code(light: f64) -> f64 {
    let light = light.clamp(0.0, 1.0);
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_codes() {
        assert_eq!(srgb_code(-1.0), 0.0);
        assert!((srgb_code(2.0) - 1.0).abs() < 1e-12);
        assert!((srgb_code(0.214_041_14) - 0.5).abs() < 1e-7);
        assert!((srgb_code(0.001) - 0.012_92).abs() < 1e-12);
    }
}
