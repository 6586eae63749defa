//! Frames of an animation: lists of frame numbers, files numbered by frame, and poses of a camera by frame.

mod camera_path;
mod found_frames;
mod frame_list;
mod frame_pattern;
mod frames;

pub use camera_path::{CameraPath, CameraPathError, PathPose, PathSource};
pub use found_frames::FoundFrames;
pub use frame_list::FrameList;
pub use frame_pattern::FramePattern;
pub use frames::Frames;
