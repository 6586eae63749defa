//! Cameras and domes as they are typed.

use cosmorama::sphere::Angle;
use cosmorama::world::{
    FieldOfView, Frame, FulldomeFrame, OmnimaxFrame, OmnimaxFraming, PerspectiveFrame, StereographicFrame,
};

use super::calibration::{Family, calibrated};
use super::fields::Fields;
use super::{Shape, SpecError, parse_degrees};

pub(super) fn perspective(fields: &Fields) -> Result<Shape, SpecError> {
    if let Some(camera) = calibrated(fields, Family::Pinhole)? {
        return Shape::single(fields, Frame::Calibrated(camera));
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

pub(super) fn stereographic(fields: &Fields) -> Result<Shape, SpecError> {
    let default = StereographicFrame::default();
    let frame = StereographicFrame {
        field_of_view: fields.angle("fov")?.unwrap_or(default.field_of_view),
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, Frame::Stereographic(frame))
}

pub(super) fn fulldome(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = FulldomeFrame {
        field_of_view: fields.angle_or("fov", 180.0)?,
        tilt: fields.angle_or("tilt", 0.0)?,
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, Frame::Fulldome(frame))
}

pub(super) fn omnimax(fields: &Fields) -> Result<Shape, SpecError> {
    let framings = [("fit", OmnimaxFraming::Fit), ("circle", OmnimaxFraming::Circle)];
    let lower = fields.read("lower", "an angle in degrees below the axis, or none, as in lower=45", |value| {
        if value == "none" { Some(None) } else { parse_degrees(value).map(Some) }
    })?;
    for key in ["center", "radius"] {
        if fields.get("framing").is_some() && fields.get(key).is_some() {
            return Err(SpecError::Both { first: "framing", second: key });
        }
    }
    let default = OmnimaxFrame::default();
    let frame = OmnimaxFrame {
        framing: fields.choice("framing", &framings)?.unwrap_or_default(),
        lower: lower.unwrap_or(default.lower),
        circle: fields.circle()?,
        axis: fields.angle_or("axis", 0.0)?,
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, Frame::Omnimax(frame))
}
