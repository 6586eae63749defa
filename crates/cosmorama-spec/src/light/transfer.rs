use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Transfer;

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
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let transfer = match text {
            "auto" => return Ok(Self::Auto),
            "srgb" => Transfer::Srgb,
            "linear" => Transfer::Linear,
            "bt1886" => Transfer::Bt1886,
            "pq" => Transfer::Pq,
            "hlg" => Transfer::Hlg,
            _ => match text.strip_prefix("gamma:").and_then(|gamma| gamma.parse().ok()) {
                Some(gamma) if (0.1..=10.0).contains(&gamma) => Transfer::Gamma(gamma),
                _ => {
                    return Err(
                        "there are auto, srgb, linear, bt1886, pq, hlg and gamma:G (G from 0.1 to 10, as in gamma:2.2)"
                            .to_owned(),
                    );
                }
            },
        };
        Ok(Self::Fixed(transfer))
    }
}

impl TransferName {
    /// Returns the transfer function that was requested; `None` if the file decides.
    pub fn fixed(&self) -> Option<Transfer> {
        match self {
            Self::Auto => None,
            Self::Fixed(transfer) => Some(transfer.clone()),
        }
    }
}
