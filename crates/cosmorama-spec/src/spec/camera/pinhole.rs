//! Pinhole cameras and stereographic views as they are typed.

use cosmorama::sphere::Angle;
use cosmorama::world::{FieldOfView, Frame, PerspectiveFrame, StereographicFrame};

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
    let frame = PerspectiveFrame { field_of_view, pixel_aspect: fields.aspect()? };
    Shape::single(fields, Frame::Perspective(frame))
}

pub(crate) fn stereographic(fields: &Fields) -> Result<Shape, SpecError> {
    let default = StereographicFrame::default();
    let frame = StereographicFrame {
        field_of_view: fields.angle("fov")?.unwrap_or(default.field_of_view),
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, Frame::Stereographic(frame))
}
