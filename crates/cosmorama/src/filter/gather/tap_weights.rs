use glam::DVec2;

use super::candidate::Candidate;
use crate::filter::kernel::UNDER;
use crate::filter::rim::clamp_set;
use crate::filter::taps::{Tap, Taps};
use crate::sphere::DirectionJacobian;

/// Turns candidates into taps whose weights add to one, or into none if their sum would be noise. With `centred`, the
/// taps' centroid is the pixel's centre. `rim` is given where views or the field end under the pixel or beside it. It
/// holds the footprint's derivatives, which tell how a slope continues there.
pub(crate) fn settle(candidates: &mut [Candidate], centred: bool, rim: Option<&DirectionJacobian>, taps: &mut Taps) {
    soften(candidates);
    let correction = if centred { Correction::centring(candidates) } else { Correction::default() };
    let surrounding = if rim.is_none() { clamp_set::reach(candidates) } else { None };
    let reach = surrounding.unwrap_or(UNDER as f32);
    let (mut sum, mut size, mut under) = (0f64, 0f64, 0);
    for candidate in candidates.iter_mut() {
        candidate.weight += correction.of(candidate);
        sum += f64::from(candidate.weight);
        size += f64::from(candidate.weight.abs());
        under += usize::from(candidate.q < reach);
    }
    // Where only negative lobes reach a texel, beside a missing face, there is no average.
    if sum <= 0.05 * size {
        return;
    }
    let scale = sum.recip() as f32;
    let settled = candidates.iter().map(|c| (c.q < reach, Tap { texel: c.texel, weight: c.weight * scale }));
    taps.fill(settled, candidates.len(), under);
    if let Some(jacobian) = rim {
        let (under, around) = (candidates.iter().filter(|c| c.q < reach), candidates.iter().filter(|c| c.q >= reach));
        let places = Places::of(jacobian);
        taps.set_places(under.chain(around).map(|candidate| places.at(candidate.offset)));
    }
}

/// Map from screen offsets, in pixels, to places in the plane tangent to the sphere, in radians.
struct Places {
    dx: [f32; 2],
    dy: [f32; 2],
}

impl Places {
    /// Returns the map around a footprint's centre.
    fn of(jacobian: &DirectionJacobian) -> Self {
        let (length, along) = (jacobian.dx.length(), jacobian.dx.dot(jacobian.dy) / jacobian.dx.length());
        let across = jacobian.dx.cross(jacobian.dy).length() / length;
        Self { dx: [length as f32, 0.0], dy: [along as f32, across as f32] }
    }

    fn at(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [x * self.dx[0] + y * self.dy[0], x * self.dx[1] + y * self.dy[1]]
    }
}

/// Least sum of the weights, as a part of the sum of their absolute values. On a single lattice it is much more.
const LEAST_SUM: f32 = 0.3;

/// Blends the weights towards positive ones where they nearly cancel. Where a fine view meets a coarse one, a few large
/// texels in the negative lobe can nearly cancel the small ones under the pixel.
fn soften(candidates: &mut [Candidate]) {
    let (mut sum, mut size) = (0f32, 0f32);
    for candidate in candidates.iter() {
        sum += candidate.weight;
        size += candidate.weight.abs();
    }
    let part = 1.0 - sum / (LEAST_SUM * size);
    // Beside a missing face there may be nothing but negative lobes.
    if part <= 0.0 || !candidates.iter().any(Candidate::is_under) {
        return;
    }
    for candidate in candidates {
        candidate.weight += part.min(1.0) * (candidate.window - candidate.weight);
    }
}

/// Least determinant of the texels' second moments, as a part of the product of their variances. Below it, the texels
/// are taken to lie in a line. Rounding to single precision leaves about 1e-7.
pub(crate) const THINNEST: f32 = 1e-6;

/// Correction that makes the weights' centroid the pixel's centre and keeps their sum. It adds v·g·(p − p̄) to the
/// weight of a texel with window v at offset p, where p̄ is the mean offset weighted by v.
///
/// A radial kernel on a lattice of texels weighs one side a little more than the other. That shifts the picture by up
/// to 0.17 of a pixel. A correction linear in the offset p is the one of moving least squares (Lancaster & Salkauskas
/// 1981). It reproduces exactly a world whose colour is linear in the screen's coordinates.
#[derive(Clone, Copy, Debug, Default)]
struct Correction {
    gradient: [f32; 2],
    constant: f32,
}

impl Correction {
    fn centring(candidates: &[Candidate]) -> Self {
        let (mut window, mut window_p, mut weight_p) = (0f32, [0f32; 2], [0f32; 2]);
        let (mut xx, mut xy, mut yy) = (0f32, 0f32, 0f32);
        for candidate in candidates {
            let [x, y] = candidate.offset;
            let windowed = [x * candidate.window, y * candidate.window];
            window += candidate.window;
            window_p = [window_p[0] + windowed[0], window_p[1] + windowed[1]];
            weight_p = [weight_p[0] + x * candidate.weight, weight_p[1] + y * candidate.weight];
            xx += windowed[0] * x;
            xy += windowed[0] * y;
            yy += windowed[1] * y;
        }
        let mean = DVec2::new(window_p[0].into(), window_p[1].into()) / f64::from(window);
        let xx = f64::from(xx) - f64::from(window_p[0]) * mean.x;
        let xy = f64::from(xy) - f64::from(window_p[0]) * mean.y;
        let yy = f64::from(yy) - f64::from(window_p[1]) * mean.y;
        let determinant = xx * yy - xy * xy;
        if determinant.is_nan() || determinant <= f64::from(THINNEST) * xx * yy {
            // All texels lie in one line, so that the centroid cannot be moved.
            return Self::default();
        }
        let p = DVec2::new(weight_p[0].into(), weight_p[1].into());
        let gradient = DVec2::new(xy * p.y - yy * p.x, xy * p.x - xx * p.y) / determinant;
        Self { gradient: [gradient.x as f32, gradient.y as f32], constant: -gradient.dot(mean) as f32 }
    }

    fn of(&self, candidate: &Candidate) -> f32 {
        let [x, y] = candidate.offset;
        candidate.window * (self.gradient[0] * x + self.gradient[1] * y + self.constant)
    }
}
