//! Projections as they are typed: `NAME[:key=value[,key=value]…]`.
//!
//! One table ([`projections`]) lists every name and key; all messages about wrong ones come from it. Only `base=` of an st map leads
//! back from a builder to the parser: it is a SPEC within a SPEC.

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
pub use help::help;
pub use map::{StMapBase, StMapSpec};
pub use parse::Spec;
pub use shape::{Shape, Single, SphereSamples};
pub use stereo::StereoSpec;
