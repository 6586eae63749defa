//! `calibration=FILE`: a camera that a program measured.

use cosmorama::projection::azimuthal::{FisheyeLens, KannalaBrandt, OCAM_COEFFICIENTS, Ocam};
use cosmorama::projection::{BrownConrady, BrownConradyCoefficients};
use cosmorama::world::{CalibratedFrame, CalibratedLens, CameraMatrix};
use cosmorama_io::{Calibration, Distortion};

use super::SpecError;
use super::fields::{Fields, wrong};

/// Which lens a SPEC's name stands for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Family {
    Fisheye,
    Pinhole,
}

/// Keys that say what a calibration says.
const SAID: [&str; 9] = ["lens", "k", "fit", "focal", "sensor", "center", "radius", "aspect", "vfov"];

/// The frame of a SPEC with `calibration=`; `None` without it.
pub(super) fn calibrated(fields: &Fields, family: Family) -> Result<Option<CalibratedFrame>, SpecError> {
    let Some(file) = fields.file("calibration") else { return Ok(None) };
    if fields.get("calibration") == Some("") {
        return Err(wrong("calibration", "", "a file, as in calibration=camera.yml"));
    }
    for first in SAID.into_iter().chain(["dfov"]) {
        if fields.get(first).is_some() {
            return Err(SpecError::Both { first, second: "calibration" });
        }
    }
    let unusable = |reason: String| SpecError::Calibration { reason };
    let told = |reason: &dyn std::fmt::Display| unusable(format!("{}: {reason}", file.display()));
    let calibration = Calibration::read(&file).map_err(|error| unusable(error.to_string()))?;
    let lens = lens(&calibration.distortion, family).map_err(|reason| told(&reason))?;
    let matrix = CameraMatrix::from_rows(calibration.matrix).map_err(|error| told(&error))?;
    Ok(Some(CalibratedFrame { lens, matrix, size: calibration.size, field_of_view: fields.angle("fov")? }))
}

fn lens(distortion: &Distortion, family: Family) -> Result<CalibratedLens, String> {
    match (distortion, family) {
        (Distortion::Ocam(polynomial), Family::Fisheye) => {
            let mut coefficients = [0.0; OCAM_COEFFICIENTS];
            polynomial.iter().zip(&mut coefficients).for_each(|(from, to)| *to = *from);
            let lens = Ocam::from_coefficients(coefficients).map_err(|error| error.to_string())?;
            Ok(CalibratedLens::Fisheye(FisheyeLens::Ocam(lens)))
        }
        (Distortion::Ocam(_), Family::Pinhole) => {
            Err("an OCamCalib lens is a fisheye; expected fisheye:calibration=".into())
        }
        (Distortion::OpenCv { is_fisheye: Some(true), .. }, Family::Pinhole) => {
            Err("says that it is of OpenCV's fisheye model; expected fisheye:calibration=".into())
        }
        (Distortion::OpenCv { is_fisheye: Some(false), .. }, Family::Fisheye) => {
            Err("says that it is of OpenCV's pinhole model; expected perspective:calibration=".into())
        }
        (Distortion::OpenCv { coefficients, .. }, Family::Fisheye) => {
            let k: [f64; 4] = coefficients.as_slice().try_into().map_err(|_| {
                let count = coefficients.len();
                format!("{count} distortion coefficients; OpenCV's fisheye has 4. For its pinhole model: perspective:calibration=")
            })?;
            let lens = KannalaBrandt::from_opencv(k).map_err(|error| error.to_string())?;
            Ok(CalibratedLens::Fisheye(FisheyeLens::KannalaBrandt(lens)))
        }
        (Distortion::OpenCv { coefficients, .. }, Family::Pinhole) => {
            let lens = BrownConrady::new(BrownConradyCoefficients::from_opencv(coefficients));
            lens.map(CalibratedLens::Pinhole).map_err(|error| error.to_string())
        }
    }
}
