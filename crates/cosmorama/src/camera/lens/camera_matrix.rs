use glam::DVec2;

use crate::camera::CameraError;
use crate::sphere::Angle;

/// Affine map from a calibrated lens's plane to pixels: OpenCV's camera matrix, or OCamCalib's affine parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraMatrix {
    /// Pixels per unit of the lens's plane, along rows and along columns.
    pub(crate) focal: DVec2,
    /// Skew: units to the right for each unit down.
    pub(crate) skew: f64,
    /// Principal point, from the image's outer corner, in pixels.
    pub(crate) principal: DVec2,
    /// Rotation of the sensor about the axis.
    pub(crate) roll: Angle,
}

/// Least determinant of a matrix that is not singular: that of focal lengths of a millionth of a pixel.
const LEAST_DETERMINANT: f64 = 1e-12;

impl CameraMatrix {
    /// Returns the matrix whose two rows map a point (right, down, 1) of the lens's plane to columns and rows of the
    /// image. As in OpenCV and OCamCalib, (0, 0) is the CENTRE of the first pixel.
    ///
    /// # Errors
    /// When the matrix mirrors the picture, is singular, or holds a value that is not finite.
    pub fn from_rows(rows: [[f64; 3]; 2]) -> Result<Self, CameraError> {
        let [[a, b, x], [c, d, y]] = rows;
        let determinant = a * d - b * c;
        if !(determinant >= LEAST_DETERMINANT && rows.as_flattened().iter().all(|number| number.is_finite())) {
            return Err(CameraError::CameraMatrix { determinant });
        }
        // The matrix is an upper triangular one times a rotation, which is that of the sensor.
        let across = c.hypot(d);
        let (sin, cos) = (c / across, d / across);
        let focal = DVec2::new(a * cos - b * sin, across);
        Ok(Self {
            focal,
            skew: (a * sin + b * cos) / focal.x,
            principal: DVec2::new(x + 0.5, y + 0.5),
            // The picture turns clockwise when the camera turns the other way.
            roll: Angle::from_radians(-sin.atan2(cos)),
        })
    }

    /// Returns the camera matrix of the image resized by these factors along x and y.
    pub(crate) fn scaled(self, scale: DVec2) -> Self {
        let (focal, principal) = (self.focal * scale, self.principal * scale);
        // Pixels are scaled, not the plane, so the skew stays what it is.
        Self { focal, principal, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_sensor_is_taken_apart() {
        let (sin, cos) = 0.1f64.sin_cos();
        let (fx, fy, skew) = (300.0, 310.0, 0.02);
        let rows = [[fx * (cos + skew * sin), fx * (skew * cos - sin), 10.0], [fy * sin, fy * cos, 20.0]];
        let matrix = CameraMatrix::from_rows(rows).unwrap();
        assert!((matrix.focal - DVec2::new(fx, fy)).length() < 1e-10 && (matrix.skew - skew).abs() < 1e-12);
        assert!((matrix.roll.radians() + 0.1).abs() < 1e-12);
        assert_eq!(matrix.principal, DVec2::new(10.5, 20.5));
        assert!(CameraMatrix::from_rows([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]).is_err());
        assert!(CameraMatrix::from_rows([[f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0]]).is_err());
    }
}
