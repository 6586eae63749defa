use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, anyhow};
use cosmorama::camera::{CameraModel, FisheyeCamera, OmnimaxCamera};
use cosmorama::compare::{CompareError, Comparison, Mask, OwnPeak, Registration, compare, difference_image};
use cosmorama::raster::{ColourMatrix, Image, Primaries, Rgba};
use cosmorama_convert::{Files, InputTransfer, MemoryBudget, probe, read, real_path, refuse_existing};
use cosmorama_io::{FacePattern, Format, FramePattern, Header, Limits};
use serde_json::{Value, json};

use super::{make_folder, write_picture};
use crate::args::{CompareArgs, Region};
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;

/// Message about a shift that cannot be measured.
const NOT_MEASURABLE: &str =
    "not measurable: the pictures differ by more than a shift of about a pixel explains, or too few pixels count";

/// Compares two pictures.
pub(super) fn run(args: &CompareArgs, console: &mut Console) -> Result<ExitCode> {
    let (mut kept, mut args) = (KeptStreams::default(), args.clone());
    for picture in [&mut args.first, &mut args.second] {
        // A name that is not UTF-8 cannot stand for many files.
        picture.to_str().map_or(Ok(()), check_one)?;
        *picture = kept.input(&picture.as_path().into())?.path().to_owned();
    }
    let (args, files) = (&args, &*kept.files());
    let format = args.diff.as_deref().map(|diff| diff_format(diff, args)).transpose()?;
    let headers = (probe(files, &args.first)?, probe(files, &args.second)?);
    MemoryBudget::new(args.memory).check_comparison([(&args.first, &headers.0), (&args.second, &headers.1)])?;
    let (first, mut second) = (light(files, &args.first, args)?, light(files, &args.second, args)?);
    let primaries = |header: &Header| header.metadata.primaries.unwrap_or(Primaries::REC709);
    let matrix = ColourMatrix::between(&primaries(&headers.1), &primaries(&headers.0));
    if !matrix.is_identity() {
        matrix.convert(second.pixels_mut());
    }
    let mask = region(args.region, &first)?;
    let comparison = compare(&first, &second, &mask).map_err(|error| {
        let files = format!("cannot compare {} with {}", args.first.display(), args.second.display());
        match &error {
            CompareError::SizesDiffer { first, .. } => anyhow!(
                "{files}: {error}; make the second anew with --size {}x{}, as 'cosmorama convert' does",
                first.0,
                first.1
            ),
            _ => anyhow::Error::new(error).context(files),
        }
    })?;
    if let (Some(path), Some(format)) = (&args.diff, format) {
        let difference = difference_image(&first, &second, &mask, args.gain)?;
        let folder = path.parent().filter(|folder| !args.no_mkdir && !folder.exists());
        let _folders = folder.map(|folder| make_folder(folder, console)).transpose()?;
        write_picture((path, format), &difference, console)?;
    }
    let failures = failures(args, &comparison);
    let text = if args.json { json_text(args, &comparison, &failures)? } else { plain_text(&comparison) };
    console.print(&text)?;
    failures.iter().for_each(|failure| console.report(format_args!("failed: {failure}")));
    Ok(if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Refuses a pattern with an error that says so. Otherwise the error would be that there is no such file.
fn check_one(name: &str) -> Result<()> {
    let is_pattern = FacePattern::parse(name).is_some() || FramePattern::parse(name).is_some();
    if is_pattern && !Path::new(name).exists() {
        return Err(usage(format!("{name} is a pattern, but compare takes two pictures; name one file of it")));
    }
    if Path::new(name).is_dir() {
        return Err(usage(format!("{name} is a folder, but compare takes two pictures; name one file in it")));
    }
    Ok(())
}

/// Returns the format of the difference picture. It may not replace a compared picture, nor any other file unless asked
/// to.
fn diff_format(diff: &Path, args: &CompareArgs) -> Result<Format> {
    let format = Format::from_extension(diff).map_err(|error| usage(error.to_string()))?;
    if [&args.first, &args.second].iter().any(|picture| real_path(picture) == real_path(diff)) {
        let message = format!("{}: --diff would replace a picture to compare; choose another name", diff.display());
        return Err(usage(message));
    }
    if !args.overwrite {
        refuse_existing(std::iter::once(diff))?;
    }
    Ok(format)
}

fn light(files: &dyn Files, path: &Path, args: &CompareArgs) -> Result<Image<Rgba>> {
    let file = read(files, path, &Limits::memory(MemoryBudget::new(args.memory).bytes))?;
    let transfer = InputTransfer::new(&args.transfer, None).of(file.image.depth(), &file.metadata);
    Ok(file.image.to_light(&transfer))
}

/// Returns the mask of the pixels inside a lens, without those that its rim cuts.
fn region(region: Region, image: &Image<Rgba>) -> Result<Mask> {
    let (width, height) = (image.width(), image.height());
    let frame = match region {
        Region::All => return Ok(Mask::everything(width, height)),
        Region::Disc => CameraModel::Fisheye(FisheyeCamera::default()),
        Region::Omnimax => CameraModel::Omnimax(OmnimaxCamera::default()),
    };
    let view = frame.view(width, height)?;
    Ok(Mask::from_fn(width, height, |i, j| view.screen_pixel(i, j).is_some_and(|pixel| pixel.coverage == 1.0)))
}

fn failures(args: &CompareArgs, comparison: &Comparison) -> Vec<String> {
    let mut failures = Vec::new();
    if let Some(least) = args.min_psnr.filter(|least| comparison.linear.psnr < *least) {
        failures.push(format!("PSNR {:.2} dB is less than --min-psnr {least}", comparison.linear.psnr));
    }
    if let Some(most) = args.max_shift {
        match comparison.registration {
            Some(registration) if registration.shift() <= most => {}
            Some(found) => failures.push(format!("a shift of {:.4} px is more than --max-shift {most}", found.shift())),
            None => failures.push(format!("the shift is {NOT_MEASURABLE}")),
        }
    }
    failures
}

fn plain_text(comparison: &Comparison) -> String {
    let Comparison { pixels, linear, own_peak, srgb, edge_free, alpha, registration } = comparison;
    let (of_one, clipped) = match own_peak {
        Some(_) => (" of a peak of 1", "; light above 1 is clipped"),
        None => ("", ""),
    };
    let mut text = format!(
        "pixels compared    {pixels}\n\
         PSNR linear        {:.2} dB{of_one} (rms {:.6}, mean {:+.6})\n\
         PSNR sRGB-encoded  {:.2} dB (rms {:.6}, mean {:+.6}{clipped})\n",
        linear.psnr, linear.rms, linear.mean, srgb.psnr, srgb.rms, srgb.mean
    );
    if let Some(OwnPeak { peak, psnr, relative }) = own_peak {
        text += &format!(
            "PSNR of own peak   {psnr:.2} dB (linear, of {peak}, the second picture's brightest; the rms is {:.3} % of that \
             picture's)\n",
            100.0 * relative
        );
    }
    if let Some(edge_free) = edge_free {
        text += &format!(
            "PSNR off edges     {:.2} dB (linear, of the {} more than 2 pixels from any edge, where filters agree)\n",
            edge_free.linear.psnr, edge_free.pixels
        );
    }
    let (column, row) = linear.largest.pixel;
    text += &format!(
        "largest difference {:.6} at {column},{row} (99.9 % are within {:.6}; alpha: {alpha:.6})\n",
        linear.largest.value, linear.percentile_99_9
    );
    text + &shift_text(*registration)
}

fn shift_text(registration: Option<Registration>) -> String {
    match registration {
        Some(found) => format!(
            "shift              {:.4} px (x {:+.4}, y {:+.4}; scale {:+.2e} {:+.2e}, turn {:+.2e})\n",
            found.shift(),
            found.dx,
            found.dy,
            found.scale_x,
            found.scale_y,
            found.rotation
        ),
        None => format!("shift              {NOT_MEASURABLE}\n"),
    }
}

fn json_text(args: &CompareArgs, comparison: &Comparison, failures: &[String]) -> Result<String> {
    let difference = |difference: &cosmorama::compare::Difference| {
        json!({
            "psnr": decibels(difference.psnr),
            "rms": difference.rms,
            "mean": difference.mean,
            "largest": difference.largest.value,
            "largest_at": [difference.largest.pixel.0, difference.largest.pixel.1],
            "percentile_99_9": difference.percentile_99_9,
        })
    };
    let report = json!({
        "first": args.first.display().to_string(),
        "second": args.second.display().to_string(),
        "pixels": comparison.pixels,
        "linear": difference(&comparison.linear),
        "srgb": difference(&comparison.srgb),
        "own_peak": comparison.own_peak.map(|OwnPeak { peak, psnr, relative }| json!({
            "peak": peak, "psnr": decibels(psnr), "relative_rms": relative,
        })),
        "edge_free_psnr": comparison.edge_free.map(|edge_free| decibels(edge_free.linear.psnr)),
        "alpha": comparison.alpha,
        "shift": comparison.registration.map(|found| json!({
            "pixels": found.shift(), "x": found.dx, "y": found.dy,
            "scale_x": found.scale_x, "scale_y": found.scale_y, "rotation": found.rotation,
        })),
        "failures": failures,
    });
    Ok(serde_json::to_string_pretty(&report)? + "\n")
}

/// Converts decibels to JSON, which has no infinity: pictures that do not differ have no figure.
pub(super) fn decibels(psnr: f64) -> Value {
    if psnr.is_finite() { json!(psnr) } else { Value::Null }
}
