//! Circles on black as SPECs, and a warning if a circle is not where a SPEC assumes it.

use cosmorama::camera::{
    CameraModel, FisheyeCamera, FisheyeFit, LensCircle, LensScale, Mirror, MirrorBallCamera, PixelPoint,
};
use cosmorama::circle::{self, Circle, Found};
use cosmorama::raster::{ColourChannel, Image, Rgba, Transfer};
use cosmorama_spec::{Shape, Spec};

use crate::diagnostic::{Code, Diagnostic, FROM, Remedy, Setting};
use crate::source::memory_budget::area;

/// Pixels along the shorter side of the coarse copy in which a circle is looked for, at least.
const COARSE: usize = 512;
/// Distances from the assumed circle, as parts of its radius, that cause a warning: for a measured circle, and for a
/// rough one.
const APART: [f64; 2] = [0.02, 0.05];

/// Returns a found circle as a SPEC tells it: to a tenth of a pixel, or to a pixel where it is rough.
pub(crate) fn lens_circle(found: &Found) -> LensCircle {
    let Circle { centre: (x, y), radius } = found.circle();
    let parts = if matches!(found, Found::Measured(_)) { 10.0 } else { 1.0 };
    let [x, y, radius] = [x, y, radius].map(|length| (length * parts).round() / parts);
    LensCircle { centre: Some(PixelPoint::new(x, y)), radius: Some(radius) }
}

/// Returns the SPECs that may fit a circle: a fisheye, whose field of view is written as given, and a mirror ball.
pub(crate) fn specs(found: &Found, fov: &str) -> [String; 2] {
    let circle = lens_circle(found);
    let fisheye = Spec::from(CameraModel::Fisheye(FisheyeCamera { circle, ..FisheyeCamera::default() }));
    let ball = Spec::from(CameraModel::MirrorBall(MirrorBallCamera { circle, ..MirrorBallCamera::default() }));
    [fisheye.to_string().replacen(':', &format!(":fov={fov},"), 1), ball.to_string()]
}

/// Warns if the circle on black is not where a SPEC without `radius=` assumes it: touching the sides. The light of a
/// file of `size` pixels is given by column and row.
pub(crate) fn elsewhere(
    spec: &Spec,
    (name, size): (&str, (usize, usize)),
    light: impl Fn(usize, usize) -> Rgba,
) -> Option<Diagnostic> {
    let (width, height) = size;
    let radius = width.min(height) as f64 / 2.0;
    // Only a SPEC that leaves its circle's place open is equal to the one with a fitted circle.
    with_circle(spec, LensCircle::FITTED).filter(|fitted| fitted == spec)?;
    let found = coarsely(size, light)?;
    let Circle { centre: (x, y), radius: true_radius } = found.circle();
    let off = [x - width as f64 / 2.0, y - height as f64 / 2.0, true_radius - radius].map(f64::abs);
    let is_rough = matches!(found, Found::Roughly(_));
    if off.into_iter().fold(0.0, f64::max) <= APART[usize::from(is_rough)] * radius {
        return None;
    }
    let told = with_circle(spec, lens_circle(&Found::Roughly(found.circle())))?.to_string();
    let message = format!(
        "{name}: {FROM} {spec} has its circle touch the shorter sides, {radius} pixels around the middle, but {} circle on \
         black is there; if it is the lens's, give {FROM} {told}",
        if is_rough { "roughly another" } else { "another" }
    );
    Some(Diagnostic::warning(Code::Circle, message).about(name).with_remedy(Remedy::Set(Setting::From, told)))
}

/// Returns a SPEC of one whole picture, whose circle touches the shorter sides unless placed, with another circle.
fn with_circle(spec: &Spec, circle: LensCircle) -> Option<Spec> {
    let mut spec = spec.clone();
    let Shape::Single(single) = &mut spec.shape else { return None };
    match &mut single.placement.frame {
        CameraModel::Fisheye(lens)
            if lens.scale == LensScale::Circle(FisheyeFit::Short) && lens.pixel_aspect == 1.0 =>
        {
            lens.circle = circle;
        }
        CameraModel::MirrorBall(ball) if ball.pixel_aspect == 1.0 => ball.circle = circle,
        _ => return None,
    }
    let is_whole = spec.stereo.is_none() && single.placement.canvas.is_none();
    (is_whole && single.placement.mirror == Mirror::default()).then_some(spec)
}

/// Returns the distance of a coarse copy's columns, and of its rows.
fn step((width, height): (usize, usize)) -> usize {
    (width.min(height) / COARSE).max(1)
}

/// Returns the bytes of the coarse copy in which a circle is looked for.
pub(crate) fn copy_bytes(size @ (width, height): (usize, usize)) -> u64 {
    area((width / step(size), height / step(size))).saturating_mul(size_of::<Rgba>() as u64)
}

/// Finds a circle in a coarse copy, which has every so many columns and rows.
fn coarsely((width, height): (usize, usize), light: impl Fn(usize, usize) -> Rgba) -> Option<Found> {
    let step = step((width, height));
    // Only the brightest channel matters.
    let code = |i: usize, j: usize| {
        let [red, green, blue, _] = light(i * step + step / 2, j * step + step / 2).0;
        let code = Transfer::Srgb.encode(f64::from(red.max(green).max(blue)), ColourChannel::Green) as f32;
        Rgba::opaque(code, code, code)
    };
    let found = circle::find(&Image::from_fn(width / step, height / step, code))?;
    let Circle { centre: (x, y), radius } = found.circle();
    let place = |k: f64| (k - 0.5) * step as f64 + (step / 2) as f64 + 0.5;
    let circle = Circle { centre: (place(x), place(y)), radius: radius * step as f64 };
    Some(match found {
        Found::Measured(_) => Found::Measured(circle),
        Found::Roughly(_) => Found::Roughly(circle),
    })
}
