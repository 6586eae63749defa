use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result, bail};
use cosmorama::raster::{EncodedImage, Image, Rgba};
use cosmorama::resample::{Plan, Resampler, ScreenMask};
use cosmorama::world::{View, World};
use cosmorama_io::{Header, Limits, WriteOptions, read, write};
use rayon::prelude::*;

use crate::failure::warn;
use crate::job::{ConvertJob, Coverage, Files, InputView};

/// Makes the outputs of a job, one frame at a time.
pub(super) struct Engine<'a> {
    job: &'a ConvertJob,
    world: World,
    /// Compiled geometry by target view, where that pays and fits into memory.
    plans: Vec<Option<Plan>>,
    masks: Vec<OnceLock<ScreenMask>>,
    texels: Vec<Rgba>,
    /// The frame whose light is in `texels`.
    loaded: Option<Option<u64>>,
    /// Texels of opaque inputs that are missing (NaN) in the loaded frame, by view.
    missing: Vec<usize>,
    pub(super) warnings: Vec<String>,
}

impl<'a> Engine<'a> {
    /// Prepares the geometry.
    pub(super) fn new(job: &'a ConvertJob) -> Result<Self> {
        let views = job.input.present().map(|(input, _, view)| (input.name.clone(), *view));
        let world = World::new(views)?;
        let texels = vec![Rgba::TRANSPARENT; world.texel_count()];
        let missing = vec![0; world.sources().len()];
        let masks = job.target.views.iter().map(|_| OnceLock::new()).collect();
        let mut engine =
            Self { job, world, plans: Vec::new(), masks, texels, loaded: None, missing, warnings: Vec::new() };
        engine.plans = engine.compile();
        Ok(engine)
    }

    /// Geometry for many frames is computed once, as far as it fits into memory.
    fn compile(&self) -> Vec<Option<Plan>> {
        let mut left = self.job.memory.left_for_plan(&self.job.input, &self.job.target);
        let pays = self.job.outputs.frames.len() > 1;
        let mut plan_of = |view: &View| {
            let resampler = self.resampler(view);
            if !pays || resampler.plan_bytes_estimate() as u64 > left {
                return None;
            }
            let plan = resampler.plan()?;
            left = left.saturating_sub(plan.bytes() as u64);
            Some(plan)
        };
        self.job.target.views.iter().map(|target| plan_of(&target.view)).collect()
    }

    fn resampler<'b>(&'b self, target: &'b View) -> Resampler<'b> {
        Resampler { world: &self.world, target, filter: self.job.filter }
    }

    /// Reads the light of a frame.
    pub(super) fn load(&mut self, frame: Option<u64>) -> Result<()> {
        let inputs: Vec<(&InputView, &Header)> =
            self.job.input.present().map(|(view, header, _)| (view, header)).collect();
        let mut rest = self.texels.as_mut_slice();
        let mut parts = Vec::new();
        for (source, (input, header)) in self.world.sources().iter().zip(inputs) {
            let (part, after) = rest.split_at_mut(source.texels().len());
            rest = after;
            // What does not change from frame to frame is read once.
            let stays = self.loaded.is_some() && matches!(input.files, Files::One(_));
            parts.push((input, header, part, stays));
        }
        let job = self.job;
        let counts: Result<Vec<Option<usize>>> = parts
            .into_par_iter()
            .map(
                |(input, header, part, stays)| {
                    if stays { Ok(None) } else { load_view(job, input, header, frame, part).map(Some) }
                },
            )
            .collect();
        for (index, count) in counts?.into_iter().enumerate() {
            if let Some(count) = count {
                self.missing[index] = count;
            }
        }
        self.loaded = Some(frame);
        self.tell_missing(frame);
        Ok(())
    }

    fn tell_missing(&mut self, frame: Option<u64>) {
        for (source, &count) in self.world.sources().iter().zip(&self.missing).filter(|(_, count)| **count > 0) {
            let number = frame.map_or_else(String::new, |frame| format!(" of frame {frame}"));
            let message = format!("{}{number}: {count} pixels are NaN and count as missing", source.name);
            warn(&message);
            self.warnings.push(message);
        }
    }

    /// Makes an output of the loaded frame: filtered light, complete with what lies outside.
    pub(super) fn render(&self, index: usize) -> Result<Image<Rgba>> {
        let target = &self.job.target.views[index];
        let mut image = match &self.plans[index] {
            Some(plan) => plan.apply(&self.texels),
            None => self.resampler(&target.view).render(&self.texels),
        };
        self.close_holes(index, &mut image)?;
        if let Coverage::Fill(colour) = self.job.coverage {
            self.mask(index).fill_unseen(&mut image, colour);
        }
        self.lay_background(index, &mut image);
        Ok(image)
    }

    fn mask(&self, index: usize) -> &ScreenMask {
        self.masks[index].get_or_init(|| ScreenMask::new(&self.world, &self.job.target.views[index].view))
    }

    /// Missing texels of opaque inputs leave the pixel to the others; a pixel that has none left is like one that no
    /// view covers.
    fn close_holes(&self, index: usize, image: &mut Image<Rgba>) -> Result<()> {
        if self.job.light.input_alpha || self.missing.iter().all(|count| *count == 0) {
            return Ok(());
        }
        let fill = self.job.fill_for_missing();
        let empty = self.mask(index).close_holes(image, fill.unwrap_or(Rgba::TRANSPARENT));
        if empty > 0 && fill.is_none() {
            let culprits: Vec<_> =
                self.world.sources().iter().zip(&self.missing).filter(|(_, count)| **count > 0).collect();
            let names: Vec<_> = culprits.iter().map(|(source, count)| format!("{} ({count})", source.name)).collect();
            bail!(
                "{empty} pixels of {} see nothing but missing pixels (NaN), found in {}; render those again, or fill the \
                 gaps with --missing COLOR or --missing transparent",
                self.job.target.views[index].name,
                names.join(", ")
            );
        }
        Ok(())
    }

    fn lay_background(&self, index: usize, image: &mut Image<Rgba>) {
        let background = self.job.light.background;
        if !self.job.light.channels.has_alpha() {
            // A file without alpha shows everything in front of the background.
            image.pixels_mut().par_iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        } else if background != Rgba::TRANSPARENT {
            self.mask(index).surround(image, background);
        }
    }

    /// Writes an output.
    pub(super) fn save(&self, image: &Image<Rgba>, path: &Path, quality: u8) -> Result<()> {
        let light = &self.job.light;
        let encoded = EncodedImage::encode(image, light.channels, light.depth, &light.transfer);
        write(path, &encoded, &light.metadata, &WriteOptions { quality })?;
        Ok(())
    }

    /// The input files of a frame.
    pub(super) fn inputs(&self, frame: Option<u64>) -> Vec<PathBuf> {
        self.job.input.paths(frame)
    }
}

/// Reads the light of one file; counts what is missing of an opaque one.
fn load_view(
    job: &ConvertJob,
    input: &InputView,
    header: &Header,
    frame: Option<u64>,
    part: &mut [Rgba],
) -> Result<usize> {
    let path = input.files.path(frame);
    let file = read(&path, &Limits::memory(job.memory.bytes))?;
    let (found, expected) = ((file.image.width(), file.image.height()), (header.width, header.height));
    if found != expected || file.window != header.window {
        bail!(
            "{}: {}x{} pixels, but the first frame has {}x{}{}; all frames must have the same size and window",
            path.display(),
            found.0,
            found.1,
            expected.0,
            expected.1,
            if found == expected { " at another place of its canvas" } else { "" }
        );
    }
    let transfer = job.light.input_transfer(file.image.depth(), &file.metadata);
    file.image.decode(&transfer, part);
    let opaque = !file.image.channels().has_alpha();
    if !(opaque && file.image.depth().is_float()) {
        return Ok(0);
    }
    let missing = part.iter().filter(|texel| texel.alpha() == 0.0).count();
    if missing == part.len() && job.fill_for_missing().is_none() {
        return Err(anyhow::anyhow!("every pixel is NaN"))
            .with_context(|| format!("{}: the {} view holds no light; render it again", path.display(), input.name));
    }
    Ok(missing)
}
