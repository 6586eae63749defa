use glam::{DMat2, DVec2};

/// The ellipse of texels that a round screen pixel covers: the texel at `centre + (U, V)` is at distance
/// r² = A U² + B U V + C V² from the centre, in the kernel's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// A.
    pub a: f64,
    /// B.
    pub b: f64,
    /// C.
    pub c: f64,
}

impl Ellipse {
    /// The ellipse of the footprint with columns (Ux, Vx) and (Uy, Vy), already in the kernel's unit, whose axes are
    /// raised to at least `floor` texels.
    ///
    /// With J the matrix of those columns, r² = xᵀ(JJᵀ)⁻¹x; this is A, B, C of Greene & Heckbert divided by their F. The
    /// eigenvalues of JJᵀ are the squared singular values of J, so raising them widens the axes and nothing else.
    pub fn new(jacobian: DMat2, floor: f64) -> Self {
        let (x, y) = (jacobian.x_axis, jacobian.y_axis);
        let (p, q, r) = (x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y);
        let (mean, half) = ((p + r) / 2.0, (p - r) / 2.0);
        let length = (half * half + q * q).sqrt();
        let (floor2, major, minor) = (floor * floor, mean + length, mean - length);
        let (raised_major, raised_minor) = (major.max(floor2), minor.max(floor2));
        // JJᵀ = mean·1 + spread·D with D the unit traceless part along the axes.
        let (mean, spread) = ((raised_major + raised_minor) / 2.0, (raised_major - raised_minor) / 2.0);
        let (along, across) = if length > 0.0 { (half / length, q / length) } else { (0.0, 0.0) };
        let (p, q, r) = (mean + spread * along, spread * across, mean - spread * along);
        let determinant = raised_major * raised_minor;
        Self { a: r / determinant, b: -2.0 * q / determinant, c: p / determinant }
    }

    /// r² at an offset from the centre.
    pub fn distance_squared(&self, offset: DVec2) -> f64 {
        self.a * offset.x * offset.x + self.b * offset.x * offset.y + self.c * offset.y * offset.y
    }

    /// Half the width and height of the box around r² = `q`.
    pub fn half_extent(&self, q: f64) -> DVec2 {
        let determinant = self.a * self.c - self.b * self.b / 4.0;
        DVec2::new((q * self.c / determinant).sqrt(), (q * self.a / determinant).sqrt())
    }

    /// Between which U the row at V lies within r² = `q`; `None` where it misses the ellipse.
    pub fn row_range(&self, v: f64, q: f64) -> Option<(f64, f64)> {
        // A U² + (B V) U + (C V² − q) = 0.
        let middle = -self.b * v / (2.0 * self.a);
        let half2 = middle * middle - (self.c * v * v - q) / self.a;
        (half2 >= 0.0).then(|| (middle - half2.sqrt(), middle + half2.sqrt()))
    }

    /// Semi-axes of r = 1 in texels, the major one first, and the major one's angle from the U axis, in radians.
    pub fn axes(&self) -> (f64, f64, f64) {
        let (mean, half) = ((self.a + self.c) / 2.0, (self.a - self.c) / 2.0);
        let spread = half.hypot(self.b / 2.0);
        // The major axis belongs to the smaller eigenvalue.
        let angle = 0.5 * (-self.b / 2.0).atan2(-half);
        ((mean - spread).recip().sqrt(), (mean + spread).recip().sqrt(), angle)
    }
}
