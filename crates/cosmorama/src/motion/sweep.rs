//! Pictures of all moments of an exposure together.

use std::ops::Range;

use super::rings::{Rings, Swept};
use super::strip::Strip;
use super::turning::{Tolerance, Turning};
use super::{Exposure, LightSum};
use crate::camera::View;
use crate::filter::FilterSettings;
use crate::raster::{Image, Rgba};
use crate::render::{Progress, Resampler, Share, Stopped};
use crate::world::World;

/// Least number of moments for which rings cost less than the moments' pictures.
const LEAST: usize = 12;

/// Deviations from a turn about one axis at which rings make the picture that moments make.
const TURN: Tolerance = Tolerance { place: 0.03, size: 0.01 };

/// Greatest uncertainty of a pixel, of white or of its own light where that is brighter.
const CERTAIN: f32 = 1.0 / 500.0;

impl Exposure {
    /// Renders the world through the open shutter: each pixel is the mean of what it sees on its way. What turns about one axis is
    /// made at once, and the rest moment by moment.
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn swept(
        &self,
        (world, filter): (&World, FilterSettings),
        texels: &[Rgba],
        progress: &dyn Progress,
    ) -> Result<Image<Rgba>, Stopped> {
        let views = self.views();
        let mut sum: Option<LightSum> = None;
        for part in parts(views, (world, filter), 0..views.len()) {
            let done = |index: usize| index as f64 / views.len() as f64;
            let share = Share { whole: progress, from: done(part.views.start), to: done(part.views.end) };
            let some = &views[part.views.clone()];
            let weight: f32 = some.iter().map(|(_, weight)| weight).sum();
            let image = match &part.rings {
                Some(rings) => by_rings(rings, some, (world, filter), texels, &share)?,
                None => by_moments(some, (world, filter), texels, &share)?,
            };
            match &mut sum {
                Some(sum) => sum.add(&image, weight),
                None => sum = Some(LightSum::new(image, weight)),
            }
        }
        Ok(sum.map_or_else(|| Image::filled(0, 0, Rgba::TRANSPARENT), LightSum::into_image))
    }
}

/// Views that follow one another, with their rings if they turn about one axis.
struct Part<'a> {
    views: Range<usize>,
    rings: Option<Rings<'a>>,
}

/// Divides an exposure into parts that turn about one axis each, as far as that pays.
fn parts<'a>(views: &'a [(View, f32)], resampler: (&'a World, FilterSettings), range: Range<usize>) -> Vec<Part<'a>> {
    if range.len() < LEAST {
        return vec![Part { views: range, rings: None }];
    }
    let some = &views[range.clone()];
    let rings = Turning::of(some, TURN).and_then(|turning| {
        let weights = some.iter().map(|(_, weight)| f64::from(*weight));
        let profile: Vec<(f64, f64)> = turning.angles.iter().copied().zip(weights).collect();
        Rings::new(some, &turning, &profile, resampler)
    });
    if rings.is_some() {
        return vec![Part { views: range, rings }];
    }
    let middle = range.start + range.len() / 2;
    let mut halves = parts(views, resampler, range.start..middle);
    halves.extend(parts(views, resampler, middle..range.end));
    if halves.iter().any(|part| part.rings.is_some()) { halves } else { vec![Part { views: range, rings: None }] }
}

/// Averages the pictures of some moments.
fn by_moments(
    views: &[(View, f32)],
    (world, filter): (&World, FilterSettings),
    texels: &[Rgba],
    progress: &dyn Progress,
) -> Result<Image<Rgba>, Stopped> {
    let total: f32 = views.iter().map(|(_, weight)| weight).sum();
    let mut sum: Option<LightSum> = None;
    for (index, (view, weight)) in views.iter().enumerate() {
        let done = |index: usize| index as f64 / views.len() as f64;
        let share = Share { whole: progress, from: done(index), to: done(index + 1) };
        let image = Resampler::new(world, view).by(filter).watched(&share).render(texels)?;
        match &mut sum {
            Some(sum) => sum.add(&image, weight / total),
            None => sum = Some(LightSum::new(image, weight / total)),
        }
    }
    Ok(sum.map_or_else(|| Image::filled(0, 0, Rgba::TRANSPARENT), LightSum::into_image))
}

/// Renders some views by their rings, and by moments where rings are not certain enough.
fn by_rings(
    rings: &Rings,
    views: &[(View, f32)],
    resampler: (&World, FilterSettings),
    texels: &[Rgba],
    progress: &dyn Progress,
) -> Result<Image<Rgba>, Stopped> {
    let beginning = Share { whole: progress, from: 0.0, to: 0.5 };
    let Swept { mut image, is_left } = rings.render(texels, CERTAIN, &beginning)?;
    let strips = Strip::all(&is_left, [image.width(), image.height()]);
    for (index, strip) in strips.iter().enumerate() {
        let done = |index: usize| 0.5 + 0.5 * index as f64 / strips.len() as f64;
        let share = Share { whole: progress, from: done(index), to: done(index + 1) };
        strip.fill(&mut image, views, resampler, texels, &share)?;
    }
    Ok(image)
}
