//! Arguments of `shade`: things under a world.

mod material;
mod names;

use std::path::PathBuf;

use clap::{Args, ValueHint};
use cosmorama::sphere::Angle;
use cosmorama_convert::Name;
use cosmorama_io::FrameList;
use cosmorama_spec::{DepthName, FilterName, KernelName, Missing, Size, Spec, TransferName};

use super::convert::{LimitArgs, OutputArgs, frame_list};
use super::with_examples;
use crate::parse::file;
use crate::parse::listed::{self, Listed};
use crate::parse::number::{crease, distance, factor};

pub(crate) use material::MaterialName;
pub(crate) use names::{
    BackgroundName, ByColour, CameraName, ChromeTable, HighlightName, ObjectName, OcclusionName, PartName, Point,
    RefractName, WallsName,
};

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 7] = [
    "cosmorama shade sky.hdr ball.png --object sphere",
    "cosmorama shade sky.hdr teapot.png --object teapot.obj --size 1920x1080",
    "cosmorama shade 'faces/{face}.png' plate4.png --object plate4 --size 1024x512",
    "cosmorama shade sky.hdr row.exr --object spheres:7 --size 1400x300",
    "cosmorama shade sky.hdr matt.png --material matte --background transparent",
    "cosmorama shade none chrome.png --material chrome --background black",
    "cosmorama shade sky.hdr dome.png --camera fulldome:tilt=20 --eye 0,0,3",
];

/// Put mirrors and matt things under a world.
///
/// Things see the world, and not one another. A pixel is dc·D + sc·S: D is the light that falls on a matt surface, S the world
/// averaged over all that the pixel reflects.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
#[command(after_help = "docs/objects.md has the conventions, docs/scenes.md the keys of scene files")]
pub(crate) struct ShadeArgs {
    /// The world: an image, a pattern, builtin:NAME, or none for chrome; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) world: Name,
    /// An image, by its extension
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) output: Name,
    /// sphere (default), spheres:N, plate4 or a model: FILE.obj, .gltf, .glb
    ///
    /// Spheres have a radius of 1. spheres:N is a row from rough to smooth; plate4 is the paper's: matt, mixed, mirror.
    /// Models stand where their files place them.
    #[arg(long, value_name = "NAME", default_value = "sphere", value_parser = Listed::<ObjectName>::new(ObjectName::NAMES), hide_possible_values = true, hide_default_value = true, help_heading = "Things")]
    pub(crate) object: ObjectName,
    /// Make a model's normals smooth over edges up to this angle; 0: flat [default: the file's own, or 40]
    #[arg(long, value_name = "DEGREES", value_parser = crease, allow_negative_numbers = true, hide_short_help = true, help_heading = "Things")]
    pub(crate) crease: Option<Angle>,
    /// Things, materials, lights, other worlds and the camera in a file (docs/scenes.md)
    #[arg(
        long,
        value_name = "FILE.toml",
        value_hint = ValueHint::FilePath,
        hide_short_help = true,
        conflicts_with_all = ["object", "crease", "material", "texture", "dc", "sc", "alpha", "ior", "absorption", "refract", "surfaces"],
        help_heading = "Things"
    )]
    pub(crate) scene: Option<PathBuf>,
    /// mirror (default), matte, mixed, glass, chrome or KEY=VALUE,…
    ///
    /// metallic=1,roughness=0.3,color=#ffcc66 is glTF's metallic-roughness; emissive, ior and specular are others of its
    /// keys. Roughness is the root of α. Colours are names, #rrggbb, or linear light as in 1:0.8:0.3. own is what a model's file says.
    #[arg(long, value_name = "NAME", default_value = "mirror", value_parser = Listed::<MaterialName>::new(MaterialName::NAMES), hide_possible_values = true, hide_default_value = true, help_heading = "Things")]
    pub(crate) material: MaterialName,
    /// A picture on what is matt or metallic-roughness: its colour
    ///
    /// It goes around a sphere by longitude and latitude; its middle faces +Z.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, hide_short_help = true, help_heading = "Things")]
    pub(crate) texture: Option<PathBuf>,
    /// Part of the light that is scattered: dc [default: the material's]
    #[arg(long, value_name = "F", value_parser = distance, allow_negative_numbers = true, help_heading = "Things")]
    pub(crate) dc: Option<f64>,
    /// Part of the light that is reflected: sc [default: the material's]
    #[arg(long, value_name = "F", value_parser = distance, allow_negative_numbers = true, help_heading = "Things")]
    pub(crate) sc: Option<f64>,
    /// GGX roughness α of the reflection, 0 to 1 [default: 0]
    ///
    /// α is the square of the roughness that most programs show.
    #[arg(long, value_name = "A", value_parser = distance, allow_negative_numbers = true, help_heading = "Things")]
    pub(crate) alpha: Option<f64>,
    /// Index of refraction of glass [default: 1.5]
    ///
    /// Three of them, as in 1.51:1.52:1.53, are for red, green and blue: glass then spreads colours.
    #[arg(long, value_name = "N", allow_negative_numbers = true, hide_short_help = true, help_heading = "Things")]
    pub(crate) ior: Option<ByColour>,
    /// How much light glass swallows for each unit of length [default: 0]
    ///
    /// As in 0.5, or 2:0.5:0.1 for red, green and blue: light falls to exp(−0.5) of itself over a length of 1.
    #[arg(long, value_name = "A", allow_negative_numbers = true, hide_short_help = true, help_heading = "Things")]
    pub(crate) absorption: Option<ByColour>,
    /// traced (default): through the glass; bent: once, where light enters
    #[arg(
        long,
        value_enum,
        value_name = "HOW",
        hide_possible_values = true,
        hide_short_help = true,
        help_heading = "Things"
    )]
    pub(crate) refract: Option<RefractName>,
    /// Surfaces that light in glass is followed through, 2 to 64 [default: 4]
    #[arg(long, value_name = "N", allow_negative_numbers = true, hide_short_help = true, help_heading = "Things")]
    pub(crate) surfaces: Option<usize>,
    /// Colours that chrome reflects, by elevation [default: earth to sky]
    ///
    /// As in '-90=#201008;0=white;90=#102040': colours at elevations in degrees, and straight between them. WORLD may then be none.
    #[arg(long, value_name = "TABLE", allow_hyphen_values = true, hide_short_help = true, help_heading = "Things")]
    pub(crate) chrome: Option<ChromeTable>,
    /// Light that shines on chrome, YAW:PITCH or YAW:PITCH:POWER; may be given again
    ///
    /// The power is the highlight's sharpness [default: 300].
    #[arg(long, value_name = "LIGHT", allow_hyphen_values = true, hide_short_help = true, help_heading = "Things")]
    pub(crate) highlight: Vec<HighlightName>,
    /// A world of its own for a part, NAME=WORLD; may be given again
    ///
    /// The spheres of a row are sphere1, sphere2 and so on.
    #[arg(long, value_name = "NAME=WORLD", hide_short_help = true, help_heading = "World")]
    pub(crate) part: Vec<PartName>,
    /// none (default), or ambient: things keep light from what is matt
    ///
    /// Rays tell what part of the light that falls on a place is hidden by things. Slow: 64 rays for each.
    #[arg(
        long,
        value_enum,
        value_name = "HOW",
        default_value = "none",
        hide_possible_values = true,
        hide_default_value = true,
        hide_short_help = true,
        help_heading = "Things"
    )]
    pub(crate) occlusion: OcclusionName,
    /// Walls that stand for a near world: box:X,Y,Z or sphere:RADIUS
    ///
    /// A reflected ray is met with them, and the world is looked up in the direction of that place from --centre.
    #[arg(long, value_name = "WALLS", hide_short_help = true, help_heading = "World")]
    pub(crate) proxy: Option<WallsName>,
    /// Point from which the world's picture was taken [default: 0,0,0]
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        requires = "proxy",
        hide_short_help = true,
        help_heading = "World"
    )]
    pub(crate) centre: Option<Point>,
    /// The world's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "World")]
    pub(crate) from: Option<Spec>,
    /// ewa-pyramid (default), ewa, bilinear, point, reference
    ///
    /// How what mirrors reflect is averaged:
    ///   ewa-pyramid  texels under an ellipse, of smaller copies if it is large
    ///   ewa          all texels under the ellipse: sharper, for stills
    ///   bilinear     the four nearest texels: fast, but flickers
    ///   point        the nearest texel
    ///   reference    many samples of the pixel, to judge others by
    /// The other filters of convert go there, too (docs/filters.md).
    #[arg(long, verbatim_doc_comment, value_name = "FILTER", default_value = "ewa-pyramid", value_parser = listed::filter(), hide_possible_values = true, hide_default_value = true, help_heading = "World")]
    pub(crate) reflect: FilterName,
    /// adaptive (default), mitchell, lanczos3, …
    #[arg(long, value_name = "NAME", default_value = "adaptive", value_parser = listed::kernel(), hide_possible_values = true, hide_default_value = true, hide_short_help = true, help_heading = "World")]
    pub(crate) kernel: KernelName,
    /// What no view covers: error (default), transparent or a colour
    #[arg(
        long,
        value_name = "COLOR",
        default_value = "error",
        hide_default_value = true,
        hide_short_help = true,
        help_heading = "World"
    )]
    pub(crate) missing: Missing,
    /// How integer code values relate to light: auto (default), srgb, linear, …
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true, hide_short_help = true, help_heading = "World")]
    pub(crate) transfer: TransferName,
    /// Which frame of several
    #[arg(long, value_name = "N", value_parser = frame_list, allow_hyphen_values = true, hide_short_help = true, help_heading = "World")]
    pub(crate) frames: Option<FrameList>,
    /// perspective:fov=40 (default), orthographic:height=H, `gltf[:NAME]` or any SPEC
    ///
    /// gltf is the first camera of a model's file, gltf:NAME one by its name.
    #[arg(long, value_name = "CAMERA", value_parser = names::camera(), hide_possible_values = true, help_heading = "Picture")]
    pub(crate) camera: Option<CameraName>,
    /// Place of the eye [default: before the things, on +Z]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) eye: Option<Point>,
    /// Point that the camera looks at [default: the middle of the things]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) target: Option<Point>,
    /// The picture's pixels: WxH, or the width [default: 640]
    #[arg(long, value_name = "WxH|N", allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) size: Option<Size>,
    /// world (default), transparent or a colour
    #[arg(long, value_name = "COLOR", help_heading = "Picture")]
    pub(crate) background: Option<BackgroundName>,
    /// A world behind the things, in place of the one that they stand under
    ///
    /// Named like WORLD; builtin:NAME, too. Both are seen by the same camera.
    #[arg(long, value_name = "WORLD", value_hint = ValueHint::FilePath, value_parser = file::name(), conflicts_with = "background", hide_short_help = true, help_heading = "Picture")]
    pub(crate) backdrop: Option<Name>,
    /// The backdrop's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, requires = "backdrop", hide_short_help = true, help_heading = "Picture")]
    pub(crate) backdrop_from: Option<Spec>,
    /// As many pictures of a whole turn of the things, turn_####.png
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000), hide_short_help = true, help_heading = "Picture")]
    pub(crate) turntable: Option<u64>,
    /// Multiply the picture's light
    #[arg(long, value_name = "FACTOR", value_parser = factor, default_value_t = 1.0, allow_negative_numbers = true, hide_short_help = true, help_heading = "Picture")]
    pub(crate) gain: f32,
    /// Output sample type [default: 8 bits, or half floats]
    #[arg(long, value_parser = listed::depth(), value_name = "DEPTH", hide_short_help = true, help_heading = "Picture")]
    pub(crate) depth: Option<DepthName>,
    #[command(flatten, next_help_heading = "Files")]
    pub(crate) file: OutputArgs,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print a machine-readable report on standard output
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}
