use glam::DVec2;

use crate::filter::kernel::{KernelTable, UNDER};

/// A texel that a kernel reaches, before the weights are final.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Candidate {
    /// Index of the texel in the world's buffer.
    pub(crate) texel: u32,
    /// Square of its distance from the pixel's centre, in the unit of the coarsest kernel that the pixel uses.
    pub(crate) q: f32,
    /// Kernel's weight times the texel's solid angle.
    pub(crate) weight: f32,
    /// Factor on the correction that centres the weights: positive, and zero at the kernel's edge.
    pub(crate) window: f32,
    /// Offset from the pixel's centre, in screen pixels.
    pub(crate) offset: [f32; 2],
}

impl Candidate {
    /// Weighs a texel at squared distance `q` < [`KernelTable::radius_squared`] and at this offset in screen pixels.
    pub(crate) fn weighed(
        table: &KernelTable,
        texel: usize,
        solid_angle: f32,
        q: f64,
        coarseness: f32,
        offset: DVec2,
    ) -> Self {
        let falloff = 1.0 - (q / table.radius_squared()) as f32;
        Self {
            texel: texel as u32,
            q: q as f32,
            weight: table.weight(q, coarseness) * solid_angle,
            window: falloff * falloff * solid_angle,
            offset: [offset.x as f32, offset.y as f32],
        }
    }

    /// Returns whether the texel lies under the pixel.
    pub(crate) fn is_under(&self) -> bool {
        f64::from(self.q) < UNDER
    }
}
