//! Maps, mirror balls and octahedra as they are typed.

use cosmorama::camera::{
    CameraModel, CylinderCamera, CylinderKind, EquirectCamera, MirrorBallCamera, OctahedralCamera, PanniniCamera,
};
use cosmorama::projection::OctahedralKind;

use crate::SpecError;
use crate::spec::Shape;
use crate::spec::fields::Fields;

pub(crate) fn equirect(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = EquirectCamera {
        horizontal: fields.angle_or("hfov", 360.0)?,
        vertical: fields.angle_or("vfov", 180.0)?,
        samples: fields.samples()?.unwrap_or_default(),
    };
    Shape::single(fields, CameraModel::Equirect(frame))
}

/// `mercator`, `cylinder` or `equal-area`: Mercator's edges are given as a latitude, the others' as a field of view.
pub(crate) fn cylinder(fields: &Fields, kind: CylinderKind) -> Result<Shape, SpecError> {
    let (edge, top) = match kind {
        CylinderKind::Mercator => ("lat", fields.angle("lat")?),
        CylinderKind::Central | CylinderKind::EqualArea => ("vfov", fields.angle("vfov")?.map(|angle| angle * 0.5)),
    };
    if top.is_some() && fields.get("aspect").is_some() {
        return Err(SpecError::Both { first: "aspect", second: edge });
    }
    let default = CylinderCamera::new(kind);
    let horizontal = fields.angle("hfov")?.unwrap_or(default.horizontal);
    let frame = CylinderCamera { horizontal, top, pixel_aspect: fields.aspect()?, ..default };
    Shape::single(fields, CameraModel::Cylinder(frame))
}

pub(crate) fn mirror_ball(fields: &Fields) -> Result<Shape, SpecError> {
    let distance =
        fields.read("distance", "ball radii from the camera to the ball's centre, more than 1, or inf", |value| {
            match value {
                "inf" => Some(None),
                _ => value.parse().ok().filter(|distance: &f64| *distance > 1.0 && distance.is_finite()).map(Some),
            }
        })?;
    let frame =
        MirrorBallCamera { distance: distance.flatten(), circle: fields.circle()?, pixel_aspect: fields.aspect()? };
    Shape::single(fields, CameraModel::MirrorBall(frame))
}

pub(crate) fn pannini(fields: &Fields) -> Result<Shape, SpecError> {
    let default = PanniniCamera::default();
    let distance = fields.read("d", "a distance, 0 or more, as in d=1", |value| {
        value.parse().ok().filter(|distance: &f64| *distance >= 0.0 && distance.is_finite())
    })?;
    let frame = PanniniCamera {
        distance: distance.unwrap_or(default.distance),
        field_of_view: fields.angle("fov")?.unwrap_or(default.field_of_view),
        pixel_aspect: fields.aspect()?,
    };
    Shape::single(fields, CameraModel::Pannini(frame))
}

pub(crate) fn octahedral(fields: &Fields) -> Result<Shape, SpecError> {
    let kinds = [("equal-area", OctahedralKind::EqualArea), ("plain", OctahedralKind::Plain)];
    let frame = OctahedralCamera { kind: fields.choice("kind", &kinds)?.unwrap_or_default() };
    Shape::single(fields, CameraModel::Octahedral(frame))
}
