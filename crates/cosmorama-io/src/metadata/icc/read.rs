//! ICC profiles that are read: their tone curves and primaries.

use std::sync::Arc;

use cosmorama::raster::{ColourChannel, ColourMatrix, Primaries, ToneCurve, Transfer};
use moxcms::{ColorProfile, DataColorSpace, ToneReprCurve, TransferCharacteristics};

use super::{D50, colorants_of};
use crate::metadata::ProfileFault;

/// Number of entries of a tabulated curve.
const ENTRIES: usize = 4096;

/// Largest deviation, in code values from 0 to 1, at which a curve counts as a standard one: a quarter of an 8-bit
/// step, because tables in profiles are rounded.
const TOLERANCE: f64 = 0.25 / 255.0;

/// Colour of an ICC profile.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Profile {
    pub(crate) transfer: Option<Transfer>,
    /// Primaries; grey has none.
    pub(crate) primaries: Option<Primaries>,
    /// Reason why the profile cannot be applied.
    pub(crate) fault: Option<ProfileFault>,
}

/// Reads a profile that consists of curves, and of primaries unless it is for grey.
pub(crate) fn read(bytes: &[u8]) -> Profile {
    let damaged = |reason: &str| faulty(ProfileFault::Damaged(reason.to_owned()));
    let Ok(profile) = ColorProfile::new_from_slice(bytes) else { return damaged("it breaks the rules of ICC.1") };
    let curves = match (profile.color_space, &profile) {
        (
            DataColorSpace::Rgb,
            ColorProfile { red_trc: Some(red), green_trc: Some(green), blue_trc: Some(blue), .. },
        ) => [red, green, blue],
        (DataColorSpace::Gray, ColorProfile { gray_trc: Some(grey), .. }) => [grey; 3],
        (DataColorSpace::Rgb | DataColorSpace::Gray, profile) if has_tables(profile) => {
            return faulty(ProfileFault::Tables);
        }
        (DataColorSpace::Rgb | DataColorSpace::Gray, _) => return damaged("it lacks tone curves"),
        _ => return damaged("it is neither for RGB nor for grey"),
    };
    let Some(transfer) = coded(&profile).or_else(|| transfer(curves)) else {
        return damaged("its tone curves have no values");
    };
    if profile.color_space == DataColorSpace::Gray {
        return Profile { transfer: Some(transfer), ..Profile::default() };
    }
    match primaries(&profile) {
        None => damaged("its red, green and blue span no triangle"),
        primaries => Profile { transfer: Some(transfer), primaries, fault: None },
    }
}

fn faulty(fault: ProfileFault) -> Profile {
    Profile { fault: Some(fault), ..Profile::default() }
}

fn has_tables(profile: &ColorProfile) -> bool {
    let ColorProfile { lut_a_to_b_perceptual, lut_a_to_b_colorimetric, lut_a_to_b_saturation, .. } = profile;
    [lut_a_to_b_perceptual, lut_a_to_b_colorimetric, lut_a_to_b_saturation].into_iter().any(Option::is_some)
}

/// Returns the transfer function that a profile names by its number, where curves can only approximate it.
fn coded(profile: &ColorProfile) -> Option<Transfer> {
    match profile.cicp?.transfer_characteristics {
        TransferCharacteristics::Smpte2084 => Some(Transfer::Pq),
        TransferCharacteristics::Hlg => Some(Transfer::Hlg),
        _ => None,
    }
}

/// Largest difference of a profile's colorants from those of named primaries. Profiles are rounded, and made with
/// whites of different precision.
const SAME_COLORANTS: f64 = 0.002;

/// Returns the primaries of the colorants, which a profile holds as adapted to D50.
fn primaries(profile: &ColorProfile) -> Option<Primaries> {
    let colorants = profile.colorant_matrix().v;
    let distance = |named: &Primaries| {
        let rows = colorants_of(named).rows();
        let pairs = rows.into_iter().flatten().zip(colorants.into_iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let named = Primaries::NAMED.into_iter().map(|(_, named)| (distance(&named), named));
    let nearest = named.min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, named)) = nearest.filter(|(distance, _)| *distance < SAME_COLORANTS) {
        return Some(named);
    }
    let [red, green, blue] = [0, 1, 2].map(|column| [0, 1, 2].map(|row| colorants[row][column]));
    let given = profile.chromatic_adaptation.map(|matrix| ColourMatrix::from_rows(matrix.v)).filter(adapts_to_d50);
    let to_d50 = match (given, profile.media_white_point) {
        (Some(given), _) => given,
        (None, Some(white)) => ColourMatrix::adaptation(chromaticity([white.x, white.y, white.z])?, D50),
        (None, None) => ColourMatrix::IDENTITY,
    };
    let from_d50 = to_d50.inverse();
    let white = [0, 1, 2].map(|row| red[row] + green[row] + blue[row]);
    let [red, green, blue, white] = [red, green, blue, white].map(|xyz| chromaticity(from_d50.apply(xyz)));
    Primaries::of_pairs(red?, green?, blue?, white?)
}

/// Returns whether a matrix adapts some white to D50. Profiles of moxcms 0.8 hold a matrix of cone responses in its
/// place.
fn adapts_to_d50(matrix: &ColourMatrix) -> bool {
    let d50 = [D50[0] / D50[1], 1.0, (1.0 - D50[0] - D50[1]) / D50[1]];
    let Some(white) = chromaticity(matrix.inverse().apply(d50)) else { return false };
    let usual = ColourMatrix::adaptation(white, D50).rows().into_iter().flatten();
    usual.zip(matrix.rows().into_iter().flatten()).all(|(a, b)| (a - b).abs() < 0.1)
}

fn chromaticity([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    let sum = x + y + z;
    (sum > 0.0).then(|| [x / sum, y / sum])
}

/// Returns the transfer function of the curves of red, green and blue.
fn transfer(curves: [&ToneReprCurve; 3]) -> Option<Transfer> {
    let [red, green, blue] = [table(curves[0])?, table(curves[1])?, table(curves[2])?];
    let curve = ToneCurve::new([red, green, blue])?;
    Some(standard(&curve).unwrap_or_else(|| Transfer::Curve(Arc::new(curve))))
}

fn table(curve: &ToneReprCurve) -> Option<Vec<f32>> {
    let evaluator = curve.make_linear_evaluator().ok()?;
    let entry = |i| evaluator.evaluate_value(i as f32 / (ENTRIES - 1) as f32);
    Some((0..ENTRIES).map(entry).collect())
}

/// Returns the exponent that was meant. Exponents are usually hundredths; in tables of one entry they are stored in
/// 256ths.
fn rounded(gamma: f64) -> f64 {
    let hundredths = (gamma * 100.0).round() / 100.0;
    if (gamma - hundredths).abs() < 1e-4 { hundredths } else { (gamma * 256.0).round() / 256.0 }
}

/// Returns the standard function that a curve matches, if any; exact formulas are better than tables.
fn standard(curve: &ToneCurve) -> Option<Transfer> {
    // The exponent of a pure power that has the curve's value at half code.
    let gamma = curve.decode(0.5, ColourChannel::Green).log(0.5);
    let candidates = [Transfer::Srgb, Transfer::Linear, Transfer::Gamma(rounded(gamma))];
    candidates.into_iter().find(|candidate| {
        (0..=255).map(|i| f64::from(i) / 255.0).all(|code| {
            ColourChannel::ALL.into_iter().all(|channel| {
                let light = curve.decode(code, channel);
                // Compared as code values, in which equal steps are equally visible. Near black, where a power is
                // steep, compared as light.
                let error = (candidate.encode(light, channel) - code).abs();
                error < TOLERANCE || (candidate.decode(code, channel) - light).abs() < TOLERANCE / 64.0
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transfer(profile: &[u8]) -> Option<Transfer> {
        read(profile).transfer
    }

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
        for rubbish in [&[][..], &[7; 500]] {
            let profile = read(rubbish);
            assert!(matches!(profile.fault, Some(ProfileFault::Damaged(_))) && profile.transfer.is_none());
        }
    }

    #[test]
    fn profiles_of_others_have_primaries_with_names() {
        for (profile, name) in [
            (ColorProfile::new_srgb(), "Rec. 709"),
            (ColorProfile::new_display_p3(), "P3-D65"),
            (ColorProfile::new_adobe_rgb(), "Adobe RGB"),
            (ColorProfile::new_bt2020(), "Rec. 2020"),
        ] {
            let found = read(&profile.encode().unwrap()).primaries;
            assert_eq!(found.and_then(|found| found.name()), Some(name));
        }
        let photo = read(&ColorProfile::new_pro_photo_rgb().encode().unwrap()).primaries.unwrap();
        assert!((photo.red[0] - 0.7347).abs() < 2e-3 && (photo.blue[0] - 0.0366).abs() < 2e-3, "{photo}");
    }

    #[test]
    fn a_profile_without_colorants_is_damaged() {
        let mut profile = ColorProfile::new_srgb();
        profile.green_colorant = profile.red_colorant;
        assert!(matches!(read(&profile.encode().unwrap()).fault, Some(ProfileFault::Damaged(_))));
        (profile.red_trc, profile.green_trc, profile.blue_trc) = (None, None, None);
        assert!(matches!(read(&profile.encode().unwrap()).fault, Some(ProfileFault::Damaged(_))));
    }
}
