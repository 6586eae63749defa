//! Text forms of pinhole cameras and stereographic views.

use cosmorama::camera::{CameraModel, FieldOfView, PerspectiveCamera, StereographicCamera};
use cosmorama::sphere::Angle;

use crate::SpecError;
use crate::angle::Degrees;
use crate::spec::fields::Fields;
use crate::spec::keys::Keys;
use crate::spec::{CalibrationSpec, LensFamily, Shape};

/// Default horizontal field of view of a pinhole camera.
const RIGHT_ANGLE: Angle = Angle::from_degrees(90.0);

pub(crate) fn perspective(fields: &Fields) -> Result<Shape, SpecError> {
    if let Some(camera) = CalibrationSpec::build(fields, LensFamily::Pinhole)? {
        return Ok(Shape::Calibrated(camera));
    }
    let (fov, vfov, dfov) = (fields.angle("fov")?, fields.angle("vfov")?, fields.angle("dfov")?);
    let field_of_view = match (fov, vfov, dfov) {
        (_, Some(_), Some(_)) => return Err(SpecError::Both { first: "vfov", second: "dfov" }),
        (Some(_), _, Some(_)) => return Err(SpecError::Both { first: "fov", second: "dfov" }),
        (Some(horizontal), Some(vertical), None) => FieldOfView::Both { horizontal, vertical },
        (None, Some(vertical), None) => FieldOfView::Vertical(vertical),
        (None, None, Some(diagonal)) => FieldOfView::Diagonal(diagonal),
        (horizontal, None, None) => FieldOfView::Horizontal(horizontal.unwrap_or(RIGHT_ANGLE)),
    };
    if matches!(field_of_view, FieldOfView::Both { .. }) && fields.get("aspect").is_some() {
        return Err(SpecError::Both { first: "aspect", second: "vfov" });
    }
    let frame = PerspectiveCamera { field_of_view, pixel_aspect: fields.aspect()? };
    Shape::single(fields, CameraModel::Perspective(frame))
}

pub(crate) fn stereographic(fields: &Fields) -> Result<Shape, SpecError> {
    let default = StereographicCamera::default();
    let frame = StereographicCamera {
        field_of_view: fields.angle("fov")?.unwrap_or(default.field_of_view),
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, CameraModel::Stereographic(frame))
}

pub(crate) fn write_perspective(shape: &Shape) -> Option<Keys> {
    if let Shape::Calibrated(camera) = shape {
        return camera.write(LensFamily::Pinhole);
    }
    let CameraModel::Perspective(frame) = shape.camera()? else { return None };
    let keys = Keys::default();
    let keys = match frame.field_of_view {
        FieldOfView::Horizontal(angle) => keys.angle("fov", angle, RIGHT_ANGLE),
        FieldOfView::Vertical(angle) => keys.with("vfov", Degrees(angle)),
        FieldOfView::Diagonal(angle) => keys.with("dfov", Degrees(angle)),
        FieldOfView::Both { horizontal, vertical } => {
            keys.with("fov", Degrees(horizontal)).with("vfov", Degrees(vertical))
        }
    };
    Some(keys.aspect(frame.pixel_aspect))
}

pub(crate) fn write_stereographic(shape: &Shape) -> Option<Keys> {
    let CameraModel::Stereographic(frame) = shape.camera()? else { return None };
    let default = StereographicCamera::default();
    Some(Keys::default().angle("fov", frame.field_of_view, default.field_of_view).aspect(frame.pixel_aspect))
}
