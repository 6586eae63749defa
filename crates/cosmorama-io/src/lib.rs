//! Image files for cosmorama: formats, metadata, face sets and frame sequences.
//!
//! [`probe`] reads a file's header, [`read`] its pixels, and [`write`](write()) makes a file appear whole or not at
//! all. [`FaceSet`] finds the faces of a cube by the naming presets of other tools, and [`FramePattern`] the frames of
//! a sequence.
#![forbid(unsafe_code)]

mod calibration;
mod codec;
mod error;
mod face_set;
mod file;
mod header;
mod limits;
mod metadata;
pub mod pending;
mod pto;
mod sequence;

pub use calibration::{Calibration, CalibrationError, Distortion};
#[cfg(feature = "diagrams")]
pub use codec::svg;
pub use codec::{Compression, ReadSeek, WriteOptions};
pub use error::IoError;
pub use face_set::{FaceFile, FaceImages, FacePattern, FacePlacement, FaceSet, LetterCase, Naming};
pub use file::{
    StPairs, open, probe, probe_from, probe_pairs, probe_pairs_from, read, read_from, read_pairs, read_pairs_from,
    write, write_hidden, write_levels, write_planes, write_to,
};
pub use header::{Format, Header, ImageFile};
pub use limits::Limits;
pub use metadata::{EnvMap, Metadata, Window};
pub use pto::{PtoError, PtoImage, PtoPanorama, PtoProject};
pub use sequence::{FoundFrames, FrameList, FramePattern, Frames};
