//! Targets: pictures of a projection, laid out in files.

pub(crate) mod aspect;
mod assembly;
mod chain;
pub(crate) mod gpano;
pub(crate) mod light;
mod movement;
pub(crate) mod picture;
pub(crate) mod sheets;
mod strip;

pub(crate) use chain::{name_of_level, whole_chain};
pub(crate) use light::of_light;
pub use light::{CHAIN_EDGE, is_cube_of_light};
pub(crate) use movement::{Movement, time};
pub use picture::Picture;
pub(crate) use sheets::{Sheet, Target, TargetFile, TargetView};
pub(crate) use strip::Strip;

use crate::diagnostic::Diagnostic;
use crate::settings::GeometrySettings;

/// Returns the warnings about an output's shape.
pub(crate) fn shape_warning(geometry: &GeometrySettings, target: &Target) -> Option<Diagnostic> {
    let aspect = target.views.first().and_then(|picture| aspect::warning(geometry, &picture.view));
    aspect.or_else(|| gpano::warning(geometry, target))
}
