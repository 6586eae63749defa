use cosmorama::camera::{FisheyeCamera, LensScale, Mirror};
use cosmorama::layout::{Arrangement, DualFisheye, DualLens, LensSide};
use cosmorama::sphere::Orientation;

use super::lens::{fit, lens, write_lens, write_scale};
use crate::SpecError;
use crate::angle::Degrees;
use crate::spec::Shape;
use crate::spec::fields::Fields;
use crate::spec::keys::Keys;

/// Two fisheye pictures in one image, as a SPEC describes them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// Both pictures, with their places in the image.
    pub picture: DualFisheye,
    /// Orientation of both together.
    pub orientation: Orientation,
    /// Mirroring of the image.
    pub mirror: Mirror,
}

const ARRANGEMENTS: [(&str, Arrangement); 2] =
    [("side-by-side", Arrangement::SideBySide), ("top-bottom", Arrangement::TopBottom)];
const ORDERS: [(&str, LensSide); 2] = [("fb", LensSide::Front), ("bf", LensSide::Back)];

impl Dual {
    /// Reads the keys of two fisheyes.
    pub(in crate::spec) fn build(fields: &Fields) -> Result<Self, SpecError> {
        let both = FisheyeCamera {
            lens: lens(fields)?,
            field_of_view: fields.angle("fov")?.unwrap_or(DualFisheye::FIELD_OF_VIEW),
            scale: LensScale::Circle(fit(fields)?),
            pixel_aspect: fields.aspect()?,
            ..FisheyeCamera::default()
        };
        let picture = DualFisheye {
            arrangement: fields.choice("layout", &ARRANGEMENTS)?.unwrap_or_default(),
            first: fields.choice("order", &ORDERS)?.unwrap_or(LensSide::Front),
            front: one(fields, LensSide::Front, both)?,
            back: one(fields, LensSide::Back, both)?,
            feather: fields.feather()?,
        };
        Ok(Self { picture, orientation: fields.orientation()?, mirror: fields.mirror()? })
    }

    /// Writes the keys, if the shape is two fisheyes.
    pub(in crate::spec) fn write(shape: &Shape) -> Option<Keys> {
        let Shape::Dual(dual) = shape else { return None };
        let DualFisheye { arrangement, first, front, back, feather } = dual.picture;
        let both = front.frame;
        let keys = Keys::default()
            .angle("fov", both.field_of_view, DualFisheye::FIELD_OF_VIEW)
            .choice("layout", arrangement, Arrangement::default(), &ARRANGEMENTS)
            .choice("order", first, LensSide::Front, &ORDERS)
            .maybe("feather", feather.map(Degrees));
        let keys = write_scale(write_lens(keys, both.lens), both.scale).aspect(both.pixel_aspect);
        let keys = keys.angle("back.fov", back.frame.field_of_view, both.field_of_view);
        let keys = [(LensSide::Front, front), (LensSide::Back, back)].into_iter().fold(keys, |keys, (side, lens)| {
            let prefix = format!("{}.", side.name());
            keys.circle(&prefix, lens.frame.circle).orientation(&prefix, lens.turned)
        });
        Some(keys.placed(dual.orientation, dual.mirror, None))
    }
}

/// Reads one of the two lenses, with the keys that apply to it alone.
fn one(fields: &Fields, side: LensSide, both: FisheyeCamera) -> Result<DualLens, SpecError> {
    let prefix = format!("{}.", side.name());
    let field_of_view = fields.angle(&format!("{prefix}fov"))?.unwrap_or(both.field_of_view);
    let frame = FisheyeCamera { field_of_view, circle: fields.circle_of(&prefix)?, ..both };
    Ok(DualLens { frame, turned: fields.orientation_of(&prefix)? })
}
