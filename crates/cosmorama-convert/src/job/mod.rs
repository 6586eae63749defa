//! A conversion resolved against its files: content, coverage, outputs, and those of them that are still to be made.

mod backdrop;
mod content;
mod convert_job;
pub(crate) mod coverage;
pub(crate) mod gaps;
mod memory_needs;
pub(crate) mod options;
mod origin;
pub(crate) mod outputs;
mod queue_depth;
mod resume;

pub use memory_needs::{encoded_beside, packed_blocks};
pub use outputs::{check_apart, real_path, refuse_existing};
pub use resume::Remade;
pub(crate) use resume::Resumed;

pub(crate) use content::Content;
pub(crate) use convert_job::{ConvertJob, Purpose, is_balanced, makes_strips};
pub(crate) use memory_needs::{
    BAND, FrameNeeds, Held, STRIP, are_too_large, footprint_bytes, is_large, is_torn, pixels_in, with_reserve,
};
#[cfg(fuzzing)]
pub use origin::compared_origins;
pub(crate) use origin::{DAMAGED_ORIGIN, damage_of, is_damaged, settings_of};
pub(crate) use outputs::{FrameOutputs, Outputs, Space, compressed, files_read};
pub(crate) use queue_depth::{FrameMemory, QueueDepth};
