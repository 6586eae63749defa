use std::f64::consts::{FRAC_1_PI, PI};

use super::basis::{HarmonicBasis, HarmonicFunctions};
use super::coefficients::Harmonics;
use super::preset::{HarmonicKind, HarmonicPreset, PresetError};
use crate::sphere::Direction;

/// Coefficients as they are written down, with what takes them back to light.
///
/// ```
/// use cosmorama::lighting::{HarmonicBasis, HarmonicKind, HarmonicPreset, Harmonics, StoredHarmonics};
/// use cosmorama::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.5, 0.5, 0.5)))?;
/// let preset = HarmonicPreset::Unity;
/// let radiance = Harmonics::new(&world, &light, 2, preset.basis())?;
/// let stored = StoredHarmonics::of(preset, &radiance, HarmonicKind::Irradiance)?;
/// assert!((stored.numbers()[0][0] - 0.5).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StoredHarmonics {
    order: usize,
    basis: HarmonicBasis,
    sum: &'static str,
    numbers: Vec<[f64; 3]>,
    weights: Vec<f64>,
}

impl StoredHarmonics {
    /// Takes coefficients as they are: those of the radiance, or of E.
    pub fn plain(radiance: &Harmonics, kind: HarmonicKind) -> Self {
        Self::scaled(radiance, kind, (|_| 1.0, 1.0))
    }

    /// Brings coefficients to the form of a program. Functions times their weights then sum to what the program takes light for:
    /// E/π, or radiance.
    ///
    /// # Errors
    /// When the program has no form for this quantity and order.
    ///
    /// # Panics
    /// When the harmonics are not in the program's basis.
    pub fn of(preset: HarmonicPreset, radiance: &Harmonics, kind: HarmonicKind) -> Result<Self, PresetError> {
        assert_eq!(radiance.basis(), preset.basis(), "harmonics in the axes of the program");
        preset.check(kind, radiance.order())?;
        let over_pi = match (preset, kind) {
            (HarmonicPreset::Filament | HarmonicPreset::Unity, HarmonicKind::Irradiance) => FRAC_1_PI,
            _ => 1.0,
        };
        let stored = Self::scaled(radiance, kind, (|function| preset.factor(kind, function), over_pi));
        Ok(if preset == HarmonicPreset::Godot { stored.lit() } else { stored })
    }

    /// Multiplies coefficients, and lets the functions sum to a part of the light.
    fn scaled(radiance: &Harmonics, kind: HarmonicKind, (factor, part): (impl Fn(usize) -> f64, f64)) -> Self {
        let harmonics = match kind {
            HarmonicKind::Radiance => radiance.clone(),
            HarmonicKind::Irradiance => radiance.irradiance(),
        };
        let coefficients = harmonics.coefficients().iter().enumerate();
        let numbers = coefficients.map(|(k, light)| light.map(|light| light * factor(k))).collect::<Vec<_>>();
        let weights = (0..numbers.len()).map(|k| part / factor(k)).collect();
        let sum = match kind {
            HarmonicKind::Radiance => "radiance",
            HarmonicKind::Irradiance if part == 1.0 => "irradiance E",
            HarmonicKind::Irradiance => "irradiance over π",
        };
        Self { order: radiance.order(), basis: radiance.basis(), sum, numbers, weights }
    }

    /// Lets functions of radiance over π sum to E/π: Lambert's cosine multiplies each band.
    fn lit(self) -> Self {
        let lambert = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let weights = (0..self.weights.len()).map(|k| lambert[k.isqrt()]).collect();
        Self { sum: "irradiance over π", weights, ..self }
    }

    /// Returns the highest band.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Returns the axes.
    pub fn basis(&self) -> HarmonicBasis {
        self.basis
    }

    /// Names the light to which the functions sum.
    pub fn sum(&self) -> &'static str {
        self.sum
    }

    /// Returns red, green and blue of each function, at l² + l + m.
    pub fn numbers(&self) -> &[[f64; 3]] {
        &self.numbers
    }

    /// Returns what each function is multiplied by when the numbers are taken back to light.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Takes the numbers back to light in a direction.
    pub fn at(&self, direction: Direction) -> [f64; 3] {
        let values = HarmonicFunctions::new(self.order, self.basis).at(direction);
        let mut sum = [0.0; 3];
        for ((value, weight), number) in values.iter().zip(&self.weights).zip(&self.numbers) {
            sum.iter_mut().zip(number).for_each(|(sum, number)| *sum += value * weight * number);
        }
        sum
    }
}
