use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};
use cosmorama::lighting::{LARGEST_COLOUR_TABLE, TableAngle};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_convert::{Conversion, Name};
use cosmorama_spec::{DepthName, Missing};

use super::world::WorldArgs;
use crate::args::with_examples;
use crate::parse::file;
use crate::parse::listed;
use crate::parse::number::degrees;

/// Commands that the help of `light table` shows.
pub(super) const TABLE_EXAMPLES: [&str; 4] = [
    "cosmorama light table sky.hdr chrome.csv",
    "cosmorama light table sky.hdr strip.exr --by azimuth --size 256",
    "cosmorama light table 'stops:-90=#302010;0=white;90=0.1,0.3,1' world.exr",
    "cosmorama light table chrome.csv world.exr --size 512",
];

/// Make a table of a world's colours by elevation or azimuth, or a world of such a table.
///
/// Greene's one-dimensional colour table for chrome (1986, section 8). A world becomes a table: CSV, or a picture of one row. A table (CSV,
/// or stops:DEGREES=COLOUR;…) becomes a panorama, or CSV.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&TABLE_EXAMPLES))]
pub(crate) struct TableArgs {
    /// A world, as convert takes it; a table in CSV; or stops:DEGREES=COLOUR;…
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// A .csv file or a picture
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// Colours of a table [default: 64], columns of a panorama [default: 512]
    #[arg(long, value_name = "N", value_parser = size, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) size: Option<usize>,
    /// elevation (default): the angle above the horizon; azimuth: the angle to the right of the front
    #[arg(long, value_enum, value_name = "ANGLE", default_value_t = By::Elevation, hide_possible_values = true, hide_default_value = true, help_heading = "Geometry")]
    pub(crate) by: By,
    /// Turn the table's axes to the right, in degrees
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) yaw: f64,
    /// Turn the table's axes up: at 90, elevation is from the back
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) pitch: f64,
    /// Turn the table's axes clockwise: at 90, elevation is from the right
    #[arg(long, value_name = "D", default_value_t = 0.0, value_parser = degrees, allow_negative_numbers = true, help_heading = "Geometry")]
    pub(crate) roll: f64,
    /// What no view covers: error (default) or a colour
    #[arg(long, value_name = "COLOR", default_value = "error", hide_default_value = true, help_heading = "Light")]
    pub(crate) missing: Missing,
    /// Sample type of a picture [default: the deepest of the format]
    #[arg(long, value_parser = listed::depth(), value_name = "DEPTH", help_heading = "Light")]
    pub(crate) depth: Option<DepthName>,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
}

/// Angle of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum By {
    /// Above the horizon
    Elevation,
    /// To the right of the front
    Azimuth,
}

impl From<By> for TableAngle {
    fn from(by: By) -> Self {
        match by {
            By::Elevation => Self::Elevation,
            By::Azimuth => Self::Azimuth,
        }
    }
}

impl TableArgs {
    /// Returns the frame in which angles are measured.
    pub(crate) fn frame(&self) -> Orientation {
        let [yaw, pitch, roll] = [self.yaw, self.pitch, self.roll].map(Angle::from_degrees);
        Orientation::from_yaw_pitch_roll(yaw, pitch, roll)
    }
}

impl From<TableArgs> for Conversion {
    fn from(args: TableArgs) -> Self {
        args.world.conversion(args.input, args.missing)
    }
}

fn size(text: &str) -> Result<usize, String> {
    let size = text.parse().ok().filter(|size| (1..=LARGEST_COLOUR_TABLE).contains(size));
    size.ok_or_else(|| format!("expected a number from 1 to {LARGEST_COLOUR_TABLE}"))
}
