use super::{
    DoubleSphere, Equidistant, Equisolid, FieldOfViewLens, Hugin, HuginIdeal, KannalaBrandt, Lens, Ocam, Orthographic,
    Polynomial, Stereographic, Unified,
};

/// Every fisheye lens, chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FisheyeLens {
    /// r = φ.
    Equidistant(Equidistant),
    /// r = 2 sin(φ/2).
    Equisolid(Equisolid),
    /// r = 2 tan(φ/2).
    Stereographic(Stereographic),
    /// r = sin φ.
    Orthographic(Orthographic),
    /// Blender's polynomial, in millimetres.
    Polynomial(Polynomial),
    /// OpenCV's fisheye.
    KannalaBrandt(KannalaBrandt),
    /// OCamCalib's polynomial, in pixels.
    Ocam(Ocam),
    /// The unified camera model and its extension.
    Unified(Unified),
    /// The double sphere model.
    DoubleSphere(DoubleSphere),
    /// The field-of-view model.
    FieldOfView(FieldOfViewLens),
    /// An ideal lens with Hugin's correction.
    Hugin(Hugin),
}

/// Calls a method of the lens that is inside.
macro_rules! each {
    ($kind:expr, $lens:ident => $call:expr) => {
        match $kind {
            FisheyeLens::Equidistant($lens) => $call,
            FisheyeLens::Equisolid($lens) => $call,
            FisheyeLens::Stereographic($lens) => $call,
            FisheyeLens::Orthographic($lens) => $call,
            FisheyeLens::Polynomial($lens) => $call,
            FisheyeLens::KannalaBrandt($lens) => $call,
            FisheyeLens::Ocam($lens) => $call,
            FisheyeLens::Unified($lens) => $call,
            FisheyeLens::DoubleSphere($lens) => $call,
            FisheyeLens::FieldOfView($lens) => $call,
            FisheyeLens::Hugin($lens) => $call,
        }
    };
}

impl FisheyeLens {
    /// r = φ.
    pub const EQUIDISTANT: Self = Self::Equidistant(Equidistant);
    /// r = 2 sin(φ/2).
    pub const EQUISOLID: Self = Self::Equisolid(Equisolid);
    /// r = 2 tan(φ/2).
    pub const STEREOGRAPHIC: Self = Self::Stereographic(Stereographic);
    /// r = sin φ.
    pub const ORTHOGRAPHIC: Self = Self::Orthographic(Orthographic);

    /// One of each, for tests and listings; the measured ones are lenses that somebody has.
    pub fn all() -> Vec<Self> {
        let measured = [
            Polynomial::from_blender([0.0, -1.2, 0.0, 0.1, -0.02]).map(Self::Polynomial),
            KannalaBrandt::from_opencv([-0.0014, -0.0032, 0.0043, -0.0016]).map(Self::KannalaBrandt),
            Ocam::from_coefficients([-0.7, 0.0, 0.35, -0.02, 0.03, 0.0, 0.0, 0.0]).map(Self::Ocam),
            Unified::from_parameters(0.55, 1.0).map(Self::Unified),
            Unified::from_parameters(0.6, 1.1).map(Self::Unified),
            DoubleSphere::from_parameters(-0.179, 0.591).map(Self::DoubleSphere),
            FieldOfViewLens::from_omega(0.95).map(Self::FieldOfView),
            Hugin::from_abc(HuginIdeal::Equidistant, [0.01, -0.03, 0.01], 1.2).map(Self::Hugin),
            Hugin::from_abc(HuginIdeal::Rectilinear, [0.0, -0.05, 0.0], 0.8).map(Self::Hugin),
        ];
        let ideal = [Self::EQUIDISTANT, Self::EQUISOLID, Self::STEREOGRAPHIC, Self::ORTHOGRAPHIC];
        ideal.into_iter().chain(measured.into_iter().flatten()).collect()
    }
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
