use crate::projection::{PlanePoint, Projection};
use crate::sphere::Direction;
use crate::world::{FieldStop, PixelPoint, Source, View};

/// Where a target's field of view ends: texels that no part of it falls upon count for nothing, whatever they hold.
///
/// A kernel at the rim of a lens reaches beyond it, into parts of faces that nobody needed to render.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldEdge<'a> {
    target: &'a View,
    /// Cosine of the limiting circle's angle from the axis: stops are for lenses, whose circles are cones. `None` where the
    /// circle holds all that the lens shows.
    circle: Option<f64>,
    /// 1 where the middle of the picture looks to the front, −1 where it looks back, as in a mirror ball.
    axis: f64,
}

/// Points of a texel by which its overlap with the field is judged: its centre, and its corners a hair inside, since
/// those of a texel beyond the edge lie on it.
const POINTS: [(f64, f64); 5] = [(0.5, 0.5), (0.001, 0.001), (0.999, 0.001), (0.001, 0.999), (0.999, 0.999)];

impl<'a> FieldEdge<'a> {
    /// The edge of a target's field; `None` if it has none inside its image.
    pub(super) fn of(target: &'a View) -> Option<Self> {
        let at = |radius| target.projection.unproject(PlanePoint::new(radius, 0.0));
        let circle = target.stop.circle.and_then(at).map(|direction| -direction.vector().z);
        let middle = target.projection.unproject(PlanePoint::new(0.0, 0.0));
        let axis = middle.map_or(1.0, |direction| (-direction.vector().z).signum());
        let circle = circle.map(|circle| axis * circle);
        (target.stop != FieldStop::NONE).then_some(Self { target, circle, axis })
    }

    /// Whether the field holds a few texels of this pitch. One that does not is made of what is around it.
    pub(super) fn is_wider_than(&self, texel_pitch: f64) -> bool {
        self.circle.is_none_or(|circle| circle.acos() > 2.0 * texel_pitch)
    }

    /// Whether something within `reach` radians of a direction may lie outside the field.
    pub(super) fn is_near(&self, direction: Direction, reach: f64) -> bool {
        let direction = self.target.orientation.to_view(direction);
        // A cosine changes by no more than its angle.
        self.circle.is_some_and(|circle| self.axis_cosine(direction) < circle + reach)
            || self.target.stop.half_space.is_some_and(|side| side.dot(direction) < reach)
    }

    /// Whether everything within `reach` radians of a direction surely lies outside the field.
    pub(super) fn is_far_beyond(&self, direction: Direction, reach: f64) -> bool {
        let direction = self.target.orientation.to_view(direction);
        self.circle.is_some_and(|circle| self.axis_cosine(direction) < circle - reach)
            || self.target.stop.half_space.is_some_and(|side| side.dot(direction) < -reach)
    }

    /// Whether a part of the field falls upon the texel with this index in the world's buffer.
    pub(super) fn touches(&self, source: &Source, texel: usize) -> bool {
        let (i, j) = ((texel - source.offset) % source.view.width(), (texel - source.offset) / source.view.width());
        POINTS.iter().any(|(x, y)| {
            let direction = source.view.direction(PixelPoint::new(i as f64 + x, j as f64 + y));
            direction.is_some_and(|direction| self.holds(direction))
        })
    }

    /// Cosine of a direction's angle from the axis.
    fn axis_cosine(&self, direction: Direction) -> f64 {
        -direction.vector().z * self.axis
    }

    fn holds(&self, direction: Direction) -> bool {
        let direction = self.target.orientation.to_view(direction);
        self.circle.is_none_or(|circle| self.axis_cosine(direction) >= circle)
            && self.target.stop.half_space.is_none_or(|side| side.dot(direction) >= 0.0)
    }
}
