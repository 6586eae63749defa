//! Command line as typed. `cosmorama-convert` works out what it means.

mod compare;
pub(crate) mod convert;
mod demo;
mod explain;
mod filters;
mod help;
mod info;
pub(crate) mod light;
mod papers;
mod shade;
mod verify;

use clap::{Arg, ArgAction, Command, CommandFactory, Parser, Subcommand};

use cosmorama_spec::SpecKind;

pub(crate) use compare::{CompareArgs, Region};
pub(crate) use convert::{ConvertArgs, FramesAsked, OutputArgs, builtins};
pub(crate) use demo::DemoArgs;
pub(crate) use explain::ExplainArgs;
pub(crate) use filters::FiltersArgs;
pub(crate) use help::{CompletionsArgs, HelpArgs, LISTS, ManArgs, SPEC_TOPIC};
pub(crate) use info::InfoArgs;
pub(crate) use light::{
    BrdfArgs, DeployArgs, DiffuseArgs, HarmonicsArgs, LightArgs, LightVerb, MapArgs, Method, PresetName, SpecularArgs,
    SunArgs, TableArgs, Unit,
};
pub(crate) use papers::{FiguresArgs, PlatesArgs};
pub(crate) use shade::{BackgroundName, CameraName, ObjectName, OcclusionName, Point, RefractName, ShadeArgs};
pub(crate) use verify::VerifyArgs;

pub(crate) use crate::parse::log_format::LogFormat;
pub(crate) use crate::parse::progress::ProgressStyle;

/// Example commands in the program's own help.
const EXAMPLES: [&str; 3] = [
    "cosmorama demo",
    "cosmorama convert 'faces/{face}.png' omnimax.png --to omnimax --size 1966x1436",
    "cosmorama info 'faces/{face}.png'",
];

/// All verbs with their examples.
const VERBS: [(&str, &[&str]); 14] = [
    ("demo", &demo::EXAMPLES),
    ("convert", &convert::EXAMPLES),
    ("light", &light::EXAMPLES),
    ("shade", &shade::EXAMPLES),
    ("plates", &papers::PLATES_EXAMPLES),
    ("info", &info::EXAMPLES),
    ("explain", &explain::EXAMPLES),
    ("compare", &compare::EXAMPLES),
    ("verify", &verify::EXAMPLES),
    ("filters", &filters::EXAMPLES),
    ("figures", &papers::FIGURES_EXAMPLES),
    ("completions", &help::COMPLETIONS_EXAMPLES),
    ("man", &help::MAN_EXAMPLES),
    ("help", &help::EXAMPLES),
];

/// World projections: Omnimax, fulldome, fisheye, panorama and cube faces, made from one another with an
/// elliptical weighted average filter.
#[derive(Debug, Parser)]
#[command(name = "cosmorama", version, propagate_version = true, arg_required_else_help = true)]
#[command(
    disable_help_subcommand = true,
    after_help = "'cosmorama VERB -h' lists a verb's options; 'cosmorama help spec' lists projections and their keys"
)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct Args {
    /// Verb to run.
    #[command(subcommand)]
    pub(crate) verb: Verb,
    /// Say also what was decided and why; twice: every detail
    ///
    /// The projection found, colours, filter, geometry, memory and frames, and what is good to know where nothing is wrong. RUST_LOG
    /// chooses by topic, as in RUST_LOG=cosmorama::memory=debug.
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub(crate) verbose: u8,
    /// Form of messages on standard error: text or json, an object a line
    #[arg(
        long,
        global = true,
        value_enum,
        value_name = "FORM",
        default_value_t,
        hide_default_value = true,
        hide_short_help = true
    )]
    pub(crate) log_format: LogFormat,
}

/// Verbs of the program.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Render an embedded world onto cube faces and make an Omnimax frame of them
    Demo(DemoArgs),
    /// Turn a world, in whatever form, into another projection
    Convert(Box<ConvertArgs>),
    /// Filter a world widely, to the light that it sheds on things
    Light(LightArgs),
    /// Put mirrors and matt things under a world
    Shade(Box<ShadeArgs>),
    /// Make the plates and figures of the paper on world projections anew
    Plates(PlatesArgs),
    /// Tell what a file or a face set is
    Info(InfoArgs),
    /// Tell what a conversion will do before it does it, in text and diagrams
    Explain(Box<ExplainArgs>),
    /// Compare two pictures: PSNR, largest difference, sub-pixel shift
    Compare(CompareArgs),
    /// Find frames of a sequence that are missing, damaged, unlike the others, black or frozen
    Verify(VerifyArgs),
    /// Compare filters on one conversion: error, aliasing, blur and cost of each
    Filters(Box<FiltersArgs>),
    /// Remake the figures of the papers from our own pictures
    Figures(FiguresArgs),
    /// Print a shell's completion script
    Completions(CompletionsArgs),
    /// Print the manual, or write its pages into a folder
    Man(ManArgs),
    /// Print the help of a verb, or of SPECs: projections, keys, other names
    Help(HelpArgs),
}

/// Lists the names of all verbs.
pub(crate) fn verbs() -> impl Iterator<Item = &'static str> {
    VERBS.iter().map(|(verb, _)| *verb)
}

/// Returns the example commands of a verb, or of the program itself without a verb.
pub(crate) fn examples(verb: Option<&str>) -> &'static [&'static str] {
    let of_verb = VERBS.iter().find(|(name, _)| Some(*name) == verb).map(|(_, examples)| *examples);
    of_verb.unwrap_or(&EXAMPLES)
}

/// Returns the long names of a verb's options, without dashes.
pub(crate) fn options(verb: &str) -> Vec<String> {
    let mut command = Args::command();
    command.build();
    let verb = command.find_subcommand(verb);
    let parts = verb.into_iter().flat_map(|verb| std::iter::once(verb).chain(verb.get_subcommands()));
    parts.flat_map(Command::get_arguments).filter_map(Arg::get_long).map(str::to_owned).collect()
}

/// Returns the long names of the options of a verb that another has of its own, without dashes.
pub(crate) fn options_of_part(verb: &str, part: &str) -> Vec<String> {
    let mut command = Args::command();
    command.build();
    let part = command.find_subcommand(verb).and_then(|verb| verb.find_subcommand(part));
    part.into_iter().flat_map(Command::get_arguments).filter_map(Arg::get_long).map(str::to_owned).collect()
}

/// Returns the names of the verbs that a verb has of its own, as `light` does.
pub(crate) fn parts(verb: &str) -> Vec<String> {
    let command = Args::command();
    let parts = command.find_subcommand(verb).into_iter().flat_map(Command::get_subcommands);
    parts.map(|part| part.get_name().to_owned()).collect()
}

/// Last line of short help, which tells where there is more.
const SEE_MORE: &str = "More: '--help' explains every option, 'cosmorama help spec' every projection with its keys.";

/// Returns the list of projections, a line each.
fn projections() -> String {
    let mut text =
        "SPEC is NAME[:key=value[,key=value]...]; 'cosmorama help spec' lists keys and other names:\n\n".to_owned();
    for kind in SpecKind::all() {
        text += &format!("  {:<12} {}\n", kind.name(), kind.about());
    }
    text
}

/// Returns a template of help that begins with examples. As a part of the template they are never wrapped, so that a
/// command is copied whole.
fn with_examples(examples: &[&str]) -> String {
    let lines: String = examples.iter().map(|example| format!("  {example}\n")).collect();
    format!("Examples:\n{lines}\n{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{{all-args}}{{after-help}}")
}
