//! Verification of a sequence's frames: which are missing, damaged, of another kind, black, frozen, or flash.

mod frame;
mod judge;
mod sheet;

use std::ops::ControlFlow;
use std::path::Path;

use cosmorama::raster::{Image, Rgba};
use cosmorama_io::{FrameList, FramePattern, Limits};
use cosmorama_spec::Size;
use rayon::prelude::*;

use super::{Observer, Stop};
use crate::diagnostic::{ConvertError, Result, usage};
use crate::source::{Files, MemoryBudget, ViewFiles, existing_frames, probe};
use frame::Frame;

pub use judge::{Fault, Faults};
pub use sheet::SheetLayout;

/// Sequence to verify.
#[derive(Clone, Debug)]
pub struct Verification<'a> {
    /// Pattern of the frames' names, such as `dome_####.png`.
    pub pattern: &'a str,
    /// Frames that there should be; all from the first to the last, if not given.
    pub frames: Option<FrameList>,
    /// Size that they should have; that of most, if not given.
    pub size: Option<Size>,
    /// Memory that decoded frames may take.
    pub memory: MemoryBudget,
    /// Frames that a contact sheet shows; `None` without one.
    pub sheet: Option<SheetLayout>,
}

/// Result of a verification.
#[derive(Clone, Debug)]
pub struct Verified {
    /// Number of frames that there should be.
    pub frames: usize,
    /// Faults of each frame that has some, in the order of the frames.
    pub faults: Vec<Faults>,
    /// Small pictures of the frames that were asked for, row by row.
    pub sheet: Option<Image<Rgba>>,
}

impl Verified {
    /// Returns the frames with a fault.
    pub fn faulty(&self) -> FrameList {
        FrameList::new(self.faults.iter().map(|of| of.frame))
    }
}

impl Verification<'_> {
    /// Reads every frame, and judges it by itself and beside its neighbours.
    ///
    /// # Errors
    /// When the pattern has no frame marker, or not one frame exists; [`ConvertError::Stopped`] if the observer ends it.
    pub fn run(&self, files: &dyn Files, observer: &mut dyn Observer) -> Result<Verified> {
        let pattern = self.sequence()?;
        let wanted = self.wanted()?;
        observer.begin(wanted.len());
        let mut frames: Vec<Frame> = Vec::with_capacity(wanted.len());
        let limits = Limits::memory(self.memory.bytes);
        let at_once = self.at_once(files, &pattern, &wanted);
        for some in wanted.chunks(at_once) {
            let thumbnails = |frame: u64| self.sheet.is_some_and(|sheet| sheet.shows(wanted[0], frame));
            let read = |frame: &u64| Frame::read(files, (*frame, &pattern.path(*frame)), &limits, thumbnails(*frame));
            frames.extend(some.par_iter().map(read).collect::<Vec<_>>());
            for (done, frame) in (frames.len() - some.len() + 1..).zip(some) {
                if observer.frame_done(Some(*frame)) == ControlFlow::Break(Stop) {
                    return Err(ConvertError::Stopped { done, frames: wanted.len() });
                }
            }
        }
        let sheet = self.sheet.map(|_| sheet::of(frames.iter().filter_map(Frame::thumbnail)));
        Ok(Verified { frames: frames.len(), faults: judge::faults(&frames, self.size), sheet })
    }

    fn sequence(&self) -> Result<FramePattern> {
        match ViewFiles::new(Path::new(self.pattern)) {
            ViewFiles::Sequence(pattern) if !self.pattern.contains("{face}") => Ok(pattern),
            ViewFiles::Sequence(_) => {
                Err(usage(format!("{} has {{face}}; verify the sequence of each face by itself", self.pattern)))
            }
            ViewFiles::One(_) => Err(usage(format!(
                "{} has no frame marker such as #### or %04d; write one where the frame number stands",
                self.pattern
            ))),
        }
    }

    /// Returns the frames that there should be, in order.
    fn wanted(&self) -> Result<Vec<u64>> {
        if let Some(frames) = &self.frames {
            let mut frames = frames.frames().to_vec();
            frames.sort_unstable();
            return Ok(frames);
        }
        let existing = existing_frames(&ViewFiles::new(Path::new(self.pattern)))?;
        match (existing.first(), existing.last()) {
            (Some(&first), Some(&last)) if last - first < MOST => Ok((first..=last).collect()),
            _ => Ok(existing),
        }
    }

    /// Returns the number of frames that fit into memory at once when decoded.
    fn at_once(&self, files: &dyn Files, pattern: &FramePattern, wanted: &[u64]) -> usize {
        let header = wanted.iter().find_map(|frame| probe(files, &pattern.path(*frame)).ok());
        // Samples, and their light in floats.
        let bytes = header.map_or(1, |header| {
            let pixels = (header.width as u64).saturating_mul(header.height as u64);
            pixels.saturating_mul((header.channels.count() * header.depth.bytes() + size_of::<Rgba>()) as u64)
        });
        (self.memory.bytes / bytes.max(1)).clamp(1, AT_ONCE) as usize
    }
}

/// Greatest number of frames between the first and the last; more is a typing error.
const MOST: u64 = 10_000_000;

/// Greatest number of frames that are read together.
const AT_ONCE: u64 = 64;

/// Refuses a contact sheet in the place of a frame.
///
/// # Errors
/// When the sheet's name is one of the sequence's.
pub fn check_sheet(pattern: &str, sheet: &Path) -> Result<()> {
    let ViewFiles::Sequence(frames) = ViewFiles::new(Path::new(pattern)) else { return Ok(()) };
    let is_frame = frames.existing()?.into_iter().any(|frame| frames.path(frame) == sheet);
    if is_frame {
        return Err(usage(format!("{}: the sheet would replace a frame; choose another name", sheet.display())));
    }
    Ok(())
}
