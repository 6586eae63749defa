//! Frames of sequences: lists of them, and which of one go with those of another.

mod map;
mod ranges;

pub use map::{FrameEnds, FrameMap};
pub use ranges::{FrameRanges, FrameRangesError};
