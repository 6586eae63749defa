//! Moving cameras: what they see, and what a world cannot show them.

pub(super) mod figure;
mod parallax;
mod report;

pub use parallax::Parallax;
pub use report::PathReport;
