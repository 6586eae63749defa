//! First words that are no verb.

use cosmorama_spec::{SpecKind, nearest};

use super::arguments::see_options;
use crate::args;

/// Other programs' words for verbs, and words that people try.
const OTHER_NAMES: [(&[&str], &str); 7] = [
    (&["render", "remap", "project", "reproject", "transform", "warp", "make", "run", "export"], "convert"),
    (&["identify", "probe", "inspect", "stat", "show", "metadata"], "info"),
    (&["diff", "psnr", "check"], "compare"),
    (&["plan", "dry-run", "analyse", "analyze", "preview", "describe"], "explain"),
    (&["example", "test"], "demo"),
    (&["complete", "completion"], "completions"),
    (&["manual"], "man"),
];

/// Words that ask for a list.
const LISTS: [&str; 8] = ["spec", "specs", "projections", "projection", "formats", "keys", "aliases", "list"];

/// Returns what to type in place of a first word that is no verb.
pub(super) fn message(word: &str) -> String {
    let verbs: Vec<&str> = args::verbs().collect();
    let lower = word.to_lowercase();
    let other = OTHER_NAMES.iter().find(|(names, _)| names.contains(&lower.as_str())).map(|(_, verb)| *verb);
    let advice = if LISTS.contains(&lower.as_str()) {
        "'cosmorama help spec' lists every projection with its keys".to_owned()
    } else if word.contains(['.', '/', '{', '#', '%']) {
        format!("a verb comes first, as in 'cosmorama convert {word} OUTPUT --to SPEC' or 'cosmorama info {word}'")
    } else if SpecKind::of(word).is_some() {
        format!("that is a projection: cosmorama convert INPUT OUTPUT --to {word}")
    } else if let Some(verb) = other.or_else(|| nearest(&lower, &verbs)) {
        format!("did you mean '{verb}'?")
    } else {
        format!("there are {}", verbs.join(", "))
    };
    format!("unknown verb '{word}'; {advice}\n\n{}", see_options(None))
}
