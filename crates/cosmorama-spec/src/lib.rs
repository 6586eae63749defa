//! Text forms of cosmorama's values: projections, filters, kernels, transfer functions, colours, sizes.
//!
//! A [`Spec`] says what a picture shows: `NAME[:key=value[,key=value]…]`. Parsing touches no file: a calibration or an st map
//! that a text names is kept as a path, for whoever opens inputs. What cannot be understood is a [`SpecError`], which names
//! the key, the value and what was expected.
#![forbid(unsafe_code)]

mod angle;
mod compression;
mod error;
mod filter;
mod frame_ranges;
mod light;
mod memory;
mod number;
mod size;
mod spec;
mod window;

pub use angle::{Degrees, parse_degrees};
pub use compression::CompressionLevel;
pub use error::{SpecError, did_you_mean};
pub use filter::{FilterName, KernelName};
pub use frame_ranges::{FrameRanges, FrameRangesError};
pub use light::{Colour, DepthName, Missing, TransferName};
pub use memory::MemorySize;
pub use size::Size;
pub use spec::{
    CalibrationSpec, Cube, Dual, LensFamily, Packing, Shape, Single, Spec, SphereSamples, StMapBase, StMapSpec,
    StereoSpec, help,
};
