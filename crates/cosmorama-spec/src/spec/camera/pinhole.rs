//! Pinhole cameras and stereographic views as they are typed.

use cosmorama::camera::{CameraModel, FieldOfView, PerspectiveCamera, StereographicCamera};
use cosmorama::sphere::Angle;

use crate::SpecError;
use crate::spec::fields::Fields;
use crate::spec::{CalibrationSpec, LensFamily, Shape};

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
        (horizontal, None, None) => FieldOfView::Horizontal(horizontal.unwrap_or(Angle::from_degrees(90.0))),
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
