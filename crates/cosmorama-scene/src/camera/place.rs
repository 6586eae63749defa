use cosmorama::sphere::{Angle, Orientation};
use glam::DVec3;

use crate::error::SceneError;

/// Place of a camera: where its eye is, and what it looks at. Its upper side is that of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The eye.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub target: DVec3,
}

impl Place {
    /// Returns the orientation of a camera here.
    ///
    /// # Errors
    /// When the eye is at the target, so that no direction is meant, or when one is not finite.
    pub fn orientation(&self) -> Result<Orientation, SceneError> {
        let ahead = self.target - self.eye;
        if !(ahead.is_finite() && ahead.length() > 0.0) {
            return Err(SceneError::NoDirection { eye: self.eye.to_array(), target: self.target.to_array() });
        }
        // Yaw turns to the right from −Z, pitch up.
        let yaw = ahead.x.atan2(-ahead.z);
        let pitch = ahead.y.atan2(ahead.x.hypot(ahead.z));
        let angle = |radians: f64| Angle::from_radians(radians);
        Ok(Orientation::from_yaw_pitch_roll(angle(yaw), angle(pitch), angle(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosmorama::sphere::Direction;

    #[test]
    fn the_target_is_ahead() {
        let targets = [[0.0, 0.0, -1.0], [3.0, 1.0, 0.5], [-2.0, 0.1, 4.0], [0.0, 5.0, 0.0], [0.0, -5.0, 0.0]];
        for target in targets.map(DVec3::from_array) {
            let place = Place { eye: DVec3::new(0.5, 0.25, -0.125), target };
            let orientation = place.orientation().expect("a direction");
            let ahead = orientation.to_world(Direction::FRONT).vector();
            assert!((ahead - (target - place.eye).normalize()).length() < 1e-12, "{target:?}");
            assert!(
                orientation.to_world(Direction::UP).vector().y >= 0.0
                    && orientation.to_world(Direction::RIGHT).vector().y.abs() < 1e-12
            );
        }
        let nowhere = Place { eye: DVec3::ONE, target: DVec3::ONE };
        assert!(nowhere.orientation().is_err());
        assert!(Place { eye: DVec3::NAN, ..nowhere }.orientation().is_err());
    }
}
