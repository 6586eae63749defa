use glam::{DMat2, DVec2};

/// Ellipse of texels that a round screen pixel covers.
///
/// The texel at `centre + (U, V)` is at distance r from the centre, in the kernel's unit, where
/// r² = A U² + B U V + C V².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Coefficient A.
    pub a: f64,
    /// Coefficient B.
    pub b: f64,
    /// Coefficient C.
    pub c: f64,
    /// Determinant AC − B²/4, kept because a thin ellipse would lose it to rounding.
    determinant: f64,
}

impl Ellipse {
    /// Returns the ellipse of the footprint with columns (Ux, Vx) and (Uy, Vy), already in the kernel's unit. Its axes
    /// are raised to at least `floor` texels.
    ///
    /// With J the matrix of those columns, r² = xᵀ(JJᵀ)⁻¹x; this is A, B, C of Greene & Heckbert divided by their F.
    /// The eigenvalues of JJᵀ are the squared singular values of J, so raising them widens the axes and nothing else.
    pub fn new(jacobian: DMat2, floor: f64) -> Self {
        let (x, y) = (jacobian.x_axis, jacobian.y_axis);
        let (p, q, r) = (x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y);
        // JJᵀ = (p q; q r) = mean·1 + spread·(cos 2θ, sin 2θ; sin 2θ, −cos 2θ), θ being the major axis's angle.
        let half = (p - r) / 2.0;
        let spread = (half * half + q * q).sqrt();
        let major = (p + r) / 2.0 + spread;
        // Not mean − spread, which loses a thin ellipse's minor axis to rounding.
        let minor = if major > 0.0 { jacobian.determinant().powi(2) / major } else { 0.0 };
        let (major, minor) = (major.max(floor * floor), minor.max(floor * floor));
        let (cos, sin) = half_angle(half, q, spread);
        Self {
            a: sin * sin / minor + cos * cos / major,
            b: 2.0 * sin * cos * (major.recip() - minor.recip()),
            c: cos * cos / minor + sin * sin / major,
            determinant: (major * minor).recip(),
        }
    }

    /// Returns r² at an offset from the centre.
    pub fn distance_squared(&self, offset: DVec2) -> f64 {
        self.a * offset.x * offset.x + self.b * offset.x * offset.y + self.c * offset.y * offset.y
    }

    /// Returns the area of r² < `q`, in texels.
    pub(crate) fn area(&self, q: f64) -> f64 {
        std::f64::consts::PI * q / self.determinant.sqrt()
    }

    /// Returns half the width and height of the box around r² = `q`.
    pub fn half_extent(&self, q: f64) -> DVec2 {
        DVec2::new((q * self.c / self.determinant).sqrt(), (q * self.a / self.determinant).sqrt())
    }

    /// Returns the semi-axes of r = 1 in a plane that maps linearly to the plane of texels: the major one as a vector,
    /// and the minor one's length.
    pub fn semi_axes_in(&self, to_texels: DMat2) -> (DVec2, f64) {
        // Eigenvalues of the conic in that plane. The smaller one is not computed as a difference, which would lose a
        // thin ellipse's to rounding.
        let conic = DMat2::from_cols(DVec2::new(self.a, self.b / 2.0), DVec2::new(self.b / 2.0, self.c));
        let there = to_texels.transpose() * conic * to_texels;
        let (half, q) = ((there.x_axis.x - there.y_axis.y) / 2.0, there.x_axis.y);
        let spread = half.hypot(q);
        let greater = (there.x_axis.x + there.y_axis.y) / 2.0 + spread;
        let determinant = self.determinant * to_texels.determinant().powi(2);
        // The greater eigenvalue belongs to the minor axis.
        let (cos, sin) = half_angle(half, q, spread);
        (DVec2::new(-sin, cos) * (greater / determinant).sqrt(), greater.recip().sqrt())
    }

    /// Prepares the ellipse r² < `q` for being cut along rows of texels.
    pub(crate) fn rows(&self, q: f64) -> EllipseRows {
        // At V, its ends are the roots U of A U² + (B V) U + (C V² − q) = 0.
        let inverse = self.a.recip();
        let slope = -0.5 * self.b * inverse;
        EllipseRows { slope, widest: q * inverse, narrowing: self.determinant * inverse * inverse }
    }

    /// Returns the semi-axes of r = 1 in texels, the major one first, and the major one's angle from the U axis, in
    /// radians.
    pub fn axes(&self) -> (f64, f64, f64) {
        let (mean, half) = ((self.a + self.c) / 2.0, (self.a - self.c) / 2.0);
        let spread = half.hypot(self.b / 2.0);
        // The major axis belongs to the smaller eigenvalue.
        let angle = 0.5 * (-self.b / 2.0).atan2(-half);
        ((mean - spread).recip().sqrt(), (mean + spread).recip().sqrt(), angle)
    }
}

/// An ellipse cut along rows of texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EllipseRows {
    slope: f64,
    widest: f64,
    narrowing: f64,
}

impl EllipseRows {
    /// Returns the least and greatest U of the row at V inside the ellipse; `None` where it misses the ellipse.
    pub(crate) fn range(&self, v: f64) -> Option<(f64, f64)> {
        let half2 = self.widest - self.narrowing * v * v;
        let (middle, half) = (self.slope * v, half2.max(0.0).sqrt());
        (half2 >= 0.0).then_some((middle - half, middle + half))
    }
}

/// Returns a matrix with its singular values raised to at least `floor`: its ellipse is widened, and nothing else.
pub(crate) fn widened(jacobian: DMat2, floor: f64) -> DMat2 {
    let [major, minor] = semi_axes(jacobian);
    if minor >= floor {
        return jacobian;
    }
    let (x, y) = (jacobian.x_axis, jacobian.y_axis);
    // JᵀJ = mean·1 + spread·(cos 2θ, sin 2θ; sin 2θ, −cos 2θ), θ being the angle that is stretched most.
    let (half, q) = ((x.length_squared() - y.length_squared()) / 2.0, x.dot(y));
    let (cos, sin) = half_angle(half, q, (half * half + q * q).sqrt());
    let axes = [DVec2::new(cos, sin), DVec2::new(-sin, cos)];
    let across = if jacobian.determinant() < 0.0 { -1.0 } else { 1.0 };
    // Where there is no major axis, any will do.
    let along = (jacobian * axes[0]).try_normalize().unwrap_or(axes[0]);
    let columns = DMat2::from_cols(along * major.max(floor), along.perp() * (across * minor.max(floor)));
    columns * DMat2::from_cols(axes[0], axes[1]).transpose()
}

/// Returns the semi-axes of the image of the unit circle, the major one first: the singular values.
pub(crate) fn semi_axes(jacobian: DMat2) -> [f64; 2] {
    let [a, b, c, d] = jacobian.to_cols_array();
    // Not `hypot`, which is a function call: footprints are far from overflowing.
    let length = |x: f64, y: f64| (x * x + y * y).sqrt();
    let (sum, difference) = (length(a + d, b - c), length(a - d, b + c));
    let major = (sum + difference) / 2.0;
    [major, if major > 0.0 { jacobian.determinant().abs() / major } else { 0.0 }]
}

/// Returns cosine and sine of θ where (x, y) = length·(cos 2θ, sin 2θ), each to full precision; 1 and 0 for a circle.
fn half_angle(x: f64, y: f64, length: f64) -> (f64, f64) {
    if length == 0.0 {
        return (1.0, 0.0);
    }
    let (cos2, sin2) = (x / length, y / length);
    if cos2 >= 0.0 {
        let cos = ((1.0 + cos2) / 2.0).sqrt();
        (cos, sin2 / (2.0 * cos))
    } else {
        let sin = ((1.0 - cos2) / 2.0).sqrt();
        (sin2 / (2.0 * sin), sin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widened_matrices_have_the_widened_ellipse() {
        for k in 0..200 {
            let t = f64::from(k);
            let columns = [DVec2::from_angle(t) * (0.03 * t), DVec2::from_angle(1.7 * t) * (0.01 * t)];
            let jacobian = DMat2::from_cols(columns[0], columns[1]);
            let (found, expected) = (Ellipse::new(widened(jacobian, 1.12), 0.0), Ellipse::new(jacobian, 1.12));
            let error =
                (found.a - expected.a).abs().max((found.b - expected.b).abs()).max((found.c - expected.c).abs());
            assert!(error < 1e-9, "{k}: {found:?} for {expected:?}");
            assert!(widened(jacobian, 0.0) == jacobian);
        }
    }

    #[test]
    fn an_ellipse_is_the_image_of_the_unit_circle() {
        for (columns, name) in [
            ([3.0, 0.5, -1.0, 2.0], "common"),
            ([1e10, 0.0, 0.0, 10.0], "as wide as at a pole"),
            ([10.0, 0.0, 0.0, 1e10], "as high as at a rim"),
            ([2.0, 2.0, -7.0, 7.0], "diagonal"),
        ] {
            let jacobian = DMat2::from_cols_array(&columns);
            let ellipse = Ellipse::new(jacobian, 1.0);
            for step in 0..16 {
                let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 16.0).sin_cos();
                let found = ellipse.distance_squared(jacobian * DVec2::new(cos, sin));
                assert!((found - 1.0).abs() < 1e-9, "{name}: {found}");
            }
        }
    }

    #[test]
    fn semi_axes_are_those_of_the_ellipse() {
        for columns in [[3.0, 0.5, -1.0, 2.0], [2.0, 2.0, -7.0, 7.0], [1.0, 0.0, 0.0, 4.0], [0.0, 2.0, 3.0, 0.0]] {
            let jacobian = DMat2::from_cols_array(&columns);
            let (major, minor, _) = Ellipse::new(jacobian, 1e-3).axes();
            let [a, b] = semi_axes(jacobian);
            assert!((a - major).abs() < 1e-9 && (b - minor).abs() < 1e-9, "{columns:?}: {a}, {b}");
        }
        assert_eq!(semi_axes(DMat2::ZERO), [0.0, 0.0]);
    }

    #[test]
    fn short_axes_are_raised_and_long_ones_left() {
        let ellipse = Ellipse::new(DMat2::from_cols_array(&[5.0, 0.0, 0.0, 0.1]), 1.5);
        assert!((ellipse.distance_squared(DVec2::new(5.0, 0.0)) - 1.0).abs() < 1e-12);
        assert!((ellipse.distance_squared(DVec2::new(0.0, 1.5)) - 1.0).abs() < 1e-12);
        let point = Ellipse::new(DMat2::ZERO, 2.0);
        assert!((point.distance_squared(DVec2::new(0.0, 2.0)) - 1.0).abs() < 1e-12);
    }
}
