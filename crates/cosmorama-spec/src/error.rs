use cosmorama::layout::LensSide;
use cosmorama::projection::azimuthal::LensError;
use thiserror::Error;

/// Reason for which a SPEC cannot be understood.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpecError {
    /// A name that no projection has.
    #[error("unknown projection '{name}'{}; there are {}", did_you_mean(.name, .known), .known.join(", "))]
    UnknownName {
        /// Name of the projection.
        name: String,
        /// Names that there are.
        known: Vec<&'static str>,
    },
    /// A projection of another program that is not on offer here.
    #[error(
        "the projection '{name}' of other programs is not on offer here; it is converted there, from and to equirect, {way}"
    )]
    NotOffered {
        /// Name of the projection.
        name: String,
        /// How to convert it by way of another program.
        way: String,
    },
    /// A key that the projection does not take.
    #[error("unknown key '{key}' for {name}{}; it takes {}", meant(.key, .known), .known.join(", "))]
    UnknownKey {
        /// Name of the projection.
        name: &'static str,
        /// Key as typed.
        key: String,
        /// Names that there are.
        known: Vec<&'static str>,
    },
    /// A common key that means nothing for this projection.
    #[error("{name} takes no {key}=: {why}")]
    Refused {
        /// Name of the projection.
        name: &'static str,
        /// Key as typed.
        key: String,
        /// Reason for which it means nothing.
        why: &'static str,
    },
    /// A part that is no `key=value`.
    #[error("'{part}' is no key=value; a SPEC is NAME[:key=value[,key=value]...], as in fisheye:fov=220,fit=width")]
    NoValue {
        /// Part as typed.
        part: String,
    },
    /// A key that is given twice.
    #[error("{key}= is given twice")]
    Twice {
        /// Key as typed.
        key: String,
    },
    /// A value that is not of the expected kind.
    #[error("{key}={value}: expected {expected}")]
    Value {
        /// Key as typed.
        key: String,
        /// Value as typed.
        value: String,
        /// Description of a good value.
        expected: String,
    },
    /// A key that is missing, without which the name means nothing.
    #[error("{name} needs {key}=, as in {example}")]
    Missing {
        /// Name of the projection.
        name: &'static str,
        /// Key as typed.
        key: &'static str,
        /// SPEC that has it.
        example: &'static str,
    },
    /// Coefficients of which no lens can be made.
    #[error("k={value}: {error}")]
    Coefficients {
        /// Value as typed.
        value: String,
        /// Reason for which the lens cannot be made.
        error: LensError,
    },
    /// Keys that say the same thing differently.
    #[error("{first}= and {second}= cannot both be given")]
    Both {
        /// One key.
        first: &'static str,
        /// Other key.
        second: &'static str,
    },
}

/// Returns the key that was meant, where one of a lens or a face was typed as it stands in the table, or another is like it.
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

/// Returns the known name that is most like what was typed, as a question; nothing where none is.
pub fn did_you_mean(typed: &str, known: &[&str]) -> String {
    let likeness = |name: &&&str| (strsim::normalized_damerau_levenshtein(typed, name) * 1000.0) as i64;
    match known.iter().max_by_key(likeness).filter(|best| likeness(best) >= 500) {
        Some(best) => format!("; did you mean '{best}'?"),
        None => String::new(),
    }
}
