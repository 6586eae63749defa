//! Inputs: files found and probed, their views, and lists of views.

mod builtin;
pub(crate) mod canvas;
pub(crate) mod eye;
pub(crate) mod faces;
pub(crate) mod files;
mod find;
pub(crate) mod lists;
pub(crate) mod pieces;
mod planned_input;
pub(crate) mod spec_files;

pub use builtin::Builtin;
pub use faces::face_view::face_placement;
pub use files::access::{Disk, Files, InMemory, probe, read};
pub use files::folder::is_one_file;
pub use files::frames::existing as existing_frames;
pub use files::view_files::ViewFiles;
pub use find::{Input, InputView};
pub use lists::listing::{Listed, listed};
pub use pieces::place::Place;

pub(crate) use eye::EyePart;
pub(crate) use faces::face_file::Face;
pub(crate) use faces::face_shape::FacePicture;
pub(crate) use files::access::{Access, read_in};
pub(crate) use files::decoded_picture::DecodedPicture;
pub(crate) use find::SAME_FOR_BOTH;
pub(crate) use pieces::piece::Piece;
