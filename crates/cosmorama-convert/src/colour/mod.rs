//! Transfer functions and primaries of both sides, ICC profiles, what labels need, and messages about alpha.

mod labels;
mod light;
mod profile;
mod thin_alpha;
mod working;

pub use light::InputTransfer;
pub use thin_alpha::ThinAlpha;

pub(crate) use labels::check_labels;
pub(crate) use light::{FileColours, Light};
