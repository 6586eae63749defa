use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};
use cosmorama::lighting::{BrdfModel, LARGEST_BRDF_TABLE};
use cosmorama_spec::DepthName;

use crate::args::convert::{OutputArgs, threads};
use crate::args::with_examples;
use crate::parse::listed;

/// Commands that the help of `light brdf` shows.
pub(super) const BRDF_EXAMPLES: [&str; 4] = [
    "cosmorama light brdf dfg.exr",
    "cosmorama light brdf dfg.ktx2 --size 256",
    "cosmorama light brdf dfg.exr --multiscatter --depth half",
    "cosmorama light brdf cloth.exr --lobe charlie",
];

/// Make a table of what rough surfaces reflect of a white world (split sum, DFG).
///
/// Column i is of n·v = (i + ½)/N, row j of the roughness √α = (j + ½)/N, smooth on top. Red times the reflectance along the normal, F0,
/// plus green is the reflected part of the light.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&BRDF_EXAMPLES))]
pub(crate) struct BrdfArgs {
    /// A file: .exr, .ktx2, .png or .tif
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// Columns and rows, 1 to 4096
    #[arg(long, value_name = "N", value_parser = size, allow_negative_numbers = true, default_value_t = SIZE, help_heading = "Table")]
    pub(crate) size: usize,
    /// ggx (default), with height-correlated Smith shadowing, or charlie, cloth
    #[arg(long, value_enum, value_name = "LOBE", default_value_t = Surface::Ggx, hide_possible_values = true, hide_default_value = true, help_heading = "Table")]
    pub(crate) lobe: Surface,
    /// Red is what was green, and green the sum of both, as Filament has it
    ///
    /// Light that facets reflect more often can then be added: mix(red, green, F0) · (1 + F0 · (1/green − 1)).
    #[arg(long, help_heading = "Table")]
    pub(crate) multiscatter: bool,
    /// Sample type [default: float; half in .ktx2, 16 in .png]
    #[arg(long, value_parser = listed::depth(), value_name = "DEPTH", help_heading = "Table")]
    pub(crate) depth: Option<DepthName>,
    #[command(flatten, next_help_heading = "Files")]
    pub(crate) file: OutputArgs,
    /// Threads to work with [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true, help_heading = "Run")]
    pub(crate) threads: Option<usize>,
    /// Print a machine-readable report on standard output
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}

impl BrdfArgs {
    /// Returns the arguments of a table of microfacets.
    pub(crate) fn usual(output: PathBuf, multiscatter: bool, threads: Option<usize>) -> Self {
        let file = OutputArgs { overwrite: true, no_mkdir: false };
        Self { output, size: SIZE, lobe: Surface::Ggx, multiscatter, depth: None, file, threads, json: false }
    }
}

/// Columns and rows of a table, unless given.
const SIZE: usize = 128;

/// Surface that a table is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Surface {
    /// Microfacets
    Ggx,
    /// Cloth: the albedo in red
    Charlie,
}

impl Surface {
    /// Returns its name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ggx => "ggx",
            Self::Charlie => "charlie",
        }
    }
}

impl From<Surface> for BrdfModel {
    fn from(surface: Surface) -> Self {
        match surface {
            Surface::Ggx => Self::Ggx,
            Surface::Charlie => Self::Charlie,
        }
    }
}

fn size(text: &str) -> Result<usize, String> {
    let size = text.parse().ok().filter(|size| (1..=LARGEST_BRDF_TABLE).contains(size));
    size.ok_or_else(|| format!("expected a number from 1 to {LARGEST_BRDF_TABLE}"))
}
