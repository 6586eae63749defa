//! Colour of a conversion: transfer functions and primaries of both sides, ICC profiles, spaces of OpenColorIO configs,
//! further channels, labels, messages about alpha, and metadata that outputs take over.

mod carried;
mod conversion;
mod labels;
mod layers;
mod light;
mod ocio;
mod profile;
mod straight_alpha;
mod thin_alpha;
mod working;

pub use layers::{LayerRules, contents};
pub use light::InputTransfer;
pub use thin_alpha::ThinAlpha;

pub(crate) use conversion::LightConversion;
pub(crate) use labels::check_labels;
pub(crate) use layers::{LayerContent, LayerGroup, LayerPlan, PictureNames, check_choice, check_light};
pub(crate) use light::{FileColours, Light};
pub(crate) use straight_alpha::StraightAlpha;
