use super::bounding_cone::SeenCone;
use crate::camera::{PixelPoint, View};
use crate::sphere::{Direction, Extent};
use crate::world::ViewMask;

/// Number of directions, each for an equal part of the sphere: enough for a tenth of a percent.
const DIRECTIONS: usize = 100_000;

/// Parts of the sphere that views show: directions all over it, and which of them any view shows.
#[derive(Clone, Debug)]
pub struct SphereCoverage {
    /// From the zenith to the nadir.
    directions: Vec<Direction>,
    is_covered: Vec<bool>,
    /// The last view, with its cone: most of many views differ by nothing but where they look.
    last: Option<(View, Option<SeenCone>)>,
}

impl Default for SphereCoverage {
    fn default() -> Self {
        Self::new()
    }
}

impl SphereCoverage {
    /// Creates the coverage of no view.
    pub fn new() -> Self {
        let mut directions: Vec<Direction> = Direction::spread(DIRECTIONS).collect();
        directions.sort_by(|a, b| b.vector().y.total_cmp(&a.vector().y));
        Self { is_covered: vec![false; directions.len()], directions, last: None }
    }

    /// Adds what a view shows and its mask lets through, and returns it as a share of the whole sphere.
    pub fn add(&mut self, view: &View, mask: Option<&ViewMask>) -> f64 {
        let seen = self.seen(view, mask);
        seen.iter().for_each(|at| self.is_covered[*at] = true);
        share(seen.len())
    }

    /// Returns what a view shows and its mask lets through as a share of the whole sphere.
    pub fn share_of(&mut self, view: &View, mask: Option<&ViewMask>) -> f64 {
        share(self.seen(view, mask).len())
    }

    /// Returns the share of the sphere that the views added show together.
    pub fn share(&self) -> f64 {
        share(self.is_covered.iter().filter(|is_covered| **is_covered).count())
    }

    /// Returns where the directions lie that no view shows; `None` if there are none.
    pub fn lacks(&self) -> Option<Extent> {
        let directions = self.directions.iter().zip(&self.is_covered);
        let missing = directions.filter(|(_, is_covered)| !**is_covered);
        missing.map(|(direction, _)| Extent::of(*direction)).reduce(Extent::union)
    }

    /// Returns the places of the directions that a view shows and its mask lets through.
    fn seen(&mut self, view: &View, mask: Option<&ViewMask>) -> Vec<usize> {
        let cone = self.cone(view);
        let near = self.directions_near(cone);
        let may_hold = |direction: Direction| cone.is_none_or(|cone| cone.may_hold(direction));
        near.filter(|at| may_hold(self.directions[*at]) && shows(view, mask, self.directions[*at])).collect()
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

/// Returns whether a view shows a direction, and its mask lets it through.
fn shows(view: &View, mask: Option<&ViewMask>, direction: Direction) -> bool {
    let is_shown = |pixel: PixelPoint| mask.is_none_or(|mask| mask.shows(pixel));
    view.sees(direction) && view.pixel(direction).is_some_and(|pixel| is_shown(view.wrapped(pixel)))
}

fn share(count: usize) -> f64 {
    count as f64 / DIRECTIONS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{
        CameraModel, CubeFaceCamera, CylinderCamera, CylinderKind, EquirectCamera, FisheyeCamera, MirrorBallCamera,
        Placement, StereographicCamera,
    };
    use crate::sphere::{Angle, Orientation};

    #[test]
    fn what_is_found_by_cones_is_what_each_direction_shows() {
        let frames = [
            CameraModel::CubeFace(CubeFaceCamera),
            CameraModel::Fisheye(FisheyeCamera::default()),
            CameraModel::Stereographic(StereographicCamera::default()),
            CameraModel::Equirect(EquirectCamera::default()),
            CameraModel::Cylinder(CylinderCamera::new(CylinderKind::Mercator)),
            CameraModel::MirrorBall(MirrorBallCamera::default()),
        ];
        let mut coverage = SphereCoverage::new();
        let mut covered = vec![false; DIRECTIONS];
        let masks = [None, Some(ViewMask::new(32, 32, |i, j| i > 9 && j < 25))];
        // Each twice in a row, turned otherwise, at both poles and at the seam.
        for (frame, angles) in frames.iter().flat_map(|frame| {
            [[0.0, 90.0, 0.0], [12.0, -88.0, 40.0], [180.0, 3.0, -70.0]].map(|angles| (frame.clone(), angles))
        }) {
            let [yaw, pitch, roll] = angles.map(Angle::from_degrees);
            let orientation = Orientation::from_yaw_pitch_roll(yaw, pitch, roll);
            let view = Placement { orientation, ..Placement::new(frame) }.view(32, 32).expect("a size");
            for mask in masks.iter().map(Option::as_ref) {
                let is_seen: Vec<bool> =
                    coverage.directions.iter().map(|direction| shows(&view, mask, *direction)).collect();
                let expected = share(is_seen.iter().filter(|is_seen| **is_seen).count());
                assert_eq!(coverage.share_of(&view, mask), expected, "{view:?}");
                if mask.is_some() {
                    assert_eq!(coverage.add(&view, mask), expected);
                    covered.iter_mut().zip(is_seen).for_each(|(covered, is_seen)| *covered |= is_seen);
                    assert_eq!(coverage.is_covered, covered);
                }
            }
        }
    }

    #[test]
    fn what_lacks_is_told_until_all_is_covered() {
        let view = CameraModel::Equirect(EquirectCamera::default()).view(64, 32).expect("a size");
        let mut coverage = SphereCoverage::new();
        assert_eq!(coverage.share(), 0.0);
        coverage.add(&view, Some(&ViewMask::new(64, 32, |i, _| i < 32)));
        assert!((coverage.share() - 0.5).abs() < 0.01, "{}", coverage.share());
        assert!(coverage.lacks().is_some());
        coverage.add(&view, None);
        assert_eq!((coverage.share(), coverage.lacks().is_none()), (1.0, true));
    }
}
