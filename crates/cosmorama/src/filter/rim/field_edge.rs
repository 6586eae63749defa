use crate::camera::{FieldStop, PixelPoint, View};
use crate::projection::{PlanePoint, Projection};
use crate::sphere::Direction;
use crate::world::Source;

/// Edge of a target's field of view. Texels that no part of the field falls on do not count, whatever they hold.
///
/// A kernel at the rim of a lens reaches beyond it, into parts of faces that nobody needed to render.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FieldEdge<'a> {
    target: &'a View,
    /// Cosine of the angle between the axis and the limiting circle: field stops are for lenses, whose circles are
    /// cones of directions. `None` where the circle holds all that the lens shows.
    circle: Option<f64>,
    /// 1 if the middle of the picture looks to the front, −1 if it looks back, as in a mirror ball.
    axis: f64,
}

/// Points of a texel that are tested for overlap with the field, besides its centre. They are the corners, moved
/// slightly inwards, since a texel beyond the edge may have corners on the edge.
const CORNERS: [(f64, f64); 4] = [(0.001, 0.001), (0.999, 0.001), (0.001, 0.999), (0.999, 0.999)];

impl<'a> FieldEdge<'a> {
    /// Returns the edge of a target's field; `None` if it has none inside its image.
    pub(crate) fn of(target: &'a View) -> Option<Self> {
        let at = |radius| target.projection.unproject(PlanePoint::new(radius, 0.0));
        let circle = target.stop.circle.and_then(at).map(|direction| -direction.vector().z);
        let middle = target.projection.unproject(PlanePoint::new(0.0, 0.0));
        let axis = middle.map_or(1.0, |direction| (-direction.vector().z).signum());
        let circle = circle.map(|circle| axis * circle);
        (target.stop != FieldStop::NONE).then_some(Self { target, circle, axis })
    }

    /// Returns whether the field is wider than a few texels of this pitch, in radians. For a narrower field, all texels
    /// around it count.
    pub(crate) fn is_wider_than(&self, texel_pitch: f64) -> bool {
        self.circle.is_none_or(|circle| circle.acos() > 2.0 * texel_pitch)
    }

    /// Returns whether something within `reach` radians of a direction may lie outside the field.
    pub(crate) fn is_near(&self, direction: Direction, reach: f64) -> bool {
        let direction = self.target.orientation.to_view(direction);
        // cos(α − ρ) = cos α cos ρ + sin α sin ρ, of which this is an upper bound.
        let within = |circle: f64| circle + sine(circle) * reach + (-circle).max(0.0) * (reach * reach / 2.0);
        self.circle.is_some_and(|circle| self.axis_cosine(direction) < within(circle))
            || self.target.stop.half_space.is_some_and(|side| side.dot(direction) < reach)
    }

    /// Returns whether everything within `reach` radians of a direction surely lies outside the field.
    pub(crate) fn is_far_beyond(&self, direction: Direction, reach: f64) -> bool {
        let direction = self.target.orientation.to_view(direction);
        self.circle.is_some_and(|circle| self.axis_cosine(direction) < circle - reach)
            || self.target.stop.half_space.is_some_and(|side| side.dot(direction) < -reach)
    }

    /// Returns whether a part of the field falls on the texel in this column and row of a source.
    pub(crate) fn touches(&self, source: &Source, texel: [usize; 2]) -> bool {
        let centre = source.view.direction(PixelPoint::centre(texel[0], texel[1]));
        !self.is_refused(source, centre) && self.holds_some(&source.view, centre, texel)
    }

    /// Returns whether a texel's centre alone shows that no part of the field falls on the texel.
    fn is_refused(&self, source: &Source, centre: Option<Direction>) -> bool {
        // No corner of a texel is farther from its centre than its side is long.
        source.has_bounded_texels() && centre.is_some_and(|centre| self.is_far_beyond(centre, source.texel_pitch))
    }

    /// Returns whether the field holds a texel's centre or one of its corners.
    fn holds_some(&self, view: &View, centre: Option<Direction>, [i, j]: [usize; 2]) -> bool {
        let at = |(x, y): &(f64, f64)| view.direction(PixelPoint::new(i as f64 + x, j as f64 + y));
        centre.into_iter().chain(CORNERS.iter().filter_map(at)).any(|direction| self.holds(direction))
    }

    /// Returns the cosine of a direction's angle from the axis.
    fn axis_cosine(&self, direction: Direction) -> f64 {
        -direction.vector().z * self.axis
    }

    /// Returns whether the field holds a direction.
    fn holds(&self, direction: Direction) -> bool {
        let direction = self.target.orientation.to_view(direction);
        self.circle.is_none_or(|circle| self.axis_cosine(direction) >= circle)
            && self.target.stop.half_space.is_none_or(|side| side.dot(direction) >= 0.0)
    }
}

/// Returns the sine of an angle between 0 and π, given its cosine.
fn sine(cosine: f64) -> f64 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelGrid;
    use crate::projection::{PlaneRect, ProjectionKind, StMap, StMapTable};
    use crate::sphere::{Angle, Orientation};
    use crate::world::World;

    #[test]
    fn what_is_not_near_the_edge_has_it_farther_away_than_asked() {
        let rect = PlaneRect { min: PlanePoint::new(-3.0, -3.0), max: PlanePoint::new(3.0, 3.0) };
        let target = View {
            projection: ProjectionKind::EQUIDISTANT,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(60, 60, rect),
            stop: FieldStop::NONE,
        };
        for half in [0.02, 0.5, 1.5, 2.2, 3.0] {
            let target = View { stop: FieldStop::circle(half), ..target.clone() };
            let edge = FieldEdge::of(&target).expect("a circle");
            for (step, reach) in (0..=300).flat_map(|step| [0.0, 0.01, 0.3, 2.0].map(|reach| (step, reach))) {
                let angle = f64::from(step) * 0.01;
                let direction = target.projection.unproject(PlanePoint::new(0.0, angle)).expect("a direction");
                let is_near = edge.is_near(direction, reach);
                assert!(is_near || angle + reach <= half + 1e-9, "{angle} + {reach}, {half}");
                // Nor is everything near: a direction much farther away is not.
                assert!(!is_near || angle + 1.3 * reach + 0.01 > half || reach > 0.01, "{angle} + {reach}, {half}");
            }
        }
    }
    fn view(projection: ProjectionKind, size: (usize, usize), half: (f64, f64), stop: FieldStop) -> View {
        let rect = PlaneRect { min: PlanePoint::new(-half.0, -half.1), max: PlanePoint::new(half.0, half.1) };
        let [yaw, pitch, roll] = [20.0, -35.0, 10.0].map(Angle::from_degrees);
        let orientation = Orientation::from_yaw_pitch_roll(yaw, pitch, roll);
        View { projection, orientation, grid: PixelGrid::spanning(size.0, size.1, rect), stop }
    }

    /// Returns a panorama in which a few columns show far more than others. No measurement of texel pitch falls on
    /// those columns.
    fn stretched() -> ProjectionKind {
        let table = StMapTable::of_pixels(97, 65, |i, j| {
            let x = (i as f64 + 0.5) / 97.0 - 0.5;
            let longitude = x + 1.0 + ((x - 0.03) * 200.0).tanh();
            ProjectionKind::EQUIRECTANGULAR.unproject(PlanePoint::new(longitude, 2.0 - j as f64 / 16.25))
        });
        ProjectionKind::StMap(StMap::new(table.expect("a table")))
    }

    /// Columns and rows of a world.
    const SIZE: [usize; 2] = [45, 37];

    /// Worlds of one view, in all projections: inside their domain and beyond.
    fn worlds() -> impl Iterator<Item = World> {
        let kinds = ProjectionKind::all().into_iter().chain([stretched()]);
        let halves = [(1.0, 1.0), (1.07, 1.02), (3.2, 1.6)];
        kinds
            .flat_map(move |kind| halves.map(|half| view(kind.clone(), (SIZE[0], SIZE[1]), half, FieldStop::NONE)))
            .filter_map(|view| World::new([("all".to_owned(), view)]).ok())
    }

    #[test]
    fn texels_that_are_refused_by_their_centres_have_no_part_in_the_field() {
        let lower = |stop: FieldStop| stop.with_lower(Angle::from_degrees(30.0));
        let [small, large] = [0.1, 0.8].map(FieldStop::circle);
        let stops = [small, large, lower(FieldStop::NONE), lower(large)];
        let target = |kind: ProjectionKind| stops.map(|stop| view(kind.clone(), (60, 60), (1.0, 1.0), stop));
        // The middle of a ball shows what is behind.
        let targets = [ProjectionKind::EQUIDISTANT, ProjectionKind::MIRROR_BALL].map(target);
        assert_eq!(FieldEdge::of(&targets[1][0]).expect("a circle").axis, -1.0);
        // Number of seen texels whose centres are farther from the field than the largest texel that was measured.
        let mut farther = 0;
        for world in worlds() {
            let source = &world.sources()[0];
            let mut refused = 0;
            for edge in targets.as_flattened().iter().filter_map(FieldEdge::of) {
                for [i, j] in (0..SIZE[1]).flat_map(|j| (0..SIZE[0]).map(move |i| [i, j])) {
                    let centre = source.view.direction(PixelPoint::centre(i, j));
                    let is_seen = edge.holds_some(&source.view, centre, [i, j]);
                    assert_eq!(edge.touches(source, [i, j]), is_seen, "{:?} at {i}, {j} by {edge:?}", source.view);
                    let is_farther = centre.is_some_and(|centre| edge.is_far_beyond(centre, source.texel_pitch));
                    farther += usize::from(is_seen && is_farther);
                    refused += usize::from(edge.is_refused(source, centre));
                }
            }
            assert_eq!(refused > 100, source.has_bounded_texels(), "{refused} texels of {:?}", source.view);
        }
        assert!(farther > 0, "no texel is larger than those that are measured");
    }
}
