//! Hugin projects (`.pto`): the text format of the Panorama Tools, as far as it describes where pictures look.

mod error;
mod line;
mod project;

pub use error::PtoError;
pub use project::{PtoImage, PtoPanorama, PtoProject};
