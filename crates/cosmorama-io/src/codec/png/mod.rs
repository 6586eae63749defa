//! Portable Network Graphics.

mod colour;
mod reader;
mod writer;

pub(crate) use reader::{probe, read};
pub(crate) use writer::write;
