//! Transfer functions of both sides, what labels need, and messages about alpha.

mod labels;
mod light;
mod thin_alpha;

pub use light::InputTransfer;
pub use thin_alpha::ThinAlpha;

pub(crate) use labels::check_labels;
pub(crate) use light::Light;
