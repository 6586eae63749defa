use super::Exposure;

/// Time of each frame's exposure: its length, its place, and its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// Time that it is open, as a fraction of the interval from frame to frame: 0.5 is a shutter of 180°.
    pub fraction: f64,
    /// Part of that time that lies before the frame's own time: 0.5 centres it, 0 begins with the frame.
    pub phase: f64,
    /// Light that it lets through while it is open.
    pub curve: ShutterCurve,
}

/// Light that a shutter lets through over its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShutterCurve {
    /// All of it, from the first moment to the last.
    #[default]
    Box,
    /// Opening evenly in the first quarter, closing in the last.
    Trapezoid,
    /// A raised cosine.
    Cosine,
}

/// A moment of an exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Its time, in frames.
    pub time: f64,
    /// Part of the exposure's light that it stands for.
    pub weight: f64,
}

/// Weights of the outermost moments, from either end inward: 1 + (2, −3, 1)/24.
const ENDS: [f64; 3] = [26.0 / 24.0, 21.0 / 24.0, 25.0 / 24.0];

/// Part of a trapezoid's time in which it opens, and in which it closes.
const RAMP: f64 = 0.25;

impl ShutterCurve {
    /// Returns the light that passes at a part of the time, at most 1.
    pub fn light(self, part: f64) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Trapezoid => (part.min(1.0 - part) / RAMP).clamp(0.0, 1.0),
            Self::Cosine => 0.5 - 0.5 * (std::f64::consts::TAU * part).cos(),
        }
    }

    /// Returns the variance of the light over the time, whose length is one.
    pub(super) fn variance(self) -> f64 {
        match self {
            Self::Box => 1.0 / 12.0,
            // The sum of two boxes' variances: a trapezoid is one box blurred by another, (1 − RAMP) and RAMP long.
            Self::Trapezoid => ((1.0 - RAMP).powi(2) + RAMP * RAMP) / 12.0,
            Self::Cosine => 1.0 / 12.0 - 0.5 / (std::f64::consts::PI * std::f64::consts::PI),
        }
    }
}

impl Shutter {
    /// Returns the shutter that is open over a fraction of the interval, around the frame's time.
    pub const fn centred(fraction: f64) -> Self {
        Self { fraction, phase: 0.5, curve: ShutterCurve::Box }
    }

    /// Returns the times at which a frame's exposure begins and ends.
    pub fn interval(&self, frame: f64) -> [f64; 2] {
        [frame - self.phase * self.fraction, frame + (1.0 - self.phase) * self.fraction]
    }

    /// Returns the times that divide a frame's exposure evenly, its ends among them.
    pub fn division(&self, frame: f64) -> [f64; Exposure::FEW] {
        let [open, close] = self.interval(frame);
        std::array::from_fn(|k| open + (close - open) * k as f64 / (Exposure::FEW - 1) as f64)
    }

    /// Divides an exposure into moments of equal length, each at its middle. Their weights sum to one.
    ///
    /// The middles alone err by h²/24 times the difference of the slopes at both ends (Euler and Maclaurin), h being a moment's length: a lamp's
    /// streak shows that at its ends. So the weights of the outer three take it off, by the slope of the parabola through them.
    pub fn moments(&self, frame: f64, count: usize) -> Vec<Moment> {
        let [open, _] = self.interval(frame);
        let part = |k: usize| (k as f64 + 0.5) / count as f64;
        let end = |k: usize| ENDS.get(k.min(count - 1 - k)).filter(|_| count >= 2 * ENDS.len()).copied().unwrap_or(1.0);
        let light = |k: usize| self.curve.light(part(k)) * end(k);
        let total: f64 = (0..count).map(light).sum();
        let moment = |k: usize| Moment { time: open + self.fraction * part(k), weight: light(k) / total };
        (0..count).map(moment).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phase_places_the_interval() {
        let with = |phase| Shutter { phase, ..Shutter::centred(0.5) }.interval(10.0);
        assert_eq!([with(0.5), with(0.0), with(1.0)], [[9.75, 10.25], [10.0, 10.5], [9.5, 10.0]]);
    }

    #[test]
    fn moments_sum_smooth_light_to_the_fourth_order() {
        let shutter = Shutter::centred(1.0);
        let error = |count: usize| {
            let sum: f64 = shutter.moments(0.5, count).iter().map(|m| m.weight * m.time.exp()).sum();
            (sum - (1f64.exp() - 1.0)).abs()
        };
        // Twice as many are sixteen times nearer.
        assert!(error(8) < 4e-5 && error(16) < error(8) / 12.0, "{} and {}", error(8), error(16));
    }

    #[test]
    fn moments_have_the_light_and_the_spread_of_their_curve() {
        for curve in [ShutterCurve::Box, ShutterCurve::Trapezoid, ShutterCurve::Cosine] {
            let moments = Shutter { curve, ..Shutter::centred(1.0) }.moments(3.0, 4000);
            let sum = |of: &dyn Fn(f64) -> f64| moments.iter().map(|m| m.weight * of(m.time - 3.0)).sum::<f64>();
            assert!((sum(&|_| 1.0) - 1.0).abs() < 1e-12 && sum(&|t| t).abs() < 1e-12);
            let variance = sum(&|t| t * t);
            assert!((variance - curve.variance()).abs() < 1e-6, "{curve:?}: {variance}, not {}", curve.variance());
        }
    }
}
