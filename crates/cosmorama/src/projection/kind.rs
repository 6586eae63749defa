use glam::{DVec2, DVec3};

use super::azimuthal::{Azimuthal, FisheyeLens, OmnimaxLens};
use super::cylindrical::{Central, Cylindrical, EqualArea, Equirectangular, Mercator};
use super::pseudocylindrical::{Mollweide, Pseudocylindrical, Sinusoidal};
use super::{
    BrownConrady, BrownConradyCoefficients, Calibrated, EquiAngular, Hammer, MirrorBall, Outline, Perspective,
    PlanePoint, PlaneRect, Projection, ProjectionKind,
};
use crate::sphere::{Angle, Direction, DirectionJacobian};

impl ProjectionKind {
    /// The pinhole camera.
    pub const PERSPECTIVE: Self = Self::Perspective(Perspective);
    /// The Omnimax lens.
    pub const OMNIMAX: Self = Self::Omnimax(Azimuthal(OmnimaxLens));
    /// The equidistant fisheye.
    pub const EQUIDISTANT: Self = Self::fisheye(FisheyeLens::EQUIDISTANT);
    /// The equirectangular panorama.
    pub const EQUIRECTANGULAR: Self = Self::Equirectangular(Cylindrical(Equirectangular));
    /// A face of an equi-angular cube map.
    pub const EQUI_ANGULAR: Self = Self::EquiAngular(EquiAngular);
    /// Mercator's map.
    pub const MERCATOR: Self = Self::Mercator(Cylindrical(Mercator));
    /// The central cylinder.
    pub const CENTRAL_CYLINDER: Self = Self::CentralCylinder(Cylindrical(Central));
    /// Lambert's equal-area cylinder.
    pub const EQUAL_AREA_CYLINDER: Self = Self::EqualAreaCylinder(Cylindrical(EqualArea));
    /// A mirror ball seen by a distant camera.
    pub const MIRROR_BALL: Self = Self::MirrorBall(MirrorBall::DISTANT);
    /// Hammer's map of the world.
    pub const HAMMER: Self = Self::Hammer(Hammer);
    /// Mollweide's map of the world.
    pub const MOLLWEIDE: Self = Self::Mollweide(Pseudocylindrical(Mollweide));
    /// The sinusoidal map of the world.
    pub const SINUSOIDAL: Self = Self::Sinusoidal(Pseudocylindrical(Sinusoidal));

    /// Returns whether the domain is convex and symmetrical about both axes. Then a rectangle overlaps the domain only
    /// if its point nearest to both axes lies inside it.
    pub(crate) fn is_oval(&self) -> bool {
        matches!(self, Self::Hammer(_) | Self::Mollweide(_) | Self::Sinusoidal(_))
    }

    /// Returns whether the domain consists of whole squares around samples. Then a pixel whose centre and corners see
    /// nothing sees nothing at all.
    pub(crate) fn ends_between_samples(&self) -> bool {
        matches!(self, Self::StMap(_))
    }

    /// Returns the projection of a fisheye lens.
    pub const fn fisheye(lens: FisheyeLens) -> Self {
        Self::Fisheye(Azimuthal(lens))
    }
}

/// Examples of cameras with lens distortion: radial, general, and with a rational formula.
pub(crate) fn bent_cameras() -> impl Iterator<Item = Calibrated<BrownConrady>> {
    let bent = [
        &[-0.28, 0.07, 0.0, 0.0][..],
        &[-0.265, -0.047, 0.0018, -0.0003, 0.252],
        &[10.7, 5.9, 1e-4, -2e-4, 0.28, 11.1, 9.9, 1.5, 1e-3, -2e-4, 5e-4, 1e-4],
    ];
    bent.into_iter().filter_map(|numbers| {
        let lens = BrownConrady::new(BrownConradyCoefficients::from_opencv(numbers)).ok()?;
        Some(Calibrated::new(lens, 0.003, Angle::HALF_TURN))
    })
}

/// Returns an example of a fisheye with skewed rows.
pub(crate) fn skewed_fisheye() -> Calibrated<Azimuthal<FisheyeLens>> {
    Calibrated::new(Azimuthal(FisheyeLens::EQUISOLID), -0.02, Angle::from_degrees(95.0))
}

impl Projection for ProjectionKind {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        each!(self, projection => projection.project(direction))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        each!(self, projection => projection.unproject(point))
    }

    fn unproject_row(&self, first: PlanePoint, step: f64, count: usize, visit: impl FnMut(usize, Direction)) {
        each!(self, projection => projection.unproject_row(first, step, count, visit));
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        each!(self, projection => projection.jacobian(point))
    }

    fn solid_angle(&self, point: PlanePoint) -> Option<f64> {
        each!(self, projection => projection.solid_angle(point))
    }

    fn row_solid_angles(&self, first: PlanePoint, step: f64, count: usize, visit: impl FnMut(usize, Option<f64>)) {
        each!(self, projection => projection.row_solid_angles(first, step, count, visit));
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        each!(self, projection => projection.unproject_with_jacobian(point))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        each!(self, projection => projection.project_with_derivatives(direction, tangents))
    }

    fn curvature(&self, point: PlanePoint) -> Option<[DVec2; 3]> {
        each!(self, projection => projection.curvature(point))
    }

    fn margin(&self, direction: Direction) -> f64 {
        each!(self, projection => projection.margin(direction))
    }

    fn has_steep_rim(&self) -> bool {
        each!(self, projection => projection.has_steep_rim())
    }

    fn ends_at_cone(&self) -> bool {
        each!(self, projection => projection.ends_at_cone())
    }

    fn beyond_seam(&self, direction: Direction) -> Option<Direction> {
        each!(self, projection => projection.beyond_seam(direction))
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        each!(self, projection => projection.cap_bounds(centre, radius))
    }

    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        each!(self, projection => projection.cap_outline(centre, radius))
    }

    fn period(&self) -> Option<f64> {
        each!(self, projection => projection.period())
    }
}
