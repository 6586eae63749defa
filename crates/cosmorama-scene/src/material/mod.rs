//! Surfaces, and what they do with light.

mod chrome;
mod finish;
mod glass;
mod picture;

use std::sync::Arc;

use thiserror::Error;

pub use chrome::{Chrome, Highlight, HighlightError};
pub use finish::{Finish, NormalMap, Paint};
pub use glass::{Glass, Refraction};
pub use picture::{PictureKind, PictureReader, PictureSource};

/// Treatment of light by a surface: dc·D + sc·S (Greene 1986, section 5).
///
/// D is the light that falls on a matt surface, S what is reflected about the mirror direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Part of the light that is scattered equally in all directions: dc.
    pub diffuse: f64,
    /// Part of the light that is reflected about the mirror direction: sc.
    pub specular: f64,
    /// GGX roughness α of the reflection; 0 is a mirror. That of a finish is its own.
    pub alpha: f64,
    /// Table of colours by elevation that it reflects, and not the world (Greene 1986, section 8).
    pub chrome: Option<Chrome>,
    /// Glass, which shows the world behind it, too: S is then what it reflects and refracts.
    pub glass: Option<Glass>,
    /// Metallic-roughness: D and S are then times its factors.
    pub finish: Option<Arc<Finish>>,
}

/// Indices of real things, from bubbles in water to gallium phosphide, and some more.
const INDICES: std::ops::RangeInclusive<f64> = 0.25..=4.0;

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
    /// A number of metallic-roughness is out of range.
    #[error("{0} is outside 0 to 1, the range of metallic, roughness and specular")]
    Part(f64),
    /// The factor on a normal map is no number.
    #[error("a factor of {0} on normals is not one: expected a number")]
    NormalScale(f64),
    /// A colour is negative or not a number.
    #[error("{0:?} is no colour: expected numbers from 0")]
    Colour([f64; 3]),
    /// A table of chrome goes by azimuth.
    #[error("chrome reflects colours by elevation, but the table is by azimuth")]
    NotByElevation,
}

impl Material {
    /// A Lambertian reflector.
    pub const MATTE: Self = Self::plain(1.0, 0.0);

    /// A perfect mirror.
    pub const MIRROR: Self = Self::plain(0.0, 1.0);

    /// Half a Lambertian reflector, half a mirror: the middle sphere of Greene's Plate 4.
    pub const MIXED: Self = Self::plain(0.5, 0.5);

    /// Clear glass of index 1.5.
    pub const GLASS: Self =
        Self { diffuse: 0.0, specular: 1.0, alpha: 0.0, chrome: None, glass: Some(Glass::new(1.5)), finish: None };

    const fn plain(diffuse: f64, specular: f64) -> Self {
        Self { diffuse, specular, alpha: 0.0, chrome: None, glass: None, finish: None }
    }

    /// Returns cheap chrome of a table.
    pub fn chrome(table: Chrome) -> Self {
        Self { chrome: Some(table), ..Self::MIRROR }
    }

    /// Returns metallic-roughness.
    pub fn of(finish: Finish) -> Self {
        Self { finish: Some(Arc::new(finish)), ..Self::plain(1.0, 1.0) }
    }

    /// Returns the material with another roughness α.
    #[must_use]
    pub fn with_alpha(&self, alpha: f64) -> Self {
        let finish =
            self.finish.as_ref().map(|finish| Arc::new(Finish { roughness: alpha.sqrt(), ..(**finish).clone() }));
        Self { alpha, finish, ..self.clone() }
    }

    /// Returns the metallic-roughness that a picture can colour: that of the material, or one that scatters as it does.
    /// `None` if it reflects otherwise.
    pub fn paintable(&self) -> Option<Finish> {
        match &self.finish {
            Some(finish) => Some((**finish).clone()),
            None => (self.specular == 0.0).then(|| Finish::matt(Paint::plain([1.0; 3]))),
        }
    }

    /// Returns whether it has a picture.
    pub(crate) fn has_pictures(&self) -> bool {
        self.finish.as_ref().is_some_and(|finish| finish.has_pictures())
    }

    /// Returns whether some light is scattered.
    pub(crate) fn is_matt(&self) -> bool {
        self.diffuse > 0.0 && self.finish.as_ref().is_none_or(|finish| finish.is_matt())
    }

    /// Returns whether some light is reflected or refracted.
    pub(crate) fn reflects(&self) -> bool {
        self.specular > 0.0 && self.finish.as_ref().is_none_or(|finish| finish.reflects())
    }

    /// Returns the least and the greatest α of what it reflects of the world; `None` if it reflects nothing of it.
    pub(crate) fn alphas(&self) -> Option<[f64; 2]> {
        let alphas = || self.finish.as_ref().map_or([self.alpha; 2], |finish| finish.alphas());
        (self.reflects() && self.chrome.is_none()).then(alphas)
    }

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
        self.finish.as_ref().map_or(Ok(()), |finish| finish.check())?;
        self.glass.map_or(Ok(()), |glass| glass.check())
    }
}

impl Default for Material {
    fn default() -> Self {
        Self::MIRROR
    }
}
