//! Maps, mirror balls and octahedra as they are typed.

use cosmorama::projection::OctahedralKind;
use cosmorama::world::{CylinderFrame, CylinderKind, MirrorBallFrame, OctahedralFrame, PanniniFrame};

use super::SpecError;
use super::fields::Fields;

/// `mercator`, `cylinder` or `equal-area`: Mercator's edges are given as a latitude, the others' as a field of view.
pub(super) fn cylinder(fields: &Fields, kind: CylinderKind) -> Result<CylinderFrame, SpecError> {
    let (edge, top) = match kind {
        CylinderKind::Mercator => ("lat", fields.angle("lat")?),
        CylinderKind::Central | CylinderKind::EqualArea => ("vfov", fields.angle("vfov")?.map(|angle| angle * 0.5)),
    };
    if top.is_some() && fields.get("aspect").is_some() {
        return Err(SpecError::Both { first: "aspect", second: edge });
    }
    let default = CylinderFrame::new(kind);
    let horizontal = fields.angle("hfov")?.unwrap_or(default.horizontal);
    Ok(CylinderFrame { horizontal, top, pixel_aspect: fields.aspect()?, ..default })
}

pub(super) fn mirror_ball(fields: &Fields) -> Result<MirrorBallFrame, SpecError> {
    let distance =
        fields.read("distance", "ball radii from the camera to the ball's centre, more than 1, or inf", |value| {
            match value {
                "inf" => Some(None),
                _ => value.parse().ok().filter(|distance: &f64| *distance > 1.0 && distance.is_finite()).map(Some),
            }
        })?;
    Ok(MirrorBallFrame { distance: distance.flatten(), circle: fields.circle()?, pixel_aspect: fields.aspect()? })
}

pub(super) fn pannini(fields: &Fields) -> Result<PanniniFrame, SpecError> {
    let default = PanniniFrame::default();
    let distance = fields.read("d", "a distance, 0 or more, as in d=1", |value| {
        value.parse().ok().filter(|distance: &f64| *distance >= 0.0 && distance.is_finite())
    })?;
    Ok(PanniniFrame {
        distance: distance.unwrap_or(default.distance),
        field_of_view: fields.angle("fov")?.unwrap_or(default.field_of_view),
        pixel_aspect: fields.aspect()?,
    })
}

pub(super) fn octahedral(fields: &Fields) -> Result<OctahedralFrame, SpecError> {
    let kinds = [("equal-area", OctahedralKind::EqualArea), ("plain", OctahedralKind::Plain)];
    Ok(OctahedralFrame { kind: fields.choice("kind", &kinds)?.unwrap_or_default() })
}
