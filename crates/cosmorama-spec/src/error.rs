use cosmorama::layout::LensSide;
use cosmorama::projection::azimuthal::LensError;
use thiserror::Error;

/// Reason why a SPEC cannot be understood.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpecError {
    /// The projection's name is unknown.
    #[error("unknown projection '{name}'{}; there are {}", did_you_mean(.name, .known), .known.join(", "))]
    UnknownName {
        /// Name as typed.
        name: String,
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

/// Returns a suggestion for a mistyped key: the full name of a lens's or face's key, or the most similar key.
fn meant(typed: &str, known: &[&str]) -> String {
    match typed.split_once('.') {
        Some((_, key)) if known.contains(&&*format!("LENS.{key}")) => {
            let each: Vec<String> = LensSide::ALL.iter().map(|side| format!("'{}.{key}'", side.name())).collect();
            format!("; did you mean {}?", each.join(" or "))
        }
        // A camera's fov is the horizontal one, which others call so; by letters dfov is as near.
        _ if matches!(typed, "hfov" | "h_fov") && known.contains(&"fov") => "; did you mean 'fov'?".to_owned(),
        _ => did_you_mean(typed, known),
    }
}

/// Returns "did you mean …?" with the most similar known name; empty if none is similar.
pub fn did_you_mean(typed: &str, known: &[&str]) -> String {
    let likeness = |name: &&&str| (strsim::normalized_damerau_levenshtein(typed, name) * 1000.0) as i64;
    match known.iter().max_by_key(likeness).filter(|best| likeness(best) >= 500) {
        Some(best) => format!("; did you mean '{best}'?"),
        None => String::new(),
    }
}
