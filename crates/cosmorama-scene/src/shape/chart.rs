use cosmorama::filter::{Texture, TextureFootprint};
use cosmorama::raster::Rgba;
use glam::{DMat2, DVec2, DVec3};

/// Place of a ray on the pictures of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chart {
    /// Coordinates u, to the right, and v, down, each 0 to 1 over a picture.
    pub(crate) at: DVec2,
    /// Change of the coordinates for one pixel to the right.
    pub(crate) dx: DVec2,
    /// Change of the coordinates for one pixel down.
    pub(crate) dy: DVec2,
    /// Change of nearness for one pixel to the right and down, as a part of it.
    pub(crate) nearing: DVec2,
    /// Unit vector on the surface along u.
    pub(crate) tangent: DVec3,
    /// Unit vector on the surface against v: up in the picture.
    pub(crate) bitangent: DVec3,
}

impl Chart {
    /// Returns the chart as it is seen from behind, where the surface's normal is reversed: dents go the other way, too.
    pub(crate) fn reversed(self) -> Self {
        Self { tangent: -self.tangent, bitangent: -self.bitangent, ..self }
    }

    /// Returns the chart of the pixel at an offset of some pixels to the right, and down.
    pub(crate) fn moved(self, offset: DVec2) -> Self {
        let step = (self.dx * offset.x + self.dy * offset.y) / (1.0 + self.nearing.dot(offset));
        Self { at: self.at + step, ..self }
    }

    /// Returns the chart of the middle part of the pixel.
    pub(crate) fn scaled(self, part: f64) -> Self {
        Self { dx: self.dx * part, dy: self.dy * part, nearing: self.nearing * part, ..self }
    }

    /// Returns the number of a picture's texels along the pixel's longer side.
    pub(crate) fn texels(&self, picture: &Texture) -> f64 {
        let size = DVec2::new(picture.picture().width() as f64, picture.picture().height() as f64);
        (self.dx * size).length().max((self.dy * size).length())
    }

    /// Averages a picture under the pixel.
    pub(crate) fn average(&self, picture: &Texture) -> Rgba {
        let jacobian = DMat2::from_cols(self.dx, self.dy);
        picture.average(&TextureFootprint { at: self.at, jacobian, nearing: self.nearing })
    }
}
