use crate::camera::{PixelPoint, View};
use crate::projection::{PlanePoint, Projection};
use crate::sphere::{Angle, Direction};

/// A cone that holds every direction in a picture.
///
/// Around the point behind a lens, or beside a horizon, even a small cap spreads over the whole plane of the image.
/// Caps outside the cone need not be searched for in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeenCone {
    middle: Direction,
    half: Angle,
}

/// Number of sampled points along each edge of an image, and across it.
const STEPS: usize = 48;

impl SeenCone {
    /// Computes the cone of a view; `None` where the view may span the whole world.
    pub(crate) fn of(view: &View) -> Option<Self> {
        match view.stop.circle {
            Some(radius) => Self::of_circle(view, radius),
            None => Self::of_image(view),
        }
    }

    fn of_circle(view: &View, radius: f64) -> Option<Self> {
        let middle = view.projection.unproject(PlanePoint::new(0.0, 0.0))?;
        let half = middle.angle_to(view.projection.unproject(PlanePoint::new(radius, 0.0))?);
        Some(Self { middle: view.orientation.to_world(middle), half })
    }

    /// Returns the cone around a lattice of points of the image, widened by the distance between neighbouring points.
    fn of_image(view: &View) -> Option<Self> {
        // A panorama goes all the way round, and a table may be torn between any two points.
        if view.period().is_some() || view.projection.ends_between_samples() {
            return None;
        }
        let at = |size: usize, step: usize| size as f64 * step as f64 / STEPS as f64;
        let look = |i: usize, j: usize| view.direction(PixelPoint::new(at(view.width(), i), at(view.height(), j)));
        let middle = look(STEPS / 2, STEPS / 2)?;
        let (mut half, mut apart) = (0f64, 0f64);
        for (i, j) in (0..=STEPS).flat_map(|j| (0..=STEPS).map(move |i| (i, j))) {
            let here = look(i, j)?;
            half = half.max(middle.angle_to(here).radians());
            let before = [(i > 0).then(|| look(i - 1, j)), (j > 0).then(|| look(i, j - 1))];
            for neighbour in before.into_iter().flatten() {
                apart = apart.max(here.angle_to(neighbour?).radians());
            }
        }
        let half = Angle::from_radians(half + apart);
        (half < Angle::HALF_TURN).then_some(Self { middle, half })
    }

    /// Returns the cone of another view that [is alike](View::is_alike) a view with this cone.
    pub(crate) fn turned(self, from: &View, to: &View) -> Self {
        Self { middle: to.orientation.to_world(from.orientation.to_view(self.middle)), ..self }
    }

    /// Returns the middle.
    pub(crate) fn middle(&self) -> Direction {
        self.middle
    }

    /// Returns the angle between the middle and the rim.
    pub(crate) fn half(&self) -> Angle {
        self.half
    }

    /// Returns whether two cones have a direction in common, or nearly so: they hold directions up to rounding.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.reaches(other.middle, other.reach())
    }

    /// Returns the angle, in radians, between the middle and the farthest direction that counts as inside: half the cone, and rounding.
    pub(crate) fn reach(&self) -> f64 {
        const ROUNDING: f64 = 1e-6;
        self.half.radians() + ROUNDING
    }

    /// Returns whether the cone may hold a direction: quickly, and with some that lie beside it.
    pub(crate) fn may_hold(&self, direction: Direction) -> bool {
        // A chord is shorter than its arc.
        self.middle.vector().distance_squared(direction.vector()) <= self.reach() * self.reach()
    }

    /// Returns whether the cone comes within `radius` radians of a direction.
    pub(crate) fn reaches(&self, direction: Direction, radius: f64) -> bool {
        let most = self.half.radians() + radius;
        // A chord is shorter than its arc, so that most of many views are ruled out without the angle.
        let chord = self.middle.vector().distance_squared(direction.vector());
        chord <= most * most && self.middle.angle_to(direction).radians() <= most
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{
        CameraModel, CubeFaceCamera, CylinderCamera, CylinderKind, EquirectCamera, FieldOfView, FisheyeCamera,
        MirrorBallCamera, PanniniCamera, PerspectiveCamera, Placement, StereographicCamera, WorldMapCamera,
    };
    use crate::sphere::Orientation;

    fn cone_holds_the_picture(frame: CameraModel, (width, height): (usize, usize)) -> bool {
        let turn = [0.7, -0.4, 0.2].map(Angle::from_radians);
        let orientation = Orientation::from_yaw_pitch_roll(turn[0], turn[1], turn[2]);
        let view = Placement { orientation, ..Placement::new(frame.clone()) }.view(width, height).expect("a size");
        let Some(cone) = SeenCone::of(&view) else { return false };
        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
            let pixel = PixelPoint::centre(i, j);
            if let Some(direction) = view.direction(pixel).filter(|_| view.shows(pixel)) {
                assert!(cone.may_hold(direction));
                assert!(cone.reaches(direction, 1e-9), "{frame:?}: {direction:?} at {i}, {j} is outside {cone:?}");
            }
        }
        true
    }

    #[test]
    fn what_a_picture_shows_is_inside() {
        let pannini = PanniniCamera::default();
        for frame in [
            CameraModel::CubeFace(CubeFaceCamera),
            CameraModel::Perspective(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(150.0)))),
            CameraModel::Pannini(pannini),
            CameraModel::Stereographic(StereographicCamera::default()),
            CameraModel::Fisheye(FisheyeCamera::default()),
        ] {
            assert!(cone_holds_the_picture(frame.clone(), (97, 61)), "{frame:?} has no cone");
        }
    }

    #[test]
    fn cones_meet_where_they_have_a_direction_in_common() {
        let cone = |degrees: f64| {
            let orientation = Orientation::from_yaw_pitch_roll(Angle::from_degrees(degrees), Angle::ZERO, Angle::ZERO);
            let frame = CameraModel::Fisheye(FisheyeCamera {
                field_of_view: Angle::from_degrees(60.0),
                ..FisheyeCamera::default()
            });
            let view = Placement { orientation, ..Placement::new(frame) }.view(32, 32).expect("a size");
            SeenCone::of(&view).expect("a cone")
        };
        for (degrees, meets) in [(0.0, true), (55.0, true), (100.0, false), (180.0, false), (-55.0, true)] {
            assert_eq!(cone(0.0).meets(&cone(degrees)), meets, "{degrees}");
            assert_eq!(cone(degrees).meets(&cone(0.0)), meets, "{degrees}");
        }
    }

    #[test]
    fn what_goes_round_or_shows_the_world_has_none() {
        for frame in [
            CameraModel::Equirect(EquirectCamera::default()),
            CameraModel::Cylinder(CylinderCamera::new(CylinderKind::Mercator)),
            CameraModel::WorldMap(WorldMapCamera::Hammer),
        ] {
            assert!(!cone_holds_the_picture(frame.clone(), (96, 48)), "{frame:?}");
        }
        // A ball shows all of the world except the point behind it.
        cone_holds_the_picture(CameraModel::MirrorBall(MirrorBallCamera::default()), (64, 64));
    }
}
