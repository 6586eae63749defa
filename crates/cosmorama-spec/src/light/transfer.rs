use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Transfer;

use crate::WordError;
use crate::error::{WordKind, nearest};

/// A transfer function by name: `auto`, `srgb`, `linear`, `bt1886`, `pq`, `hlg` or `gamma:G`.
#[derive(Clone, Debug, PartialEq)]
pub enum TransferName {
    /// The transfer function that the file names, else sRGB.
    Auto,
    /// A transfer function that overrides the file's.
    Fixed(Transfer),
}

/// Prints the name. The curves of an ICC profile, which have no name, print as `auto`, because the file holds them.
impl fmt::Display for TransferName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto | Self::Fixed(Transfer::Curve(_)) => f.write_str("auto"),
            Self::Fixed(Transfer::Srgb) => f.write_str("srgb"),
            Self::Fixed(Transfer::Linear) => f.write_str("linear"),
            Self::Fixed(Transfer::Bt1886) => f.write_str("bt1886"),
            Self::Fixed(Transfer::Pq) => f.write_str("pq"),
            Self::Fixed(Transfer::Hlg) => f.write_str("hlg"),
            Self::Fixed(Transfer::Gamma(gamma)) => write!(f, "gamma:{gamma}"),
        }
    }
}

impl FromStr for TransferName {
    type Err = WordError;

    fn from_str(text: &str) -> Result<Self, WordError> {
        let transfer = match text {
            "auto" => return Ok(Self::Auto),
            "srgb" => Transfer::Srgb,
            "linear" => Transfer::Linear,
            "bt1886" => Transfer::Bt1886,
            "pq" => Transfer::Pq,
            "hlg" => Transfer::Hlg,
            _ => match text.strip_prefix("gamma:").and_then(|gamma| gamma.parse().ok()) {
                Some(gamma) if (0.1..=10.0).contains(&gamma) => Transfer::Gamma(gamma),
                _ => return Err(unknown(text)),
            },
        };
        Ok(Self::Fixed(transfer))
    }
}

/// Other programs' words for transfer functions, each with our name.
const OTHER_NAMES: [(&str, &str); 18] = [
    ("gamma", "gamma:2.2"),
    ("lin", "linear"),
    ("raw", "linear"),
    ("none", "linear"),
    ("rec709", "bt1886"),
    ("bt709", "bt1886"),
    ("rec.709", "bt1886"),
    ("bt.709", "bt1886"),
    ("rec2020", "bt1886"),
    ("rec.2020", "bt1886"),
    ("bt2020", "bt1886"),
    ("bt.2020", "bt1886"),
    ("hdr10", "pq"),
    ("st2084", "pq"),
    ("smpte2084", "pq"),
    ("rec2100", "pq"),
    ("iec61966-2-1", "srgb"),
    ("b67", "hlg"),
];

fn unknown(text: &str) -> WordError {
    WordError::Unknown {
        what: WordKind::Transfer,
        word: text.to_owned(),
        meant: meant(text),
        known: "auto, srgb, linear, bt1886, pq, hlg and gamma:G (G from 0.1 to 10, as in gamma:2.2)".to_owned(),
    }
}

/// Finds a suggestion: another program's word, a gamma without the colon, or a name with similar spelling.
fn meant(text: &str) -> Option<String> {
    let word = text.to_ascii_lowercase();
    let exponent = word.trim_start_matches("gamma").trim_start_matches([':', '=', ' ']);
    if exponent.parse::<f64>().is_ok_and(|gamma| (0.1..=10.0).contains(&gamma)) {
        return Some(format!("gamma:{exponent}"));
    }
    let other = OTHER_NAMES.iter().find(|(other, _)| *other == word).map(|(_, ours)| *ours);
    other.or_else(|| nearest(&word, &TransferName::NAMES.map(|(name, _)| name))).map(str::to_owned)
}

impl TransferName {
    /// All names with a line of help, in the order of the help.
    pub const NAMES: [(&str, &str); 7] = [
        ("auto", "As the file says, else srgb; float files linear"),
        ("srgb", "sRGB's curve"),
        ("linear", "Code values are light"),
        ("bt1886", "Video: BT.1886, a gamma of 2.4"),
        ("pq", "HDR video: PQ, SMPTE ST 2084"),
        ("hlg", "HDR video: HLG"),
        ("gamma:2.2", "Any gamma from 0.1 to 10"),
    ];

    /// Returns the transfer function that was requested; `None` if the file decides.
    pub fn fixed(&self) -> Option<Transfer> {
        match self {
            Self::Auto => None,
            Self::Fixed(transfer) => Some(transfer.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_transfer_function_is_answered_by_what_was_meant() {
        let refused = |text: &str| text.parse::<TransferName>().unwrap_err().to_string();
        for (typed, meant) in [
            ("sRGB", "srgb"),
            ("2.2", "gamma:2.2"),
            ("gamma2.4", "gamma:2.4"),
            ("gamma=1.8", "gamma:1.8"),
            ("gamma", "gamma:2.2"),
            ("rec709", "bt1886"),
            ("linaer", "linear"),
        ] {
            let message = refused(typed);
            let expected = format!("unknown transfer function '{typed}'; did you mean '{meant}'? There are auto");
            assert!(message.starts_with(&expected), "{message}");
        }
        assert!(refused("gamma:0").starts_with("unknown transfer function 'gamma:0'; did you mean 'gamma:2.2'?"));
        for (name, _) in TransferName::NAMES {
            assert_eq!(name.parse::<TransferName>().unwrap().to_string(), name);
        }
        for (_, ours) in OTHER_NAMES {
            assert!(ours.parse::<TransferName>().is_ok(), "{ours}");
        }
    }
}
