use super::magnification::central_footprint;
use super::survey::{Survey, used_part};
use super::{FaceSize, Magnification};
use crate::camera::View;
use crate::filter::FilterSettings;
use crate::raster::Rgba;
use crate::render::{Accuracy, Arithmetic, Need, Needs, Resampler, Uncovered};
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Figures of a conversion before it runs: coverage, needs, magnification and memory. It prints as readable text.
///
/// Figures that would need every pixel of a large target are counted on a regular subset of at least 130 000 pixels.
/// The needed rectangles are exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Width and height of the target.
    pub size: (usize, usize),
    /// Fraction of the target's pixels that show something, 0 to 1.
    pub shown: f64,
    /// Direction and view at the target's centre.
    pub centre: Option<Centre>,
    /// Each view of the world.
    pub views: Vec<ViewReport>,
    /// Pixels whose directions no view shows.
    pub uncovered: Option<Uncovered>,
    /// Texels per pixel.
    pub gathered: Gathered,
    /// Memory in bytes.
    pub memory: Memory,
}

/// Direction and view of the pixel at a target's centre, which is on the lens's axis if that is visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Centre {
    /// Direction in which the pixel looks.
    pub direction: Direction,
    /// Index of the view that gives the pixel, and the pixel's length there.
    pub view: Option<(usize, Magnification)>,
}

/// Role of one view in a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewReport {
    /// Rectangles of needed texels.
    pub need: Need,
    /// Width and height of the image.
    pub size: (usize, usize),
    /// Fraction of its texels that the target shows, 0 to 1.
    pub used: f64,
    /// Fraction of the target's picture that the view gives, 0 to 1.
    pub share: f64,
    /// Range of the view's texels per target pixel.
    pub magnification: Option<Magnification>,
    /// Image sizes that would suit the target.
    pub advised: Option<FaceSize>,
}

/// Number of texels that are averaged for a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathered {
    /// Mean over the pixels that show something.
    pub mean: f64,
    /// Maximum.
    pub most: usize,
}

/// Memory of a conversion in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Light of all views.
    pub texels: usize,
    /// Pixels of the target.
    pub pixels: usize,
    /// Upper bound of what the filter keeps: a pyramid's levels, or tables of sums; zero for filters that keep nothing.
    pub levels: usize,
    /// Estimate of a sequence's geometry in floats; a single frame keeps none.
    pub plan: usize,
    /// Estimate of a sequence's geometry in integers, for opaque 8-bit pictures; zero where the filter uses floats.
    pub fixed_plan: usize,
}

impl Report {
    /// Computes the report of making `target` from `world`. The world needs no light, and may consist of planned views.
    pub fn of(world: &World, target: &View, filter: &FilterSettings) -> Self {
        let needs = Needs::of(world, std::slice::from_ref(target), filter, Accuracy::Exact);
        let survey = Survey::of(world, target, filter);
        let centre = central_footprint(target);
        let view = |(index, source): (usize, &Source)| {
            let (pixels, magnification) = survey.views[index];
            let need = needs.views[index].clone();
            ViewReport {
                size: (source.view.width(), source.view.height()),
                used: if need.seen.is_some() { used_part(source, target) } else { 0.0 },
                share: pixels as f64 / survey.shown.max(1) as f64,
                magnification,
                advised: centre.as_ref().and_then(|footprint| FaceSize::of(&source.view, footprint)),
                need,
            }
        };
        Self {
            size: (target.width(), target.height()),
            shown: survey.shown as f64 / survey.sampled.max(1) as f64,
            centre: centre.map(|footprint| Centre::of(world, &footprint)),
            views: world.sources().iter().enumerate().map(view).collect(),
            uncovered: needs.uncovered,
            gathered: Gathered { mean: survey.texels as f64 / survey.shown.max(1) as f64, most: survey.most },
            memory: Memory::of(world, target, filter),
        }
    }

    /// Returns the fraction of all texels that the target shows, 0 to 1.
    pub fn used(&self) -> f64 {
        let texels = |view: &ViewReport| (view.size.0 * view.size.1) as f64;
        let given: f64 = self.views.iter().map(texels).sum();
        self.views.iter().map(|view| view.used * texels(view)).sum::<f64>() / given.max(1.0)
    }
}

impl Centre {
    fn of(world: &World, footprint: &crate::camera::Footprint) -> Self {
        let direction = footprint.direction;
        let view = world.owner(direction).and_then(|(index, _)| {
            let (_, jacobian) = world.sources()[index].view.texel_footprint(footprint)?;
            Some((index, Magnification::of(jacobian)))
        });
        Self { direction, view }
    }
}

impl Memory {
    fn of(world: &World, target: &View, filter: &FilterSettings) -> Self {
        let resampler = Resampler { world, target, filter: *filter };
        Self {
            texels: world.texel_count() * size_of::<Rgba>(),
            pixels: target.width() * target.height() * size_of::<Rgba>(),
            levels: resampler.filter_bytes(),
            plan: resampler.plan_bytes_estimate(Arithmetic::Float),
            fixed_plan: resampler.plan_bytes_estimate(Arithmetic::Fixed),
        }
    }
}
