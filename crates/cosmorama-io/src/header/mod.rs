//! Formats of files.

mod format;

pub use format::Format;
