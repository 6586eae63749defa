//! Errors for files that a SPEC names in a place where none is read.

use cosmorama_spec::{CalibrationSpec, StMapSpec};

use crate::diagnostic::{ConvertError, usage};

/// Returns the error for a map in a place where none is possible.
pub(crate) fn st_map(map: &StMapSpec) -> ConvertError {
    usage(format!("st-map:file={}: an st map cannot be given here", map.file.display()))
}

/// Returns the error for a calibration in a place where none is possible.
pub(crate) fn calibration(camera: &CalibrationSpec) -> ConvertError {
    usage(format!("calibration={}: a calibration cannot be given here", camera.file.display()))
}
