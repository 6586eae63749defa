//! Hugin's projects.
#![no_main]

use std::path::Path;

use cosmorama_fuzz::prepare;
use cosmorama_io::PtoProject;
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    let _ = PtoProject::read_from(bytes, Path::new("two.pto"));
});
