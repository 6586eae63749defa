//! The tone curve of an ICC profile.

use std::sync::Arc;

use cosmorama::raster::{ColourChannel, ToneCurve, Transfer};
use moxcms::{ColorProfile, DataColorSpace, ToneReprCurve};

/// Number of entries of a tabulated curve.
const ENTRIES: usize = 4096;

/// Largest deviation, in code values from 0 to 1, at which a curve counts as a standard one: a quarter of an 8-bit
/// step, because tables in profiles are rounded.
const TOLERANCE: f64 = 0.25 / 255.0;

/// Returns the transfer function of a profile; `None` if it has no tone curves (print profiles) or cannot be read.
pub(crate) fn transfer(profile: &[u8]) -> Option<Transfer> {
    let profile = ColorProfile::new_from_slice(profile).ok()?;
    let curves = match profile.color_space {
        DataColorSpace::Rgb => [profile.red_trc?, profile.green_trc?, profile.blue_trc?],
        DataColorSpace::Gray => {
            let grey = profile.gray_trc?;
            [grey.clone(), grey.clone(), grey]
        }
        _ => return None,
    };
    let [red, green, blue] = [table(&curves[0])?, table(&curves[1])?, table(&curves[2])?];
    let curve = ToneCurve::new([red, green, blue])?;
    Some(standard(&curve).unwrap_or_else(|| Transfer::Curve(Arc::new(curve))))
}

fn table(curve: &ToneReprCurve) -> Option<Vec<f32>> {
    let evaluator = curve.make_linear_evaluator().ok()?;
    let entry = |i| evaluator.evaluate_value(i as f32 / (ENTRIES - 1) as f32);
    Some((0..ENTRIES).map(entry).collect())
}

/// Returns the standard function that a curve matches, if any; exact formulas are better than tables.
fn standard(curve: &ToneCurve) -> Option<Transfer> {
    // Where a pure power would have to be at half code.
    let gamma = curve.decode(0.5, ColourChannel::Green).log(0.5);
    let candidates = [Transfer::Srgb, Transfer::Linear, Transfer::Gamma((gamma * 256.0).round() / 256.0)];
    candidates.into_iter().find(|candidate| {
        (0..=255).map(|i| f64::from(i) / 255.0).all(|code| {
            ColourChannel::ALL.into_iter().all(|channel| {
                let light = curve.decode(code, channel);
                // Compared as code values, where equal steps are equally visible; near black, where a power is
                // steep, as light.
                let error = (candidate.encode(light, channel) - code).abs();
                error < TOLERANCE || (candidate.decode(code, channel) - light).abs() < TOLERANCE / 64.0
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_profiles_are_srgb() {
        let profile = ColorProfile::new_srgb().encode().unwrap();
        assert_eq!(transfer(&profile), Some(Transfer::Srgb));
    }

    #[test]
    fn a_pure_gamma_is_one() {
        let mut profile = ColorProfile::new_srgb();
        let curve = Some(ToneReprCurve::Parametric(vec![1.8]));
        (profile.red_trc, profile.green_trc, profile.blue_trc) = (curve.clone(), curve.clone(), curve);
        profile.cicp = None;
        let Some(Transfer::Gamma(gamma)) = transfer(&profile.encode().unwrap()) else { panic!("a gamma") };
        assert!((gamma - 1.8).abs() < 0.003, "{gamma}");
    }

    #[test]
    fn a_linear_profile_is_linear() {
        let mut profile = ColorProfile::new_srgb();
        let curve = Some(ToneReprCurve::Lut(vec![]));
        (profile.red_trc, profile.green_trc, profile.blue_trc) = (curve.clone(), curve.clone(), curve);
        profile.cicp = None;
        assert_eq!(transfer(&profile.encode().unwrap()), Some(Transfer::Linear));
    }

    #[test]
    fn other_curves_are_tabulated() {
        let mut profile = ColorProfile::new_srgb();
        let lut: Vec<u16> = (0..256_u32).map(|i| (i * i * i / 253 + i / 5).min(65535) as u16).collect();
        let curve = Some(ToneReprCurve::Lut(lut));
        (profile.red_trc, profile.green_trc, profile.blue_trc) = (curve.clone(), curve.clone(), curve);
        profile.cicp = None;
        assert!(matches!(transfer(&profile.encode().unwrap()), Some(Transfer::Curve(_))));
    }

    #[test]
    fn rubbish_is_no_profile() {
        assert_eq!(transfer(&[]), None);
        assert_eq!(transfer(&[7; 500]), None);
    }
}
