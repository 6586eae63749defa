use cosmorama::sphere::Angle;
use cosmorama::world::{
    CylinderKind, EquirectFrame, FieldOfView, FisheyeFrame, Frame, FulldomeFrame, OmnimaxFrame, OmnimaxFraming,
    PerspectiveFrame, Placement, StereographicFrame, WorldMapFrame,
};

use super::calibration::{Family, calibrated};
use super::cube::Cube;
use super::dual::Dual;
use super::fields::Fields;
use super::lens::fisheye;
use super::maps::{cylinder, mirror_ball, octahedral, pannini};
use super::shape::{Shape, Single, SphereSamples};
use super::st_map::StMapSpec;
use super::{SpecError, angle::parse_degrees};

impl Shape {
    /// The shape of a name of the table and keys of that name.
    pub(super) fn build(name: &str, fields: &Fields) -> Result<Self, SpecError> {
        let mut samples = SphereSamples::NotAPanorama;
        let frame = match name {
            "cube" => return Cube::build(fields).map(Self::Cube),
            "dual-fisheye" => return Dual::build(fields).map(Box::new).map(Self::Dual),
            "st-map" => return StMapSpec::build(fields).map(Self::StMap),
            "perspective" => match calibrated(fields, Family::Pinhole)? {
                Some(frame) => Frame::Calibrated(frame),
                None => Frame::Perspective(perspective(fields)?),
            },
            "equirect" => {
                let frame = equirect(fields)?;
                let given = fields.get("samples").is_some();
                samples = if given { SphereSamples::Given(frame.samples) } else { SphereSamples::ByFormat };
                Frame::Equirect(frame)
            }
            "fisheye" => match calibrated(fields, Family::Fisheye)? {
                Some(frame) => Frame::Calibrated(frame),
                None => Frame::Fisheye(fisheye(fields)?),
            },
            "stereographic" => Frame::Stereographic(stereographic(fields)?),
            "fulldome" => Frame::Fulldome(fulldome(fields)?),
            "omnimax" => Frame::Omnimax(omnimax(fields)?),
            "mercator" => Frame::Cylinder(cylinder(fields, CylinderKind::Mercator)?),
            "cylinder" => Frame::Cylinder(cylinder(fields, CylinderKind::Central)?),
            "equal-area" => Frame::Cylinder(cylinder(fields, CylinderKind::EqualArea)?),
            "mirror-ball" => Frame::MirrorBall(mirror_ball(fields)?),
            "angular-map" => Frame::Fisheye(angular_map(fields)?),
            "hammer" => Frame::WorldMap(WorldMapFrame::Hammer),
            "mollweide" => Frame::WorldMap(WorldMapFrame::Mollweide),
            "sinusoidal" => Frame::WorldMap(WorldMapFrame::Sinusoidal),
            "pannini" => Frame::Pannini(pannini(fields)?),
            "octahedral" => Frame::Octahedral(octahedral(fields)?),
            _ => return Err(SpecError::UnknownName { name: name.to_owned() }),
        };
        let placement = Placement {
            frame,
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
        };
        let any_shape = fields.get("hfov").is_some() && fields.get("vfov").is_some();
        Ok(Self::Single(Single { placement, samples, any_shape }))
    }
}

fn perspective(fields: &Fields) -> Result<PerspectiveFrame, SpecError> {
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
    Ok(PerspectiveFrame { field_of_view, pixel_aspect: fields.aspect()? })
}

fn equirect(fields: &Fields) -> Result<EquirectFrame, SpecError> {
    Ok(EquirectFrame {
        horizontal: fields.angle_or("hfov", 360.0)?,
        vertical: fields.angle_or("vfov", 180.0)?,
        samples: fields.samples()?.unwrap_or_default(),
    })
}

fn stereographic(fields: &Fields) -> Result<StereographicFrame, SpecError> {
    let default = StereographicFrame::default();
    Ok(StereographicFrame {
        field_of_view: fields.angle("fov")?.unwrap_or(default.field_of_view),
        pixel_aspect: fields.aspect()?,
    })
}

/// Debevec's light probes: an equidistant fisheye that sees everything.
fn angular_map(fields: &Fields) -> Result<FisheyeFrame, SpecError> {
    Ok(FisheyeFrame {
        field_of_view: Angle::TURN,
        circle: fields.circle()?,
        pixel_aspect: fields.aspect()?,
        ..FisheyeFrame::default()
    })
}

fn fulldome(fields: &Fields) -> Result<FulldomeFrame, SpecError> {
    Ok(FulldomeFrame {
        field_of_view: fields.angle_or("fov", 180.0)?,
        tilt: fields.angle_or("tilt", 0.0)?,
        pixel_aspect: fields.aspect()?,
    })
}

fn omnimax(fields: &Fields) -> Result<OmnimaxFrame, SpecError> {
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
    Ok(OmnimaxFrame {
        framing: fields.choice("framing", &framings)?.unwrap_or_default(),
        lower: lower.unwrap_or(default.lower),
        circle: fields.circle()?,
        axis: fields.angle_or("axis", 0.0)?,
        pixel_aspect: fields.aspect()?,
    })
}
