use glam::DVec3;

use crate::camera::{PixelPoint, View};
use crate::sphere::DirectionJacobian;

/// Turn of a view about one axis, while it stays as it is otherwise.
#[derive(Clone, Debug)]
pub(super) struct Turning {
    /// Axis, in the world's frame.
    pub(super) axis: DVec3,
    /// Index of the view from which angles are counted.
    pub(super) middle: usize,
    /// Angle of each view about the axis, in radians.
    pub(super) angles: Vec<f64>,
}

/// Differences from a turn about one axis that are allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// Distance of a pixel from its way about the axis, in pixels, or in texels where those are larger.
    pub(super) place: f64,
    /// Relative difference of a pixel's size, and of its shape, from those of the pixel that the middle view has there.
    pub(super) size: f64,
}

/// Pixels each way at which views are measured.
const LATTICE: usize = 17;

impl Turning {
    /// Finds the axis of some views; `None` where they turn about several, change otherwise, or stand still. `texel` is the
    /// width of the world's finest texels in radians.
    pub(super) fn of(views: &[(View, f32)], texel: f64, tolerance: Tolerance) -> Option<Self> {
        let middle = views.len() / 2;
        let (lens, ends) = (&views[middle].0, [&views[0].0, &views[views.len() - 1].0]);
        if !views.iter().all(|(view, _)| view.is_alike(lens)) {
            return None;
        }
        let back = lens.orientation.rotation().inverse();
        let turns: Vec<DVec3> = views.iter().map(|(view, _)| turn(view.orientation.rotation() * back)).collect();
        let axis = (turns[views.len() - 1] - turns[0]).try_normalize()?;
        let angles: Vec<f64> = turns.iter().map(|turn| turn.dot(axis)).collect();
        let off = turns.iter().zip(&angles).map(|(turn, angle)| (*turn - axis * *angle).length()).fold(0.0, f64::max);
        let finest = lattice(lens)
            .filter_map(|point| lens.texel(point))
            .map(|pixel| minor(&pixel))
            .filter(|minor| *minor > 0.0)
            .fold(f64::MAX, f64::min);
        let is_near = off < tolerance.place * finest.max(texel);
        let is_even =
            || ends.iter().all(|view| lattice(view).all(|point| is_of_size(lens, view, point, tolerance.size)));
        (is_near && is_even()).then_some(Self { axis, middle, angles })
    }
}

/// Returns a turn as its axis times its angle. [`DQuat::to_scaled_axis`](glam::DQuat::to_scaled_axis) loses half of a small angle's digits.
fn turn(rotation: glam::DQuat) -> DVec3 {
    let vector = DVec3::new(rotation.x, rotation.y, rotation.z) * rotation.w.signum();
    let sine = vector.length();
    if sine > 0.0 { vector * (2.0 * sine.atan2(rotation.w.abs()) / sine) } else { vector }
}

/// Returns points all over a view, its corners among them.
pub(super) fn lattice(view: &View) -> impl Iterator<Item = PixelPoint> + '_ {
    let place = |k: usize, size: usize| size as f64 * k as f64 / (LATTICE - 1) as f64;
    (0..LATTICE * LATTICE)
        .map(move |k| PixelPoint::new(place(k % LATTICE, view.width()), place(k / LATTICE, view.height())))
}

/// Returns a bound of a pixel's shorter axis in radians, at most √2 times too short.
fn minor(jacobian: &DirectionJacobian) -> f64 {
    let major = (jacobian.dx.length_squared() + jacobian.dy.length_squared()).sqrt();
    if major > 0.0 { jacobian.solid_angle() / major } else { 0.0 }
}

/// Returns whether a view's pixel is as large as that of the lens in its direction, and of its shape.
fn is_of_size(lens: &View, view: &View, point: PixelPoint, tolerance: f64) -> bool {
    // On the very poles of a panorama a pixel has no size.
    let Some((direction, own)) = view.direction(point).zip(view.texel(point)).filter(|(_, own)| minor(own) > 0.0)
    else {
        return true;
    };
    let axes = || {
        let there = lens.texel(lens.pixel(direction)?)?;
        Some([there.pseudo_inverse(own.dx)?, there.pseudo_inverse(own.dy)?])
    };
    let Some([x, y]) = axes() else { return false };
    // Covariance of the own pixel in pixels of the lens, less that of the lens: variances differ by twice as much as sizes.
    let off = [x.x * x.x + y.x * y.x - 1.0, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y - 1.0];
    off.iter().all(|off| off.abs() < 2.0 * tolerance)
}
