use glam::DVec3;

use super::Angle;

/// A direction from the centre of the world: a unit vector, never a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(DVec3);

impl Direction {
    /// −Z, the direction in which an unturned view looks.
    pub const FRONT: Self = Self(DVec3::NEG_Z);
    /// +Z.
    pub const BACK: Self = Self(DVec3::Z);
    /// +X.
    pub const RIGHT: Self = Self(DVec3::X);
    /// −X.
    pub const LEFT: Self = Self(DVec3::NEG_X);
    /// +Y.
    pub const UP: Self = Self(DVec3::Y);
    /// −Y.
    pub const DOWN: Self = Self(DVec3::NEG_Y);

    /// Returns the direction of a vector, which need not have length one; `None` for zero, NaN or infinity.
    pub fn new(vector: DVec3) -> Option<Self> {
        vector.try_normalize().map(Self)
    }

    /// Returns the direction of a vector that already has length one, up to rounding.
    pub fn from_unit(unit: DVec3) -> Self {
        debug_assert!((unit.length_squared() - 1.0).abs() < 1e-9, "{unit}");
        Self(unit)
    }

    /// Returns the direction of a longitude (0 at the front, positive to the right) and a latitude (positive up).
    pub fn from_longitude_latitude(longitude: Angle, latitude: Angle) -> Self {
        let (sin_lon, cos_lon) = longitude.sin_cos();
        let (sin_lat, cos_lat) = latitude.sin_cos();
        Self(DVec3::new(sin_lon * cos_lat, sin_lat, -cos_lon * cos_lat))
    }

    /// Returns `count` directions spread evenly over the sphere along a spiral (a Fibonacci lattice).
    pub fn spread(count: usize) -> impl Iterator<Item = Self> {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        (0..count).map(move |k| {
            let y = 1.0 - (2 * k + 1) as f64 / count as f64;
            let (sin, cos) = (golden * k as f64).sin_cos();
            let radius = (1.0 - y * y).sqrt();
            Self(DVec3::new(radius * sin, y, -radius * cos))
        })
    }

    /// Returns longitude (0 at the front, −180° to 180°, positive to the right) and latitude (positive up). They are
    /// the yaw and pitch of a camera that looks this way.
    pub fn longitude_latitude(self) -> (Angle, Angle) {
        let longitude = self.0.x.atan2(-self.0.z);
        let latitude = self.0.y.atan2(self.0.x.hypot(self.0.z));
        (Angle::from_radians(longitude), Angle::from_radians(latitude))
    }

    /// Returns the unit vector.
    pub const fn vector(self) -> DVec3 {
        self.0
    }

    /// Returns the opposite direction.
    #[must_use]
    pub fn opposite(self) -> Self {
        Self::from_unit(-self.vector())
    }

    /// Returns the cosine of the angle to another direction.
    pub fn dot(self, other: Self) -> f64 {
        self.0.dot(other.0)
    }

    /// Returns the angle to another direction, exact for small and large angles alike.
    pub fn angle_to(self, other: Self) -> Angle {
        // Between near directions: the series of 2 asin(chord/2), of which the next term is less than rounding.
        let squared = self.0.distance_squared(other.0);
        if squared < 1e-3 {
            let series = 1.0 + squared * (1.0 / 24.0 + squared * (3.0 / 640.0 + squared * (5.0 / 7168.0)));
            return Angle::from_radians(squared.sqrt() * series);
        }
        let sine = self.0.cross(other.0).length();
        Angle::from_radians(sine.atan2(self.dot(other)))
    }
}

/// Derivatives ∂direction/∂(x, y) of a direction with respect to a point of a plane or a pixel of a screen. Both
/// columns are tangent to the sphere at the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionJacobian {
    /// Change of the direction for a unit step along x.
    pub dx: DVec3,
    /// Change of the direction for a unit step along y.
    pub dy: DVec3,
}

impl DirectionJacobian {
    /// Returns the solid angle covered by a unit square of the plane, in steradians (to first order).
    pub fn solid_angle(&self) -> f64 {
        self.dx.cross(self.dy).length()
    }

    /// Returns the step in the plane that moves the direction by `tangent`, of which only the part in the tangent plane
    /// counts. `None` where the mapping is singular.
    pub fn pseudo_inverse(&self, tangent: DVec3) -> Option<glam::DVec2> {
        // Cramer's rule on areas in the tangent plane. The normal equations JᵀJ would square the condition number, which
        // near the rim of a lens that sees almost all of the sphere costs half of the digits.
        let normal = self.dx.cross(self.dy);
        let determinant = normal.length_squared();
        if determinant <= 1e-24 * self.dx.length_squared() * self.dy.length_squared() {
            return None;
        }
        let (x, y) = (tangent.cross(self.dy).dot(normal), self.dx.cross(tangent).dot(normal));
        Some(glam::DVec2::new(x, y) / determinant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_exact_whether_small_or_large() {
        let from = Direction::from_longitude_latitude(Angle::from_degrees(30.0), Angle::from_degrees(40.0));
        let (across, _) = from.vector().any_orthonormal_pair();
        // 0.0316 is where the formula changes.
        for radians in [0.0, 1e-9, 1e-4, 0.01, 0.0316, 0.03163, 0.032, 1.0, 3.0, std::f64::consts::PI] {
            let to = Direction::from_unit(from.vector() * f64::cos(radians) + across * f64::sin(radians));
            let found = from.angle_to(to).radians();
            assert!((found - radians).abs() < 4e-16, "{found}, not {radians}");
        }
    }
}
