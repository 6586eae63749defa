//! Domes and Omnimax frames as they are typed.

use cosmorama::camera::{CameraModel, FulldomeCamera, OmnimaxCamera, OmnimaxFraming};

use crate::SpecError;
use crate::angle::parse_degrees;
use crate::spec::Shape;
use crate::spec::fields::Fields;

pub(crate) fn fulldome(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = FulldomeCamera {
        field_of_view: fields.angle_or("fov", 180.0)?,
        tilt: fields.angle_or("tilt", 0.0)?,
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, CameraModel::Fulldome(frame))
}

pub(crate) fn omnimax(fields: &Fields) -> Result<Shape, SpecError> {
    let framings = [("fit", OmnimaxFraming::Fit), ("circle", OmnimaxFraming::Circle)];
    let lower = fields.read("lower", "an angle in degrees below the axis, or none, as in lower=45", |value| {
        if value == "none" { Some(None) } else { parse_degrees(value).map(Some) }
    })?;
    for key in ["center", "radius"] {
        if fields.get("framing").is_some() && fields.get(key).is_some() {
            return Err(SpecError::Both { first: "framing", second: key });
        }
    }
    let default = OmnimaxCamera::default();
    let frame = OmnimaxCamera {
        framing: fields.choice("framing", &framings)?.unwrap_or_default(),
        lower: lower.unwrap_or(default.lower),
        circle: fields.circle()?,
        axis: fields.angle_or("axis", 0.0)?,
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, CameraModel::Omnimax(frame))
}
