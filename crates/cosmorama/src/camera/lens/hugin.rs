use glam::DVec2;

use crate::camera::error::check_field_of_view;
use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::ProjectionKind;
use crate::projection::azimuthal::{FisheyeLens, Hugin, HuginIdeal, Lens};
use crate::sphere::{Angle, Orientation};

/// Projection of an image or a panorama in a Hugin project, with its number after `f` in the project file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HuginProjection {
    /// Rectilinear: f0.
    Rectilinear,
    /// Swept panorama on a cylinder: f1.
    Cylinder,
    /// Equidistant fisheye, r = φ: f2 and f3.
    Equidistant,
    /// Equirectangular panorama: f4.
    Equirectangular,
    /// Orthographic fisheye, r = sin φ: f8.
    Orthographic,
    /// Stereographic fisheye, r = 2 tan(φ/2): f10.
    Stereographic,
    /// Equisolid fisheye, r = 2 sin(φ/2): f21.
    Equisolid,
    /// Mercator's map; panoramas only.
    Mercator,
    /// Lambert's equal-area cylinder; panoramas only.
    EqualArea,
}

impl HuginProjection {
    /// Returns the projection that lens number `f` of an image line of a `.pto` file stands for; `None` for unsupported numbers.
    pub const fn of_lens(f: u32) -> Option<Self> {
        Some(match f {
            0 => Self::Rectilinear,
            1 => Self::Cylinder,
            2 | 3 => Self::Equidistant,
            4 => Self::Equirectangular,
            8 => Self::Orthographic,
            10 => Self::Stereographic,
            21 => Self::Equisolid,
            _ => return None,
        })
    }

    /// Returns the projection that `f` means in a p-line, for panoramas of a part of the world; its numbers differ from
    /// an i-line's.
    pub const fn of_panorama(f: u32) -> Option<Self> {
        Some(match f {
            0 => Self::Rectilinear,
            1 => Self::Cylinder,
            2 => Self::Equirectangular,
            3 => Self::Equidistant,
            4 => Self::Stereographic,
            5 => Self::Mercator,
            8 => Self::EqualArea,
            14 => Self::Orthographic,
            9 | 15 => Self::Equisolid,
            _ => return None,
        })
    }
}

/// An image of a Hugin project, with the lens parameters of its i-line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HuginCamera {
    /// Lens type: f.
    pub projection: HuginProjection,
    /// Field of view across the image's width, before the correction: v.
    pub field_of_view: Angle,
    /// Coefficients a, b and c of the correction.
    pub correction: [f64; 3],
    /// Offset of the axis from the image's centre, right and down, in pixels: d and e.
    pub shift: [f64; 2],
}

impl Camera for HuginCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let (w, h) = (width as f64, height as f64);
        let focal = self.focal(w)?;
        let projection = self.kind(focal, w.min(h))?;
        let [right, down] = self.shift;
        let centre = PixelPoint::new(w / 2.0 + right, h / 2.0 + down);
        let grid = PixelGrid::centred(width, height, centre, DVec2::splat(focal.recip()));
        if let ProjectionKind::Fisheye(lens) = &projection {
            self.check_correction(&lens.0, focal, (w / 2.0 + right.abs(), h / 2.0 + down.abs()))?;
        }
        Ok(View { projection, orientation: Orientation::IDENTITY, grid, stop: FieldStop::NONE })
    }

    /// Returns height over width of most cameras' pictures.
    fn natural_ratio(&self) -> f64 {
        0.75
    }

    /// Returns true: d and e are in pixels.
    fn is_measured_in_pixels(&self) -> bool {
        self.shift != [0.0; 2]
    }
}

impl HuginCamera {
    /// Returns pixels per unit of the projection.
    fn focal(&self, width: f64) -> Result<f64, CameraError> {
        let (greatest, below) = match self.projection {
            HuginProjection::Rectilinear => (180.0, true),
            HuginProjection::Orthographic => (180.0, false),
            HuginProjection::Stereographic => (360.0, true),
            HuginProjection::Equisolid
            | HuginProjection::Cylinder
            | HuginProjection::Equirectangular
            | HuginProjection::Mercator
            | HuginProjection::EqualArea => (360.0, false),
            // The circle may be smaller than the image.
            HuginProjection::Equidistant => (1000.0, false),
        };
        check_field_of_view("v, the field of view across the image,", self.field_of_view, greatest, below)?;
        Ok(width / 2.0 / self.ideal(self.field_of_view * 0.5))
    }

    /// Returns the distance from the axis, before the correction, at which an angle is seen.
    fn ideal(&self, angle: Angle) -> f64 {
        let half = angle * 0.5;
        match self.projection {
            HuginProjection::Rectilinear => angle.tan(),
            HuginProjection::Orthographic => angle.sin_cos().0,
            HuginProjection::Stereographic => 2.0 * half.tan(),
            HuginProjection::Equisolid => 2.0 * half.sin_cos().0,
            _ => angle.radians(),
        }
    }

    /// Checks that the correction does not turn back within the image, by radii before and after it. A rectilinear lens
    /// shows every corner. A fisheye's circle may end anywhere beyond 90°, corners included.
    fn check_correction(&self, lens: &FisheyeLens, focal: f64, reach: (f64, f64)) -> Result<(), CameraError> {
        let (angle, end) = match self.projection {
            HuginProjection::Rectilinear => (90.0, reach.0.hypot(reach.1)),
            _ => (89.999, reach.0),
        };
        let turn = Angle::from_radians(lens.reach());
        let seen = lens.radius(lens.reach()).map_or(f64::INFINITY, |radius| radius * focal);
        let ideal = self.ideal(turn) * focal;
        if turn.degrees() < angle && self.correction != [0.0; 3] && seen.min(ideal) < end {
            return Err(CameraError::CorrectionTurnsBack { degrees: turn.degrees(), ideal, radius: seen, end });
        }
        Ok(())
    }

    fn kind(&self, focal: f64, shorter: f64) -> Result<ProjectionKind, CameraError> {
        let is_ideal = self.correction == [0.0; 3];
        let corrected = |ideal, plain| {
            if is_ideal {
                return Ok(plain);
            }
            let lens = Hugin::from_abc(ideal, self.correction, focal / (shorter / 2.0));
            lens.map(|lens| ProjectionKind::fisheye(FisheyeLens::Hugin(lens))).map_err(CameraError::Lens)
        };
        match self.projection {
            HuginProjection::Rectilinear => corrected(HuginIdeal::Rectilinear, ProjectionKind::PERSPECTIVE),
            HuginProjection::Equidistant => corrected(HuginIdeal::Equidistant, ProjectionKind::EQUIDISTANT),
            HuginProjection::Orthographic => {
                corrected(HuginIdeal::Orthographic, ProjectionKind::fisheye(FisheyeLens::ORTHOGRAPHIC))
            }
            HuginProjection::Stereographic => {
                corrected(HuginIdeal::Stereographic, ProjectionKind::fisheye(FisheyeLens::STEREOGRAPHIC))
            }
            HuginProjection::Equisolid => {
                corrected(HuginIdeal::Equisolid, ProjectionKind::fisheye(FisheyeLens::EQUISOLID))
            }
            HuginProjection::Cylinder if is_ideal => Ok(ProjectionKind::CENTRAL_CYLINDER),
            HuginProjection::Equirectangular if is_ideal => Ok(ProjectionKind::EQUIRECTANGULAR),
            HuginProjection::Mercator if is_ideal => Ok(ProjectionKind::MERCATOR),
            HuginProjection::EqualArea if is_ideal => Ok(ProjectionKind::EQUAL_AREA_CYLINDER),
            HuginProjection::Cylinder
            | HuginProjection::Equirectangular
            | HuginProjection::Mercator
            | HuginProjection::EqualArea => Err(CameraError::CorrectedPanorama),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    const LENS: HuginCamera = HuginCamera {
        projection: HuginProjection::Rectilinear,
        field_of_view: Angle::from_degrees(90.0),
        correction: [0.0; 3],
        shift: [3.0, -2.0],
    };

    #[test]
    fn the_width_spans_v_and_the_axis_is_shifted() {
        for (projection, at_edge) in [
            (HuginProjection::Rectilinear, 45.0),
            (HuginProjection::Equidistant, 45.0),
            (HuginProjection::Equisolid, 45.0),
            (HuginProjection::Stereographic, 45.0),
            (HuginProjection::Orthographic, 45.0),
        ] {
            for correction in [[0.0; 3], [0.01, -0.02, 0.005]] {
                // The width is the shorter side here, and the correction does nothing at half the shorter side.
                let view = HuginCamera { projection, correction, ..LENS }.view(300, 400).unwrap();
                let axis = view.direction(PixelPoint::new(153.0, 198.0)).unwrap();
                assert!(axis.angle_to(Direction::FRONT).degrees() < 1e-9);
                let edge = view.direction(PixelPoint::new(303.0, 198.0)).unwrap();
                assert!((edge.angle_to(Direction::FRONT).degrees() - at_edge).abs() < 1e-9, "{projection:?}");
            }
        }
    }

    #[test]
    fn a_correction_that_turns_back_within_the_image_is_told() {
        let error = HuginCamera { correction: [0.0, -0.4, 0.0], ..LENS }.view(400, 300).unwrap_err().to_string();
        assert!(error.contains("turn back") && error.contains("pixels"), "{error}");
        // Here only the radius before the correction is within the image, and here the image is a fisheye's.
        for (projection, correction) in
            [(HuginProjection::Rectilinear, [0.0, -9.0, 0.0]), (HuginProjection::Equidistant, [0.0, -0.4, 0.0])]
        {
            let error = HuginCamera { projection, correction, ..LENS }.view(400, 300).unwrap_err().to_string();
            assert!(error.contains("turn back") && error.contains("pixels"), "{error}");
        }
        let panorama = HuginCamera { projection: HuginProjection::Cylinder, correction: [0.0, 0.1, 0.0], ..LENS };
        assert_eq!(panorama.view(400, 300), Err(CameraError::CorrectedPanorama));
    }
}
