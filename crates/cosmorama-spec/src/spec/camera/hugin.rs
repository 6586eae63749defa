//! Text form of Hugin's lenses: f, v and a b c d e of an i-line.

use cosmorama::camera::{CameraModel, HuginCamera, HuginProjection};
use cosmorama::sphere::Angle;

use crate::SpecError;
use crate::spec::Shape;
use crate::spec::fields::Fields;
use crate::spec::keys::Keys;

/// Lenses of an i-line that a, b and c correct, by f: 0, 2 or 3, 8, 10, 21.
const LENSES: [(&str, HuginProjection); 5] = [
    ("rectilinear", HuginProjection::Rectilinear),
    ("fisheye", HuginProjection::Equidistant),
    ("orthographic", HuginProjection::Orthographic),
    ("stereographic", HuginProjection::Stereographic),
    ("equisolid", HuginProjection::Equisolid),
];

pub(crate) fn hugin(fields: &Fields) -> Result<Shape, SpecError> {
    let projection = fields.choice("lens", &LENSES)?.unwrap_or(HuginProjection::Rectilinear);
    let coefficient = |key: &str| number(fields, key, &format!("a coefficient of Hugin's, as in {key}=-0.02"));
    let frame = HuginCamera {
        projection,
        field_of_view: fields.angle("fov")?.unwrap_or(usual(projection)),
        correction: [coefficient("a")?, coefficient("b")?, coefficient("c")?],
        shift: [
            number(fields, "d", "pixels to the right of the image's middle, as in d=12.5")?,
            number(fields, "e", "pixels below the image's middle, as in e=-7")?,
        ],
    };
    Shape::single(fields, CameraModel::Hugin(frame))
}

/// Returns the default field of view of a lens.
fn usual(projection: HuginProjection) -> Angle {
    Angle::from_degrees(if projection == HuginProjection::Rectilinear { 90.0 } else { 180.0 })
}

pub(crate) fn write(shape: &Shape) -> Option<Keys> {
    let CameraModel::Hugin(frame) = shape.camera()? else { return None };
    let ([a, b, c], [d, e]) = (frame.correction, frame.shift);
    let keys = Keys::default().choice("lens", frame.projection, HuginProjection::Rectilinear, &LENSES).angle(
        "fov",
        frame.field_of_view,
        usual(frame.projection),
    );
    let numbers = [("a", a), ("b", b), ("c", c), ("d", d), ("e", e)];
    Some(numbers.into_iter().fold(keys, |keys, (key, value)| keys.number(key, value, 0.0)))
}

fn number(fields: &Fields, key: &str, expected: &str) -> Result<f64, SpecError> {
    let finite = |value: &str| value.parse().ok().filter(|number: &f64| number.is_finite());
    Ok(fields.read(key, expected, finite)?.unwrap_or(0.0))
}
