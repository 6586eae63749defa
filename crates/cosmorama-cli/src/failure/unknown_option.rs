//! Options that a verb does not have: keys of SPECs, other programs' words, typing errors.

use cosmorama_spec::{SpecKind, nearest};

use super::arguments::{Typed, see_options};
use super::other_words;
use super::spec_key::{self, with_key};
use crate::args;

/// Verbs that take projections.
const WITH_SPECS: [&str; 2] = ["convert", "explain"];

/// Returns what to type in place of an argument that a verb does not take.
pub(super) fn message(argument: &str, typed: &Typed) -> String {
    let verb = typed.verb();
    let Some(word) = argument.strip_prefix("--").or_else(|| argument.strip_prefix('-')) else {
        return format!("unexpected argument '{argument}'; {}\n\n{}", lone_word(argument, typed), see_options(verb));
    };
    let word = word.split('=').next().unwrap_or_default().to_lowercase().replace('_', "-");
    let words = ["cosmorama"].into_iter().chain(verb).chain(typed.part());
    let who = words.collect::<Vec<_>>().join(" ");
    let takes_specs = verb.is_none_or(|verb| WITH_SPECS.contains(&verb));
    let is_long = argument.starts_with("--");
    if let Some(name) = typed.option_with_one_dash(verb).filter(|_| !is_long) {
        return format!("{who} has no option -{name}; write --{name}, with two dashes\n\n{}", see_options(verb));
    }
    let advice = spec_key::advice(&word, argument, typed)
        .filter(|_| takes_specs && is_long)
        .or_else(|| other_words::advice(&word, verb))
        .or_else(|| option_of_part(&word, typed))
        .or_else(|| own_option(&word, verb))
        .or_else(|| option_of_other(&word, verb))
        .unwrap_or_default();
    let advice = if advice.is_empty() { advice } else { format!("; {advice}") };
    format!("{who} has no option {argument}{advice}\n\n{}", see_options(verb))
}

/// Returns advice on a word that belongs to no option.
fn lone_word(word: &str, typed: &Typed) -> String {
    if let Some(first) = typed.video_args_before(word) {
        return format!("quotes hold an encoder's arguments together: --video-args '{first} {word}'");
    }
    let key = word.split_once('=').map(|(key, value)| (key.trim_start_matches(':'), value));
    if let Some((key, value)) = key.filter(|(key, _)| SpecKind::all().any(|kind| kind.key(key).is_some())) {
        return match SpecKind::all().find_map(|kind| with_key(kind, kind.key(key)?, value, typed)) {
            Some(example) => format!("keys follow the projection's name and a colon, without spaces: {example}"),
            None => format!("keys follow the projection's name and a colon, without spaces: --to NAME:{key}={value}"),
        };
    }
    if SpecKind::of(word).is_some() {
        return format!("that is a projection: --to {word}");
    }
    if word == "x" || word.parse::<f64>().is_ok() {
        return "a size is one word, without spaces, as in --size 4096x2048".to_owned();
    }
    if ["kb", "mb", "gb", "k", "m", "g", "gib", "mib", "%"].contains(&word.to_lowercase().as_str()) {
        return "a size of memory is one word, without spaces, as in --memory 8G".to_owned();
    }
    if typed.verb().is_some_and(|verb| args::options(verb).iter().any(|name| name == word)) {
        return format!("an option begins with two dashes: --{word}");
    }
    match typed.verb() {
        Some("info") => {
            return "info tells of one input; several files are named by one pattern, in quotes: '####' where frame numbers stand, \
                    '{face}' where faces' names do"
                .to_owned();
        }
        Some("compare") => return "two pictures are compared".to_owned(),
        Some("explain") => {
            return format!("explain makes no picture: leave {word} out; its diagrams go into a folder, --output DIR");
        }
        Some("demo" | "man") => return "one folder is named".to_owned(),
        Some("completions") => return "one shell is named".to_owned(),
        Some("help") => return "one topic is named; 'help spec' and 'help light' take a second word".to_owned(),
        _ => {}
    }
    // The shell replaces a wildcard by a list of files.
    "many files are named by one pattern, in quotes: '####' where frame numbers stand, '{face}' where faces' names do"
        .to_owned()
}

/// Returns the verb with the same first word that has the option: `light specular`, for `light diffuse`.
fn option_of_part(word: &str, typed: &Typed) -> Option<String> {
    let (verb, part) = (typed.verb()?, typed.part()?);
    let has = |other: &String| other != part && args::options_of_part(verb, other).iter().any(|name| name == word);
    args::parts(verb).into_iter().find(has).map(|other| format!("cosmorama {verb} {other} has it"))
}

/// Returns the verb's own option that is most similar to what was typed.
fn own_option(word: &str, verb: Option<&str>) -> Option<String> {
    let names =
        verb.map_or_else(|| ["help", "version", "verbose", "log-format"].map(str::to_owned).to_vec(), args::options);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let begun = names.iter().copied().find(|name| word.len() > 2 && name.starts_with(word));
    begun.or_else(|| nearest(word, &names)).map(|name| format!("did you mean --{name}?"))
}

/// Returns another verb that has the option.
fn option_of_other(word: &str, verb: Option<&str>) -> Option<String> {
    let Some(verb) = verb else {
        return args::verbs().find(|other| args::options(other).iter().any(|name| name == word)).map(|other| {
            format!("a verb and its files come first, as in {}", args::examples(Some(other)).first().unwrap_or(&""))
        });
    };
    let other = args::verbs()
        .filter(|other| *other != verb)
        .find(|other| args::options(other).iter().any(|name| name == word))?;
    Some(format!("cosmorama {other} has it"))
}
