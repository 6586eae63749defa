//! Costs of a sequence before it is made: processor time, memory and disk.

use std::collections::HashSet;

use cosmorama::explain;
use cosmorama::raster::{Channels, Depth};
use cosmorama::world::World;
use cosmorama_io::Format;

use super::Explanation;
use crate::input::{Input, InputView};
use crate::job::{FrameNeeds, Held, are_too_large, compressed, footprint_bytes, program_bytes, with_reserve};
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
    pub picture_bytes: u64,
    /// Memory of a run that makes many frames, with as many threads as there are now.
    pub job_bytes: u64,
    /// Disk for a frame.
    pub frame_bytes: u64,
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

    /// Returns how pictures are held. Integers take inputs of 8 bits without alpha; planned ones are taken for such.
    fn held(self, input: &Input) -> Held {
        let mut headers = input.present().map(|(_, header, _)| header);
        let is_plain = headers.all(|header| header.depth == Depth::Eight && !header.channels.has_alpha());
        if self == Self::EightBits && is_plain { Held::INTEGERS } else { Held::of_samples(self.pixel_bytes()) }
    }
}

impl Explanation {
    /// Returns the costs of making all pictures, frame by frame, by their reports.
    pub fn costs(&self, worlds: &[World], reports: &[explain::Report]) -> Vec<SequenceCost> {
        let input = self.needed(reports);
        CostedFiles::ALL.into_iter().map(|files| self.cost(files, &input, worlds, reports)).collect()
    }

    fn cost(&self, files: CostedFiles, input: &Input, worlds: &[World], reports: &[explain::Report]) -> SequenceCost {
        let held = files.held(input);
        let size = |picture: &Picture| (picture.view.width(), picture.view.height());
        let sizes = self.file_sizes();
        let pixels = sizes.iter().copied().map(area).fold(0, u64::saturating_add);
        let is_part = |picture: &&Picture| picture.place.is_some_and(|place| !place.is_whole(size(picture)));
        let largest = self.pictures().iter().filter(is_part).map(|picture| area(size(picture))).max().unwrap_or(0);
        let prepared = reports.iter().map(|report| report.memory.levels as u64).max().unwrap_or(0);
        let needs = FrameNeeds::of_pictures(input, worlds, (pixels, largest), held).with_prepared(prepared);
        let views = self.pictures().iter().map(|picture| &picture.view);
        let needs = needs.with_footprints(self.pool.install(|| footprint_bytes(self.filter.kind, input, views)));
        let needs = self.pool.install(|| needs.with_encoders_of(files.format(), &sizes));
        let needs = if are_too_large(sizes.iter().copied()) { needs.by_strips(files.format(), &sizes) } else { needs };
        let plan = |report: &explain::Report| {
            if held == Held::INTEGERS { report.memory.fixed_plan } else { report.memory.plan }
        };
        // A camera that moves has another geometry in each frame, of which none is kept.
        let is_moving = self.movement.is_some();
        let plans = if is_moving { 0 } else { reports.iter().map(|report| plan(report) as u64).sum() };
        let threads = self.pool.current_num_threads();
        let depth = self.memory.queue_depth(needs, (usize::MAX, self.pictures().len()), plans, threads);
        let of_job = [needs.shared, plans, depth.bytes].into_iter().fold(0, u64::saturating_add);
        let with_program = |bytes: u64| program_bytes(threads, needs.made()).saturating_add(with_reserve(bytes));
        let raw = pixels.saturating_mul(files.pixel_bytes());
        SequenceCost {
            files,
            cpu_seconds: seconds((files, is_moving), input, raw, reports),
            picture_bytes: with_program(needs.peak()),
            job_bytes: with_program(of_job),
            frame_bytes: compressed(raw, files.format(), None),
        }
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
    fn needed(&self, reports: &[explain::Report]) -> Input {
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

/// Returns the processor seconds of a frame, whose geometry is kept unless the camera moves.
fn seconds((files, is_moving): (CostedFiles, bool), input: &Input, raw: u64, reports: &[explain::Report]) -> f64 {
    let nanoseconds = files.nanoseconds();
    let Nanoseconds { pixel, texel, read, written } = if is_moving { nanoseconds.with_geometry() } else { nanoseconds };
    let filtered = |report: &explain::Report| {
        let shown = (report.size.0 * report.size.1) as f64 * report.shown;
        shown * (pixel + texel * report.gathered.mean)
    };
    let planned = || input.views().map(|view| 3 * area((view.nominal.width(), view.nominal.height())));
    let present: u64 = input.present().map(|(_, header, _)| read_bytes(header)).fold(0, u64::saturating_add);
    let samples = if input.present().next().is_some() { present } else { planned().fold(0, u64::saturating_add) };
    let all = reports.iter().map(filtered).sum::<f64>() + samples as f64 * read + raw as f64 * written;
    all / 1e9
}
