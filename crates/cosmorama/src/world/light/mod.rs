mod pictures;

pub use pictures::PictureError;

use rayon::prelude::*;
use thiserror::Error;

use super::World;
use crate::camera::PixelPoint;
use crate::raster::{Image, Rgba};
use crate::sphere::Direction;

/// Reason why light does not belong to a world.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LightError {
    /// The number of texels differs from the world's.
    #[error("the views have {expected} texels, but light is given for {found}")]
    WrongLength {
        /// Texels of the world.
        expected: usize,
        /// Texels that were given.
        found: usize,
    },
    /// The pictures' sizes differ from the views'.
    #[error("the light is not that of these views: they have other sizes")]
    WrongViews,
}

/// The light of a world: a texel for each texel of each of its views.
///
/// A world is geometry, and can be filled with any light: one light fits all worlds whose views have the same sizes, in
/// the same order. Texels are linear and premultiplied. A texel with a NaN becomes transparent, and infinite light
/// becomes the largest half float ([`Rgba::finite`]).
///
/// ```
/// use cosmorama::camera::{CameraModel, EquirectCamera};
/// use cosmorama::raster::Rgba;
/// use cosmorama::world::{Light, World};
///
/// let world = World::new([("sky".to_owned(), CameraModel::Equirect(EquirectCamera::default()).view(64, 32)?)])?;
/// let light = Light::by_direction(&world, |direction| {
///     let up = direction.vector().y as f32;
///     Rgba::opaque(0.5 + 0.5 * up, 0.5, 0.5)
/// });
/// assert_eq!(light.texels().len(), world.texel_count());
/// assert!(Light::new(&world, vec![Rgba::BLACK; 7]).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    texels: Vec<Rgba>,
    sizes: Vec<[usize; 2]>,
}

impl Light {
    /// Creates light from texels: view after view, each row by row.
    ///
    /// # Errors
    /// When the number of texels differs from the world's.
    pub fn new(world: &World, mut texels: Vec<Rgba>) -> Result<Self, LightError> {
        let (expected, found) = (world.texel_count(), texels.len());
        if expected != found {
            return Err(LightError::WrongLength { expected, found });
        }
        texels.par_iter_mut().with_min_len(1 << 14).for_each(|texel| {
            // Most are finite: those are not written.
            if !texel.0.iter().all(|channel| channel.is_finite()) {
                *texel = texel.finite();
            }
        });
        Ok(Self { texels, sizes: world.view_sizes().collect() })
    }

    /// Creates light from one picture for each view.
    ///
    /// # Errors
    /// When the number of pictures differs from the views', or a picture's size from its view's.
    pub fn of_pictures(world: &World, pictures: impl IntoIterator<Item = Image<Rgba>>) -> Result<Self, LightError> {
        let (mut texels, mut sizes) = (Vec::with_capacity(world.texel_count()), Vec::new());
        for picture in pictures {
            sizes.push([picture.width(), picture.height()]);
            texels.extend(picture.into_pixels());
        }
        if world.view_sizes().ne(sizes) {
            return Err(LightError::WrongViews);
        }
        Self::new(world, texels)
    }

    /// Creates light by a formula, from the direction of each texel's centre. Texels without a direction are
    /// transparent.
    pub fn by_direction(world: &World, light: impl Fn(Direction) -> Rgba + Sync) -> Self {
        let mut texels = vec![Rgba::TRANSPARENT; world.texel_count()];
        for source in world.sources() {
            let rows = texels[source.texels()].par_chunks_mut(source.view.width()).enumerate();
            rows.for_each(|(j, row)| {
                for (i, texel) in row.iter_mut().enumerate() {
                    let direction = source.view.direction(PixelPoint::centre(i, j));
                    *texel = direction.map_or(Rgba::TRANSPARENT, |direction| light(direction).finite());
                }
            });
        }
        Self { texels, sizes: world.view_sizes().collect() }
    }

    /// Returns all texels: view after view, each row by row.
    pub fn texels(&self) -> &[Rgba] {
        &self.texels
    }

    /// Returns all texels by value.
    pub fn into_texels(self) -> Vec<Rgba> {
        self.texels
    }

    /// Checks that this is light of a world's views.
    ///
    /// # Errors
    /// When the sizes differ.
    pub fn check(&self, world: &World) -> Result<(), LightError> {
        if self.sizes.iter().copied().eq(world.view_sizes()) { Ok(()) } else { Err(LightError::WrongViews) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::panorama;

    fn world(width: usize) -> World {
        World::new([("all".to_owned(), panorama(width, 8))]).expect("a view")
    }

    #[test]
    fn wrong_lengths_are_refused() {
        let (small, large) = (world(16), world(32));
        let light = Light::new(&small, vec![Rgba::BLACK; 128]).expect("as many as there are");
        assert_eq!(light.check(&small), Ok(()));
        assert_eq!(light.check(&large), Err(LightError::WrongViews));
        let found = Light::new(&large, vec![Rgba::BLACK; 128]);
        assert_eq!(found, Err(LightError::WrongLength { expected: 256, found: 128 }));
        let picture = |width| Image::filled(width, 8, Rgba::BLACK);
        assert_eq!(Light::of_pictures(&small, [picture(16)]), Ok(light));
        assert_eq!(Light::of_pictures(&small, [picture(8), picture(8)]), Err(LightError::WrongViews));
        assert_eq!(Light::of_pictures(&small, []), Err(LightError::WrongViews));
    }

    #[test]
    fn what_is_no_number_is_missing() {
        let mut texels = vec![Rgba::BLACK; 128];
        texels[5] = Rgba([1.0, f32::NAN, 0.0, 1.0]);
        texels[6] = Rgba([f32::INFINITY, 0.0, 0.0, 1.0]);
        let light = Light::new(&world(16), texels).expect("as many as there are");
        assert_eq!(light.texels()[5], Rgba::TRANSPARENT);
        assert_eq!(light.texels()[6], Rgba([65504.0, 0.0, 0.0, 1.0]));
        let light = Light::by_direction(&world(16), |_| Rgba([f32::NAN; 4]));
        assert!(light.into_texels().iter().all(|texel| *texel == Rgba::TRANSPARENT));
    }
}
