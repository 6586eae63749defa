//! Costs of a sequence before it is made: processor time, memory and disk.

use std::collections::HashSet;

use cosmorama::explain::Report;
use cosmorama::filter::FilterKind;
use cosmorama::raster::{Channels, Depth, FixedCodec, Rgba};
use cosmorama::render::Arithmetic;
use cosmorama::world::World;
use cosmorama_io::{Format, Header, Metadata};

use super::Explanation;
use crate::input::{Input, InputView};
use crate::job::{
    FrameNeeds, Held, are_too_large, compressed, footprint_bytes, is_balanced, is_torn, makes_strips, pixels_in,
};
use crate::source::memory_budget::{area, read_bytes};
use crate::target::Picture;

/// Kind of files that a sequence is written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostedFiles {
    /// PNG of 8 bits.
    EightBits,
    /// OpenEXR halves.
    Halves,
}

/// Costs of a sequence, about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SequenceCost {
    /// Files for which it holds.
    pub files: CostedFiles,
    /// Processor seconds of a frame, all threads added.
    pub cpu_seconds: f64,
    /// Memory of a run that makes a single picture.
    pub picture: CostedMemory,
    /// Memory of a run that makes many frames, with as many threads as there are now.
    pub sequence: CostedMemory,
    /// Disk for a frame.
    pub frame_bytes: u64,
}

/// Memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CostedMemory {
    /// Bytes.
    pub bytes: u64,
    /// Whether so many may be taken; the run is refused else.
    pub is_allowed: bool,
}

impl SequenceCost {
    /// Returns how many frames a core makes in an hour.
    pub fn frames_a_core_hour(&self) -> f64 {
        3600.0 / self.cpu_seconds.max(f64::MIN_POSITIVE)
    }
}

/// Nanoseconds of work on one core of a server with AVX2, near 3 GHz: those of 48 frames in docs/performance.md, "Whole commands". With
/// AVX-512 the filter takes half as long.
struct Nanoseconds {
    /// For each pixel that shows something.
    pixel: f64,
    /// For each texel that is averaged.
    texel: f64,
    /// For each byte of an input's samples: decoded, and brought to light.
    read: f64,
    /// For each byte of an output's samples: encoded and written.
    written: f64,
}

impl Nanoseconds {
    /// Counts the geometry, too, where it is not kept, as of a moving camera: figures of tilted domes of 512² to 2048² from panoramas of
    /// 1024×512 and 4096×2048 (docs/performance.md, "A moving camera").
    fn with_geometry(self) -> Self {
        Self { pixel: 65.0, texel: 5.5, ..self }
    }
}

impl CostedFiles {
    /// All kinds.
    pub const ALL: [Self; 2] = [Self::EightBits, Self::Halves];

    fn nanoseconds(self) -> Nanoseconds {
        match self {
            Self::EightBits => Nanoseconds { pixel: 2.0, texel: 0.75, read: 3.0, written: 2.0 },
            Self::Halves => Nanoseconds { pixel: 6.0, texel: 1.5, read: 3.0, written: 20.0 },
        }
    }

    fn format(self) -> Format {
        match self {
            Self::EightBits => Format::Png,
            Self::Halves => Format::Exr,
        }
    }

    /// Bytes of a pixel's samples, with alpha if an input has it.
    fn pixel_bytes(self, input: &Input) -> u64 {
        let depth = if self == Self::EightBits { Depth::Eight } else { Depth::Half };
        let channels = if has_alpha(input) { Channels::Rgba } else { Channels::Rgb };
        (channels.count() * depth.bytes()) as u64
    }
}

/// Manner in which pictures are made, and held meanwhile.
#[derive(Clone, Copy)]
struct Manner {
    /// Of a picture whose geometry is not kept.
    alone: Held,
    /// Of a frame whose geometry is kept.
    kept: Held,
    arithmetic: Arithmetic,
}

/// Geometry that is kept for all frames.
#[derive(Clone, Copy)]
struct Kept {
    bytes: u64,
    /// Part of all geometry, 0 to 1.
    part: f64,
}

/// Input and pictures of a frame, without which no cost can be told.
struct Scene<'a> {
    /// Views that a picture needs.
    input: Input,
    worlds: &'a [World],
    reports: &'a [Report],
    /// Sizes of its files.
    sizes: Vec<(usize, usize)>,
    /// Whether large pictures are made strip by strip.
    is_by_strips: bool,
}

impl Explanation {
    /// Returns the number of frames that are asked for, or else that the input has; `None` where that is one picture.
    pub fn frames(&self) -> Option<usize> {
        let asked = self.asked_frames.as_ref().map(|frames| frames.frames().len());
        asked.or(Some(self.input().frames.len()).filter(|frames| *frames > 1))
    }

    /// Returns the costs of making all pictures, frame by frame, by their reports.
    pub fn costs(&self, worlds: &[World], reports: &[Report]) -> Vec<SequenceCost> {
        let (input, sizes) = (self.needed(reports), self.file_sizes());
        let is_by_strips = are_too_large(sizes.iter().copied()) && makes_strips(&self.filter, self.has_shutter());
        let scene = Scene { input, worlds, reports, sizes, is_by_strips };
        CostedFiles::ALL.into_iter().map(|files| self.pool.install(|| self.cost(files, &scene))).collect()
    }

    fn cost(&self, files: CostedFiles, scene: &Scene) -> SequenceCost {
        let manner = self.manner(files, scene);
        let threads = self.pool.current_num_threads();
        let alone = self.needs(files, manner.alone, scene);
        let one_of_many = |held: Held| self.of_many(self.needs(files, held, scene), &scene.input);
        let least = one_of_many(manner.alone);
        let kept = self.kept(manner.arithmetic, self.memory.left_for_plan(least, threads), scene);
        let is_kept = kept.part == 1.0 && !scene.is_by_strips;
        let needs = if is_kept { one_of_many(manner.kept) } else { least };
        let frames = self.frames().unwrap_or(usize::MAX);
        let depth = self.memory.queue_depth(needs, (frames, scene.sizes.len()), kept.bytes, threads);
        let raw = pixels_in(scene.sizes.iter().copied()).saturating_mul(files.pixel_bytes(&scene.input));
        let memory =
            |bytes: u64, needs: FrameNeeds| CostedMemory { bytes, is_allowed: self.memory.allows_frame(needs) };
        // Where not one frame fits, no room is left that could be counted: then, what one needs.
        let sequence = match memory(needs.sequence_bytes(depth, kept.bytes, threads), least) {
            memory if memory.is_allowed => memory,
            refused => CostedMemory { bytes: least.picture_bytes(threads), ..refused },
        };
        SequenceCost {
            files,
            cpu_seconds: seconds((files, kept.part), scene, raw),
            picture: memory(alone.picture_bytes(threads), alone),
            sequence,
            frame_bytes: compressed(raw, files.format(), None),
        }
    }

    fn has_shutter(&self) -> bool {
        self.movement.as_ref().is_some_and(|(movement, _)| movement.blur.is_some())
    }

    /// Returns the needs of one frame of many. A world that a moving camera looks at may be a still one; other files, and those that do not
    /// exist yet, change from frame to frame.
    fn of_many(&self, needs: FrameNeeds, input: &Input) -> FrameNeeds {
        let present = input.present().count();
        let is_still = self.movement.is_some() && present > 0;
        let files = if present > 0 { present } else { input.views().count() };
        if is_still { needs.of_many() } else { needs.of_moving_input(files).of_many() }
    }

    /// Returns how the pictures of files are made. Integers take inputs of 8 bits without alpha; those that do not exist yet are taken for
    /// such.
    fn manner(&self, files: CostedFiles, Scene { input, reports, .. }: &Scene) -> Manner {
        let floats = Held::of_samples(files.pixel_bytes(input));
        let any = Manner { alone: floats, kept: floats, arithmetic: Arithmetic::Float };
        let is_complete = reports.iter().all(|report| report.uncovered.is_none());
        if files == CostedFiles::Halves || self.has_shutter() || !is_complete || is_balanced(&self.filter) {
            return any;
        }
        if Arithmetic::Fixed.has_plan_of(self.filter.kind) && takes_integers(input) {
            return Manner { alone: Held::INTEGERS, kept: Held::INTEGERS, arithmetic: Arithmetic::Fixed };
        }
        // A plan of floats makes samples of 8 bits without a picture of light, unless it is one of a pyramid.
        let is_at_once = input.holds_only_integers() && !has_alpha(input) && self.filter.kind != FilterKind::EwaPyramid;
        if is_at_once { Manner { kept: Held::CODES, ..any } } else { any }
    }

    /// Returns the needs of a frame whose pictures are held so.
    fn needs(&self, files: CostedFiles, held: Held, scene: &Scene) -> FrameNeeds {
        let Scene { input, worlds, reports, sizes, is_by_strips } = scene;
        let size = |picture: &Picture| (picture.view.width(), picture.view.height());
        let is_part = |picture: &&Picture| picture.place.is_some_and(|place| !place.is_whole(size(picture)));
        let largest = self.pictures().iter().filter(is_part).map(|picture| area(size(picture))).max().unwrap_or(0);
        let prepared = reports.iter().map(|report| report.memory.levels as u64).max().unwrap_or(0);
        let views = || self.pictures().iter().map(|picture| &picture.view);
        let whole = FrameNeeds::of_pictures(input, worlds, (pixels_in(sizes.iter().copied()), largest), held)
            .beside_tables(views())
            .with_prepared(prepared)
            .with_footprints(footprint_bytes(self.filter.kind, input, views()))
            .with_encoders_of(files.format(), sizes);
        let has_masks = reports.iter().any(|report| report.uncovered.is_some()) && is_torn(input, views());
        let masked = if has_masks { whole.with_masks(self.pictures().iter().map(size)) } else { whole };
        if *is_by_strips { masked.by_strips(files.format(), sizes) } else { masked }
    }

    /// Returns the plans that fit into so many bytes: those of whole pictures, or of as many strips as there is room for. A camera that moves
    /// has another geometry in each frame, of which none is kept.
    fn kept(&self, arithmetic: Arithmetic, room: u64, scene: &Scene) -> Kept {
        if self.movement.is_some() {
            return Kept { bytes: 0, part: 0.0 };
        }
        let (mut bytes, mut all) = (0, 0_u64);
        for Report { memory, .. } in scene.reports {
            let plan = if arithmetic == Arithmetic::Fixed { memory.fixed_plan } else { memory.plan } as u64;
            let left = room.saturating_sub(bytes);
            let kept = match (plan <= left, scene.is_by_strips) {
                (true, _) => plan,
                (false, true) => left,
                (false, false) => 0,
            };
            (bytes, all) = (bytes + kept, all.saturating_add(plan));
        }
        // Filters without a plan have no geometry that could be kept.
        Kept { bytes, part: if all == 0 { 1.0 } else { bytes as f64 / all as f64 } }
    }

    /// Returns the sizes of the files of a frame. Pictures that have places fill as few as hold them.
    fn file_sizes(&self) -> Vec<(usize, usize)> {
        let size = |picture: &Picture| (picture.view.width(), picture.view.height());
        let sheet =
            self.pictures().iter().find_map(|picture| picture.place.filter(|place| !place.is_whole(size(picture))));
        let all = || self.pictures().iter().map(|picture| area(size(picture))).fold(0, u64::saturating_add);
        sheet.map_or_else(
            || self.pictures().iter().map(size).collect(),
            |place| vec![place.of; all().div_ceil(area(place.of).max(1)) as usize],
        )
    }

    /// Returns the input with those views that a picture needs.
    fn needed(&self, reports: &[Report]) -> Input {
        let views = reports.iter().flat_map(|report| &report.views);
        let needed: HashSet<&str> =
            views.filter(|view| view.need.read.is_some()).map(|view| view.need.name.as_str()).collect();
        let kept = |views: &Vec<InputView>| -> Vec<InputView> {
            views.iter().filter(|view| needed.contains(view.name.as_str())).cloned().collect()
        };
        let Input { worlds, frames, .. } = self.input();
        Input { worlds: worlds.iter().map(kept).collect(), frames: frames.clone(), faces: None, beside: Vec::new() }
    }
}

/// Returns whether an input has alpha, so that outputs have it, too.
fn has_alpha(input: &Input) -> bool {
    input.present().any(|(_, header, _)| header.channels.has_alpha())
}

/// Returns whether all inputs are opaque, of 8 bits, of the same primaries, and fit the light of integers, as the outputs do, which are
/// encoded like the first.
fn takes_integers(input: &Input) -> bool {
    let first = input.present().next().map(|(_, header, _)| header.metadata.clone()).unwrap_or_default();
    let transfer = |header: &Header| {
        let Metadata { transfer, primaries, .. } = &header.metadata;
        (*primaries == first.primaries).then(|| transfer.clone().unwrap_or_default())
    };
    FixedCodec::new(&first.transfer.clone().unwrap_or_default(), Rgba::BLACK).is_some()
        && input.takes_integers(transfer)
}

/// Returns the processor seconds of a frame, of whose geometry a part is kept, and the rest computed anew.
fn seconds((files, kept): (CostedFiles, f64), Scene { input, reports, .. }: &Scene, raw: u64) -> f64 {
    let (by_plan, anew) = (files.nanoseconds(), files.nanoseconds().with_geometry());
    let mixed = |of: fn(&Nanoseconds) -> f64| kept * of(&by_plan) + (1.0 - kept) * of(&anew);
    let (pixel, texel) = (mixed(|nanoseconds| nanoseconds.pixel), mixed(|nanoseconds| nanoseconds.texel));
    let filtered = |report: &Report| {
        let shown = (report.size.0 * report.size.1) as f64 * report.shown;
        shown * (pixel + texel * report.gathered.mean)
    };
    let planned = || input.views().map(|view| 3 * area((view.nominal.width(), view.nominal.height())));
    let present: u64 = input.present().map(|(_, header, _)| read_bytes(header)).fold(0, u64::saturating_add);
    let samples = if input.present().next().is_some() { present } else { planned().fold(0, u64::saturating_add) };
    let coded = samples as f64 * by_plan.read + raw as f64 * by_plan.written;
    (reports.iter().map(filtered).sum::<f64>() + coded) / 1e9
}
