//! Transfer functions and primaries of both sides, ICC profiles, and messages about alpha.

mod light;
mod profile;
mod thin_alpha;
mod working;

pub use light::InputTransfer;
pub use thin_alpha::ThinAlpha;

pub(crate) use light::{FileColours, Light};
