use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result, bail};
use cosmorama::raster::{Decoder, EncodedImage, Image, Rgba};
use cosmorama::resample::{Plan, Resampler, ScreenMask};
use cosmorama::world::{Source, World};
use cosmorama_io::{Header, Limits, WriteOptions, read, write_levels};
use rayon::prelude::*;

use super::stages::{Stage, Stages};
use crate::job::{ConvertJob, Coverage, FacePixels, Files, InputView, Light, Sheet, TargetView};

/// Makes the outputs of a job, frame by frame.
pub(super) struct Engine<'a> {
    job: &'a ConvertJob,
    /// Compiled geometry by target view, where that pays and fits into memory.
    plans: Vec<Option<Plan>>,
    masks: Vec<OnceLock<ScreenMask>>,
    decoder: Decoder,
}

/// The light of a frame. Its memory, and what does not change from frame to frame, serves the next one.
pub(super) struct FrameLight {
    texels: Vec<Rgba>,
    /// Texels that are missing (NaN), by view.
    missing: Vec<usize>,
    /// Whether a frame has been read into it.
    is_used: bool,
}

impl<'a> Engine<'a> {
    /// Prepares the geometry.
    pub(super) fn new(job: &'a ConvertJob) -> Self {
        let masks = job.target.views.iter().map(|_| OnceLock::new()).collect();
        let mut engine = Self { job, plans: Vec::new(), masks, decoder: Decoder::default() };
        engine.plans = engine.compile();
        engine
    }

    /// How many frames are worked on at once: reading and writing files uses one thread a file, so that several
    /// keep all of them busy.
    pub(super) fn batch(&self) -> usize {
        let plans = self.plans.iter().flatten().map(|plan| plan.bytes() as u64).sum();
        let possible = self.job.memory.frames_beside(&self.job.input, &self.job.target, plans);
        possible.clamp(1, rayon::current_num_threads())
    }

    /// Room for the light of a frame.
    pub(super) fn frame_light(&self) -> FrameLight {
        FrameLight {
            texels: vec![Rgba::TRANSPARENT; self.job.worlds.iter().map(World::texel_count).sum()],
            missing: vec![0; self.job.worlds.iter().map(|world| world.sources().len()).sum()],
            is_used: false,
        }
    }

    /// Geometry for many frames is computed once, as far as it fits into memory.
    fn compile(&self) -> Vec<Option<Plan>> {
        let mut left = self.job.memory.left_for_plan(&self.job.input, &self.job.target);
        let pays = self.job.outputs.frames.len() > 1;
        let plan_of = |target: &TargetView| {
            let resampler = self.resampler(target);
            if !pays || resampler.plan_bytes_estimate() as u64 > left {
                return None;
            }
            let plan = resampler.plan()?;
            left = left.saturating_sub(plan.bytes() as u64);
            Some(plan)
        };
        self.job.target.views.iter().map(plan_of).collect()
    }

    fn resampler<'b>(&'b self, target: &'b TargetView) -> Resampler<'b> {
        Resampler { world: self.world(target), target: &target.view, filter: self.job.filter }
    }

    /// What a target shows.
    fn world(&self, target: &TargetView) -> &World {
        &self.job.worlds[target.world(self.job.worlds.len())]
    }

    /// The light of what a target shows.
    fn light_of<'b>(&self, target: &TargetView, light: &'b FrameLight) -> &'b [Rgba] {
        let index = target.world(self.job.worlds.len());
        let before: usize = self.job.worlds[..index].iter().map(World::texel_count).sum();
        &light.texels[before..][..self.job.worlds[index].texel_count()]
    }

    /// Reads the light of a frame.
    pub(super) fn load(&self, frame: Option<u64>, light: &mut FrameLight) -> Result<()> {
        let mut rest = light.texels.as_mut_slice();
        let mut parts = Vec::new();
        let views = self.job.worlds.iter().flat_map(World::sources).zip(self.job.input.present());
        for (index, (source, (input, header, _))) in views.enumerate() {
            let (texels, after) = rest.split_at_mut(source.texels().len());
            rest = after;
            // What does not change from frame to frame is read once.
            if !light.is_used || matches!(input.files, Files::Sequence(_)) {
                parts.push(ViewPart { index, input, header, texels });
            }
        }
        let load = |views| self.load_file(frame, views);
        let counts: Result<Vec<Vec<(usize, usize)>>> = by_file(parts, frame).into_par_iter().map(load).collect();
        for (index, missing) in counts?.into_iter().flatten() {
            light.missing[index] = missing;
        }
        light.is_used = true;
        Ok(())
    }

    /// Reads the light of the views of one file; counts the pixels of each that are missing (NaN).
    fn load_file(&self, frame: Option<u64>, views: Vec<ViewPart<'_>>) -> Result<Vec<(usize, usize)>> {
        let Some(first) = views.first() else { return Ok(Vec::new()) };
        let (path, window) = (first.input.files.path(frame), first.header.window);
        let expected = first.input.part.map_or((first.header.width, first.header.height), |part| part.of);
        let file = read(&path, &Limits::memory(self.job.memory.bytes))?;
        let found = (file.image.width(), file.image.height());
        if found != expected || file.window != window {
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
        let transfer = self.job.light.input_transfer(file.image.depth(), &file.metadata);
        let mut counts = Vec::new();
        for view in views {
            let missing = match view.input.part {
                Some(part) => {
                    let face = file.image.cropped(part.corner, (view.header.width, view.header.height));
                    self.decoder.decode(&face, &transfer, view.texels)
                }
                None => self.decoder.decode(&file.image, &transfer, view.texels),
            };
            if missing == view.texels.len() && self.job.fill_for_missing().is_none() {
                return Err(anyhow::anyhow!("every pixel is NaN")).with_context(|| {
                    format!("{}: the {} view holds no light; render it again", path.display(), view.input.name)
                });
            }
            counts.push((view.index, missing));
        }
        Ok(counts)
    }

    /// Where faces are clearly not as they are said to be, as their borders in this frame show.
    pub(super) fn continuity(&self, light: &FrameLight) -> Option<String> {
        let given = self.job.input.faces.as_ref()?;
        // Of a stereo pair, the left eye's.
        let (views, sources) = (self.job.input.worlds.first()?.iter(), self.job.worlds.first()?.sources());
        let present = views.enumerate().filter(|(_, view)| view.present().is_some()).map(|(index, _)| index);
        let texels = |source: &Source| {
            let (width, texels) = (source.view.width(), &light.texels[source.texels()]);
            move |i: usize, j: usize| texels[j * width + i]
        };
        let lights: Vec<_> = sources.iter().map(texels).collect();
        let size = |source: &Source| (source.view.width(), source.view.height());
        let pictures = sources.iter().zip(&lights).map(|(source, light)| FacePixels { size: size(source), light });
        given.warning(&present.zip(pictures).collect::<Vec<_>>())
    }

    /// What should be known about the light of a frame.
    pub(super) fn warnings(&self, frame: Option<u64>, light: &FrameLight) -> Vec<String> {
        let tell = |(view, count): (&InputView, usize)| {
            format!("{}: {count} pixels are NaN and count as missing", view.files.path(frame).display())
        };
        self.incomplete(light).map(tell).collect()
    }

    /// Views with missing texels, and how many.
    fn incomplete<'b>(&'b self, light: &'b FrameLight) -> impl Iterator<Item = (&'b InputView, usize)> {
        let views = self.job.input.present().zip(&light.missing);
        views.filter(|(_, count)| **count > 0).map(|((view, _, _), count)| (view, *count))
    }

    /// Makes the picture of a file and its smaller copies: filtered light, complete with what lies outside, faces in their
    /// places.
    pub(super) fn render(&self, file: usize, light: &FrameLight, stages: &mut Stages) -> Result<Vec<Image<Rgba>>> {
        let background = self.job.light.background;
        let mut level = |sheet| assemble(sheet, background, |index| self.render_view(index, light, stages));
        self.job.target.files[file].levels().map(&mut level).collect()
    }

    fn render_view(&self, index: usize, light: &FrameLight, stages: &mut Stages) -> Result<Image<Rgba>> {
        let target = &self.job.target.views[index];
        let texels = self.light_of(target, light);
        stages.time(Stage::Filter, || {
            let mut image = match &self.plans[index] {
                Some(plan) => plan.apply(texels),
                None => self.resampler(target).render(texels),
            };
            self.complete(index, light, &mut image)?;
            Ok(image)
        })
    }

    fn complete(&self, index: usize, light: &FrameLight, image: &mut Image<Rgba>) -> Result<()> {
        self.close_holes(index, light, image)?;
        if let Coverage::Fill(colour) = self.job.coverage {
            self.mask(index).fill_unseen(image, colour);
        }
        self.lay_background(index, image);
        Ok(())
    }

    fn mask(&self, index: usize) -> &ScreenMask {
        let target = &self.job.target.views[index];
        self.masks[index].get_or_init(|| ScreenMask::new(self.world(target), &target.view))
    }

    /// Missing texels of opaque inputs leave the pixel to the others; a pixel that has none left is like one that no
    /// view covers.
    fn close_holes(&self, index: usize, light: &FrameLight, image: &mut Image<Rgba>) -> Result<()> {
        if self.job.light.input_alpha || self.incomplete(light).next().is_none() {
            return Ok(());
        }
        let fill = self.job.fill_for_missing();
        let empty = self.mask(index).close_holes(image, fill.unwrap_or(Rgba::TRANSPARENT));
        if empty > 0 && fill.is_none() {
            let culprit = |(view, count): (&InputView, usize)| format!("{} ({count})", view.name);
            let culprits: Vec<_> = self.incomplete(light).map(culprit).collect();
            bail!(
                "{empty} pixels of {} see nothing but missing pixels (NaN), found in {}; render those again, or fill the \
                 gaps with --missing COLOR or --missing transparent",
                self.job.target.views[index].name,
                culprits.join(", ")
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

    /// What the outputs hold.
    pub(super) fn light(&self) -> &Light {
        &self.job.light
    }
}

/// A picture: an image, or several in their places on a background.
pub(super) fn assemble<P: Copy>(
    sheet: &Sheet,
    background: P,
    mut image: impl FnMut(usize) -> Result<Image<P>>,
) -> Result<Image<P>> {
    let mut picture = None;
    for &(index, (left, top)) in &sheet.pieces {
        let piece = image(index)?;
        if (piece.width(), piece.height()) == sheet.size {
            return Ok(piece);
        }
        let picture = picture.get_or_insert_with(|| Image::filled(sheet.size.0, sheet.size.1, background));
        for j in 0..piece.height() {
            picture.pixels_mut()[(top + j) * sheet.size.0 + left..][..piece.width()].copy_from_slice(piece.row(j));
        }
    }
    Ok(picture.unwrap_or_else(|| Image::filled(sheet.size.0, sheet.size.1, background)))
}

/// Writes an output, a picture and its smaller copies.
pub(super) fn save(light: &Light, levels: &[Image<Rgba>], path: &Path, options: &WriteOptions) -> Result<()> {
    let encode = |image| EncodedImage::encode(image, light.channels, light.depth, &light.transfer);
    let encoded: Vec<EncodedImage> = levels.iter().map(encode).collect();
    write_levels(path, &encoded, &light.metadata, options)?;
    Ok(())
}

/// The texels of a view that are to be read.
struct ViewPart<'a> {
    index: usize,
    input: &'a InputView,
    header: &'a Header,
    texels: &'a mut [Rgba],
}

/// Views that share a file are read together.
fn by_file(views: Vec<ViewPart<'_>>, frame: Option<u64>) -> Vec<Vec<ViewPart<'_>>> {
    let mut files: Vec<(PathBuf, Vec<ViewPart<'_>>)> = Vec::new();
    for view in views {
        let path = view.input.files.path(frame);
        match files.iter_mut().find(|(other, _)| *other == path) {
            Some((_, shared)) => shared.push(view),
            None => files.push((path, vec![view])),
        }
    }
    files.into_iter().map(|(_, views)| views).collect()
}
