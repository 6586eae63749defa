use glam::DVec2;

use super::weighing::{Region, Seen, area_in_square};
use crate::filter::{CrossSection, Kernel};

/// Exact areas of texels under the quadrilateral of a pixel's corners, evenly weighted: a box filter (Catmull 1974; Catmull
/// & Smith 1980 call it area averaging).
///
/// Each corner is mapped by itself. Where they make no quadrilateral, as around the pole of a panorama, the footprint's
/// parallelogram stands for it.
pub(super) struct Catmull;

impl Region for Catmull {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let corners = seen.corners(0.5);
        let within = seen.texels_within(seen.reach_of(corners));
        for j in within.rows {
            for i in within.columns.clone() {
                let area = area_in_square(corners, DVec2::new(i as f64, j as f64));
                if area > 0.0 {
                    visit([i, j], area);
                }
            }
        }
    }

    fn kernel(&self) -> Option<Kernel> {
        Some(Kernel::uniform(CrossSection::Box))
    }

    fn reach(&self) -> f64 {
        0.5
    }
}
