use crate::projection::PlanePoint;
use crate::sphere::{Angle, Direction};

/// Limits of a lens's field of view inside its image: a circle in the plane, a great circle, both or neither.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldStop {
    /// Radius of the limiting circle around the axis, in plane units.
    pub circle: Option<f64>,
    /// Normal of the limiting great circle, in the view's frame: directions on its side of the plane are visible.
    pub half_space: Option<Direction>,
}

impl FieldStop {
    /// No limit: everything that the projection can show is visible.
    pub const NONE: Self = Self { circle: None, half_space: None };

    /// Returns a stop that is a limiting circle.
    pub const fn circle(radius: f64) -> Self {
        Self { circle: Some(radius), half_space: None }
    }

    /// Hides everything below the great circle that passes `lower` below the axis and through both sides. At 45° the
    /// visible part is dir·up ≥ −dir·forward (Greene & Heckbert 1986).
    #[must_use]
    pub fn with_lower(self, lower: Angle) -> Self {
        let (sin, cos) = lower.sin_cos();
        Self { half_space: Some(Direction::from_unit(glam::DVec3::new(0.0, cos, -sin))), ..self }
    }

    /// Returns whether a point of the plane is visible. `direction`, the direction seen there, is called only if a
    /// great circle limits the field.
    pub fn passes(&self, point: PlanePoint, direction: impl FnOnce() -> Option<Direction>) -> bool {
        let in_circle = self.circle.is_none_or(|radius| point.x * point.x + point.y * point.y <= radius * radius);
        in_circle && self.half_space.is_none_or(|side| direction().is_some_and(|direction| side.dot(direction) >= 0.0))
    }
}
