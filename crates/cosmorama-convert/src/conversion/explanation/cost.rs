//! Costs of a sequence before it is made: processor time, memory and disk.

use std::collections::HashSet;

use cosmorama::explain::Report;
use cosmorama::filter::FilterKind;
use cosmorama::raster::{Channels, Depth, FixedCodec, FixedDecoder, Rgba};
use cosmorama::render::Arithmetic;
use cosmorama::world::World;
use cosmorama_io::{Format, Header};

use super::Explanation;
use crate::input::{Input, InputView};
use crate::job::{FrameNeeds, Held, are_too_large, compressed, footprint_bytes, is_balanced, is_torn, pixels_in};
use crate::source::memory_budget::{area, read_bytes};
use crate::target::Picture;

/// Kind of files that a sequence is written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostedFiles {
    /// PNG of 8 bits without alpha.
    EightBits,
    /// OpenEXR halves without alpha.
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
    /// Counts the geometry, too, which each frame of a moving camera has anew: figures of tilted domes of 512² to 2048² from panoramas of
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

    /// Bytes of a pixel's samples.
    fn pixel_bytes(self) -> u64 {
        let depth = if self == Self::EightBits { Depth::Eight } else { Depth::Half };
        (Channels::Rgb.count() * depth.bytes()) as u64
    }
}

/// Manner in which pictures are made, and held meanwhile.
#[derive(Clone, Copy)]
struct Making {
    /// Of a picture that is made alone.
    alone: Held,
    /// Of a frame whose geometry is kept.
    planned: Held,
    arithmetic: Arithmetic,
}

/// Parts of a frame, and of what it is made.
struct Frame<'a> {
    /// Views that a picture needs.
    input: Input,
    worlds: &'a [World],
    reports: &'a [Report],
    /// Sizes of its files.
    sizes: Vec<(usize, usize)>,
}

impl Explanation {
    /// Returns the number of frames that are asked for, or else that the input has; `None` where that is one picture.
    pub fn frames(&self) -> Option<usize> {
        let asked = self.asked_frames.as_ref().map(|frames| frames.frames().len());
        asked.or(Some(self.input().frames.len()).filter(|frames| *frames > 1))
    }

    /// Returns the costs of making all pictures, frame by frame, by their reports.
    pub fn costs(&self, worlds: &[World], reports: &[Report]) -> Vec<SequenceCost> {
        let frame = Frame { input: self.needed(reports), worlds, reports, sizes: self.file_sizes() };
        CostedFiles::ALL.into_iter().map(|files| self.pool.install(|| self.cost(files, &frame))).collect()
    }

    fn cost(&self, files: CostedFiles, frame: &Frame) -> SequenceCost {
        let making = self.making(files, frame);
        let threads = self.pool.current_num_threads();
        let alone = self.needs((files, making.alone), frame);
        let one_of_many = |held: Held| self.of_many(self.needs((files, held), frame), &frame.input);
        let planned = one_of_many(making.planned);
        let plans = self.plan_bytes(making.arithmetic, self.memory.left_for_plan(planned, threads), frame.reports);
        let many = if plans == 0 { one_of_many(making.alone) } else { planned };
        let depth = self.memory.queue_depth(many, (usize::MAX, frame.sizes.len()), plans, threads);
        let raw = pixels_in(frame.sizes.iter().copied()).saturating_mul(files.pixel_bytes());
        SequenceCost {
            files,
            cpu_seconds: seconds((files, plans == 0), frame, raw),
            picture: self.memory_of(alone, alone.picture_bytes(threads)),
            sequence: self.memory_of(many, many.sequence_bytes(depth, plans, threads).max(many.picture_bytes(threads))),
            frame_bytes: compressed(raw, files.format(), None),
        }
    }

    /// Returns the needs of one frame of many. A world that a moving camera looks at may be a still one; other files, and those that do not
    /// exist yet, change from frame to frame.
    fn of_many(&self, needs: FrameNeeds, input: &Input) -> FrameNeeds {
        let is_still = self.movement.is_some() && input.present().next().is_some();
        let needs = if is_still { needs } else { needs.of_moving_input(input.views().count()) };
        needs.of_many()
    }

    fn memory_of(&self, needs: FrameNeeds, bytes: u64) -> CostedMemory {
        CostedMemory { bytes, is_allowed: self.memory.allows_frame(needs) }
    }

    /// Returns how the pictures of files are made. Integers take inputs of 8 bits without alpha; planned ones are taken for such.
    fn making(&self, files: CostedFiles, frame: &Frame) -> Making {
        let floats = Held::of_samples(files.pixel_bytes());
        let any = Making { alone: floats, planned: floats, arithmetic: Arithmetic::Float };
        let is_blurred = self.movement.as_ref().is_some_and(|(movement, _)| movement.blur.is_some());
        let is_complete = frame.reports.iter().all(|report| report.uncovered.is_none());
        if files == CostedFiles::Halves || is_blurred || !is_complete || is_balanced(&self.filter) {
            return any;
        }
        if Arithmetic::Fixed.has_plan_of(self.filter.kind) && takes_integers(&frame.input) {
            return Making { alone: Held::INTEGERS, planned: Held::INTEGERS, arithmetic: Arithmetic::Fixed };
        }
        // A plan of floats makes samples of 8 bits without a picture of light, unless it is one of a pyramid.
        let are_integers = frame.input.present().all(|(_, header, _)| !header.depth.is_float());
        if are_integers && self.filter.kind != FilterKind::EwaPyramid {
            Making { planned: Held::CODES, ..any }
        } else {
            any
        }
    }

    /// Returns the needs of a frame whose pictures are held so.
    fn needs(&self, (files, held): (CostedFiles, Held), frame: &Frame) -> FrameNeeds {
        let Frame { input, worlds, reports, sizes } = frame;
        let size = |picture: &Picture| (picture.view.width(), picture.view.height());
        let is_part = |picture: &&Picture| picture.place.is_some_and(|place| !place.is_whole(size(picture)));
        let largest = self.pictures().iter().filter(is_part).map(|picture| area(size(picture))).max().unwrap_or(0);
        let prepared = reports.iter().map(|report| report.memory.levels as u64).max().unwrap_or(0);
        let views = || self.pictures().iter().map(|picture| &picture.view);
        let needs = FrameNeeds::of_pictures(input, worlds, (pixels_in(sizes.iter().copied()), largest), held)
            .beside_tables(views())
            .with_prepared(prepared)
            .with_footprints(footprint_bytes(self.filter.kind, input, views()))
            .with_encoders_of(files.format(), sizes);
        let is_incomplete = reports.iter().any(|report| report.uncovered.is_some());
        let needs = if is_incomplete && is_torn(input, views()) {
            needs.with_masks(self.pictures().iter().map(size))
        } else {
            needs
        };
        if are_too_large(sizes.iter().copied()) { needs.by_strips(files.format(), sizes) } else { needs }
    }

    /// Returns the bytes of the plans that fit into so many: those of whole pictures, or of as many strips as there is room for. A camera
    /// that moves has another geometry in each frame, of which none is kept.
    fn plan_bytes(&self, arithmetic: Arithmetic, room: u64, reports: &[Report]) -> u64 {
        if self.movement.is_some() {
            return 0;
        }
        let is_by_strips = are_too_large(self.file_sizes().into_iter());
        reports.iter().fold(0, |taken, Report { memory, .. }| {
            let plan = if arithmetic == Arithmetic::Fixed { memory.fixed_plan } else { memory.plan } as u64;
            let left = room - taken;
            taken
                + if plan <= left {
                    plan
                } else if is_by_strips {
                    left
                } else {
                    0
                }
        })
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

/// Returns whether all inputs are opaque, of 8 bits, and fit the light of integers, as the outputs do, which are encoded like the first.
fn takes_integers(input: &Input) -> bool {
    let mut transfers = input.present().map(|(_, header, _)| header.metadata.transfer.clone().unwrap_or_default());
    let is_plain = |header: &Header| header.depth == Depth::Eight && !header.channels.has_alpha();
    let first = transfers.next().unwrap_or_default();
    input.present().all(|(_, header, _)| is_plain(header))
        && FixedCodec::new(&first, Rgba::BLACK).is_some()
        && [first].into_iter().chain(transfers).all(|transfer| FixedDecoder::new(&transfer).is_some())
}

/// Returns the processor seconds of a frame, whose geometry is computed anew or kept.
fn seconds((files, is_anew): (CostedFiles, bool), Frame { input, reports, .. }: &Frame, raw: u64) -> f64 {
    let nanoseconds = files.nanoseconds();
    let Nanoseconds { pixel, texel, read, written } = if is_anew { nanoseconds.with_geometry() } else { nanoseconds };
    let filtered = |report: &Report| {
        let shown = (report.size.0 * report.size.1) as f64 * report.shown;
        shown * (pixel + texel * report.gathered.mean)
    };
    let planned = || input.views().map(|view| 3 * area((view.nominal.width(), view.nominal.height())));
    let present: u64 = input.present().map(|(_, header, _)| read_bytes(header)).fold(0, u64::saturating_add);
    let samples = if input.present().next().is_some() { present } else { planned().fold(0, u64::saturating_add) };
    let all = reports.iter().map(filtered).sum::<f64>() + samples as f64 * read + raw as f64 * written;
    all / 1e9
}
