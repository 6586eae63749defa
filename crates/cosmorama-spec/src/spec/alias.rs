//! Names that other programs have for the same projections and keys: ffmpeg's v360 and envutil.

use super::projections::Kind;
use crate::error::key_for;

/// Another program's name, and the SPEC that it stands for here.
pub(super) const ALIASES: [(&str, &str); 33] = [
    ("e", "equirect"),
    ("equirectangular", "equirect"),
    ("latlong", "equirect"),
    ("latlon", "equirect"),
    ("panorama", "equirect"),
    ("spherical", "equirect"),
    ("he", "equirect:hfov=180"),
    ("hequirect", "equirect:hfov=180"),
    ("flat", "perspective"),
    ("gnomonic", "perspective"),
    ("rectilinear", "perspective"),
    ("sg", "stereographic"),
    ("og", "fisheye:lens=orthographic"),
    ("orthographic", "fisheye:lens=orthographic"),
    ("equisolid", "fisheye:lens=equisolid"),
    ("equidistant", "fisheye"),
    // ffmpeg's ball has the front in its middle, and is not mirrored.
    ("ball", "fisheye:lens=equisolid,fov=360"),
    ("c3x2", "cube:layout=3x2"),
    ("c6x1", "cube:layout=strip-h"),
    ("c1x6", "cube:layout=strip-v"),
    ("eac", "cube:layout=eac"),
    // Its left half looks back.
    ("dfisheye", "dual-fisheye:order=bf,fov=180"),
    ("cylindrical", "cylinder"),
    ("cylindricalea", "equal-area"),
    ("octahedron", "octahedral:kind=plain"),
    ("sinus", "sinusoidal"),
    ("moll", "mollweide"),
    ("cubemap", "cube"),
    ("domemaster", "fulldome"),
    ("little-planet", "stereographic:pitch=-90"),
    ("littleplanet", "stereographic:pitch=-90"),
    ("tiny-planet", "stereographic:pitch=-90"),
    ("tinyplanet", "stereographic:pitch=-90"),
];

/// Projections of ffmpeg's v360 that are not on offer.
const REFUSED: [&str; 5] = ["barrel", "fb", "barrelsplit", "tsp", "tetrahedron"];
/// Projection of envutil that is not on offer: a cube of equal angles.
const REFUSED_OF_ENVUTIL: &str = "biatan6";

/// The SPEC with its name as we have it. Keys that were typed follow those that the name stands for, in whose place they
/// come.
pub(super) fn without_alias(text: &str) -> String {
    let (name, typed) = text.split_once(':').unwrap_or((text, ""));
    let Some((_, meaning)) = ALIASES.iter().find(|(alias, _)| *alias == name) else { return text.to_owned() };
    let (ours, own) = meaning.split_once(':').unwrap_or((meaning, ""));
    let key = |part: &str| part.split('=').next().unwrap_or_default().trim().to_owned();
    let is_typed = |own: &&str| typed.split(',').any(|part| key(part) == key(own));
    let kept = own.split(',').filter(|own| !is_typed(own));
    let keys: Vec<&str> = kept.chain([typed]).filter(|part| !part.is_empty()).collect();
    if keys.is_empty() { ours.to_owned() } else { format!("{ours}:{}", keys.join(",")) }
}

/// How to go by way of equirect, where another program has a projection of this name that we do not.
pub(super) fn refusal(name: &str) -> Option<String> {
    match name {
        REFUSED_OF_ENVUTIL => Some(
            "as by envutil's --projection spherical; cubes of equal angles are cube:layout=eac here, laid out otherwise"
                .to_owned(),
        ),
        _ => REFUSED.contains(&name).then(|| format!("as by ffmpeg's v360=input={name}:output=e")),
    }
}

/// Keys of a projection that are written as ffmpeg's filters have them, with colons between, as they are written here;
/// `None` where they are not.
///
/// What the projection does not take, such as a vertical field of view beside that of a fisheye, is left out.
pub(super) fn without_colons(kind: &'static Kind, keys: &str) -> Option<String> {
    let has_file = |key: &str| matches!(key.trim(), "base" | "file" | "calibration");
    let is_colons = |part: &str| {
        let (key, value) = part.split_once('=').unwrap_or((part, ""));
        !has_file(key) && value.split(':').skip(1).any(|later| later.contains('='))
    };
    if !keys.split(',').any(is_colons) {
        return None;
    }
    let known: Vec<&str> = kind.all_keys().map(|key| key.name).collect();
    let mut pairs: Vec<String> = Vec::new();
    for part in keys.split([',', ':']) {
        match (part.split_once('='), pairs.last_mut()) {
            (Some((key, value)), _) => pairs.extend(key_for(key.trim(), &known).map(|key| format!("{key}={value}"))),
            (None, Some(last)) => *last = format!("{last}:{part}"),
            (None, None) => {}
        }
    }
    Some(if pairs.is_empty() { kind.name.to_owned() } else { format!("{}:{}", kind.name, pairs.join(",")) })
}
