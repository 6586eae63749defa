use clap::builder::{NonEmptyStringValueParser, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};
use cosmorama::filter::LabelRule;
use cosmorama::motion::{Easing, Ramp, ShutterCurve, Smoothness};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_convert::BlurMethod;
use cosmorama_spec::{FilterName, FrameRate, KernelName, Size, Spec};

use crate::parse::listed;
use crate::parse::number::{degrees, ramp, zoom};

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
    ///
    /// Or over the frames: A..B turns from A in the first frame to B in the last, as in --yaw 0..360 --frames 1-240: any number of whole turns, evenly
    /// unless --easing is given. With a still input, --frames says which frames are made.
    #[arg(long, value_name = "D", default_value = "0", value_parser = ramp, allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) yaw: Ramp,
    /// Turn the output up
    #[arg(long, value_name = "D", default_value = "0", value_parser = ramp, allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) pitch: Ramp,
    /// Turn the output's camera clockwise
    #[arg(long, value_name = "D", default_value = "0", value_parser = ramp, allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) roll: Ramp,
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
    /// The weights of that average: adaptive, gaussian[:alpha=2,cutoff=1,table=2048], mitchell, robidoux, robidoux-sharp, catmull-rom,
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

/// Turn of the camera of one picture.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct TurnArgs {
    /// Turn the output to the right, in degrees
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, hide_short_help = true, help_heading = "Geometry")]
    yaw: f64,
    /// Turn the output up
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, hide_short_help = true, help_heading = "Geometry")]
    pitch: f64,
    /// Turn the output's camera clockwise
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, hide_short_help = true, help_heading = "Geometry")]
    roll: f64,
}

impl From<TurnArgs> for Orientation {
    fn from(turn: TurnArgs) -> Self {
        let [yaw, pitch, roll] = [turn.yaw, turn.pitch, turn.roll].map(Angle::from_degrees);
        Self::from_yaw_pitch_roll(yaw, pitch, roll)
    }
}

/// Movement of the output's camera.
#[derive(Clone, Debug, Args)]
pub(crate) struct CameraArgs {
    /// Poses of a moving camera by frame: CSV or JSON
    ///
    /// Columns frame, yaw, pitch and roll in degrees, and fov if that changes; or frame, qw, qx, qy and qz: the rotation from the
    /// camera's frame (x right, y up, z back) to the world's. Frames between are interpolated on the sphere. A still input is
    /// converted to all frames of the path, or to those of --frames (docs/motion.md).
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = NonEmptyStringValueParser::new(), conflicts_with_all = ["yaw", "pitch", "roll", "fov", "easing"], help_heading = "Geometry")]
    pub(crate) path: Option<String>,
    /// Poses of the input by frame, as those of --path: it is turned frame by frame
    ///
    /// A camera's own motion steadies its pictures: its poses, as its gyroscope measured them, put each frame where it was taken.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = NonEmptyStringValueParser::new(), hide_short_help = true, help_heading = "Geometry")]
    pub(crate) in_path: Option<String>,
    /// Frames a second: of a video that is made [default: as the input, or 30], and where a path has time instead of frame
    ///
    /// As in 25, 30000/1001 or 29.97.
    #[arg(long, value_name = "N", allow_hyphen_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) fps: Option<FrameRate>,
    /// From pose to pose of a path: slerp (default), or smooth, whose rate does not jump
    #[arg(long, value_name = "CURVE", value_parser = path_curve(), hide_possible_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) path_curve: Option<Smoothness>,
    /// Zoom from one field of view to another over the frames: A..B
    ///
    /// Measured as that of --to, which it replaces: of perspective (fov, vfov or dfov), pannini, fisheye, fulldome and
    /// stereographic.
    #[arg(long, value_name = "A..B", value_parser = zoom, allow_hyphen_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) fov: Option<Ramp>,
    /// Rate of a turn A..B: linear (default), in (from rest), out (to rest), in-out
    #[arg(long, value_name = "HOW", value_parser = easing(), hide_possible_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) easing: Option<Easing>,
}

/// Motion blur.
#[derive(Clone, Debug, Args)]
pub(crate) struct ShutterArgs {
    /// Motion blur: how long each frame is exposed
    ///
    /// A fraction of the time from frame to frame: 0.5 is a shutter of 180°. It is centred on the frame's time, unless --shutter-phase says otherwise. A path may begin before
    /// the first frame and end after the last one; else the camera goes on as it moves there.
    #[arg(long, value_name = "F", value_parser = shutter, allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) shutter: Option<f64>,
    /// Part of the exposure that comes before the frame's time: centre (default), leading, trailing or 0 to 1
    ///
    /// leading is 0, from the frame's time on; trailing is 1, up to it.
    #[arg(long, value_name = "P", value_parser = phase, allow_hyphen_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) shutter_phase: Option<f64>,
    /// Light that passes: box (default), trapezoid (opens and closes in a quarter each), cosine
    #[arg(long, value_name = "CURVE", value_parser = shutter_curve(), hide_possible_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) shutter_curve: Option<ShutterCurve>,
    /// Way to blur: swept (default), each pixel along its own path; ellipse, fast and soft; none
    #[arg(long, value_name = "HOW", value_parser = motion(), hide_possible_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) motion: Option<MotionKind>,
}

/// Way to blur.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MotionKind {
    /// No blur.
    None,
    /// Blur by a method.
    By(BlurMethod),
}

/// Reads the time for which a shutter is open.
fn shutter(text: &str) -> Result<f64, String> {
    const LONGEST: f64 = 10.0;
    let is_fraction = |fraction: &f64| (0.0..=LONGEST).contains(fraction);
    text.parse().ok().filter(is_fraction).ok_or_else(|| {
        "expected a fraction of the time from frame to frame, from 0 to 10, as 0.5 for a shutter of 180°".to_owned()
    })
}

/// Reads the place of an exposure.
fn phase(text: &str) -> Result<f64, String> {
    match text {
        "centre" | "center" => Ok(0.5),
        "leading" => Ok(0.0),
        "trailing" => Ok(1.0),
        _ => text.parse().ok().filter(|part| (0.0..=1.0).contains(part)).ok_or_else(|| {
            "expected centre, leading, trailing, or the part of the exposure before the frame's time, from 0 to 1"
                .to_owned()
        }),
    }
}

/// Reads the light that a shutter lets through.
fn shutter_curve() -> impl TypedValueParser<Value = ShutterCurve> {
    let curve = |word: String| match word.as_str() {
        "trapezoid" => ShutterCurve::Trapezoid,
        "cosine" => ShutterCurve::Cosine,
        _ => ShutterCurve::Box,
    };
    PossibleValuesParser::new(["box", "trapezoid", "cosine"]).map(curve)
}

/// Reads a way to blur.
fn motion() -> impl TypedValueParser<Value = MotionKind> {
    let kind = |word: String| match word.as_str() {
        "none" => MotionKind::None,
        "ellipse" => MotionKind::By(BlurMethod::Ellipse),
        _ => MotionKind::By(BlurMethod::Swept),
    };
    PossibleValuesParser::new(["swept", "ellipse", "none"]).map(kind)
}

/// Reads the way from pose to pose.
fn path_curve() -> impl TypedValueParser<Value = Smoothness> {
    let curve = |word: String| if word == "smooth" { Smoothness::Smooth } else { Smoothness::Slerp };
    PossibleValuesParser::new(["slerp", "smooth"]).map(curve)
}

/// Reads the rate of a turn.
fn easing() -> impl TypedValueParser<Value = Easing> {
    let easing = |word: String| match word.as_str() {
        "in" => Easing::In,
        "out" => Easing::Out,
        "in-out" => Easing::InOut,
        _ => Easing::Linear,
    };
    PossibleValuesParser::new(["linear", "in", "out", "in-out"]).map(easing)
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
