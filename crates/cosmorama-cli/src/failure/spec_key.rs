//! Keys of SPECs that are typed as options.

use cosmorama_spec::{Spec, SpecError, SpecKey, SpecKind};

use super::arguments::Typed;

/// Other words for keys.
const OTHER_KEYS: [(&str, &str); 7] = [
    ("mirror", "flip"),
    ("hflip", "flip"),
    ("vflip", "flip"),
    ("crop", "canvas"),
    ("calib", "calibration"),
    ("faceorder", "order"),
    ("names", "naming"),
];

/// Other possible meanings of a word that is a key.
const BESIDES: [(&str, &str); 1] = [("rotate", "; the view is turned by --yaw, --pitch and --roll")];

/// Projections that come first where a key is explained by an example.
const USUAL: [&str; 5] = ["perspective", "fulldome", "fisheye", "equirect", "omnimax"];

/// Returns what to write in place of an option that is a key of SPECs; `None` where no projection has such a key.
pub(super) fn advice(word: &str, option: &str, typed: &Typed) -> Option<String> {
    let word = OTHER_KEYS.iter().find(|(other, _)| *other == word).map_or(word, |(_, key)| *key);
    let asked: Vec<SpecKind> =
        ["--to", "--from"].into_iter().filter_map(|side| SpecKind::of(typed.value(side)?)).collect();
    let takers: Vec<(SpecKind, &SpecKey)> =
        SpecKind::all().filter_map(|kind| Some((kind, exact(kind, word)?))).collect();
    let own = asked.iter().find_map(|kind| Some((*kind, exact(*kind, word)?)));
    // The projection that was asked for may have another name for it.
    let alike = || asked.iter().find_map(|kind| Some((*kind, kind.key(word)?)));
    let (kind, key) = own.or_else(alike).or_else(|| first(&takers))?;
    let value = typed.value(option.split('=').next().unwrap_or_default());
    // A value that the key refuses is no advice. Then the kind of value is named instead.
    let value = value.filter(|value| takes(kind, key, value)).unwrap_or(key.value);
    // If the output is another projection, the input must have been meant.
    let side = if typed.value("--to").is_some() && typed.value("--from").is_none() { "--from" } else { "--to" };
    let write =
        with_key(kind, key, value, typed).unwrap_or_else(|| format!("{side} {}:{}={value}", kind.name(), key.name));
    let not = match asked.first() {
        _ if exact(kind, word).is_none() => {
            return Some(format!("of {} that is the key {}: {write}", kind.name(), key.name));
        }
        Some(asked) if own.is_none() => format!(", not of {}", asked.name()),
        _ => String::new(),
    };
    let besides = BESIDES.iter().find(|(key, _)| *key == word).map_or("", |(_, besides)| besides);
    Some(format!("{word} is a key of {}{not}: {write}{besides}", list(&takers)))
}

/// Returns whether a key accepts a value.
fn takes(kind: SpecKind, key: &SpecKey, value: &str) -> bool {
    let parsed = format!("{}:{}={value}", kind.name(), key.name).parse::<Spec>();
    !matches!(parsed, Err(SpecError::Value { key: of, .. }) if of == key.name)
}

/// Returns the key of a projection that has this very name, apart from spelling.
fn exact(kind: SpecKind, word: &str) -> Option<&'static SpecKey> {
    let plain = word.replace('-', "").replace("centre", "center");
    kind.key(word).filter(|key| key.name == plain)
}

/// Returns the projection that explains a key best.
fn first<'k>(takers: &[(SpecKind, &'k SpecKey)]) -> Option<(SpecKind, &'k SpecKey)> {
    let usual = USUAL.iter().find_map(|name| takers.iter().find(|(kind, _)| kind.name() == *name));
    usual.or(takers.first()).copied()
}

/// Returns the option that was typed, `--to` or `--from`, with another key.
pub(super) fn with_key(kind: SpecKind, key: &SpecKey, value: &str, typed: &Typed) -> Option<String> {
    ["--to", "--from"].into_iter().find_map(|option| {
        let spec = typed.value(option)?;
        let separator = match spec.ends_with([':', ',']) {
            true => "",
            false if spec.contains(':') => ",",
            false => ":",
        };
        (SpecKind::of(spec)?.name() == kind.name()).then(|| format!("{option} {spec}{separator}{}={value}", key.name))
    })
}

/// Lists names of projections as in a sentence.
fn list(takers: &[(SpecKind, &SpecKey)]) -> String {
    let names: Vec<&str> = takers.iter().map(|(kind, _)| kind.name()).collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => names.concat(),
    }
}
