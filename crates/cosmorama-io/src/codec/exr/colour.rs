//! Attributes about colour.

use cosmorama::raster::Primaries;
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::meta::header::Header as Part;

use crate::Metadata;

/// Name of the attribute of OpenEXR 3.4 that names a colour space.
const INTEROP_ID: &str = "colorInteropID";

/// Names of linear spaces by the Color Interop Forum, "Color Space Encodings for Texture Assets and CG Rendering".
const INTEROP_IDS: [(&str, Primaries); 6] = [
    ("lin_rec709_scene", Primaries::REC709),
    ("lin_p3d65_scene", Primaries::P3_D65),
    ("lin_rec2020_scene", Primaries::REC2020),
    ("lin_adobergb_scene", Primaries::ADOBE_RGB),
    ("lin_ap1_scene", Primaries::AP1),
    ("lin_ap0_scene", Primaries::AP0),
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
    let named = id.as_ref().map(|id| INTEROP_IDS.iter().find(|(known, _)| known == id).map(|(_, named)| *named));
    match (id, named, primaries) {
        (Some(id), Some(Some(named)), Some(primaries)) if !named.is_same(&primaries) => {
            metadata.complaints.push(format!(
                "its chromaticities say {primaries} and its {INTEROP_ID} {id}; chromaticities come first"
            ));
        }
        (Some(id), Some(None), _) => metadata.notes.push(format!("its {INTEROP_ID}, {id}, is not known here")),
        _ => {}
    }
    metadata.primaries = primaries.or(named.flatten());
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
    let primaries = metadata.primaries?;
    let (id, _) = INTEROP_IDS.iter().find(|(_, known)| known.is_same(&primaries))?;
    Some((Text::from(INTEROP_ID), AttributeValue::Text(Text::from(*id))))
}
