use clap::Args;
use cosmorama_spec::{FilterName, KernelName, Size, Spec};

use super::parse::number::degrees;

/// What light comes from where and goes where: shared by `convert` and `explain`.
#[derive(Clone, Debug, Args)]
pub(crate) struct GeometryArgs {
    /// The input's projection [default: found from metadata, face pattern or shape]
    #[arg(long, value_name = "SPEC", help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// The output's projection [default: cube, if the output has {face} or %c]
    #[arg(long, value_name = "SPEC", help_heading = "Geometry")]
    pub(crate) to: Option<Spec>,
    /// Output pixels; N is the width, or the edge of a face, or the width of one circle or of one eye's picture before it
    /// is squeezed, where several share the image [default: parity with the input at the centre]
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
    /// ewa, ewa-pyramid (from smaller copies where a pixel holds many: bounded time, about 40 dB from ewa), point, bilinear or
    /// reference[:samples=N]
    #[arg(long, value_name = "NAME", default_value = "ewa", help_heading = "Filter")]
    pub(crate) filter: FilterName,
    /// adaptive, gaussian[:alpha=2,cutoff=1], mitchell, robidoux, robidoux-sharp, catmull-rom, lanczos2, lanczos3,
    /// lanczos3-sharp, tent, box, or light, which keeps the light of suns; each takes scale= (its unit in output pixels) and
    /// floor= (at least, in texels)
    #[arg(long, value_name = "NAME[:k=v]", default_value = "adaptive", help_heading = "Filter")]
    pub(crate) kernel: KernelName,
    /// Clamp to the texels under the pixel, but for slopes that go on to a rim where all texels confirm them: on, unless the
    /// kernel is light
    #[arg(long, value_name = "on|off", action = clap::ArgAction::Set, value_parser = on_or_off, help_heading = "Filter")]
    pub(crate) anti_ringing: Option<bool>,
}

fn on_or_off(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("expected on or off".to_owned()),
    }
}
