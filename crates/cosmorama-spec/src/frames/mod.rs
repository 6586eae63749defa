//! Frames of sequences: lists of them by number and by time, and which of one go with those of another.

mod map;
mod ranges;
mod rate;
mod times;

pub use map::{FrameEnds, FrameMap};
pub use ranges::{FrameRanges, FrameRangesError};
pub use rate::FrameRate;
pub use times::{TimeRanges, TimeRangesError};
