use std::ops::Range;

use cosmorama::raster::{ColourChannel, ColourMatrix, Primaries, Transfer};
use moxcms::{
    CicpColorPrimaries, CicpProfile, ColorProfile, DataColorSpace, LocalizableString, Matrix3d, MatrixCoefficients,
    ProfileClass, ProfileText, RenderingIntent, ToneReprCurve, TransferCharacteristics, Xyzd,
};

use super::{D50, colorants_of};
use crate::metadata::colour_name;

/// Number of entries of curves that no formula of ICC.1 can express.
const ENTRIES: u16 = 4096;

/// Returns a profile that defines the light of an RGB file's code values.
pub(crate) fn made(transfer: &Transfer, primaries: &Primaries) -> Option<Vec<u8>> {
    let curve = |channel| Some(curve(transfer, channel));
    let [red, green, blue] = [0, 1, 2].map(|column| {
        let rows = colorants_of(primaries).rows();
        Xyzd { x: rows[0][column], y: rows[1][column], z: rows[2][column] }
    });
    let to_d50 = ColourMatrix::adaptation(primaries.white, D50);
    let mut profile = described(&colour_name(Some(primaries), Some(transfer))?);
    profile.color_space = DataColorSpace::Rgb;
    (profile.red_colorant, profile.green_colorant, profile.blue_colorant) = (red, green, blue);
    profile.chromatic_adaptation = Some(Matrix3d { v: to_d50.rows() });
    profile.red_trc = curve(ColourChannel::Red);
    profile.green_trc = curve(ColourChannel::Green);
    profile.blue_trc = curve(ColourChannel::Blue);
    profile.cicp = code_points(transfer, primaries);
    encoded(&profile)
}

/// Returns a profile for a grey file. `None` for transfer functions that a curve does not describe completely, since
/// grey has no code points.
pub(crate) fn made_grey(transfer: &Transfer) -> Option<Vec<u8>> {
    if code_points(transfer, &Primaries::REC709).is_some() {
        return None;
    }
    let mut profile = described("grey");
    profile.color_space = DataColorSpace::Gray;
    profile.gray_trc = Some(curve(transfer, ColourChannel::Green));
    encoded(&profile)
}

/// Place of a profile's date and time in its header (ICC.1:2022, 7.2.1).
const DATE: Range<usize> = 24..36;

/// The first second of the year 2000, for all profiles: the same picture always gives the same file. moxcms writes the time of now.
const MADE: [u8; 12] = [0x07, 0xD0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0];

fn encoded(profile: &ColorProfile) -> Option<Vec<u8>> {
    let mut bytes = profile.encode().ok()?;
    bytes.get_mut(DATE)?.copy_from_slice(&MADE);
    Some(bytes)
}

/// Returns the parts that all profiles share.
fn described(name: &str) -> ColorProfile {
    let d50 = Xyzd { x: 0.9642, y: 1.0, z: 0.8249 };
    let mut profile = ColorProfile::default();
    profile.pcs = DataColorSpace::Xyz;
    profile.profile_class = ProfileClass::DisplayDevice;
    profile.rendering_intent = RenderingIntent::RelativeColorimetric;
    profile.white_point = d50;
    // The version of ICC that is written requires D50 here, too; a display's own white follows from `chad`.
    profile.media_white_point = Some(d50);
    profile.description = Some(text(name));
    profile.copyright = Some(text("No copyright, use freely"));
    profile
}

/// Returns a text of an even number of letters, of two bytes each: the encoder puts tags one behind the other, and ICC.1 wants
/// them, and the whole, to be multiples of four bytes. libpng leaves out profiles that are not.
fn text(text: &str) -> ProfileText {
    let even = if text.encode_utf16().count().is_multiple_of(2) { text.to_owned() } else { format!("{text} ") };
    ProfileText::Localizable(vec![LocalizableString::new("en".to_owned(), "US".to_owned(), even)])
}

fn curve(transfer: &Transfer, channel: ColourChannel) -> ToneReprCurve {
    match transfer {
        // Function type 3 of ICC.1:2022, 10.18.
        Transfer::Srgb => ToneReprCurve::Parametric(vec![2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045]),
        // An empty table would do, but OpenColorIO refuses it.
        Transfer::Linear => ToneReprCurve::Parametric(vec![1.0]),
        Transfer::Gamma(gamma) => ToneReprCurve::Parametric(vec![*gamma as f32]),
        Transfer::Bt1886 => ToneReprCurve::Parametric(vec![2.4]),
        Transfer::Pq | Transfer::Hlg | Transfer::Curve(_) => {
            let last = f64::from(ENTRIES - 1);
            // A profile's light ends at 1.
            let peak = transfer.decode(1.0, channel);
            let entry = |i: u16| (transfer.decode(f64::from(i) / last, channel) / peak * 65535.0).round() as u16;
            ToneReprCurve::Lut((0..ENTRIES).map(entry).collect())
        }
    }
}

/// Returns the code points of transfer functions that a curve does not describe completely.
fn code_points(transfer: &Transfer, primaries: &Primaries) -> Option<CicpProfile> {
    let transfer_characteristics = match transfer {
        Transfer::Pq => TransferCharacteristics::Smpte2084,
        Transfer::Hlg => TransferCharacteristics::Hlg,
        _ => return None,
    };
    let number = primaries.number().and_then(|number| CicpColorPrimaries::try_from(number).ok());
    Some(CicpProfile {
        color_primaries: number.unwrap_or(CicpColorPrimaries::Unspecified),
        transfer_characteristics,
        matrix_coefficients: MatrixCoefficients::Identity,
        full_range: true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::icc::read;

    #[test]
    fn what_is_made_says_what_it_was_made_for() {
        let own = Primaries::of_pairs([0.6, 0.3], [0.3, 0.6], [0.1, 0.1], [0.32, 0.33]).unwrap();
        let named = Primaries::NAMED.into_iter().map(|(_, primaries)| primaries);
        for primaries in named.chain([own]) {
            for transfer in [
                Transfer::Srgb,
                Transfer::Linear,
                Transfer::Gamma(1.8),
                Transfer::Gamma(2.4),
                Transfer::Pq,
                Transfer::Hlg,
            ] {
                let profile = read(&made(&transfer, &primaries).unwrap());
                assert_eq!((profile.transfer, profile.fault), (Some(transfer), None), "{primaries}");
                assert!(profile.primaries.unwrap().is_same(&primaries), "{primaries}: {:?}", profile.primaries);
            }
        }
        assert_eq!(made(&Transfer::Srgb, &own).unwrap()[DATE], MADE);
        assert_eq!(made_grey(&Transfer::Gamma(1.8)).unwrap()[DATE], MADE);
    }

    // libpng reads no others.
    #[test]
    fn profiles_and_their_tags_are_multiples_of_four_bytes() {
        let names = Primaries::NAMED.into_iter().map(|(_, primaries)| primaries);
        let colours = names.flat_map(|primaries| {
            [Transfer::Srgb, Transfer::Linear, Transfer::Gamma(2.2), Transfer::Pq]
                .map(|transfer| made(&transfer, &primaries))
        });
        for profile in colours.chain([made_grey(&Transfer::Gamma(1.8))]).map(Option::unwrap) {
            let number = |at: usize| u32::from_be_bytes(profile[at..at + 4].try_into().unwrap());
            assert_eq!((number(0), profile.len() % 4), (profile.len() as u32, 0));
            for tag in 0..number(128) as usize {
                assert_eq!(number(132 + 12 * tag + 4) % 4, 0, "the place of tag {tag}");
            }
        }
    }
}
