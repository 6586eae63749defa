use glam::DVec2;

use crate::camera::error::{check_field_of_view, rounded};
use crate::camera::{Camera, CameraError, CameraMatrix, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::azimuthal::{Azimuthal, FisheyeLens, Lens};
use crate::projection::{BrownConrady, Calibrated, PlanePoint, Projection, ProjectionKind};
use crate::sphere::{Angle, Direction, Orientation};

/// The lens of a measured camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CalibratedLens {
    /// A fisheye.
    Fisheye(FisheyeLens),
    /// A pinhole camera with lens distortion.
    Pinhole(BrownConrady),
}

/// A camera calibrated by another program: focal lengths and principal point are in pixels of the calibrated image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibratedCamera {
    /// Mapping of angles to radii.
    pub lens: CalibratedLens,
    /// Mapping of the lens's plane to pixels.
    pub matrix: CameraMatrix,
    /// Columns and rows of the calibrated image. An image of another size is taken as that one resized.
    pub size: Option<(usize, usize)>,
    /// Field of view around the axis that is used; the whole image unless given.
    pub field_of_view: Option<Angle>,
}

/// Distance from the axis, in focal lengths, beyond which a lens's image counts as infinite.
const INFINITELY_FAR: f64 = 1e6;

/// Factor by which the projection extends beyond the angle of the image's corners, because kernels reach a little
/// farther.
const BEYOND_CORNERS: f64 = 1.05;

impl Camera for CalibratedCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let matrix = self.matrix.scaled(self.scale(width, height)?);
        let CameraMatrix { focal, principal, .. } = matrix;
        let centre = PixelPoint::new(principal.x, principal.y);
        let grid = PixelGrid::centred(width, height, centre, focal.recip());
        let (projection, stop) = match self.lens {
            CalibratedLens::Fisheye(lens) => self.fisheye(lens, &matrix, &grid)?,
            CalibratedLens::Pinhole(lens) => (self.pinhole(lens, &matrix, &grid)?, FieldStop::NONE),
        };
        let orientation = Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::ZERO, matrix.roll);
        Ok(View { projection, orientation, grid, stop })
    }

    /// Returns height over width of the calibrated image.
    fn natural_ratio(&self) -> f64 {
        self.size
            .filter(|(width, height)| width.min(height) > &0)
            .map_or(0.75, |(width, height)| height as f64 / width as f64)
    }

    fn is_measured_in_pixels(&self) -> bool {
        self.size.is_none()
    }
}

impl CalibratedCamera {
    /// Computes the scale factors from the calibrated image to one of this size.
    fn scale(&self, width: usize, height: usize) -> Result<DVec2, CameraError> {
        let Some((w, h)) = self.size else { return Ok(DVec2::ONE) };
        if w == 0 || h == 0 {
            return Err(CameraError::CalibrationSize { found: (width, height), measured: (w, h) });
        }
        let found = DVec2::new(width as f64, height as f64);
        let measured = DVec2::new(w as f64, h as f64);
        let scale = found / measured;
        // The sides of an image are whole numbers of pixels, so a factor may be off by half a pixel.
        let mean = f64::midpoint(scale.x, scale.y);
        if (found - measured * mean).abs().max_element() > 0.51 {
            return Err(CameraError::CalibrationSize { found: (width, height), measured: (w, h) });
        }
        Ok(scale)
    }

    fn fisheye(
        &self,
        lens: FisheyeLens,
        matrix: &CameraMatrix,
        grid: &PixelGrid,
    ) -> Result<(ProjectionKind, FieldStop), CameraError> {
        let end = Some(lens.reach()).filter(|reach| *reach < std::f64::consts::PI);
        let turn = end.and_then(|reach| lens.radius(reach)).filter(|radius| *radius < INFINITELY_FAR);
        let farthest = corners(matrix, grid).map(|corner| corner.x.hypot(corner.y)).into_iter().fold(0.0, f64::max);
        let limit = self.limit(lens.reach(), turn, turn.is_some_and(|turn| farthest > turn), matrix)?;
        if matrix.skew != 0.0 {
            let camera = Calibrated::new(Azimuthal(lens), matrix.skew, limit);
            return Ok((ProjectionKind::SkewedFisheye(camera), FieldStop::NONE));
        }
        let rim = lens.radius(limit.radians()).filter(|radius| *radius < INFINITELY_FAR);
        Ok((ProjectionKind::fisheye(lens), rim.map_or(FieldStop::NONE, FieldStop::circle)))
    }

    fn pinhole(
        &self,
        lens: BrownConrady,
        matrix: &CameraMatrix,
        grid: &PixelGrid,
    ) -> Result<ProjectionKind, CameraError> {
        let seen = corners(matrix, grid).map(|corner| lens.unproject(corner));
        let turn = lens.folds().then(|| lens.rim());
        let limit = self.limit(lens.reach(), turn, turn.is_some() && seen.contains(&None), matrix)?;
        let angles = seen.into_iter().flatten().map(|direction| direction.angle_to(Direction::FRONT).radians());
        let needed = angles.fold(0.0, f64::max) * BEYOND_CORNERS;
        let all_seen = !seen.contains(&None);
        let limit = if all_seen { Angle::from_radians(limit.radians().min(needed)) } else { limit };
        Ok(ProjectionKind::Pinhole(Calibrated::new(lens, matrix.skew, limit)))
    }

    /// Returns the greatest angle from the axis that is used, in a lens that ends at `reach` radians. `turn` is the
    /// radius at which its formula turns back, if it does.
    fn limit(
        &self,
        reach: f64,
        turn: Option<f64>,
        is_in_image: bool,
        matrix: &CameraMatrix,
    ) -> Result<Angle, CameraError> {
        let greatest = 2.0 * reach.to_degrees();
        match self.field_of_view {
            Some(angle) => {
                check_field_of_view("the field of view", angle, rounded(greatest), false)?;
                Ok(Angle::from_radians((angle.radians() / 2.0).min(reach)))
            }
            None => match turn.filter(|_| is_in_image) {
                Some(radius) => Err(CameraError::CalibrationTurnsBack {
                    radius: radius * f64::midpoint(matrix.focal.x, matrix.focal.y),
                    greatest,
                }),
                None => Ok(Angle::from_radians(reach)),
            },
        }
    }
}

/// Returns the image's corners in the lens's plane.
fn corners(matrix: &CameraMatrix, grid: &PixelGrid) -> [PlanePoint; 4] {
    let (right, bottom) = (grid.width() as f64, grid.height() as f64);
    [(0.0, 0.0), (right, 0.0), (0.0, bottom), (right, bottom)].map(|(x, y)| {
        let point = grid.to_plane(PixelPoint::new(x, y));
        PlanePoint::new(point.x + matrix.skew * point.y, point.y)
    })
}
