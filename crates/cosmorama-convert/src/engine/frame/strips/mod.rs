//! Pictures that are too large to be held. They are made strip by strip while they are written.

use std::ops::{ControlFlow, Range};
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::motion::Moment;
use cosmorama::raster::{EncodedImage, Image, Pixel, Threads};
use cosmorama::render::{Progress, Share, Stopped};
use cosmorama_io::pending::Hidden;
use cosmorama_io::{LayeredRows, Plane};

use super::blur::FramePart;
use super::pictures::{Engine, Layer, Making};
use crate::diagnostic::{ConvertError, Diagnostic, Result, failure};
use crate::engine::geometry::{bytes_of_passes, partly_anew};
use crate::engine::{BalancedLight, FrameLight, FrameWords, FurtherFiles, Geometry, LayerPass, Levels, Posed, Shares};
use crate::job::{ConvertJob, FrameOutputs, STRIP};
use crate::target::{Strip, TargetFile};

/// Geometry of the strips of a job's pictures, which all its frames share: as much of it as fits into memory. Empty where strips are
/// made once, and where the camera moves.
#[derive(Default)]
pub(crate) struct KeptStrips {
    /// Rows and geometry of the strips of each file, from above.
    files: Vec<Vec<(Range<usize>, Arc<Geometry>)>>,
}

impl KeptStrips {
    /// Compiles the geometry of strips that are made again, of pictures of a `whole` geometry. Also returns the warnings about it.
    pub(super) fn new(
        job: &ConvertJob,
        whole: &Geometry,
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        if job.is_by_strips() && job.outputs.are_many() {
            Self::compile(job, whole, progress)
        } else {
            Ok((Self::default(), Vec::new()))
        }
    }

    fn compile(
        job: &ConvertJob,
        whole: &Geometry,
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        let (mut kept, mut told, mut all) = (Self::default(), Vec::new(), 0);
        let pixels: usize = job.target.files.iter().map(|file| area(file.sheet.size)).sum();
        // Strips that are not kept need room for their plan.
        let (mut bytes, mut done) = (bytes_of_passes(job), 0);
        for (file, TargetFile { sheet, .. }) in job.target.files.iter().enumerate() {
            let mut strips = Vec::new();
            for top in (0..sheet.size.1).step_by(STRIP) {
                let rows = with_margin(top..sheet.size.1.min(top + STRIP), sheet.size.1, job.strips_have_margins());
                let strip = Strip::of(&job.target, file, rows);
                // Margins are made twice.
                let at = |done: usize| (done as f64 / pixels as f64).min(1.0);
                let share = Share { whole: progress, from: at(done), to: at(done + area(strip.sheet.size)) };
                done += area(strip.sheet.size);
                let views = strip.views(&job.target.views);
                let (geometry, warnings) = Geometry::of_strip((job, whole), (&strip, &views, true), bytes, &share)?;
                all += views.len();
                if geometry.is_whole() {
                    bytes += geometry.bytes();
                    strips.push((strip.rows, Arc::new(geometry)));
                }
                told.extend(warnings.into_iter().filter(|warning| !told.contains(warning)).collect::<Vec<_>>());
            }
            kept.files.push(strips);
        }
        if !told.is_empty() && kept.kept() > 0 {
            told = vec![partly_anew(kept.kept(), all)];
        }
        Ok((kept, told))
    }

    /// Returns the geometry of a strip, if it is kept.
    fn of(&self, strip: &Strip) -> Option<Arc<Geometry>> {
        let kept = self.files.get(strip.file)?.iter().find(|(rows, _)| *rows == strip.rows)?;
        Some(Arc::clone(&kept.1))
    }

    fn all(&self) -> impl Iterator<Item = &Geometry> {
        self.files.iter().flatten().map(|(_, geometry)| &**geometry)
    }

    /// Returns the number of plans that are kept.
    pub(super) fn kept(&self) -> usize {
        self.all().map(Geometry::kept).sum()
    }

    /// Returns the bytes that it holds.
    pub(super) fn bytes(&self) -> u64 {
        self.all().map(Geometry::bytes).sum()
    }
}

/// A frame whose files are made strip by strip.
#[derive(Clone, Copy)]
struct Whole<'a> {
    frame: &'a FrameOutputs,
    light: &'a FrameLight,
    layer: &'a Layer,
    /// Moments of its exposure.
    moments: Option<&'a [Moment]>,
    /// Files of its further channels.
    further: &'a FurtherFiles<'a>,
    progress: &'a dyn Progress,
}

impl Engine<'_> {
    /// Makes the files of a frame and writes them, but for their names.
    pub(super) fn strips(
        &self,
        frame: &FrameOutputs,
        light: &FrameLight,
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let (layer, moments) = (self.layer(frame, progress)?, self.blur_of(frame)?);
        let pixels_of = |(file, _): &(usize, PathBuf)| area(self.job.target.files[*file].sheet.size);
        let pixels: usize = frame.files.iter().map(pixels_of).sum();
        let further = &FurtherFiles::new(self.job, frame.frame);
        let mut done = 0;
        let written = |file: &(usize, PathBuf)| {
            let at = |done: usize| done as f64 / pixels as f64;
            let share = Share { whole: progress, from: at(done), to: at(done + pixels_of(file)) };
            done += pixels_of(file);
            let moments = moments.as_deref();
            let whole = Whole { frame, light, layer: &layer, moments, further, progress: &share };
            Ok(Levels::Written(self.file_by_strips(&whole, file)?))
        };
        frame.files.iter().map(written).collect()
    }

    fn file_by_strips(&self, whole: &Whole, (file, path): &(usize, PathBuf)) -> Result<Hidden> {
        let size = self.job.target.files[*file].sheet.size;
        let at = |rows: usize| (rows as f64 / size.1 as f64).min(1.0);
        let (mut done, mut failed) = (0, None);
        let mut make = |rows: Range<usize>| {
            let share = Share { whole: whole.progress, from: at(done), to: at(done + rows.len()) };
            done += rows.len();
            let made = self.rows(&Whole { progress: &share, ..*whole }, *file, rows);
            made.map_err(|error: ConvertError| failed = Some(error)).ok()
        };
        let origin = self.job.origin_of(whole.frame.frame)?.map(Arc::from);
        let words = FrameWords { place: whole.layer.place, carried: whole.light.carried(), origin };
        let written = if self.job.layers.is_plain() {
            self.writer().save_rows(words, path, (size, STRIP), &mut |rows| make(rows)?.picture)
        } else {
            self.writer().save_layer_rows(words, path, (size, STRIP), &self.job.layers, &mut make)
        };
        failed.map_or(written, Err)
    }

    /// Makes rows of a file. Where some lack texels, or a view, neighbours decide what becomes of them; so a margin is made, too.
    fn rows(&self, whole: &Whole, file: usize, rows: Range<usize>) -> Result<LayeredRows> {
        let (width, height) = self.job.target.files[file].sheet.size;
        let has_margin = self.job.strips_have_margins() || !self.is_complete(whole.light);
        let made = with_margin(rows.clone(), height, has_margin);
        let strip = Strip::of(&self.job.target, file, made.clone());
        let wanted = rows.start - made.start..rows.end - made.start;
        let layers = &self.job.layers;
        // What is blurred has geometry of its own.
        let is_filtered = whole.moments.is_none() && !layers.leaves_picture_out();
        let times = if is_filtered { self.layers() } else { 0 } + layers.groups.len();
        let end = if whole.moments.is_some() { 1.0 / (1 + layers.groups.len()) as f64 } else { 0.0 };
        let blurred = Share { whole: whole.progress, from: 0.0, to: end };
        let rest = Share { from: end, to: 1.0, ..blurred };
        let mut making = (times > 0).then(|| self.making(whole.layer, (&strip, times), &rest)).transpose()?;
        let picture = if layers.leaves_picture_out() {
            None
        } else {
            let whole = Whole { progress: &blurred, ..*whole };
            Some(self.picture_of(&whole, (&strip, wanted.clone()), making.as_mut())?)
        };
        let wanted = wanted.start * width..wanted.end * width;
        let part = |plane: Plane| Plane { samples: plane.samples.part(wanted.clone()), ..plane };
        let planes = self.planes_of(whole, &strip, making.as_mut())?.into_iter().map(part).collect();
        Ok(LayeredRows { picture, planes })
    }

    /// Prepares to filter the views of a strip so many times.
    fn making<'p>(
        &self,
        whole: &Layer,
        (strip, times): (&Strip, usize),
        progress: &'p dyn Progress,
    ) -> Result<Making<'p>> {
        let views = strip.views(&self.job.target.views);
        let all = views.iter().map(|target| &target.view).cycle().take(views.len() * times);
        Ok(Making { layer: self.layer_of_strip(whole, strip)?, shares: Shares::new(progress, all) })
    }

    /// Makes the samples of a strip's wanted rows.
    fn picture_of(
        &self,
        whole: &Whole,
        (strip, wanted): (&Strip, Range<usize>),
        making: Option<&mut Making>,
    ) -> Result<EncodedImage> {
        let &Whole { frame, light, moments, progress, .. } = whole;
        let part = FramePart { frame, strip: Some(strip) };
        let made = match (moments, making) {
            (Some(moments), _) => self.render_blurred(part, (light, moments), progress)?.pop(),
            (None, Some(making)) => Some(self.render_sheets(&[&strip.sheet], (frame.frame, light), making)?),
            (None, None) => None,
        };
        let encoded = match made {
            Some(Levels::Light(mut made)) => {
                made.pop().map(|image| self.writer().encode(self.rows_of(image, wanted), Threads::All))
            }
            Some(Levels::Codes(mut made)) => {
                made.pop().map(|image| EncodedImage::of_codes(self.rows_of(image, wanted)))
            }
            Some(Levels::Encoded(_) | Levels::Written(_) | Levels::Layered { .. }) | None => None,
        };
        encoded.ok_or_else(|| failure!("a strip has no picture"))
    }

    /// Makes the further channels of a strip.
    fn planes_of(&self, whole: &Whole, strip: &Strip, making: Option<&mut Making>) -> Result<Vec<Plane>> {
        let making = making.filter(|_| !self.job.layers.groups.is_empty());
        let Some(Making { layer, shares }) = making else { return Ok(Vec::new()) };
        let pass = LayerPass { job: self.job, posed: &layer.posed, pool: &self.pool };
        Ok(pass.make(whole.further, &[&strip.sheet], shares)?.pop().unwrap_or_default())
    }

    /// Returns rows of an image, whose memory goes back to the pool.
    fn rows_of<P: Pixel>(&self, image: Image<P>, rows: Range<usize>) -> Image<P> {
        if rows.len() == image.height() {
            return image;
        }
        let width = image.width();
        let mut part = self.pool.take_image(width, rows.len());
        part.pixels_mut().copy_from_slice(&image.pixels()[rows.start * width..rows.end * width]);
        self.pool.give_image(image);
        part
    }

    /// Returns the geometry of a strip, and of what lies behind it, in the pose of the whole.
    pub(super) fn layer_of_strip(&self, whole: &Layer, strip: &Strip) -> Result<Layer> {
        let (pose, views) = (whole.posed.pose, strip.views(&whole.posed.views));
        let posed = match self.strips.of(strip) {
            Some(geometry) => Posed::of((pose, views), geometry),
            // What is told of the geometry is told of the whole.
            None => {
                let own = (self.job, &*whole.posed.geometry);
                let kept = self.strips.bytes();
                let own = Geometry::of_strip(own, (strip, &views, false), kept, &|_: f64| ControlFlow::Continue(()));
                Posed::of((pose, views), Arc::new(own.map_err(|Stopped| self.stopped())?.0))
            }
        };
        let behind = self.behind.as_ref().zip(whole.behind.as_ref());
        let behind = behind.map(|(behind, whole)| behind.engine.layer_of_strip(whole, strip).map(Box::new));
        let (posed, behind) = (Arc::new(posed), behind.transpose()?);
        Ok(Layer { place: whole.place, posed, balanced: BalancedLight::default(), behind })
    }
}

/// Returns rows with those beside them on which they depend: pixels around one that is filled, and those around these, which tell where
/// the world ends.
fn with_margin(rows: Range<usize>, height: usize, is_needed: bool) -> Range<usize> {
    let margin = if is_needed { 3 } else { 0 };
    rows.start.saturating_sub(margin)..height.min(rows.end + margin)
}

fn area((width, height): (usize, usize)) -> usize {
    width * height
}

#[cfg(test)]
mod tests;
