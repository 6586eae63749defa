use std::collections::BTreeSet;
use std::ops::{AddAssign, Range};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use cosmorama::filter::{ClassicTables, FilterKind};
use cosmorama::raster::{Decoder, FixedDecoder, FixedLight, FramePool, IrregularPixels, Rgba, Transfer};
use cosmorama::world::{RimTexels, Source, World};
use cosmorama_io::Carried;
use rayon::prelude::*;

use crate::colour::{FileColours, LightConversion};
use crate::diagnostic::{RESUME, Result, bail};
use crate::engine::{FrameFile, Stage, Stages, ViewImage, Which};
use crate::job::{BAND, ConvertJob};
use crate::source::Stamp;

/// Light of a frame. Its memory, and views that do not change, are reused for the next frame.
pub(crate) struct FrameLight {
    texels: Texels,
    /// Tables that the filter makes of each world's light once for all pictures, as soon as one asks for them.
    tables: Vec<OnceLock<Option<ClassicTables>>>,
    /// Counts of texels that are reported, by view.
    counts: Vec<Counts>,
    /// Texels of each view that its own rim cuts.
    rims: Vec<RimTexels>,
    /// Files with transparent pixels, if the outputs are opaque because the first frame is.
    flattened: BTreeSet<PathBuf>,
    /// Whether frames are held in 15 bits where possible.
    is_fixed: bool,
    /// Rows of each view from which pictures are made. Others need not be decoded.
    rows: Range<usize>,
    /// Whether the views that do not change from frame to frame have been read.
    has_still: bool,
    decoder: Decoder,
    fixed_decoders: Vec<(Transfer, Option<FixedDecoder>)>,
    /// Metadata of the first view's file.
    carried: Option<Arc<Carried>>,
    /// Files of the views, as they were before they were read.
    read: Vec<Option<(PathBuf, Option<Stamp>)>>,
}

/// Light of the texels of each world.
pub(crate) enum Texels {
    /// Light of any range, in floats.
    Float(Vec<Vec<Rgba>>),
    /// Light of opaque 8-bit pictures, in 15 bits.
    Fixed(Vec<FixedLight>),
}

/// Approximate number of texels that a thread decodes at once.
const PIECE: usize = 1 << 16;

/// Fate of the samples of images that have been decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spent {
    /// They stay: their memory serves the next frame.
    Kept,
    /// They are freed as they are decoded, from the last row on, so that they are never held beside all of their light.
    Freed,
}

impl FrameLight {
    /// Allocates the light of a job's frames.
    pub(crate) fn new(job: &ConvertJob, is_fixed: bool, rows: Range<usize>) -> Self {
        let texels = if is_fixed { Texels::fixed(job) } else { Texels::floats(job) };
        // Labels at a rim are not mixed with their surroundings, and restoring them would make new labels.
        let has_rims = !matches!(job.filter.kind, FilterKind::Labels(_));
        let rim = |source: &Source| if has_rims { RimTexels::of(&source.view) } else { RimTexels::default() };
        let rims: Vec<RimTexels> = job.worlds.iter().flat_map(World::sources).map(rim).collect();
        let counts = vec![Counts::default(); rims.len()];
        let decoder = Decoder::default();
        let flattened = BTreeSet::new();
        let (fixed_decoders, carried, read) = (Vec::new(), None, vec![None; rims.len()]);
        let tables = vec![OnceLock::new(); job.worlds.len()];
        Self {
            texels,
            tables,
            counts,
            rims,
            flattened,
            is_fixed,
            rows,
            has_still: false,
            decoder,
            fixed_decoders,
            carried,
            read,
        }
    }

    /// Returns all texels.
    pub(crate) fn texels(&self) -> &Texels {
        &self.texels
    }

    /// Returns the texels of each world, if they are floats.
    pub(crate) fn into_floats(self) -> Vec<Vec<Rgba>> {
        match self.texels {
            Texels::Float(worlds) => worlds,
            Texels::Fixed(_) => Vec::new(),
        }
    }

    /// Returns what the filter computes of a world's light once: for all pictures, faces and moments, until the light changes.
    pub(crate) fn tables(&self, job: &ConvertJob, place: usize) -> Option<&ClassicTables> {
        let Texels::Float(worlds) = &self.texels else { return None };
        self.tables[place].get_or_init(|| job.filter.tables(&job.worlds[place], &worlds[place])).as_ref()
    }

    /// Returns the counts of texels that are reported, by view.
    pub(crate) fn counts(&self) -> &[Counts] {
        &self.counts
    }

    /// Returns files with transparent pixels that have not been reported, where the outputs have no alpha.
    pub(crate) fn flattened(&self) -> impl Iterator<Item = &Path> {
        self.flattened.iter().map(PathBuf::as_path)
    }

    /// Returns the metadata that the frame's outputs take over.
    pub(crate) fn carried(&self) -> Option<Arc<Carried>> {
        self.carried.clone()
    }

    /// Checks that no file has changed since it was read, so that what is said of the inputs is true of the pixels.
    ///
    /// # Errors
    /// When one has, or is gone.
    pub(crate) fn check_unchanged(&self, job: &ConvertJob) -> Result<()> {
        let stamped = self.read.iter().flatten().filter_map(|(path, stamp)| Some((path, (*stamp)?)));
        let changed =
            stamped.filter(|(path, stamp)| job.files.stamp(path) != Some(*stamp)).map(|(path, _)| path).next();
        let Some(path) = changed.map(|path| path.display()) else { return Ok(()) };
        let then = if job.is_resumable() {
            format!("make the frames that are left with {RESUME}")
        } else {
            "begin again".to_owned()
        };
        bail!(
            Changed: "{path}: it was changed or removed while its picture was converted; leave inputs alone meanwhile, and {then}"
        )
    }

    /// Decodes a frame: all its views, or those that change from frame to frame. Images that are freed have no rows left.
    pub(crate) fn fill(
        &mut self,
        job: &ConvertJob,
        frame: Option<u64>,
        (images, spent): (&mut [ViewImage], Spent),
        (stages, pool): (&Stages, &FramePool),
    ) -> Result<()> {
        // A frame unlike the first, with alpha or in another encoding, is held in floats. What a frame becomes must not
        // depend on the one before.
        let is_fixed = self.is_fixed && images.iter().all(|image| self.takes(image));
        if is_fixed != matches!(self.texels, Texels::Fixed(_)) {
            // Freed first, since both are never held at once.
            self.texels = Texels::Float(Vec::new());
            self.texels = if is_fixed { Texels::fixed(job) } else { Texels::floats(job) };
            self.has_still = false;
        }
        if !self.has_still && images.len() < self.counts.len() {
            for file in FrameFile::all(job, frame, Which::Still) {
                let mut still = stages.beside(Stage::Decode, || file.read(job, pool))?;
                if let (true, Some(image)) = (is_fixed, still.iter().find(|image| !self.takes(image))) {
                    let path = image.path.display();
                    bail!(Changed: "{path}: no longer opaque and of 8 bits; leave files alone while they are read");
                }
                self.decode(job, (&mut still, spent), stages)?;
            }
        }
        self.has_still = true;
        if let Some(carried) = images.iter().find_map(|image| image.carried.as_ref()) {
            self.carried = Some(Arc::clone(carried));
        }
        let is_announced = job.light.input_alpha || job.light.channels.has_alpha();
        let flattened = images.iter().filter(|image| !is_announced && !image.image.is_opaque());
        self.flattened = flattened.map(|image| image.path.clone()).collect();
        self.decode(job, (images, spent), stages)
    }

    /// Returns whether an image can be held in 15 bits.
    fn takes(&mut self, image: &ViewImage) -> bool {
        let FileColours { transfer: wanted, conversion } = &image.colours;
        if conversion.is_some() {
            return false;
        }
        let known = self.fixed_decoders.iter().position(|(transfer, _)| transfer == wanted);
        let index = known.unwrap_or_else(|| {
            self.fixed_decoders.push((wanted.clone(), FixedDecoder::new(wanted)));
            self.fixed_decoders.len() - 1
        });
        self.fixed_decoders[index].1.as_ref().is_some_and(|decoder| decoder.takes(&image.image))
    }

    fn decode(&mut self, job: &ConvertJob, (images, spent): (&mut [ViewImage], Spent), stages: &Stages) -> Result<()> {
        let sizes: Vec<usize> = images.iter().map(|image| image.image.width() * image.image.height()).collect();
        if !images.is_empty() {
            self.tables.fill(OnceLock::new());
        }
        let Self { texels, rims, decoder, fixed_decoders, rows: wanted, .. } = self;
        let counts = match texels {
            Texels::Fixed(worlds) => {
                let decoder = |image: &ViewImage| {
                    fixed_decoders.iter().find(|(transfer, _)| *transfer == image.colours.transfer)?.1.as_ref()
                };
                let rows = |image: &ViewImage, first: usize, into: &mut [[i16; 4]]| {
                    decoder(image).map(|decoder| decoder.decode_rows(&image.image, first, into));
                    // An integer is always a number, and its light is in working primaries.
                    Counts::default()
                };
                decode((images, spent, wanted), worlds.iter_mut().flat_map(FixedLight::views_mut), stages, rows)
            }
            Texels::Float(worlds) => {
                let rows = |image: &ViewImage, first: usize, into: &mut [Rgba]| {
                    let FileColours { transfer, conversion } = &image.colours;
                    let irregular = decoder.decode_rows(&image.image, transfer, first, into);
                    let converted = |conversion: &LightConversion| conversion.convert(into);
                    Counts { irregular, outside: conversion.as_ref().map_or(irregular.negative, converted), cut: 0 }
                };
                decode((images, spent, wanted), views(job, worlds), stages, rows)
            }
        };
        texels.restore_rims(job, images, rims);
        for ((image, counts), size) in images.iter().zip(counts).zip(sizes) {
            if counts.irregular.missing == size && job.fill_for_missing().is_none() {
                let name = job.input.present().nth(image.view).map_or("", |(view, ..)| &view.name);
                let path = image.path.display();
                bail!(NotANumber: "{path}: the {name} view holds no light; render it again: every pixel is NaN");
            }
            self.counts[image.view] = Counts { cut: image.cut, ..counts };
            self.read[image.view] = Some((image.path.clone(), image.stamp));
        }
        Ok(())
    }
}

impl Texels {
    fn floats(job: &ConvertJob) -> Self {
        // Zeroed without touching the memory: each page is first touched by the thread that fills it.
        Self::Float(job.worlds.iter().map(|world| bytemuck::zeroed_vec(world.texel_count())).collect())
    }

    fn fixed(job: &ConvertJob) -> Self {
        Self::Fixed(job.worlds.iter().map(|world| FixedLight::black(world.view_sizes())).collect())
    }

    /// Restores the rim texels of these images, which may be mixed with their surroundings.
    fn restore_rims(&mut self, job: &ConvertJob, images: &[ViewImage], rims: &[RimTexels]) {
        match self {
            Self::Float(worlds) => {
                let views = views(job, worlds);
                each_read(images, rims, views, |image, rim, view| {
                    let is_free = image.image.depth().is_float() || image.colours.conversion.is_some();
                    rim.restore(view, |texel| texel, |light| if is_free { light } else { within_white(light) });
                });
            }
            Self::Fixed(worlds) => {
                let views = worlds.iter_mut().flat_map(FixedLight::views_mut);
                each_read(images, rims, views, |_, rim, view| {
                    rim.restore(view, FixedLight::light, FixedLight::texel);
                });
            }
        }
    }

    /// Returns the light of a world's texel.
    pub(crate) fn rgba(&self, world: usize, texel: usize) -> Rgba {
        match self {
            Self::Float(worlds) => worlds[world][texel],
            Self::Fixed(worlds) => worlds[world].rgba(texel),
        }
    }
}

/// Counts of pixels that are reported.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counts {
    /// Pixels whose samples are no light.
    pub(crate) irregular: IrregularPixels,
    /// Pixels outside of the working primaries, which have negative light in these.
    pub(crate) outside: usize,
    /// Pixels whose colour exceeded alpha and was cut when the file was read.
    pub(crate) cut: usize,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.irregular = self.irregular + other.irregular;
        self.outside += other.outside;
        self.cut += other.cut;
    }
}

/// Decodes images in parallel pieces, and returns the counts of each. Each view is given by its rows,
/// all of one length; `rows` decodes some of them. Where samples are kept, rows that are not wanted may be left out.
fn decode<'a, T: Send + 'a>(
    (images, spent, wanted): (&mut [ViewImage], Spent, &Range<usize>),
    views: impl Iterator<Item = &'a mut [T]>,
    stages: &Stages,
    rows: impl Fn(&ViewImage, usize, &mut [T]) -> Counts + Sync,
) -> Vec<Counts> {
    let mut views: Vec<_> = views.map(Some).collect();
    let mut view = |image: &ViewImage| views[image.view].take().expect("one image for each view");
    let rows =
        |image: &ViewImage, first: usize, into: &mut [T]| stages.beside(Stage::Decode, || rows(image, first, into));
    let mut counts = vec![Counts::default(); images.len()];
    match spent {
        Spent::Kept => {
            let all = images.iter().enumerate().flat_map(|(index, image)| {
                let is_wanted = |first: usize| first < wanted.end && wanted.start < first + rows_of_piece(image);
                let pieces = pieces(image, 0, view(image)).filter(move |(first, _)| is_wanted(*first));
                pieces.map(move |(first, into)| (index, image, first, into))
            });
            decode_pieces(all.collect(), rows, &mut counts);
        }
        Spent::Freed => {
            let mut batch = Vec::new();
            for (index, image) in images.iter_mut().enumerate() {
                let texels = view(image);
                if batch.iter().map(|(_, _, texels): &Decoded<T>| texels.len()).sum::<usize>() + texels.len() > BAND {
                    free(std::mem::take(&mut batch), rows, &mut counts);
                }
                batch.push((index, image, texels));
            }
            free(batch, rows, &mut counts);
        }
    }
    counts
}

/// An image, its place among all, and its texels.
type Decoded<'a, T> = (usize, &'a mut ViewImage, &'a mut [T]);

/// An image, its place among all, and some of its texels with the row with which they begin.
type Piece<'a, T> = (usize, &'a ViewImage, usize, &'a mut [T]);

/// Decodes pieces of images in parallel, and adds what is counted to the counts of each image.
fn decode_pieces<T: Send>(
    pieces: Vec<Piece<'_, T>>,
    rows: impl Fn(&ViewImage, usize, &mut [T]) -> Counts + Sync,
    counts: &mut [Counts],
) {
    let found = pieces.into_par_iter().map(|(index, image, first, into)| (index, rows(image, first, into)));
    found.collect::<Vec<_>>().into_iter().for_each(|(index, found)| counts[index] += found);
}

/// Decodes images by bands of their rows, from the last row on, and frees the samples of each band.
fn free<T: Send>(
    mut images: Vec<Decoded<'_, T>>,
    rows: impl Fn(&ViewImage, usize, &mut [T]) -> Counts + Copy + Sync,
    counts: &mut [Counts],
) {
    let before_band =
        |image: &ViewImage| image.image.height().saturating_sub(BAND.div_ceil(image.image.width().max(1)));
    while !images.is_empty() {
        let mut band = Vec::new();
        for (index, image, texels) in &mut images {
            let (height, first) = (image.image.height().max(1), before_band(image));
            let all = std::mem::take(texels);
            let (rest, last) = all.split_at_mut(all.len() / height * first);
            *texels = rest;
            band.extend(pieces(image, first, last).map(|(first, into)| (*index, &**image, first, into)));
        }
        decode_pieces(band, rows, counts);
        for (_, image, _) in &mut images {
            let rows = before_band(image);
            image.image.keep_rows(rows);
        }
        images.retain(|(_, image, _)| image.image.height() > 0);
    }
}

/// Returns an image's texels in pieces for threads, each with its first row, where the texels begin with row `first`.
fn pieces<'a, T>(image: &ViewImage, first: usize, texels: &'a mut [T]) -> impl Iterator<Item = (usize, &'a mut [T])> {
    let some = rows_of_piece(image);
    let pitch = (texels.len() / (image.image.height() - first).max(1)).max(1);
    texels.chunks_mut(some * pitch).enumerate().map(move |(piece, into)| (first + piece * some, into))
}

/// Returns the number of rows of a piece.
fn rows_of_piece(image: &ViewImage) -> usize {
    PIECE.div_ceil(image.image.width().max(1))
}

/// Limits light to white, as in files of integers, so that 15 bits and floats give the same.
fn within_white(light: Rgba) -> Rgba {
    Rgba(light.0.map(|sample| sample.min(light.alpha())))
}

/// Passes each image that was read, with its view's rim and texels, to `visit`.
fn each_read<'a, T: 'a>(
    images: &[ViewImage],
    rims: &[RimTexels],
    views: impl Iterator<Item = &'a mut [T]>,
    visit: impl Fn(&ViewImage, &RimTexels, &mut [T]),
) {
    let mut read: Vec<Option<&ViewImage>> = vec![None; rims.len()];
    images.iter().for_each(|image| read[image.view] = Some(image));
    for ((texels, rim), image) in views.zip(rims).zip(read) {
        image.into_iter().for_each(|image| visit(image, rim, texels));
    }
}

/// Splits the texels of all worlds by view.
fn views<'a>(job: &'a ConvertJob, worlds: &'a mut [Vec<Rgba>]) -> impl Iterator<Item = &'a mut [Rgba]> {
    job.worlds.iter().zip(worlds).flat_map(|(world, texels)| {
        let mut rest = texels.as_mut_slice();
        let view = move |source: &Source| rest.split_off_mut(..source.texels().len()).expect("light of all the world");
        world.sources().iter().map(view)
    })
}
