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

    /// The rows of r² < `q`, ready to be cut one after the other.
    pub(super) fn rows(&self, q: f64) -> EllipseRows {
        // A U² + (B V) U + (C V² − q) = 0.
        let inverse = self.a.recip();
        let slope = -0.5 * self.b * inverse;
        EllipseRows { slope, widest: q * inverse, narrowing: self.c * inverse - slope * slope }
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

/// An ellipse cut along rows of texels.
#[derive(Clone, Copy, Debug)]
pub(super) struct EllipseRows {
    slope: f64,
    widest: f64,
    narrowing: f64,
}

impl EllipseRows {
    /// Between which U the row at V lies inside; `None` where it misses the ellipse.
    pub(super) fn range(&self, v: f64) -> Option<(f64, f64)> {
        let half2 = self.widest - self.narrowing * v * v;
        let (middle, half) = (self.slope * v, half2.max(0.0).sqrt());
        (half2 >= 0.0).then_some((middle - half, middle + half))
    }
}
