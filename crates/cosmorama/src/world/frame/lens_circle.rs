use super::FrameError;
use super::error::check_positive;
use crate::world::{PixelGrid, PixelPoint};

/// Where a lens's circle lies in an image, in place of where the frame's own rule puts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensCircle {
    /// Its centre.
    pub centre: Option<PixelPoint>,
    /// Its radius, in pixel widths.
    pub radius: Option<f64>,
}

impl LensCircle {
    /// As the frame's own rule says.
    pub const FITTED: Self = Self { centre: None, radius: None };

    /// The grid with its circle of `plane_radius` plane units where this says.
    pub(super) fn place(self, grid: PixelGrid, plane_radius: f64) -> Result<PixelGrid, FrameError> {
        if let Some(radius) = self.radius {
            check_positive("the radius", radius)?;
        }
        let step = grid.step();
        let scale = self.radius.map_or(1.0, |radius| plane_radius / radius / step.x);
        let centre = self.centre.unwrap_or_else(|| grid.to_pixel(crate::projection::PlanePoint::new(0.0, 0.0)));
        Ok(PixelGrid::centred(grid.width(), grid.height(), centre, step * scale))
    }
}

impl Default for LensCircle {
    fn default() -> Self {
        Self::FITTED
    }
}
