//! Text forms of projections: `NAME[:key=value[,key=value]…]`.
//!
//! One table ([`projections`]) lists every name and key, and all messages about wrong ones are made from it. Only the
//! st map's `base=`, a SPEC within a SPEC, calls the parser from a builder.

mod alias;
mod camera;
mod cube;
mod fields;
mod help;
mod keys;
mod map;
mod parse;
mod projections;
mod shape;
mod stereo;

pub use camera::{CalibrationSpec, Dual, LensFamily};
pub use cube::{Cube, Packing};
pub use help::{SpecKind, help, help_on_key, presets};
pub use map::{StMapBase, StMapSpec};
pub use parse::Spec;
pub use projections::Key as SpecKey;
pub use shape::{Shape, Single, SphereSamples};
pub use stereo::StereoSpec;
