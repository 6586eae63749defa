//! Guesses at what a mistyped word was meant for.

use cosmorama::layout::LensSide;

use super::question;

/// Words of people and other programs for keys, each with the keys that it may stand for, the likeliest first.
const OTHER_KEYS: [(&[&str], &[&str]); 17] = [
    (&["tilt", "axis", "lean", "inclination"], &["tilt", "axis", "pitch"]),
    (&["mirror", "mirrored", "hflip", "vflip"], &["flip"]),
    (&["crop", "window", "region", "roi"], &["canvas"]),
    (&["calib", "camera", "intrinsics"], &["calibration"]),
    (&["faceorder"], &["order"]),
    (&["preset", "convention"], &["naming"]),
    (&["angle", "view", "aperture", "span", "degrees", "zoom"], &["fov", "hfov"]),
    (&["pan", "heading", "azimuth", "longitude", "lon"], &["yaw"]),
    (&["elevation", "latitude"], &["lat", "pitch"]),
    (&["model", "projection", "mapping", "type"], &["lens", "kind"]),
    (&["coefficients", "coeffs", "distortion", "d", "params"], &["k"]),
    (&["blend", "overlap"], &["feather"]),
    (&["cut", "bottom"], &["lower"]),
    (&["pixelaspect", "par"], &["aspect"]),
    (&["eyes", "3d"], &["stereo"]),
    (&["dist"], &["distance", "k"]),
    (&["inverse"], &["invert"]),
];

/// Returns a suggestion for a mistyped key: the full name of a lens's or face's key, a key of the same meaning, or the most
/// similar key.
pub(super) fn meant(typed: &str, known: &[&str]) -> String {
    match typed.split_once('.') {
        Some((_, key)) if known.contains(&&*format!("LENS.{key}")) => {
            let each: Vec<String> = LensSide::ALL.iter().map(|side| format!("{}.{key}", side.name())).collect();
            question(&each)
        }
        _ => match key_for(typed, known).or_else(|| in_words_of_others(typed, known)) {
            Some(key) => question(&[key]),
            None => did_you_mean(typed, known),
        },
    }
}

/// Finds the key for a field of view or a centre that has another name elsewhere: ffmpeg's `h_fov`, a panorama's `hfov`.
///
/// A camera's `fov` is the horizontal one, although `dfov` is as similar in spelling.
pub(crate) fn key_for<'k>(typed: &str, known: &[&'k str]) -> Option<&'k str> {
    let plain = plain(typed);
    let names: &[&str] = match plain.as_str() {
        "hfov" | "ihfov" | "fov" => &["hfov", "fov"],
        "vfov" | "ivfov" => &["vfov"],
        "dfov" | "idfov" => &["dfov", "fov"],
        "centre" => &["center"],
        "name" | "names" => &["naming"],
        // A dome leans, and an Omnimax lens's axis rises: both are the same angle in a theatre.
        "tilt" => &["tilt", "axis"],
        "axis" => &["axis", "tilt"],
        other => &[other],
    };
    first_of(names, known)
}

/// Finds the key that a word of people or other programs stands for.
fn in_words_of_others<'k>(typed: &str, known: &[&'k str]) -> Option<&'k str> {
    let plain = plain(typed);
    let (_, keys) = OTHER_KEYS.iter().find(|(words, _)| words.contains(&plain.as_str()))?;
    first_of(keys, known)
}

/// Returns a word in small letters, without marks between its parts.
fn plain(word: &str) -> String {
    word.to_ascii_lowercase().replace(['_', '-'], "")
}

/// Finds the first of some names that is known.
fn first_of<'k>(names: &[&str], known: &[&'k str]) -> Option<&'k str> {
    names.iter().find_map(|name| known.iter().copied().find(|key| key == name))
}

/// Returns "did you mean …?" with the most similar known name; empty if none is similar.
pub fn did_you_mean(typed: &str, known: &[&str]) -> String {
    question(nearest(typed, known).as_slice())
}

/// Finds the known name that is most like what was typed.
pub fn nearest<'k>(typed: &str, known: &[&'k str]) -> Option<&'k str> {
    let typed = typed.to_ascii_lowercase();
    // Half of the letters must be alike. What is longer than twice a name is not, and to compare it takes time by its length.
    let letters = typed.chars().count();
    let is_near = |name: &&str| letters <= 2 * name.chars().count();
    let likeness = |name: &&str| (strsim::normalized_damerau_levenshtein(&typed, name) * 1000.0) as i64;
    known.iter().copied().filter(is_near).max_by_key(likeness).filter(|best| likeness(best) >= 500)
}
