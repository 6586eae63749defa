//! Fisheye lenses: the angle from the axis is a function of the radius in the picture.

pub(crate) mod arc_sine;
pub(crate) mod ball_lens;
pub(crate) mod calibrated;
pub(crate) mod equidistant;
pub(crate) mod equisolid;
pub(crate) mod lens;
pub(crate) mod mirror_ball;
pub(crate) mod omnimax;
pub(crate) mod orthographic;
pub(crate) mod stereographic;

pub use ball_lens::BallLens;
pub use calibrated::by_angle::ByAngle;
pub use calibrated::by_radius::ByRadius;
pub use calibrated::double_sphere::DoubleSphere;
pub use calibrated::field_of_view::FieldOfViewLens;
pub use calibrated::hugin::{Hugin, HuginIdeal};
pub use calibrated::kannala_brandt::KannalaBrandt;
pub use calibrated::ocam::{OCAM_COEFFICIENTS, Ocam};
pub use calibrated::polynomial::Polynomial;
pub use calibrated::unified::Unified;
pub use equidistant::Equidistant;
pub use equisolid::Equisolid;
pub use lens::{Lens, LensError};
pub use omnimax::OmnimaxLens;
pub use orthographic::Orthographic;
use std::f64::consts::PI;
pub use stereographic::Stereographic;

use glam::DVec3;

use super::{Outline, PlanePoint, PlaneRect, Projection, Ring, Sector, enum_dispatch};
use crate::sphere::{Angle, Direction, DirectionJacobian};

enum_dispatch! { ($)
    /// Any fisheye lens, chosen at run time. The examples of calibrated lenses are real ones.
    #[derive(Copy)]
    pub enum FisheyeLens {
        /// The equidistant lens, r = φ.
        Equidistant(Equidistant) = [Equidistant],
        /// The equisolid lens, r = 2 sin(φ/2).
        Equisolid(Equisolid) = [Equisolid],
        /// The stereographic lens, r = 2 tan(φ/2).
        Stereographic(Stereographic) = [Stereographic],
        /// The orthographic lens, r = sin φ.
        Orthographic(Orthographic) = [Orthographic],
        /// Blender's polynomial, in millimetres.
        Polynomial(Polynomial) = Polynomial::from_blender([0.0, -1.2, 0.0, 0.1, -0.02]),
        /// OpenCV's fisheye.
        KannalaBrandt(KannalaBrandt) = KannalaBrandt::from_opencv([-0.0014, -0.0032, 0.0043, -0.0016]),
        /// OCamCalib's polynomial, in pixels.
        Ocam(Ocam) = Ocam::from_coefficients([-0.7, 0.0, 0.35, -0.02, 0.03, 0.0, 0.0, 0.0]),
        /// The unified camera model and its extension.
        Unified(Unified) =
            [Unified::from_parameters(0.55, 1.0), Unified::from_parameters(0.6, 1.1)].into_iter().flatten(),
        /// The double sphere model.
        DoubleSphere(DoubleSphere) = DoubleSphere::from_parameters(-0.179, 0.591),
        /// The field-of-view model.
        FieldOfView(FieldOfViewLens) = FieldOfViewLens::from_omega(0.95),
        /// An ideal lens with Hugin's correction.
        Hugin(Hugin) = [
            Hugin::from_abc(HuginIdeal::Equidistant, [0.01, -0.03, 0.01], 1.2),
            Hugin::from_abc(HuginIdeal::Rectilinear, [0.0, -0.05, 0.0], 0.8),
        ]
        .into_iter()
        .flatten(),
    }
}

pub(crate) mod fisheye_lens;

/// The projection of a [`Lens`]; the plane's unit is the lens's unit of radius, and its origin is on the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Azimuthal<L>(pub L);

impl<L: Lens> Projection for Azimuthal<L> {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let sine = length(vector.x, vector.y);
        let radius = self.0.radius(sine.atan2(-vector.z))?;
        if sine == 0.0 {
            // All of the rim shows the direction straight behind, so any point of it will do.
            return Some(PlanePoint::new(radius, 0.0));
        }
        Some(PlanePoint::new(vector.x / sine * radius, vector.y / sine * radius))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        let radius = length(point.x, point.y);
        let (sin, cos) = self.0.sin_cos(radius);
        // If one is NaN, so is the other.
        if cos.is_nan() {
            return None;
        }
        let across = if radius == 0.0 { 0.0 } else { sin / radius };
        Some(Direction::from_unit(DVec3::new(point.x * across, point.y * across, -cos)))
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let radius = length(point.x, point.y);
        let (angle, slope) = self.0.angle(radius);
        // NaN means that there is no image.
        if angle.is_nan() || angle > PI {
            return None;
        }
        if radius == 0.0 {
            return Some((Direction::FRONT, DirectionJacobian { dx: DVec3::X * slope, dy: DVec3::Y * slope }));
        }
        let (sin, cos) = angle.sin_cos();
        let (ux, uy) = (point.x / radius, point.y / radius);
        let radial = DVec3::new(cos * ux, cos * uy, sin) * slope;
        let tangential = DVec3::new(-uy, ux, 0.0) * (sin / radius);
        let jacobian = DirectionJacobian { dx: radial * ux - tangential * uy, dy: radial * uy + tangential * ux };
        Some((Direction::from_unit(DVec3::new(ux * sin, uy * sin, -cos)), jacobian))
    }

    fn margin(&self, direction: Direction) -> f64 {
        // The chord to the direction straight behind.
        let vector = direction.vector();
        let behind = (vector - Direction::BACK.vector()).length();
        let reach = self.0.reach();
        if reach >= PI { behind } else { behind.min(reach - length(vector.x, vector.y).atan2(-vector.z)) }
    }

    fn has_steep_rim(&self) -> bool {
        self.0.has_steep_rim()
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        self.cap_outline(centre, radius).bounds()
    }

    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        let (from_axis, radius) = (Direction::FRONT.angle_to(centre).radians(), radius.radians());
        // Limited to the image, which is the rim's circle where a cap extends beyond it.
        let at = |angle: f64| self.0.radius(angle.clamp(0.0, self.0.reach()));
        let Some(outer) = at(from_axis + radius) else { return Outline::Rects(vec![PlaneRect::EVERYTHING]) };
        let inner = at(from_axis - radius).unwrap_or(0.0);
        // A cap that holds the axis, or the direction straight behind, has a full ring. Others have a sector as wide as
        // their azimuths.
        let sector = (from_axis > radius && from_axis + radius < PI).then(|| {
            let azimuth = centre.vector().y.atan2(centre.vector().x);
            Sector::new(azimuth, (radius.sin() / from_axis.sin()).min(1.0).asin())
        });
        Outline::Ring(Ring { inner, outer, sector })
    }
}

/// Returns √(x² + y²) for coordinates that cannot overflow; several times faster than `hypot`.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Returns sin φ/depth(φ) and its derivative, from (sin φ, cos φ) and from the depth and its derivative.
fn ratio((sin, cos): (f64, f64), (depth, slope): (f64, f64)) -> (f64, f64) {
    (sin / depth, (cos * depth - sin * slope) / (depth * depth))
}

/// Returns an error unless all coefficients are finite.
pub(crate) fn finite(what: &'static str, coefficients: &[f64]) -> Result<(), LensError> {
    let Some(found) = coefficients.iter().find(|k| !k.is_finite()) else { return Ok(()) };
    LensError::unless(false, what, *found, "a finite number")
}
