//! Text forms of domes and Omnimax frames.

use cosmorama::camera::{CameraModel, FulldomeCamera, OmnimaxCamera, OmnimaxFraming};
use cosmorama::sphere::Angle;

use crate::SpecError;
use crate::angle::{Degrees, parse_degrees};
use crate::spec::Shape;
use crate::spec::fields::Fields;
use crate::spec::keys::Keys;

pub(crate) fn fulldome(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = FulldomeCamera {
        field_of_view: fields.angle_or("fov", 180.0)?,
        tilt: fields.slope("tilt")?,
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, CameraModel::Fulldome(frame))
}

const FRAMINGS: [(&str, OmnimaxFraming); 2] = [("fit", OmnimaxFraming::Fit), ("circle", OmnimaxFraming::Circle)];

pub(crate) fn omnimax(fields: &Fields) -> Result<Shape, SpecError> {
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
        framing: fields.choice("framing", &FRAMINGS)?.unwrap_or_default(),
        lower: lower.unwrap_or(default.lower),
        circle: fields.circle()?,
        axis: fields.slope("axis")?,
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, CameraModel::Omnimax(frame))
}

pub(crate) fn write_fulldome(shape: &Shape) -> Option<Keys> {
    let CameraModel::Fulldome(frame) = shape.camera()? else { return None };
    let keys = Keys::default().angle("fov", frame.field_of_view, Angle::from_degrees(180.0));
    Some(keys.angle("tilt", frame.tilt, Angle::ZERO).aspect(frame.pixel_aspect))
}

pub(crate) fn write_omnimax(shape: &Shape) -> Option<Keys> {
    let CameraModel::Omnimax(frame) = shape.camera()? else { return None };
    let default = OmnimaxCamera::default();
    let lower = frame.lower.map_or_else(|| "none".to_owned(), |lower| Degrees(lower).to_string());
    let keys = Keys::default()
        .choice("framing", frame.framing, default.framing, &FRAMINGS)
        .maybe("lower", Some(lower).filter(|_| frame.lower != default.lower))
        .circle("", frame.circle)
        .angle("axis", frame.axis, default.axis);
    Some(keys.aspect(frame.pixel_aspect))
}
