use crate::camera::error::check_positive;
use crate::camera::{CameraError, PixelGrid, PixelPoint};

/// Explicit place of a lens's circle in an image; it overrides the camera model's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensCircle {
    /// Centre of the circle.
    pub centre: Option<PixelPoint>,
    /// Radius of the circle, in pixel widths.
    pub radius: Option<f64>,
}

impl LensCircle {
    /// No override: the camera model places the circle.
    pub const FITTED: Self = Self { centre: None, radius: None };

    /// Moves and scales a grid so that its circle of `plane_radius` plane units lies as requested.
    pub(crate) fn place(self, grid: PixelGrid, plane_radius: f64) -> Result<PixelGrid, CameraError> {
        if let Some(radius) = self.radius {
            check_positive("the radius", radius)?;
        }
        let step = grid.step();
        let scale = self.radius.map_or(1.0, |radius| plane_radius / radius / step.x);
        let centre = self.centre.unwrap_or_else(|| grid.to_pixel(crate::projection::PlanePoint::new(0.0, 0.0)));
        let placed = PixelGrid::centred(grid.width(), grid.height(), centre, step * scale);
        if self != Self::FITTED {
            self.check_seen(&placed, centre, plane_radius)?;
        }
        Ok(placed)
    }

    /// Returns an error if no part of the circle is on the image.
    fn check_seen(self, grid: &PixelGrid, centre: PixelPoint, plane_radius: f64) -> Result<(), CameraError> {
        let (width, height) = (grid.width(), grid.height());
        let (across, down) = (plane_radius / grid.step().x.abs(), plane_radius / grid.step().y.abs());
        // Point of the image nearest to the circle's centre, relative to the centre, in radii.
        let x = (centre.x.clamp(0.0, width as f64) - centre.x) / across;
        let y = (centre.y.clamp(0.0, height as f64) - centre.y) / down;
        if x * x + y * y < 1.0 {
            return Ok(());
        }
        Err(CameraError::CircleOffImage { centre: (centre.x, centre.y), radius: across, width, height })
    }
}

impl Default for LensCircle {
    fn default() -> Self {
        Self::FITTED
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_circle_off_the_image_is_refused_and_one_at_its_edge_is_not() {
        let grid = PixelGrid::centred(100, 50, PixelPoint::new(50.0, 25.0), DVec2::splat(0.04));
        let place =
            |x: f64, y: f64| LensCircle { centre: Some(PixelPoint::new(x, y)), radius: Some(20.0) }.place(grid, 1.0);
        for (x, y) in [(50.0, 25.0), (-19.0, 25.0), (119.0, 25.0), (113.0, 63.0), (50.0, 69.0)] {
            assert!(place(x, y).is_ok(), "{x}, {y}");
        }
        for (x, y) in [(-20.0, 25.0), (121.0, 25.0), (115.0, 65.0), (50.0, 900.0)] {
            let error = place(x, y).unwrap_err().to_string();
            assert!(error.contains("radius 20") && error.contains("100x50"), "{error}");
        }
    }
}
