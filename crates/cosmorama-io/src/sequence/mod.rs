//! Frames of an animation: lists of frame numbers, and files numbered by frame.

mod found_frames;
mod frame_list;
mod frame_pattern;
mod frames;

pub use found_frames::FoundFrames;
pub use frame_list::FrameList;
pub use frame_pattern::FramePattern;
pub use frames::Frames;
