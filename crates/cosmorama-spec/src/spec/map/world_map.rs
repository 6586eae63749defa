//! Text forms of maps, mirror balls and octahedra.

use cosmorama::camera::{
    CameraModel, CylinderCamera, CylinderKind, EquirectCamera, MirrorBallCamera, OctahedralCamera, PanniniCamera,
    WorldMapCamera,
};
use cosmorama::projection::OctahedralKind;

use crate::SpecError;
use crate::angle::Degrees;
use crate::spec::fields::{Fields, samples_name};
use crate::spec::keys::Keys;
use crate::spec::{Shape, Single, SphereSamples};

pub(crate) fn equirect(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = EquirectCamera {
        horizontal: fields.angle_or("hfov", 360.0)?,
        vertical: fields.angle_or("vfov", 180.0)?,
        samples: fields.samples()?.unwrap_or_default(),
    };
    let pose = fields.choice("pose", &[("yes", true), ("no", false)])?.unwrap_or_default();
    if let (true, Some(second)) = (pose, ["yaw", "pitch", "roll"].into_iter().find(|key| fields.get(key).is_some())) {
        return Err(SpecError::Both { first: "pose", second });
    }
    Ok(match Shape::single(fields, CameraModel::Equirect(frame))? {
        Shape::Single(single) => Shape::Single(Single { pose, ..single }),
        shape => shape,
    })
}

/// Reads `mercator`, `cylinder` or `equal-area`. Mercator's edges are given as a latitude, the others' as a field of
/// view.
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

const KINDS: [(&str, OctahedralKind); 2] =
    [("equal-area", OctahedralKind::EqualArea), ("plain", OctahedralKind::Plain)];

pub(crate) fn octahedral(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = OctahedralCamera { kind: fields.choice("kind", &KINDS)?.unwrap_or_default() };
    Shape::single(fields, CameraModel::Octahedral(frame))
}

pub(crate) fn write_equirect(shape: &Shape) -> Option<Keys> {
    let Shape::Single(single) = shape else { return None };
    let CameraModel::Equirect(frame) = shape.camera()? else { return None };
    let default = EquirectCamera::default();
    let keys = match single.any_shape {
        true => Keys::default().with("hfov", Degrees(frame.horizontal)).with("vfov", Degrees(frame.vertical)),
        false => Keys::default().angle("hfov", frame.horizontal, default.horizontal).angle(
            "vfov",
            frame.vertical,
            default.vertical,
        ),
    };
    let samples = match single.samples {
        SphereSamples::Given(samples) => Some(samples),
        SphereSamples::ByFile | SphereSamples::NotAPanorama => {
            Some(frame.samples).filter(|samples| *samples != default.samples)
        }
    };
    Some(keys.maybe("samples", samples.map(samples_name)).switch("pose", single.pose))
}

pub(crate) fn write_cylinder(shape: &Shape, kind: CylinderKind) -> Option<Keys> {
    let Shape::Single(single) = shape else { return None };
    let CameraModel::Cylinder(frame) = shape.camera()? else { return None };
    let horizontal =
        Some(frame.horizontal).filter(|angle| single.any_shape || *angle != CylinderCamera::new(kind).horizontal);
    let (edge, top) = match kind {
        CylinderKind::Mercator => ("lat", frame.top),
        CylinderKind::Central | CylinderKind::EqualArea => ("vfov", frame.top.map(|top| top * 2.0)),
    };
    let keys = Keys::default().maybe("hfov", horizontal.map(Degrees)).maybe(edge, top.map(Degrees));
    (frame.kind == kind).then(|| keys.aspect(frame.pixel_aspect))
}

pub(crate) fn write_mirror_ball(shape: &Shape) -> Option<Keys> {
    let CameraModel::MirrorBall(frame) = shape.camera()? else { return None };
    let keys = Keys::default().maybe("distance", frame.distance).circle("", frame.circle);
    Some(keys.aspect(frame.pixel_aspect))
}

/// Writes a map of the whole world, which has no keys of its own.
pub(crate) fn write_whole(shape: &Shape, map: WorldMapCamera) -> Option<Keys> {
    let CameraModel::WorldMap(frame) = shape.camera()? else { return None };
    (frame == map).then(Keys::default)
}

pub(crate) fn write_pannini(shape: &Shape) -> Option<Keys> {
    let CameraModel::Pannini(frame) = shape.camera()? else { return None };
    let default = PanniniCamera::default();
    let keys = Keys::default().angle("fov", frame.field_of_view, default.field_of_view);
    Some(keys.number("d", frame.distance, default.distance).aspect(frame.pixel_aspect))
}

pub(crate) fn write_octahedral(shape: &Shape) -> Option<Keys> {
    let CameraModel::Octahedral(frame) = shape.camera()? else { return None };
    Some(Keys::default().choice("kind", frame.kind, OctahedralKind::default(), &KINDS))
}
