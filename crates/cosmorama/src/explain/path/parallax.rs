use std::fmt::{Display, Formatter};

use crate::camera::{Footprint, View};

/// Error of a distant world for a camera that does not only turn: what is near would shift before what is far.
///
/// A thing at a distance N from the place where the world was made is seen from a place T away at another angle, by at most
/// asin(T/N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallax {
    /// Greatest distance of the camera from the place where the world was made.
    pub travel: f64,
    /// Distance of the nearest thing from that place.
    pub nearest: f64,
    /// Greatest error in degrees.
    pub degrees: f64,
    /// Greatest error in the finest pixels of all frames.
    pub pixels: f64,
    /// Distance from which on things are less than half a pixel off.
    pub unseen_from: f64,
}

/// Points along each side of a frame at which its pixels are measured.
const POINTS: usize = 17;

/// Error in pixels that nobody sees.
const UNSEEN: f64 = 0.5;

impl Parallax {
    /// Computes the error over frames with these views each. `None` unless the camera stays nearer than the nearest thing, and
    /// shows something.
    pub fn of(frames: &[Vec<View>], travel: f64, nearest: f64) -> Option<Self> {
        let is_between = travel >= 0.0 && travel < nearest && nearest.is_finite();
        let finest = frames.iter().flatten().map(finest_pixels_per_radian).fold(0.0, f64::max);
        (is_between && finest > 0.0).then(|| {
            let angle = (travel / nearest).asin();
            Self {
                travel,
                nearest,
                degrees: angle.to_degrees(),
                pixels: angle * finest,
                unseen_from: travel / (UNSEEN / finest).min(1.0).sin(),
            }
        })
    }
}

/// Returns the pixels in a radian where a view has most, along the direction in which they are smallest.
fn finest_pixels_per_radian(view: &View) -> f64 {
    let at = |size: usize, k: usize| (size.saturating_sub(1) * k / (POINTS - 1)).min(size.saturating_sub(1));
    let points = (0..POINTS * POINTS).map(|k| (at(view.width(), k % POINTS), at(view.height(), k / POINTS)));
    let footprints = points.filter_map(|(i, j)| view.centre_footprint(i, j));
    // Of a footprint that is made of a covariance, the second side is the shorter semi-axis.
    let smallest = footprints
        .map(|footprint| Footprint::from_covariance(footprint.direction, footprint.covariance()).jacobian.dy.length());
    smallest.filter(|side| *side > 0.0).map(f64::recip).fold(0.0, f64::max)
}

impl Display for Parallax {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { travel, nearest, degrees, pixels, unseen_from } = self;
        writeln!(
            f,
            "parallax things {nearest} m away are off by up to {pixels:.2} pixels ({degrees:.3}°) where the camera is {travel} m from \
             the world's place; from {unseen_from:.1} m on by less than half a pixel"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, FieldOfView, PerspectiveCamera};
    use crate::sphere::Angle;

    #[test]
    fn the_error_is_that_of_a_thing_beside_the_way() {
        let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(60.0)));
        let view = CameraModel::from(camera).view(1920, 1080).unwrap();
        let found = Parallax::of(&[vec![view]], 0.5, 50.0).unwrap();
        // A pixel at the corner is smallest along the radius: cos² of the angle there times that at the centre.
        let focal = 960.0 / 30_f64.to_radians().tan();
        let corner = (959.5_f64.hypot(539.5) / focal).atan();
        let expected = 0.01_f64.asin() * focal / corner.cos().powi(2);
        assert!((found.pixels / expected - 1.0).abs() < 1e-3, "{found:?}, not {expected}");
        let from = 0.5 / (0.5 / (focal / corner.cos().powi(2))).sin();
        assert!((found.unseen_from / from - 1.0).abs() < 1e-3, "{found:?}, not {from}");
        assert_eq!(found.degrees, 0.01_f64.asin().to_degrees());
    }

    #[test]
    fn what_is_passed_has_no_error_to_tell() {
        let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(60.0)));
        let view = vec![CameraModel::from(camera).view(64, 48).unwrap()];
        let frames = [view];
        assert!(Parallax::of(&frames, 2.0, 2.0).is_none() && Parallax::of(&frames, -1.0, 2.0).is_none());
        assert!(Parallax::of(&[], 1.0, 2.0).is_none());
        assert_eq!(Parallax::of(&frames, 0.0, 2.0).map(|found| found.pixels), Some(0.0));
    }
}
