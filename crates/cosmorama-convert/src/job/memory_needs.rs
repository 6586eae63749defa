//! Memory that a conversion needs, held against its budget before any of it is taken.
//!
//! A frame is read, then filtered, then written, and each of these frees what the next does not need. So it takes what the greediest of
//! them holds, and not the sum of all.

use cosmorama::camera::View;
use cosmorama::filter::FilterKind;
use cosmorama::projection::ProjectionKind;
use cosmorama::raster::{FixedLight, Rgba};
use cosmorama::world::{StPixel, World};
use cosmorama_builtin::{DirectionMap, DirectionPixel};
use cosmorama_io::{Format, Header};

use crate::colour::{LayerPlan, Light};
use crate::diagnostic::{CHANNELS, EVERY, Result, SHUTTER};
use crate::input::{Input, InputView};
use crate::job::{Content, ConvertJob, FrameMemory, QueueDepth};
use crate::source::MemoryBudget;
use crate::source::memory_budget::{area, human, read_bytes};
use crate::target::{Sheet, Strip, Target, TargetView};

/// Bytes in which a job holds a texel of light, a pixel of a picture, and a pixel of its file's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Held {
    /// Whether texels and pixels are integers.
    is_fixed: bool,
    /// Bytes of a pixel.
    pixel: u64,
    /// Samples of a pixel, while its picture is encoded; those of integers are the picture itself.
    encoded: u64,
}

impl Held {
    /// Opaque pictures of 8 bits, filtered in integers.
    pub(crate) const INTEGERS: Self = Self { is_fixed: true, pixel: size_of::<[u8; 3]>() as u64, encoded: 0 };

    /// Returns pictures of light that are encoded as files want them.
    pub(crate) fn floats(light: &Light) -> Self {
        Self::of_samples(light.file_bytes((1, 1)))
    }

    /// Returns pictures of light whose samples take so many bytes a pixel.
    pub(crate) const fn of_samples(encoded: u64) -> Self {
        Self { is_fixed: false, pixel: size_of::<Rgba>() as u64, encoded }
    }

    /// Maps of places, of which each value becomes a plane.
    pub(crate) const PLACES: Self =
        Self { is_fixed: false, pixel: size_of::<StPixel>() as u64, encoded: size_of::<StPixel>() as u64 };

    /// Returns maps of directions, of which each value becomes a plane.
    pub(crate) fn directions(map: DirectionMap) -> Self {
        let planes = map.channels().len() * size_of::<f32>();
        Self { is_fixed: false, pixel: size_of::<DirectionPixel>() as u64, encoded: planes as u64 }
    }

    /// Returns pictures of light whose encoding is not known yet: as large as any.
    pub(crate) const fn any() -> Self {
        Self::of_samples(size_of::<Rgba>() as u64)
    }

    /// Returns the bytes of a view's light, with the padding of its rows.
    fn light(self, (width, height): (usize, usize)) -> u64 {
        if self.is_fixed {
            area((FixedLight::pitch(width), height)).saturating_mul(size_of::<[i16; 4]>() as u64)
        } else {
            area((width, height)).saturating_mul(size_of::<Rgba>() as u64)
        }
    }
}

/// Memory of a frame in bytes, by what takes it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FrameNeeds {
    /// Solid angles and tables, which all frames share.
    pub(crate) shared: u64,
    /// Levels, sums or blocks that filter or light make of the input, and copies of pictures.
    pub(crate) prepared: u64,
    /// Samples of files that change from frame to frame, and of those that do not.
    samples: Samples,
    /// Light of all texels.
    pub(crate) light: u64,
    /// Pictures.
    pictures: u64,
    /// Largest part of a sheet, which is made by itself.
    piece: u64,
    /// Weights of the rows that threads work on.
    bands: u64,
    /// Masks of pixels that no view covers.
    masks: u64,
    /// Samples of the pictures.
    encoded: u64,
    /// Whether the pictures are made strip by strip.
    is_by_strips: bool,
}

/// Bytes of a frame's samples.
#[derive(Clone, Copy, Debug, Default)]
struct Samples {
    all: u64,
    /// Of files that change from frame to frame.
    moving: u64,
    /// Number of these files.
    files: usize,
    /// Blocks and copies of the decoders.
    scratch: u64,
    /// Whether they stay when they have become light, for the next frame.
    is_kept: bool,
}

impl FrameNeeds {
    /// Returns the needs of a job's frames. Those of `worlds` are exact where there are any.
    pub(crate) fn of(input: &Input, worlds: &[World], target: &Target, held: Held) -> Self {
        let sheets = || target.files.iter().flat_map(|file| file.levels());
        let pixels = sheets().map(|sheet| area(sheet.size)).fold(0, u64::saturating_add);
        let is_piece = |sheet: &&Sheet| sheet.pieces.len() > 1;
        let parts =
            sheets().filter(is_piece).flat_map(|sheet| &sheet.pieces).filter_map(|(index, _)| target.views.get(*index));
        let largest = parts.map(|target| pixels_of(&target.view)).max().unwrap_or(0);
        let views = target.views.iter().map(|target| &target.view);
        Self::of_pictures(input, worlds, (pixels, largest), held).beside_tables(views)
    }

    /// Returns the needs of pictures of so many pixels, of which the largest part is made by itself.
    pub(crate) fn of_pictures(input: &Input, worlds: &[World], (pixels, largest): (u64, u64), held: Held) -> Self {
        let size = |header: &Header| (header.width, header.height);
        let light = if input.present().next().is_some() {
            input.present().map(|(_, header, _)| held.light(size(header))).fold(0, u64::saturating_add)
        } else {
            let planned = input.views().map(|view| held.light((view.nominal.width(), view.nominal.height())));
            planned.fold(0, u64::saturating_add)
        };
        let lists = VIEW.saturating_mul(input.views().count() as u64);
        let needs = Self {
            shared: solid_angle_bytes(input, worlds).saturating_add(lists),
            prepared: 0,
            samples: Samples::of(input),
            light,
            pictures: pixels.saturating_mul(held.pixel),
            piece: largest.saturating_mul(held.pixel),
            bands: 0,
            masks: 0,
            encoded: pixels.saturating_mul(held.encoded),
            is_by_strips: false,
        };
        needs.beside_tables(input.views().map(|view| &view.nominal))
    }

    /// Adds the tables of views' projections.
    fn beside_tables<'v>(self, views: impl Iterator<Item = &'v View>) -> Self {
        Self { shared: views.map(table_bytes).fold(self.shared, u64::saturating_add), ..self }
    }

    /// Adds the weights of the rows of views of these sizes that threads work on. Where texels are far more than pixels, there is about one
    /// weight for each texel.
    pub(crate) fn with_bands(self, texels: u64, views: impl Iterator<Item = (usize, usize)>) -> Self {
        let rows = BAND_ROWS.saturating_mul(rayon::current_num_threads() as u64);
        let bytes = |(width, height): (usize, usize)| {
            let all = texels.saturating_add(area((width, height))).saturating_mul(WEIGHT);
            all / (height as u64).max(1) * rows.min(height as u64)
        };
        Self { bands: views.map(bytes).max().unwrap_or(0), ..self }
    }

    /// Adds masks of views of these sizes, and the copy of one while it is made.
    pub(crate) fn with_masks(self, views: impl Iterator<Item = (usize, usize)>) -> Self {
        let pixels: Vec<u64> = views.map(area).collect();
        let all = sum([pixels.iter().copied().fold(0, u64::saturating_add), pixels.iter().copied().max().unwrap_or(0)]);
        Self { masks: all.saturating_mul(MASK), ..self }
    }

    /// Adds what is made of the input before pictures are, or copies of pictures.
    pub(crate) fn with_prepared(self, bytes: u64) -> Self {
        Self { prepared: self.prepared.saturating_add(bytes), ..self }
    }

    /// Adds pictures that streams hold beside those of frames.
    pub(crate) fn beside_streams(self, bytes: u64) -> Self {
        Self { shared: self.shared.saturating_add(bytes), ..self }
    }

    /// Returns the needs of one frame of many.
    pub(crate) fn of_many(self) -> Self {
        Self { samples: Samples { is_kept: true, ..self.samples }, ..self }
    }

    /// Returns the needs of pictures of these sizes that are made one after the other, strip by strip: only a strip of one is there at once,
    /// with the samples of the one before, which are written; all samples of a picture where the format is not written row by row.
    pub(crate) fn by_strips(self, format: Format, sizes: &[(usize, usize)]) -> Self {
        let all = pixels_in(sizes.iter().copied()).max(1);
        let strip = |pictures: u64| (pictures / all).saturating_mul(strip_of(sizes.iter().copied()));
        let is_encoded = self.encoded > 0;
        let samples = if is_encoded { self.encoded } else { self.pictures };
        let largest = sizes.iter().copied().map(area).max().unwrap_or(0);
        let written = if format.takes_rows() { strip(samples) } else { (samples / all).saturating_mul(largest) };
        // OpenEXR sorts those that it writes by channel.
        let sorted = if format == Format::Exr { strip(samples) } else { 0 };
        // Integers are samples themselves.
        let light = if is_encoded { strip(self.pictures) } else { 0 };
        Self {
            pictures: sum([written, strip(samples), sorted]),
            piece: light + strip(self.pictures).min(self.piece),
            encoded: 0,
            masks: if self.masks == 0 { 0 } else { strip(all.saturating_mul(2 * MASK)) },
            is_by_strips: true,
            ..self
        }
    }

    /// Returns the least needs of a target's pictures: by strips, where these are large.
    pub(crate) fn least(self, target: &Target) -> Self {
        if is_large(target) { self.by_strips_of(target) } else { self }
    }

    fn by_strips_of(self, target: &Target) -> Self {
        let sizes: Vec<(usize, usize)> = target.files.iter().map(|file| file.sheet.size).collect();
        self.by_strips(target.format, &sizes)
    }

    /// Returns the bytes that a frame takes at once, at most, without those of the program. Samples of a single frame are freed as
    /// they become light.
    pub(crate) fn peak(self) -> u64 {
        let Samples { all, scratch, is_kept, .. } = self.samples;
        let band = if is_kept { u64::MAX } else { (BAND * size_of::<Rgba>()) as u64 };
        let (first, last) = (sum([all, scratch.max(self.light.min(band))]), sum([self.light, all.min(band)]));
        let filtered = sum([self.light, self.prepared, self.pictures, self.piece, self.bands, self.masks]);
        let written = sum([self.pictures, self.encoded]);
        self.shared.saturating_add(first.max(last).max(filtered).max(written))
    }

    /// Returns the bytes of a frame of a sequence, without what all share: the next one is read, and the one before written, while it
    /// is made.
    fn in_sequence(self) -> FrameMemory {
        let Samples { all, moving, scratch, .. } = self.samples;
        let written = self.pictures.saturating_add(self.encoded);
        let once = sum([scratch, self.light, self.prepared, self.piece, self.bands, self.masks]);
        FrameMemory { all: sum([all, once, written]), read: moving, written }
    }

    /// Returns the bytes of the pictures.
    pub(crate) fn pictures(self) -> u64 {
        self.pictures
    }

    /// Returns the bytes of the light of the pictures, or of the strips, that are made at once.
    pub(crate) fn light_of_pictures(self) -> u64 {
        if self.is_by_strips { self.piece } else { self.pictures }
    }
}

impl Samples {
    fn of(input: &Input) -> Self {
        let mut found = Self::default();
        for (view, header, _) in input.present() {
            // Parts of a file, and turned pictures, are copies beside the whole.
            let is_copied = view.part.is_some() || header.metadata.orientation.is_some();
            let bytes = read_bytes(header).saturating_mul(if is_copied { 2 } else { 1 });
            found.all = found.all.saturating_add(bytes);
            found.scratch = found.scratch.saturating_add(scratch_bytes(header));
            if view.files.has_frames() {
                found.moving = found.moving.saturating_add(bytes);
                found.files += 1;
            }
        }
        if input.present().next().is_none() {
            // Of inputs that do not exist yet, the usual pictures: three samples of 8 bits.
            let planned = input.views().map(|view| pixels_of(&view.nominal).saturating_mul(3));
            found.all = planned.fold(0, u64::saturating_add);
        }
        found.scratch = found.scratch.min(MOST_SCRATCH.saturating_mul(rayon::current_num_threads() as u64));
        found
    }
}

impl ConvertJob {
    /// Returns the memory that its frames need, without what lies behind and without further channels.
    pub(crate) fn frame_needs(&self) -> FrameNeeds {
        let held = match self.content {
            Content::Directions(map) => Held::directions(map),
            Content::StMap => Held::PLACES,
            _ if self.fixed_codec().is_some() => Held::INTEGERS,
            _ => Held::floats(&self.light),
        };
        let needs = FrameNeeds::of(&self.input, &self.worlds, &self.target, held)
            .with_prepared(self.prepared)
            .beside_streams(self.input.ahead_bytes(&*self.files));
        let is_one = self.input.frames.len() <= 1 && !self.outputs.are_many();
        let needs = if is_one { needs } else { needs.of_many() };
        let has_bands = self.content.has_files() && self.filter.kind == FilterKind::Ewa && self.lighting.is_none();
        let views = self.target.views.iter().map(|target| (target.view.width(), target.view.height()));
        let needs = if has_bands { needs.with_bands(self.input.texels() as u64, views.clone()) } else { needs };
        let needs = if self.has_masks() { needs.with_masks(views) } else { needs };
        if self.is_by_strips() { needs.by_strips_of(&self.target) } else { needs }
    }

    /// Returns whether masks of its views are made: of what no view of the input covers, or of what lies outside the field of view.
    fn has_masks(&self) -> bool {
        let is_surrounded = self.light.channels.has_alpha() && self.light.background != Rgba::TRANSPARENT;
        self.lighting.is_none() && self.content == Content::World && (!self.is_complete() || is_surrounded)
    }

    /// Returns the bytes that the filter keeps beside the light of a world, for that view, or that part of one, for which they are most.
    pub(super) fn filter_bytes(&self) -> u64 {
        let bytes = |target: &TargetView| self.resampler(target).filter_bytes() as u64;
        if self.is_by_strips() {
            let of_strip = |strip: Strip| strip.views(&self.target.views).iter().map(bytes).max().unwrap_or(0);
            Strip::all(&self.target, STRIP).map(of_strip).max().unwrap_or(0)
        } else {
            self.target.views.iter().map(bytes).max().unwrap_or(0)
        }
    }

    /// Returns the pixels of further channels that are held at once: of all pictures, or of a strip and of the one before, which is written.
    pub(super) fn pixels_made(&self) -> u64 {
        let sizes = self.target.files.iter().map(|file| file.sheet.size);
        if self.is_by_strips() { strip_of(sizes).saturating_mul(2) } else { pixels_in(sizes) }
    }

    /// Returns the memory that a single frame needs in all: with the program, further channels, and what lies behind.
    pub(crate) fn estimated_bytes(&self, threads: usize) -> u64 {
        let of_layer = |job: &Self| {
            let further = job.layers.bytes(job.input.texels() as u64, job.pixels_made());
            job.frame_needs().peak().saturating_add(further)
        };
        let pictures = self.layers().map(of_layer).fold(0, u64::saturating_add);
        with_reserve(pictures).saturating_add(program_bytes(threads))
    }
}

impl MemoryBudget {
    /// Checks that the geometry of whole pictures, and the light of the largest file, fit before memory is allocated. A
    /// small file may declare a huge size, or be a window of a huge canvas.
    pub(crate) fn check_pictures(self, input: &Input) -> Result<()> {
        let tables = input.views().map(|view| table_bytes(&view.nominal)).fold(0, u64::saturating_add);
        // At least, since pictures of 8 bits may be held in integers.
        let light =
            |header: &Header| Held::INTEGERS.light((header.width, header.height)).saturating_add(read_bytes(header));
        let light = input.present().map(|(_, header, _)| light(header)).max().unwrap_or(0);
        let needed = sum([solid_angle_bytes(input, &[]), tables, light]);
        let largest = input.views().max_by_key(|view| pixels_of(&view.nominal)).map_or_else(String::new, |view| {
            let (width, height) = (view.nominal.width(), view.nominal.height());
            format!("; the largest whole picture, {}, has {width}x{height} pixels", view.name)
        });
        self.allow(needed, "the input", &largest)
    }

    /// Checks that the outputs of a frame fit, before anything is made.
    pub(crate) fn check_outputs(self, target: &Target, light: &Light) -> Result<()> {
        let sizes = target.files.iter().flat_map(|file| file.levels()).map(|sheet| sheet.size);
        let pixels = if is_large(target) && target.format.takes_rows() { strip_of(sizes) } else { pixels_in(sizes) };
        // Each exists as a picture, in one form or the other, or as samples.
        let least = light.file_bytes((1, 1)).min(Held::INTEGERS.pixel);
        self.allow(pixels.saturating_mul(least), "a frame", &describe(target, "; "))
    }

    /// Checks that pictures of these sizes would fit in a frame, although they are only described.
    pub(crate) fn check_sizes(self, sizes: impl IntoIterator<Item = (usize, usize)>) -> Result<()> {
        let sizes: Vec<(usize, usize)> = sizes.into_iter().collect();
        let largest = sizes.iter().max_by_key(|size| area(**size));
        let why = largest.map_or_else(String::new, |(width, height)| format!("; the output {width}x{height}"));
        let sizes = sizes.into_iter();
        // They may be made by strips.
        let pixels = if are_too_large(sizes.clone()) { strip_of(sizes) } else { pixels_in(sizes) };
        self.allow(pixels.saturating_mul(Held::INTEGERS.pixel), "a frame", &why)
    }

    /// Checks that a frame with the light of all wanted views fits, before memory is allocated.
    pub(crate) fn check_frame(self, needs: FrameNeeds, input: &Input, target: &Target) -> Result<()> {
        let largest = input.present().max_by_key(|(_, header, _)| header.width.saturating_mul(header.height));
        let largest = largest.map_or_else(String::new, |(view, header, _)| {
            format!(
                "; the largest input, {}, has {}x{} pixels",
                view.files.path(None).display(),
                header.width,
                header.height
            )
        });
        let link = if largest.is_empty() { "; " } else { ", and " };
        self.allow(with_program(needs.peak()), "a frame", &(largest + &describe(target, link)))
    }

    /// Checks that things under a world fit, which need so many bytes beside the program. Returns the bytes of all.
    ///
    /// # Errors
    /// When they do not.
    pub fn check_things(self, bytes: u64, threads: usize) -> Result<u64> {
        self.allow(with_program(bytes), "the picture", "; its world and its size decide")?;
        Ok(bytes.saturating_add(program_bytes(threads)))
    }

    /// Returns the budget that is left beside a frame.
    pub(crate) fn beside_frame(self, needs: FrameNeeds) -> Self {
        self.beside(needs.peak())
    }

    /// Checks that a frame fits together with what a filter or light prepares of the input, which frames do one after the other.
    pub(crate) fn check_prepared(self, needs: FrameNeeds) -> Result<()> {
        let why = format!("; what is prepared of the input is {} of it", human(needs.prepared));
        self.allow(with_program(needs.peak()), "a frame", &why)
    }

    /// Checks that a frame fits together with the sum of the pictures under a shutter, of so many bytes.
    pub(crate) fn check_sum(self, needs: FrameNeeds, sum: u64) -> Result<()> {
        let why = format!("; the sum of its moments, for {SHUTTER}, is {} of it", human(sum));
        self.allow(with_program(needs.peak()), "a frame", &why)
    }

    /// Checks that a frame fits together with copies of the maps, between which others are interpolated.
    pub(crate) fn check_maps(self, needs: FrameNeeds, maps: u64) -> Result<()> {
        let why = format!("; the maps between two that are computed, for {EVERY}, are {} of it", human(maps));
        self.allow(with_program(needs.peak()), "a frame", &why)
    }

    /// Chooses how many further channels are read at once, of so many texels, and returns the budget that is left beside all of them,
    /// of which so many pixels are made. It is an error if not even the largest group of them fits beside a frame.
    pub(crate) fn beside_channels(
        self,
        layers: &mut LayerPlan,
        needs: FrameNeeds,
        (read, made): (u64, u64),
    ) -> Result<Self> {
        if layers.groups.is_empty() {
            return Ok(self);
        }
        let least = layers.bytes(read, made);
        let needed = needs.peak().saturating_add(least);
        let why = format!("; its further channels are {} of it, and {CHANNELS} takes fewer", human(least));
        self.allow(needed, "a frame", &why)?;
        let spare = self.bytes - needed;
        layers.room = layers.largest_bytes(read).saturating_add(spare.min(self.bytes / READ_PART));
        Ok(self.beside(layers.bytes(read, made)))
    }

    /// Returns the memory left for geometry that all frames share.
    pub(crate) fn left_for_plan(self, needs: FrameNeeds, threads: usize) -> u64 {
        self.beside_program(threads).saturating_sub(sum([needs.shared, needs.in_sequence().all]))
    }

    /// Returns the memory left beside the program itself. A single frame may use less than is counted here, so it is
    /// not limited by it.
    fn beside_program(self, threads: usize) -> u64 {
        self.bytes.saturating_sub(program_bytes(threads))
    }

    /// Returns how many frames may be in flight around the one that is filtered, beside the geometry that they share.
    /// Each frame's files keep a thread busy, so more frames than threads are of no use.
    pub(crate) fn queue_depth(self, needs: FrameNeeds, files: usize, plans: u64, threads: usize) -> QueueDepth {
        let wanted = |files: usize| 1 + threads.div_ceil(files.max(1));
        let room = self.beside_program(threads).saturating_sub(plans).saturating_sub(needs.shared);
        // By strips, pictures are encoded as they are made.
        let written = if needs.is_by_strips { 1 } else { wanted(files) };
        QueueDepth::fitting(room, needs.in_sequence(), (wanted(needs.samples.files), written))
    }
}

/// Approximate number of texels that are decoded before their samples are freed.
pub(crate) const BAND: usize = 1 << 20;

/// Memory of the program without pictures, with its tables.
const PROGRAM: u64 = 20 << 20;

/// Memory of a thread beside the pictures that it works on: blocks of files, and the allocator's reserve.
const THREAD: u64 = 4 << 20;

/// Part of the memory of pictures that the allocator keeps beside them: freed blocks, and pages half used.
const RESERVE: u64 = 16;

/// Memory of a view beside its texels: its names, its header and its geometry, in several lists.
const VIEW: u64 = 5 << 10;

/// Pixels of a frame's pictures that are held at once, at most, where they can be made by strips.
const MOST_HELD: u64 = 1 << 27;

/// Returns whether the pictures of a target are too large to be held. With mip levels they are textures, which are held whatever their size.
pub(crate) fn is_large(target: &Target) -> bool {
    let is_alone = target.files.iter().all(|file| file.mips.is_empty());
    is_alone && are_too_large(target.files.iter().map(|file| file.sheet.size))
}

/// Returns whether pictures of these sizes are too large to be held together, where they can be made by strips.
pub(crate) fn are_too_large(sizes: impl Iterator<Item = (usize, usize)>) -> bool {
    pixels_in(sizes) > MOST_HELD
}

/// Returns the pixels of the largest strip of pictures of these sizes.
fn strip_of(sizes: impl Iterator<Item = (usize, usize)>) -> u64 {
    sizes.map(|(width, height)| area((width, height.min(STRIP)))).max().unwrap_or(0)
}

fn pixels_in(sizes: impl Iterator<Item = (usize, usize)>) -> u64 {
    sizes.map(area).fold(0, u64::saturating_add)
}

/// Rows of a strip.
pub(crate) const STRIP: usize = 512;

/// Bytes of a pixel of a mask.
const MASK: u64 = 8;

/// Rows that a thread works on.
const BAND_ROWS: u64 = 32;

/// Bytes of a texel's weight, and of what a pixel's weights need beside them.
const WEIGHT: u64 = 8;

/// Memory from which budgets hold for the program and all its threads, too. Smaller ones hold for pictures: nobody means that the program
/// itself is too large.
const SMALL: u64 = 64 << 20;

/// Bytes of blocks and copies that a decoder holds, at most.
const MOST_SCRATCH: u64 = 72 << 20;

/// Returns the memory of the program without pictures.
pub(crate) fn program_bytes(threads: usize) -> u64 {
    PROGRAM.saturating_add(THREAD.saturating_mul(threads as u64))
}

/// Adds what the allocator keeps beside pictures to their bytes.
pub(crate) fn with_reserve(pictures: u64) -> u64 {
    pictures.saturating_add(pictures / RESERVE)
}

/// Adds the program to the bytes of pictures, unless both are few.
fn with_program(pictures: u64) -> u64 {
    let all = with_reserve(pictures).saturating_add(program_bytes(rayon::current_num_threads()));
    if all < SMALL { pictures } else { all }
}

fn sum<const N: usize>(bytes: [u64; N]) -> u64 {
    bytes.into_iter().fold(0, u64::saturating_add)
}

fn pixels_of(view: &View) -> u64 {
    area((view.width(), view.height()))
}

fn describe(target: &Target, link: &str) -> String {
    let size = |Sheet { size: (width, height), .. }: &Sheet| format!("{link}the output {width}x{height}");
    target.files.first().map_or_else(String::new, |file| size(&file.sheet))
}

/// Part of the memory, at most, into which further channels are read at once, beside the largest group of them.
const READ_PART: u64 = 4;

/// Returns the bytes of tables that a view's projection holds.
fn table_bytes(view: &View) -> u64 {
    match &view.projection {
        ProjectionKind::StMap(map) => map.bytes(),
        _ => 0,
    }
}

/// Returns the bytes of blocks and copies that a file's decoder holds.
fn scratch_bytes(header: &Header) -> u64 {
    let samples = read_bytes(header);
    match header.format {
        // Blocks that are unpacked together.
        Format::Exr => samples.min(MOST_SCRATCH),
        // Coefficients of files that come in several scans.
        Format::Jpeg => samples.saturating_mul(2).min(MOST_SCRATCH),
        _ => samples.min(1 << 20),
    }
}

/// Returns the bytes of the solid angles of all texels. Views that are alike share them, as the faces of a cube do.
fn solid_angle_bytes(input: &Input, worlds: &[World]) -> u64 {
    if !worlds.is_empty() {
        return worlds.iter().map(|world| world.solid_angle_bytes() as u64).fold(0, u64::saturating_add);
    }
    let texels = input.views().map(|view: &InputView| pixels_of(&view.nominal));
    let texels = if input.faces.is_some() { texels.max().unwrap_or(0) } else { texels.fold(0, u64::saturating_add) };
    texels.saturating_mul(size_of::<f32>() as u64)
}

/// Returns the bytes that the light of a view takes while it is gathered: blocks of 4×4 texels and those above them.
pub(crate) fn gathered_bytes(view: &View) -> u64 {
    pixels_of(view).saturating_mul(11)
}
