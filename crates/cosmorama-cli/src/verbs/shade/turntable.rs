use std::path::PathBuf;

use anyhow::Result;
use cosmorama::sphere::Angle;
use cosmorama_io::FramePattern;

use crate::args::ShadeArgs;
use crate::failure::usage;

/// A picture that is made: its file, and how far the things are turned.
pub(super) struct Frame {
    pub(super) path: PathBuf,
    pub(super) turn: Angle,
}

/// Lists the pictures that are made: one, or those of a whole turn.
pub(super) fn frames(args: &ShadeArgs) -> Result<Vec<Frame>> {
    let Some(count) = args.turntable else {
        return Ok(vec![Frame { path: args.output.path().to_owned(), turn: Angle::from_degrees(0.0) }]);
    };
    let Some(pattern) = FramePattern::parse(&args.output) else {
        return Err(usage(format!(
            "--turntable: {} has no place for the frame's number; write it as in turn_####.png",
            args.output
        )));
    };
    let turn = |frame: u64| Angle::from_degrees(360.0 * (frame - 1) as f64 / count as f64);
    Ok((1..=count).map(|frame| Frame { path: pattern.path(frame), turn: turn(frame) }).collect())
}
