//! Fisheye lenses: the angle from the axis is a function of the radius in the picture.

mod arc_sine;
mod ball;
mod by_angle;
mod by_radius;
mod double_sphere;
mod equidistant;
mod equisolid;
mod field_of_view;
mod fisheye_lens;
mod hugin;
mod kannala_brandt;
mod lens;
mod ocam;
mod omnimax;
mod orthographic;
mod polynomial;
mod stereographic;
mod unified;

pub use ball::BallLens;
pub use by_angle::ByAngle;
pub use by_radius::ByRadius;
pub use double_sphere::DoubleSphere;
pub use equidistant::Equidistant;
pub use equisolid::Equisolid;
pub use field_of_view::FieldOfViewLens;
pub use fisheye_lens::FisheyeLens;
pub use hugin::{Hugin, HuginIdeal};
pub use kannala_brandt::KannalaBrandt;
pub use lens::{Lens, LensError};
pub use ocam::{OCAM_COEFFICIENTS, Ocam};
pub use omnimax::OmnimaxLens;
pub use orthographic::Orthographic;
pub use polynomial::Polynomial;
pub use stereographic::Stereographic;
pub use unified::Unified;

use std::f64::consts::PI;

use glam::DVec3;

use super::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// The projection of a [`Lens`]: the plane's unit is the lens's own unit of radius, its origin the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Azimuthal<L>(pub L);

impl<L: Lens> Projection for Azimuthal<L> {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let sine = length(vector.x, vector.y);
        let radius = self.0.radius(sine.atan2(-vector.z))?;
        if sine == 0.0 {
            // Straight behind is the whole rim: any point of it will do.
            return Some(PlanePoint::new(radius, 0.0));
        }
        Some(PlanePoint::new(vector.x / sine * radius, vector.y / sine * radius))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.unproject_with_jacobian(point).map(|(direction, _)| direction)
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let radius = length(point.x, point.y);
        let (angle, slope) = self.0.angle(radius);
        // A NaN is no angle either.
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
        let axis_angle = Direction::FRONT.angle_to(centre);
        // No further than there is an image: what sees more of a cap than the rim's circle holds does not see all of it.
        let Some(outer) = self.0.radius((axis_angle + radius).radians().min(self.0.reach())) else {
            return PlaneRect::EVERYTHING;
        };
        if axis_angle <= radius || (axis_angle + radius).degrees() >= 180.0 {
            return PlaneRect { min: PlanePoint::new(-outer, -outer), max: PlanePoint::new(outer, outer) };
        }
        // A ring sector: between two radii, and as wide as the cap is in azimuth.
        let inner = self.0.radius((axis_angle - radius).radians()).unwrap_or(0.0);
        let azimuth = centre.vector().y.atan2(centre.vector().x);
        let half_width = (radius.radians().sin() / axis_angle.radians().sin()).min(1.0).asin();
        let (min_cos, max_cos) = cosine_range(azimuth, half_width);
        let (min_sin, max_sin) = cosine_range(azimuth - std::f64::consts::FRAC_PI_2, half_width);
        let low = |c: f64| if c < 0.0 { c * outer } else { c * inner };
        let high = |c: f64| if c > 0.0 { c * outer } else { c * inner };
        PlaneRect {
            min: PlanePoint::new(low(min_cos), low(min_sin)),
            max: PlanePoint::new(high(max_cos), high(max_sin)),
        }
    }
}

/// Least and greatest cosine of the angles within `half_width` ≤ π/2 of `centre`.
fn cosine_range(centre: f64, half_width: f64) -> (f64, f64) {
    use std::f64::consts::TAU;
    let (a, b) = ((centre - half_width).cos(), (centre + half_width).cos());
    let reaches = |angle: f64| (centre - angle + PI).rem_euclid(TAU) - PI;
    let min = if reaches(PI).abs() <= half_width { -1.0 } else { a.min(b) };
    let max = if reaches(0.0).abs() <= half_width { 1.0 } else { a.max(b) };
    (min, max)
}

/// √(x² + y²) for coordinates that cannot overflow: several times faster than `hypot`.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// sin φ/depth(φ) and its derivative, of (sin φ, cos φ) and of the depth with its derivative.
fn ratio((sin, cos): (f64, f64), (depth, slope): (f64, f64)) -> (f64, f64) {
    (sin / depth, (cos * depth - sin * slope) / (depth * depth))
}

/// All coefficients are numbers.
pub(super) fn finite(what: &'static str, coefficients: &[f64]) -> Result<(), LensError> {
    let Some(found) = coefficients.iter().find(|k| !k.is_finite()) else { return Ok(()) };
    LensError::unless(false, what, *found, "a finite number")
}
