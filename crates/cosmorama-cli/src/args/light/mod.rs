//! Arguments of the verbs that make light of a world.

mod brdf;
mod deploy;
mod harmonics;
pub(crate) mod lobe;
mod maps;
mod roughness;
mod sun;
mod table;
mod world;

use clap::{Args, Subcommand};

use super::with_examples;

pub(crate) use brdf::BrdfArgs;
pub(crate) use deploy::{DeployArgs, PresetName};
pub(crate) use harmonics::HarmonicsArgs;
pub(crate) use maps::{DiffuseArgs, MapArgs, Method, SpecularArgs, Unit};
pub(crate) use sun::SunArgs;
pub(crate) use table::TableArgs;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 10] = [
    "cosmorama light diffuse sky.hdr light.exr",
    "cosmorama light diffuse 'faces/{face}.exr' light.exr --to mercator",
    "cosmorama light specular sky.exr rough.exr --alpha 0.25 --size 256",
    "cosmorama light specular sky.exr glossy.png --lobe phong:64",
    "cosmorama light specular sky.exr chain.ktx2 --levels 5",
    "cosmorama light harmonics sky.exr light.json --order 4",
    "cosmorama light table sky.hdr chrome.csv",
    "cosmorama light brdf dfg.exr",
    "cosmorama light sun sky.hdr --remove sky-without-sun.exr",
    "cosmorama light deploy sky.hdr garden --preset filament",
];

/// Filter a world widely, to the light that it sheds on things.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES), arg_required_else_help = true)]
#[command(after_help = "'cosmorama light diffuse -h' lists the options of a map; docs/light.md has the conventions")]
pub(crate) struct LightArgs {
    /// Kind of map to make.
    #[command(subcommand)]
    pub(crate) verb: LightVerb,
}

/// Kinds of maps of a world's light.
#[derive(Debug, Subcommand)]
pub(crate) enum LightVerb {
    /// Make a map of the light that falls on a matt surface, by the direction that it faces
    Diffuse(Box<DiffuseArgs>),
    /// Make a map of what a glossy surface reflects, by the mirror direction
    Specular(Box<SpecularArgs>),
    /// Sum the spherical harmonics of a world's light, as JSON, CSV or code
    Harmonics(Box<HarmonicsArgs>),
    /// Make a table of a world's colours by elevation or azimuth, or a world of such a table
    Table(Box<TableArgs>),
    /// Find the suns and lamps of a world: direction, size, colour and light
    Sun(Box<SunArgs>),
    /// Make a table of what rough surfaces reflect of a white world (split sum, DFG)
    Brdf(BrdfArgs),
    /// Write all that an engine loads to light a scene by a world, in one folder
    Deploy(Box<DeployArgs>),
}

/// Returns the example commands of a verb of `light`.
pub(crate) fn examples(verb: &str) -> &'static [&'static str] {
    match verb {
        "diffuse" => &maps::DIFFUSE_EXAMPLES,
        "brdf" => &brdf::BRDF_EXAMPLES,
        "deploy" => &deploy::DEPLOY_EXAMPLES,
        "table" => &table::TABLE_EXAMPLES,
        "sun" => &sun::SUN_EXAMPLES,
        "harmonics" => &harmonics::HARMONICS_EXAMPLES,
        _ => &maps::SPECULAR_EXAMPLES,
    }
}
