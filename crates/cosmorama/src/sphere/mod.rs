//! Directions, orientations and angles: the sphere of the world around a point.
//!
//! The world frame is right-handed: +X right, +Y up, −Z front.

mod angle;
mod cube_face;
mod direction;
mod extent;
mod orientation;

pub use angle::Angle;
pub use cube_face::CubeFace;
pub use direction::{Direction, DirectionJacobian};
pub use extent::Extent;
pub use orientation::Orientation;
