use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::NonEmptyStringValueParser;
use clap::{Args, ValueEnum, ValueHint};
use cosmorama::lighting::{HIGHEST_ORDER, HarmonicBasis, HarmonicWindow};
use cosmorama_convert::{Conversion, GeometrySettings};
use cosmorama_io::FrameList;
use cosmorama_spec::{Missing, Spec, TransferName};

use crate::args::convert::{LimitArgs, frame_list};
use crate::args::parse::listed;
use crate::args::with_examples;

/// Commands that the help of `light harmonics` shows.
pub(super) const HARMONICS_EXAMPLES: [&str; 3] = [
    "cosmorama light harmonics sky.hdr light.json",
    "cosmorama light harmonics 'faces/{face}.exr' light.json --order 4 --basis yup",
    "cosmorama light harmonics sky.exr light.json --kind irradiance --window hanning",
];

/// Sum the spherical harmonics of a world's light, as JSON.
///
/// The coefficient of band l and number m is the l² + l + m-th: red, green, blue. The functions are real and orthonormal, without
/// the phase of Condon and Shortley.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&HARMONICS_EXAMPLES))]
pub(crate) struct HarmonicsArgs {
    /// An image or a pattern, as convert takes it; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = NonEmptyStringValueParser::new())]
    pub(crate) input: String,
    /// A JSON file
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// The input's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// Highest band, 0 to 10
    #[arg(long, value_name = "N", value_parser = order, allow_negative_numbers = true, default_value = "2", help_heading = "Light")]
    pub(crate) order: usize,
    /// radiance: the light itself; irradiance: what falls on a matt surface
    #[arg(long, value_enum, value_name = "KIND", default_value_t = Kind::Radiance, hide_possible_values = true, help_heading = "Light")]
    pub(crate) kind: Kind,
    /// zup: of the world's x, y, z (+Y up, −Z front); yup: of x, −z, y
    ///
    /// The pole of zup's functions is the world's +Z, the back; that of yup's is the world's +Y, up.
    #[arg(long, value_enum, value_name = "AXES", default_value_t = Basis::Zup, hide_possible_values = true, help_heading = "Light")]
    pub(crate) basis: Basis,
    /// Weaken high bands against ringing: hanning, lanczos or lanczos:WIDTH
    ///
    /// Bands from the width on vanish. It is the order plus one, unless given, as in hanning:4.5.
    #[arg(long, value_name = "WINDOW", help_heading = "Light")]
    pub(crate) window: Option<WindowName>,
    /// What no view covers: error (default) or a colour
    #[arg(long, value_name = "COLOR", default_value = "error", hide_default_value = true, help_heading = "Light")]
    pub(crate) missing: Missing,
    /// How integer code values relate to light: auto (default), srgb, linear, …
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true, help_heading = "Light")]
    pub(crate) transfer: TransferName,
    /// Which frame of several
    #[arg(long, value_name = "N", value_parser = frame_list, allow_hyphen_values = true, help_heading = "Frames and files")]
    pub(crate) frames: Option<FrameList>,
    /// Replace an existing output
    #[arg(short = 'y', long, help_heading = "Frames and files")]
    pub(crate) overwrite: bool,
    /// Fail where the folder of the output does not exist
    #[arg(long, hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) no_mkdir: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// What coefficients are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Kind {
    /// The light itself: a constant world of 1 gives 1
    Radiance,
    /// What falls on a matt surface: a constant world of 1 gives π
    Irradiance,
}

/// Axes of the functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Basis {
    /// The world's x, y and z
    Zup,
    /// The world's x, −z and y: the pole is up
    Yup,
}

impl Kind {
    /// Returns its name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Radiance => "radiance",
            Self::Irradiance => "irradiance",
        }
    }
}

impl Basis {
    /// Returns its name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Zup => "zup",
            Self::Yup => "yup",
        }
    }
}

impl From<Basis> for HarmonicBasis {
    fn from(basis: Basis) -> Self {
        match basis {
            Basis::Zup => Self::ZUp,
            Basis::Yup => Self::YUp,
        }
    }
}

/// A window with its width, as in `hanning` or `lanczos:4`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WindowName {
    shape: WindowShape,
    width: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum WindowShape {
    Hanning,
    Lanczos,
}

impl WindowName {
    /// Returns the window for an order.
    pub(crate) fn window(self, order: usize) -> HarmonicWindow {
        let width = self.width.unwrap_or((order + 1) as f64);
        match self.shape {
            WindowShape::Hanning => HarmonicWindow::Hanning { width },
            WindowShape::Lanczos => HarmonicWindow::Lanczos { width },
        }
    }
}

impl FromStr for WindowName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, width) = text.split_once(':').map_or((text, None), |(name, width)| (name, Some(width)));
        let shape = match name {
            "hanning" => WindowShape::Hanning,
            "lanczos" => WindowShape::Lanczos,
            _ => return Err("expected hanning or lanczos, with a width as in hanning:4 if wanted".to_owned()),
        };
        let is_width = |width: &f64| width.is_finite() && *width > 0.0;
        let width = width.map(|width| {
            let number = width.parse().ok().filter(is_width);
            number.ok_or_else(|| format!("{name} needs a width more than 0, as in {name}:4"))
        });
        Ok(Self { shape, width: width.transpose()? })
    }
}

fn order(text: &str) -> Result<usize, String> {
    let order = text.parse().ok().filter(|order| *order <= HIGHEST_ORDER);
    order.ok_or_else(|| format!("expected a number from 0 to {HIGHEST_ORDER}"))
}

impl From<HarmonicsArgs> for Conversion {
    fn from(args: HarmonicsArgs) -> Self {
        Self {
            input: args.input,
            geometry: GeometrySettings { from: args.from, ..GeometrySettings::default() },
            transfer: args.transfer,
            missing: args.missing,
            frames: args.frames,
            limits: args.limits.into(),
            ..Self::default()
        }
    }
}
