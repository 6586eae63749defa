//! What is made: pictures of a projection, laid into files.

pub(crate) mod aspect;
pub(crate) mod gpano;
pub(crate) mod picture;
pub(crate) mod sheets;
pub(crate) mod size;

pub use picture::{Picture, Place};
pub(crate) use sheets::{Sheet, Target, TargetFile, TargetView};

use crate::conversion::GeometrySettings;
use crate::diagnostic::Diagnostic;

/// What should be known of an output's shape.
pub(crate) fn told_of_shape(geometry: &GeometrySettings, target: &Target) -> Option<Diagnostic> {
    aspect::warning(geometry, target).or_else(|| gpano::warning(geometry, target))
}
