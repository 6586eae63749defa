//! Reasons why a text cannot be parsed, each with what to write instead.

mod meaning;

use std::fmt;

use cosmorama::projection::azimuthal::LensError;
use thiserror::Error;

pub use meaning::{did_you_mean, nearest};

pub(crate) use meaning::key_for;
use meaning::meant;

/// Reason why a SPEC cannot be understood.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpecError {
    /// The projection's name is unknown.
    #[error("unknown projection '{name}'{}", all_after(&question(.meant), "there are", &.known.join(", ")))]
    UnknownName {
        /// Name as typed.
        name: String,
        /// Suggested names or SPECs; none if none is likely.
        meant: Vec<String>,
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
    #[error("unknown key '{key}' for {name}{}", all_after(&meant(.key, .known), "it takes", &.known.join(", ")))]
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
    #[error("'{part}' is no key=value; {}", with_key(.instead))]
    NoValue {
        /// Part as typed.
        part: String,
        /// Suggested SPECs, in which the part is the value of a key; none if it fits no key.
        instead: Vec<String>,
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
        /// Reason why the coefficients make no lens.
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

/// Reason why a word is not the name of a filter, kernel, transfer function, primaries or sample type.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WordError {
    /// The word is unknown.
    #[error("unknown {what} '{word}'{}", all_after(&question(.meant.as_slice()), "there are", .known))]
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
        /// Name of the word in that setting.
        name: String,
    },
    /// A parameter is unknown or wrong.
    #[error("{0}")]
    Parameter(String),
}

/// Kind of thing that a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// A filter: the averaging of a pixel.
    Filter,
    /// A kernel: the weights by which a pixel averages.
    Kernel,
    /// A transfer function.
    Transfer,
    /// Primaries.
    Primaries,
    /// A sample type.
    Depth,
}

impl fmt::Display for WordKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Filter => "filter",
            Self::Kernel => "kernel",
            Self::Transfer => "transfer function",
            Self::Primaries => "primaries",
            Self::Depth => "depth",
        })
    }
}

/// Returns the question whether one of some names was meant; empty if there are none.
fn question(names: &[impl AsRef<str>]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("'{}'", name.as_ref())).collect();
    if quoted.is_empty() { String::new() } else { format!("; did you mean {}?", quoted.join(" or ")) }
}

/// Returns a question, if there is one, and all that is known after it: `; did you mean 'fov'? It takes fov, lens`.
fn all_after(question: &str, verb: &str, known: &str) -> String {
    match (question, verb.split_at(1)) {
        ("", _) => format!("; {verb} {known}"),
        (question, (first, rest)) => format!("{question} {}{rest} {known}", first.to_uppercase()),
    }
}

/// Returns the advice to write one of some SPECs, or the form of all if there are none.
fn with_key(specs: &[String]) -> String {
    match specs {
        [] => "a SPEC is NAME[:key=value[,key=value]...], as in fisheye:fov=220,fit=width".to_owned(),
        specs => format!("write {}", specs.join(" or ")),
    }
}

/// Returns the advice to write a SPEC, or an example if there is none.
fn written(spec: Option<&str>) -> String {
    match spec {
        Some(spec) => format!("; write {spec}"),
        None => ", as in fisheye:fov=220,fit=width".to_owned(),
    }
}
