use clap::builder::NonEmptyStringValueParser;
use clap::{Args, ValueHint};
use cosmorama_io::FrameList;
use cosmorama_spec::{
    Colour, CompressionLevel, DepthName, FrameRanges, FrameRangesError, MemorySize, Missing, TransferName,
};

use super::ProgressStyle;
use super::geometry::GeometryArgs;
use super::parse::compression::CompressionParser;
use super::parse::depth::depth_parser;

/// Turn a world, in whatever form, into another projection.
#[derive(Clone, Debug, Args)]
#[command(before_help = "Examples:
  cosmorama convert 'faces/{face}.png' dome.png --to omnimax --size 1966x1436
  cosmorama convert '%c/frame_%c_%04d.tga' 'dome_####.png' --to fulldome:tilt=20 --size 4096
  cosmorama convert panorama.jpg view.png --to perspective:fov=60 --yaw 30 --pitch -10 --size 1920x1080
  cosmorama convert panorama.exr 'cube/{face}.exr' --to cube --size 1024
  cosmorama convert dome.png back.png --from fulldome --to equirect --missing black
  cosmorama convert builtin:grid align.png --to fulldome --size 4096
  cosmorama convert photo.jpg flat.png --from fisheye:calibration=camera.yml --to perspective:fov=90
  cosmorama convert project.pto panorama.png
  cosmorama convert panorama.exr map.exr --to fulldome --size 2048 --st-map
  cosmorama convert plate.exr undistorted.exr --from st-map:file=undistort.exr")]
#[command(after_help = after_help())]
pub(crate) struct ConvertArgs {
    /// An image, a pattern with {face} or %c (faces) and ####, @@@@ or %04d (frames), builtin:NAME, a world file
    /// (.toml: many views, each view with image, spec, mask, priority and feather in degrees) or a Hugin project (.pto);
    /// - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = NonEmptyStringValueParser::new())]
    pub(crate) input: String,
    /// An image or a pattern; the extension chooses the format; - is standard output, in the format of --format
    #[arg(value_hint = ValueHint::FilePath, value_parser = NonEmptyStringValueParser::new())]
    pub(crate) output: String,
    #[command(flatten)]
    pub(crate) geometry: GeometryArgs,
    /// Instead of the picture, write where in the input each of its pixels looks, for Nuke, Fusion or oiiotool to do
    /// the same: an OpenEXR file, red to the right, green up, 0 to 1, blue the part of a pixel that shows anything
    #[arg(long, help_heading = "Geometry")]
    pub(crate) st_map: bool,
    /// How integer code values relate to light: auto, srgb, linear, bt1886, pq, hlg, gamma:G; float files are linear
    #[arg(long, value_name = "T", default_value = "auto", help_heading = "Light")]
    pub(crate) transfer: TransferName,
    /// As --transfer, for the input alone, a float file too
    #[arg(long, value_name = "T", help_heading = "Light")]
    pub(crate) in_transfer: Option<TransferName>,
    /// As --transfer, for the output alone, a float file too
    #[arg(long, value_name = "T", help_heading = "Light")]
    pub(crate) out_transfer: Option<TransferName>,
    /// Output sample type [default: as the input, where the format can]
    #[arg(long, value_parser = depth_parser(), value_name = "DEPTH", help_heading = "Light")]
    pub(crate) depth: Option<DepthName>,
    /// Pixels outside the lens [default: black, transparent where the output has alpha]. Of a sequence, the first frame
    /// tells whether there is alpha; what is transparent in a later one is laid over this, with a warning
    #[arg(long, value_name = "COLOR", help_heading = "Light")]
    pub(crate) background: Option<Colour>,
    /// Directions that no view covers: error, transparent or a colour
    #[arg(long, value_name = "error|COLOR|transparent", default_value = "error", help_heading = "Light")]
    pub(crate) missing: Missing,
    /// Which frames: 5, 1-10 or 1-3,5,7-20:2 [default: all from the first that exists to the last]
    #[arg(long, value_name = "LIST", value_parser = frame_list, allow_hyphen_values = true, help_heading = "Frames and files")]
    pub(crate) frames: Option<FrameList>,
    /// Replace existing outputs
    #[arg(short = 'y', long, conflicts_with = "resume", help_heading = "Frames and files")]
    pub(crate) overwrite: bool,
    /// Skip outputs that are already complete: whole, and of the size, channels and depth that this conversion makes. What
    /// else is in their places is made again, with a warning
    #[arg(long, help_heading = "Frames and files")]
    pub(crate) resume: bool,
    /// The format of standard output, by its extension, as in --format png
    #[arg(long, value_name = "EXT", help_heading = "Frames and files")]
    pub(crate) format: Option<String>,
    /// KTX2 and DDS: add the smaller copies (mips), each made as a picture of its size would be
    #[arg(long, help_heading = "Frames and files")]
    pub(crate) mips: bool,
    /// JPEG quality, 1 to 100 [default: 95]
    #[arg(long, value_name = "Q", value_parser = quality, allow_hyphen_values = true, help_heading = "Frames and files")]
    pub(crate) quality: Option<u8>,
    /// PNG, TIFF and OpenEXR: how hard to press, without loss [default: balanced; fast for PNG sequences]
    #[arg(long, value_parser = CompressionParser, value_name = "HOW", help_heading = "Frames and files")]
    pub(crate) compression: Option<CompressionLevel>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// How to tell what is going on, on standard error
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = ProgressStyle::Auto, help_heading = "Run")]
    pub(crate) progress: ProgressStyle,
    /// Print a machine-readable report on standard output
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}

/// What a run may take.
#[derive(Clone, Debug, Args)]
pub(crate) struct LimitArgs {
    /// Threads to work with [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true, help_heading = "Run")]
    pub(crate) threads: Option<usize>,
    /// Memory to use at most, as in 500M, 8G or 50%; never more than there is [default: 75% of free memory]
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, help_heading = "Run")]
    pub(crate) memory: Option<MemorySize>,
}

fn frame_list(text: &str) -> Result<FrameList, FrameRangesError> {
    text.parse().map(|ranges: FrameRanges| FrameList::new(ranges.frames()))
}

fn quality(text: &str) -> Result<u8, String> {
    match text.parse() {
        Ok(quality @ 1..=100) => Ok(quality),
        _ => Err("expected a number from 1 to 100".to_owned()),
    }
}

fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1024) => Ok(count),
        _ => Err("expected a number from 1 to 1024".to_owned()),
    }
}

/// Every projection, and every built-in world.
fn after_help() -> String {
    let mut text = cosmorama_spec::help();
    text += "\nbuiltin:NAME is a world by formula, in any projection and --size:\n\n";
    for (name, about) in cosmorama_convert::Builtin::all() {
        text += &format!("  {name:<13} {about}\n");
    }
    text
}
