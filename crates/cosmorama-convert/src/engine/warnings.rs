//! Warnings about light: bright sources that filters do not keep, alpha that is nowhere full, samples that are no
//! light, and a lens's circle that is not where it is assumed.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};

use cosmorama::filter::FilterKind;
use cosmorama::sphere::Direction;
use cosmorama_spec::Spec;

use crate::colour::{StraightAlpha, ThinAlpha};
use crate::detect::disc;
use crate::diagnostic::{Code, Diagnostic, FILTER, KERNEL, Remedy, Setting};
use crate::engine::{Counts, FrameLight};
use crate::job::ConvertJob;

/// Fraction of a world's light in bright sources above which a change of it shows in lighting.
const MUCH: f64 = 0.1;

/// Number of directions that are tested to see whether outputs show the whole world.
const DIRECTIONS: usize = 500;

/// Counts of pixels that are reported once, after the last frame, since a sequence may have them in every frame.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    /// Files that have been counted. Some serve all frames.
    counted: BTreeSet<PathBuf>,
    clipped: Told,
    infinite: Told,
    alpha: Told,
    cut: Told,
}

/// Pixels of one kind, and the files that hold some.
#[derive(Debug, Default)]
struct Told {
    pixels: usize,
    /// Pixels of these files, of all kinds.
    of: usize,
    files: Vec<PathBuf>,
}

impl Told {
    fn add(&mut self, pixels: usize, of: usize, path: &Path) {
        if pixels > 0 {
            self.pixels += pixels;
            self.of += of;
            self.files.push(path.to_owned());
        }
    }

    /// Returns a warning that begins with the files; none where there are no pixels to tell of.
    fn warning(&self, code: Code, what: impl FnOnce(&Self) -> String) -> Option<Diagnostic> {
        let first = self.files.first()?.display();
        let others = match self.files.len() - 1 {
            0 => String::new(),
            1 => " and another file".to_owned(),
            others => format!(" and {others} other files"),
        };
        Some(Diagnostic::warning(code, format!("{first}{others}: {}", what(self))).about(first))
    }
}

impl Tally {
    /// Adds the pixels of a frame.
    pub(crate) fn add(&mut self, job: &ConvertJob, frame: Option<u64>, light: &FrameLight) {
        let mut frames_files = BTreeSet::new();
        for ((view, header, _), Counts { irregular, outside, cut }) in job.input.present().zip(light.counts()) {
            let path = view.files.path(frame);
            if self.counted.contains(&path) {
                continue;
            }
            let of = header.width.saturating_mul(header.height);
            self.clipped.add(if job.light.clips { *outside } else { 0 }, of, &path);
            self.infinite.add(irregular.infinite, of, &path);
            self.alpha.add(irregular.alpha, of, &path);
            self.cut.add(*cut, of, &path);
            frames_files.insert(path);
        }
        self.counted.append(&mut frames_files);
    }

    /// Returns the warnings about all frames.
    pub(crate) fn warnings(&self, job: &ConvertJob) -> Vec<Diagnostic> {
        let clipped = |told: &Told| {
            format!(
                "{:.2} % of {} pixels lie outside of the output's primaries, {}: they are clipped to what those can show",
                100.0 * told.pixels as f64 / told.of.max(1) as f64,
                if told.files.len() == 1 { "its" } else { "their" },
                job.light.working.primaries
            )
        };
        let infinite = |told: &Told| match told.pixels {
            1 => "1 pixel is infinite and counts as 65504, the largest half float".to_owned(),
            pixels => format!("{pixels} pixels are infinite and count as 65504, the largest half float"),
        };
        let alpha = |told: &Told| match told.pixels {
            1 => "the alpha of 1 pixel is below 0 or above 1, and counts as 0 or 1".to_owned(),
            pixels => format!("the alpha of {pixels} pixels is below 0 or above 1, and counts as 0 or 1"),
        };
        let cut = |told: &Told| {
            let pixels = if told.pixels == 1 { "1 pixel" } else { &format!("{} pixels", told.pixels) };
            format!(
                "colour exceeds alpha in {pixels}, and is cut to white there: integers of premultiplied colour cannot be read \
                 brighter. Write such light as floats"
            )
        };
        let told = [
            self.clipped.warning(Code::OutOfGamut, clipped),
            self.infinite.warning(Code::TooBright, infinite),
            self.alpha.warning(Code::AlphaRange, alpha),
            self.cut.warning(Code::AlphaStraight, cut),
        ];
        told.into_iter().flatten().collect()
    }
}

/// Warns where a whole world is made from light with bright sources, which few filters keep.
pub(crate) fn suns(job: &ConvertJob, light: &FrameLight) -> Option<Diagnostic> {
    if job.lighting.is_some() || job.is_balance_asked_for() || !is_of_any_range(job) || !shows_the_world(job) {
        return None;
    }
    let parts = job.worlds.iter().enumerate();
    let part = parts.map(|(index, world)| world.light_of_suns(|texel| light.texels().rgba(index, texel)));
    let part = part.fold(0.0, f64::max);
    (part > MUCH).then(|| {
        // The default filter needs no naming.
        let filter = if job.filter.kind == FilterKind::Ewa { String::new() } else { format!("{FILTER} ewa ") };
        let message = format!(
            "{:.0} % of the light comes from suns or lamps, over a hundred times as bright as the mean; this filter \
             may add light to them or take some away. Where the picture is to light a scene, {filter}{KERNEL} light \
             keeps what there is, and is a little softer",
            100.0 * part
        );
        Diagnostic::warning(Code::Suns, message).with_remedy(Remedy::Set(Setting::Kernel, "light".to_owned()))
    })
}

/// Returns whether some input holds light beyond white. Numbers in one channel are no light but depth, or a mask.
pub(crate) fn is_of_any_range(job: &ConvertJob) -> bool {
    let mut headers = job.layers().flat_map(|job| job.input.present()).map(|(_, header, _)| header);
    headers.any(|header| header.depth.is_float() && header.channels.is_colour())
}

/// Returns whether the outputs show all directions, or nearly all.
fn shows_the_world(job: &ConvertJob) -> bool {
    let sees = |direction: &Direction| job.target.views.iter().any(|target| target.view.sees(*direction));
    let seen = Direction::spread(DIRECTIONS).filter(sees).count();
    100 * seen >= 99 * DIRECTIONS
}

/// Warns about files of a frame in which no pixel has full alpha, or alpha seems to be straight.
pub(crate) fn alpha(job: &ConvertJob, frame: Option<u64>, light: &FrameLight) -> Vec<Diagnostic> {
    if !job.light.input_alpha {
        return Vec::new();
    }
    // A file may hold several views.
    let mut files: BTreeMap<PathBuf, Vec<(usize, Range<usize>)>> = BTreeMap::new();
    let worlds = job.worlds.iter().enumerate();
    let sources = worlds.flat_map(|(index, world)| world.sources().iter().map(move |source| (index, source)));
    for ((view, header, _), (world, source)) in job.input.present().zip(sources) {
        if header.channels.has_alpha() {
            let texels = source.offset..source.offset + source.texels().len();
            files.entry(view.files.path(frame)).or_default().push((world, texels));
        }
    }
    let told = files.iter().flat_map(|(path, views)| {
        let texels = views.iter().flat_map(|(world, texels)| texels.clone().map(|texel| (*world, texel)));
        let pixels = texels.map(|(world, texel)| light.texels().rgba(world, texel));
        let thin = ThinAlpha::of(pixels.clone()).and_then(ThinAlpha::told).map(|told| (Code::AlphaThin, told));
        let straight = StraightAlpha::of(pixels).told().map(|told| (Code::AlphaStraight, told));
        let warning = |(code, told)| {
            let path = path.display();
            Diagnostic::warning(code, format!("{path}: {told}")).about(path)
        };
        [thin, straight].into_iter().flatten().map(warning).collect::<Vec<_>>()
    });
    told.collect()
}

/// Warns if a lens has left its circle elsewhere than a `--from` that does not place it assumes.
pub(crate) fn circle(job: &ConvertJob, from: &Spec, light: &FrameLight) -> Option<Diagnostic> {
    let (view, _, held) = job.input.present().next().filter(|(_, header, _)| header.window.is_none())?;
    let (width, height) = (held.width(), held.height());
    disc::elsewhere(from, (&view.name, (width, height)), |i, j| light.texels().rgba(0, j * width + i))
}
