use cosmorama::camera::View;
use cosmorama::filter::FilterSettings;
use cosmorama::raster::{FixedCodec, FixedLight, Rgba, Transfer};
use cosmorama::render::Resampler;
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;

use super::{cube, fisheye, turned};

/// The conversion whose speed counts: six faces to a fulldome master, the default filter, light of 8 bits.
pub struct Dome {
    /// Faces of half as many pixels across as the dome.
    pub world: World,
    /// The dome.
    pub target: View,
    /// Some light, not all the same.
    pub light: FixedLight,
    /// What makes 8 bits of it.
    pub codec: FixedCodec,
}

impl Dome {
    /// One of so many pixels across.
    ///
    /// # Panics
    /// When it has none.
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

    /// What makes it.
    pub fn resampler(&self) -> Resampler<'_> {
        Resampler { world: &self.world, target: &self.target, filter: FilterSettings::DEFAULT }
    }

    /// Pixels of the square that it is in.
    pub fn pixels(&self) -> usize {
        self.target.width() * self.target.height()
    }
}
