use super::{Equidistant, Equisolid, FisheyeLens, Lens, Orthographic, Stereographic};

impl FisheyeLens {
    /// The equidistant lens, r = φ.
    pub const EQUIDISTANT: Self = Self::Equidistant(Equidistant);
    /// The equisolid lens, r = 2 sin(φ/2).
    pub const EQUISOLID: Self = Self::Equisolid(Equisolid);
    /// The stereographic lens, r = 2 tan(φ/2).
    pub const STEREOGRAPHIC: Self = Self::Stereographic(Stereographic);
    /// The orthographic lens, r = sin φ.
    pub const ORTHOGRAPHIC: Self = Self::Orthographic(Orthographic);
}

impl Lens for FisheyeLens {
    fn angle(&self, radius: f64) -> (f64, f64) {
        each!(self, lens => lens.angle(radius))
    }

    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        each!(self, lens => lens.sin_cos(radius))
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        each!(self, lens => lens.radius(angle))
    }

    fn reach(&self) -> f64 {
        each!(self, lens => lens.reach())
    }

    fn has_steep_rim(&self) -> bool {
        each!(self, lens => lens.has_steep_rim())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_one_is_listed() {
        assert_eq!(FisheyeLens::all().len(), 13);
    }

    #[test]
    fn radii_and_angles_rise_together_up_to_the_rim() {
        for lens in FisheyeLens::all() {
            let mut last = -1.0;
            for step in 0..=1000 {
                let angle = lens.reach() * f64::from(step) / 1000.0;
                let Some(radius) = lens.radius(angle) else {
                    assert!(step == 1000, "{lens:?} has no image at {angle}");
                    continue;
                };
                assert!(radius > last, "{lens:?}: {radius} at {angle}");
                let (back, slope) = lens.angle(radius);
                let ((sin, cos), (expected_sin, expected_cos)) = (lens.sin_cos(radius), back.sin_cos());
                assert!(
                    (sin - expected_sin).hypot(cos - expected_cos) <= 1e-14 + 8.0 * f64::EPSILON * slope,
                    "{lens:?}: {radius}"
                );
                // At a steep rim the radius holds only half of the angle's digits.
                assert!((back - angle).abs() <= 1e-12 + 8.0 * f64::EPSILON * slope, "{lens:?}: {back}, not {angle}");
                last = radius;
            }
        }
    }
}
