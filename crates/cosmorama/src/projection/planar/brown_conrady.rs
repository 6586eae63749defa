use glam::{DMat2, DVec2, DVec3};

use crate::projection::azimuthal::LensError;
use crate::projection::monotone::{inverse, rises_until};
use crate::projection::{Perspective, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// A pinhole camera with lens distortion: Brown's model with Conrady's tangential terms, as in OpenCV
/// (`cv::calibrateCamera`, `cv::projectPoints`). The plane's unit is the focal length.
///
/// The field of view ends where the formula folds: at the angle from the axis beyond which two directions have the same
/// image in some bearing. Within it the mapping's derivative is positive definite on a disc, so each point has one
/// direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrownConrady {
    coefficients: BrownConradyCoefficients,
    /// Tangent of the angle from the axis at which the field of view ends.
    reach: f64,
    /// Whether it ends because the formula folds.
    folds: bool,
    /// Rectangle that holds the whole picture.
    bounds: PlaneRect,
    /// Greatest distance of a point of the picture from the middle.
    outermost: f64,
}

/// The coefficients of a [`BrownConrady`] lens in OpenCV's notation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrownConradyCoefficients {
    /// k1 to k6: (1 + k1 r² + k2 r⁴ + k3 r⁶)/(1 + k4 r² + k5 r⁴ + k6 r⁶).
    pub radial: [f64; 6],
    /// Tangential coefficients p1 and p2.
    pub tangential: [f64; 2],
    /// Thin prism coefficients s1 to s4.
    pub prism: [f64; 4],
}

/// Greatest angle of a pinhole camera from its axis, in radians; its tangent is about 10⁵.
const WIDEST: f64 = 1.570_786;

/// Bearings in which a fold is searched; distortions have at most three waves per turn.
const BEARINGS: usize = 64;

/// Limit of Newton steps. Each step doubles the digits, so a point that takes longer has no image.
const MOST_STEPS: usize = 40;

impl BrownConradyCoefficients {
    /// Returns coefficients in the order of OpenCV's vectors of 4, 5, 8 or 12: k1 k2 p1 p2, k3, k4 k5 k6, s1 s2 s3 s4.
    /// Missing ones are 0.
    pub fn from_opencv(numbers: &[f64]) -> Self {
        let at = |index: usize| numbers.get(index).copied().unwrap_or(0.0);
        Self {
            radial: [at(0), at(1), at(4), at(5), at(6), at(7)],
            tangential: [at(2), at(3)],
            prism: [at(8), at(9), at(10), at(11)],
        }
    }

    /// Returns the image of the point `u` (tangents of the angles from the axis, y down), and the derivative.
    fn bend(&self, u: DVec2) -> (DVec2, DMat2) {
        let [k1, k2, k3, k4, k5, k6] = self.radial;
        let ([p1, p2], [s1, s2, s3, s4]) = (self.tangential, self.prism);
        let t = u.length_squared();
        let (over, over_slope) = (1.0 + t * (k1 + t * (k2 + t * k3)), k1 + t * (2.0 * k2 + t * 3.0 * k3));
        let (under, under_slope) = (1.0 + t * (k4 + t * (k5 + t * k6)), k4 + t * (2.0 * k5 + t * 3.0 * k6));
        let scale = over / under;
        let scale_slope = (over_slope - scale * under_slope) / under;
        let DVec2 { x, y } = u;
        let bent = u * scale
            + DVec2::new(2.0 * p1 * x * y + p2 * (t + 2.0 * x * x), p1 * (t + 2.0 * y * y) + 2.0 * p2 * x * y)
            + DVec2::new(t * (s1 + t * s2), t * (s3 + t * s4));
        // ∂t = 2u.
        let (along_t, cross) = (2.0 * scale_slope, 2.0 * p1 * x + 2.0 * p2 * y);
        let prism = 2.0 * DVec2::new(s1 + 2.0 * t * s2, s3 + 2.0 * t * s4);
        let dx = DVec2::new(scale + along_t * x * x + 2.0 * p1 * y + 6.0 * p2 * x, along_t * x * y + cross);
        let dy = DVec2::new(along_t * x * y + cross, scale + along_t * y * y + 6.0 * p1 * y + 2.0 * p2 * x);
        (bent, DMat2::from_cols(dx + prism * x, dy + prism * y))
    }

    /// Returns the smallest eigenvalue of the symmetric part of the derivative at `u`: the formula folds where it is 0.
    fn least_gain(&self, u: DVec2) -> f64 {
        let (_, m) = self.bend(u);
        let (mean, half, cross) = (
            f64::midpoint(m.x_axis.x, m.y_axis.y),
            (m.x_axis.x - m.y_axis.y) / 2.0,
            f64::midpoint(m.x_axis.y, m.y_axis.x),
        );
        mean - half.hypot(cross)
    }

    fn radial_only(&self) -> bool {
        self.tangential == [0.0; 2] && self.prism == [0.0; 4]
    }

    /// Returns r times its radial scale, and the derivative.
    fn radius(&self, r: f64) -> (f64, f64) {
        let radial = Self { radial: self.radial, ..Self::default() };
        let (bent, slope) = radial.bend(DVec2::new(r, 0.0));
        (bent.x, slope.x_axis.x)
    }
}

impl BrownConrady {
    /// Returns the lens with these coefficients.
    ///
    /// # Errors
    /// When a coefficient is not finite, or the picture folds at the axis.
    pub fn new(coefficients: BrownConradyCoefficients) -> Result<Self, LensError> {
        let BrownConradyCoefficients { radial, tangential, prism } = coefficients;
        for numbers in [&radial[..], &tangential, &prism] {
            crate::projection::azimuthal::finite("a distortion coefficient", numbers)?;
        }
        // The integral of the gain along a bearing is the distance in the image, which rises while the gain is
        // positive.
        let bearings = if coefficients.radial_only() { 1 } else { BEARINGS };
        let gain = |angle: f64| {
            let around = |k: usize| DVec2::from_angle(k as f64 / bearings as f64 * std::f64::consts::TAU);
            let gains = (0..bearings).map(|k| coefficients.least_gain(around(k) * angle.tan()));
            gains.fold(f64::INFINITY, |least, gain| if gain.is_nan() { gain } else { least.min(gain) })
        };
        let end = rises_until(|angle| (angle, gain(angle)), WIDEST).ok_or(LensError::NoImage)?;
        let mut lens = Self {
            coefficients,
            reach: end.tan(),
            folds: end < WIDEST,
            bounds: PlaneRect::EVERYTHING,
            outermost: f64::INFINITY,
        };
        lens.bounds = lens.disc_bounds(DVec2::ZERO, lens.reach);
        lens.outermost = lens.outermost();
        Ok(lens)
    }

    /// Returns the angle from the axis, in radians, at which the field of view ends.
    pub fn reach(&self) -> f64 {
        self.reach.atan()
    }

    /// Returns whether the field of view ends because the formula folds.
    pub fn folds(&self) -> bool {
        self.folds
    }

    /// Returns the distance from the middle at which the picture ends to the right, in focal lengths.
    pub fn rim(&self) -> f64 {
        let (bent, _) = self.coefficients.bend(DVec2::new(self.reach, 0.0));
        bent.length()
    }

    /// Returns the tangents (y up) of the direction seen at a point.
    fn straightened(&self, point: PlanePoint) -> Option<DVec2> {
        let target = DVec2::new(point.x, -point.y);
        let start = self.first_guess(target)?;
        let straight = if self.coefficients.radial_only() { start } else { self.newton(start, target)? };
        (straight.length() <= self.reach).then(|| DVec2::new(straight.x, -straight.y))
    }

    /// Returns a starting point for Newton's iteration, exact for purely radial distortion.
    fn first_guess(&self, target: DVec2) -> Option<DVec2> {
        let distance = target.length();
        if distance == 0.0 {
            return Some(DVec2::ZERO);
        }
        let (farthest, _) = self.coefficients.radius(self.reach);
        if distance.is_nan() || distance > self.outermost || (self.coefficients.radial_only() && distance > farthest) {
            return None;
        }
        let radius = inverse(|r| self.coefficients.radius(r), distance.min(farthest), 0.0, self.reach);
        Some(target * (radius / distance))
    }

    /// Uses Newton's iteration, halving each step until it comes nearer; the derivative is positive definite
    /// throughout.
    fn newton(&self, start: DVec2, target: DVec2) -> Option<DVec2> {
        let mut at = start;
        let (mut bent, mut slope) = self.coefficients.bend(at);
        for _ in 0..MOST_STEPS {
            let error = bent - target;
            let mut step = slope.inverse() * error;
            if !step.is_finite() {
                return None;
            }
            // Iteration ends at the precision of f64, not at a tolerance.
            let negligible = step.length() <= 1e-9 * (1.0 + at.length());
            let mut next = at - step;
            let mut found = self.coefficients.bend(next);
            while !negligible && (found.0 - target).length() >= error.length() {
                step /= 2.0;
                if step.length() <= f64::EPSILON * (1.0 + at.length()) {
                    return None;
                }
                next = at - step;
                found = self.coefficients.bend(next);
            }
            at = next;
            (bent, slope) = found;
            if negligible {
                return Some(at);
            }
        }
        None
    }

    /// Returns the greatest distance of a rim point from the middle, plus a thousandth for the points between samples.
    fn outermost(&self) -> f64 {
        let around = |k: usize| DVec2::from_angle(k as f64 / (4 * BEARINGS) as f64 * std::f64::consts::TAU);
        let distance = |k: usize| self.coefficients.bend(around(k) * self.reach).0.length();
        1.001 * (0..4 * BEARINGS).map(distance).fold(0.0, f64::max)
    }

    /// Returns a rectangle that holds the image of a disc of tangents (y down).
    fn disc_bounds(&self, centre: DVec2, radius: f64) -> PlaneRect {
        let mut bounds: Option<PlaneRect> = None;
        for k in 0..BEARINGS {
            let around = DVec2::from_angle(k as f64 / BEARINGS as f64 * std::f64::consts::TAU);
            let (bent, _) = self.coefficients.bend(centre + around * radius);
            let point = PlanePoint::new(bent.x, -bent.y);
            bounds = Some(bounds.map_or(PlaneRect { min: point, max: point }, |bounds| bounds.with(point)));
        }
        let Some(PlaneRect { min, max }) = bounds else { return PlaneRect::EVERYTHING };
        // Between two of these points, the circle's image may go beyond both by a thousandth of its size.
        let spare = 0.02 * (max.x - min.x).max(max.y - min.y);
        PlaneRect {
            min: PlanePoint::new(min.x - spare, min.y - spare),
            max: PlanePoint::new(max.x + spare, max.y + spare),
        }
    }
}

impl Projection for BrownConrady {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let PlanePoint { x, y } = Perspective.project(direction)?;
        let straight = DVec2::new(x, -y);
        let (bent, _) = self.coefficients.bend(straight);
        (straight.length() <= self.reach).then(|| PlanePoint::new(bent.x, -bent.y))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        let straight = self.straightened(point)?;
        Perspective.unproject(PlanePoint::new(straight.x, straight.y))
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let straight = self.straightened(point)?;
        let (direction, seen) = Perspective.unproject_with_jacobian(PlanePoint::new(straight.x, straight.y))?;
        let inverse = self.derivative(straight).inverse();
        let along = |moved: DVec2| seen.dx * moved.x + seen.dy * moved.y;
        Some((direction, DirectionJacobian { dx: along(inverse.x_axis), dy: along(inverse.y_axis) }))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        let (straight, moved) = Perspective.project_with_derivatives(direction, tangents)?;
        let slope = self.derivative(DVec2::new(straight.x, straight.y));
        Some((self.project(direction)?, moved.map(|moved| slope * moved)))
    }

    fn margin(&self, direction: Direction) -> f64 {
        self.reach() - direction.angle_to(Direction::FRONT).radians()
    }

    fn has_steep_rim(&self) -> bool {
        self.folds
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let straight = Perspective.cap_bounds(centre, radius);
        let (min, max) = (DVec2::new(straight.min.x, -straight.max.y), DVec2::new(straight.max.x, -straight.min.y));
        let (middle, half) = ((min + max) / 2.0, (max - min).length() / 2.0);
        if middle.is_finite() && middle.length() + half <= self.reach {
            self.disc_bounds(middle, half)
        } else {
            self.bounds
        }
    }
}

impl BrownConrady {
    /// Returns ∂image/∂tangents, both with y up.
    fn derivative(&self, straight: DVec2) -> DMat2 {
        let (_, m) = self.coefficients.bend(DVec2::new(straight.x, -straight.y));
        DMat2::from_cols(DVec2::new(m.x_axis.x, -m.x_axis.y), DVec2::new(-m.y_axis.x, m.y_axis.y))
    }
}
