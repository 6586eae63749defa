use std::f64::consts::FRAC_PI_2;

use crate::camera::{FieldStop, Footprint, PixelBounds, PixelPoint, PixelRect, View};
use crate::filter::Kernel;
use crate::sphere::{Angle, Direction};
use crate::world::{Source, World};

/// Factor by which points of a block may lie farther from its centre than its corners do, because mappings bend.
const BEND: f64 = 1.25;

/// Radius in radians from which on a block of pixels has no cap.
const WIDEST: f64 = 0.5;

/// Cap of the sphere that holds all directions seen by a block of pixels: those within `radius` radians of `centre`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cap {
    centre: Direction,
    radius: f64,
    /// Size of the block's largest pixel: the root of its summed squared derivatives, in radians.
    pixel: f64,
}

impl Cap {
    /// Returns the cap around `centre` that holds the block with these corners; `None` if it would be wider than
    /// [`WIDEST`].
    pub(crate) fn around(centre: Direction, corners: &[Footprint]) -> Option<Self> {
        let (mut radius, mut pixel) = (0f64, 0f64);
        for corner in corners {
            radius = radius.max(BEND * centre.angle_to(corner.direction).radians());
            let (dx, dy) = (corner.jacobian.dx, corner.jacobian.dy);
            pixel = pixel.max(BEND * (dx.length_squared() + dy.length_squared()).sqrt());
        }
        (radius < WIDEST).then_some(Self { centre, radius, pixel })
    }

    /// Returns the cap, widened by this number of radians on all sides.
    pub(crate) fn widened(self, by: f64) -> Self {
        Self { radius: self.radius + by, ..self }
    }

    /// Returns the cap that holds the whole pixels whose centres this cap holds.
    pub(crate) fn of_whole_pixels(self) -> Self {
        self.widened(self.pixel)
    }

    /// Returns whether all of the cap is below a great circle of the view, whose pole is `side`.
    pub(crate) fn is_below(&self, side: Direction, view: &View) -> bool {
        side.dot(view.orientation.to_view(self.centre)) < -self.radius.min(FRAC_PI_2).sin()
    }

    /// Returns the radius in radians.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns whether the view's field stop cuts off nothing of the cap.
    pub(crate) fn is_clear_of_stop(&self, view: &View) -> bool {
        let bounds = || view.cap_bounds(self.centre, Angle::from_radians(self.radius));
        view.stop == FieldStop::NONE || self.passes_stop_of(view, &bounds())
    }

    /// Returns whether all of the cap is inside the view's field and away from its rim. False where no formula
    /// describes the rim.
    pub(crate) fn is_inside(&self, view: &View) -> bool {
        !view.projection.ends_between_samples() && view.margin(self.centre) > self.radius && self.is_clear_of_stop(view)
    }

    /// Returns whether one source shows all of the cap.
    pub(crate) fn is_shown_by(&self, source: &Source) -> bool {
        let view = &source.view;
        let bounds = view.cap_bounds(self.centre, Angle::from_radians(self.radius));
        let columns = source.period.is_some_and(|period| period <= view.width())
            || (bounds.min.x >= 0.0 && bounds.max.x <= view.width() as f64);
        let rows = bounds.min.y >= 0.0 && bounds.max.y <= view.height() as f64;
        // Without a field stop, a view ends at its rim, which the margin measures. A mask may hide any texel.
        let is_inside = source.period.is_some() || view.margin(self.centre) > self.radius;
        let is_bare = source.mask.is_none();
        is_bare && is_inside && columns && rows && self.passes_stop_of(view, &bounds)
    }

    fn passes_stop_of(&self, view: &View, bounds: &PixelBounds) -> bool {
        let half_space = view
            .stop
            .half_space
            .is_none_or(|side| side.dot(view.orientation.to_view(self.centre)) >= self.radius.sin());
        // A disc that holds the corners of a rectangle holds the rectangle.
        let in_circle = |radius: f64| {
            let corners = [
                (bounds.min.x, bounds.min.y),
                (bounds.max.x, bounds.min.y),
                (bounds.min.x, bounds.max.y),
                (bounds.max.x, bounds.max.y),
            ];
            corners.into_iter().all(|(x, y)| {
                let point = view.grid.to_plane(PixelPoint::new(x, y));
                point.x.hypot(point.y) <= radius
            })
        };
        half_space && view.stop.circle.is_none_or(in_circle)
    }

    /// Returns the texels of a source that the block's pixels can see, without a kernel around them.
    pub(crate) fn seen_texels(&self, source: &Source) -> Option<PixelRect> {
        texels_within(source, self.centre, self.radius)
    }

    /// Returns the view that shows all of the cap; the first of several.
    pub(crate) fn owner(&self, world: &World) -> Option<usize> {
        world.near(self.centre, || 0.0).find(|view| self.is_shown_by(&world.sources()[*view]))
    }

    /// Visits the views of which a kernel around the block's pixels can touch texels, with these texels.
    pub(crate) fn read_texels<'a>(
        &self,
        world: &'a World,
        kernel: &Kernel,
    ) -> impl Iterator<Item = (usize, PixelRect)> + use<'a> {
        // A kernel may widen to the size of the largest texels nearby, of any view.
        let texel_pitch = world.coarsest(|source| source.texel_pitch_within(self.centre, self.radius));
        // The gather's own bound of a kernel, half as much again for the error of mappings that it takes as linear, and
        // the few texels of look-ups without a kernel.
        let unit = (kernel.scale * self.pixel).max(kernel.floor * texel_pitch);
        let reach = 1.5 * kernel.radius().max(1.0) * unit + 3.0 * texel_pitch;
        let (centre, radius) = (self.centre, self.radius + reach);
        let touched = move |view: usize| Some((view, texels_within(&world.sources()[view], centre, radius)?));
        world.near(centre, || radius).filter_map(touched)
    }
}

/// Returns the texels of a source that can lie within `radius` radians of a direction.
pub(crate) fn texels_within(source: &Source, centre: Direction, radius: f64) -> Option<PixelRect> {
    if !source.reaches(centre, radius) {
        return None;
    }
    let (width, height) = (source.view.width(), source.view.height());
    let bounds = source.view.cap_bounds(centre, Angle::from_radians(radius));
    let wraps = source.period.is_some() && (bounds.min.x < 0.0 || bounds.max.x > width as f64);
    let low = |value: f64, size: usize| value.floor().clamp(0.0, size as f64) as usize;
    let high = |value: f64, size: usize| value.ceil().clamp(0.0, size as f64) as usize;
    let (left, right) = if wraps { (0, width) } else { (low(bounds.min.x, width), high(bounds.max.x, width)) };
    let (top, bottom) = (low(bounds.min.y, height), high(bounds.max.y, height));
    (left < right && top < bottom).then_some(PixelRect { left, top, right, bottom })
}
