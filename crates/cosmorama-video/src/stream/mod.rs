//! Streams of pictures for pipes, without ffmpeg: YUV4MPEG2, PAM and its elders, PFM.

mod input;
mod output;
mod pam;
mod pfm;
mod y4m;

pub use pam::{PamReader, PamWriter};
pub use pfm::{ByteOrder, PfmReader, PfmWriter};
pub use y4m::{Subsampling, Y4mFormat, Y4mReader, Y4mWriter};
