/// A round kernel on the screen, tabulated over the squared distance: the paper's WTAB, exp(−2 r²) out to r = 1 (Greene
/// & Heckbert 1986).
#[derive(Clone, Debug)]
pub(super) struct ScreenKernel {
    table: Vec<f64>,
}

impl ScreenKernel {
    /// Radius, in pixels.
    pub(super) const RADIUS: f64 = 1.0;

    /// Integral along a line through the middle: ∫ exp(−2 x²) from −1 to 1.
    pub(super) const INTEGRAL: f64 = 1.196_288_013_322_608;

    /// Falloff over the squared radius.
    const ALPHA: f64 = 2.0;

    /// Entries of the table.
    pub(super) const LENGTH: usize = 4096;

    pub(super) fn new() -> Self {
        let entry = |q: usize| (-Self::ALPHA * (q as f64 + 0.5) / Self::LENGTH as f64).exp();
        Self { table: (0..Self::LENGTH).map(entry).collect() }
    }

    /// Returns the weight at a squared distance, in pixels; zero from the radius on.
    pub(super) fn weight(&self, square: f64) -> f64 {
        self.table.get((square * Self::LENGTH as f64) as usize).copied().unwrap_or(0.0)
    }

    /// Returns the entry for Q, where F is the table's length.
    pub(super) fn entry(&self, q: usize) -> f64 {
        self.table[q]
    }
}
