use std::path::PathBuf;

use cosmorama::camera::{Canvas, Mirror};
use cosmorama::sphere::{Angle, Orientation};

use crate::SpecError;
use crate::angle::Degrees;
use crate::spec::fields::{Fields, wrong};
use crate::spec::keys::Keys;

/// Kind of lens that a calibration must describe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LensFamily {
    /// A pinhole camera with lens distortion: `perspective:calibration=`.
    Pinhole,
    /// A fisheye lens: `fisheye:calibration=`.
    Fisheye,
}

/// The picture of a calibrated camera (`calibration=FILE`), before the file has been read.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationSpec {
    /// Calibration file.
    pub file: PathBuf,
    /// Kind of lens that the file must describe.
    pub family: LensFamily,
    /// Field of view around the axis that is used; `None` for all that the lens shows.
    pub field_of_view: Option<Angle>,
    /// Orientation of the camera in the world.
    pub orientation: Orientation,
    /// Mirroring of the picture.
    pub mirror: Mirror,
    /// Canvas of which the picture is a window.
    pub canvas: Option<Canvas>,
}

/// Keys that a calibration file replaces.
const HELD: [&str; 10] = ["lens", "k", "fit", "focal", "sensor", "center", "radius", "aspect", "vfov", "dfov"];

impl CalibrationSpec {
    /// Reads the keys of a calibrated camera; `None` without `calibration=`.
    pub(in crate::spec) fn build(fields: &Fields, family: LensFamily) -> Result<Option<Self>, SpecError> {
        let Some(file) = fields.file("calibration") else { return Ok(None) };
        if fields.get("calibration") == Some("") {
            return Err(wrong("calibration", "", "a file, as in calibration=camera.yml"));
        }
        if let Some(first) = HELD.into_iter().find(|key| fields.get(key).is_some()) {
            return Err(SpecError::Both { first, second: "calibration" });
        }
        Ok(Some(Self {
            file,
            family,
            field_of_view: fields.angle("fov")?,
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
        }))
    }

    /// Writes the keys, if the camera has this kind of lens.
    pub(in crate::spec) fn write(&self, family: LensFamily) -> Option<Keys> {
        let keys = Keys::default().with("calibration", self.file.display());
        let keys = keys.maybe("fov", self.field_of_view.map(Degrees));
        (self.family == family).then(|| keys.placed(self.orientation, self.mirror, self.canvas))
    }
}
