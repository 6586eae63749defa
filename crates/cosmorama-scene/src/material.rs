use thiserror::Error;

/// Treatment of light by a surface: dc·D + sc·S (Greene 1986, section 5), or glass.
///
/// D is the light that falls on a matt surface, S what is reflected about the mirror direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Part of the light that is scattered equally in all directions: dc.
    pub diffuse: f64,
    /// Part of the light that is reflected about the mirror direction: sc.
    pub specular: f64,
    /// GGX roughness α of the reflection; 0 is a mirror.
    pub alpha: f64,
    /// Whether it reflects a table of colours by elevation, and not the world (Greene 1986, section 8).
    pub chrome: bool,
    /// Glass, which shows the world behind it, too: S is then what it reflects and refracts.
    pub glass: Option<Glass>,
}

/// Inside of a solid that light passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Index of refraction of red, green and blue.
    pub index: [f64; 3],
    /// Part of red, green and blue light that is lost over a short way, for each unit of length (Beer).
    pub absorption: [f64; 3],
    /// Way of light inside.
    pub refraction: Refraction,
    /// Surfaces that light is followed through, the first and the last among them.
    pub surfaces: usize,
    /// Part of a pixel's light below which it is not split further.
    pub least: f64,
}

/// Way of light inside glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refraction {
    /// From surface to surface, split at each into a reflected and a refracted part.
    Traced,
    /// Bent once, where it enters: an impression of refraction, not its picture (Greene 1986, section 1).
    Bent,
}

impl Glass {
    /// Most surfaces that light is followed through.
    pub const MOST_SURFACES: usize = 64;

    /// Returns clear glass of one index for all colours.
    pub const fn new(index: f64) -> Self {
        Self { index: [index; 3], absorption: [0.0; 3], refraction: Refraction::Traced, surfaces: 4, least: 1e-4 }
    }

    fn check(&self) -> Result<(), MaterialError> {
        /// Indices of real things, from bubbles in water to gallium phosphide, and some more.
        const INDICES: std::ops::RangeInclusive<f64> = 0.25..=4.0;
        if let Some(wrong) = self.index.into_iter().find(|index| !INDICES.contains(index)) {
            return Err(MaterialError::Index(wrong));
        }
        if let Some(wrong) = self.absorption.into_iter().find(|part| !(part.is_finite() && *part >= 0.0)) {
            return Err(MaterialError::Absorption(wrong));
        }
        if (2..=Self::MOST_SURFACES).contains(&self.surfaces) {
            Ok(())
        } else {
            Err(MaterialError::Surfaces(self.surfaces))
        }
    }
}

/// Reason why there is no such material.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MaterialError {
    /// A coefficient is negative or not a number.
    #[error("a coefficient of {0} is not one: expected a number from 0")]
    Coefficient(f64),
    /// The roughness is out of range.
    #[error("a roughness α of {0} is outside 0 to 1")]
    Alpha(f64),
    /// The index of refraction is out of range.
    #[error("an index of refraction of {0} is outside 0.25 to 4")]
    Index(f64),
    /// The absorption is negative or not a number.
    #[error("an absorption of {0} is not one: expected a number from 0")]
    Absorption(f64),
    /// The number of surfaces is out of range.
    #[error("{0} surfaces of glass: expected 2 to {most}", most = Glass::MOST_SURFACES)]
    Surfaces(usize),
}

impl Material {
    /// A Lambertian reflector.
    pub const MATTE: Self = Self { diffuse: 1.0, specular: 0.0, alpha: 0.0, chrome: false, glass: None };

    /// A perfect mirror.
    pub const MIRROR: Self = Self { diffuse: 0.0, specular: 1.0, alpha: 0.0, chrome: false, glass: None };

    /// Half a Lambertian reflector, half a mirror: the middle sphere of Greene's Plate 4.
    pub const MIXED: Self = Self { diffuse: 0.5, specular: 0.5, alpha: 0.0, chrome: false, glass: None };

    /// Cheap chrome.
    pub const CHROME: Self = Self { chrome: true, ..Self::MIRROR };

    /// Clear glass of index 1.5.
    pub const GLASS: Self = Self { glass: Some(Glass::new(1.5)), ..Self::MIRROR };

    /// Checks that the numbers are in range.
    ///
    /// # Errors
    /// When one is not.
    pub fn check(&self) -> Result<(), MaterialError> {
        let is_coefficient = |number: &&f64| !(number.is_finite() && **number >= 0.0);
        if let Some(wrong) = [&self.diffuse, &self.specular].into_iter().find(is_coefficient) {
            return Err(MaterialError::Coefficient(*wrong));
        }
        if !(0.0..=1.0).contains(&self.alpha) {
            return Err(MaterialError::Alpha(self.alpha));
        }
        self.glass.map_or(Ok(()), |glass| glass.check())
    }
}

impl Default for Material {
    fn default() -> Self {
        Self::MIRROR
    }
}
