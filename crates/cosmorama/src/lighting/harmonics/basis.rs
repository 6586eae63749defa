use std::f64::consts::PI;

use glam::DVec3;

use crate::sphere::Direction;

/// Axes in which harmonics are written. The frame is the world's: +X right, +Y up, −Z front, the middle of a panorama.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HarmonicBasis {
    /// The functions of the world's own x, y and z: their pole is the world's +Z, the back.
    #[default]
    ZUp,
    /// The functions of x, −z and y: their pole is the world's +Y, up; their +y is the front.
    YUp,
    /// The functions of −x, y and −z: +z is the front, +x the left.
    FrontZ,
    /// The functions of −z, y and x: +x is the front, +z the right.
    FrontX,
    /// The functions of −z, y and −x: +x is the front, +z the left, as in a left-handed frame.
    FrontXLeftHanded,
}

impl HarmonicBasis {
    /// All axes.
    pub const ALL: [Self; 5] = [Self::ZUp, Self::YUp, Self::FrontZ, Self::FrontX, Self::FrontXLeftHanded];

    /// Returns the coordinates x, y and z of a direction, for which the functions are written.
    pub fn coordinates(self, direction: Direction) -> [f64; 3] {
        let DVec3 { x, y, z } = direction.vector();
        match self {
            Self::ZUp => [x, y, z],
            Self::YUp => [x, -z, y],
            Self::FrontZ => [-x, y, -z],
            Self::FrontX => [-z, y, x],
            Self::FrontXLeftHanded => [-z, y, -x],
        }
    }

    /// Returns the sides of the world to which +x, +y and +z point.
    pub(super) fn sides(self) -> [&'static str; 3] {
        match self {
            Self::ZUp => ["right", "up", "back"],
            Self::YUp => ["right", "front", "up"],
            Self::FrontZ => ["left", "up", "front"],
            Self::FrontX => ["front", "up", "right"],
            Self::FrontXLeftHanded => ["front", "up", "left"],
        }
    }
}

/// Real orthonormal spherical harmonics up to an order, without the phase of Condon and Shortley.
///
/// Y00 = 0.282095, Y1−1 = 0.488603 y, Y10 = 0.488603 z, Y11 = 0.488603 x; function l, m stands at l² + l + m. In general
/// Y_lm is P_l^|m|(z) times √2 Re (x + iy)^m, or √2 Im (x + iy)^|m| where m is negative (P.-P. Sloan, *Efficient Spherical
/// Harmonic Evaluation*, Journal of Computer Graphics Techniques 2(2), 2013). P are Legendre's functions over sin^m θ, normalised.
#[derive(Clone, Debug)]
pub struct HarmonicFunctions {
    order: usize,
    basis: HarmonicBasis,
    /// First value of each column m: P_m^m, with √2 for m > 0.
    starts: Vec<f64>,
    /// Factors of P_(l−1) and P_(l−2), for l = m + 1 onwards, column by column.
    steps: Vec<[f64; 2]>,
}

impl HarmonicFunctions {
    /// Prepares the functions up to an order.
    pub fn new(order: usize, basis: HarmonicBasis) -> Self {
        let (mut starts, mut steps) = (Vec::new(), Vec::new());
        let mut start = (0.25 / PI).sqrt();
        for m in 0..=order {
            if m > 0 {
                start *= ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
            }
            starts.push(if m > 0 { std::f64::consts::SQRT_2 * start } else { start });
            steps.extend((m + 1..=order).map(|l| step(l, m)));
        }
        Self { order, basis, starts, steps }
    }

    /// Visits the functions' polynomials in z, column by column: l, m, the factor of the highest power, and the share s by which
    /// the polynomial without that factor is z p_(l−1) − s p_(l−2).
    pub(super) fn polynomials(&self) -> impl Iterator<Item = (usize, usize, f64, f64)> {
        let column = move |(m, start): (usize, &f64)| {
            let mut leading = *start;
            let of_band = move |l: usize| {
                if l > m {
                    leading *= step(l, m)[0];
                }
                (l, m, leading, if l > m + 1 { step(l - 1, m)[0].powi(-2) } else { 0.0 })
            };
            (m..=self.order).map(of_band)
        };
        self.starts.iter().enumerate().flat_map(column)
    }

    /// Returns the number of functions: (order + 1)².
    pub fn count(&self) -> usize {
        (self.order + 1).pow(2)
    }

    /// Evaluates all functions in a direction.
    pub fn at(&self, direction: Direction) -> Vec<f64> {
        let mut values = vec![0.0; self.count()];
        self.evaluate(direction, &mut values);
        values
    }

    /// Evaluates all functions in a direction, into a slice of [`count`](Self::count) values.
    pub(super) fn evaluate(&self, direction: Direction, values: &mut [f64]) {
        let [x, y, z] = self.basis.coordinates(direction);
        let mut steps = self.steps.iter();
        // (x + iy)^m = sin^m θ (cos mφ + i sin mφ).
        let (mut cos, mut sin) = (1.0, 0.0);
        for (m, start) in self.starts.iter().enumerate() {
            let (mut before, mut legendre) = (0.0, *start);
            for l in m..=self.order {
                if l > m
                    && let Some([up, back]) = steps.next()
                {
                    (before, legendre) = (legendre, up * z * legendre - back * before);
                }
                let middle = l * l + l;
                values[middle + m] = legendre * cos;
                if m > 0 {
                    values[middle - m] = legendre * sin;
                }
            }
            (cos, sin) = (x * cos - y * sin, x * sin + y * cos);
        }
    }
}

/// Returns the factors of z P_(l−1)^m and of P_(l−2)^m in P_l^m, all normalised.
fn step(l: usize, m: usize) -> [f64; 2] {
    let square = |number: usize| (number * number) as f64;
    let up = |l: usize| ((4.0 * square(l) - 1.0) / (square(l) - square(m))).sqrt();
    [up(l), if l > m + 1 { up(l) / up(l - 1) } else { 0.0 }]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrates all products of functions by Gauss's rule: midpoints in longitude, 24 nodes in z by Newton's iteration.
    #[test]
    fn functions_are_orthonormal() {
        const NODES: usize = 24;
        const AROUND: usize = 48;
        for basis in HarmonicBasis::ALL {
            let functions = HarmonicFunctions::new(10, basis);
            let count = functions.count();
            assert_eq!(count, 121);
            let mut products = vec![0.0; count * count];
            for (z, weight) in gauss_nodes(NODES) {
                for k in 0..AROUND {
                    let (sin, cos) = (2.0 * PI * (k as f64 + 0.3) / AROUND as f64).sin_cos();
                    let radius = (1.0 - z * z).sqrt();
                    let values = functions.at(Direction::from_unit(DVec3::new(radius * cos, radius * sin, z)));
                    let part = weight * 2.0 * PI / AROUND as f64;
                    for (a, row) in values.iter().zip(products.chunks_mut(count)) {
                        row.iter_mut().zip(&values).for_each(|(sum, b)| *sum += part * a * b);
                    }
                }
            }
            for (k, product) in products.into_iter().enumerate() {
                let expected = if k / count == k % count { 1.0 } else { 0.0 };
                assert!((product - expected).abs() < 1e-12, "{basis:?}, {} by {}: {product}", k / count, k % count);
            }
        }
    }

    /// Nodes and weights of Gauss and Legendre.
    fn gauss_nodes(count: usize) -> Vec<(f64, f64)> {
        let node = |k: usize| {
            let mut z = (PI * (k as f64 + 0.75) / (count as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut before, mut value) = (0.0, 1.0);
                for l in 1..=count {
                    let l = l as f64;
                    (before, value) = (value, ((2.0 * l - 1.0) * z * value - (l - 1.0) * before) / l);
                }
                slope = count as f64 * (z * value - before) / (z * z - 1.0);
                z -= value / slope;
            }
            (z, 2.0 / ((1.0 - z * z) * slope * slope))
        };
        (0..count).map(node).collect()
    }

    #[test]
    fn low_bands_are_those_of_the_convention() {
        let direction = Direction::new(DVec3::new(0.3, -0.5, 0.7)).expect("not zero");
        let DVec3 { x, y, z } = direction.vector();
        let expected = |x: f64, y: f64, z: f64| {
            // Ramamoorthi & Hanrahan 2001, equation 3.
            let first = [0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y, 1.092548 * y * z];
            let rest = [0.315392 * (3.0 * z * z - 1.0), 1.092548 * x * z, 0.546274 * (x * x - y * y)];
            [&first[..], &rest].concat()
        };
        for (basis, expected) in [(HarmonicBasis::ZUp, expected(x, y, z)), (HarmonicBasis::YUp, expected(x, -z, y))] {
            let values = HarmonicFunctions::new(2, basis).at(direction);
            for (k, (value, expected)) in values.iter().zip(expected).enumerate() {
                assert!((value - expected).abs() < 1e-6, "{basis:?} {k}: {value}, {expected}");
            }
        }
    }
}
