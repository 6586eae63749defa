//! Verbs of the program, a file for each.

mod compare;
mod convert;
mod demo;
mod explain;
mod filters;
mod help;
mod info;
mod light;
mod papers;
mod shade;
mod verify;

use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result, anyhow};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama_convert::refuse_existing;
use cosmorama_io::pending::NewFolders;
use cosmorama_io::{Format, Metadata, WriteOptions, write};
use cosmorama_spec::DepthName;

use crate::allocator;
use crate::args::{OutputArgs, Verb};
use crate::console::Console;
use crate::failure::usage;
use crate::interrupt;

/// Runs the verb that was typed.
pub(crate) fn run(verb: Verb, console: &mut Console) -> Result<ExitCode> {
    allocator::check_addresses()?;
    interrupt::install(console.unfinished.clone())?;
    if let Verb::Info(_) | Verb::Explain(_) | Verb::Compare(_) | Verb::Filters(_) = verb {
        // Started here, so that it is an error where they cannot be.
        rayon::ThreadPoolBuilder::new().build_global().context("cannot start threads")?;
    }
    match verb {
        Verb::Demo(args) => demo::run(&args, console),
        Verb::Convert(args) => convert::run(*args, console),
        Verb::Light(args) => light::run(args, console),
        Verb::Shade(args) => shade::run(*args, console),
        Verb::Plates(args) => papers::plates::run(&args, console),
        Verb::Info(args) => info::run(&args, console),
        Verb::Explain(args) => explain::run(*args, console),
        Verb::Compare(args) => compare::run(&args, console),
        Verb::Verify(args) => verify::run(&args, console),
        Verb::Filters(args) => filters::run(*args, console),
        Verb::Figures(args) => papers::figures::run(&args, console),
        Verb::Completions(args) => help::completions(&args, console),
        Verb::Man(args) => help::man(&args, console),
        Verb::Help(args) => help::help(&args, console),
    }
}

/// Refuses to replace a file unasked, and makes its folder unless that is to exist. The folder is removed with the returned value
/// if it stays empty.
fn prepare_output(path: &Path, args: OutputArgs, console: &Console) -> Result<Option<NewFolders>> {
    if !args.overwrite {
        refuse_existing([path].into_iter())?;
    }
    make_parent(path, args, console)
}

/// Makes the folder of an output, unless that is to exist. It is removed with the returned value if it stays empty.
fn make_parent(path: &Path, args: OutputArgs, console: &Console) -> Result<Option<NewFolders>> {
    let folder = path.parent().filter(|folder| !args.no_mkdir && !folder.as_os_str().is_empty());
    folder.map(|folder| make_folder(folder, console)).transpose()
}

/// Refuses a sample type that an output, which is `what`, does not hold.
fn check_depth(path: &Path, what: impl Display, depth: Depth, held: &[Depth]) -> Result<()> {
    if held.contains(&depth) {
        return Ok(());
    }
    let names: Vec<&str> = held.iter().map(|depth| DepthName(*depth).name()).collect();
    let (path, depth) = (path.display(), DepthName(depth));
    Err(usage(format!("{path}: {what} has no --depth {depth}; choose {}", names.join(", "))))
}

/// Writes a picture for people to look at, without alpha.
fn write_picture(file: (&Path, Format), picture: &Image<Rgba>, console: &Console) -> Result<()> {
    write_channels(file, Channels::Rgb, picture, console)
}

/// Writes a picture as PNG of 8 bits, with alpha where not all of it is opaque.
fn save_png(path: &Path, picture: &Image<Rgba>, console: &Console) -> Result<()> {
    let is_opaque = picture.pixels().iter().all(|pixel| pixel.alpha() >= 1.0);
    let channels = if is_opaque { Channels::Rgb } else { Channels::Rgba };
    write_channels((path, Format::Png), channels, picture, console)
}

fn write_channels(
    (path, format): (&Path, Format),
    channels: Channels,
    picture: &Image<Rgba>,
    console: &Console,
) -> Result<()> {
    let (depth, channels) = (format.nearest_depth(Depth::Eight), format.nearest_channels(channels));
    let transfer = if depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
    let encoded = EncodedImage::encode(picture, channels, depth, &transfer);
    let metadata = Metadata { transfer: Some(transfer), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    Ok(write(path, &encoded, &options)?)
}

/// Tells of a file that was made.
fn tell_made(console: &Console, path: &Path, what: &str, start: Instant) -> Result<()> {
    console.print(&format!("{:<40} {what} in {:.2} s\n", path.display().to_string(), start.elapsed().as_secs_f64()))
}

/// Makes a folder that does not exist yet, with those above it. Folders that stay empty are removed with the returned
/// value.
fn make_folder(folder: &Path, console: &Console) -> Result<NewFolders> {
    if let Some(file) = folder.ancestors().find(|folder| folder.is_file()) {
        return Err(usage(format!("{} is a file, where a folder was expected; name another", file.display())));
    }
    let mut folders = NewFolders::new(&console.unfinished);
    folders.make(folder).map_err(|error| {
        anyhow!("the folder {} cannot be made ({error}); choose another, where you may write", folder.display())
    })?;
    Ok(folders)
}
