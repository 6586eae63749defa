use std::fmt;

use cosmorama::layout::LensSide;
use cosmorama::projection::azimuthal::LensError;
use thiserror::Error;

/// Reason why a SPEC cannot be understood.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpecError {
    /// The projection's name is unknown.
    #[error("unknown projection '{name}'{}; there are {}", question(.meant.as_deref()), .known.join(", "))]
    UnknownName {
        /// Name as typed.
        name: String,
        /// Suggested name or SPEC, if one is likely.
        meant: Option<String>,
        /// Known names.
        known: Vec<&'static str>,
    },
    /// The projection belongs to another program and is not supported here.
    #[error(
        "the projection '{name}' of other programs is not on offer here; it is converted there, from and to equirect, {way}"
    )]
    NotOffered {
        /// Name as typed.
        name: String,
        /// Remedy: a conversion by the other program.
        way: String,
    },
    /// The projection does not have this key.
    #[error("unknown key '{key}' for {name}{}; it takes {}", meant(.key, .known), .known.join(", "))]
    UnknownKey {
        /// Name of the projection.
        name: &'static str,
        /// Key as typed.
        key: String,
        /// Known keys.
        known: Vec<&'static str>,
    },
    /// The key, common to most projections, has no meaning for this one.
    #[error("{name} takes no {key}=: {why}")]
    Refused {
        /// Name of the projection.
        name: &'static str,
        /// Key as typed.
        key: String,
        /// Reason why it has no meaning.
        why: &'static str,
    },
    /// A part is not of the form `key=value`.
    #[error("'{part}' is no key=value; a SPEC is NAME[:key=value[,key=value]...], as in fisheye:fov=220,fit=width")]
    NoValue {
        /// Part as typed.
        part: String,
    },
    /// The keys are separated by colons, as in ffmpeg's filters.
    #[error("keys are separated by commas here, not by colons{}", written(.instead.as_deref()))]
    Colons {
        /// Suggested SPEC, if there is one.
        instead: Option<String>,
    },
    /// A key is given twice.
    #[error("{key}= is given twice")]
    Twice {
        /// Key as typed.
        key: String,
    },
    /// A value is not of the expected kind.
    #[error("{key}={value}: expected {expected}")]
    Value {
        /// Key as typed.
        key: String,
        /// Value as typed.
        value: String,
        /// Description of a valid value.
        expected: String,
    },
    /// A required key is missing.
    #[error("{name} needs {key}=, as in {example}")]
    Missing {
        /// Name of the projection.
        name: &'static str,
        /// Missing key.
        key: &'static str,
        /// Example of a SPEC with the key.
        example: &'static str,
    },
    /// The coefficients do not make a lens.
    #[error("k={value}: {error}")]
    Coefficients {
        /// Value as typed.
        value: String,
        /// Reason why they do not.
        error: LensError,
    },
    /// Two keys contradict or exclude each other.
    #[error("{first}= and {second}= cannot both be given")]
    Both {
        /// First key.
        first: &'static str,
        /// Second key.
        second: &'static str,
    },
}

impl SpecError {
    /// Returns the message without the list of keys, for callers that print the list in a better form.
    pub fn summary(&self) -> String {
        match self {
            Self::UnknownKey { name, key, known } => format!("unknown key '{key}' for {name}{}", meant(key, known)),
            other => other.to_string(),
        }
    }
}

/// Reason why a word is not the name of a filter, kernel or transfer function.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WordError {
    /// The word is unknown.
    #[error("unknown {what} '{word}'{}; there are {known}", question(.meant.as_deref()))]
    Unknown {
        /// Kind of name that was expected.
        what: WordKind,
        /// Word as typed.
        word: String,
        /// Suggested word, if one is likely.
        meant: Option<String>,
        /// Known words.
        known: String,
    },
    /// The word belongs to another setting.
    #[error("'{word}' is no {what}; that is a {of}: {name}")]
    OfOther {
        /// Kind of name that was expected.
        what: WordKind,
        /// Word as typed.
        word: String,
        /// Setting to which the word belongs.
        of: WordKind,
        /// Name that it has there.
        name: String,
    },
    /// A parameter is unknown or wrong.
    #[error("{0}")]
    Parameter(String),
}

/// Kind of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// A filter: the averaging of a pixel.
    Filter,
    /// A kernel: the weights of that average.
    Kernel,
    /// A transfer function.
    Transfer,
    /// Primaries.
    Primaries,
}

impl fmt::Display for WordKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Filter => "filter",
            Self::Kernel => "kernel",
            Self::Transfer => "transfer function",
            Self::Primaries => "primaries",
        })
    }
}

/// Returns a suggestion for a mistyped key: the full name of a lens's or face's key, or the most similar key.
fn meant(typed: &str, known: &[&str]) -> String {
    match typed.split_once('.') {
        Some((_, key)) if known.contains(&&*format!("LENS.{key}")) => {
            let each: Vec<String> = LensSide::ALL.iter().map(|side| format!("'{}.{key}'", side.name())).collect();
            format!("; did you mean {}?", each.join(" or "))
        }
        _ => match key_for(typed, known) {
            Some(key) => question(Some(key)),
            None => did_you_mean(typed, known),
        },
    }
}

/// Finds the key for a field of view or a centre that has another name elsewhere: ffmpeg's `h_fov`, a panorama's `hfov`.
///
/// A camera's `fov` is the horizontal one; by letters `dfov` is as near.
pub(crate) fn key_for<'k>(typed: &str, known: &[&'k str]) -> Option<&'k str> {
    let plain = typed.to_ascii_lowercase().replace(['_', '-'], "");
    let names: &[&str] = match plain.as_str() {
        "hfov" | "ihfov" | "fov" => &["hfov", "fov"],
        "vfov" | "ivfov" => &["vfov"],
        "dfov" | "idfov" => &["dfov", "fov"],
        "centre" => &["center"],
        "name" | "names" => &["naming"],
        other => &[other],
    };
    names.iter().find_map(|name| known.iter().copied().find(|key| key == name))
}

/// Returns "did you mean …?" with the most similar known name; empty if none is similar.
pub fn did_you_mean(typed: &str, known: &[&str]) -> String {
    question(nearest(typed, known))
}

/// Finds the known name that is most like what was typed.
pub fn nearest<'k>(typed: &str, known: &[&'k str]) -> Option<&'k str> {
    let typed = typed.to_ascii_lowercase();
    let likeness = |name: &&str| (strsim::normalized_damerau_levenshtein(&typed, name) * 1000.0) as i64;
    known.iter().copied().max_by_key(likeness).filter(|best| likeness(best) >= 500)
}

/// Returns the question whether a name was meant.
fn question(name: Option<&str>) -> String {
    name.map_or_else(String::new, |name| format!("; did you mean '{name}'?"))
}

/// Returns the advice to write a SPEC, or an example if there is none.
fn written(spec: Option<&str>) -> String {
    match spec {
        Some(spec) => format!("; write {spec}"),
        None => ", as in fisheye:fov=220,fit=width".to_owned(),
    }
}
