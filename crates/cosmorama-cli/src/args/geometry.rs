use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use cosmorama::filter::LabelRule;
use cosmorama_spec::{FilterName, KernelName, Size, Spec};

use super::parse::listed;
use super::parse::number::degrees;

/// Geometry and filter of a conversion, shared by `convert` and `explain`.
#[derive(Clone, Debug, Args)]
pub(crate) struct GeometryArgs {
    /// The input's projection [default: found]
    ///
    /// Unless given, it is found from metadata, face pattern or shape.
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// The output's projection, as in fulldome:tilt=20
    ///
    /// Unless given, it is a cube where the output has {face} or %c.
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) to: Option<Spec>,
    /// Output pixels: 1966x1436, or the width: 4096, 4k
    ///
    /// N is the width, or the edge of a face, or the width of one circle or of one eye's picture before it is squeezed, where
    /// several share the image; 4k is 4096. Unless given, it is parity with the input at the centre.
    #[arg(long, value_name = "WxH|N", allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) size: Option<Size>,
    /// Turn the output to the right, in degrees
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) yaw: f64,
    /// Turn the output up
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) pitch: f64,
    /// Turn the output's camera clockwise
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) roll: f64,
    /// ewa (default), ewa-pyramid, point, bilinear, reference
    ///
    /// What a pixel averages: ewa all that it sees; ewa-pyramid the same from smaller copies where it holds many texels, in
    /// bounded time, about 40 dB from ewa; reference N by N samples (reference:samples=N).
    #[arg(long, value_name = "NAME", default_value = "ewa", value_parser = listed::filter(), hide_possible_values = true, hide_default_value = true, help_heading = "Filter")]
    pub(crate) filter: FilterName,
    /// Never mix values: for object numbers, classes and masks
    ///
    /// A pixel takes the value of one texel: the nearest, or the one with the most area under the pixel (vote).
    #[arg(long, value_name = "RULE", value_parser = labels(), conflicts_with_all = ["filter", "kernel", "anti_ringing"], hide_short_help = true, help_heading = "Filter")]
    pub(crate) labels: Option<LabelRule>,
    /// adaptive (default), mitchell, lanczos3, light, …
    ///
    /// The weights of that average: adaptive, gaussian[:alpha=2,cutoff=1], mitchell, robidoux, robidoux-sharp, catmull-rom,
    /// lanczos2, lanczos3, lanczos3-sharp, tent, box, or light, which keeps the light of suns. Each takes scale= (its unit in
    /// output pixels) and floor= (at least, in texels).
    #[arg(long, value_name = "NAME", default_value = "adaptive", value_parser = listed::kernel(), hide_possible_values = true, hide_default_value = true, help_heading = "Filter")]
    pub(crate) kernel: KernelName,
    /// Clamp to the texels under the pixel
    ///
    /// All but slopes that go on to a rim where all texels confirm them: on, unless the kernel is light.
    #[arg(long, value_name = "on|off", action = clap::ArgAction::Set, value_parser = on_or_off, hide_short_help = true, help_heading = "Filter")]
    pub(crate) anti_ringing: Option<bool>,
}

/// Reads the rule by which a pixel of labels is chosen.
fn labels() -> impl TypedValueParser<Value = LabelRule> {
    let rule = |word: String| if word == "vote" { LabelRule::Vote } else { LabelRule::Nearest };
    PossibleValuesParser::new(["nearest", "vote"]).map(rule)
}

fn on_or_off(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("expected on or off".to_owned()),
    }
}
