//! Transfer functions of both sides, and messages about alpha.

mod light;
mod thin_alpha;

pub use light::InputTransfer;
pub use thin_alpha::ThinAlpha;

pub(crate) use light::Light;
