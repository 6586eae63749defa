//! Worlds made from pictures, with their light: the start of most programs.

use thiserror::Error;

use super::{Light, LightError};
use crate::camera::{CameraError, CameraModel, EquirectCamera, LayoutFaceCamera, Placement, SamplePositions, View};
use crate::raster::{Image, Rgba};
use crate::sphere::CubeFace;
use crate::world::{RimTexels, World, WorldError};

/// Reason why pictures do not make a world.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PictureError {
    /// The camera model does not fit the picture's size.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The views do not make a world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A picture's size differs from its view's.
    #[error(transparent)]
    Light(#[from] LightError),
}

impl World {
    /// Makes a world of the six faces of a cube, in the order of [`CubeFace::ALL`], each upright as seen from inside.
    ///
    /// The pictures hold linear light, premultiplied by alpha. `samples` is the position of a face's outermost samples.
    ///
    /// ```
    /// use cosmorama::prelude::*;
    ///
    /// let faces = CubeFace::ALL.map(|_| Image::filled(32, 32, Rgba::opaque(0.2, 0.4, 0.8)));
    /// let (world, light) = World::from_cube(faces, SamplePositions::Centres)?;
    /// assert_eq!(light.texels().len(), world.texel_count());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When a face has no pixels, or more than a world can count.
    pub fn from_cube(faces: [Image<Rgba>; 6], samples: SamplePositions) -> Result<(Self, Light), PictureError> {
        let camera = CameraModel::from(LayoutFaceCamera { samples, ..LayoutFaceCamera::default() });
        let views = CubeFace::ALL.into_iter().zip(faces).map(|(face, picture)| {
            let placement = Placement { orientation: face.orientation(), ..Placement::new(camera.clone()) };
            let view = placement.view(picture.width(), picture.height())?;
            Ok((face.name().to_owned(), view, picture))
        });
        Self::from_pictures(views.collect::<Result<Vec<_>, CameraError>>()?)
    }

    /// Makes a world of one equirectangular panorama of the whole sphere, whose pixels tile it.
    ///
    /// ```
    /// use cosmorama::prelude::*;
    ///
    /// let (world, _) = World::from_panorama(Image::filled(64, 32, Rgba::BLACK))?;
    /// assert_eq!(world.sources().len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the picture has no pixels, or more than a world can count.
    pub fn from_panorama(picture: Image<Rgba>) -> Result<(Self, Light), PictureError> {
        Self::from_lens(CameraModel::from(EquirectCamera::default()), picture)
    }

    /// Makes a world of one picture by any camera: a fisheye, a perspective view, a mirror ball, a map. It need not
    /// cover the sphere.
    ///
    /// ```
    /// use cosmorama::prelude::*;
    ///
    /// let fisheye = CameraModel::from(FisheyeCamera::default());
    /// let (world, _) = World::from_lens(fisheye, Image::filled(64, 64, Rgba::opaque(0.5, 0.5, 0.5)))?;
    /// assert!(world.owner(Direction::FRONT).is_some());
    /// assert!(world.owner(Direction::BACK).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the camera's parameters are out of range or do not suit the picture's size.
    pub fn from_lens(camera: impl Into<Placement>, picture: Image<Rgba>) -> Result<(Self, Light), PictureError> {
        let view = camera.into().view(picture.width(), picture.height())?;
        Self::from_pictures([("picture".to_owned(), view, picture)])
    }

    /// Makes a world of named views with their pictures, in linear light, premultiplied by alpha.
    ///
    /// Texels that a view's own rim cuts are restored from their neighbours ([`RimTexels`]).
    ///
    /// # Errors
    /// When there is no view, or a picture's size differs from its view's.
    pub fn from_pictures(
        pictures: impl IntoIterator<Item = (String, View, Image<Rgba>)>,
    ) -> Result<(Self, Light), PictureError> {
        let (mut views, mut images) = (Vec::new(), Vec::new());
        for (name, view, mut picture) in pictures {
            if (picture.width(), picture.height()) == (view.width(), view.height()) {
                RimTexels::of(&view).restore(picture.pixels_mut(), |texel| texel, |light| light);
            }
            views.push((name, view));
            images.push(picture);
        }
        let world = Self::new(views)?;
        let light = Light::of_pictures(&world, images)?;
        Ok((world, light))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::{Angle, Orientation};

    #[test]
    fn faces_look_where_they_belong() {
        let faces = CubeFace::ALL.map(|face| Image::filled(8, 8, Rgba::opaque(face as u8 as f32, 0.0, 0.0)));
        let (world, light) = World::from_cube(faces, SamplePositions::Centres).expect("six faces");
        for face in CubeFace::ALL {
            let (owner, pixel) =
                world.owner(face.orientation().to_world(crate::sphere::Direction::FRONT)).expect("a whole cube");
            let source = &world.sources()[owner];
            let texel = source.offset + pixel.y as usize * 8 + pixel.x as usize;
            assert_eq!(light.texels()[texel].0[0], face as u8 as f32, "{}", face.name());
        }
    }

    #[test]
    fn a_turned_lens_looks_elsewhere() {
        let up = Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::from_degrees(90.0), Angle::ZERO);
        let lens = CameraModel::from(crate::camera::FisheyeCamera::default());
        let placement = Placement { orientation: up, ..Placement::new(lens) };
        let (world, _) = World::from_lens(placement, Image::filled(16, 16, Rgba::BLACK)).expect("a lens");
        assert!(world.owner(crate::sphere::Direction::UP).is_some());
        assert!(world.owner(crate::sphere::Direction::DOWN).is_none());
    }

    #[test]
    fn pictures_of_another_size_are_refused() {
        let view = CameraModel::from(EquirectCamera::default()).view(8, 4).expect("a panorama");
        let picture = Image::filled(9, 4, Rgba::BLACK);
        let found = World::from_pictures([("sky".to_owned(), view, picture)]);
        assert!(matches!(found, Err(PictureError::Light(LightError::WrongViews))));
        assert!(World::from_panorama(Image::filled(0, 0, Rgba::BLACK)).is_err());
    }
}
