//! Frames: how a projection's picture lies in an image of a given size.
//!
//! A frame knows what a size in pixels does not: the field of view, where the lens's circle goes, the shape of a pixel.
//! With a size it makes a [`View`]; without one it says which size suits it.

mod calibrated;
mod camera_matrix;
mod cube_face;
mod cylinder;
mod equirect;
mod error;
mod field_of_view;
mod fisheye;
mod fulldome;
mod hugin;
mod layout_face;
mod lens_circle;
mod mirror_ball;
mod octahedral;
mod omnimax;
mod pannini;
mod perspective;
mod placement;
mod st_map;
mod stereographic;
mod world_map;

pub use calibrated::{CalibratedFrame, CalibratedLens};
pub use camera_matrix::CameraMatrix;
pub use cube_face::CubeFaceFrame;
pub use cylinder::{CylinderFrame, CylinderKind};
pub use equirect::{EquirectFrame, SamplePositions};
pub use error::FrameError;
pub use field_of_view::FieldOfView;
pub use fisheye::{FisheyeFit, FisheyeFrame, LensScale};
pub use fulldome::FulldomeFrame;
pub use hugin::{HuginFrame, HuginProjection};
pub use layout_face::{FaceMapping, LayoutFaceFrame};
pub use lens_circle::LensCircle;
pub use mirror_ball::MirrorBallFrame;
pub use octahedral::OctahedralFrame;
pub use omnimax::OmnimaxFrame;
pub use pannini::PanniniFrame;
pub use perspective::PerspectiveFrame;
pub use placement::{Canvas, Mirror, Placement};
pub use st_map::StMapFrame;
pub use stereographic::StereographicFrame;
pub use world_map::WorldMapFrame;

use super::View;
use crate::projection::one_of;

one_of! { ($)
    /// Every kind of frame, chosen at run time.
    pub enum Frame {
        /// A pinhole camera.
        Perspective(PerspectiveFrame),
        /// A face of a cube.
        CubeFace(CubeFaceFrame),
        /// A face of a cube map in equal angles, or with its samples on the edges.
        LayoutFace(LayoutFaceFrame),
        /// A fisheye.
        Fisheye(FisheyeFrame),
        /// A camera that was measured.
        Calibrated(CalibratedFrame),
        /// A picture of a Hugin project.
        Hugin(HuginFrame),
        /// A stereographic picture without a circle.
        Stereographic(StereographicFrame),
        /// A domemaster.
        Fulldome(FulldomeFrame),
        /// An Omnimax film frame.
        Omnimax(OmnimaxFrame),
        /// A panorama of longitude by latitude.
        Equirect(EquirectFrame),
        /// A panorama on a cylinder.
        Cylinder(CylinderFrame),
        /// A photograph of a mirror ball.
        MirrorBall(MirrorBallFrame),
        /// A map of the whole world.
        WorldMap(WorldMapFrame),
        /// A wide picture in Pannini's manner.
        Pannini(PanniniFrame),
        /// An octahedron unfolded.
        Octahedral(OctahedralFrame),
        /// A picture whose mapping is a table.
        StMap(StMapFrame),
    }
}

/// What each of them tells.
trait ImageFrame {
    /// The view of an image that has pixels.
    fn view(&self, width: usize, height: usize) -> Result<View, FrameError>;

    /// The height over the width that suits it.
    fn natural_ratio(&self) -> f64 {
        1.0
    }

    /// Whether a length in pixels says how large the picture is, so that no other size fits.
    fn is_measured_in_pixels(&self) -> bool {
        false
    }
}

impl Frame {
    /// The view of an image of `width` × `height` pixels, its camera looking ahead (a dome's to its zenith).
    ///
    /// # Errors
    /// When a parameter is out of its range, or an image has no pixels.
    pub fn view(&self, width: usize, height: usize) -> Result<View, FrameError> {
        if width == 0 || height == 0 {
            return Err(FrameError::NoPixels { width, height });
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
    pub fn size_at(&self, pixels_per_radian: f64) -> Result<(usize, usize), FrameError> {
        /// Any size will do: pixels per radian are in proportion to it.
        const TRIAL: usize = 1 << 20;
        /// Sides that no file format counts.
        const LARGEST: f64 = u32::MAX as f64;
        if each!(self, frame => frame.is_measured_in_pixels()) {
            return Err(FrameError::SizeNeeded);
        }
        let trial = self.view(TRIAL, self.natural_height(TRIAL))?.pixels_per_radian();
        let width = (TRIAL as f64 * pixels_per_radian / trial / 2.0).round().max(1.0) * 2.0;
        let height = width * self.natural_height(TRIAL) as f64 / TRIAL as f64;
        if !(width <= LARGEST && height <= LARGEST) {
            return Err(FrameError::SizeUnbounded { width, height });
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
        let face = Frame::CubeFace(CubeFaceFrame).view(1024, 1024).unwrap().pixels_per_radian();
        assert!((face - 512.0).abs() < 1e-9);
        let fisheye = Frame::Fulldome(FulldomeFrame::default()).size_at(face).unwrap();
        // 512 pixels a radian over 180°: 512 π.
        assert_eq!(fisheye, (1608, 1608));
        assert_eq!(Frame::CubeFace(CubeFaceFrame).size_at(face).unwrap(), (1024, 1024));
        assert_eq!(Frame::Equirect(EquirectFrame::default()).size_at(face).unwrap(), (3216, 1608));
        // The radius is 1.411269 times 512 pixels; the film frame is 1966:1436 and a little wider than the circle.
        assert_eq!(Frame::Omnimax(OmnimaxFrame::default()).size_at(face).unwrap(), (1542, 1126));
        let camera = PerspectiveFrame::new(FieldOfView::Horizontal(Angle::from_degrees(90.0)));
        assert_eq!(Frame::Perspective(camera).size_at(face).unwrap(), (1024, 768));
    }

    #[test]
    fn a_circle_in_pixels_wants_a_size() {
        let circle = LensCircle { radius: Some(500.0), ..LensCircle::FITTED };
        let frame = Frame::Omnimax(OmnimaxFrame { circle, ..OmnimaxFrame::default() });
        assert_eq!(frame.size_at(512.0), Err(FrameError::SizeNeeded));
    }

    #[test]
    fn what_no_image_can_hold_is_refused() {
        let degrees = |degrees| FieldOfView::Horizontal(Angle::from_degrees(degrees));
        let frame = |fov| Frame::Perspective(PerspectiveFrame::new(degrees(fov)));
        for (frame, pixels) in [(frame(90.0), 1e300), (frame(90.0), f64::INFINITY), (frame(179.999_999), 1e9)] {
            assert!(matches!(frame.size_at(pixels), Err(FrameError::SizeUnbounded { .. })), "{frame:?}");
        }
        assert!(frame(1e-300).size_at(512.0).is_ok_and(|(width, height)| width >= 2 && height >= 2));
    }

    #[test]
    fn nothing_is_no_image() {
        let error = Frame::CubeFace(CubeFaceFrame).view(0, 4).unwrap_err();
        assert_eq!(error, FrameError::NoPixels { width: 0, height: 4 });
    }
}
