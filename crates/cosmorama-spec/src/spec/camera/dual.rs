use cosmorama::camera::{FisheyeCamera, LensScale, Mirror};
use cosmorama::layout::{Arrangement, DualFisheye, DualLens, LensSide};
use cosmorama::sphere::Orientation;

use super::lens::{fit, lens};
use crate::SpecError;
use crate::spec::fields::Fields;

/// Two fisheye pictures in one image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The pictures.
    pub picture: DualFisheye,
    /// How both are turned.
    pub orientation: Orientation,
    /// How the image is mirrored.
    pub mirror: Mirror,
}

impl Dual {
    /// The pictures of these keys.
    pub(in crate::spec) fn build(fields: &Fields) -> Result<Self, SpecError> {
        let arrangements = [("side-by-side", Arrangement::SideBySide), ("top-bottom", Arrangement::TopBottom)];
        let orders = [("fb", LensSide::Front), ("bf", LensSide::Back)];
        let both = FisheyeCamera {
            lens: lens(fields)?,
            field_of_view: fields.angle("fov")?.unwrap_or(DualFisheye::FIELD_OF_VIEW),
            scale: LensScale::Circle(fit(fields)?),
            pixel_aspect: fields.aspect()?,
            ..FisheyeCamera::default()
        };
        let picture = DualFisheye {
            arrangement: fields.choice("layout", &arrangements)?.unwrap_or_default(),
            first: fields.choice("order", &orders)?.unwrap_or(LensSide::Front),
            front: one(fields, LensSide::Front, both)?,
            back: one(fields, LensSide::Back, both)?,
            feather: fields.feather()?,
        };
        Ok(Self { picture, orientation: fields.orientation()?, mirror: fields.mirror()? })
    }
}

/// One of the two, with what is said of it alone.
fn one(fields: &Fields, side: LensSide, both: FisheyeCamera) -> Result<DualLens, SpecError> {
    let prefix = format!("{}.", side.name());
    let field_of_view = fields.angle(&format!("{prefix}fov"))?.unwrap_or(both.field_of_view);
    let frame = FisheyeCamera { field_of_view, circle: fields.circle_of(&prefix)?, ..both };
    Ok(DualLens { frame, turned: fields.orientation_of(&prefix)? })
}
