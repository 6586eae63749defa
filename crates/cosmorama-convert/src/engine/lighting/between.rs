//! Maps of frames between two that are computed.

use cosmorama::lighting::MapDifference;
use cosmorama::raster::{Image, Rgba};

use crate::engine::Levels;
use crate::job::FrameOutputs;
use crate::settings::Every;

/// Difference of a map between two computed ones from what it would be if it were computed, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterpolationReport {
    /// Frame; `None` for a still.
    pub frame: Option<u64>,
    /// Difference from the computed map.
    pub difference: MapDifference,
}

/// Frames of a sequence of which some are computed, and others interpolated.
pub(crate) struct Between<'a> {
    frames: &'a [FrameOutputs],
    every: Every,
    /// Computed frame before those that are to come.
    before: Option<Computed>,
    /// Frame that was computed to be compared.
    middle: Option<Computed>,
    reports: Vec<InterpolationReport>,
}

/// Maps of a computed frame.
struct Computed {
    place: usize,
    maps: Vec<Vec<Image<Rgba>>>,
}

impl<'a> Between<'a> {
    /// Plans the frames; without a rule, all are computed.
    pub(crate) fn new(frames: &'a [FrameOutputs], every: Option<Every>) -> Self {
        let every = every.unwrap_or(Every { frames: 1, measured: false });
        Self { frames, every, before: None, middle: None, reports: Vec::new() }
    }

    /// Lists the places of frames that are computed, from 1, in order.
    pub(crate) fn computed(&self) -> Vec<usize> {
        let last = self.frames.len();
        let is_computed =
            |place: &usize| self.is_key(*place) || (self.every.measured && *place == self.middle_after(*place));
        (1..=last).filter(is_computed).collect()
    }

    /// Returns whether a frame is written as it is computed: each Nth, and the last.
    pub(crate) fn is_key(&self, place: usize) -> bool {
        (place - 1).is_multiple_of(self.every.frames) || place == self.frames.len()
    }

    /// Returns the middle of the frames between the keys around a place.
    fn middle_after(&self, place: usize) -> usize {
        let before = place - (place - 1) % self.every.frames;
        let after = (before + self.every.frames).min(self.frames.len());
        before + (after - before) / 2
    }

    /// Keeps a frame that is compared with the interpolated one.
    pub(crate) fn compare(&mut self, place: usize, pictures: &[Levels]) {
        self.middle = Some(Computed::of(place, pictures));
    }

    /// Takes a key, and returns the frames between the one before and this one, with their places.
    pub(crate) fn up_to(&mut self, place: usize, pictures: &[Levels]) -> Vec<(usize, Vec<Levels>)> {
        if self.every.frames == 1 {
            return Vec::new();
        }
        let key = Computed::of(place, pictures);
        let mut made = Vec::new();
        if let Some(before) = &self.before {
            for between in before.place + 1..place {
                let maps = before.mixed(&key, self.part((before.place, between, place)));
                if let Some(middle) = self.middle.take_if(|middle| middle.place == between) {
                    self.reports.push(middle.compared(&maps, self.frames[between - 1].frame));
                }
                made.push((between, maps.into_iter().map(Levels::Light).collect()));
            }
        }
        self.before = Some(key);
        made
    }

    /// Returns how far a frame lies between two others, by their numbers.
    fn part(&self, (before, between, after): (usize, usize, usize)) -> f32 {
        let number = |place: usize| self.frames[place - 1].frame.unwrap_or(place as u64) as f32;
        (number(between) - number(before)) / (number(after) - number(before))
    }

    /// Returns the differences of frames that were computed to be compared.
    pub(crate) fn reports(self) -> Vec<InterpolationReport> {
        self.reports
    }
}

impl Computed {
    fn of(place: usize, pictures: &[Levels]) -> Self {
        let maps =
            pictures.iter().map(|levels| if let Levels::Light(maps) = levels { maps.clone() } else { Vec::new() });
        Self { place, maps: maps.collect() }
    }

    /// Mixes the maps of two frames.
    fn mixed(&self, other: &Self, part: f32) -> Vec<Vec<Image<Rgba>>> {
        let image = |(a, b): (&Image<Rgba>, &Image<Rgba>)| {
            Image::from_fn(a.width(), a.height(), |i, j| *a.get(i, j) * (1.0 - part) + *b.get(i, j) * part)
        };
        let levels = |(a, b): (&Vec<Image<Rgba>>, &Vec<Image<Rgba>>)| a.iter().zip(b).map(image).collect();
        self.maps.iter().zip(&other.maps).map(levels).collect()
    }

    /// Compares interpolated maps with these.
    fn compared(&self, maps: &[Vec<Image<Rgba>>], frame: Option<u64>) -> InterpolationReport {
        let pairs = self.maps.iter().flatten().zip(maps.iter().flatten());
        InterpolationReport { frame, difference: MapDifference::of(pairs) }
    }
}
