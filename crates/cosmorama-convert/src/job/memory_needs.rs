//! Memory that a conversion needs, held against its budget before any of it is taken.

use cosmorama::camera::View;
use cosmorama::projection::ProjectionKind;
use cosmorama::raster::Rgba;
use cosmorama_io::Format;

use crate::colour::LayerPlan;
use crate::diagnostic::{CHANNELS, EVERY, Result, SHUTTER};
use crate::input::{Input, InputView};
use crate::job::{FrameMemory, QueueDepth};
use crate::source::MemoryBudget;
use crate::source::memory_budget::{area, human, light_bytes, read_bytes};
use crate::target::{Sheet, Target};

impl MemoryBudget {
    /// Checks that the geometry of whole pictures, and the light of the largest file, fit before memory is allocated. A
    /// small file may declare a huge size, or be a window of a huge canvas.
    pub(crate) fn check_pictures(self, input: &Input) -> Result<()> {
        let texels = |view: &InputView| pixels(&view.nominal);
        let geometry = input.views().map(texels).fold(0, u64::saturating_add).saturating_mul(SOLID_ANGLE);
        let tables = input.views().map(|view| table_bytes(&view.nominal)).fold(0, u64::saturating_add);
        let light = input.present().map(|(_, header, _)| light_bytes(header)).max().unwrap_or(0);
        let needed = geometry.saturating_add(tables).saturating_add(light);
        let largest = input.views().max_by_key(|view| texels(view)).map_or_else(String::new, |view| {
            let (width, height) = (view.nominal.width(), view.nominal.height());
            format!("; the largest whole picture, {}, has {width}x{height} pixels", view.name)
        });
        self.allow(needed, "the input", &largest)
    }

    /// Checks that the outputs of a frame fit, before anything is made.
    pub(crate) fn check_outputs(self, target: &Target) -> Result<()> {
        self.allow(output_bytes(target), "a frame", &describe(target, "; "))
    }

    /// Checks that pictures of these sizes would fit in a frame, although they are only described.
    pub(crate) fn check_sizes(self, sizes: impl IntoIterator<Item = (usize, usize)>) -> Result<()> {
        let sizes: Vec<(usize, usize)> = sizes.into_iter().collect();
        let largest = sizes.iter().max_by_key(|size| area(**size));
        let why = largest.map_or_else(String::new, |(width, height)| format!("; the output {width}x{height}"));
        self.allow(pixel_bytes(sizes), "a frame", &why)
    }

    /// Checks that a frame with the light of all wanted views fits, before memory is allocated.
    pub(crate) fn check_frame(self, input: &Input, target: &Target) -> Result<()> {
        let largest = input.present().max_by_key(|(_, header, _)| header.width.saturating_mul(header.height));
        let largest = largest.map_or_else(String::new, |(view, header, _)| {
            format!(
                "; the largest input, {}, has {}x{} pixels",
                view.files.path(None).display(),
                header.width,
                header.height
            )
        });
        self.allow(frame_bytes(input, target), "a frame", &(largest + &describe(target, ", and ")))
    }

    /// Returns the budget that is left beside a frame.
    pub(crate) fn beside_frame(self, input: &Input, target: &Target) -> Self {
        self.beside(frame_bytes(input, target))
    }

    /// Returns the budget that is left beside what a filter or light prepares of the input, which frames do one after the
    /// other. It is an error if a frame and that do not fit.
    pub(crate) fn beside_prepared(self, prepared: u64, input: &Input, target: &Target) -> Result<Self> {
        let needed = frame_bytes(input, target).saturating_add(prepared);
        let why = format!("; what is prepared of the input is {} of it", human(prepared));
        self.allow(needed, "a frame", &why)?;
        Ok(self.beside(prepared))
    }

    /// Returns the budget that is left beside the sum of the pictures under a shutter. It is an error if a frame and that
    /// do not fit.
    pub(crate) fn beside_sum(self, input: &Input, target: &Target) -> Result<Self> {
        let sum = output_bytes(target) / 2;
        let why = format!("; the sum of its moments, for {SHUTTER}, is {} of it", human(sum));
        self.allow(frame_bytes(input, target).saturating_add(sum), "a frame", &why)?;
        Ok(self.beside(sum))
    }

    /// Returns the budget that is left beside copies of the maps, between which others are interpolated. It is an error if a frame
    /// and they do not fit.
    pub(crate) fn beside_maps(self, copies: u64, input: &Input, target: &Target) -> Result<Self> {
        let maps = (output_bytes(target) / 2).saturating_mul(copies);
        let why = format!("; the maps between two that are computed, for {EVERY}, are {} of it", human(maps));
        self.allow(frame_bytes(input, target).saturating_add(maps), "a frame", &why)?;
        Ok(self.beside(maps))
    }

    /// Chooses how many further channels are read at once, and returns the budget that is left beside all of them. It
    /// is an error if not even the largest group of them fits beside a frame.
    pub(crate) fn beside_channels(self, layers: &mut LayerPlan, input: &Input, target: &Target) -> Result<Self> {
        if layers.groups.is_empty() {
            return Ok(self);
        }
        let made = target.files.iter().map(|file| area(file.sheet.size)).fold(0, u64::saturating_add);
        let read = input.texels() as u64;
        let least = layers.bytes(read, made);
        let needed = frame_bytes(input, target).saturating_add(least);
        let why = format!("; its further channels are {} of it, and {CHANNELS} takes fewer", human(least));
        self.allow(needed, "a frame", &why)?;
        let spare = self.bytes - needed;
        layers.room = layers.largest_bytes(read).saturating_add(spare.min(self.bytes / READ_PART));
        Ok(self.beside(layers.bytes(read, made)))
    }

    /// Returns the memory left for geometry that all frames share.
    pub(crate) fn left_for_plan(self, input: &Input, target: &Target, threads: usize) -> u64 {
        self.beside_program(threads).saturating_sub(frame_bytes(input, target)).saturating_sub(plane_bytes(target))
    }

    /// Returns the memory left beside the program itself. A single frame may use less than is counted here, so it is
    /// not limited by it.
    fn beside_program(self, threads: usize) -> u64 {
        self.bytes.saturating_sub(PROGRAM).saturating_sub(THREAD.saturating_mul(threads as u64))
    }

    /// Returns how many frames may be in flight around the one that is filtered, beside the geometry that they share.
    /// Each frame's files keep a thread busy, so more frames than threads are of no use.
    pub(crate) fn queue_depth(self, input: &Input, target: &Target, plans: u64, threads: usize) -> QueueDepth {
        let moving = input.present().filter(|(view, ..)| view.files.has_frames());
        let (files, read) = moving
            .fold((0, 0_u64), |(files, bytes), (_, header, _)| (files + 1, bytes.saturating_add(read_bytes(header))));
        let wanted = |files: usize| 1 + threads.div_ceil(files.max(1));
        let geometry = geometry_bytes(input, target);
        let planes = plane_bytes(target);
        let frame = FrameMemory {
            all: frame_bytes(input, target).saturating_sub(geometry).saturating_add(planes),
            read,
            written: output_bytes(target).saturating_add(planes),
        };
        let room = self.beside_program(threads).saturating_sub(plans).saturating_sub(geometry);
        QueueDepth::fitting(room, frame, (wanted(files), wanted(target.files.len())))
    }
}

/// Memory of the program without pictures, with its tables.
const PROGRAM: u64 = 8 << 20;

/// Memory of a thread beside the pictures that it works on: bands of geometry, blocks of files, and the allocator's
/// reserve.
const THREAD: u64 = 3 << 20;

/// Bytes of a texel's solid angle.
const SOLID_ANGLE: u64 = size_of::<f32>() as u64;

fn pixels(view: &View) -> u64 {
    area((view.width(), view.height()))
}

fn describe(target: &Target, link: &str) -> String {
    let size = |Sheet { size: (width, height), .. }: &Sheet| format!("{link}the output {width}x{height}");
    target.files.first().map_or_else(String::new, |file| size(&file.sheet))
}

/// Returns the bytes of the outputs and their encoded samples.
fn output_bytes(target: &Target) -> u64 {
    pixel_bytes(target.files.iter().flat_map(|file| file.levels()).map(|sheet| sheet.size))
}

/// Part of the memory, at most, into which further channels are read at once, beside the largest group of them.
const READ_PART: u64 = 4;

/// Returns the bytes of OpenEXR's planes, into which samples are sorted while their pictures are still held.
fn plane_bytes(target: &Target) -> u64 {
    if target.format == Format::Exr { output_bytes(target) / 2 } else { 0 }
}

/// Returns the bytes of pictures of these sizes, with their encoded samples.
fn pixel_bytes(sizes: impl IntoIterator<Item = (usize, usize)>) -> u64 {
    let pixels = sizes.into_iter().map(area).fold(0, u64::saturating_add);
    pixels.saturating_mul(2 * size_of::<Rgba>() as u64)
}

/// Returns the bytes of tables that a view's projection holds.
fn table_bytes(view: &View) -> u64 {
    match &view.projection {
        ProjectionKind::StMap(map) => map.bytes(),
        _ => 0,
    }
}

/// Returns the bytes that all frames share, without plans: the solid angle of every texel, and tables.
fn geometry_bytes(input: &Input, target: &Target) -> u64 {
    let angles = (input.texels() as u64).saturating_mul(SOLID_ANGLE);
    let views = input.views().map(|view| &view.nominal).chain(target.views.iter().map(|target| &target.view));
    let tables = views.map(table_bytes).fold(0, u64::saturating_add);
    angles.saturating_add(tables)
}

/// Returns the bytes of a frame with everything that it shares: its files, their light, and the outputs.
fn frame_bytes(input: &Input, target: &Target) -> u64 {
    let light = input.present().map(|(_, header, _)| light_bytes(header)).fold(0, u64::saturating_add);
    light.saturating_add(geometry_bytes(input, target)).saturating_add(output_bytes(target))
}

/// Returns the bytes that the light of a view takes while it is gathered: blocks of 4×4 texels and those above them.
pub(crate) fn gathered_bytes(view: &View) -> u64 {
    (view.width() as u64).saturating_mul(view.height() as u64).saturating_mul(11)
}
