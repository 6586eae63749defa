//! What a conversion needs, held against the budget of memory.

use cosmorama_io::Header;

use super::{
    FrameNeeds, Held, Strips, are_too_large, is_large, map_bytes, pixels_in, pixels_of, program_bytes,
    solid_angle_bytes, sum, with_reserve, without_reserve,
};
use crate::colour::{LayerPlan, Light};
use crate::diagnostic::{CHANNELS, EVERY, Result, SHUTTER};
use crate::input::Input;
use crate::job::QueueDepth;
use crate::source::MemoryBudget;
use crate::source::memory_budget::{SMALL, area, human, read_bytes};
use crate::target::{Sheet, Target};

impl MemoryBudget {
    /// Checks that the geometry of whole pictures, and the light of the largest file, fit before memory is allocated. A
    /// small file may declare a huge size, or be a window of a huge canvas.
    pub(crate) fn check_pictures(self, input: &Input) -> Result<()> {
        let tables = input.views().map(|view| map_bytes(&view.nominal)).fold(0, u64::saturating_add);
        // At least, since pictures of 8 bits may be held in integers.
        let light =
            |header: &Header| Held::INTEGERS.light((header.width, header.height)).saturating_add(read_bytes(header));
        let light = input.present().map(|(_, header, _)| light(header)).max().unwrap_or(0);
        let needed = sum([solid_angle_bytes(input, &[]), tables, light]);
        let largest = input.views().max_by_key(|view| pixels_of(&view.nominal)).map_or_else(String::new, |view| {
            let (width, height) = (view.nominal.width(), view.nominal.height());
            format!("; the largest whole picture, {}, has {width}x{height} pixels", view.name)
        });
        self.allow(needed, "the input alone", &largest)
    }

    /// Checks that the outputs of a frame fit, before anything is made.
    pub(crate) fn check_outputs(self, target: &Target, light: &Light) -> Result<()> {
        let sizes = target.files.iter().flat_map(|file| file.levels()).map(|sheet| sheet.size);
        let pixels =
            if is_large(target) && target.format.takes_rows() { Strips::of(sizes).first } else { pixels_in(sizes) };
        // Each exists as a picture, in one form or the other, or as samples.
        let least = light.file_bytes((1, 1)).min(Held::INTEGERS.pixel);
        self.allow(
            pixels.saturating_mul(least),
            "the output alone",
            &largest_has(target.files.iter().map(|file| file.sheet.size).max_by_key(|size| area(*size))),
        )
    }

    /// Checks that pictures of these sizes would fit in a frame, although they are only described.
    pub(crate) fn check_sizes(self, sizes: impl IntoIterator<Item = (usize, usize)>) -> Result<()> {
        let sizes: Vec<(usize, usize)> = sizes.into_iter().collect();
        let largest = sizes.iter().max_by_key(|size| area(**size));
        let why = largest_has(largest.copied());
        let sizes = sizes.into_iter();
        // They may be made by strips.
        let pixels = if are_too_large(sizes.clone()) { Strips::of(sizes).first } else { pixels_in(sizes) };
        self.allow(pixels.saturating_mul(Held::INTEGERS.pixel), "the output alone", &why)
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
        self.allow(self.with_program(needs), "a frame", &(largest + &describe(target, link)))
    }

    /// Returns whether a frame fits.
    pub(crate) fn allows_frame(self, needs: FrameNeeds) -> bool {
        self.with_program(needs) <= self.bytes
    }

    /// Returns the bytes of a frame and of the program, unless both are few and no film is among them. Of addresses there is no room
    /// beside: a third of the program has its own already.
    fn with_program(self, needs: FrameNeeds) -> u64 {
        let program = program_bytes(rayon::current_num_threads(), needs.made());
        let all = with_reserve(needs.peak()).saturating_add(program);
        match self.is_of_addresses {
            _ if all >= SMALL || self.codecs > 0 => all,
            true => all - program / 3,
            false => needs.peak(),
        }
    }

    /// Checks that things under a world fit, which need so many bytes beside the program. Returns the bytes of all.
    ///
    /// # Errors
    /// When they do not.
    pub fn check_things(self, bytes: u64, threads: usize) -> Result<u64> {
        let all = bytes.saturating_add(program_bytes(threads, bytes));
        self.allow(if all < SMALL { bytes } else { all }, "the picture", "; its world and its size decide")?;
        Ok(all)
    }

    /// Returns the budget that is left beside a frame.
    pub(crate) fn beside_frame(self, needs: FrameNeeds) -> Self {
        self.beside(needs.peak())
    }

    /// Checks that a frame fits together with what a filter or light prepares of the input, which frames do one after the other.
    pub(crate) fn check_prepared(self, needs: FrameNeeds) -> Result<()> {
        let why = format!("; what is prepared of the input is {} of it", human(needs.prepared));
        self.allow(self.with_program(needs), "a frame", &why)
    }

    /// Checks that a frame fits together with the sum of the pictures under a shutter, of so many bytes.
    pub(crate) fn check_sum(self, needs: FrameNeeds, sum: u64) -> Result<()> {
        let why = format!("; the sum of its moments, for {SHUTTER}, is {} of it", human(sum));
        self.allow(self.with_program(needs), "a frame", &why)
    }

    /// Checks that a frame fits together with copies of the maps, between which others are interpolated.
    pub(crate) fn check_maps(self, needs: FrameNeeds, maps: u64) -> Result<()> {
        let why = format!("; the maps between two that are computed, for {EVERY}, are {} of it", human(maps));
        self.allow(self.with_program(needs), "a frame", &why)
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

    /// Returns the memory left for pictures beside the program itself. A single frame may use less than is counted here, so it is
    /// not limited by it.
    fn beside_program(self, threads: usize) -> u64 {
        without_reserve(self.bytes.saturating_sub(program_bytes(threads, self.bytes)))
    }

    /// Returns how many of all frames, of so many files each, may be in flight around the one that is filtered, beside the geometry that
    /// they share. Each frame's files keep a thread busy, so more frames than threads are of no use.
    pub(crate) fn queue_depth(
        self,
        needs: FrameNeeds,
        (frames, files): (usize, usize),
        plans: u64,
        threads: usize,
    ) -> QueueDepth {
        let wanted = |files: usize| (1 + threads.div_ceil(files.max(1))).min(frames);
        let room = self.beside_program(threads).saturating_sub(plans).saturating_sub(needs.shared);
        // By strips, pictures are encoded as they are made.
        let written = if needs.is_by_strips { 1 } else { wanted(files) };
        QueueDepth::fitting(room, needs.in_sequence(), (wanted(needs.samples.files), written))
    }
}

/// Says how large the largest picture is.
fn largest_has(size: Option<(usize, usize)>) -> String {
    size.map_or_else(String::new, |(width, height)| format!("; its largest picture has {width}x{height} pixels"))
}

fn describe(target: &Target, link: &str) -> String {
    let size = |Sheet { size: (width, height), .. }: &Sheet| format!("{link}the output {width}x{height}");
    target.files.first().map_or_else(String::new, |file| size(&file.sheet))
}

/// Part of the memory, at most, into which further channels are read at once, beside the largest group of them.
const READ_PART: u64 = 4;
