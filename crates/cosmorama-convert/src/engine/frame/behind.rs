//! The world behind the input's alpha.

use std::sync::{Mutex, MutexGuard};

use cosmorama::camera::View;
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Progress, Stopped};
use rayon::prelude::*;

use crate::diagnostic::{Diagnostic, Result};
use crate::engine::warnings::Tally;
use crate::engine::{Engine, FrameFile, FrameLight, Spent, Stages, ViewImage, Which, WriterOptions};
use crate::job::ConvertJob;
use crate::source::lock;

/// The world behind the input, with its light in the frame that is made.
pub(super) struct Behind<'a> {
    pub(super) engine: Engine<'a>,
    held: Mutex<Held>,
    tally: Mutex<Tally>,
}

/// Light of a backdrop's frame.
struct Held {
    light: FrameLight,
    /// The frame; `None` before any is read.
    frame: Option<Option<u64>>,
}

impl<'a> Behind<'a> {
    /// Prepares the backdrop of a job, if it has one.
    pub(super) fn new(job: &'a ConvertJob, progress: &dyn Progress) -> Result<Option<Box<Self>>, Stopped> {
        let Some(backdrop) = &job.backdrop else { return Ok(None) };
        let engine = Engine::new(backdrop, WriterOptions::default(), progress)?;
        let held = Mutex::new(Held { light: engine.frame_light(), frame: None });
        Ok(Some(Box::new(Self { engine, held, tally: Mutex::default() })))
    }

    /// Returns the diagnostics about its light in all frames.
    pub(super) fn tallied(&self) -> Vec<Diagnostic> {
        lock(&self.tally).warnings(self.engine.job)
    }

    /// Lays the picture of a view over what lies behind it, in the frame at a place among all. `make` renders that from the backdrop's own
    /// frame and its light.
    pub(super) fn lay_under(
        &self,
        (view, image): (&View, &mut Image<Rgba>),
        place: usize,
        make: impl FnOnce(&Engine<'a>, (Option<u64>, &FrameLight)) -> Result<Image<Rgba>>,
    ) -> Result<()> {
        let own = self.engine.job.input.frames[place];
        let held = self.read(own)?;
        let under = make(&self.engine, (own, &held.light))?;
        let width = image.width().max(1);
        let rows = image.pixels_mut().par_chunks_mut(width).zip(under.pixels().par_chunks(width)).enumerate();
        rows.for_each(|(j, (row, under))| {
            for (i, (pixel, under)) in row.iter_mut().zip(under).enumerate() {
                // The rim of a lens cuts both alike: what it leaves of the one lies before what it leaves of the other.
                let is_cut = pixel.alpha() > 0.0 && under.alpha() > 0.0 && under.alpha() < 1.0;
                let screen = if is_cut { view.screen_pixel(i, j) } else { None };
                let part = screen.map_or(1.0, |screen| screen.coverage as f32);
                *pixel += *under * (1.0 - pixel.alpha() / part).max(0.0);
            }
        });
        self.engine.pool().give_image(under);
        Ok(())
    }

    /// Asks something of the backdrop's own frame at a place among all, and of its light.
    pub(super) fn ask<T>(
        &self,
        place: usize,
        question: impl FnOnce(&Engine<'a>, &FrameLight) -> Result<T>,
    ) -> Result<T> {
        question(&self.engine, &self.read(self.engine.job.input.frames[place])?.light)
    }

    /// Reads the light of a frame, unless it is held.
    fn read(&self, frame: Option<u64>) -> Result<MutexGuard<'_, Held>> {
        let (job, pool, mut held) = (self.engine.job, self.engine.pool(), lock(&self.held));
        if held.frame == Some(frame) {
            return Ok(held);
        }
        let is_first = held.frame.is_none();
        let files = FrameFile::all(job, frame, if is_first { Which::All } else { Which::Moving });
        // In the order of files, so that of several errors it is always the same that is told.
        let read: Vec<Result<Vec<ViewImage>>> = files.into_par_iter().map(|file| file.read(job, pool)).collect();
        let mut images: Vec<ViewImage> = read.into_iter().collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
        let spent = if job.input.frames.len() > 1 { Spent::Kept } else { Spent::Freed };
        held.light.fill(job, frame, (&mut images, spent), (&Stages::default(), pool))?;
        images.into_iter().for_each(|image| pool.give(image.image.into_samples()));
        held.frame = Some(frame);
        lock(&self.tally).add(job, frame, &held.light);
        self.engine.will_tell(self.engine.warnings(frame, &held.light));
        if is_first {
            self.engine.will_tell(self.engine.continuity(&held.light).into_iter().collect());
        }
        Ok(held)
    }
}
