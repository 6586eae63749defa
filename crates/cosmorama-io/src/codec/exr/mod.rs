//! OpenEXR.

mod dwa;
mod reader;
mod selection;
mod window;
mod writer;

pub(crate) use reader::{probe, probe_pairs, read, read_pairs};
pub(crate) use writer::{write, write_planes};
