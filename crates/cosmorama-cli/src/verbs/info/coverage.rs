//! Parts of the sphere that views show.

use cosmorama::camera::{PixelPoint, View};
use cosmorama::sphere::{Direction, Extent};
use cosmorama::world::SeenCone;
use cosmorama_convert::InputView;

/// Number of directions, each for an equal part of the sphere: enough for a tenth of a percent.
const DIRECTIONS: usize = 100_000;

/// Directions all over the sphere, and which of them any view shows.
pub(super) struct Coverage {
    /// From the zenith to the nadir.
    directions: Vec<Direction>,
    is_covered: Vec<bool>,
    /// The last view, with its cone: most of many views differ by nothing but where they look.
    last: Option<(View, Option<SeenCone>)>,
}

impl Coverage {
    pub(super) fn new() -> Self {
        let directions: Vec<Direction> = Direction::spread(DIRECTIONS).collect();
        Self { is_covered: vec![false; directions.len()], directions, last: None }
    }

    /// Adds what a view shows, and returns it as a share of the whole sphere.
    pub(super) fn add(&mut self, view: &InputView) -> f64 {
        let seen = self.seen(view);
        seen.iter().for_each(|at| self.is_covered[*at] = true);
        share(seen.len())
    }

    /// Returns what a view shows as a share of the whole sphere.
    pub(super) fn share_of(&mut self, view: &InputView) -> f64 {
        share(self.seen(view).len())
    }

    /// Returns the share of the sphere that the views added show together.
    pub(super) fn share(&self) -> f64 {
        share(self.is_covered.iter().filter(|is_covered| **is_covered).count())
    }

    /// Returns where the directions lie that no view shows; `None` if there are none.
    pub(super) fn lacks(&self) -> Option<Extent> {
        let directions = self.directions.iter().zip(&self.is_covered);
        directions
            .filter(|(_, is_covered)| !**is_covered)
            .map(|(direction, _)| Extent::of(*direction))
            .reduce(Extent::union)
    }

    /// Returns the places of the directions that a view's file shows and its mask lets through.
    fn seen(&mut self, view: &InputView) -> Vec<usize> {
        let Some((held, _)) = &view.window else { return Vec::new() };
        let is_shown = |pixel: PixelPoint| view.mask.as_ref().is_none_or(|mask| mask.shows(pixel));
        let cone = self.cone(held);
        let holds = |direction: Direction| {
            cone.is_none_or(|cone| cone.may_hold(direction))
                && held.sees(direction)
                && held.pixel(direction).is_some_and(|pixel| is_shown(held.wrapped(pixel)))
        };
        self.directions_near(cone).filter(|at| holds(self.directions[*at])).collect()
    }

    /// Returns the range of directions at the latitudes of a cone.
    fn directions_near(&self, cone: Option<SeenCone>) -> std::ops::Range<usize> {
        let Some(cone) = cone else { return 0..self.directions.len() };
        let latitude = |direction: Direction| direction.longitude_latitude().1.radians();
        let middle = latitude(cone.middle());
        let from = self.directions.partition_point(|direction| latitude(*direction) > middle + cone.reach());
        let until = self.directions.partition_point(|direction| latitude(*direction) >= middle - cone.reach());
        from..until
    }

    /// Returns the cone that holds what a view shows.
    fn cone(&mut self, view: &View) -> Option<SeenCone> {
        let cone = match &self.last {
            Some((last, cone)) if last.is_alike(view) => cone.map(|cone| cone.turned(last, view)),
            _ => SeenCone::of(view),
        };
        self.last = Some((view.clone(), cone));
        cone
    }
}

fn share(count: usize) -> f64 {
    count as f64 / DIRECTIONS as f64
}
