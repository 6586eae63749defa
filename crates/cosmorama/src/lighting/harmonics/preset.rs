use std::f64::consts::{FRAC_1_PI, PI};

use thiserror::Error;

use super::basis::HarmonicBasis;

/// Quantity that harmonics are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HarmonicKind {
    /// The light itself: a constant world of 1 gives 1.
    Radiance,
    /// Light that falls on a matt surface, E: a constant world of 1 gives π.
    Irradiance,
}

/// Program that has a form of its own for nine coefficients: its axes, signs and constants.
///
/// All of them store the number of band l and m at l² + l + m. Each has the axes in which it shows a panorama.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HarmonicPreset {
    /// `IndirectLight::Builder`: `irradiance` takes E/π times the factors of the polynomials 1, y, z, x, xy, yz, 3z² − 1, xz, x² − y²,
    /// `radiance` the functions with the phase of Condon and Shortley (Filament, `libs/ibl/src/CubemapSH.cpp`,
    /// `computeIrradianceSH3Bands` and `TSH`; cmgen mirrors a panorama, which puts its middle at +z).
    Filament,
    /// `LightProbe`: radiance, without that phase (three.js, `src/math/SphericalHarmonics3.js`; `equirectUv` puts a panorama's middle
    /// at +x).
    Three,
    /// `SphericalHarmonicsL2`: E/π times the factors of the polynomials, as Filament has them (Unity, `SphericalHarmonics.cs` of the
    /// high definition render pipeline, `invNormConsts`; the shader Skybox/Panoramic puts a panorama's middle at +x).
    Unity,
    /// Probes of `LightmapGIData`: radiance over π, without that phase (Godot, `lm_compute.glsl`, `MODE_LIGHT_PROBES`; its sky puts a
    /// panorama's middle at +z).
    Godot,
}

/// Reason why a program has no form for such harmonics.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PresetError {
    /// It takes another quantity.
    #[error("{0:?} takes {1:?} only")]
    Kind(HarmonicPreset, HarmonicKind),
    /// It takes other orders.
    #[error("{0:?} takes harmonics of order {1}, not {2}")]
    Order(HarmonicPreset, &'static str, usize),
}

impl HarmonicPreset {
    /// All programs.
    pub const ALL: [Self; 4] = [Self::Filament, Self::Three, Self::Unity, Self::Godot];

    /// Returns the program's name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Filament => "filament",
            Self::Three => "three",
            Self::Unity => "unity",
            Self::Godot => "godot",
        }
    }

    /// Returns the axes in which it shows a panorama.
    pub fn basis(self) -> HarmonicBasis {
        match self {
            Self::Filament | Self::Godot => HarmonicBasis::FrontZ,
            Self::Three => HarmonicBasis::FrontX,
            Self::Unity => HarmonicBasis::FrontXLeftHanded,
        }
    }

    /// Returns the quantity that it takes, or takes first.
    pub fn kind(self) -> HarmonicKind {
        match self {
            Self::Filament | Self::Unity => HarmonicKind::Irradiance,
            Self::Three | Self::Godot => HarmonicKind::Radiance,
        }
    }

    /// Checks that it has a form for a quantity and an order.
    ///
    /// # Errors
    /// When it has none.
    pub fn check(self, kind: HarmonicKind, order: usize) -> Result<(), PresetError> {
        let takes_both = matches!(self, Self::Filament | Self::Three);
        if kind != self.kind() && !takes_both {
            return Err(PresetError::Kind(self, self.kind()));
        }
        match (self, order) {
            (_, 2) | (Self::Filament, 0 | 1) => Ok(()),
            (Self::Filament, _) => Err(PresetError::Order(self, "0, 1 or 2", order)),
            _ => Err(PresetError::Order(self, "2", order)),
        }
    }

    /// Returns what the program multiplies a coefficient of the radiance, or of E, by before it stores it.
    pub(super) fn factor(self, kind: HarmonicKind, function: usize) -> f64 {
        match (self, kind) {
            (Self::Filament | Self::Unity, HarmonicKind::Irradiance) => FRAC_1_PI * polynomial_factor(function),
            (Self::Filament, HarmonicKind::Radiance) => phase(function),
            (Self::Godot, _) => FRAC_1_PI,
            (Self::Three, _) | (Self::Unity, HarmonicKind::Radiance) => 1.0,
        }
    }
}

/// Returns the sign of Condon and Shortley: −1 for odd m.
fn phase(function: usize) -> f64 {
    // At l² + l + m, and l² + l is even.
    if function.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Returns the factors of 1, y, z, x, xy, yz, 3z² − 1, xz and x² − y² in the functions.
fn polynomial_factor(function: usize) -> f64 {
    let square = match function {
        0 => 1.0,
        1..=3 => 3.0,
        6 => 5.0 / 4.0,
        8 => 15.0 / 4.0,
        _ => 15.0,
    };
    (square / (4.0 * PI)).sqrt()
}
