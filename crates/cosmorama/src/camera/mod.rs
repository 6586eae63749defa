//! Camera models: the placement of a projection's picture in an image of a given size.
//!
//! A camera model holds the field of view, the place of the lens's circle and the shape of a pixel. With a size in
//! pixels it makes a [`View`]; without one it proposes a suitable size.

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
use crate::sphere::Angle;
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
    /// Any camera model, chosen at run time.
    pub enum CameraModel {
        /// A pinhole camera.
        Perspective(PerspectiveCamera),
        /// A face of a cube.
        CubeFace(CubeFaceCamera),
        /// A face of a cube map that is equi-angular, has samples on its edges, or extends beyond 90°.
        LayoutFace(LayoutFaceCamera),
        /// A fisheye.
        Fisheye(FisheyeCamera),
        /// A calibrated camera.
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
        /// A wide picture in Pannini projection.
        Pannini(PanniniCamera),
        /// An octahedron unfolded.
        Octahedral(OctahedralCamera),
        /// A picture whose mapping is a table.
        StMap(StMapCamera),
    }
}

/// Behaviour of one camera model.
trait Camera {
    /// Returns the view of an image of `width` × `height` pixels, neither of them 0.
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError>;

    /// Returns the preferred height over width.
    fn natural_ratio(&self) -> f64 {
        1.0
    }

    /// Returns this camera with another field of view, if it has a single one that can change while all else stays.
    fn with_field_of_view(&self, _: Angle) -> Option<CameraModel> {
        None
    }

    /// Returns whether a length in pixels fixes the scale, so that the image's size cannot be chosen freely.
    fn is_measured_in_pixels(&self) -> bool {
        false
    }
}

impl CameraModel {
    /// Returns the view of an image of `width` × `height` pixels. The camera looks ahead; that of a dome looks to its
    /// zenith.
    ///
    /// # Errors
    /// When a parameter is out of its range, or the image has no pixels.
    pub fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        if width == 0 || height == 0 {
            return Err(CameraError::NoPixels { width, height });
        }
        each!(self, frame => frame.view(width, height))
    }

    /// Returns this camera with another field of view, measured as its own is; `None` for a model that has no single one which
    /// could change while all else stays.
    pub fn with_field_of_view(&self, field_of_view: Angle) -> Option<Self> {
        each!(self, camera => camera.with_field_of_view(field_of_view))
    }

    /// Returns the height that suits a width. Fisheyes, domes and cube faces are square, Omnimax frames have the film's
    /// 1966:1436, and panoramas the shape of their field of view. Cameras have 4:3 unless both angles are given, and
    /// maps of the world 2:1.
    pub fn natural_height(&self, width: usize) -> usize {
        let ratio = each!(self, frame => frame.natural_ratio());
        ((width as f64 * ratio).round() as usize).max(1)
    }

    /// Returns the size, in even numbers, at which the centre has so many pixels per radian: that of a source with the
    /// same resolution.
    ///
    /// # Errors
    /// When a parameter is out of its range, when the circle is placed in pixels, which fixes the size, or when the
    /// size is larger than any image.
    pub fn size_at(&self, pixels_per_radian: f64) -> Result<(usize, usize), CameraError> {
        /// Size at which the resolution is measured; any would do, since pixels per radian are proportional to it.
        const TRIAL: usize = 1 << 20;
        /// Largest side that a file format can hold.
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
        let width = width as usize;
        let height = self.natural_height(width);
        let wider = self.natural_height(width + 2);
        // A panorama stays exactly twice as wide as high, which is how files without metadata are known.
        if matches!(self, Self::Equirect(_)) && !height.is_multiple_of(2) && wider.is_multiple_of(2) {
            return Ok((width + 2, wider));
        }
        Ok((width, height + height % 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn another_field_of_view_is_measured_as_the_cameras_own() {
        let angle = Angle::from_degrees(40.0);
        let of = |field_of_view| CameraModel::from(PerspectiveCamera::new(field_of_view));
        let wide = Angle::from_degrees(90.0);
        for kind in [FieldOfView::Horizontal, FieldOfView::Vertical, FieldOfView::Diagonal] {
            assert_eq!(of(kind(wide)).with_field_of_view(angle), Some(of(kind(angle))));
        }
        let both = FieldOfView::Both { horizontal: wide, vertical: wide };
        assert_eq!(of(both).with_field_of_view(angle), None);
        assert_eq!(CameraModel::from(EquirectCamera::default()).with_field_of_view(angle), None);
        let dome = FulldomeCamera { field_of_view: angle, ..FulldomeCamera::default() };
        assert_eq!(CameraModel::from(FulldomeCamera::default()).with_field_of_view(angle), Some(dome.into()));
    }

    #[test]
    fn nothing_is_no_image() {
        let error = CameraModel::CubeFace(CubeFaceCamera).view(0, 4).unwrap_err();
        assert_eq!(error, CameraError::NoPixels { width: 0, height: 4 });
    }
}
