//! How code values relate to light on both sides, and what is told of alpha.

mod light;
mod thin_alpha;

pub use light::InputTransfer;
pub use thin_alpha::ThinAlpha;

pub(crate) use light::Light;
