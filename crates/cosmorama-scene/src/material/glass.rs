use super::MaterialError;

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

    pub(super) fn check(&self) -> Result<(), MaterialError> {
        if let Some(wrong) = self.index.into_iter().find(|index| !super::INDICES.contains(index)) {
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
