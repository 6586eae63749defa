use clap::{Args, ValueEnum, ValueHint};
use cosmorama::raster::Depth;
use cosmorama_convert::{Conversion, GeometrySettings, LightScale, Name};
use cosmorama_spec::{DepthName, Missing, Size, Spec, TransferName};

use super::lobe::LobeName;
use super::roughness::RoughnessMapName;
use crate::args::convert::{FilesArgs, FramesAsked, RunArgs, TurnArgs, existing};
use crate::args::with_examples;
use crate::parse::file;
use crate::parse::listed::{self, Listed};
use crate::parse::number::every;

/// Example commands in the help of `light diffuse`.
pub(super) const DIFFUSE_EXAMPLES: [&str; 5] = [
    "cosmorama light diffuse sky.hdr light.exr",
    "cosmorama light diffuse sky.exr 'light/{face}.exr' --size 32",
    "cosmorama light diffuse sky.png light.png --to mercator --normalise radiance",
    "cosmorama light diffuse dome.exr light.exr --from fulldome --missing black",
    "cosmorama light diffuse 'sky.####.exr' 'light.####.exr' --every 10",
];

/// Example commands in the help of `light specular`.
pub(super) const SPECULAR_EXAMPLES: [&str; 5] = [
    "cosmorama light specular sky.exr rough.exr --alpha 0.25 --size 256",
    "cosmorama light specular sky.exr 'rough/{face}.exr' --alpha 0.5",
    "cosmorama light specular sky.exr glossy.exr --lobe phong:64 --to mercator",
    "cosmorama light specular sky.exr chain.ktx2 --levels 5 --size 256 --roughness-map filament",
    "cosmorama light specular sky.exr 'rough_{level}.exr' --alpha 0,0.05,0.2,0.6 --size 512",
];

/// Make a map of the light that falls on a matt surface, by the direction that it faces.
///
/// E(n) = ∫ L(ω) max(0, n·ω) dω, by the solid angles of texels.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&DIFFUSE_EXAMPLES))]
pub(crate) struct DiffuseArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// irradiance: E (a world of 1 gives π); radiance: E/π (1)
    #[arg(long, value_enum, value_name = "UNIT", default_value_t = Unit::Irradiance, hide_possible_values = true, help_heading = "Light")]
    pub(crate) normalise: Unit,
    /// Compute each Nth frame and the last, and interpolate the others between
    #[arg(long, value_name = "N", value_parser = every, allow_negative_numbers = true, conflicts_with = "resume", help_heading = "Frames and files")]
    pub(crate) every: Option<usize>,
    /// Compute a frame in the middle of each gap, too, and tell how far the interpolated one is from it
    #[arg(long, requires = "every", help_heading = "Frames and files")]
    pub(crate) every_error: bool,
}

/// Make a map of what a glossy surface reflects, by the mirror direction.
///
/// Each pixel is the average of the world's light under a lobe about its direction: a world of 1 gives 1. Normal, view and mirror
/// direction are one (N = V = R).
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&SPECULAR_EXAMPLES))]
pub(crate) struct SpecularArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// ggx (default), charlie, phong:N or blinn:N
    ///
    /// ggx weighs each direction by D(h)·(n·l), charlie too, with the distribution of cloth; phong by cosᴺ θ, blinn by
    /// cosᴺ(θ/2)·cos θ.
    #[arg(long, value_name = "LOBE", default_value = "ggx", value_parser = Listed::<LobeName>::new(LobeName::NAMES), hide_possible_values = true, hide_default_value = true, help_heading = "Light")]
    pub(crate) lobe: LobeName,
    /// Roughness α of ggx and charlie, 0.001 to 1, or 0 for a mirror; several, as in 0,0.1,0.4,1, make a chain
    ///
    /// α is the square of the roughness that most programs show.
    #[arg(long, value_name = "A", value_delimiter = ',', allow_negative_numbers = true, help_heading = "Light")]
    pub(crate) alpha: Vec<f64>,
    /// Make a chain of N maps, each of half the size: a mirror first, then rougher and rougher
    ///
    /// One KTX 2, KTX or DDS file holds all as mip levels of a cube, one OpenEXR file those of a panorama; in other formats, OUTPUT has
    /// {level} where the number of a level stands, from 0.
    #[arg(long, value_name = "N", value_parser = levels, allow_negative_numbers = true, help_heading = "Light")]
    pub(crate) levels: Option<usize>,
    /// How α grows along a chain: linear, squared (default), filament, gltf, unreal, three
    ///
    /// linear: α = level/(N−1). squared and gltf: α = roughness², roughness = level/(N−1). filament: α = roughness², roughness =
    /// 1 − √(1 − level/(N−1)). unreal, three: α = roughness², roughness by the size of faces, as these programs read it.
    #[arg(long, value_enum, value_name = "MAP", hide_possible_values = true, help_heading = "Light")]
    pub(crate) roughness_map: Option<RoughnessMapName>,
    /// lobes: averages under the lobe; mipmap: plain mip maps of the faces, as in 1986
    #[arg(long, value_enum, value_name = "METHOD", default_value_t = Method::Lobes, hide_possible_values = true, help_heading = "Light")]
    pub(crate) method: Method,
}

/// Way to make the levels of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Averages under the lobe of each level
    #[value(alias = "exact")]
    Lobes,
    /// Means of two by two pixels of the level before (Greene 1986, section 7)
    Mipmap,
}

fn scale(text: &str) -> Result<LightScale, String> {
    if text == "auto" {
        return Ok(LightScale::Fitting);
    }
    // Light is of single precision.
    let is_scale = |factor: &f64| *factor > 0.0 && (*factor as f32).is_normal();
    let factor = text.parse().ok().filter(is_scale);
    factor.map(LightScale::Factor).ok_or_else(|| "expected auto, or a factor more than 0, as in 0.25".to_owned())
}

fn levels(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(levels @ 1..=16) => Ok(levels),
        _ => Err("expected a number from 1 to 16".to_owned()),
    }
}

/// Unit of a diffuse map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Unit {
    /// E: a constant world of 1 gives π
    Irradiance,
    /// E/π: a constant world of 1 gives 1
    Radiance,
}

/// World and files of a map of light, and the options that both kinds of map share.
#[derive(Clone, Debug, Args)]
pub(crate) struct MapArgs {
    /// An image or a pattern, as convert takes it; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// An image or a pattern, by its extension
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) output: Name,
    /// The input's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// The map's projection [default: equirect, or cube for {face}]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) to: Option<Spec>,
    /// The map's pixels: WxH, or the width [default: 64; faces 32]
    #[arg(long, value_name = "WxH|N", allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) size: Option<Size>,
    #[command(flatten)]
    pub(crate) turn: TurnArgs,
    /// Sum every texel for every pixel
    ///
    /// The default takes together texels over which the lobe hardly bends; docs/light.md says how near it is.
    #[arg(long, help_heading = "Light")]
    pub(crate) exact: bool,
    /// Write the light times FACTOR, or auto: times the power of two with which all of it fits
    ///
    /// Half floats end at 65504, and integers at 1. The file says what it was, lightScale, where it has a place for that.
    #[arg(long, value_name = "auto|FACTOR", value_parser = scale, allow_negative_numbers = true, default_value = "1", hide_default_value = true, help_heading = "Light")]
    pub(crate) scale: LightScale,
    /// What no view covers: error (default), transparent or a colour
    #[arg(long, value_name = "COLOR", default_value = "error", hide_default_value = true, help_heading = "Light")]
    pub(crate) missing: Missing,
    /// How integer code values relate to light: auto (default), srgb, linear, …
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true, help_heading = "Light")]
    pub(crate) transfer: TransferName,
    /// Output sample type [default: the deepest of the format]
    #[arg(long, value_parser = listed::depth(), value_name = "DEPTH", help_heading = "Light")]
    pub(crate) depth: Option<DepthName>,
    #[command(flatten)]
    pub(crate) files: FilesArgs,
    #[command(flatten)]
    pub(crate) run: RunArgs,
}

impl From<MapArgs> for Conversion {
    fn from(args: MapArgs) -> Self {
        let (frames, times) = FramesAsked::parted(args.files.frames);
        Self {
            input: args.input,
            output: args.output,
            geometry: GeometrySettings {
                from: args.from,
                to: args.to,
                size: args.size,
                orientation: args.turn.into(),
                ..GeometrySettings::default()
            },
            transfer: args.transfer,
            depth: args.depth.map(Depth::from),
            missing: args.missing,
            frames,
            times,
            existing: existing(args.files.overwrite, args.files.resume),
            make_folders: !args.files.no_mkdir,
            limits: args.run.limits.into(),
            ..Self::default()
        }
    }
}
