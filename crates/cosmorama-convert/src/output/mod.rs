//! Outputs: their names, which of them exist, and which are to be made.

pub(crate) mod outputs;
mod resume;

pub use outputs::{check_apart, real_path, refuse_existing};
pub use resume::Remade;

pub(crate) use outputs::{FrameOutputs, Outputs, files_read};
