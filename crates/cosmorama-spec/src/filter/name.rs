use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use cosmorama::filter::{Classic, FilterKind, IntegrationOrder, LabelRule};

use super::names;
use crate::WordError;

/// A filter by name: `ewa`, `ewa-pyramid`, `point`, `bilinear`, `reference[:samples=N]`, or one of the literature, such as
/// `summed-area` or `repeated-integration[:order=N]`; for labels, `labels:nearest` or `labels:vote`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilterName(pub FilterKind);

impl FilterName {
    /// All names with a line of help, in the order of the help.
    pub const NAMES: &'static [(&'static str, &'static str)] = &names::FILTERS;
}

impl fmt::Display for FilterName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            FilterKind::Ewa => f.write_str("ewa"),
            FilterKind::EwaPyramid => f.write_str("ewa-pyramid"),
            FilterKind::Point => f.write_str("point"),
            FilterKind::Bilinear => f.write_str("bilinear"),
            FilterKind::Labels(LabelRule::Nearest) => f.write_str("labels:nearest"),
            FilterKind::Labels(LabelRule::Vote) => f.write_str("labels:vote"),
            FilterKind::Classic(Classic::RepeatedIntegration(order)) if order != IntegrationOrder::USUAL => {
                write!(f, "repeated-integration:order={}", order.get())
            }
            FilterKind::Classic(classic) => f.write_str(classic.name()),
            FilterKind::Reference { samples: SAMPLES } => f.write_str("reference"),
            FilterKind::Reference { samples } => write!(f, "reference:samples={samples}"),
        }
    }
}

/// Default number of sub-samples along a pixel's side.
const SAMPLES: usize = 4;

/// Range of the number of sub-samples along a pixel's side.
const SAMPLE_RANGE: RangeInclusive<usize> = 1..=64;

impl FromStr for FilterName {
    type Err = WordError;

    fn from_str(text: &str) -> Result<Self, WordError> {
        Ok(Self(match text {
            "ewa" => FilterKind::Ewa,
            "ewa-pyramid" => FilterKind::EwaPyramid,
            "point" => FilterKind::Point,
            "bilinear" => FilterKind::Bilinear,
            "labels:nearest" => FilterKind::Labels(LabelRule::Nearest),
            "labels:vote" => FilterKind::Labels(LabelRule::Vote),
            "reference" => FilterKind::Reference { samples: SAMPLES },
            "mipmap:levels=trilinear" => FilterKind::Classic(Classic::MipMap),
            _ => match Classic::named(text) {
                Some(classic) => FilterKind::Classic(classic),
                None => with_number(text)?,
            },
        }))
    }
}

/// Reads a filter that has a number behind its name.
fn with_number(text: &str) -> Result<FilterKind, WordError> {
    if let Some(("reference", count)) = text.split_once(":samples=") {
        let samples = count.parse().ok().filter(|samples| SAMPLE_RANGE.contains(samples));
        return samples
            .map(|samples| FilterKind::Reference { samples })
            .ok_or_else(|| parameter("samples", count, &SAMPLE_RANGE));
    }
    if let Some(("repeated-integration", count)) = text.split_once(":order=") {
        let order = count.parse().ok().and_then(IntegrationOrder::new);
        return order
            .map(|order| FilterKind::Classic(Classic::RepeatedIntegration(order)))
            .ok_or_else(|| parameter("order", count, &IntegrationOrder::RANGE));
    }
    Err(names::no_filter(text))
}

fn parameter<N: fmt::Display>(key: &str, given: &str, range: &RangeInclusive<N>) -> WordError {
    WordError::Parameter(format!("{key}={given}: expected a number from {} to {}", range.start(), range.end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_filter_is_answered_by_what_was_meant() {
        let refused = |text: &str| text.parse::<FilterName>().unwrap_err().to_string();
        assert_eq!(refused("bicubic"), "'bicubic' is no filter; that is a kernel: catmull-rom");
        assert_eq!(refused("gaussian:alpha=2"), "'gaussian:alpha=2' is no filter; that is a kernel: gaussian:alpha=2");
        assert!(refused("nearest").contains("did you mean 'point'?"));
        assert!(refused("ewa-pyramids").contains("did you mean 'ewa-pyramid'?"));
        assert!(refused("sharp").starts_with("unknown filter 'sharp'; there are ewa, ewa-pyramid"));
        assert!(refused("point:samples=3").contains("reference takes samples=N"));
        assert!(refused("ewa-pyramid:levels=nearest").contains("interpolates between two levels"));
        assert!(refused("mipmap:levels=3").ends_with("mipmap takes levels=nearest or levels=trilinear"));
        assert!(refused("ewa:fast").contains("ewa:paper"));
        assert!(refused("repeated-integration:order=9").contains("from 1 to 4"));
        assert!(refused("reference:samples=99").contains("from 1 to 64"));
    }

    #[test]
    fn every_name_is_parsed_and_printed() {
        let names = FilterName::NAMES.iter().map(|(name, _)| *name);
        for name in names.chain(["labels:nearest", "labels:vote", "repeated-integration:order=3"]) {
            assert_eq!(name.parse::<FilterName>().unwrap().to_string(), name);
        }
        let trilinear: FilterName = "mipmap:levels=trilinear".parse().unwrap();
        assert_eq!(trilinear.to_string(), "mipmap");
    }
}
