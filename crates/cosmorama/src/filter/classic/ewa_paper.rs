use glam::DVec2;

use super::weighing::{Region, ScreenKernel, Seen};
use crate::filter::{Ellipse, Kernel};

/// EWA as the paper prints it: Q by finite differences along the rows of the ellipse's box, and a table of weights over Q
/// (Greene & Heckbert 1986).
///
/// [`ewa`](crate::filter::ewa()) is the printed program, for one image. Here footprints under a texel are widened, and
/// each view that the ellipse touches adds its texels, by their solid angle.
pub(super) struct EwaPaper(pub(super) ScreenKernel);

impl Region for EwaPaper {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let ellipse = Ellipse::new(seen.jacobian, 1.0);
        // A, B, C scaled so that F is the length of WTAB and Q its index.
        let (f, scale) = (self.0.length() as f64, self.0.entries_per_unit());
        let [a, b, c] = [ellipse.a, ellipse.b, ellipse.c].map(|coefficient| coefficient * scale);
        let within = seen.texels_within(ellipse.half_extent(self.0.radius().powi(2)));
        let first = *within.columns.start();
        for j in within.rows {
            let DVec2 { x: u, y: v } = seen.offset([first, j]);
            let mut dq = a * (2.0 * u + 1.0) + b * v;
            let mut q = (c * v + b * u) * v + a * u * u;
            for i in within.columns.clone() {
                if q < f {
                    visit([i, j], self.0.entry(q.max(0.0) as usize));
                }
                q += dq;
                dq += 2.0 * a;
            }
        }
    }

    fn kernel(&self) -> Option<Kernel> {
        Some(self.0.kernel())
    }
}
