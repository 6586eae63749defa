use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};
use cosmorama_convert::{Conversion, Name};
use cosmorama_spec::Missing;

use super::world::WorldArgs;
use crate::args::{ProgressStyle, with_examples};
use crate::parse::file;

/// Commands that the help of `light deploy` shows.
pub(super) const DEPLOY_EXAMPLES: [&str; 4] = [
    "cosmorama light deploy sky.hdr garden --preset filament",
    "cosmorama light deploy sky.exr assets/sky --preset bevy --sky-size 2048",
    "cosmorama light deploy 'faces/{face}.exr' public/sky --preset three",
    "cosmorama light deploy sky.hdr sky --preset godot --json",
];

/// Write all that an engine loads to light a scene by a world, in one folder.
///
/// The sky with its smaller copies, the light on matt surfaces, a chain of roughness, a table of what surfaces reflect, and README.txt,
/// which says what is what and how it is loaded. The folder appears with all files or not at all.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&DEPLOY_EXAMPLES))]
pub(crate) struct DeployArgs {
    /// An image or a pattern, as convert takes it; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// A folder, which is made
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) folder: PathBuf,
    /// Who loads it: filament, gltf (Khronos' viewer), three, bevy, godot, unreal
    #[arg(long, value_enum, value_name = "ENGINE", hide_possible_values = true, help_heading = "Light")]
    pub(crate) preset: PresetName,
    /// Faces of the chain of roughness: a power of two, 16 to 4096
    #[arg(long, value_name = "N", value_parser = power_of_two, allow_negative_numbers = true, default_value = "256", help_heading = "Geometry")]
    pub(crate) size: usize,
    /// Faces of the sky: a power of two; a panorama is four times as wide
    #[arg(long, value_name = "N", value_parser = power_of_two, allow_negative_numbers = true, default_value = "1024", help_heading = "Geometry")]
    pub(crate) sky_size: usize,
    /// What no view covers: error (default) or a colour
    #[arg(long, value_name = "COLOR", default_value = "error", hide_default_value = true, help_heading = "Light")]
    pub(crate) missing: Missing,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// How to tell what is going on, on standard error
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = ProgressStyle::Auto, hide_short_help = true, help_heading = "Run")]
    pub(crate) progress: ProgressStyle,
}

/// Name of an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PresetName {
    /// Filament
    Filament,
    /// Khronos' glTF sample viewer
    Gltf,
    /// three.js
    Three,
    /// Bevy
    Bevy,
    /// Godot
    Godot,
    /// Unreal Engine
    Unreal,
}

impl PresetName {
    /// Returns its name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Filament => "filament",
            Self::Gltf => "gltf",
            Self::Three => "three",
            Self::Bevy => "bevy",
            Self::Godot => "godot",
            Self::Unreal => "unreal",
        }
    }
}

impl From<DeployArgs> for Conversion {
    fn from(args: DeployArgs) -> Self {
        args.world.conversion(args.input, args.missing)
    }
}

fn power_of_two(text: &str) -> Result<usize, String> {
    let size = text.parse().ok().filter(|size: &usize| size.is_power_of_two() && (16..=4096).contains(size));
    size.ok_or_else(|| "expected a power of two from 16 to 4096".to_owned())
}
