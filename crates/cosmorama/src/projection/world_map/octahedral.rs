use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use crate::projection::{Outline, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Mapping of the sphere to an octahedron.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OctahedralKind {
    /// Areas are proportional to solid angles (Clarberg 2008), as in pbrt's environment maps.
    #[default]
    EqualArea,
    /// Central projection along rays (Engelhardt & Dachsbacher 2008), as in game engines.
    Plain,
}

/// The sphere on an octahedron unfolded into a square, −1 to 1 both ways, with the front in the middle and the back in
/// all four corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Octahedral(pub OctahedralKind);

/// Half side of the square, with a tolerance for rounding.
const EDGE: f64 = 1.0 + 1e-9;

/// Greatest speed of a coordinate, per radian, in a quarter of the square.
const FASTEST: f64 = 1.42;

/// Folds the corner (x, y) of a quarter across its diagonal; the fold is its own inverse.
fn folded(x: f64, y: f64) -> (f64, f64) {
    (1.0 - y, 1.0 - x)
}

impl OctahedralKind {
    /// Returns the place of a direction without negative components in the quarter x + y ≤ 1.
    fn place(self, right: f64, up: f64, ahead: f64) -> (f64, f64) {
        match self {
            Self::Plain => {
                let length = right + up + ahead;
                (right / length, up / length)
            }
            Self::EqualArea => {
                // r = √(1 − ahead), without its loss of digits; the azimuth in quarters of a turn.
                let across2 = right * right + up * up;
                let radius = (across2 / (1.0 + ahead)).sqrt();
                // Computed from the nearer axis.
                let (x, y) = if up <= right {
                    let y = up.atan2(right) / FRAC_PI_2;
                    (1.0 - y, y)
                } else {
                    let x = right.atan2(up) / FRAC_PI_2;
                    (x, 1.0 - x)
                };
                (x * radius, y * radius)
            }
        }
    }

    /// Returns the direction (right, up, ahead) at a point of that quarter, and its derivatives.
    fn seen(self, x: f64, y: f64) -> [DVec3; 3] {
        match self {
            Self::Plain => {
                let vector = DVec3::new(x, y, 1.0 - x - y);
                let inverse_length = vector.length_recip();
                let unit = vector * inverse_length;
                let along = |step: DVec3| (step - unit * unit.dot(step)) * inverse_length;
                [unit, along(DVec3::new(1.0, 0.0, -1.0)), along(DVec3::new(0.0, 1.0, -1.0))]
            }
            Self::EqualArea => Self::equal_area(x, y),
        }
    }

    /// Computes the equal-area direction. With r = x + y: ahead = 1 − r², across = r √(2 − r²), azimuth = (π/2) y/r.
    fn equal_area(x: f64, y: f64) -> [DVec3; 3] {
        let radius = x + y;
        let part = if radius > 0.0 { y / radius } else { 0.0 };
        let (sin, cos) = (FRAC_PI_2 * part).sin_cos();
        let root = (2.0 - radius * radius).sqrt();
        let outwards = DVec3::new(cos, sin, 0.0) * (2.0 * (1.0 - radius * radius) / root) - DVec3::Z * (2.0 * radius);
        // The azimuth's derivatives are −(π/2) y/r² and (π/2) x/r²; times across, r √(2 − r²).
        let around = DVec3::new(-sin, cos, 0.0) * (FRAC_PI_2 * root);
        let unit = DVec3::new(cos * radius * root, sin * radius * root, (1.0 - radius) * (1.0 + radius));
        [unit, outwards - around * part, outwards + around * (1.0 - part)]
    }
}

/// Returns 1 with the sign of a number.
fn sign(value: f64) -> f64 {
    1f64.copysign(value)
}

impl Projection for Octahedral {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let (x, y) = self.0.place(vector.x.abs(), vector.y.abs(), vector.z.abs());
        let (x, y) = if vector.z > 0.0 { folded(x, y) } else { (x, y) };
        Some(PlanePoint::new(x * sign(vector.x), y * sign(vector.y)))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.unproject_with_jacobian(point).map(|(direction, _)| direction)
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let is_inside = point.x.abs() <= EDGE && point.y.abs() <= EDGE;
        is_inside.then(|| {
            let (x, y) = (point.x.abs().min(1.0), point.y.abs().min(1.0));
            let is_behind = x + y > 1.0;
            let (inner_x, inner_y) = if is_behind { folded(x, y) } else { (x, y) };
            let [unit, dx, dy] = self.0.seen(inner_x, inner_y);
            // Behind the diagonal, the inner x falls as y rises, and the other way round.
            let (dx, dy) = if is_behind { (-dy, -dx) } else { (dx, dy) };
            let signs = DVec3::new(sign(point.x), sign(point.y), if is_behind { 1.0 } else { -1.0 });
            let jacobian = DirectionJacobian { dx: dx * signs * signs.x, dy: dy * signs * signs.y };
            (Direction::from_unit(unit * signs), jacobian)
        })
    }

    /// Returns the angle to the nearest plane between faces of the octahedron, along which the mapping has creases.
    fn margin(&self, direction: Direction) -> f64 {
        direction.vector().abs().min_element()
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        self.cap_outline(centre, radius).bounds()
    }

    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        let vector = centre.vector();
        let (reach, sine) = (FASTEST * radius.radians(), radius.radians().min(FRAC_PI_2).sin());
        let (x, y) = self.0.place(vector.x.abs(), vector.y.abs(), vector.z.abs());
        let mut rects = Vec::new();
        let mut add = |x: f64, y: f64| {
            let corner = |by: f64| PlanePoint::new((x + by).clamp(-1.0, 1.0), (y + by).clamp(-1.0, 1.0));
            rects.push(PlaneRect { min: corner(-reach), max: corner(reach) });
        };
        // The front of the picture is in one piece. Behind, each quarter that the cap touches has its own piece.
        if vector.z - sine <= 0.0 {
            add(x * sign(vector.x), y * sign(vector.y));
        }
        if vector.z + sine > 0.0 {
            let (x, y) = folded(x, y);
            for (right, up) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                if vector.x * right >= -sine && vector.y * up >= -sine {
                    add(x * right, y * up);
                }
            }
        }
        Outline::Rects(rects)
    }
}
