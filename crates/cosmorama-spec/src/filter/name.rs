use std::fmt;
use std::str::FromStr;

use cosmorama::filter::{Classic, FilterKind, LabelRule, MipChoice};

use super::names;
use crate::WordError;

/// A filter by name: `ewa`, `ewa-pyramid`, `point`, `bilinear`, `reference[:samples=N]`, or one of the literature, such as
/// `summed-area` or `repeated-integration[:order=N]`; for labels, `labels:nearest` or `labels:vote`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilterName(pub FilterKind);

impl FilterName {
    /// All names with a line of help, in the order of the help.
    pub const NAMES: [(&str, &str); 16] = names::FILTERS;
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
            FilterKind::Classic(Classic::RepeatedIntegration { order }) if order != Classic::USUAL_ORDER => {
                write!(f, "repeated-integration:order={order}")
            }
            FilterKind::Classic(classic) => f.write_str(classic_name(classic)),
            FilterKind::Reference { samples: SAMPLES } => f.write_str("reference"),
            FilterKind::Reference { samples } => write!(f, "reference:samples={samples}"),
        }
    }
}

/// Returns the name of a filter of the literature.
fn classic_name(classic: Classic) -> &'static str {
    match classic {
        Classic::MipMap(MipChoice::Trilinear) => "mipmap",
        Classic::MipMap(MipChoice::Nearest) => "mipmap:levels=nearest",
        Classic::SummedArea => "summed-area",
        Classic::RepeatedIntegration { .. } => "repeated-integration",
        Classic::TwoPass => "two-pass",
        Classic::Catmull => "catmull",
        Classic::BlinnNewell => "blinn-newell",
        Classic::FeibushLevoyCook => "feibush-levoy-cook",
        Classic::Gangnet => "gangnet",
        Classic::EwaPaper => "ewa:paper",
        Classic::EwaInteger => "ewa:integer",
    }
}

/// Default number of sub-samples along a pixel's side.
const SAMPLES: usize = 4;

impl FromStr for FilterName {
    type Err = WordError;

    fn from_str(text: &str) -> Result<Self, WordError> {
        let samples = |text: &str| text.parse().ok().filter(|samples| (1..=64).contains(samples));
        if let Some(("repeated-integration", order)) = text.split_once(":order=") {
            let (least, most) = (Classic::ORDERS.start(), Classic::ORDERS.end());
            let known = order.parse().ok().filter(|order| Classic::ORDERS.contains(order));
            return known.map(|order| Self(FilterKind::Classic(Classic::RepeatedIntegration { order }))).ok_or_else(
                || WordError::Parameter(format!("order={order}: expected a number from {least} to {most}")),
            );
        }
        match text.split_once(":samples=") {
            Some(("reference", count)) => match samples(count) {
                Some(samples) => Ok(Self(FilterKind::Reference { samples })),
                None => Err(WordError::Parameter(format!("samples={count}: expected a number from 1 to 64"))),
            },
            _ => match text {
                "ewa" => Ok(Self(FilterKind::Ewa)),
                "ewa-pyramid" => Ok(Self(FilterKind::EwaPyramid)),
                "point" => Ok(Self(FilterKind::Point)),
                "bilinear" => Ok(Self(FilterKind::Bilinear)),
                "labels:nearest" => Ok(Self(FilterKind::Labels(LabelRule::Nearest))),
                "labels:vote" => Ok(Self(FilterKind::Labels(LabelRule::Vote))),
                "reference" => Ok(Self(FilterKind::Reference { samples: SAMPLES })),
                _ => {
                    let named = Classic::ALL.into_iter().find(|classic| classic_name(*classic) == text);
                    named.map(|classic| Self(FilterKind::Classic(classic))).ok_or_else(|| names::no_filter(text))
                }
            },
        }
    }
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
        assert!(refused("point:samples=3").contains("only reference takes a key"));
        assert!(refused("repeated-integration:order=9").contains("from 1 to 4"));
        assert!(refused("reference:samples=99").contains("from 1 to 64"));
    }

    #[test]
    fn every_name_is_parsed_and_printed() {
        let names = FilterName::NAMES.map(|(name, _)| name);
        for name in names.into_iter().chain(["labels:nearest", "labels:vote", "repeated-integration:order=3"]) {
            assert_eq!(name.parse::<FilterName>().unwrap().to_string(), name);
        }
    }
}
