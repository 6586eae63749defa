//! Names that other programs have for the same projections: ffmpeg's v360 and envutil.

/// Another program's name, and the SPEC that it stands for here.
const ALIASES: [(&str, &str); 21] = [
    ("e", "equirect"),
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
    ("cylindrical", "cylinder"),
    ("cylindricalea", "equal-area"),
    ("octahedron", "octahedral:kind=plain"),
    ("sinus", "sinusoidal"),
    ("moll", "mollweide"),
    ("cubemap", "cube"),
    ("domemaster", "fulldome"),
    ("little-planet", "stereographic:pitch=-90"),
];

/// Projections of other programs that are not on offer.
const REFUSED: [&str; 6] = ["barrel", "fb", "barrelsplit", "tsp", "tetrahedron", "biatan6"];

/// The SPEC with its name as we have it; keys that were typed follow those that the name stands for.
pub(super) fn without_alias(text: &str) -> String {
    let (name, keys) = text.split_once(':').unwrap_or((text, ""));
    let Some((_, meaning)) = ALIASES.iter().find(|(alias, _)| *alias == name) else { return text.to_owned() };
    let between = match (keys.is_empty(), meaning.contains(':')) {
        (true, _) => "",
        (false, true) => ",",
        (false, false) => ":",
    };
    format!("{meaning}{between}{keys}")
}

/// Whether another program has a projection of this name that we do not.
pub(super) fn is_refused(name: &str) -> bool {
    REFUSED.contains(&name)
}
