//! Calibrations of lenses: OpenCV's YAML, JSON and XML, ROS's and Kalibr's, and OCamCalib's.
#![no_main]

use std::path::Path;

use cosmorama_fuzz::prepare;
use cosmorama_io::Calibration;
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    let _ = Calibration::read_from(bytes, Path::new("camera"));
});
