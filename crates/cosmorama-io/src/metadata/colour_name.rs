use cosmorama::raster::{Primaries, Transfer};

/// Colour spaces with a name of their own.
const NAMED: [(&str, Primaries, Transfer); 6] = [
    ("sRGB", Primaries::REC709, Transfer::Srgb),
    ("Display P3", Primaries::P3_D65, Transfer::Srgb),
    ("ACES2065-1", Primaries::AP0, Transfer::Linear),
    ("ACEScg", Primaries::AP1, Transfer::Linear),
    ("DCI-P3", Primaries::P3_DCI, Transfer::Gamma(2.6)),
    ("linear sRGB", Primaries::REC709, Transfer::Linear),
];

/// Gamma of Adobe RGB (1998), 4.3.4.2.
pub(crate) const ADOBE_GAMMA: f64 = 563.0 / 256.0;

/// Returns the name of a colour space as people say it, such as "Rec. 2020, PQ". `None` where a part is not known.
pub(crate) fn colour_name(primaries: Option<&Primaries>, transfer: Option<&Transfer>) -> Option<String> {
    let (primaries, transfer) = (primaries?, transfer?);
    let named = NAMED.iter().find(|(_, known, curve)| known.is_same(primaries) && curve == transfer);
    if let Some((name, ..)) = named {
        return Some((*name).to_owned());
    }
    let curve = match transfer {
        Transfer::Srgb => "sRGB's curve".to_owned(),
        Transfer::Linear => "linear".to_owned(),
        Transfer::Gamma(gamma) if primaries.is_same(&Primaries::ADOBE_RGB) && (gamma - ADOBE_GAMMA).abs() < 2e-3 => {
            return Some("Adobe RGB (1998)".to_owned());
        }
        Transfer::Gamma(gamma) => format!("gamma {}", (gamma * 1e3).round() / 1e3),
        Transfer::Bt1886 => "BT.1886".to_owned(),
        Transfer::Pq => "PQ".to_owned(),
        Transfer::Hlg => "HLG".to_owned(),
        Transfer::Curve(_) => "curves of its profile".to_owned(),
    };
    Some(format!("{primaries}, {curve}"))
}
