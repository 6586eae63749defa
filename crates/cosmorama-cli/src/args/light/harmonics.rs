use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum, ValueHint};
use cosmorama::lighting::{HIGHEST_ORDER, HarmonicBasis, HarmonicKind, HarmonicPreset, HarmonicWindow};
use cosmorama_convert::{Conversion, Name};
use cosmorama_spec::Missing;

use super::world::WorldArgs;
use crate::args::with_examples;
use crate::parse::file;

/// Commands that the help of `light harmonics` shows.
pub(super) const HARMONICS_EXAMPLES: [&str; 4] = [
    "cosmorama light harmonics sky.hdr light.json",
    "cosmorama light harmonics 'faces/{face}.exr' light.csv --order 4 --basis yup",
    "cosmorama light harmonics sky.exr light.json --basis filament",
    "cosmorama light harmonics sky.exr light.glsl --kind irradiance --window hanning",
];

/// Sum the spherical harmonics of a world's light, as JSON, CSV or code.
///
/// The coefficient of band l and number m is the l² + l + m-th: red, green, blue. The functions are real and orthonormal, without
/// the phase of Condon and Shortley, but where a program's preset has others. Also told: what the coefficients miss of the light, and
/// whether their sum is negative anywhere.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&HARMONICS_EXAMPLES))]
pub(crate) struct HarmonicsArgs {
    /// An image or a pattern, as convert takes it; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// A file: .json, .csv, or code: .glsl, .hlsl, .rs, .cpp, .hpp, .h
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// Highest band, 0 to 10
    #[arg(long, value_name = "N", value_parser = order, allow_negative_numbers = true, default_value = "2", help_heading = "Light")]
    pub(crate) order: usize,
    /// radiance: the light itself; irradiance: what falls on a matt surface [default: radiance, or what the preset takes]
    #[arg(long, value_enum, value_name = "KIND", hide_possible_values = true, help_heading = "Light")]
    pub(crate) kind: Option<Kind>,
    /// zup: of the world's x, y, z (+Y up, −Z front); yup: of x, −z, y; filament, three, unity, godot: as these programs take them
    ///
    /// The pole of zup's functions is the world's +Z, the back; that of yup's is the world's +Y, up. A program's preset has its axes
    /// for a panorama, its signs and its constants; docs/light.md lists them.
    #[arg(long, value_enum, value_name = "BASIS", default_value_t = Basis::Zup, hide_possible_values = true, help_heading = "Light")]
    pub(crate) basis: Basis,
    /// Weaken high bands against ringing: hanning, lanczos or lanczos:WIDTH
    ///
    /// Bands from the width on vanish. It is the order plus one, unless given, as in hanning:4.5.
    #[arg(long, value_name = "WINDOW", help_heading = "Light")]
    pub(crate) window: Option<WindowName>,
    /// What no view covers: error (default) or a colour
    #[arg(long, value_name = "COLOR", default_value = "error", hide_default_value = true, help_heading = "Light")]
    pub(crate) missing: Missing,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
}

/// What coefficients are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Kind {
    /// The light itself: a constant world of 1 gives 1
    Radiance,
    /// What falls on a matt surface: a constant world of 1 gives π
    Irradiance,
}

/// Axes, signs and constants of the functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Basis {
    /// The world's x, y and z
    Zup,
    /// The world's x, −z and y: the pole is up
    Yup,
    /// Filament's IndirectLight
    Filament,
    /// A LightProbe of three.js
    Three,
    /// Unity's SphericalHarmonicsL2
    Unity,
    /// Probes of Godot's LightmapGI
    Godot,
}

impl From<Kind> for HarmonicKind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Radiance => Self::Radiance,
            Kind::Irradiance => Self::Irradiance,
        }
    }
}

impl Basis {
    /// Returns its name.
    pub(crate) fn name(self) -> &'static str {
        let axes = if self == Self::Zup { "zup" } else { "yup" };
        self.preset().map_or(axes, HarmonicPreset::name)
    }

    /// Returns the program whose form it is, if it is one's.
    pub(crate) fn preset(self) -> Option<HarmonicPreset> {
        match self {
            Self::Zup | Self::Yup => None,
            Self::Filament => Some(HarmonicPreset::Filament),
            Self::Three => Some(HarmonicPreset::Three),
            Self::Unity => Some(HarmonicPreset::Unity),
            Self::Godot => Some(HarmonicPreset::Godot),
        }
    }

    /// Returns the axes.
    pub(crate) fn axes(self) -> HarmonicBasis {
        let plain = if self == Self::Yup { HarmonicBasis::YUp } else { HarmonicBasis::ZUp };
        self.preset().map_or(plain, HarmonicPreset::basis)
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
        args.world.conversion(args.input, args.missing)
    }
}
