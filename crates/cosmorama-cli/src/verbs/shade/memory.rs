use cosmorama::filter::{Filter, FilterSettings};
use cosmorama::raster::Rgba;
use cosmorama_convert::Radiance;
use cosmorama_scene::{LightMaps, Scene};

use super::camera::Shot;

/// Bytes of a texel under which things are lit: its light, its solid angle, and its part of blocks of light.
const LIT: usize = size_of::<Rgba>() + size_of::<f32>() + 11;

/// Bytes of the cube of the world on which wide parts of pixels are seen, with the weights by which it is made.
const CUBE: usize = 16 << 20;

/// Light under which things are lit.
pub(super) struct Lighting<'a> {
    pub(super) worlds: &'a [Radiance],
    pub(super) maps: &'a [LightMaps],
    pub(super) filter: FilterSettings,
}

impl Lighting<'_> {
    /// Returns the memory of worlds without their maps.
    fn lit_bytes(&self) -> usize {
        self.worlds.iter().map(|light| light.world.texel_count() * LIT).sum()
    }

    /// Returns the memory of worlds, ready to be asked.
    fn bytes(&self) -> usize {
        let prepared = |light: &Radiance| CUBE + self.filter.setup(&light.world).bytes;
        let maps = self.maps.iter().map(LightMaps::bytes).sum::<usize>();
        self.lit_bytes() + self.worlds.iter().map(prepared).sum::<usize>() + maps
    }

    /// Returns the memory in which maps are made, those of one world after those of another.
    fn bytes_to_make(&self) -> usize {
        self.lit_bytes() + self.maps.iter().map(LightMaps::bytes_to_make).max().unwrap_or(0)
    }
}

/// Returns the memory that pictures of things need with their tables of chrome, beside the things themselves and the program.
pub(super) fn needed(scene: &Scene, lighting: &Lighting, shots: &[Shot], frames: usize) -> u64 {
    let pixels: usize = shots.iter().map(|shot| shot.camera.width() * shot.camera.height()).sum();
    // The picture, its samples, a sheet that it goes into, and what lies behind things that turn.
    let pictures = 2 + usize::from(shots.iter().any(|shot| shot.place.is_some())) + usize::from(frames > 1);
    let shaded = lighting.bytes() + scene.chrome_bytes() + pixels * pictures * size_of::<Rgba>();
    shaded.max(lighting.bytes_to_make()) as u64
}
