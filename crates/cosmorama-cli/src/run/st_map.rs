use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use cosmorama::filter::Filter;
use cosmorama::raster::{Depth, Image, Rgba};
use cosmorama::world::{ST_NOWHERE, StPixel};
use cosmorama_io::{Format, WriteOptions, write_planes};
use cosmorama_spec::Missing;

use super::engine::assemble;
use super::report::Report;
use super::stages::{Stage, Stages};
use crate::args::ConvertArgs;
use crate::failure::{usage, warn};
use crate::job::{Builtin, ConvertJob, st_pixels};

/// The names of an st map's numbers, in their order.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Writes the map by which other programs do the conversion.
pub(super) fn convert(args: &ConvertArgs) -> Result<Report> {
    let start = Instant::now();
    let stages = Stages::default();
    if Builtin::named(&args.input)?.is_some() {
        return Err(usage(format!("--st-map tells places in an image, but {} is a formula", args.input)));
    }
    let job = stages.alone(Stage::Plan, || ConvertJob::resolve(args))?;
    check(args, &job)?;
    let depth = job.light.depth;
    if depth == Depth::Half {
        warn(
            "--depth half: halves of an st map tell places to 1/2048 of the picture's width only; leave it out for floats",
        );
    }
    for frame in &job.outputs.frames {
        for (index, path) in &frame.files {
            let sheet = &job.target.files[*index].sheet;
            let map = |view: usize| st_pixels(&job, &job.target.views[view]);
            let image = stages.alone(Stage::Filter, || assemble(sheet, ST_NOWHERE, map))?;
            stages.alone(Stage::Encode, || save(&image, path, depth))?;
        }
    }
    let inputs: BTreeSet<PathBuf> = job.outputs.frames.iter().flat_map(|frame| job.input.paths(frame.frame)).collect();
    Ok(Report::new(inputs, &job.outputs, start.elapsed(), &stages, job.warnings))
}

/// A map holds no colours.
fn check(args: &ConvertArgs, job: &ConvertJob) -> Result<()> {
    if job.target.format != Format::Exr {
        return Err(usage(format!(
            "--st-map writes numbers, but {} is {}; name the output .exr",
            args.output, job.target.format
        )));
    }
    let geometry = &args.geometry;
    let is_plain = geometry.filter.0 == Filter::DEFAULT.kind && geometry.kernel.kernel == Filter::DEFAULT.kernel;
    if !is_plain || geometry.anti_ringing.is_some() {
        return Err(usage(
            "--filter, --kernel and --anti-ringing are for texels that are weighed, but an st map has none; leave them out",
        ));
    }
    let is_transferred = [Some(&args.transfer), args.in_transfer.as_ref(), args.out_transfer.as_ref()];
    if args.background.is_some() || is_transferred.into_iter().flatten().any(|transfer| transfer.fixed().is_some()) {
        return Err(usage(
            "--background, --transfer, --in-transfer and --out-transfer are for light, but an st map has none; leave them out",
        ));
    }
    if matches!(args.missing, Missing::Fill(colour) if colour != Rgba::TRANSPARENT) {
        return Err(usage(
            "--missing: an st map has no colours; give --missing transparent, which leaves places without one",
        ));
    }
    Ok(())
}

fn save(image: &Image<StPixel>, path: &Path, depth: Depth) -> Result<()> {
    let plane = |number: usize| image.pixels().iter().map(|pixel| pixel[number]).collect();
    let planes = CHANNELS.iter().enumerate().map(|(number, name)| (*name, plane(number))).collect();
    write_planes(path, (image.width(), image.height()), planes, depth, &WriteOptions::default())?;
    Ok(())
}
