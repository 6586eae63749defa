use std::sync::Arc;

use cosmorama::filter::{Texture, Wrap};
use cosmorama::raster::{Image, Rgba};
use glam::{DVec3, Vec3};

use super::MaterialError;

/// Metallic-roughness, the material of glTF 2.0: a mix of metal and of an insulator over a matt ground.
///
/// By its specification (appendix B), and with the split sum of Karis (*Real shading in Unreal Engine 4*, 2013), it is
/// kd·D + ks·S, with factors by colour and angle of view.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// Colour: what an insulator scatters, and what metal reflects straight on.
    pub base: Paint,
    /// Part of the surface that is metal, from 0 to 1.
    pub metallic: f64,
    /// Roughness from 0 to 1, the root of GGX's α.
    pub roughness: f64,
    /// Factors on the two by place: roughness in green, metallic in blue.
    pub metal_map: Option<Arc<Texture>>,
    /// Light that the surface sends out by itself.
    pub emissive: Paint,
    /// Dents and bumps.
    pub normal_map: Option<NormalMap>,
    /// Index of refraction of the insulator, 1.5 unless given (`KHR_materials_ior`).
    pub index: f64,
    /// Factor on what the insulator reflects; 0 leaves the matt ground alone (`KHR_materials_specular`).
    pub specular: f64,
}

/// A colour in linear light, alone or times a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    /// Red, green and blue.
    pub colour: [f64; 3],
    /// Colours by place.
    pub map: Option<Arc<Texture>>,
}

/// Directions of a surface's dents and bumps.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMap {
    /// Unit normals along the tangent, the bitangent and the surface's normal.
    map: Arc<Texture>,
    /// Factor on the first two.
    pub scale: f64,
}

impl Paint {
    /// Returns a colour without a picture.
    pub const fn plain(colour: [f64; 3]) -> Self {
        Self { colour, map: None }
    }

    /// Returns a picture, as it is.
    pub fn picture(map: Texture) -> Self {
        Self { colour: [1.0; 3], map: Some(Arc::new(map)) }
    }
}

impl NormalMap {
    /// Returns the map of a picture as glTF has it: each number, 0 to 1, is half of one more than a component, red along
    /// the tangent and green up.
    pub fn new(picture: &Image<Rgba>, wrap: [Wrap; 2], scale: f64) -> Self {
        let normal = |pixel: &Rgba| {
            let [x, y, z, _] = pixel.0.map(|part| 2.0 * part - 1.0);
            // Eight bits do not hold lengths of one; what is shorter would count as rough.
            let [x, y, z] = Vec3::new(x, y, z).normalize_or(Vec3::Z).to_array();
            Rgba::opaque(x, y, z)
        };
        let normals = Image::from_fn(picture.width(), picture.height(), |i, j| normal(picture.get(i, j)));
        Self { map: Arc::new(Texture::new(normals, wrap)), scale }
    }

    /// Returns the map of a picture of heights, or of normals if it is not grey: files of OBJ name both alike. A height of one
    /// over the width of a texel is a slope of `scale`.
    pub fn of_bumps(picture: &Image<Rgba>, wrap: [Wrap; 2], scale: f64) -> Self {
        let is_grey = |pixel: &Rgba| pixel.0[0] == pixel.0[1] && pixel.0[1] == pixel.0[2];
        if !picture.pixels().iter().all(is_grey) {
            return Self::new(picture, wrap, scale);
        }
        let height = |i: i64, j: i64| {
            let (column, row) = (wrap[0].texel(i, picture.width()), wrap[1].texel(j, picture.height()));
            picture.get(column, row).0[0]
        };
        let normal = |i: usize, j: usize| {
            let (i, j) = (i as i64, j as i64);
            let across = 0.5 * (height(i + 1, j) - height(i - 1, j));
            let upward = 0.5 * (height(i, j - 1) - height(i, j + 1));
            let [x, y, z] = Vec3::new(-across, -upward, 1.0).normalize().to_array();
            Rgba::opaque(x, y, z)
        };
        let normals = Image::from_fn(picture.width(), picture.height(), normal);
        Self { map: Arc::new(Texture::new(normals, wrap)), scale }
    }

    /// Returns the map with another factor.
    pub(crate) fn with_scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// Returns the normals.
    pub(crate) fn map(&self) -> &Texture {
        &self.map
    }
}

impl Default for Finish {
    /// Returns a white insulator, smooth as glass.
    fn default() -> Self {
        Self {
            base: Paint::plain([1.0; 3]),
            metallic: 0.0,
            roughness: 0.0,
            metal_map: None,
            emissive: Paint::plain([0.0; 3]),
            normal_map: None,
            index: 1.5,
            specular: 1.0,
        }
    }
}

impl Finish {
    /// Returns what scatters all light of a picture, and reflects nothing.
    pub fn matt(base: Paint) -> Self {
        Self { base, roughness: 1.0, specular: 0.0, ..Self::default() }
    }

    /// Returns whether it has a picture.
    pub(super) fn has_pictures(&self) -> bool {
        let maps = [&self.base.map, &self.metal_map, &self.emissive.map];
        self.normal_map.is_some() || maps.into_iter().any(Option::is_some)
    }

    /// Returns the light that the insulator reflects straight on.
    pub(crate) fn insulator(&self) -> f64 {
        let ratio = (self.index - 1.0) / (self.index + 1.0);
        ratio * ratio
    }

    /// Returns whether some of the light is scattered.
    pub(super) fn is_matt(&self) -> bool {
        self.metallic < 1.0 || self.metal_map.is_some()
    }

    /// Returns whether some of the light is reflected.
    pub(super) fn reflects(&self) -> bool {
        self.metallic > 0.0 || self.specular > 0.0
    }

    /// Returns the least and the greatest α anywhere.
    pub(super) fn alphas(&self) -> [f64; 2] {
        let of = |part: f32| (self.roughness * f64::from(part.clamp(0.0, 1.0))).powi(2);
        let whole = self.roughness.powi(2);
        let [least, greatest] = self.metal_map.as_ref().map_or([whole; 2], |map| {
            let parts = map.picture().pixels().iter().map(|texel| texel.0[1]);
            let (least, greatest) = parts.fold((f32::INFINITY, 0.0), |(a, b): (f32, f32), c| (a.min(c), b.max(c)));
            [of(least), of(greatest)]
        });
        // Dents that a pixel does not show make it rough.
        [least, if self.normal_map.is_some() { 1.0 } else { greatest }]
    }

    pub(super) fn check(&self) -> Result<(), MaterialError> {
        if let Some(wrong) =
            [self.metallic, self.roughness, self.specular].into_iter().find(|part| !(0.0..=1.0).contains(part))
        {
            return Err(MaterialError::Part(wrong));
        }
        let colours = [self.base.colour, self.emissive.colour].map(DVec3::from_array);
        if let Some(wrong) = colours.into_iter().find(|colour| !colour.is_finite() || colour.min_element() < 0.0) {
            return Err(MaterialError::Colour(wrong.to_array()));
        }
        if let Some(map) = self.normal_map.as_ref().filter(|map| !map.scale.is_finite()) {
            return Err(MaterialError::NormalScale(map.scale));
        }
        if super::INDICES.contains(&self.index) { Ok(()) } else { Err(MaterialError::Index(self.index)) }
    }
}
