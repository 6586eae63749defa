use glam::DVec2;

use crate::camera::{PixelGrid, PixelPoint};

/// Placement of the Omnimax circle in the film frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OmnimaxFraming {
    /// The frame shows the circle from its top down to the lower cut, as far as the frame's shape permits.
    #[default]
    Fit,
    /// The whole circle is in the frame, centred and as large as possible.
    Circle,
}

/// Width over height of the visible part: 2/(1 + r(45°)), the constant of POV-Ray's `omnimax` camera.
const FIT_ASPECT: f64 = 1.283458;

impl OmnimaxFraming {
    /// Returns the grid of a frame; `pixel_aspect` is a pixel's width over its height. One plane unit is the lens
    /// radius.
    pub fn grid(self, width: usize, height: usize, pixel_aspect: f64) -> PixelGrid {
        let (w, h) = (width as f64, height as f64);
        let aspect = w / h * pixel_aspect;
        match self {
            Self::Circle => {
                let radius = (w * pixel_aspect).min(h) / 2.0;
                PixelGrid::centred(
                    width,
                    height,
                    PixelPoint::new(w / 2.0, h / 2.0),
                    DVec2::new(pixel_aspect, 1.0) / radius,
                )
            }
            // With X and Y in −1…1 over the frame: a wide frame leaves black at the sides, x = X·A/K,
            // y = (Y − 1)/K + 1; a middling one cuts the bottom, y = (Y − 1)/A + 1; a tall one shows all, y = Y/A.
            Self::Fit if aspect > FIT_ASPECT => {
                Self::touching_top(width, height, 2.0 / w * aspect / FIT_ASPECT, 2.0 / h / FIT_ASPECT)
            }
            Self::Fit if aspect > 1.0 => Self::touching_top(width, height, 2.0 / w, 2.0 / h / aspect),
            Self::Fit => PixelGrid::centred(
                width,
                height,
                PixelPoint::new(w / 2.0, h / 2.0),
                DVec2::new(2.0 / w, 2.0 / h / aspect),
            ),
        }
    }

    /// Returns the grid whose circle touches the frame's top edge, horizontally centred.
    fn touching_top(width: usize, height: usize, step_x: f64, step_y: f64) -> PixelGrid {
        let centre = PixelPoint::new(width as f64 / 2.0, 1.0 / step_y);
        PixelGrid::centred(width, height, centre, DVec2::new(step_x, step_y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_frame() {
        let grid = OmnimaxFraming::Fit.grid(1966, 1436, 1.0);
        let centre = grid.to_pixel(crate::projection::PlanePoint::new(0.0, 0.0));
        assert!((centre.x - 983.0).abs() < 1e-9 && (centre.y - 921.523).abs() < 1e-3, "{centre:?}");
        assert!((1.0 / grid.step().x - 921.523).abs() < 1e-3);
        assert!((1.0 / grid.step().y - 921.523).abs() < 1e-3);
    }
}
