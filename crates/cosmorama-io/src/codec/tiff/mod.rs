//! TIFF.

mod reader;
mod writer;

pub(crate) use reader::{probe, read};
pub(crate) use writer::write;
