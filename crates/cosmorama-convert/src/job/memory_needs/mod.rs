//! Memory that a conversion needs, held against its budget before any of it is taken.
//!
//! A frame is read, then filtered, then written, and each of these frees what the next does not need. So it takes what the greediest of
//! them holds, and not the sum of all.

mod checks;
mod codecs;
mod footprint;
mod rings;

use cosmorama::camera::View;
use cosmorama::projection::ProjectionKind;
use cosmorama::raster::{FixedLight, Rgba};
use cosmorama::world::{StPixel, World};
use cosmorama_builtin::{DirectionMap, DirectionPixel};
use cosmorama_io::{Format, Header};

use crate::colour::Light;
use crate::detect::disc;
use crate::input::{Input, InputView};
use crate::job::gaps::Shot;
use crate::job::{Content, ConvertJob, FrameMemory, QueueDepth};
use crate::source::memory_budget::{area, map_reading_bytes, read_bytes};
use crate::target::{Sheet, Strip, Target, TargetView};

pub(crate) use footprint::footprint_bytes;

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

    /// Opaque pictures of 8 bits, made of light at once.
    pub(crate) const CODES: Self = Self { is_fixed: false, pixel: size_of::<[u8; 3]>() as u64, encoded: 0 };

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
    /// Weights of the texels under pixels that threads work on.
    footprints: u64,
    /// Masks of pixels that no view covers.
    masks: u64,
    /// Copy of the light in which the circle of a lens is looked for, before pictures are made.
    looked_at: u64,
    /// Samples of the pictures.
    encoded: u64,
    /// Bytes that encoders hold beside the samples of the pictures that they write.
    written: u64,
    /// Blocks that threads pack, of whichever pictures.
    blocks: u64,
    /// Bytes in which the largest st map is read, before any frame.
    maps: u64,
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
            footprints: 0,
            masks: 0,
            looked_at: looked_at_bytes(input),
            encoded: pixels.saturating_mul(held.encoded),
            written: 0,
            blocks: 0,
            maps: 0,
            is_by_strips: false,
        };
        needs.beside_tables(input.views().map(|view| &view.nominal))
    }

    /// Adds the tables of views' projections.
    pub(crate) fn beside_tables<'v>(self, views: impl Iterator<Item = &'v View>) -> Self {
        views.filter(|view| is_map(view)).fold(self, |needs, view| Self {
            shared: needs.shared.saturating_add(map_bytes(view)),
            maps: needs.maps.max(map_reading_bytes(map_bytes(view))),
            ..needs
        })
    }

    /// Adds the weights of the texels under the largest pixels.
    pub(crate) fn with_footprints(self, bytes: u64) -> Self {
        Self { footprints: bytes, ..self }
    }

    /// Adds masks of views of these sizes, none of whose pixels is as the one beside it.
    pub(crate) fn with_masks(self, views: impl Iterator<Item = (usize, usize)>) -> Self {
        Self { masks: pixels_in(views).saturating_mul(MASK), ..self }
    }

    /// Adds what is made of the input before pictures are, or copies of pictures.
    pub(crate) fn with_prepared(self, bytes: u64) -> Self {
        Self { prepared: self.prepared.saturating_add(bytes), ..self }
    }

    /// Adds what encoders of a format hold beside samples of pictures of these sizes.
    pub(crate) fn with_encoders_of(self, format: Format, sizes: &[(usize, usize)]) -> Self {
        let samples = self.samples_of_pictures();
        let pixel = samples / pixels_in(sizes.iter().copied()).max(1);
        let row = sizes.iter().map(|(width, _)| *width as u64).max().unwrap_or(0).saturating_mul(pixel);
        Self { written: encoded_beside(format, samples), blocks: packed_blocks(format, samples, row), ..self }
    }

    /// Returns the bytes of the samples of the pictures: integers are samples themselves.
    fn samples_of_pictures(self) -> u64 {
        if self.encoded > 0 { self.encoded } else { self.pictures }
    }

    /// Adds pictures that streams hold beside those of frames.
    pub(crate) fn beside_streams(self, bytes: u64) -> Self {
        Self { shared: self.shared.saturating_add(bytes), ..self }
    }

    /// Leaves out what is held of the input's pictures, of which maps of places need no light, but for those that were looked at.
    fn without_light(self, looked_at: u64) -> Self {
        Self { samples: Samples::default(), light: 0, prepared: 0, footprints: 0, looked_at, ..self }
    }

    /// Returns the needs of one frame of many.
    pub(crate) fn of_many(self) -> Self {
        Self { samples: Samples { is_kept: true, ..self.samples }, ..self }
    }

    /// Returns the needs where all of so many files of the input change from frame to frame.
    pub(crate) fn of_moving_input(self, files: usize) -> Self {
        Self { samples: Samples { moving: self.samples.all, files, ..self.samples }, ..self }
    }

    /// Returns the needs of pictures of these sizes that are made one after the other, strip by strip: only a strip of one is there at once,
    /// with the samples of the one before, which are written; all samples of a picture where the format is not written row by row.
    pub(crate) fn by_strips(self, format: Format, sizes: &[(usize, usize)]) -> Self {
        let all = pixels_in(sizes.iter().copied()).max(1);
        let strips = Strips::of(sizes.iter().copied());
        let of = |bytes: u64, pixels: u64| (bytes / all).saturating_mul(pixels);
        let is_encoded = self.encoded > 0;
        let samples = |pixels: u64| of(if is_encoded { self.encoded } else { self.pictures }, pixels);
        // Integers are samples themselves.
        let light = |pixels: u64| if is_encoded { of(self.pictures, pixels) } else { 0 };
        let made = |pixels: u64| light(pixels).saturating_add(samples(pixels));
        let largest = sizes.iter().copied().map(area).max().unwrap_or(0);
        let written = if format.takes_rows() { samples(strips.first) } else { samples(largest) };
        // OpenEXR sorts those that it writes by channel.
        let sorted = if format == Format::Exr { samples(strips.first) } else { 0 };
        // The first is made by itself, and written while the next is made.
        let most = made(strips.first).max(sum([written, sorted, made(strips.next)]));
        let light = light(strips.first);
        Self {
            pictures: most.saturating_sub(light),
            piece: light.saturating_add(of(self.pictures, strips.first).min(self.piece)),
            encoded: 0,
            written: 0,
            masks: if self.masks == 0 { 0 } else { strips.first.saturating_mul(MASK) },
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
        let filtered = sum([self.light, self.prepared, self.pictures, self.piece, self.footprints, self.masks]);
        let looked_at = self.light.saturating_add(self.looked_at);
        let written = sum([self.pictures, self.encoded, self.blocks]);
        self.shared.saturating_add(first.max(last).max(looked_at).max(filtered).max(written)).max(self.maps)
    }

    /// Returns the bytes of a frame of a sequence, without what all share: the next one is read, and the one before written, while it
    /// is made. Of those that are written there are samples alone.
    fn in_sequence(self) -> FrameMemory {
        let Samples { all, moving, scratch, .. } = self.samples;
        let made = sum([self.pictures, self.encoded, self.written]);
        let written = self.samples_of_pictures().saturating_add(self.written);
        let filtered = sum([self.prepared, self.piece, self.footprints, self.masks]);
        let once = sum([scratch, self.light, filtered.max(self.looked_at), self.blocks]);
        FrameMemory { all: sum([all, once, made]), read: moving, written }
    }

    /// Returns the memory of a run that makes one frame.
    pub(crate) fn picture_bytes(self, threads: usize) -> u64 {
        with_reserve(self.peak()).saturating_add(program_bytes(threads, self.made()))
    }

    /// Returns the memory of a run that makes many frames, with so many bytes of geometry and of what lies behind. Each frame in flight is
    /// worked on by a thread.
    pub(crate) fn sequence_bytes(self, depth: QueueDepth, beside: u64, threads: usize) -> u64 {
        let pictures = sum([self.shared, depth.bytes, beside]).max(self.maps);
        let made = self.made().saturating_mul((depth.read + depth.written) as u64);
        with_reserve(pictures).saturating_add(program_bytes(threads, made))
    }

    /// Returns the bytes that are made of pictures.
    fn made(self) -> u64 {
        sum([self.pictures, self.piece, self.encoded])
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
        self.frame_needs_held(held)
    }

    /// Returns the memory that its frames need if they are opaque pictures of 8 bits, made of light at once.
    pub(crate) fn frame_needs_of_codes(&self) -> FrameNeeds {
        self.frame_needs_held(Held::CODES)
    }

    fn frame_needs_held(&self, held: Held) -> FrameNeeds {
        let needs = FrameNeeds::of(&self.input, &self.worlds, &self.target, held)
            .with_prepared(self.prepared)
            .beside_streams(self.input.ahead_bytes(&*self.files));
        let is_one = self.input.frames.len() <= 1 && !self.outputs.are_many();
        let needs = if is_one { needs } else { needs.of_many() };
        let views = self.target.views.iter().map(|target| &target.view);
        let sizes: Vec<_> = self.target.files.iter().flat_map(|file| file.levels()).map(|sheet| sheet.size).collect();
        let needs = needs.with_footprints(self.footprints).with_encoders_of(self.target.format, &sizes);
        let needs = if self.has_masks() { needs.with_masks(views.map(size_of_view)) } else { needs };
        let needs = if self.is_by_strips() { needs.by_strips_of(&self.target) } else { needs };
        if self.content == Content::StMap { needs.without_light(self.decoded.looked_at()) } else { needs }
    }

    /// Returns the bytes of the weights of the texels under its largest pixels, in a few of its shots.
    pub(super) fn footprint_bytes(&self, shots: &[Shot]) -> u64 {
        const SHOTS: usize = 16;
        let some = shots.iter().step_by(shots.len().div_ceil(SHOTS).max(1));
        let views = some.flat_map(|shot| &shot.views).map(|target| &target.view);
        footprint_bytes(self.filter.kind, &self.input, views)
    }

    /// Returns whether the masks of what no view of the input covers take memory.
    fn has_masks(&self) -> bool {
        let is_torn = is_torn(&self.input, self.target.views.iter().map(|target| &target.view));
        is_torn && self.lighting.is_none() && self.content == Content::World && !self.is_complete()
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
        if self.is_by_strips() {
            let Strips { first, next } = Strips::of(sizes);
            first.saturating_add(next)
        } else {
            pixels_in(sizes)
        }
    }

    /// Returns the memory that a single frame needs in all: with the program, further channels, and what lies behind.
    pub(crate) fn estimated_bytes(&self, threads: usize) -> u64 {
        let of_layer = |job: &Self| {
            let needs = job.frame_needs();
            let further = job.layers.bytes(job.input.texels() as u64, job.pixels_made());
            [needs.peak().saturating_add(further), needs.made()]
        };
        let sums = |[a, b]: [u64; 2], [c, d]: [u64; 2]| [a.saturating_add(c), b.saturating_add(d)];
        let [all, made] = self.layers().map(of_layer).fold([0, 0], sums);
        with_reserve(all).saturating_add(program_bytes(threads, made))
    }
}

/// Approximate number of texels that are decoded before their samples are freed.
pub(crate) const BAND: usize = 1 << 20;

/// Memory of the program without pictures, with its tables.
const PROGRAM: u64 = 23 << 20;

/// Memory of a thread beside the pictures that it works on: weights of some pixels, blocks of files, and the allocator's reserve.
const THREAD: u64 = 1 << 19;

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

/// Pixels of the largest strips of pictures.
#[derive(Clone, Copy)]
struct Strips {
    first: u64,
    /// Of the one that is made while the first is written.
    next: u64,
}

impl Strips {
    fn of(sizes: impl Iterator<Item = (usize, usize)>) -> Self {
        sizes.fold(Self { first: 0, next: 0 }, |most, (width, height)| {
            let (first, next) = (height.min(STRIP), height.saturating_sub(STRIP).min(STRIP));
            Self { first: most.first.max(area((width, first))), next: most.next.max(area((width, next))) }
        })
    }
}

pub(crate) fn pixels_in(sizes: impl Iterator<Item = (usize, usize)>) -> u64 {
    sizes.map(area).fold(0, u64::saturating_add)
}

/// Rows of a strip.
pub(crate) const STRIP: usize = 512;

/// Bytes of a pixel of a mask that differs from its neighbours.
const MASK: u64 = 12;

/// Bytes of blocks and copies that a decoder holds, at most.
const MOST_SCRATCH: u64 = 72 << 20;

/// Returns the bytes that an encoder holds beside a picture's samples: OpenEXR sorts them by channel, and a JPEG is encoded as a whole.
pub fn encoded_beside(format: Format, samples: u64) -> u64 {
    match format {
        Format::Exr => samples,
        Format::Jpeg => samples / 2,
        _ => 0,
    }
}

/// Returns the bytes of the blocks that all threads pack, of a picture with so many bytes of samples in all and in a row. Those of OpenEXR
/// have 16 rows; each is there as samples, in their order, in the file's, as differences, and packed, and some wait to be written.
pub fn packed_blocks(format: Format, samples: u64, row: u64) -> u64 {
    const COPIES: u64 = 6;
    if format != Format::Exr {
        return 0;
    }
    let threads = rayon::current_num_threads() as u64;
    row.saturating_mul(16 * COPIES).saturating_mul(threads).min(samples.saturating_mul(3))
}

/// Returns the memory of the program without its pictures, of which so many bytes are made. Threads take no more than there is to make.
pub(crate) fn program_bytes(threads: usize, made: u64) -> u64 {
    PROGRAM.saturating_add(THREAD.saturating_mul(threads as u64).min(made.saturating_mul(8)))
}

/// Adds what the allocator keeps beside pictures to their bytes.
pub(crate) fn with_reserve(pictures: u64) -> u64 {
    pictures.saturating_add(pictures / RESERVE)
}

/// Returns how many bytes of pictures, with what the allocator keeps beside them, fit into so many.
fn without_reserve(bytes: u64) -> u64 {
    bytes - bytes.div_ceil(RESERVE + 1)
}

fn sum<const N: usize>(bytes: [u64; N]) -> u64 {
    bytes.into_iter().fold(0, u64::saturating_add)
}

fn pixels_of(view: &View) -> u64 {
    area(size_of_view(view))
}

fn size_of_view(view: &View) -> (usize, usize) {
    (view.width(), view.height())
}

/// Returns the bytes of the copy in which the circle of a lens is looked for.
fn looked_at_bytes(input: &Input) -> u64 {
    let views: Vec<&InputView> = input.views().collect();
    match views[..] {
        [view] if matches!(view.nominal.projection, ProjectionKind::Fisheye(_) | ProjectionKind::MirrorBall(_)) => {
            disc::copy_bytes(size_of_view(&view.nominal))
        }
        _ => 0,
    }
}

/// Returns the bytes of the st map that a view's projection holds.
fn map_bytes(view: &View) -> u64 {
    match &view.projection {
        ProjectionKind::StMap(map) => map.bytes(),
        _ => 0,
    }
}

/// Returns whether the world of an input may end in any pixel of these views, so that their masks take memory: at views with masks of their
/// own, maps, and many views with gaps.
pub(crate) fn is_torn<'v>(input: &Input, mut views: impl Iterator<Item = &'v View>) -> bool {
    const MANY: usize = 100;
    let mut parts = input.views();
    parts.any(|part| part.mask.is_some() || is_map(&part.nominal))
        || views.any(is_map)
        || input.views().nth(MANY).is_some()
}

fn is_map(view: &View) -> bool {
    matches!(view.projection, ProjectionKind::StMap(_))
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
