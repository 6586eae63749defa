//! Text form of fisheye lenses: `lens=NAME,k=…`, and the scale of their pictures.

use cosmorama::camera::{CameraModel, FisheyeCamera, FisheyeFit, LensScale};
use cosmorama::projection::azimuthal::{
    DoubleSphere, FieldOfViewLens, FisheyeLens, KannalaBrandt, LensError, OCAM_COEFFICIENTS, Ocam, Polynomial, Unified,
};
use cosmorama::sphere::Angle;

use crate::SpecError;
use crate::spec::fields::{Fields, wrong};
use crate::spec::keys::Keys;
use crate::spec::{CalibrationSpec, LensFamily, Shape};

/// A lens by name.
#[derive(Clone, Copy)]
enum Model {
    Ideal(FisheyeLens),
    Polynomial,
    KannalaBrandt,
    Ocam,
    Unified,
    ExtendedUnified,
    DoubleSphere,
    FieldOfView,
}

const MODELS: [(&str, Model); 11] = [
    ("equidistant", Model::Ideal(FisheyeLens::EQUIDISTANT)),
    ("equisolid", Model::Ideal(FisheyeLens::EQUISOLID)),
    ("stereographic", Model::Ideal(FisheyeLens::STEREOGRAPHIC)),
    ("orthographic", Model::Ideal(FisheyeLens::ORTHOGRAPHIC)),
    ("polynomial", Model::Polynomial),
    ("kannala-brandt", Model::KannalaBrandt),
    ("ocam", Model::Ocam),
    ("ucm", Model::Unified),
    ("eucm", Model::ExtendedUnified),
    ("double-sphere", Model::DoubleSphere),
    ("fov", Model::FieldOfView),
];

pub(crate) fn fisheye(fields: &Fields) -> Result<Shape, SpecError> {
    if let Some(camera) = CalibrationSpec::build(fields, LensFamily::Fisheye)? {
        return Ok(Shape::Calibrated(camera));
    }
    let lens = lens(fields)?;
    let scale = scale(fields)?;
    let field_of_view = match (fields.angle("fov")?, scale) {
        (Some(angle), _) => angle,
        (None, LensScale::Circle(_)) => FisheyeCamera::default().field_of_view,
        // The scale gives the picture's size, so the field of view is all that the lens shows.
        (None, _) => FisheyeCamera::whole_field(lens),
    };
    let frame = FisheyeCamera { lens, field_of_view, scale, circle: fields.circle()?, pixel_aspect: fields.aspect()? };
    Shape::single(fields, CameraModel::Fisheye(frame))
}

/// Builds Debevec's light probe: an equidistant fisheye of 360°.
pub(crate) fn angular_map(fields: &Fields) -> Result<Shape, SpecError> {
    let frame = FisheyeCamera {
        field_of_view: Angle::TURN,
        circle: fields.circle()?,
        pixel_aspect: fields.aspect()?,
        ..FisheyeCamera::default()
    };
    Shape::single(fields, CameraModel::Fisheye(frame))
}

fn scale(fields: &Fields) -> Result<LensScale, SpecError> {
    for [first, second] in [
        ["focal", "sensor"],
        ["focal", "fit"],
        ["focal", "radius"],
        ["sensor", "fit"],
        ["sensor", "radius"],
        ["fit", "radius"],
    ] {
        if fields.get(first).is_some() && fields.get(second).is_some() {
            return Err(SpecError::Both { first, second });
        }
    }
    let focal = fields.positive("focal", "a focal length in pixels, more than 0, as in focal=412.5")?;
    let sensor = fields.positive("sensor", "the sensor's width in millimetres, more than 0, as in sensor=36")?;
    if let Some(value) = fields.get("sensor").filter(|_| fields.get("lens") != Some("polynomial")) {
        return Err(wrong(
            "sensor",
            value,
            "lens=polynomial beside it, which counts in millimetres; else give focal= or fit=",
        ));
    }
    Ok(match (focal, sensor) {
        (Some(pixels), _) => LensScale::Focal(pixels),
        (None, Some(width)) => LensScale::SensorWidth(width),
        (None, None) => LensScale::Circle(fit(fields)?),
    })
}

const FITS: [(&str, FisheyeFit); 5] = [
    ("short", FisheyeFit::Short),
    ("long", FisheyeFit::Long),
    ("width", FisheyeFit::Width),
    ("height", FisheyeFit::Height),
    ("diagonal", FisheyeFit::Diagonal),
];

/// Reads the dimension of the image that the circle spans.
pub(crate) fn fit(fields: &Fields) -> Result<FisheyeFit, SpecError> {
    Ok(fields.choice("fit", &FITS)?.unwrap_or_default())
}

/// Reads the lens formula.
pub(crate) fn lens(fields: &Fields) -> Result<FisheyeLens, SpecError> {
    let model = fields.choice("lens", &MODELS)?.unwrap_or(Model::Ideal(FisheyeLens::EQUIDISTANT));
    let refused = |error: LensError| {
        let value = fields.get("k").unwrap_or_default().to_owned();
        SpecError::Coefficients { value, error }
    };
    match model {
        Model::Ideal(lens) => match fields.get("k") {
            Some(value) => Err(wrong("k", value, "no coefficients, which only measured lenses have")),
            None => Ok(lens),
        },
        Model::Polynomial => {
            let k = coefficients(fields, 2, "k0:k1:k2:k3:k4 as in Blender, as in k=0:-0.02:0:0:0")?;
            Polynomial::from_blender(k).map(FisheyeLens::Polynomial).map_err(refused)
        }
        Model::KannalaBrandt => {
            let k = coefficients(fields, 1, "k1:k2:k3:k4 as in OpenCV, as in k=-0.01:0.002:0:0")?;
            KannalaBrandt::from_opencv(k).map(FisheyeLens::KannalaBrandt).map_err(refused)
        }
        Model::Ocam => {
            let k: [f64; OCAM_COEFFICIENTS] =
                coefficients(fields, 1, "a0:a1:a2… as in OCamCalib, at most 8, as in k=-250:0:0.002")?;
            Ocam::from_coefficients(k).map(FisheyeLens::Ocam).map_err(refused)
        }
        Model::Unified => {
            let [alpha] = coefficients(fields, 1, "alpha, as in k=0.55")?;
            Unified::from_parameters(alpha, 1.0).map(FisheyeLens::Unified).map_err(refused)
        }
        Model::ExtendedUnified => {
            let [alpha, beta] = coefficients(fields, 2, "alpha:beta, as in k=0.6:1.1")?;
            Unified::from_parameters(alpha, beta).map(FisheyeLens::Unified).map_err(refused)
        }
        Model::DoubleSphere => {
            let [xi, alpha] = coefficients(fields, 2, "xi:alpha, as in k=-0.18:0.59")?;
            DoubleSphere::from_parameters(xi, alpha).map(FisheyeLens::DoubleSphere).map_err(refused)
        }
        Model::FieldOfView => {
            let [omega] = coefficients(fields, 1, "omega in radians, as in k=0.95")?;
            FieldOfViewLens::from_omega(omega).map(FisheyeLens::FieldOfView).map_err(refused)
        }
    }
}

/// Reads `k=`, with at least `least` numbers; the others are 0.
fn coefficients<const N: usize>(fields: &Fields, least: usize, expected: &str) -> Result<[f64; N], SpecError> {
    let numbers = |value: &str| {
        let mut numbers = [0.0; N];
        let mut count = 0;
        for part in value.split(':') {
            *numbers.get_mut(count)? = part.trim().parse().ok()?;
            count += 1;
        }
        (count >= least).then_some(numbers)
    };
    fields.read("k", expected, numbers)?.ok_or_else(|| wrong("k", "", expected))
}

pub(crate) fn write_fisheye(shape: &Shape) -> Option<Keys> {
    if let Shape::Calibrated(camera) = shape {
        return camera.write(LensFamily::Fisheye);
    }
    let CameraModel::Fisheye(frame) = shape.camera()? else { return None };
    let usual = match frame.scale {
        LensScale::Circle(_) => FisheyeCamera::default().field_of_view,
        LensScale::Focal(_) | LensScale::SensorWidth(_) => FisheyeCamera::whole_field(frame.lens),
    };
    let keys = write_lens(Keys::default().angle("fov", frame.field_of_view, usual), frame.lens);
    Some(write_scale(keys, frame.scale).circle("", frame.circle).aspect(frame.pixel_aspect))
}

pub(crate) fn write_angular_map(shape: &Shape) -> Option<Keys> {
    let CameraModel::Fisheye(frame) = shape.camera()? else { return None };
    let plain = FisheyeCamera {
        field_of_view: Angle::TURN,
        circle: frame.circle,
        pixel_aspect: frame.pixel_aspect,
        ..FisheyeCamera::default()
    };
    (frame == plain).then(|| Keys::default().circle("", frame.circle).aspect(frame.pixel_aspect))
}

/// Adds the keys for the scale of a lens's picture.
pub(in crate::spec) fn write_scale(keys: Keys, scale: LensScale) -> Keys {
    match scale {
        LensScale::Circle(fit) => keys.choice("fit", fit, FisheyeFit::default(), &FITS),
        LensScale::Focal(pixels) => keys.with("focal", pixels),
        LensScale::SensorWidth(millimetres) => keys.with("sensor", millimetres),
    }
}

/// Adds the name of a lens and its coefficients.
pub(in crate::spec) fn write_lens(keys: Keys, lens: FisheyeLens) -> Keys {
    let (name, k): (&str, Vec<f64>) = match lens {
        FisheyeLens::Equidistant(_) | FisheyeLens::Hugin(_) => return keys,
        FisheyeLens::Equisolid(_) => return keys.with("lens", "equisolid"),
        FisheyeLens::Stereographic(_) => return keys.with("lens", "stereographic"),
        FisheyeLens::Orthographic(_) => return keys.with("lens", "orthographic"),
        FisheyeLens::Polynomial(lens) => ("polynomial", lens.to_blender().to_vec()),
        FisheyeLens::KannalaBrandt(lens) => ("kannala-brandt", lens.to_opencv().to_vec()),
        FisheyeLens::Ocam(lens) => ("ocam", lens.coefficients().to_vec()),
        FisheyeLens::Unified(lens) => match lens.parameters() {
            [alpha, 1.0] => ("ucm", vec![alpha]),
            [alpha, beta] => ("eucm", vec![alpha, beta]),
        },
        FisheyeLens::DoubleSphere(lens) => ("double-sphere", lens.parameters().to_vec()),
        FisheyeLens::FieldOfView(lens) => ("fov", vec![lens.omega()]),
    };
    let k: Vec<String> = k.iter().map(f64::to_string).collect();
    keys.with("lens", name).with("k", k.join(":"))
}
