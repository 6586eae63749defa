//! The command line as typed. What it means is worked out by `cosmorama-convert`.

mod compare;
pub(crate) mod convert;
mod demo;
mod explain;
pub(crate) mod geometry;
mod info;
mod parse;
mod progress;
mod settings;
mod shell;

use clap::{Parser, Subcommand};

pub(crate) use compare::{CompareArgs, Region};
pub(crate) use convert::ConvertArgs;
pub(crate) use demo::DemoArgs;
pub(crate) use explain::ExplainArgs;
pub(crate) use info::InfoArgs;
pub(crate) use progress::ProgressStyle;
pub(crate) use shell::CompletionsArgs;

/// World projections: Omnimax, fulldome, fisheye, panorama and cube faces, made from one another with an
/// elliptical weighted average filter.
#[derive(Debug, Parser)]
#[command(name = "cosmorama", version, propagate_version = true, arg_required_else_help = true)]
#[command(before_help = "Examples:
  cosmorama demo
  cosmorama convert 'faces/{face}.png' dome.png --to omnimax --size 1966x1436
  cosmorama info 'faces/{face}.png'")]
pub(crate) struct Args {
    /// What to do.
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

/// What can be done.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Render an embedded world onto cube faces and make an Omnimax frame of them
    Demo(DemoArgs),
    /// Turn a world, in whatever form, into another projection
    Convert(Box<ConvertArgs>),
    /// Tell what a file or a face set is
    Info(InfoArgs),
    /// Tell what a conversion will do before it does it, in text and diagrams
    Explain(Box<ExplainArgs>),
    /// Compare two pictures: PSNR, largest difference, sub-pixel shift
    Compare(CompareArgs),
    /// Print a shell's completion script
    Completions(CompletionsArgs),
    /// Print the manual page
    Man,
}
