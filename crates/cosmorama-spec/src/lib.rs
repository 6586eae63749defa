//! Text forms of cosmorama's values: projections, filters, kernels, transfer functions, colours, sizes.
//!
//! A [`Spec`] names the projection of a picture: `NAME[:key=value[,key=value]…]`. Every type here parses with
//! [`FromStr`] and prints with [`Display`]; the printed text parses to the same value.
//!
//! ```
//! use cosmorama_spec::{FilterName, Shape, Size, Spec};
//!
//! let spec: Spec = "fulldome:tilt=20.0,fov=180".parse()?;
//! let Shape::Single(single) = &spec.shape else { panic!("a dome is one image") };
//! let view = single.placement.view(1024, 1024).expect("a dome of this size");
//! assert_eq!(view.width(), 1024);
//! // What is default is left out.
//! assert_eq!(spec.to_string(), "fulldome:tilt=20");
//!
//! assert_eq!("4096".parse::<Size>().map(|size| size.width), Ok(4096));
//! assert_eq!("reference:samples=4".parse::<FilterName>().map(|filter| filter.to_string()), Ok("reference".into()));
//!
//! // An error names the key, the value and what was expected.
//! let error = "fulldome:tilt=wide".parse::<Spec>().unwrap_err();
//! assert_eq!(error.to_string(), "tilt=wide: expected an angle from -90 to 90 degrees, as in tilt=20");
//! # Ok::<(), cosmorama_spec::SpecError>(())
//! ```
//!
//! Parsing touches no file. A calibration or an st map that the text names is kept as a path, to be read later
//! ([`Shape::Calibrated`], [`Shape::StMap`], [`Spec::files`]).
//!
//! [`FromStr`]: std::str::FromStr
//! [`Display`]: std::fmt::Display
#![forbid(unsafe_code)]

mod angle;
mod error;
mod filter;
mod frames;
mod light;
mod memory;
mod number;
mod size;
mod spec;
mod window;

pub use angle::{Degrees, parse_degrees, parse_ramp};
pub use error::{SpecError, WordError, WordKind, did_you_mean, nearest};
pub use filter::{FilterName, KernelName};
pub use frames::{FrameEnds, FrameMap, FrameRanges, FrameRangesError, FrameRate, TimeRanges, TimeRangesError};
pub use light::{
    Colour, DepthName, Missing, PrimariesName, TransferName, colour_table_csv, colour_table_of_csv,
    colour_table_of_stops,
};
pub use memory::MemorySize;
pub use size::Size;
pub use spec::{
    CalibrationSpec, Cube, Dual, LensFamily, Packing, Shape, Single, Spec, SpecKey, SpecKind, SphereSamples, StMapBase,
    StMapSpec, StereoSpec, help, help_on_key, presets,
};
