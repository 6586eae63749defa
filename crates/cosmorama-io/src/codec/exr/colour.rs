//! Attributes about colour.

use cosmorama::raster::{Primaries, Transfer};
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::meta::header::Header as Part;

use crate::Metadata;

/// Name of the attribute of OpenEXR 3.4 that names a colour space.
const INTEROP_ID: &str = "colorInteropID";

/// Names of spaces by the Color Interop Forum, "Color Space Encodings for Texture Assets and CG Rendering".
const INTEROP_IDS: [(&str, Primaries, Transfer); 13] = [
    ("lin_rec709_scene", Primaries::REC709, Transfer::Linear),
    ("lin_p3d65_scene", Primaries::P3_D65, Transfer::Linear),
    ("lin_rec2020_scene", Primaries::REC2020, Transfer::Linear),
    ("lin_adobergb_scene", Primaries::ADOBE_RGB, Transfer::Linear),
    ("lin_ap1_scene", Primaries::AP1, Transfer::Linear),
    ("lin_ap0_scene", Primaries::AP0, Transfer::Linear),
    ("srgb_rec709_scene", Primaries::REC709, Transfer::Srgb),
    ("srgb_p3d65_scene", Primaries::P3_D65, Transfer::Srgb),
    ("srgb_ap1_scene", Primaries::AP1, Transfer::Srgb),
    ("g22_rec709_scene", Primaries::REC709, Transfer::Gamma(2.2)),
    ("g22_adobergb_scene", Primaries::ADOBE_RGB, Transfer::Gamma(2.2)),
    ("g22_ap1_scene", Primaries::AP1, Transfer::Gamma(2.2)),
    ("g18_rec709_scene", Primaries::REC709, Transfer::Gamma(1.8)),
];

/// Adds what a part says of its colours. `chromaticities` takes precedence over `colorInteropID`, since it holds
/// numbers.
pub(super) fn read(part: &Part, mut metadata: Metadata) -> Metadata {
    let own = &part.own_attributes;
    metadata.white_luminance = own.white_luminance.filter(|white| white.is_finite() && *white > 0.0);
    if let (Some(given), None) = (own.white_luminance, metadata.white_luminance) {
        metadata.complaints.push(format!("its whiteLuminance is ignored: expected cd/m² above 0, found {given}"));
    }
    let said = part.shared_attributes.chromaticities;
    let pairs = said.map(|pairs| [pairs.red, pairs.green, pairs.blue, pairs.white].map(pair));
    let primaries = pairs.and_then(|[red, green, blue, white]| Primaries::of_pairs(red, green, blue, white));
    if said.is_some() && primaries.is_none() {
        let complaint = "its chromaticities are ignored: red, green and blue span no triangle around white";
        metadata.complaints.push(complaint.to_owned());
    }
    let id = own.other.get(&Text::from(INTEROP_ID)).and_then(|value| match value {
        AttributeValue::Text(text) => Some(text.to_string()),
        _ => None,
    });
    metadata.primaries = primaries;
    let Some(id) = id else { return metadata };
    match (INTEROP_IDS.into_iter().find(|(known, ..)| *known == id), primaries) {
        (Some((_, named, transfer)), said) => {
            if let Some(primaries) = said.filter(|said| !named.is_same(said)) {
                metadata.complaints.push(format!(
                    "its chromaticities say {primaries} and its {INTEROP_ID} {id}; chromaticities come first"
                ));
            }
            metadata.primaries = said.or(Some(named));
            metadata.transfer = Some(transfer);
        }
        (None, said) => metadata.complaints.push(format!(
            "its {INTEROP_ID}, {id}, is not known here, and is left out: its values are taken for linear {}",
            said.unwrap_or(Primaries::REC709)
        )),
    }
    metadata
}

fn pair(Vec2(x, y): Vec2<f32>) -> [f64; 2] {
    [x.into(), y.into()]
}

/// Returns the attribute of four pairs.
pub(super) fn chromaticities(primaries: &Primaries) -> Chromaticities {
    let [red, green, blue, white] = primaries.pairs().map(|[x, y]| Vec2(x as f32, y as f32));
    Chromaticities { red, green, blue, white }
}

/// Returns the attribute that names the colour space, if it has such a name.
pub(super) fn interop_id(metadata: &Metadata) -> Option<(Text, AttributeValue)> {
    let primaries = metadata.primaries.unwrap_or(Primaries::REC709);
    let transfer = metadata.transfer.as_ref().unwrap_or(&Transfer::Linear);
    // Linear Rec. 709 needs no name.
    if metadata.primaries.is_none() && *transfer == Transfer::Linear {
        return None;
    }
    let is_this = |(_, known, curve): &(&str, Primaries, Transfer)| known.is_same(&primaries) && curve == transfer;
    let (id, ..) = INTEROP_IDS.into_iter().find(is_this)?;
    Some((Text::from(INTEROP_ID), AttributeValue::Text(Text::from(id))))
}
