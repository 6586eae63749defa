use rayon::prelude::*;
use thiserror::Error;

use super::albedo::Albedo;
use super::charlie::CharlieQuadrature;
use super::ggx::GgxQuadrature;
use crate::raster::{Image, Rgba};

/// Largest edge of a table.
pub const LARGEST_BRDF_TABLE: usize = 4096;

/// Reflectance of a surface that a table is of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BrdfModel {
    /// Microfacets: GGX with Smith's height-correlated shadowing.
    #[default]
    Ggx,
    /// Cloth: Charlie, with the visibility of Neubelt and Pettineo.
    Charlie,
}

/// Numbers that the red and green of a table hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BrdfChannels {
    /// Scale and bias: red times F0, plus green.
    #[default]
    ScaleBias,
    /// Bias and total, as Filament has them: from red to green by F0; times 1 + F0 (1/green − 1), what facets reflect more often is
    /// there, too (E. Turquin, *Practical multiple scattering compensation for microfacet models*, 2019).
    Multiscatter,
}

/// Reason why there is no such table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BrdfError {
    /// The edge is zero or too large.
    #[error("a table of {0} cells is outside 1 to {LARGEST_BRDF_TABLE}")]
    Size(usize),
    /// Cloth has no Fresnel factor to be split by.
    #[error("cloth has one number a cell, and none for facets that reflect more often")]
    Cloth,
}

impl BrdfModel {
    /// Computes the albedo for a cosine n·v of the angle of view, 0 to 1, and a roughness α, 0 to 1; neither is 0.
    ///
    /// ```
    /// use cosmorama::lighting::BrdfModel;
    ///
    /// let albedo = BrdfModel::Ggx.albedo(0.8, 0.01);
    /// assert!((albedo.total() - 1.0).abs() < 1e-3);
    /// assert!((albedo.bias - 0.2f64.powi(5)).abs() < 1e-3);
    /// ```
    pub fn albedo(self, n_dot_v: f64, alpha: f64) -> Albedo {
        self.quadrature().albedo(n_dot_v, alpha)
    }

    /// Computes a table: column i is of n·v = (i + ½)/N, row j of the perceptual roughness √α = (j + ½)/N, smooth on top. Cloth has its
    /// albedo in red; blue is 0.
    ///
    /// # Errors
    /// When the size is 0 or above [`LARGEST_BRDF_TABLE`], or cloth is asked for more than one number.
    pub fn table(self, size: usize, channels: BrdfChannels) -> Result<Image<Rgba>, BrdfError> {
        if size == 0 || size > LARGEST_BRDF_TABLE {
            return Err(BrdfError::Size(size));
        }
        if self == Self::Charlie && channels == BrdfChannels::Multiscatter {
            return Err(BrdfError::Cloth);
        }
        let quadrature = self.quadrature();
        let centre = |k: usize| (k as f64 + 0.5) / size as f64;
        let mut image = Image::filled(size, size, Rgba::opaque(0.0, 0.0, 0.0));
        image.pixels_mut().par_chunks_mut(size).enumerate().for_each(|(j, row)| {
            for (i, pixel) in row.iter_mut().enumerate() {
                let albedo = quadrature.albedo(centre(i), centre(j) * centre(j));
                let [red, green] = match channels {
                    BrdfChannels::ScaleBias => [albedo.scale, albedo.bias],
                    BrdfChannels::Multiscatter => [albedo.bias, albedo.total()],
                };
                *pixel = Rgba::opaque(red as f32, green as f32, 0.0);
            }
        });
        Ok(image)
    }

    /// Prepares the quadrature. So many nodes leave less than 10⁻⁵ of error in tables up to the largest.
    fn quadrature(self) -> Quadrature {
        match self {
            Self::Ggx => Quadrature::Ggx(GgxQuadrature::new(24, 40)),
            Self::Charlie => Quadrature::Charlie(CharlieQuadrature::new(32, 56)),
        }
    }
}

enum Quadrature {
    Ggx(GgxQuadrature),
    Charlie(CharlieQuadrature),
}

impl Quadrature {
    fn albedo(&self, n_dot_v: f64, alpha: f64) -> Albedo {
        match self {
            Self::Ggx(quadrature) => quadrature.albedo(n_dot_v, alpha),
            Self::Charlie(quadrature) => Albedo { scale: quadrature.albedo(n_dot_v, alpha), bias: 0.0 },
        }
    }
}
