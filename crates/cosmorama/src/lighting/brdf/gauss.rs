use std::f64::consts::PI;

/// Nodes and weights of Gauss's rule on 0 to 1.
pub(super) struct GaussRule(Vec<(f64, f64)>);

impl GaussRule {
    /// Finds the zeros of a Legendre polynomial by Newton's iteration.
    pub(super) fn new(count: usize) -> Self {
        Self((0..count).map(|k| node(k, count)).collect())
    }

    /// Visits each node with its weight.
    pub(super) fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        self.0.iter().copied()
    }
}

fn node(k: usize, count: usize) -> (f64, f64) {
    let n = count as f64;
    let mut z = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
    let mut slope = 1.0;
    // Newton's iteration doubles the digits; a first guess has three.
    for _ in 0..8 {
        let (mut before, mut value) = (0.0, 1.0);
        for l in 1..=count {
            let l = l as f64;
            (before, value) = (value, ((2.0 * l - 1.0) * z * value - (l - 1.0) * before) / l);
        }
        slope = n * (z * value - before) / (z * z - 1.0);
        z -= value / slope;
    }
    (0.5 + 0.5 * z, 1.0 / ((1.0 - z * z) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_integrated_exactly() {
        let rule = GaussRule::new(24);
        for power in [0, 1, 7, 30, 47] {
            let found: f64 = rule.nodes().map(|(x, weight)| weight * x.powi(power)).sum();
            let expected = 1.0 / f64::from(power + 1);
            assert!((found - expected).abs() < 1e-14, "{power}: {found}");
        }
    }
}
