use super::weighing::{Region, Seen};

/// A pyramid over the parallelogram that the pixels around map to: a tent along each side, in the parallelogram's own
/// frame (Blinn & Newell 1976).
pub(super) struct BlinnNewell;

impl Region for BlinnNewell {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let jacobian = seen.widened();
        let to_screen = jacobian.inverse();
        let within = seen.texels_within(jacobian.x_axis.abs() + jacobian.y_axis.abs());
        for j in within.rows {
            for i in within.columns.clone() {
                let at = to_screen * seen.offset([i, j]);
                let weight = (1.0 - at.x.abs()).max(0.0) * (1.0 - at.y.abs()).max(0.0);
                if weight > 0.0 {
                    visit([i, j], weight);
                }
            }
        }
    }
}
