//! Sources of inputs: bytes and pictures, names by frame, and the memory that reading may take.

pub(crate) mod access;
pub(crate) mod decoded_picture;
pub(crate) mod lock;
pub(crate) mod memory_budget;
pub(crate) mod name;
pub(crate) mod stamp;
pub(crate) mod system_memory;
pub(crate) mod unread;
pub(crate) mod video;
pub(crate) mod view_files;
pub(crate) mod wanted_frames;

pub use access::{Disk, Files, InMemory, LiveStream, probe, read, with_videos};
pub use memory_budget::MemoryBudget;
pub use name::Name;
pub use stamp::Stamp;
pub use system_memory::peak_bytes;
pub use view_files::ViewFiles;
pub use wanted_frames::existing as existing_frames;

pub(crate) use access::{Access, ChosenFiles, read_choice, read_further, read_in};
pub(crate) use decoded_picture::DecodedPicture;
pub(crate) use lock::lock;
pub(crate) use memory_budget::light_bytes;
