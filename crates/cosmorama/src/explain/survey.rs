use rayon::prelude::*;

use super::Magnification;
use crate::camera::{PixelPoint, ScreenPixel, View};
use crate::filter::{FilterSettings, KernelTable};
use crate::render::{Pyramid, Resampler, TexelCount};
use crate::world::{Source, World};

/// Greatest number of pixels, or of texels of a view, that a survey visits. If there are more, it visits every second,
/// third and so on.
const SAMPLES: usize = 1 << 17;

/// Statistics over a target's pixels.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    /// Number of visited pixels, and of those that show something.
    pub(crate) sampled: usize,
    pub(crate) shown: usize,
    /// Texels gathered by all visited pixels, and the most by one.
    pub(crate) texels: usize,
    pub(crate) most: usize,
    /// For each view, the number of pixels that look into it, and their length in texels.
    pub(crate) views: Vec<(usize, Option<Magnification>)>,
}

impl Survey {
    pub(crate) fn of(world: &World, target: &View, filter: &FilterSettings) -> Self {
        let step = stride(target.width(), target.height());
        let rows: Vec<usize> = sampled(target.height(), step).collect();
        let few = rows.len().div_ceil(8 * rayon::current_num_threads()).max(1);
        let table = KernelTable::new(&filter.kernel);
        let resampler = Resampler { world, target, filter: *filter };
        let pyramid = Pyramid::new(&resampler);
        let count = || TexelCount::new(&pyramid, &table);
        let bands: Vec<Self> = rows.par_chunks(few).map(|rows| Self::of_rows(world, target, count(), rows)).collect();
        bands.into_iter().fold(Self::empty(world), Self::merged)
    }

    fn empty(world: &World) -> Self {
        Self { sampled: 0, shown: 0, texels: 0, most: 0, views: vec![(0, None); world.sources().len()] }
    }

    fn of_rows(world: &World, target: &View, mut texels: TexelCount, rows: &[usize]) -> Self {
        let mut survey = Self::empty(world);
        let step = stride(target.width(), target.height());
        for &j in rows {
            for i in sampled(target.width(), step) {
                survey.sampled += 1;
                let Some(screen) = target.screen_pixel(i, j) else { continue };
                let count = texels.of((i, j), &screen);
                survey.shown += 1;
                survey.texels += count;
                survey.most = survey.most.max(count);
                survey.add_magnification(world, &screen);
            }
        }
        survey
    }

    fn add_magnification(&mut self, world: &World, screen: &ScreenPixel) {
        let Some((index, _)) = world.owner(screen.footprint.direction) else { return };
        let (pixels, range) = &mut self.views[index];
        *pixels += 1;
        if let Some((_, jacobian)) = world.sources()[index].view.texel_footprint(&screen.footprint) {
            *range = range.iter().copied().chain([Magnification::of(jacobian)]).reduce(Magnification::union);
        }
    }

    fn merged(mut self, other: Self) -> Self {
        self.sampled += other.sampled;
        self.shown += other.shown;
        self.texels += other.texels;
        self.most = self.most.max(other.most);
        for ((pixels, range), (more, others)) in self.views.iter_mut().zip(other.views) {
            *pixels += more;
            *range = range.iter().copied().chain(others).reduce(Magnification::union);
        }
        self
    }
}

/// Returns the fraction of a view's texels whose centres a target shows.
pub(crate) fn used_part(source: &Source, target: &View) -> f64 {
    let view = &source.view;
    let step = stride(view.width(), view.height());
    let rows: Vec<usize> = sampled(view.height(), step).collect();
    let (given, used) = rows
        .par_iter()
        .map(|&j| {
            let centres = sampled(view.width(), step).map(|i| PixelPoint::centre(i, j));
            centres.filter(|&centre| view.shows(centre)).fold((0, 0), |(given, used), centre| {
                let is_used = view.direction(centre).is_some_and(|direction| target.sees(direction));
                (given + 1, used + usize::from(is_used))
            })
        })
        .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    used as f64 / given.max(1) as f64
}

fn stride(width: usize, height: usize) -> usize {
    ((width * height) as f64 / SAMPLES as f64).sqrt().ceil().max(1.0) as usize
}

/// Visits every `step`th index and the last one, because extremes lie at borders.
fn sampled(size: usize, step: usize) -> impl Iterator<Item = usize> + Clone {
    (0..size).filter(move |index| index % step == 0 || index + 1 == size)
}
