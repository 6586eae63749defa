use glam::DVec2;

use crate::raster::{Image, Rgba};

/// The brightness of a picture, in code values: that of its brightest channel.
pub(super) struct Brightness<'a> {
    codes: &'a Image<Rgba>,
    /// Level of black.
    pub(super) black: f64,
    /// Level above black up to which pixels count as black.
    pub(super) least: f64,
}

/// Greatest level of black.
const BLACK: f64 = 0.2;
/// Least difference from black of a picture's content: a few 8-bit codes.
const LEAST: f64 = 3.0 / 255.0;

impl<'a> Brightness<'a> {
    /// Wraps a picture with at least one black corner; `None` for others.
    pub(super) fn new(codes: &'a Image<Rgba>) -> Option<Self> {
        let (width, height) = (codes.width(), codes.height());
        let side = (width.min(height) / 40).max(2);
        if width.min(height) < 16 {
            return None;
        }
        let corner = |left: usize, top: usize| {
            let places = (0..side * side).map(|k| (left + k % side, top + k / side));
            let mut values: Vec<f64> = places.map(|(i, j)| brightness(codes.get(i, j))).collect();
            values.sort_by(f64::total_cmp);
            (values[values.len() / 2], values[values.len() * 9 / 10])
        };
        let corners = [(0, 0), (width - side, 0), (0, height - side), (width - side, height - side)];
        let (black, high) =
            corners.map(|(left, top)| corner(left, top)).into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        (black < BLACK).then_some(Self { codes, black, least: LEAST.max(4.0 * (high - black)) })
    }

    pub(super) fn size(&self) -> (usize, usize) {
        (self.codes.width(), self.codes.height())
    }

    pub(super) fn is_black(&self, i: usize, j: usize) -> bool {
        brightness(self.codes.get(i, j)) - self.black < self.least
    }

    /// Interpolates linearly between pixel centres; `None` outside.
    fn at(&self, point: DVec2) -> Option<f64> {
        let (x, y) = (point.x - 0.5, point.y - 0.5);
        let (width, height) = self.size();
        if x < 0.0 || y < 0.0 || x > (width - 1) as f64 || y > (height - 1) as f64 {
            return None;
        }
        let (i, j) = ((x as usize).min(width - 2), (y as usize).min(height - 2));
        let (u, v) = (x - i as f64, y - j as f64);
        let value = |i, j| brightness(self.codes.get(i, j));
        let upper = (1.0 - u) * value(i, j) + u * value(i + 1, j);
        Some((1.0 - v) * upper + v * ((1.0 - u) * value(i, j + 1) + u * value(i + 1, j + 1)))
    }

    /// Returns where black ends along rows and columns from the picture's edges, to a pixel.
    pub(super) fn coarse_rim(&self) -> Vec<DVec2> {
        let (width, height) = self.size();
        let mut points = Vec::new();
        // Two pixels in a row, so that a hot pixel does not count.
        let first = |is_black: &dyn Fn(usize) -> bool, length: usize| {
            (0..length - 1).find(|&k| !is_black(k) && !is_black(k + 1)).filter(|&k| k > 1)
        };
        let centre = |i: usize, j: usize| DVec2::new(i as f64 + 0.5, j as f64 + 0.5);
        for k in 0..LINES {
            let (row, column) = ((2 * k + 1) * height / (2 * LINES), (2 * k + 1) * width / (2 * LINES));
            points.extend(first(&|i| self.is_black(i, row), width).map(|i| centre(i, row)));
            points.extend(first(&|i| self.is_black(width - 1 - i, row), width).map(|i| centre(width - 1 - i, row)));
            points.extend(first(&|j| self.is_black(column, j), height).map(|j| centre(column, j)));
            points.extend(
                first(&|j| self.is_black(column, height - 1 - j), height).map(|j| centre(column, height - 1 - j)),
            );
        }
        points
    }

    /// Returns where the picture ends along a ray that crosses its rim near a radius, to a fraction of a pixel: half
    /// way between the levels outside and just inside. `None` if the picture is dark there, or the ray leaves the
    /// frame.
    pub(super) fn rim(&self, centre: DVec2, direction: DVec2, radius: f64, reach: f64) -> Option<DVec2> {
        let steps = (2.0 * reach / STEP) as usize;
        let at = |k: usize| self.at(centre + (radius + reach - k as f64 * STEP) * direction);
        let values: Vec<f64> = (0..=steps).map(at).collect::<Option<_>>()?;
        let quarter = values.len() / 4;
        let mut outside: Vec<f64> = values[..quarter.max(1)].to_vec();
        outside.sort_by(f64::total_cmp);
        let outside = outside[outside.len() / 2];
        let highest = values.iter().copied().fold(outside, f64::max);
        let least = self.least.max(RINGING * (highest - outside));
        let rise = values.iter().position(|value| value - outside > least)?;
        // Just inside: the next three pixels after the rise has begun.
        let inside = values[rise..].iter().take((3.0 / STEP) as usize).copied().fold(outside, f64::max);
        let half = 0.5 * (inside + outside);
        let k = (1..values.len()).find(|&k| values[k] >= half && k + 1 > rise)?;
        let part = (half - values[k - 1]) / (values[k] - values[k - 1]);
        Some(centre + (radius + reach - (k as f64 - 1.0 + part) * STEP) * direction)
    }
}

/// Number of rows and columns along which the end of black is searched.
const LINES: usize = 128;
/// Fraction of the inner level that may occur outside the rim, because the blocks of JPEG files ring.
const RINGING: f64 = 0.125;
/// Pixels between samples along a ray.
const STEP: f64 = 0.25;

fn brightness(code: &Rgba) -> f64 {
    let [red, green, blue, _] = code.0;
    f64::from(red.max(green).max(blue))
}
