//! Cube layouts: how the six faces of a cube lie in one picture.

mod cube_layout;
mod error;
mod face_order;
mod face_part;
mod face_placement;
mod kind;

pub use cube_layout::{CubeLayout, PlacedFace};
pub use error::LayoutError;
pub use face_order::FaceOrder;
pub use face_part::FacePart;
pub use face_placement::FacePlacement;
pub use kind::LayoutKind;
