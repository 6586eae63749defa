//! First words that are not verbs.

use cosmorama_spec::{SpecKind, nearest};

use super::arguments::see_options;
use crate::args;

/// Other programs' words for verbs, and words that people try.
const OTHER_NAMES: [(&[&str], &str); 7] = [
    (
        &[
            "render",
            "remap",
            "project",
            "reproject",
            "transform",
            "warp",
            "make",
            "run",
            "export",
            "rotate",
            "turn",
            "unwrap",
            "dewarp",
        ],
        "convert",
    ),
    (&["identify", "probe", "inspect", "stat", "show", "metadata"], "info"),
    (&["diff", "psnr", "check"], "compare"),
    (&["plan", "dry-run", "analyse", "analyze", "preview", "describe"], "explain"),
    (&["example", "test"], "demo"),
    (&["complete", "completion"], "completions"),
    (&["manual"], "man"),
];

/// Words that ask for a list.
const LISTS: [&str; 7] = ["spec", "specs", "projections", "projection", "keys", "aliases", "list"];

/// Words for tasks that have no verb here, and what to do instead.
const NO_VERBS: [(&[&str], &str); 7] = [
    (&["version"], "it is an option: cosmorama --version"),
    (&["init", "setup", "new", "install", "config"], "nothing has to be set up; 'cosmorama demo' shows what it does"),
    (
        &["v360", "ffmpeg"],
        "v360's names of projections are understood: v360=e:flat is cosmorama convert INPUT OUTPUT --from e --to flat",
    ),
    (
        &["stitch", "merge", "blend"],
        "cosmorama convert project.pto OUTPUT, or a world file (.toml) that lists the pictures (docs/tasks.md)",
    ),
    (
        &["resize", "scale", "downsample"],
        "convert makes another size of the same projection: cosmorama convert INPUT OUTPUT --from SPEC --to SPEC --size N",
    ),
    (&["view", "open", "play", "gui"], "there is no viewer; 'cosmorama info FILE' tells what a picture is"),
    (&["validate"], "frames are checked by 'cosmorama verify PATTERN'"),
];

/// Other words for the maps of `light`.
const MAPS: [(&[&str], &str); 3] = [
    (&["irradiance", "ambient", "lambert", "diffuse-map"], "diffuse"),
    (&["reflection", "glossy", "prefilter", "radiance", "ggx", "phong", "rough"], "specular"),
    (&["sh", "spherical-harmonics", "coefficients", "probe"], "harmonics"),
];

/// Returns what to type in place of a second word that is not a verb of the first.
pub(super) fn message_of_part(word: &str, verb: &str) -> String {
    let parts = args::parts(verb);
    let names: Vec<&str> = parts.iter().map(String::as_str).collect();
    let lower = word.to_lowercase();
    let other = MAPS.iter().find(|(words, _)| words.contains(&lower.as_str())).map(|(_, part)| *part);
    let advice = if word.contains(['.', '/', '{', '#', '%']) {
        let first = names.first().copied().unwrap_or_default();
        format!(
            "say which map comes first, as in cosmorama {verb} {first} {word} OUTPUT; there are {}",
            names.join(", ")
        )
    } else if let Some(part) = other.or_else(|| nearest(&lower, &names)) {
        format!("did you mean '{verb} {part}'?")
    } else {
        format!("there are {}", names.join(", "))
    };
    format!("unknown '{word}' after {verb}; {advice}\n\n{}", see_options(Some(verb)))
}

/// Returns what to type in place of a first word that is not a verb.
pub(super) fn message(word: &str) -> String {
    let verbs: Vec<&str> = args::verbs().collect();
    let lower = word.to_lowercase();
    let other = OTHER_NAMES.iter().find(|(names, _)| names.contains(&lower.as_str())).map(|(_, verb)| *verb);
    let no_verb = NO_VERBS.iter().find(|(words, _)| words.contains(&lower.as_str())).map(|(_, advice)| *advice);
    let advice = if LISTS.contains(&lower.as_str()) {
        "'cosmorama help spec' lists every projection with its keys".to_owned()
    } else if let Some(advice) = no_verb {
        advice.to_owned()
    } else if args::LISTS.iter().any(|list| list.trim_end_matches('s') == lower.trim_end_matches('s')) {
        format!("'cosmorama help {lower}' lists them")
    } else if word.contains(['.', '/', '{', '#', '%']) {
        format!("a verb comes first, as in 'cosmorama convert {word} OUTPUT --to SPEC' or 'cosmorama info {word}'")
    } else if SpecKind::of(word).is_some() {
        format!("that is a projection: cosmorama convert INPUT OUTPUT --to {word}")
    } else if let Some(verb) = other.or_else(|| nearest(&lower, &verbs)) {
        let example =
            args::examples(Some(verb)).first().map_or_else(String::new, |example| format!(" As in {example}"));
        format!("did you mean '{verb}'?{example}")
    } else {
        format!("there are {}", verbs.join(", "))
    };
    format!("unknown verb '{word}'; {advice}\n\n{}", see_options(None))
}
