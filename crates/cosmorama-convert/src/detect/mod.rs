//! Detection of what a picture shows, where nothing is declared: by metadata, shape, pixels, and the borders of faces.

pub(crate) mod cross_variants;
mod decision;
pub(crate) mod detection;
pub(crate) mod disc;
mod face_continuity;
mod mirrored_faces;
mod oval;
pub(crate) mod pixels;
mod seams;
mod split;

pub use detection::{Likely, likely};
pub use face_continuity::{Continuity, FacePixels, GivenFaces};
pub use pixels::{damage_of, light_of};

pub(crate) use cross_variants::Readings;
pub(crate) use decision::{Examined, Guess};
pub(crate) use pixels::{Evidence, Seen, unless_damaged};
pub(crate) use split::{Circles, Twins};
