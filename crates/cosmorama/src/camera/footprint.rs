use std::ops::{Add, Mul};

use glam::{DMat2, DMat3, DVec2, DVec3};

use crate::sphere::{Direction, DirectionJacobian};

/// A small part of the sphere around a direction, to first order: the part of the world that a pixel, a reflected ray
/// or a reflection lobe sees.
///
/// Two derivatives span it: the change of the direction for one pixel to the right (`dx`) and one pixel down (`dy`), in
/// radians. A filter's kernel covers the parallelogram of the two, so its unit is one pixel. Filters use only the
/// ellipse that the two span; the reference filter, which takes sub-samples, also uses their orientation.
///
/// As a Gaussian, a footprint has a standard deviation of half a pixel ([`Footprint::covariance`]). Roughness and
/// motion blur widen it: their variances are added.
///
/// ```
/// use cosmorama::camera::{Covariance, Footprint};
/// use cosmorama::sphere::{Angle, Direction};
/// use glam::DVec3;
///
/// // A pixel of 0.001 radians that looks to the front …
/// let pixel = Footprint::new(Direction::FRONT, DVec3::X * 0.001, DVec3::NEG_Y * 0.001);
/// // … through a glass whose lobe has a standard deviation of one degree.
/// let sigma = Angle::from_degrees(1.0).radians();
/// let blurred = pixel.widened_by(Covariance::round(Direction::FRONT, sigma * sigma));
/// let width = blurred.jacobian.dx.length();
/// assert!((width - f64::hypot(0.001, 2.0 * sigma)).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Direction of its centre, in the world's frame.
    pub direction: Direction,
    /// Derivatives of the direction per pixel, in the world's frame.
    pub jacobian: DirectionJacobian,
}

/// Standard deviations per pixel: Greene & Heckbert's Gaussian exp(−2r²) has a standard deviation of half a pixel.
const DEVIATIONS: f64 = 2.0;

impl Footprint {
    /// Returns the footprint of a direction and its derivatives per pixel. The derivatives' parts along the direction
    /// are dropped.
    pub fn new(direction: Direction, dx: DVec3, dy: DVec3) -> Self {
        let tangent = |vector: DVec3| vector - direction.vector() * direction.vector().dot(vector);
        Self { direction, jacobian: DirectionJacobian { dx: tangent(dx), dy: tangent(dy) } }
    }

    /// Returns the footprint of a single direction, of no extent; filters interpolate the texels around it.
    pub fn point(direction: Direction) -> Self {
        Self { direction, jacobian: DirectionJacobian { dx: DVec3::ZERO, dy: DVec3::ZERO } }
    }

    /// Returns the footprint whose Gaussian has this covariance. Each derivative is an axis of its ellipse, two
    /// standard deviations long; `dx` is the longer one.
    ///
    /// [`Footprint::covariance`] is the inverse, up to rounding.
    pub fn from_covariance(direction: Direction, covariance: Covariance) -> Self {
        let basis = tangent_basis(direction);
        let DMat2 { x_axis: DVec2 { x: p, y: q }, y_axis: DVec2 { y: r, .. } } = covariance.within(basis);
        // (p q; q r) = mean·1 + spread·(cos 2θ, sin 2θ; sin 2θ, −cos 2θ), θ being the longer axis's angle.
        let spread = f64::hypot((p - r) / 2.0, q);
        let major = (p + r) / 2.0 + spread;
        // Not mean − spread, which loses a thin ellipse's minor axis to rounding.
        let minor = if major > 0.0 { (p * r - q * q).max(0.0) / major } else { 0.0 };
        let along = DVec2::from_angle(0.5 * q.atan2((p - r) / 2.0));
        let axis =
            |at: DVec2, variance: f64| (basis[0] * at.x + basis[1] * at.y) * (DEVIATIONS * variance.max(0.0).sqrt());
        Self { direction, jacobian: DirectionJacobian { dx: axis(along, major), dy: axis(along.perp(), minor) } }
    }

    /// Returns the covariance of the footprint's Gaussian in radians²; its standard deviation is half a pixel.
    pub fn covariance(&self) -> Covariance {
        let DirectionJacobian { dx, dy } = self.jacobian;
        (Covariance::along(dx) + Covariance::along(dy)) * (DEVIATIONS * DEVIATIONS).recip()
    }

    /// Returns the footprint blurred by another Gaussian, whose covariance is added.
    #[must_use]
    pub fn widened_by(&self, covariance: Covariance) -> Self {
        Self::from_covariance(self.direction, self.covariance() + covariance)
    }

    /// Returns the circle of the same area, turned as the footprint is: its axes are as long as each other, and perpendicular.
    /// A footprint without area stays as it is.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let DirectionJacobian { dx, dy } = self.jacobian;
        let normal = dx.cross(dy);
        let area = normal.length();
        // The rotation of the polar decomposition: `dy` turned back by a right angle lies along `dx`, but for the shear.
        let Some(along) = (dx * area + dy.cross(normal)).try_normalize() else { return *self };
        let jacobian = DirectionJacobian { dx: along * area.sqrt(), dy: normal.cross(along) / area.sqrt() };
        Self { jacobian, ..*self }
    }

    /// Returns the direction at an offset from the centre, in pixels. Lengths on the tangent plane become lengths along
    /// great circles. `None` beyond half a turn.
    pub fn direction_at(&self, x: f64, y: f64) -> Option<Direction> {
        let offset = self.jacobian.dx * x + self.jacobian.dy * y;
        let angle = offset.length();
        if angle == 0.0 {
            return Some(self.direction);
        }
        let (sin, cos) = angle.sin_cos();
        let there = self.direction.vector() * cos + offset * (sin / angle);
        if angle <= std::f64::consts::PI { Direction::new(there) } else { None }
    }
}

/// Spread of directions around a direction, in radians²: a symmetric matrix on the plane tangent to the sphere.
///
/// The matrix is held in the world's frame, where it maps vectors along the direction to zero; so it needs no basis of
/// the tangent plane. [`Covariance::within`] gives its four numbers in any basis. Covariances around one direction add.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Covariance(DMat3);

impl Covariance {
    /// No spread.
    pub const ZERO: Self = Self(DMat3::ZERO);

    /// Returns the covariance of a round lobe: one variance, in radians², along all tangents of a direction.
    pub fn round(direction: Direction, variance: f64) -> Self {
        let [right, up] = tangent_basis(direction);
        (Self::along(right) + Self::along(up)) * variance
    }

    /// Returns the covariance of a spread along one tangent vector, whose length is the standard deviation in radians.
    /// For a path traversed at constant speed the standard deviation is its length divided by √12.
    pub fn along(tangent: DVec3) -> Self {
        Self(DMat3::from_cols(tangent * tangent.x, tangent * tangent.y, tangent * tangent.z))
    }

    /// Returns the covariance with these components in a basis of the tangent plane.
    pub fn from_matrix([right, up]: [DVec3; 2], matrix: DMat2) -> Self {
        let (p, q, r) = (matrix.x_axis.x, 0.5 * (matrix.x_axis.y + matrix.y_axis.x), matrix.y_axis.y);
        let column = |x: f64, y: f64| (right * p + up * q) * x + (right * q + up * r) * y;
        Self(DMat3::from_cols(column(right.x, up.x), column(right.y, up.y), column(right.z, up.z)))
    }

    /// Returns the components in an orthonormal basis of the tangent plane.
    pub fn within(&self, basis: [DVec3; 2]) -> DMat2 {
        let row = |axis: DVec3| DVec2::new((self.0 * axis).dot(basis[0]), (self.0 * axis).dot(basis[1]));
        DMat2::from_cols(row(basis[0]), row(basis[1]))
    }
}

impl Add for Covariance {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Mul<f64> for Covariance {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

/// Returns two perpendicular unit tangents of a direction.
fn tangent_basis(direction: Direction) -> [DVec3; 2] {
    let (right, up) = direction.vector().any_orthonormal_pair();
    [right, up]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn footprints() -> impl Iterator<Item = Footprint> {
        Direction::spread(200).enumerate().map(|(k, direction)| {
            let (right, up) = direction.vector().any_orthonormal_pair();
            let (sin, cos) = (k as f64).sin_cos();
            let (long, short) = (0.3, 0.3 * 0.7f64.powi(k as i32 % 30));
            Footprint::new(direction, (right * cos + up * sin) * long, (up - right * 0.3) * short)
        })
    }

    fn close(a: Covariance, b: Covariance) -> bool {
        a.0.abs_diff_eq(b.0, 1e-12)
    }

    #[test]
    fn covariances_come_back() {
        for footprint in footprints() {
            let again = Footprint::from_covariance(footprint.direction, footprint.covariance());
            assert!(close(again.covariance(), footprint.covariance()), "{footprint:?}, {again:?}");
            let DirectionJacobian { dx, dy } = again.jacobian;
            assert!(dx.dot(dy).abs() < 1e-12 && dx.length() >= dy.length(), "{again:?}");
            assert!(dx.dot(again.direction.vector()).abs() < 1e-12);
            let basis = tangent_basis(footprint.direction);
            assert!(close(Covariance::from_matrix(basis, again.covariance().within(basis)), again.covariance()));
        }
    }

    #[test]
    fn covariances_add() {
        for footprint in footprints() {
            let sum = footprint.widened_by(Covariance::round(footprint.direction, 0.01));
            for axis in tangent_basis(footprint.direction) {
                let along = |footprint: &Footprint| (footprint.covariance().0 * axis).dot(axis);
                assert!((along(&sum) - along(&footprint) - 0.01).abs() < 1e-12);
            }
        }
        let point = Footprint::point(Direction::UP);
        assert_eq!(point.covariance(), Covariance::ZERO);
        assert_eq!(point.widened_by(Covariance::ZERO), point);
    }

    /// Checks that circles have the area and the side of their footprints, and that circles stay what they are.
    #[test]
    fn rounded_footprints_are_circles_of_their_area() {
        for footprint in footprints() {
            let DirectionJacobian { dx, dy } = footprint.jacobian;
            let circle = footprint.rounded();
            let DirectionJacobian { dx: across, dy: down } = circle.jacobian;
            let area = dx.cross(dy);
            assert!(across.cross(down).distance(area) < 1e-12 && across.dot(down).abs() < 1e-12, "{footprint:?}");
            assert!((across.length() - down.length()).abs() < 1e-12 && dx.dot(across) > 0.0 && dy.dot(down) > 0.0);
            let again = circle.rounded().jacobian;
            assert!(again.dx.distance(across) < 1e-12 && again.dy.distance(down) < 1e-12, "{footprint:?}");
        }
        let point = Footprint::point(Direction::UP);
        assert_eq!(point.rounded(), point);
    }

    #[test]
    fn offsets_go_along_great_circles() {
        for footprint in footprints() {
            for (x, y) in [(0.0, 0.0), (1.0, 0.0), (-0.5, 2.0), (3.0, -3.0)] {
                let offset = footprint.jacobian.dx * x + footprint.jacobian.dy * y;
                let found = footprint.direction_at(x, y).expect("less than half a turn");
                assert!((found.angle_to(footprint.direction).radians() - offset.length()).abs() < 1e-12);
                let (found, ahead) = (found.vector(), offset.normalize_or_zero());
                assert!((found.dot(ahead) - offset.length().sin()).abs() < 1e-12);
            }
        }
        assert_eq!(Footprint::new(Direction::UP, DVec3::X * 4.0, DVec3::ZERO).direction_at(1.0, 0.0), None);
    }
}
