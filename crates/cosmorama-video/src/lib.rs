//! Video for cosmorama: the installed ffmpeg, found and driven; streams of pictures without it; spherical tags.
//!
//! [`Ffmpeg::find`] finds the programs, [`Ffmpeg::probe`] reads what a video is, [`VideoReader`] gives its frames by their
//! numbers, and [`VideoWriter`] makes a video appear whole or not at all. ffmpeg ends with success on much that is damaged; here
//! frames are counted, and a frame that is missing is an error that names it, or is held or skipped on demand ([`Damaged`]).
//!
//! [`Y4mReader`], [`PamReader`] and [`PfmReader`], with their writers, take pictures from pipes and give them to pipes.
#![forbid(unsafe_code)]

mod codec_memory;
mod colour;
mod error;
mod ffmpeg;
mod labels;
mod probe;
mod ratio;
mod read;
mod spatial;
mod stream;
mod write;

pub use colour::{ChromaPlace, ColourTags, ContentLight, HdrTags, MasteringDisplay, SignalRange, transfer_number};
pub use error::VideoError;
pub use ffmpeg::{Ffmpeg, Version};
pub use labels::Labels;
pub use probe::{Announced, AnnouncedBy, CutShort, OtherStream, StreamKind, Timeline, Turn, VideoInfo};
pub use ratio::Ratio;
pub use read::{
    CodedOrder, Damaged, Fault, FrameCondition, HalfPlace, PairedReader, ReadOptions, SecondHalf, VideoFrame,
    VideoReader,
};
pub use spatial::{Bounds, SpatialTags, SphericalPose, SphericalProjection, StereoMode};
pub use stream::{ByteOrder, PamReader, PamWriter, PfmReader, PfmWriter, Subsampling, Y4mFormat, Y4mReader, Y4mWriter};
pub use write::{Carried, Codec, Container, FrameTimes, VideoWriter, WriteSettings, Written};
