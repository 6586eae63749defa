//! Conversions of worlds as values: settings are checked against files by their headers alone, then explained or run.
//!
//! [`Conversion`] holds the settings. [`Conversion::check`] finds the files and reports what is impossible, and
//! [`Checked::run`] makes the outputs while an [`Observer`] watches. Every message is a [`Diagnostic`], returned and
//! passed to the observer, never printed; settings in its text are [`Setting`]s, which each caller writes in its own
//! way. No state survives a conversion: threads and memory belong to the run.
#![forbid(unsafe_code)]
#![doc = include_str!("../README.md")]

mod colour;
mod conversion;
mod detect;
mod diagnostic;
mod engine;
mod input;
mod job;
mod packing;
mod settings;
mod source;
mod target;

pub use colour::{InputTransfer, LayerRules, ThinAlpha, contents};
pub use conversion::{
    Checked, CostedFiles, CostedMemory, Explanation, ExplanationSettings, Fault, Faults, FilterReport, FilterTrial,
    FilterTrials, Observer, PathExplanation, Quiet, Radiance, Report, SequenceCost, SheetLayout, Stop, Verification,
    Verified, Work, WorldHarmonics, WorldLight, WorldSuns, WorldTable, check_sheet, threads,
};
pub use detect::{Continuity, FacePixels, GivenFaces, Likely, damage_of, light_of, likely};
pub use diagnostic::{
    Code, ConvertError, Decision, Diagnostic, Message, Outcome, Part, Remedy, Result, Setting, Severity, Topic,
};
pub use engine::{CpuSeconds, InterpolationReport, LightReport};
pub use input::{Builtin, Input, InputView, Listed, face_set, is_one_file, listed};
#[cfg(fuzzing)]
pub use job::compared_origins;
pub use job::{Remade, check_apart, encoded_beside, packed_blocks, real_path, refuse_existing};
pub use packing::{Place, face_placement};
pub use settings::{
    Backdrop, BlurMethod, CameraMovement, Conversion, DepthKind, Every, Existing, GeometrySettings, LayerSettings,
    LightLevel, LightNormalisation, LightScale, LightSettings, LimitSettings, MotionBlur, NormalSpace, OcioSettings,
    PoseFile,
};
pub use source::video::{DamagedFrames, PictureSink, VideoSettings, Videos, is_video};
pub use source::{
    Disk, Files, InMemory, LiveStream, MemoryBudget, Name, Stamp, ViewFiles, existing_frames, peak_bytes, probe, read,
    with_videos,
};
pub use target::{CHAIN_EDGE, Picture, is_cube_of_light};
