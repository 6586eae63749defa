use super::magnification::central_footprint;
use super::survey::{Survey, used_part};
use super::{FaceSize, Magnification};
use crate::camera::View;
use crate::filter::FilterSettings;
use crate::raster::Rgba;
use crate::render::{Accuracy, Arithmetic, Need, Needs, Resampler, Uncovered};
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Figures of a conversion before it runs: coverage, needs, magnification and memory. Its text form is for people.
///
/// What needs a look at every pixel of a large target is counted on a regular part of them, at least 130 000; the needed
/// rectangles are exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Width and height of the target.
    pub size: (usize, usize),
    /// The part of the target's pixels that show something, 0 to 1.
    pub shown: f64,
    /// What the target's centre sees.
    pub centre: Option<Centre>,
    /// Each view of the world.
    pub views: Vec<ViewReport>,
    /// Pixels that no view covers.
    pub uncovered: Option<Uncovered>,
    /// Texels that go into a pixel.
    pub gathered: Gathered,
    /// Bytes.
    pub memory: Memory,
}

/// What the pixel at a target's centre (on the axis of its lens, if it shows that) sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Centre {
    /// Where it looks.
    pub direction: Direction,
    /// The view that gives it, by index, and how long the pixel is there.
    pub view: Option<(usize, Magnification)>,
}

/// Part of one view in a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewReport {
    /// The rectangles of texels that are needed.
    pub need: Need,
    /// Width and height of the image.
    pub size: (usize, usize),
    /// The part of its texels that the target shows, 0 to 1.
    pub used: f64,
    /// The part of the target's picture that it gives, 0 to 1.
    pub share: f64,
    /// Range of its texels along a target's pixel.
    pub magnification: Option<Magnification>,
    /// Image sizes that would suit the target.
    pub advised: Option<FaceSize>,
}

/// How many texels go into a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathered {
    /// On average over the pixels that show something.
    pub mean: f64,
    /// At most.
    pub most: usize,
}

/// What a conversion holds in memory, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The light of all views.
    pub texels: usize,
    /// The target's pixels.
    pub pixels: usize,
    /// The smaller copies of a pyramid, at most; zero for other filters.
    pub levels: usize,
    /// The geometry of a sequence in floats, estimated; a single frame keeps none.
    pub plan: usize,
    /// Bytes of a sequence's geometry in integers, estimated, for opaque pictures of 8 bits. Zero where the filter uses floats.
    pub fixed_plan: usize,
}

impl Report {
    /// Computes the report of making `target` from `world`. The world needs no light: it may be of planned views.
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

    /// Texels that the target shows, of all texels given, 0 to 1.
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
            levels: resampler.level_bytes(),
            plan: resampler.plan_bytes_estimate(Arithmetic::Float),
            fixed_plan: resampler.plan_bytes_estimate(Arithmetic::Fixed),
        }
    }
}
