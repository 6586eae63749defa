//! Pictures packed into images: faces in a layout, two lenses, two eyes, and parts of a canvas.

pub(crate) mod canvas;
pub(crate) mod eye;
pub(crate) mod face_view;
pub(crate) mod piece;
pub(crate) mod place;
pub(crate) mod size;

pub use face_view::face_placement;
pub use place::Place;

pub(crate) use eye::EyePart;
pub(crate) use piece::Piece;
