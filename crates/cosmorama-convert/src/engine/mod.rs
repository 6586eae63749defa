//! Makes the outputs of a checked conversion, frame by frame.

mod frame;
mod geometry;
mod layers;
mod lighting;
mod posed;
mod sequence;
mod shares;
mod timing;
pub(crate) mod unfiltered;
pub(crate) mod warnings;
mod writer;

pub use lighting::between::InterpolationReport;
pub use lighting::light_maps::LightReport;
pub use timing::CpuSeconds;

pub(crate) use frame::files::{FrameFile, ViewImage, Which};
pub(crate) use frame::light::{Counts, FrameLight, Spent, Texels};
pub(crate) use frame::pictures::Engine;
pub(crate) use geometry::{Geometry, WorldLight};
pub(crate) use layers::{FurtherFiles, LayerPass};
pub(crate) use lighting::balance::{self, Balance, BalancedLight};
pub(crate) use lighting::light_maps::{LightMaps, light_of_unseen};
pub(crate) use posed::Posed;
pub(crate) use sequence::{Sequence, Watcher};
pub(crate) use shares::Shares;
pub(crate) use timing::{Stage, Stages};
pub(crate) use writer::{FrameWords, Levels, Writer, WriterOptions};
