use std::array::from_fn;

/// Unknowns of an affine flow.
pub(crate) const UNKNOWNS: usize = 6;

pub(crate) type Vector = [f64; UNKNOWNS];
type Matrix = [Vector; UNKNOWNS];

/// Ratio to the greatest eigenvalue below which an eigenvalue is noise: its direction is not determined.
const RANK: f64 = 1e-13;

/// Limit of sweeps of rotations; symmetric matrices of this size are diagonal after about six.
const SWEEPS: usize = 30;

/// The normal equations of a linear least-squares problem in six unknowns.
#[derive(Clone, Default)]
pub(crate) struct NormalEquations {
    /// Matrix; only its upper triangle is used until it is solved.
    matrix: Matrix,
    right: Vector,
}

impl NormalEquations {
    /// Adds one observation: `factors · unknowns = value`.
    pub(crate) fn observe(&mut self, factors: &Vector, value: f64) {
        for r in 0..UNKNOWNS {
            for c in r..UNKNOWNS {
                self.matrix[r][c] += factors[r] * factors[c];
            }
            self.right[r] += factors[r] * value;
        }
    }

    /// Adds the observations of other equations.
    pub(crate) fn add(&mut self, other: &Self) {
        for r in 0..UNKNOWNS {
            for c in r..UNKNOWNS {
                self.matrix[r][c] += other.matrix[r][c];
            }
            self.right[r] += other.right[r];
        }
    }

    /// Returns the least-squares solution; the shortest one if several are equally good.
    pub(crate) fn solve(&self) -> Vector {
        let symmetric = from_fn(|r| from_fn(|c| self.matrix[r.min(c)][r.max(c)]));
        let (values, vectors) = eigen(symmetric);
        let least = RANK * values.iter().copied().fold(0.0, f64::max);
        let mut solution = [0.0; UNKNOWNS];
        for (value, vector) in values.iter().zip(&vectors).filter(|(value, _)| **value > least) {
            let part = dot(vector, &self.right) / value;
            solution = from_fn(|k| solution[k] + part * vector[k]);
        }
        solution
    }
}

/// Returns the eigenvalues and eigenvectors (rows) of a symmetric matrix, by Jacobi's rotations.
fn eigen(mut matrix: Matrix) -> (Vector, Matrix) {
    let mut vectors: Matrix = from_fn(|r| from_fn(|c| f64::from(u8::from(r == c))));
    for _ in 0..SWEEPS {
        for p in 0..UNKNOWNS {
            for q in p + 1..UNKNOWNS {
                rotate(&mut matrix, &mut vectors, p, q);
            }
        }
    }
    (from_fn(|k| matrix[k][k]), vectors)
}

/// Rotates the plane of axes p and q so that their common element vanishes.
fn rotate(matrix: &mut Matrix, vectors: &mut Matrix, p: usize, q: usize) {
    if matrix[p][q] == 0.0 {
        return;
    }
    let cotangent = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
    let tangent = 1.0_f64.copysign(cotangent) / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = tangent.hypot(1.0).recip();
    let sine = tangent * cosine;
    let turn = |p: f64, q: f64| (cosine * p - sine * q, sine * p + cosine * q);
    for row in matrix.iter_mut() {
        (row[p], row[q]) = turn(row[p], row[q]);
    }
    for turned in [matrix, vectors] {
        let (row_p, row_q) = (turned[p], turned[q]);
        turned[p] = from_fn(|c| turn(row_p[c], row_q[c]).0);
        turned[q] = from_fn(|c| turn(row_p[c], row_q[c]).1);
    }
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: Vector = [0.3, -1.0, 2.0, 0.0, 1e-3, -5.0];

    fn factors(k: usize) -> Vector {
        from_fn(|c| ((k * 7 + c * 3 + k * c) as f64).sin())
    }

    #[test]
    fn consistent_observations_are_met() {
        let mut equations = NormalEquations::default();
        (0..40).for_each(|k| equations.observe(&factors(k), dot(&factors(k), &TRUTH)));
        let solution = equations.solve();
        for (found, truth) in solution.iter().zip(TRUTH) {
            assert!((found - truth).abs() < 1e-10, "{solution:?}");
        }
    }

    #[test]
    fn unknowns_that_nothing_says_are_zero() {
        let mut equations = NormalEquations::default();
        assert_eq!(equations.solve(), [0.0; 6]);
        equations.observe(&[1.0, 1.0, 0.0, 0.0, 0.0, 0.0], 1.0);
        let [x, y, rest @ ..] = equations.solve();
        assert!((x - 0.5).abs() < 1e-14 && (y - 0.5).abs() < 1e-14 && rest == [0.0; 4]);
    }
}
