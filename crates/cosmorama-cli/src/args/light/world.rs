use clap::Args;
use cosmorama_convert::{Conversion, GeometrySettings, Name};
use cosmorama_io::FrameList;
use cosmorama_spec::{Missing, Spec, TransferName};

use crate::args::convert::{LimitArgs, OutputArgs, frame_list};
use crate::parse::listed;

/// Description of a world whose light is wanted, and of what becomes of it.
#[derive(Clone, Debug, Args)]
pub(crate) struct WorldArgs {
    /// The input's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// How integer code values relate to light: auto (default), srgb, linear, …
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true, help_heading = "Light")]
    pub(crate) transfer: TransferName,
    /// Which frame of several
    #[arg(long, value_name = "N", value_parser = frame_list, allow_hyphen_values = true, help_heading = "Frames and files")]
    pub(crate) frames: Option<FrameList>,
    #[command(flatten, next_help_heading = "Frames and files")]
    pub(crate) file: OutputArgs,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print a machine-readable report on standard output
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}

impl WorldArgs {
    /// Returns the settings by which the world is read.
    pub(super) fn conversion(self, input: Name, missing: Missing) -> Conversion {
        Conversion {
            input,
            geometry: GeometrySettings { from: self.from, ..GeometrySettings::default() },
            transfer: self.transfer,
            missing,
            frames: self.frames,
            limits: self.limits.into(),
            ..Conversion::default()
        }
    }
}
