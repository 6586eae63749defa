use cosmorama::raster::{Primaries, Transfer};

/// Names of display spaces in ACES' configs that do not tell curve and primaries in the usual order.
const OTHERS: [(&str, &str); 6] = [
    ("srgb_display", "srgb_rec709"),
    ("srgb_texture", "srgb_rec709"),
    ("srgb_tx", "srgb_rec709"),
    ("displayp3_display", "srgb_p3d65"),
    ("rec1886_rec709_display", "g24_rec709"),
    ("rec2100_pq_display", "pq_rec2020"),
];

/// Returns the primaries and the transfer function of a space by its name in the Color Interop Forum's list, "Color Space
/// Encodings for Texture Assets and CG Rendering", as `lin_ap1_scene` or `g22_rec709`, which are aliases in ACES' configs, too.
pub(super) fn of(name: &str) -> Option<(Primaries, Transfer)> {
    let name = OTHERS.iter().find(|(other, _)| *other == name).map_or(name, |(_, usual)| usual);
    let name = name.strip_suffix("_scene").or_else(|| name.strip_suffix("_display")).unwrap_or(name);
    let (curve, primaries) = name.split_once('_')?;
    let transfer = match curve {
        "lin" => Transfer::Linear,
        "srgb" => Transfer::Srgb,
        "g18" => Transfer::Gamma(1.8),
        "g22" => Transfer::Gamma(2.2),
        "g24" => Transfer::Bt1886,
        "g26" => Transfer::Gamma(2.6),
        "pq" => Transfer::Pq,
        "hlg" => Transfer::Hlg,
        _ => return None,
    };
    let primaries = match primaries {
        "rec709" => Primaries::REC709,
        "p3d65" => Primaries::P3_D65,
        "rec2020" => Primaries::REC2020,
        "adobergb" => Primaries::ADOBE_RGB,
        "ap0" => Primaries::AP0,
        "ap1" => Primaries::AP1,
        _ => return None,
    };
    Some((primaries, transfer))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_spaces_are_known_by_name() {
        assert_eq!(of("lin_ap1_scene"), Some((Primaries::AP1, Transfer::Linear)));
        assert_eq!(of("lin_ap1"), of("lin_ap1_scene"));
        assert_eq!(of("srgb_display"), Some((Primaries::REC709, Transfer::Srgb)));
        assert_eq!(of("rec2100_pq_display"), Some((Primaries::REC2020, Transfer::Pq)));
        assert_eq!(of("g22_adobergb_scene"), Some((Primaries::ADOBE_RGB, Transfer::Gamma(2.2))));
    }

    #[test]
    fn others_are_not_guessed() {
        for name in ["ACEScct", "acescct_ap1", "lin_ciexyzd65_scene", "st2084_p3d65_display", "lin", "", "data"] {
            assert_eq!(of(name), None, "{name}");
        }
    }
}
