use super::by_angle::{ByAngle, RadiusFormula};
use crate::projection::azimuthal::{LensError, finite};

/// Kannala & Brandt's fisheye, as in OpenCV (`cv::fisheye`): r = θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸) focal lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KannalaBrandtFormula([f64; 4]);

/// Lens with Kannala & Brandt's formula.
pub type KannalaBrandt = ByAngle<KannalaBrandtFormula>;

impl KannalaBrandt {
    /// Returns the lens with OpenCV's coefficients k1 to k4.
    ///
    /// # Errors
    /// When a coefficient is not finite.
    pub fn from_opencv(k: [f64; 4]) -> Result<Self, LensError> {
        finite("a coefficient of Kannala-Brandt", &k)?;
        Self::new(KannalaBrandtFormula(k))
    }

    /// Returns OpenCV's coefficients k1 to k4.
    pub fn to_opencv(&self) -> [f64; 4] {
        self.formula.0
    }
}

impl RadiusFormula for KannalaBrandtFormula {
    fn formula(&self, angle: f64) -> (f64, f64) {
        let [k1, k2, k3, k4] = self.0;
        let t = angle * angle;
        let radius = angle * (1.0 + t * (k1 + t * (k2 + t * (k3 + t * k4))));
        (radius, 1.0 + t * (3.0 * k1 + t * (5.0 * k2 + t * (7.0 * k3 + t * 9.0 * k4))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::Lens;

    #[test]
    fn a_lens_that_opencv_measured_comes_back() {
        // OpenCV's own fisheye test, modules/calib3d/test/test_fisheye.cpp: D.
        let k = [-0.001_443_158_604_254_17, -0.003_206_632_575_51, 0.004_266_118_817_27, -0.001_640_443_139_6];
        let lens = KannalaBrandt::from_opencv(k).expect("a lens");
        let theta = 1.0f64;
        let theirs = theta + k[0] * theta.powi(3) + k[1] * theta.powi(5) + k[2] * theta.powi(7) + k[3] * theta.powi(9);
        let radius = lens.radius(theta).expect("seen");
        assert!((radius - theirs).abs() < 1e-15);
        assert!((lens.angle(radius).0 - theta).abs() < 1e-14);
    }

    #[test]
    fn it_ends_where_the_radius_turns_back() {
        // r = θ − θ³/3 turns back at 1 radian.
        let lens = KannalaBrandt::from_opencv([-1.0 / 3.0, 0.0, 0.0, 0.0]).expect("a lens");
        assert!((lens.reach() - 1.0).abs() < 1e-12);
        assert!(lens.radius(1.01).is_none() && lens.angle(0.67).0.is_nan());
    }
}
