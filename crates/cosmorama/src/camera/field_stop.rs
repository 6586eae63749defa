use crate::projection::PlanePoint;
use crate::sphere::{Angle, Direction};

/// What limits a lens's field of view inside its image: a circle in the plane, a great circle, both or neither.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldStop {
    /// Radius of the limiting circle around the axis, in plane units.
    pub circle: Option<f64>,
    /// The visible side of a great circle: directions (in the view's frame) on this side of the plane at right angles.
    pub half_space: Option<Direction>,
}

impl FieldStop {
    /// Everything that the projection can show.
    pub const NONE: Self = Self { circle: None, half_space: None };

    /// A limiting circle.
    pub const fn circle(radius: f64) -> Self {
        Self { circle: Some(radius), half_space: None }
    }

    /// Cuts off what lies under the great circle that passes `lower` below the axis and through both sides: at 45° what
    /// stays is dir·up ≥ −dir·forward (Greene & Heckbert 1986).
    #[must_use]
    pub fn with_lower(self, lower: Angle) -> Self {
        let (sin, cos) = lower.sin_cos();
        Self { half_space: Some(Direction::from_unit(glam::DVec3::new(0.0, cos, -sin))), ..self }
    }

    /// Whether a point of the plane is inside; `direction` is what is seen there, asked for only if it matters.
    pub fn passes(&self, point: PlanePoint, direction: impl FnOnce() -> Option<Direction>) -> bool {
        let in_circle = self.circle.is_none_or(|radius| point.x * point.x + point.y * point.y <= radius * radius);
        in_circle && self.half_space.is_none_or(|side| direction().is_some_and(|direction| side.dot(direction) >= 0.0))
    }
}
