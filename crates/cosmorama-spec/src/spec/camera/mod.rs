//! Text forms of cameras, lenses and domes.

mod calibration;
pub(super) mod dome;
mod dual;
pub(super) mod hugin;
pub(super) mod lens;
pub(super) mod pinhole;

pub use calibration::{CalibrationSpec, LensFamily};
pub use dual::Dual;
