use std::f64::consts::PI;

use thiserror::Error;

use super::basis::{HarmonicBasis, HarmonicFunctions};
use super::sum::HarmonicSums;
use super::window::HarmonicWindow;
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Light, LightError, World};

/// Highest order of harmonics.
pub const HIGHEST_ORDER: usize = 10;

/// Coefficients of light, red, green and blue, for each real orthonormal spherical harmonic up to an order.
///
/// The coefficient of band l and number m stands at l² + l + m. [`HarmonicFunctions`] are the functions.
///
/// ```
/// use cosmorama::lighting::{HarmonicBasis, Harmonics};
/// use cosmorama::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let grey = Image::filled(64, 32, Rgba::opaque(0.5, 0.5, 0.5));
/// let (world, light) = World::from_panorama(grey)?;
/// let radiance = Harmonics::new(&world, &light, 2, HarmonicBasis::ZUp)?;
/// let [red, ..] = radiance.irradiance().at(Direction::FRONT);
/// assert!((red - 0.5 * std::f64::consts::PI).abs() < 1e-2);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    order: usize,
    basis: HarmonicBasis,
    coefficients: Vec<[f64; 3]>,
}

/// Reason why a world's light has no such harmonics.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum HarmonicsError {
    /// The order is too high.
    #[error("an order of {0} is outside 0 to {HIGHEST_ORDER}")]
    Order(usize),
    /// The light is not that of the world.
    #[error(transparent)]
    Light(#[from] LightError),
}

impl Harmonics {
    /// Sums the radiance of a world, texel by texel. What the world does not show is dark.
    ///
    /// # Errors
    /// When the order is above [`HIGHEST_ORDER`], or the light is not that of the world.
    pub fn new(world: &World, light: &Light, order: usize, basis: HarmonicBasis) -> Result<Self, HarmonicsError> {
        light.check(world)?;
        Self::of_texels(world, (light.texels(), Rgba::TRANSPARENT), order, basis)
    }

    /// Sums the radiance of texels. The second colour is the light of what the world does not show.
    ///
    /// # Errors
    /// When the order is above [`HIGHEST_ORDER`].
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of_texels(
        world: &World,
        (texels, unseen): (&[Rgba], Rgba),
        order: usize,
        basis: HarmonicBasis,
    ) -> Result<Self, HarmonicsError> {
        if order > HIGHEST_ORDER {
            return Err(HarmonicsError::Order(order));
        }
        let functions = HarmonicFunctions::new(order, basis);
        let coefficients = HarmonicSums::of(world, texels, &functions).over(unseen);
        Ok(Self { order, basis, coefficients })
    }

    /// Returns the highest band.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Returns the basis.
    pub fn basis(&self) -> HarmonicBasis {
        self.basis
    }

    /// Returns red, green and blue of each function, at l² + l + m.
    pub fn coefficients(&self) -> &[[f64; 3]] {
        &self.coefficients
    }

    /// Evaluates the sum of all functions in a direction.
    pub fn at(&self, direction: Direction) -> [f64; 3] {
        self.sum(&self.functions(), direction)
    }

    /// Prepares its functions.
    pub(super) fn functions(&self) -> HarmonicFunctions {
        HarmonicFunctions::new(self.order, self.basis)
    }

    /// Evaluates the sum of its functions in a direction.
    pub(super) fn sum(&self, functions: &HarmonicFunctions, direction: Direction) -> [f64; 3] {
        let values = functions.at(direction);
        let mut sum = [0.0; 3];
        for (value, coefficient) in values.iter().zip(&self.coefficients) {
            sum.iter_mut().zip(coefficient).for_each(|(sum, part)| *sum += value * part);
        }
        sum
    }

    /// Returns the irradiance E of this radiance, by the direction that a surface faces. A constant world of 1 gives π.
    ///
    /// Lambert's cosine multiplies each band by its own factor (R. Ramamoorthi and P. Hanrahan, *An Efficient Representation for
    /// Irradiance Environment Maps*, SIGGRAPH 2001, equations 7 to 9).
    #[must_use]
    pub fn irradiance(&self) -> Self {
        self.by_band(cosine_factor)
    }

    /// Returns the harmonics with higher bands weakened, against ringing.
    #[must_use]
    pub fn windowed(&self, window: HarmonicWindow) -> Self {
        self.by_band(|band| window.factor(band))
    }

    fn by_band(&self, factor: impl Fn(usize) -> f64) -> Self {
        let of_band = |band: usize| std::iter::repeat_n(factor(band), 2 * band + 1);
        let factors = (0..=self.order).flat_map(of_band);
        let scaled = |(light, factor): (&[f64; 3], f64)| light.map(|light| light * factor);
        Self { coefficients: self.coefficients.iter().zip(factors).map(scaled).collect(), ..self.clone() }
    }
}

/// Returns Lambert's factor of a band, Â of Ramamoorthi & Hanrahan 2001, equations 7 to 9: π, 2π/3, π/4, 0, −π/24, 0, π/64, …
fn cosine_factor(band: usize) -> f64 {
    if band == 1 {
        return 2.0 * PI / 3.0;
    }
    if band % 2 == 1 {
        return 0.0;
    }
    let l = band as f64;
    // l! / (2^l ((l/2)!)²) is the product of (2k − 1)/(2k) for k up to l/2.
    let middle: f64 = (1..=band / 2).map(|k| (2 * k - 1) as f64 / (2 * k) as f64).product();
    let sign = if (band / 2).is_multiple_of(2) { -1.0 } else { 1.0 };
    2.0 * PI * sign / ((l + 2.0) * (l - 1.0)) * middle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cosine_has_the_factors_of_the_paper() {
        let expected = [PI, 2.0 * PI / 3.0, PI / 4.0, 0.0, -PI / 24.0, 0.0, PI / 64.0, 0.0, -PI / 128.0];
        for (band, expected) in expected.into_iter().enumerate() {
            assert!((cosine_factor(band) - expected).abs() < 1e-14, "{band}: {}", cosine_factor(band));
        }
    }
}
