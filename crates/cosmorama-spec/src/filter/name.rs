use std::fmt;
use std::str::FromStr;

use cosmorama::filter::FilterKind;

/// Filter by name: `ewa`, `ewa-pyramid`, `point`, `bilinear` or `reference[:samples=N]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilterName(pub FilterKind);

impl fmt::Display for FilterName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            FilterKind::Ewa => f.write_str("ewa"),
            FilterKind::EwaPyramid => f.write_str("ewa-pyramid"),
            FilterKind::Point => f.write_str("point"),
            FilterKind::Bilinear => f.write_str("bilinear"),
            FilterKind::Reference { samples: SAMPLES } => f.write_str("reference"),
            FilterKind::Reference { samples } => write!(f, "reference:samples={samples}"),
        }
    }
}

/// Default number of sub-samples along a pixel's side.
const SAMPLES: usize = 4;

impl FromStr for FilterName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let samples = |text: &str| text.parse().ok().filter(|samples| (1..=64).contains(samples));
        match text.split_once(":samples=") {
            Some(("reference", count)) => match samples(count) {
                Some(samples) => Ok(Self(FilterKind::Reference { samples })),
                None => Err(format!("samples={count}: expected a number from 1 to 64")),
            },
            _ => match text {
                "ewa" => Ok(Self(FilterKind::Ewa)),
                "ewa-pyramid" => Ok(Self(FilterKind::EwaPyramid)),
                "point" => Ok(Self(FilterKind::Point)),
                "bilinear" => Ok(Self(FilterKind::Bilinear)),
                "reference" => Ok(Self(FilterKind::Reference { samples: SAMPLES })),
                _ => Err("there are ewa, ewa-pyramid, point, bilinear and reference[:samples=N]".to_owned()),
            },
        }
    }
}
