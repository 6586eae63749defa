use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Primaries;

use crate::WordError;
use crate::error::{WordKind, nearest};

/// Primaries by name: `rec709`, `p3-d65`, `p3-dci`, `rec2020`, `ap0`, `acescg` or `adobe-rgb`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimariesName(pub Primaries);

/// Names with their primaries.
const KNOWN: [(&str, Primaries); 7] = [
    ("rec709", Primaries::REC709),
    ("p3-d65", Primaries::P3_D65),
    ("p3-dci", Primaries::P3_DCI),
    ("rec2020", Primaries::REC2020),
    ("ap0", Primaries::AP0),
    ("acescg", Primaries::AP1),
    ("adobe-rgb", Primaries::ADOBE_RGB),
];

/// Other programs' words for primaries, each with our name.
const OTHER_NAMES: [(&str, &str); 22] = [
    ("srgb", "rec709"),
    ("bt709", "rec709"),
    ("rec.709", "rec709"),
    ("bt.709", "rec709"),
    ("709", "rec709"),
    ("p3", "p3-d65"),
    ("display-p3", "p3-d65"),
    ("displayp3", "p3-d65"),
    ("p3d65", "p3-d65"),
    ("smpte432", "p3-d65"),
    ("dci-p3", "p3-dci"),
    ("smpte431", "p3-dci"),
    ("bt2020", "rec2020"),
    ("rec.2020", "rec2020"),
    ("bt.2020", "rec2020"),
    ("2020", "rec2020"),
    ("rec2100", "rec2020"),
    ("aces", "ap0"),
    ("aces2065-1", "ap0"),
    ("ap1", "acescg"),
    ("adobergb", "adobe-rgb"),
    ("adobe", "adobe-rgb"),
];

/// Prints the name, or the four pairs of chromaticities if the primaries have no name.
impl fmt::Display for PrimariesName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match KNOWN.iter().find(|(_, known)| known.is_same(&self.0)) {
            Some((name, _)) => f.write_str(name),
            None => self.0.fmt(f),
        }
    }
}

impl FromStr for PrimariesName {
    type Err = WordError;

    fn from_str(text: &str) -> Result<Self, WordError> {
        let found = KNOWN.iter().find(|(name, _)| *name == text);
        found.map(|(_, primaries)| Self(*primaries)).ok_or_else(|| unknown(text))
    }
}

fn unknown(text: &str) -> WordError {
    let word = text.to_ascii_lowercase();
    let other = OTHER_NAMES.iter().find(|(other, _)| *other == word).map(|(_, ours)| *ours);
    let names = PrimariesName::NAMES.map(|(name, _)| name);
    WordError::Unknown {
        what: WordKind::Primaries,
        word: text.to_owned(),
        meant: other.or_else(|| nearest(&word, &names)).map(str::to_owned),
        known: "rec709, p3-d65, p3-dci, rec2020, ap0, acescg and adobe-rgb".to_owned(),
    }
}

impl PrimariesName {
    /// All names with a line of help, in the order of the help.
    pub const NAMES: [(&str, &str); 7] = [
        ("rec709", "Rec. 709, those of sRGB"),
        ("p3-d65", "Display P3"),
        ("p3-dci", "Cinema projection"),
        ("rec2020", "Rec. 2020, those of HDR video"),
        ("ap0", "ACES2065-1, for exchange and archives"),
        ("acescg", "ACEScg (AP1), for rendering"),
        ("adobe-rgb", "Adobe RGB (1998)"),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_name_is_answered_by_what_was_meant() {
        for (name, _) in PrimariesName::NAMES {
            assert_eq!(name.parse::<PrimariesName>().unwrap().to_string(), name);
        }
        for (other, ours) in OTHER_NAMES {
            assert!(ours.parse::<PrimariesName>().is_ok(), "{ours}");
            let message = other.parse::<PrimariesName>().unwrap_err().to_string();
            let expected = format!("unknown primaries '{other}'; did you mean '{ours}'? There are rec709");
            assert!(message.starts_with(&expected), "{message}");
        }
    }
}
