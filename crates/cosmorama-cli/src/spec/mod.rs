//! Projections as they are typed: `NAME[:key=value[,key=value]…]`.
//!
//! One table ([`kind`]) lists every name and key; all messages about wrong ones come from it.

mod alias;
mod angle;
mod calibration;
mod camera;
mod cube;
mod dual;
mod fields;
mod help;
mod hugin;
mod kind;
mod lens;
mod maps;
mod shape;
mod st_map;
mod stereo;
mod text;
mod window;

pub(crate) use angle::parse_degrees;
pub(crate) use cube::{Cube, Packing};
pub(crate) use dual::Dual;
pub(crate) use help::help;
pub(crate) use shape::{Shape, Single, SphereSamples};
pub(crate) use st_map::StMapSpec;
pub(crate) use stereo::StereoSpec;
pub(crate) use text::{Spec, SpecError, did_you_mean};
