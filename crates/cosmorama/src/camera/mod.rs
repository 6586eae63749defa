//! Camera models: how a projection's picture lies in an image of a given size.
//!
//! A camera model knows what a size in pixels does not: the field of view, where the lens's circle goes, the shape of a pixel.
//! With a size it makes a [`View`]; without one it says which size suits it.

mod error;
mod field_stop;
pub(crate) mod flat;
mod footprint;
mod grid;
pub(crate) mod lens;
pub(crate) mod map;
mod placement;
mod screen_pixel;
mod st_map;
mod view;

use crate::projection::enum_dispatch;
pub use error::CameraError;
pub use field_stop::FieldStop;
pub use flat::cube_face::CubeFaceCamera;
pub use flat::field_of_view::FieldOfView;
pub use flat::layout_face::{FaceMapping, LayoutFaceCamera};
pub use flat::pannini::PanniniCamera;
pub use flat::perspective::PerspectiveCamera;
pub use footprint::{Covariance, Footprint};
pub use grid::{PixelBounds, PixelGrid, PixelPoint, PixelRect};
pub use lens::calibrated::{CalibratedCamera, CalibratedLens};
pub use lens::camera_matrix::CameraMatrix;
pub use lens::fisheye::{FisheyeCamera, FisheyeFit, LensScale};
pub use lens::framing::OmnimaxFraming;
pub use lens::fulldome::FulldomeCamera;
pub use lens::hugin::{HuginCamera, HuginProjection};
pub use lens::lens_circle::LensCircle;
pub use lens::mirror_ball::MirrorBallCamera;
pub use lens::omnimax::OmnimaxCamera;
pub use lens::stereographic::StereographicCamera;
pub use map::cylinder::{CylinderCamera, CylinderKind};
pub use map::equirect::{EquirectCamera, SamplePositions};
pub use map::octahedral::OctahedralCamera;
pub use map::world_map::WorldMapCamera;
pub use placement::{Canvas, Mirror, Placement};
pub use screen_pixel::ScreenPixel;
pub use st_map::StMapCamera;
pub(crate) use view::ROUNDING;
pub use view::View;

enum_dispatch! { ($)
    /// Every kind of frame, chosen at run time.
    pub enum CameraModel {
        /// A pinhole camera.
        Perspective(PerspectiveCamera),
        /// A face of a cube.
        CubeFace(CubeFaceCamera),
        /// A face of a cube map in equal angles, or with its samples on the edges.
        LayoutFace(LayoutFaceCamera),
        /// A fisheye.
        Fisheye(FisheyeCamera),
        /// A camera that was measured.
        Calibrated(CalibratedCamera),
        /// A picture of a Hugin project.
        Hugin(HuginCamera),
        /// A stereographic picture without a circle.
        Stereographic(StereographicCamera),
        /// A domemaster.
        Fulldome(FulldomeCamera),
        /// An Omnimax film frame.
        Omnimax(OmnimaxCamera),
        /// A panorama of longitude by latitude.
        Equirect(EquirectCamera),
        /// A panorama on a cylinder.
        Cylinder(CylinderCamera),
        /// A photograph of a mirror ball.
        MirrorBall(MirrorBallCamera),
        /// A map of the whole world.
        WorldMap(WorldMapCamera),
        /// A wide picture in Pannini's manner.
        Pannini(PanniniCamera),
        /// An octahedron unfolded.
        Octahedral(OctahedralCamera),
        /// A picture whose mapping is a table.
        StMap(StMapCamera),
    }
}

/// What each of them tells.
trait Camera {
    /// The view of an image that has pixels.
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError>;

    /// The height over the width that suits it.
    fn natural_ratio(&self) -> f64 {
        1.0
    }

    /// Whether a length in pixels says how large the picture is, so that no other size fits.
    fn is_measured_in_pixels(&self) -> bool {
        false
    }
}

impl CameraModel {
    /// The view of an image of `width` × `height` pixels, its camera looking ahead (a dome's to its zenith).
    ///
    /// # Errors
    /// When a parameter is out of its range, or an image has no pixels.
    pub fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        if width == 0 || height == 0 {
            return Err(CameraError::NoPixels { width, height });
        }
        each!(self, frame => frame.view(width, height))
    }

    /// The height that suits a width: square for fisheyes, domes and cube faces, the film's 1966:1436 for Omnimax,
    /// the shape of the field of view for a panorama, 4:3 for a camera unless its field of view is given both ways, twice as wide
    /// as high for a map of the world.
    pub fn natural_height(&self, width: usize) -> usize {
        let ratio = each!(self, frame => frame.natural_ratio());
        ((width as f64 * ratio).round() as usize).max(1)
    }

    /// The even size at which the centre has so many pixels a radian: parity with a source that has as many.
    ///
    /// # Errors
    /// When a parameter is out of its range, the place of a lens's circle is given in pixels, which fixes the size, or no
    /// image is that large.
    pub fn size_at(&self, pixels_per_radian: f64) -> Result<(usize, usize), CameraError> {
        /// Any size will do: pixels per radian are in proportion to it.
        const TRIAL: usize = 1 << 20;
        /// Sides that no file format counts.
        const LARGEST: f64 = u32::MAX as f64;
        if each!(self, frame => frame.is_measured_in_pixels()) {
            return Err(CameraError::SizeNeeded);
        }
        let trial = self.view(TRIAL, self.natural_height(TRIAL))?.pixels_per_radian();
        let width = (TRIAL as f64 * pixels_per_radian / trial / 2.0).round().max(1.0) * 2.0;
        let height = width * self.natural_height(TRIAL) as f64 / TRIAL as f64;
        if !(width <= LARGEST && height <= LARGEST) {
            return Err(CameraError::SizeUnbounded { width, height });
        }
        let height = self.natural_height(width as usize);
        Ok((width as usize, height + height % 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Angle;

    #[test]
    fn parity_with_a_cube_face_of_1024() {
        let face = CameraModel::CubeFace(CubeFaceCamera).view(1024, 1024).unwrap().pixels_per_radian();
        assert!((face - 512.0).abs() < 1e-9);
        let fisheye = CameraModel::Fulldome(FulldomeCamera::default()).size_at(face).unwrap();
        // 512 pixels a radian over 180°: 512 π.
        assert_eq!(fisheye, (1608, 1608));
        assert_eq!(CameraModel::CubeFace(CubeFaceCamera).size_at(face).unwrap(), (1024, 1024));
        assert_eq!(CameraModel::Equirect(EquirectCamera::default()).size_at(face).unwrap(), (3216, 1608));
        // The radius is 1.411269 times 512 pixels; the film frame is 1966:1436 and a little wider than the circle.
        assert_eq!(CameraModel::Omnimax(OmnimaxCamera::default()).size_at(face).unwrap(), (1542, 1126));
        let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(90.0)));
        assert_eq!(CameraModel::Perspective(camera).size_at(face).unwrap(), (1024, 768));
    }

    #[test]
    fn a_circle_in_pixels_wants_a_size() {
        let circle = LensCircle { radius: Some(500.0), ..LensCircle::FITTED };
        let frame = CameraModel::Omnimax(OmnimaxCamera { circle, ..OmnimaxCamera::default() });
        assert_eq!(frame.size_at(512.0), Err(CameraError::SizeNeeded));
    }

    #[test]
    fn what_no_image_can_hold_is_refused() {
        let degrees = |degrees| FieldOfView::Horizontal(Angle::from_degrees(degrees));
        let frame = |fov| CameraModel::Perspective(PerspectiveCamera::new(degrees(fov)));
        for (frame, pixels) in [(frame(90.0), 1e300), (frame(90.0), f64::INFINITY), (frame(179.999_999), 1e9)] {
            assert!(matches!(frame.size_at(pixels), Err(CameraError::SizeUnbounded { .. })), "{frame:?}");
        }
        assert!(frame(1e-300).size_at(512.0).is_ok_and(|(width, height)| width >= 2 && height >= 2));
    }

    #[test]
    fn nothing_is_no_image() {
        let error = CameraModel::CubeFace(CubeFaceCamera).view(0, 4).unwrap_err();
        assert_eq!(error, CameraError::NoPixels { width: 0, height: 4 });
    }
}
