//! Other programs' names for projections and keys: those of ffmpeg's v360 and of envutil, and of cameras' videos.

use super::projections::Kind;
use crate::error::key_for;

/// Other programs' names, each with the SPEC that it stands for.
pub(super) const ALIASES: [(&str, &str); 37] = [
    ("e", "equirect"),
    ("equirectangular", "equirect"),
    ("latlong", "equirect"),
    ("latlon", "equirect"),
    ("panorama", "equirect"),
    ("spherical", "equirect"),
    ("he", "equirect:hfov=180"),
    ("hequirect", "equirect:hfov=180"),
    // The front half for each eye, as cameras with two eyes and players have it.
    ("vr180", "equirect:hfov=180,stereo=sbs"),
    // Two rows of three faces of equal angles. Of the outer ones, each half is by another lens, and 64 columns of a row are there
    // twice: outer faces of 1376 columns beside an inner one of 1344. David Greenwood, "Reverse Engineering GoPro's 360 Video File
    // Format", part 3, trekview.org 2021; Paul Bourke, "GoPro MAX 360 Action Cam movie layout", paulbourke.net/panorama/gopromax2sphere.
    ("gopro-max", "cube:layout=eac,overlap=32"),
    // Circles of some 204 degrees beside each other, upright; insta360-to-equirectangular.sh, by v360=dfisheye:e:ih_fov=204.
    // Which lens is called the front is a choice. Models differ: an Air has 191.5, by the shader below.
    ("insta360", "dual-fisheye:fov=204"),
    // The left picture lies with its upper side to the left, the right one with its upper side to the right; 90 degrees are 0.445 of
    // a half's width. Nora, ThetaRealtimeEquirectangular (Unity shader), 2015; mrdoob/three.js, webgl_panorama_dualfisheye.html.
    ("theta", "dual-fisheye:fov=202,front.roll=90,back.roll=-90"),
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
    // The left half looks back.
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

/// Words that people try for a projection, each with the SPEC that they may mean. They are suggested, not understood: some
/// have a second meaning.
const TRIED: [(&[&str], &str); 16] = [
    (&["planet", "small-planet", "smallplanet", "stereo-planet"], "little-planet"),
    (&["dome", "planetarium", "master"], "fulldome"),
    (&["hemisphere", "hemispherical", "all-sky", "allsky"], "fisheye"),
    (&["imax", "imax-dome", "omni"], "omnimax"),
    (&["360", "vr", "vr360", "pano", "erp", "equi", "sphere", "lat-long", "spheremap", "hdri"], "equirect"),
    (&["180"], "he"),
    (&["skybox", "cube-map", "cubic", "sixpack"], "cube"),
    (&["cross"], "cube:layout=cross-h"),
    (&["cube3x2", "cubemap3x2", "3x2"], "cube:layout=3x2"),
    (&["strip", "cube6x1", "cubemap6x1", "6x1"], "cube:layout=strip-h"),
    (&["cube1x6", "cubemap1x6", "1x6"], "cube:layout=strip-v"),
    (&["pinhole", "normal", "camera", "undistorted", "view", "flat-view", "persp"], "perspective"),
    (&["chrome-ball", "chromeball", "mirrorball", "silver-ball"], "mirror-ball"),
    (&["probe", "light-probe", "lightprobe", "angular"], "angular-map"),
    (&["two-fisheyes", "double-fisheye"], "dual-fisheye"),
    (&["gopro", "gopromax", "max", "gopro-360"], "gopro-max"),
];

/// Returns the SPEC that a word tried for a projection may mean.
pub(super) fn tried(word: &str) -> Option<&'static str> {
    let word = word.to_ascii_lowercase().replace('_', "-");
    TRIED.iter().find(|(words, _)| words.contains(&word.as_str())).map(|(_, spec)| *spec)
}

/// Projections of ffmpeg's v360 that are not supported.
const REFUSED: [&str; 5] = ["barrel", "fb", "barrelsplit", "tsp", "tetrahedron"];
/// Projection of envutil that is not supported: an equi-angular cube.
const REFUSED_OF_ENVUTIL: &str = "biatan6";

/// Replaces another program's name by the SPEC that it stands for. Typed keys follow that SPEC's own keys, and override
/// them.
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

/// Returns how to convert an unsupported projection by way of equirect in the other program; `None` for other names.
pub(super) fn refusal(name: &str) -> Option<String> {
    match name {
        REFUSED_OF_ENVUTIL => Some(
            "as by envutil's --projection spherical; cubes of equal angles are cube:layout=eac here, laid out otherwise"
                .to_owned(),
        ),
        _ => REFUSED.contains(&name).then(|| format!("as by ffmpeg's v360=input={name}:output=e for an input, v360=input=e:output={name} for an output")),
    }
}

/// Rewrites keys that are separated by colons, as in ffmpeg's filters, in our notation; `None` if that is not the case.
///
/// Keys that the projection does not have are left out, for example the vertical field of view of a fisheye.
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
