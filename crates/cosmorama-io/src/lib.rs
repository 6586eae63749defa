//! Image files for cosmorama: formats, metadata, face sets and frame sequences.
//!
//! [`probe`] reads a file's header, [`read`] its pixels, and [`write`](write()) makes a file appear whole or not at
//! all. [`FaceSet`] finds the faces of a cube by the naming presets of other tools, and [`FramePattern`] the frames of
//! a sequence.
//!
//! A panorama is read, turned into light, and written in another format:
//!
//! ```
//! use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};
//! use cosmorama_io::{Limits, Metadata, WriteOptions, read, write};
//!
//! let folder = tempfile::tempdir()?;
//! let (input, output) = (folder.path().join("sky.exr"), folder.path().join("sky.png"));
//! let sky = EncodedImage::new(2, 1, Channels::Rgb, Depth::Float, Samples::Float(vec![0.5; 6]))?;
//! write(&input, &sky, &WriteOptions::default())?;
//!
//! let light = read(&input, &Limits::default())?.to_light();
//! let codes = light.to_codes(Depth::Eight, &Transfer::Srgb);
//! let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
//! write(&output, &codes, &WriteOptions::with_metadata(metadata))?;
//! assert_eq!(read(&output, &Limits::default())?.image.width(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The files of a face set may lie turned or mirrored. [`FaceSet::read_all`] turns them upright; a program that reads a
//! [`FaceFile`] by itself must apply its [`placement`](FaceFile::placement).
#![forbid(unsafe_code)]
#![cfg_attr(
    not(feature = "default"),
    allow(dead_code, unused_imports, reason = "helpers of codecs that are left out have no callers")
)]

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
pub use codec::{Compression, ReadSeek, WriteOptions, is_contained};
pub use error::{IoError, is_video};
pub use face_set::{FaceFile, FaceImages, FacePattern, FacePlacement, FaceSet, LetterCase, Naming};
pub use file::{
    StPairs, check_chosen, open, probe, probe_chosen, probe_from, probe_pairs, probe_pairs_from, read, read_chosen,
    read_from, read_in, read_layers, read_pairs, read_pairs_from, write, write_flat, write_hidden,
    write_layer_rows_hidden, write_layers, write_layers_hidden, write_levels, write_planes, write_rows_hidden,
    write_to,
};
pub use header::{
    Choice, Format, Header, ImageFile, LayeredImage, LayeredRows, MadeLayers, MadeRows, Plane, PlaneSamples,
};
pub use limits::Limits;
pub use metadata::{
    Attribute, Carried, EnvMap, Exif, FilePart, Kept, Layers, Metadata, MetadataRoom, NamedChannel, Pose, ProfileFault,
    Remark, SampleKind, TextChunk, Window, transfer_of_number,
};
pub use pto::{PtoError, PtoImage, PtoPanorama, PtoProject};
pub use sequence::{CameraPath, CameraPathError, FoundFrames, FrameList, FramePattern, Frames, PathPose, PathSource};
