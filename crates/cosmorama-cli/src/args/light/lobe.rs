use std::str::FromStr;

use cosmorama::lighting::Lobe;

/// Name of a lobe, as in `ggx`, `phong:64`, `blinn:32` or `charlie`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LobeName {
    Ggx,
    Charlie,
    Phong(f64),
    Blinn(f64),
}

impl LobeName {
    /// Names for help and completions.
    pub(crate) const NAMES: [(&'static str, &'static str); 4] = [
        ("ggx", "microfacets, as renderers have them; --alpha is its roughness"),
        ("phong:64", "Phong's cosine to a power, about the mirror direction"),
        ("blinn:64", "Blinn's cosine of the half angle to a power, times n·l"),
        ("charlie", "cloth; --alpha is its roughness"),
    ];

    /// Returns the lobe with a roughness α, which lobes with an exponent do not have.
    pub(crate) fn lobe(self, alpha: Option<f64>) -> Result<Lobe, String> {
        let rough =
            || alpha.ok_or("--alpha is missing: give the roughness α, 0.001 to 1, as in --alpha 0.25".to_owned());
        let without = |exponent: f64| match alpha {
            Some(_) => Err("--alpha is for ggx and charlie; an exponent says how sharp phong and blinn are".to_owned()),
            None => Ok(exponent),
        };
        let lobe = match self {
            Self::Ggx => Lobe::ggx(rough()?),
            Self::Charlie => Lobe::charlie(rough()?),
            Self::Phong(exponent) => Lobe::phong(without(exponent)?),
            Self::Blinn(exponent) => Lobe::blinn(without(exponent)?),
        };
        lobe.map_err(|error| format!("--lobe, --alpha: {error}"))
    }
}

impl FromStr for LobeName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, exponent) = text.split_once(':').map_or((text, None), |(name, exponent)| (name, Some(exponent)));
        let power = || {
            let number = exponent.and_then(|exponent| exponent.parse::<f64>().ok()).filter(|number| *number >= 0.0);
            number.ok_or_else(|| format!("{name} needs an exponent, as in {name}:64"))
        };
        match name {
            "phong" => power().map(Self::Phong),
            "blinn" => power().map(Self::Blinn),
            "ggx" | "charlie" if exponent.is_some() => {
                Err(format!("{name} has no exponent; its roughness is --alpha, as in --lobe {name} --alpha 0.25"))
            }
            "ggx" => Ok(Self::Ggx),
            "charlie" => Ok(Self::Charlie),
            _ => Err("expected ggx, charlie, phong:N or blinn:N".to_owned()),
        }
    }
}
