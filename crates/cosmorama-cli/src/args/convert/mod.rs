mod geometry;
mod settings;
mod video;

use clap::builder::{NonEmptyStringValueParser, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};
use cosmorama_convert::{DepthKind, Name, NormalSpace, OcioSettings};
use cosmorama_io::{Compression, FrameList};
use cosmorama_spec::{
    Colour, DepthName, FrameMap, FrameRanges, FrameRangesError, MemorySize, Missing, PrimariesName, Spec, TransferName,
};

use super::{SEE_MORE, projections, with_examples};
use crate::parse::compression::CompressionParser;
use crate::parse::file;
use crate::parse::listed;
use crate::parse::progress::ProgressStyle;

pub(super) use geometry::{CameraArgs, GeometryArgs, ShutterArgs, TurnArgs};
pub(super) use settings::existing;
pub(crate) use video::FramesAsked;
pub(crate) use video::VideoArgs;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 10] = [
    "cosmorama convert 'faces/{face}.png' omnimax.png --to omnimax --size 1966x1436",
    "cosmorama convert '%c/%c_%04d.tga' 'dome_####.png' --to fulldome:tilt=20",
    "cosmorama convert panorama.jpg view.png --to perspective:fov=60 --yaw 30",
    "cosmorama convert sky.exr 'cube/{face}.exr' --to cube --channels 'R,G,B,Z'",
    "cosmorama convert dome.png sky.png --from fulldome --to equirect --missing red",
    "cosmorama convert builtin:grid align.png --to fulldome --size 4k",
    "cosmorama convert a.jpg flat.png --from fisheye:calibration=cam.yml --to flat",
    "cosmorama convert project.pto panorama.png",
    "cosmorama convert panorama.exr map.exr --to fulldome --size 2048 --st-map",
    "cosmorama convert plate.exr undistorted.exr --from st-map:file=undistort.exr",
];

/// Colour spaces of an OpenColorIO config.
#[derive(Clone, Debug, Args)]
pub(crate) struct OcioArgs {
    /// OpenColorIO config: a file (.ocio, .ocioz) or ocio://default [default: $OCIO]
    ///
    /// It says what colours are, instead of files' own tags and the options above: code values are brought from --in-space to its
    /// scene_linear role, filtered there, and brought to --out-space or --view. Needs a program built with the feature ocio.
    #[arg(long, value_name = "CONFIG", value_parser = NonEmptyStringValueParser::new(), hide_short_help = true, help_heading = "Light")]
    ocio: Option<String>,
    /// The input's colour space, by its name in the config
    #[arg(long, value_name = "S", value_parser = NonEmptyStringValueParser::new(), hide_short_help = true, help_heading = "Light")]
    in_space: Option<String>,
    /// The output's colour space, by its name in the config [default: the input's]
    #[arg(long, value_name = "S", value_parser = NonEmptyStringValueParser::new(), hide_short_help = true, help_heading = "Light")]
    out_space: Option<String>,
    /// The config's display and view that the output is made for, instead of --out-space
    #[arg(long, value_name = "DISPLAY/VIEW", value_parser = NonEmptyStringValueParser::new(), hide_short_help = true, help_heading = "Light")]
    view: Option<String>,
}

/// Returns what is asked of a config. `$OCIO` names it where the command line names a space or a view alone.
impl From<OcioArgs> for OcioSettings {
    fn from(args: OcioArgs) -> Self {
        let asked = Self { config: args.ocio, in_space: args.in_space, out_space: args.out_space, view: args.view };
        if !asked.is_asked() {
            return asked;
        }
        let usual = || std::env::var("OCIO").ok().filter(|name| !name.is_empty());
        Self { config: asked.config.or_else(usual), ..asked }
    }
}

/// Turn a world, in whatever form, into another projection.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
#[command(after_help = SEE_MORE, after_long_help = after_long_help())]
pub(crate) struct ConvertArgs {
    /// An image, pattern, video or builtin:NAME; - is standard input
    ///
    /// A pattern has {face} or %c where faces' names stand, and ####, @@@@ or %04d where frame numbers do. A world file (.toml)
    /// holds many views, each with image, spec, mask, priority and feather in degrees; a Hugin project (.pto) is read, too. A video is
    /// read through the installed ffmpeg (docs/video.md).
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// An image, pattern or video, by its extension; - is standard output
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) output: Name,
    #[command(flatten)]
    pub(crate) geometry: GeometryArgs,
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
    #[command(flatten)]
    pub(crate) shutter: ShutterArgs,
    /// Write where each pixel looks, for other programs
    ///
    /// Instead of the picture, writes where in the input each of its pixels looks, for Nuke, Fusion or oiiotool to do the same:
    /// an OpenEXR file, red to the right, green up, 0 to 1, blue the part of a pixel that shows anything.
    #[arg(long, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) st_map: bool,
    /// auto (default), srgb, linear, bt1886, pq, hlg, …
    ///
    /// How integer code values relate to light, in and out; also gamma:G, as gamma:2.2. Float files are linear.
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true, help_heading = "Light")]
    pub(crate) transfer: TransferName,
    /// As --transfer, for the input alone, a float file too
    #[arg(long, value_name = "T", value_parser = listed::transfer(), hide_possible_values = true, hide_short_help = true, help_heading = "Light")]
    pub(crate) in_transfer: Option<TransferName>,
    /// As --transfer, for the output alone, a float file too
    #[arg(long, value_name = "T", value_parser = listed::transfer(), hide_possible_values = true, hide_short_help = true, help_heading = "Light")]
    pub(crate) out_transfer: Option<TransferName>,
    /// The output's primaries: rec709, p3-d65, p3-dci, rec2020, ap0, acescg, adobe-rgb [default: as the first input]
    ///
    /// All light is converted to them, white to white. Unless given, they are those that the first input names, else Rec. 709. A
    /// colour that they cannot show is negative in files of floats, and clipped in integers, with a warning.
    #[arg(long, value_name = "P", value_parser = listed::primaries(), hide_possible_values = true, hide_short_help = true, help_heading = "Light")]
    pub(crate) primaries: Option<PrimariesName>,
    /// Primaries of inputs that name none [default: rec709]
    #[arg(long, value_name = "P", value_parser = listed::primaries(), hide_possible_values = true, hide_short_help = true, help_heading = "Light")]
    pub(crate) in_primaries: Option<PrimariesName>,
    /// Take inputs for sRGB whatever their ICC profiles say
    ///
    /// For a profile that is damaged, or holds tables of colours, which are not followed.
    #[arg(long, hide_short_help = true, help_heading = "Light")]
    pub(crate) ignore_profile: bool,
    #[command(flatten)]
    pub(crate) ocio: OcioArgs,
    /// OpenEXR: the channels to take, as in 'R,G,B,diffuse.*' [default: all]
    ///
    /// Names in which * stands for any letters. All that are taken go into OpenEXR outputs, under their names and in their sample
    /// types, each by the rule for what it holds: light is filtered; depth and normals see below; channels of integers, cryptomatte
    /// and those named id take one texel's value (--labels). The first layer of colour among them is the picture.
    #[arg(long, value_name = "LIST", value_parser = NonEmptyStringValueParser::new(), value_delimiter = ',', hide_short_help = true, help_heading = "Channels")]
    pub(crate) channels: Vec<String>,
    /// OpenEXR: the part to read of files of several, by name or number from 0 [default: the first picture]
    #[arg(long, value_name = "N", value_parser = NonEmptyStringValueParser::new(), hide_short_help = true, help_heading = "Channels")]
    pub(crate) part: Option<String>,
    /// What the input's depth is: planar (from the camera's plane) or radial (from the camera) [default: by its projection]
    ///
    /// Unless given, that of flat views and cube faces is planar, with a warning, and that of others radial. It is written as planar
    /// in flat outputs, and as radial in others.
    #[arg(long, value_name = "KIND", value_parser = depth_kind(), hide_short_help = true, help_heading = "Channels")]
    pub(crate) depth_kind: Option<DepthKind>,
    /// Turn normals from the input's views to the output's
    ///
    /// For normals in each view's own frame: x to the right, y up, z to the viewer. Without it, or as --normals=world, they are in the
    /// world's frame, and no view turns them.
    #[arg(long, value_name = "FRAME", num_args = 0..=1, require_equals = true, default_missing_value = "camera", value_parser = normals(), hide_short_help = true, help_heading = "Channels")]
    pub(crate) normals: Option<NormalSpace>,
    /// Output sample type [default: as the input]
    ///
    /// Unless given, it is as the input's, where the format can.
    #[arg(long, value_parser = listed::depth(), value_name = "DEPTH", help_heading = "Light")]
    pub(crate) depth: Option<DepthName>,
    /// Pixels outside the lens [default: black]
    ///
    /// Unless given, they are black, and transparent where the output has alpha. Of a sequence, the first frame tells whether
    /// there is alpha; what is transparent in a later one is laid over this, with a warning. A colour is a name, #rrggbb,
    /// #rrggbbaa, or r,g,b of linear light.
    #[arg(long, value_name = "COLOR", help_heading = "Light")]
    pub(crate) background: Option<Colour>,
    /// Uncovered: error (default), mirror or a colour
    ///
    /// Pixels that look where no view of the input does: transparent is a colour, too. mirror shows what lies as far inside the edge of the input, stretch
    /// the nearest of it.
    #[arg(long, value_name = "COLOR", default_value = "error", hide_default_value = true, help_heading = "Light")]
    pub(crate) missing: Missing,
    /// A world behind the input's alpha, and behind what it does not cover
    ///
    /// Named like an input; builtin:NAME, too. Both are seen by the same camera, and composited in linear light.
    #[arg(long, value_name = "INPUT", value_hint = ValueHint::FilePath, value_parser = file::name(), hide_short_help = true, help_heading = "Light")]
    pub(crate) backdrop: Option<Name>,
    /// The backdrop's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, requires = "backdrop", hide_short_help = true, help_heading = "Light")]
    pub(crate) backdrop_from: Option<Spec>,
    /// The backdrop's frames: step (default), hold or loop; +N adds, as in loop+12
    ///
    /// step takes the frame of the same number, which must be there; hold goes on with the last one (and begins with the first),
    /// loop repeats all. A number is added to the frame: +12 begins 12 frames later in the backdrop.
    #[arg(long, value_name = "RULE", value_parser = frame_map, requires = "backdrop", allow_hyphen_values = true, hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) backdrop_frames: Option<FrameMap>,
    #[command(flatten)]
    pub(crate) video: VideoArgs,
    #[command(flatten)]
    pub(crate) files: FilesArgs,
    /// The format of standard output, as in --format png
    #[arg(long, value_name = "EXT", help_heading = "Frames and files")]
    pub(crate) format: Option<String>,
    /// KTX2 and DDS: add the smaller copies (mips), each made as a picture of its size would be
    #[arg(long, hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) mips: bool,
    /// JPEG quality, 1 to 100 [default: 95]
    #[arg(long, value_name = "Q", value_parser = quality, allow_hyphen_values = true, hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) quality: Option<u8>,
    /// PNG, TIFF and OpenEXR: how hard to press, without loss [default: balanced; fast for PNG sequences]
    #[arg(long, value_parser = CompressionParser, value_name = "HOW", hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) compression: Option<Compression>,
    /// Write no metadata of the input: no attributes, texts, Exif or XMP
    ///
    /// Unless given, they go along where the output's format can hold them and they are still true (docs/metadata.md). Tags of
    /// colours stay, since they say what the pixels mean, and so does a panorama's place (GPano).
    #[arg(long, hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) strip: bool,
    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// Frames to make, and treatment of outputs and folders.
#[derive(Clone, Debug, Args)]
pub(crate) struct FilesArgs {
    /// Which frames: 5, 1-10 or 1-3,5,7-20:2 [default: all]
    ///
    /// Unless given, all from the first that exists to the last. Those of a video count from 0, or are chosen by time, as in
    /// 00:01:00-00:01:10, which ends before its second time.
    #[arg(long, value_name = "LIST", value_parser = FramesAsked::parse, allow_hyphen_values = true, help_heading = "Frames and files")]
    pub(crate) frames: Option<FramesAsked>,
    /// Replace existing outputs
    #[arg(short = 'y', long, conflicts_with = "resume", help_heading = "Frames and files")]
    pub(crate) overwrite: bool,
    /// Skip outputs that are already complete
    ///
    /// Complete are those that are whole, and made with these settings from these inputs, as their files tell. Others made otherwise are an
    /// error; what is damaged is made again, with a warning.
    #[arg(long, help_heading = "Frames and files")]
    pub(crate) resume: bool,
    /// Fail where a folder of an output does not exist
    ///
    /// Otherwise it is made, with those above it.
    #[arg(long, help_heading = "Frames and files")]
    pub(crate) no_mkdir: bool,
}

/// Limits, progress and report of a run.
#[derive(Clone, Debug, Args)]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// How to tell what is going on, on standard error
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = ProgressStyle::Auto, hide_short_help = true, help_heading = "Run")]
    pub(crate) progress: ProgressStyle,
    /// Print a machine-readable report on standard output
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}

/// Limits of threads and memory.
#[derive(Clone, Debug, Args)]
pub(crate) struct LimitArgs {
    /// Threads to work with [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true, help_heading = "Run")]
    pub(crate) threads: Option<usize>,
    /// Memory at most: 500M, 8G or 50% [default: 75% of free]
    ///
    /// As in 500M, 8G or 50%; never more than there is. Unless given, three quarters of what is free.
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, help_heading = "Run")]
    pub(crate) memory: Option<MemorySize>,
}

/// Treatment of an output that exists, and of a folder that does not.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct OutputArgs {
    /// Replace an existing output
    #[arg(short = 'y', long)]
    pub(crate) overwrite: bool,
    /// Fail where the folder of the output does not exist
    #[arg(long, hide_short_help = true)]
    pub(crate) no_mkdir: bool,
}

/// Reads the kind of a depth.
fn depth_kind() -> impl TypedValueParser<Value = DepthKind> {
    let kind = |word: String| if word == "planar" { DepthKind::Planar } else { DepthKind::Radial };
    PossibleValuesParser::new(["planar", "radial"]).map(kind)
}

/// Reads the frame of normals.
fn normals() -> impl TypedValueParser<Value = NormalSpace> {
    let frame = |word: String| if word == "world" { NormalSpace::World } else { NormalSpace::Camera };
    PossibleValuesParser::new(["world", "camera"]).map(frame)
}

/// Reads a list of frames.
pub(super) fn frame_list(text: &str) -> Result<FrameList, FrameRangesError> {
    text.parse().map(|ranges: FrameRanges| FrameList::new(ranges.frames()))
}

/// Reads the rule for a backdrop's frames.
fn frame_map(text: &str) -> Result<FrameMap, String> {
    text.parse()
}

fn quality(text: &str) -> Result<u8, String> {
    match text.parse() {
        Ok(quality @ 1..=100) => Ok(quality),
        _ => Err("expected a number from 1 to 100".to_owned()),
    }
}

/// Reads a number of threads.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1024) => Ok(count),
        _ => Err("expected a number from 1 to 1024".to_owned()),
    }
}

/// Returns the list of built-in worlds.
pub(crate) fn builtins() -> String {
    let mut text = "builtin:NAME is a world by formula, in any projection and --size:\n\n".to_owned();
    for (name, about) in cosmorama_convert::Builtin::all() {
        text += &format!("  {name:<13} {about}\n");
    }
    text
}

/// Returns the lists of projections and built-in worlds.
fn after_long_help() -> String {
    format!("{}\n{}", projections(), builtins())
}
