//! Hugin's lenses as they are typed: an i-line's f, v and a b c d e.

use cosmorama::camera::{CameraModel, HuginCamera, HuginProjection};
use cosmorama::sphere::Angle;

use crate::SpecError;
use crate::spec::Shape;
use crate::spec::fields::Fields;

/// The lenses of an i-line that a, b and c correct, by its f: 0, 2 or 3, 8, 10, 21.
const LENSES: [(&str, HuginProjection); 5] = [
    ("rectilinear", HuginProjection::Rectilinear),
    ("fisheye", HuginProjection::Equidistant),
    ("orthographic", HuginProjection::Orthographic),
    ("stereographic", HuginProjection::Stereographic),
    ("equisolid", HuginProjection::Equisolid),
];

pub(crate) fn hugin(fields: &Fields) -> Result<Shape, SpecError> {
    let projection = fields.choice("lens", &LENSES)?.unwrap_or(HuginProjection::Rectilinear);
    let usual = if projection == HuginProjection::Rectilinear { 90.0 } else { 180.0 };
    let coefficient = |key: &str| number(fields, key, &format!("a coefficient of Hugin's, as in {key}=-0.02"));
    let frame = HuginCamera {
        projection,
        field_of_view: fields.angle("fov")?.unwrap_or(Angle::from_degrees(usual)),
        correction: [coefficient("a")?, coefficient("b")?, coefficient("c")?],
        shift: [
            number(fields, "d", "pixels to the right of the image's middle, as in d=12.5")?,
            number(fields, "e", "pixels below the image's middle, as in e=-7")?,
        ],
    };
    Shape::single(fields, CameraModel::Hugin(frame))
}

fn number(fields: &Fields, key: &str, expected: &str) -> Result<f64, SpecError> {
    let finite = |value: &str| value.parse().ok().filter(|number: &f64| number.is_finite());
    Ok(fields.read(key, expected, finite)?.unwrap_or(0.0))
}
