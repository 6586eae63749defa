//! Channels beside the picture's own: their content, and which of them the output gets.

mod plan;
mod resolve;
mod rules;

pub use plan::LayerRules;
pub use rules::contents;

pub(crate) use plan::{LayerPlan, PictureNames};
pub(crate) use resolve::{check_choice, check_light};
pub(crate) use rules::{LayerContent, LayerGroup};
