//! Calibrations that a SPEC names: reads the file and makes the camera.

use std::fmt::Display;

use cosmorama::camera::{CalibratedCamera, CalibratedLens, CameraMatrix, CameraModel, Placement};
use cosmorama::projection::azimuthal::{FisheyeLens, KannalaBrandt, OCAM_COEFFICIENTS, Ocam};
use cosmorama::projection::{BrownConrady, BrownConradyCoefficients};
use cosmorama_io::Distortion;
use cosmorama_spec::{CalibrationSpec, LensFamily, Shape, Single, Spec, SphereSamples, StMapBase};

use crate::diagnostic::{Result, failure};
use crate::source::Access;

/// Reads the calibration of a SPEC, or of its `base=`. A SPEC without one is returned unchanged.
///
/// # Errors
/// When a calibration cannot be read, or does not make a camera of this kind.
pub(crate) fn read_calibrations(mut spec: Spec, access: Access) -> Result<Spec> {
    match &mut spec.shape {
        Shape::Calibrated(camera) => spec.shape = Shape::Single(single(camera, access)?),
        Shape::StMap(map) => {
            if let Some(StMapBase::Calibrated(camera)) = &map.base {
                map.base = Some(StMapBase::Single(single(camera, access)?));
            }
        }
        Shape::Single(_) | Shape::Cube(_) | Shape::Dual(_) => {}
    }
    Ok(spec)
}

fn single(camera: &CalibrationSpec, access: Access) -> Result<Single> {
    let frame = frame(camera, access).map_err(|error| error.after("calibration=: "))?;
    let placement = Placement {
        frame: CameraModel::Calibrated(frame),
        orientation: camera.orientation,
        mirror: camera.mirror,
        canvas: camera.canvas,
    };
    Ok(Single { placement, samples: SphereSamples::NotAPanorama, any_shape: false, pose: false })
}

fn frame(camera: &CalibrationSpec, access: Access) -> Result<CalibratedCamera> {
    let calibration = access.read_calibration(&camera.file)?;
    let told = |reason: &dyn Display| failure!(Malformed: "{}: {reason}", camera.file.display());
    let lens = lens(&calibration.distortion, camera.family).map_err(|reason| told(&reason))?;
    let matrix = CameraMatrix::from_rows(calibration.matrix).map_err(|error| told(&error))?;
    Ok(CalibratedCamera { lens, matrix, size: calibration.size, field_of_view: camera.field_of_view })
}

fn lens(distortion: &Distortion, family: LensFamily) -> Result<CalibratedLens, String> {
    match (distortion, family) {
        (Distortion::Ocam(polynomial), LensFamily::Fisheye) => {
            let mut coefficients = [0.0; OCAM_COEFFICIENTS];
            polynomial.iter().zip(&mut coefficients).for_each(|(from, to)| *to = *from);
            let lens = Ocam::from_coefficients(coefficients).map_err(|error| error.to_string())?;
            Ok(CalibratedLens::Fisheye(FisheyeLens::Ocam(lens)))
        }
        (Distortion::Ocam(_), LensFamily::Pinhole) => {
            Err("an OCamCalib lens is a fisheye; expected fisheye:calibration=".into())
        }
        (Distortion::OpenCv { is_fisheye: Some(true), .. }, LensFamily::Pinhole) => {
            Err("says that it is of OpenCV's fisheye model; expected fisheye:calibration=".into())
        }
        (Distortion::OpenCv { is_fisheye: Some(false), .. }, LensFamily::Fisheye) => {
            Err("says that it is of OpenCV's pinhole model; expected perspective:calibration=".into())
        }
        (Distortion::OpenCv { coefficients, .. }, LensFamily::Fisheye) => {
            let k: [f64; 4] = coefficients.as_slice().try_into().map_err(|_| {
                let count = coefficients.len();
                format!("{count} distortion coefficients; OpenCV's fisheye has 4. For its pinhole model: perspective:calibration=")
            })?;
            let lens = KannalaBrandt::from_opencv(k).map_err(|error| error.to_string())?;
            Ok(CalibratedLens::Fisheye(FisheyeLens::KannalaBrandt(lens)))
        }
        (Distortion::OpenCv { coefficients, .. }, LensFamily::Pinhole) => {
            let lens = BrownConrady::new(BrownConradyCoefficients::from_opencv(coefficients));
            lens.map(CalibratedLens::Pinhole).map_err(|error| error.to_string())
        }
    }
}
