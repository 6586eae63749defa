//! Image files for cosmorama: formats, metadata, face sets and frame sequences.
//!
//! [`probe`] reads what a file says of itself, [`read`] reads its pixels, [`write`](write()) makes a file appear
//! whole or not at all. [`FaceSet`] finds the faces of a cube by the naming presets of other tools, and
//! [`FramePattern`] the frames of a sequence.
#![forbid(unsafe_code)]

mod calibration;
mod error;
mod face_set;
mod file;
mod format;
mod formats;
mod gpano;
mod icc;
mod limits;
mod metadata;
pub mod pending;
mod pto;
mod sequence;
mod st_pairs;
pub mod svg;
mod write_options;

pub use calibration::{Calibration, CalibrationError, Distortion};
pub use error::IoError;
pub use face_set::{FaceFile, FacePattern, FacePlacement, FaceSet, LetterCase, Naming};
pub use file::{Header, ImageFile, probe, read, write, write_hidden, write_levels, write_planes};
pub use format::Format;
pub use limits::Limits;
pub use metadata::{EnvMap, Metadata, Window};
pub use pto::{PtoError, PtoImage, PtoPanorama, PtoProject};
pub use sequence::{FoundFrames, FrameList, FramePattern, Frames};
pub use st_pairs::{StPairs, probe_pairs, read_pairs};
pub use write_options::{Compression, WriteOptions};
