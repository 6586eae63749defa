//! Paths of cameras: CSV, JSON, Gyroflow's and glTF's.
#![no_main]

use std::io::ErrorKind;
use std::path::Path;

use cosmorama_fuzz::prepare;
use cosmorama_io::{CameraPath, PathSource};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: prepare(Vec::new), |bytes: &[u8]| {
    // Tables are told by their text, glTF by its name.
    for (name, fps, is_of_input) in [("a", None, false), ("a", Some(25.0), true), ("a.gltf", Some(25.0), false)] {
        let beside = |_: &Path| Err(ErrorKind::NotFound.into());
        let source = PathSource { name: Path::new(name), fps, node: None, is_of_input, beside: &beside };
        let Ok(path) = CameraPath::read(bytes, &source) else { continue };
        for pose in path.poses {
            let angles = pose.orientation.yaw_pitch_roll();
            assert!(pose.frame.is_finite() && angles.iter().all(|angle| angle.degrees().is_finite()), "{pose:?}");
        }
    }
});
