//! Layouts of several pictures in one image: six faces of a cube, two fisheyes, or the pictures of two eyes.

mod arrangement;
mod cube_layout;
mod dual_fisheye;
mod error;
mod face_order;
mod face_part;
mod face_placement;
mod layout_kind;
mod naming;
mod stereo;

pub use arrangement::Arrangement;
pub use cube_layout::{CubeLayout, PlacedFace};
pub use dual_fisheye::{DualFisheye, DualLens, LensSide, PlacedLens};
pub use error::LayoutError;
pub use face_order::FaceOrder;
pub use face_part::FacePart;
pub use face_placement::FacePlacement;
pub use layout_kind::LayoutKind;
pub use naming::Naming;
pub use stereo::{Eye, Stereo};
