//! A conversion from its settings to its report: [`Conversion`](crate::Conversion) → [`check`](crate::Conversion::check) → [`Checked`] → [`Checked::run`].

mod advance;
mod check;
mod decisions;
mod explanation;
mod filters;
mod observer;
mod report;
mod run;
mod verify;
mod videos;
mod world_light;

pub use check::Checked;
pub use check::threads;
pub use explanation::{CostedFiles, CostedMemory, Explanation, ExplanationSettings, PathExplanation, SequenceCost};
pub use filters::{FilterReport, FilterTrial, FilterTrials};
pub use observer::{Observer, Quiet, Stop, Work};
pub use report::Report;
pub use verify::{Fault, Faults, SheetLayout, Verification, Verified, check_sheet};
pub use world_light::{Radiance, WorldHarmonics, WorldLight, WorldSuns, WorldTable};

pub(crate) use advance::watched;
