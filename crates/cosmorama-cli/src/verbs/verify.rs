use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Result;
use cosmorama_convert::{Disk, Fault, SheetLayout, Verification, Verified, check_sheet};
use cosmorama_io::pending::{NewFolders, Pending};
use cosmorama_io::{Format, FrameList, is_video};
use serde_json::{Value, json};

use super::convert::Watch;
use super::{prepare_output, write_picture};
use crate::args::{FramesAsked, OutputArgs, VerifyArgs};
use crate::console::Console;
use crate::failure::usage;

/// Verifies a sequence, and reports its faults.
pub(super) fn run(args: &VerifyArgs, console: &Console) -> Result<ExitCode> {
    if &*args.pattern == "-" {
        return Err(usage(
            "a stream is not verified as it comes; write it to a file first, as frames.y4m, and verify that",
        ));
    }
    let format = args.sheet.as_deref().map(sheet_format).transpose()?;
    let _folders = args.sheet.as_deref().map(|sheet| prepare_sheet(sheet, args, console)).transpose()?;
    let (frames, times) = FramesAsked::parted(args.frames.clone());
    let verification = Verification {
        pattern: &args.pattern,
        frames,
        times,
        size: args.size,
        limits: args.limits.clone().into(),
        sheet: args.sheet.as_ref().map(|_| SheetLayout { every: args.every }),
    };
    let mut watch = Watch::new(console, args.progress);
    let verified = verification.run(Arc::new(Disk), &mut watch)?;
    watch.finish();
    let text = if args.json {
        serde_json::to_string_pretty(&json_of(args, &verified))? + "\n"
    } else {
        text_of(args, &verified)
    };
    console.print(&text)?;
    if let (Some(path), Some(format), Some(sheet)) = (&args.sheet, format, &verified.sheet) {
        write_picture((path, format), sheet, console)?;
    }
    if verified.faults.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    console.fail_for_engine(&format!("frames with faults: {}", verified.faulty()));
    Ok(ExitCode::FAILURE)
}

/// Returns the format of a sheet.
fn sheet_format(sheet: &Path) -> Result<Format> {
    Format::from_extension(sheet).map_err(|error| {
        if is_video(sheet) {
            let picture = sheet.with_extension("png");
            return usage(format!("{}: a sheet is one picture; name it {}", sheet.display(), picture.display()));
        }
        usage(error.to_string())
    })
}

/// Refuses to replace a frame, or a file unasked, and makes the sheet's folder. If it cannot be written there, that is told before
/// all frames are read.
fn prepare_sheet(sheet: &Path, args: &VerifyArgs, console: &Console) -> Result<Option<NewFolders>> {
    check_sheet(&args.pattern, sheet)?;
    let file = OutputArgs { overwrite: args.overwrite, no_mkdir: args.no_mkdir };
    let folders = prepare_output(sheet, file, console)?;
    Pending::create(sheet, &console.unfinished)?;
    Ok(folders)
}

/// Returns the list of faults, a line for each kind or damaged frame.
fn text_of(args: &VerifyArgs, verified: &Verified) -> String {
    let mut lines: Vec<(String, Vec<u64>)> = Vec::new();
    for of in &verified.faults {
        for fault in &of.faults {
            let told = told(fault);
            match lines.iter_mut().find(|(line, _)| *line == told) {
                Some((_, frames)) => frames.push(of.frame),
                None => lines.push((told, vec![of.frame])),
            }
        }
    }
    let line = |(told, frames): (String, Vec<u64>)| format!("{told}: {}\n", FrameList::new(frames));
    let list: String = lines.into_iter().map(line).collect();
    // Some codecs have no sums by which it could know.
    let so_far = if is_video(Path::new(&args.pattern)) { ", as far as its decoder tells" } else { "" };
    match (verified.faults.len(), verified.frames) {
        (0, 1) => format!("1 frame is whole{so_far}\n"),
        (0, frames) => format!("{frames} frames are whole and alike{so_far}\n"),
        (1, 1) => format!("{list}the only frame has faults: {}\n", verified.faulty()),
        (1, frames) => format!("{list}1 of {frames} frames has faults: {}\n", verified.faulty()),
        (faulty, frames) => format!("{list}{faulty} of {frames} frames have faults: {}\n", verified.faulty()),
    }
}

fn told(fault: &Fault) -> String {
    match fault {
        Fault::Missing => "missing".to_owned(),
        Fault::Damaged(reason) => format!("damaged ({reason})"),
        Fault::Size { found: (width, height), expected } => format!("of size {width}x{height} instead of {expected}"),
        Fault::Kind(kind) => format!("unlike most, {kind}"),
        Fault::Settings => "made by other settings than most".to_owned(),
        Fault::Held => "made of another frame, in the place of a damaged one".to_owned(),
        Fault::Traces => "made of a frame that takes after a damaged one, and may show traces of it".to_owned(),
        Fault::Black => "black".to_owned(),
        Fault::Frozen => "equal to the frame before".to_owned(),
        Fault::Flash => "a flash, far from both neighbours".to_owned(),
    }
}

fn json_of(args: &VerifyArgs, verified: &Verified) -> Value {
    let fault = |frame: u64, fault: &Fault| {
        let mut found = json!({ "frame": frame, "fault": fault.name() });
        match fault {
            Fault::Damaged(reason) => found["reason"] = json!(reason),
            Fault::Size { found: (width, height), expected } => {
                found["found"] = json!(format!("{width}x{height}"));
                found["expected"] = json!(expected.to_string());
            }
            Fault::Kind(kind) => found["found"] = json!(kind),
            Fault::Missing | Fault::Settings | Fault::Held | Fault::Traces => {}
            Fault::Black | Fault::Frozen | Fault::Flash => {}
        }
        found
    };
    let faults = verified.faults.iter().flat_map(|of| of.faults.iter().map(|one| fault(of.frame, one)));
    json!({
        "pattern": &*args.pattern,
        "frames": verified.frames,
        "whole": verified.frames - verified.faults.len(),
        "faults": faults.collect::<Vec<_>>(),
        "frames_with_faults": verified.faulty().to_string(),
        "sheet": args.sheet.as_ref().map(|sheet| sheet.display().to_string()),
    })
}
