//! SPECs of pictures with a circle on black.

use cosmorama::camera::{CameraModel, FisheyeCamera, LensCircle, MirrorBallCamera, PixelPoint};
use cosmorama::circle::{Circle, Found};
use cosmorama_spec::Spec;

/// Returns a found circle as a SPEC tells it: to a tenth of a pixel, or to a pixel where it is rough.
pub(crate) fn lens_circle(found: &Found) -> LensCircle {
    let Circle { centre: (x, y), radius } = found.circle();
    let parts = if matches!(found, Found::Measured(_)) { 10.0 } else { 1.0 };
    let [x, y, radius] = [x, y, radius].map(|length| (length * parts).round() / parts);
    LensCircle { centre: Some(PixelPoint::new(x, y)), radius: Some(radius) }
}

/// Returns what may leave a circle: a fisheye, whose field of view is written as given, and a mirror ball.
pub(crate) fn specs(found: &Found, fov: &str) -> [String; 2] {
    let circle = lens_circle(found);
    let fisheye = Spec::from(CameraModel::Fisheye(FisheyeCamera { circle, ..FisheyeCamera::default() }));
    let ball = Spec::from(CameraModel::MirrorBall(MirrorBallCamera { circle, ..MirrorBallCamera::default() }));
    [fisheye.to_string().replacen(':', &format!(":fov={fov},"), 1), ball.to_string()]
}
