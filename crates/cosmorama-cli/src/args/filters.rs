use std::path::PathBuf;

use clap::{Args, ValueHint};
use cosmorama_convert::{Conversion, GeometrySettings, Name};
use cosmorama_io::FrameList;
use cosmorama_spec::{FilterName, KernelName, Size, Spec, TransferName};

use super::convert::{LimitArgs, TurnArgs, frame_list};
use super::{ProgressStyle, SEE_MORE, projections, with_examples};
use crate::parse::file;
use crate::parse::listed;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 4] = [
    "cosmorama filters 'faces/{face}.png' --to omnimax --size 983x718",
    "cosmorama filters sky.jpg --to perspective:fov=60 --size 512",
    "cosmorama filters sky.png --to fulldome --size 512 --only ewa,mipmap,point",
    "cosmorama filters sky.png --to fulldome --size 1k --truth direct.png --csv",
];

/// Least width and height of a picture whose filters are compared.
const LEAST: usize = 16;

/// Compare filters on one conversion: error, aliasing, blur and cost of each.
///
/// A table: PSNR of linear light against the reference filter and, with --truth, against a direct render; aliasing, the energy
/// that is left of gratings which the picture cannot hold, in dB; the width of an edge in pixels, from 10 % to 90 %; processor
/// seconds of the picture and of the preparation within; the memory of that; and texels read for a pixel. docs/filters.md says
/// what the figures mean.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
#[command(after_help = SEE_MORE, after_long_help = projections())]
pub(crate) struct FiltersArgs {
    /// An image or a pattern, as convert takes it
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// The input's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// The output's projection: of one picture
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) to: Option<Spec>,
    /// Output pixels [default: parity with the input at the centre]
    #[arg(long, value_name = "WxH|N", value_parser = size, allow_hyphen_values = true, help_heading = "Geometry")]
    pub(crate) size: Option<Size>,
    #[command(flatten)]
    pub(crate) turn: TurnArgs,
    /// Filters to compare, as in ewa,mipmap [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = listed::filter(), hide_possible_values = true, help_heading = "Filter")]
    pub(crate) only: Vec<FilterName>,
    /// Weights of ewa, ewa-pyramid and the reference
    #[arg(long, value_name = "NAME", default_value = "adaptive", value_parser = listed::kernel(), hide_possible_values = true, help_heading = "Filter")]
    pub(crate) kernel: KernelName,
    /// A direct render of the output, to measure errors from
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Filter")]
    pub(crate) truth: Option<PathBuf>,
    /// How integer code values relate to light, of both files
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, help_heading = "Filter")]
    pub(crate) transfer: TransferName,
    /// Which frame of several
    #[arg(long, value_name = "N", value_parser = frame_list, allow_hyphen_values = true, help_heading = "Run")]
    pub(crate) frames: Option<FrameList>,
    /// Write crops.png into this folder: the same places by each filter
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, help_heading = "Run")]
    pub(crate) output: Option<PathBuf>,
    /// Replace an existing crops.png
    #[arg(short = 'y', long, requires = "output", help_heading = "Run")]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// How to tell what is going on, on standard error
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = ProgressStyle::Auto, hide_short_help = true, help_heading = "Run")]
    pub(crate) progress: ProgressStyle,
    /// Print the table as JSON
    #[arg(long, conflicts_with = "csv", help_heading = "Run")]
    pub(crate) json: bool,
    /// Print the table as comma-separated values
    #[arg(long, help_heading = "Run")]
    pub(crate) csv: bool,
}

impl FiltersArgs {
    /// Returns the filters to compare, each once: those that were asked for, or all.
    pub(crate) fn filters(&self) -> Vec<FilterName> {
        let all = || FilterName::NAMES.iter().filter_map(|(name, _)| name.parse().ok()).collect();
        let mut filters = if self.only.is_empty() { all() } else { Vec::new() };
        for filter in &self.only {
            if !filters.contains(filter) {
                filters.push(*filter);
            }
        }
        filters
    }

    /// Returns the conversion on which filters are compared.
    pub(crate) fn conversion(&self) -> Conversion {
        Conversion {
            input: self.input.clone(),
            geometry: GeometrySettings {
                from: self.from.clone(),
                to: self.to.clone(),
                size: self.size,
                orientation: self.turn.into(),
                kernel: self.kernel,
                ..GeometrySettings::default()
            },
            transfer: self.transfer.clone(),
            frames: self.frames.clone(),
            limits: self.limits.clone().into(),
            ..Conversion::default()
        }
    }
}

/// Reads the size of a picture that is large enough for its pixels to be measured.
fn size(text: &str) -> Result<Size, String> {
    let size: Size = text.parse()?;
    if size.width.min(size.height.unwrap_or(size.width)) < LEAST {
        return Err(format!(
            "expected {LEAST} pixels or more each way, too few to measure otherwise, as in 512 or 983x718"
        ));
    }
    Ok(size)
}
