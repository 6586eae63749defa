/// A point of a projection's plane: x right, y up, in the projection's natural unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePoint {
    /// Distance to the right of the origin.
    pub x: f64,
    /// Distance above the origin.
    pub y: f64,
}

impl PlanePoint {
    /// Returns the point (x, y).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }
}

/// A rectangle of a projection's plane. An infinite side means that it is not bounded there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneRect {
    /// Least x and y.
    pub min: PlanePoint,
    /// Greatest x and y.
    pub max: PlanePoint,
}

impl PlaneRect {
    /// Returns the smallest rectangle that also holds a point.
    #[must_use]
    pub fn with(self, point: PlanePoint) -> Self {
        Self {
            min: PlanePoint::new(self.min.x.min(point.x), self.min.y.min(point.y)),
            max: PlanePoint::new(self.max.x.max(point.x), self.max.y.max(point.y)),
        }
    }

    /// The empty rectangle.
    pub(crate) const NOTHING: Self = Self {
        min: PlanePoint::new(f64::INFINITY, f64::INFINITY),
        max: PlanePoint::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The whole plane.
    pub const EVERYTHING: Self = Self {
        min: PlanePoint::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
        max: PlanePoint::new(f64::INFINITY, f64::INFINITY),
    };
}
