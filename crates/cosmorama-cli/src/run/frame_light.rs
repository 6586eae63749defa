use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use cosmorama::raster::{Decoder, EncodedImage, FixedDecoder, FixedLight, Rgba, Transfer};
use cosmorama::world::World;
use cosmorama_io::{Header, Limits, read};
use rayon::prelude::*;

use crate::job::{ConvertJob, Files, InputView};

/// The light of a frame. Its memory, and what does not change from frame to frame, serves the next one.
pub(super) struct FrameLight {
    texels: Texels,
    /// Texels that are missing (NaN), by view.
    missing: Vec<usize>,
    /// Whether frames are to be held in 15 bits, if they can be.
    is_fixed: bool,
    /// Whether a frame has been read into it.
    is_used: bool,
}

/// Light of the texels of each world.
pub(super) enum Texels {
    /// Of any range.
    Float(Vec<Vec<Rgba>>),
    /// Of opaque pictures of 8 bits.
    Fixed(Vec<FixedLight>),
}

impl FrameLight {
    /// Room for that of a job.
    pub(super) fn new(job: &ConvertJob, is_fixed: bool) -> Self {
        let texels = if is_fixed { Texels::fixed(job) } else { Texels::floats(job) };
        let missing = vec![0; job.worlds.iter().map(|world| world.sources().len()).sum()];
        Self { texels, missing, is_fixed, is_used: false }
    }

    /// All the texels.
    pub(super) fn texels(&self) -> &Texels {
        &self.texels
    }

    /// Texels that are missing (NaN), by view.
    pub(super) fn missing(&self) -> &[usize] {
        &self.missing
    }

    /// Reads a frame.
    pub(super) fn load(&mut self, job: &ConvertJob, decoder: &Decoder, frame: Option<u64>) -> Result<()> {
        if self.is_fixed && matches!(self.texels, Texels::Float(_)) {
            // The frame before was another: what this one becomes must not depend on it.
            self.texels = Texels::Fixed(Vec::new());
            (self.texels, self.is_used) = (Texels::fixed(job), false);
        }
        if let Texels::Fixed(worlds) = &mut self.texels {
            let decode = |image: &EncodedImage, transfer: &Transfer, into: &mut [[i16; 4]]| {
                FixedDecoder::new(transfer).is_some_and(|decoder| decoder.decode(image, into)).then_some(0)
            };
            let read = Reading { job, frame, is_used: self.is_used, decode };
            let texels = worlds.iter_mut().map(FixedLight::texels_mut).collect();
            if read.all(texels, &mut self.missing)? {
                self.is_used = true;
                return Ok(());
            }
            // A frame unlike the first: with alpha, or in another encoding.
            self.texels = Texels::Float(Vec::new());
            (self.texels, self.is_used) = (Texels::floats(job), false);
        }
        if let Texels::Float(worlds) = &mut self.texels {
            let decode = |image: &EncodedImage, transfer: &Transfer, into: &mut [Rgba]| {
                Some(decoder.decode(image, transfer, into))
            };
            let read = Reading { job, frame, is_used: self.is_used, decode };
            read.all(worlds.iter_mut().map(Vec::as_mut_slice).collect(), &mut self.missing)?;
            self.is_used = true;
        }
        Ok(())
    }
}

impl Texels {
    fn floats(job: &ConvertJob) -> Self {
        Self::Float(job.worlds.iter().map(|world| vec![Rgba::TRANSPARENT; world.texel_count()]).collect())
    }

    fn fixed(job: &ConvertJob) -> Self {
        Self::Fixed(job.worlds.iter().map(|world| FixedLight::black(world.texel_count())).collect())
    }

    /// The light of a world's texel.
    pub(super) fn rgba(&self, world: usize, texel: usize) -> Rgba {
        match self {
            Self::Float(worlds) => worlds[world][texel],
            Self::Fixed(worlds) => worlds[world].rgba(texel),
        }
    }
}

/// A frame that is being read.
struct Reading<'a, D> {
    job: &'a ConvertJob,
    frame: Option<u64>,
    /// Whether what does not change from frame to frame is there already.
    is_used: bool,
    /// Makes light of an image and counts the pixels that are missing; `None` if it cannot.
    decode: D,
}

/// The texels of a view that are to be read.
struct ViewPart<'a, T> {
    index: usize,
    input: &'a InputView,
    header: &'a Header,
    texels: &'a mut [T],
}

/// Views by their index, with how many pixels of each are missing.
type Missing = Vec<(usize, usize)>;

impl<D> Reading<'_, D> {
    /// Reads the light of all views; false if some file's cannot be held.
    fn all<T: Send>(&self, texels: Vec<&mut [T]>, missing: &mut [usize]) -> Result<bool>
    where
        D: Fn(&EncodedImage, &Transfer, &mut [T]) -> Option<usize> + Sync,
    {
        let mut parts = Vec::new();
        let texels = self.job.worlds.iter().zip(texels).flat_map(|(world, texels)| by_view(world, texels));
        for (index, (texels, (input, header, _))) in texels.zip(self.job.input.present()).enumerate() {
            // What does not change from frame to frame is read once.
            if !self.is_used || matches!(input.files, Files::Sequence(_)) {
                parts.push(ViewPart { index, input, header, texels });
            }
        }
        let counts: Result<Vec<Option<Missing>>> =
            by_file(parts, self.frame).into_par_iter().map(|views| self.file(views)).collect();
        let Some(counts) = counts?.into_iter().collect::<Option<Vec<Missing>>>() else { return Ok(false) };
        for (index, count) in counts.into_iter().flatten() {
            missing[index] = count;
        }
        Ok(true)
    }

    /// Reads the light of the views of one file.
    fn file<T>(&self, views: Vec<ViewPart<'_, T>>) -> Result<Option<Missing>>
    where
        D: Fn(&EncodedImage, &Transfer, &mut [T]) -> Option<usize>,
    {
        let Some(first) = views.first() else { return Ok(Some(Vec::new())) };
        let (path, window) = (first.input.files.path(self.frame), first.header.window);
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
            let count = view.texels.len();
            let missing = match view.input.part {
                Some(part) => {
                    let face = file.image.cropped(part.corner, (view.header.width, view.header.height));
                    (self.decode)(&face, &transfer, view.texels)
                }
                None => (self.decode)(&file.image, &transfer, view.texels),
            };
            let Some(missing) = missing else { return Ok(None) };
            if missing == count && self.job.fill_for_missing().is_none() {
                return Err(anyhow::anyhow!("every pixel is NaN")).with_context(|| {
                    format!("{}: the {} view holds no light; render it again", path.display(), view.input.name)
                });
            }
            counts.push((view.index, missing));
        }
        Ok(Some(counts))
    }
}

/// The texels of each of a world's views.
fn by_view<'a, T>(world: &World, mut texels: &'a mut [T]) -> Vec<&'a mut [T]> {
    let mut views = Vec::new();
    for source in world.sources() {
        let (these, rest) = texels.split_at_mut(source.texels().len());
        views.push(these);
        texels = rest;
    }
    views
}

/// Views that share a file are read together.
fn by_file<T>(views: Vec<ViewPart<'_, T>>, frame: Option<u64>) -> Vec<Vec<ViewPart<'_, T>>> {
    let mut files: Vec<(PathBuf, Vec<ViewPart<'_, T>>)> = Vec::new();
    for view in views {
        let path = view.input.files.path(frame);
        match files.iter_mut().find(|(other, _)| *other == path) {
            Some((_, shared)) => shared.push(view),
            None => files.push((path, vec![view])),
        }
    }
    files.into_iter().map(|(_, views)| views).collect()
}
