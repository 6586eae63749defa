//! Arguments of the verbs about the program itself.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use clap_complete::Shell;
use cosmorama_spec::SpecKind;

use super::{verbs, with_examples};
use crate::parse::listed;

/// Example commands in the help of `help`.
pub(super) const EXAMPLES: [&str; 5] = [
    "cosmorama help convert",
    "cosmorama help spec",
    "cosmorama help fisheye",
    "cosmorama help tilt",
    "cosmorama help kernels",
];

/// Example commands in the help of `man`.
pub(super) const MAN_EXAMPLES: [&str; 2] = ["cosmorama man | man -l -", "cosmorama man ~/.local/share/man"];

/// Example commands in the help of `completions`.
pub(super) const COMPLETIONS_EXAMPLES: [&str; 3] = [
    "cosmorama completions bash >> ~/.bash_completion",
    "cosmorama completions zsh > ~/.zfunc/_cosmorama",
    "cosmorama completions fish > ~/.config/fish/completions/cosmorama.fish",
];

/// Topics of help that are lists of names.
pub(crate) const LISTS: [&str; 8] =
    ["kernels", "filters", "transfers", "primaries", "depths", "formats", "naming", "builtins"];

/// Topic of help that is no verb.
pub(crate) const SPEC_TOPIC: &str = "spec";

/// Print the help of a verb, or of SPECs: projections, keys, other names.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct HelpArgs {
    /// A verb, a projection, a key, spec (how projections are typed), kernels, formats, naming…
    #[arg(value_parser = listed::word(verbs().chain([SPEC_TOPIC]).chain(LISTS).map(|topic| (topic, ""))), hide_possible_values = true)]
    pub(crate) topic: Option<String>,
    /// After spec: the one projection whose keys to print; after light: the kind of map
    #[arg(value_parser = listed::word(SpecKind::all().map(|kind| (kind.name(), kind.about()))), hide_possible_values = true)]
    pub(crate) projection: Option<String>,
}

/// Print the manual, or write its pages into a folder.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&MAN_EXAMPLES))]
pub(crate) struct ManArgs {
    /// Write a page for each verb (man1), and one for SPECs (man7), into this folder
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) dir: Option<PathBuf>,
    /// Replace existing pages
    #[arg(short = 'y', long, requires = "dir")]
    pub(crate) overwrite: bool,
}

/// Print a shell's completion script.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&COMPLETIONS_EXAMPLES))]
pub(crate) struct CompletionsArgs {
    /// Which shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}
