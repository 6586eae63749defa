use cosmorama::camera::View;
use cosmorama::filter::FilterSettings;
use cosmorama::raster::{FixedCodec, FixedLight, Rgba, Transfer};
use cosmorama::render::Resampler;
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;

use super::{cube, fisheye, turned};

/// The conversion of the speed measurements: six faces to a fulldome master, the default filter, 8-bit light.
pub struct Dome {
    /// Faces with half as many pixels across as the dome.
    pub world: World,
    /// The dome.
    pub target: View,
    /// Light with some variation.
    pub light: FixedLight,
    /// Encoder to 8 bits.
    pub codec: FixedCodec,
}

impl Dome {
    /// Creates a dome of so many pixels across.
    ///
    /// # Panics
    /// When `size` is 0.
    pub fn new(size: usize) -> Self {
        let world = cube(&CubeFace::ALL, size / 2, size / 2);
        let target = View { orientation: turned([0.0, 90.0, 0.0]), ..fisheye(size, 180.0) };
        let mut light = FixedLight::black(world.view_sizes());
        for (index, texel) in light.texels_mut().enumerate() {
            *texel = [index % 32_749, index / 7 % 32_749, index * 5 % 32_749, 0].map(|sample| sample as i16);
        }
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        Self { world, target, light, codec }
    }

    /// Returns the resampler of the conversion.
    pub fn resampler(&self) -> Resampler<'_> {
        Resampler { world: &self.world, target: &self.target, filter: FilterSettings::DEFAULT }
    }

    /// Returns the number of pixels of the square around the dome.
    pub fn pixels(&self) -> usize {
        self.target.width() * self.target.height()
    }
}
