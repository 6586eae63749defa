//! Memory: the available amount, the needs of a conversion, and the number of frames in flight.

mod memory;
mod queue_depth;
mod system_memory;

pub use memory::MemoryBudget;
pub(crate) use queue_depth::QueueDepth;
pub use system_memory::peak_bytes;

pub(crate) use memory::light_bytes;
pub(crate) use queue_depth::FrameMemory;
