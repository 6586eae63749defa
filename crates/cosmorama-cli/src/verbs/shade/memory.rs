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
    fn bytes(&self) -> usize {
        let world = |light: &Radiance| light.world.texel_count() * LIT + CUBE + self.filter.setup(&light.world).bytes;
        self.worlds.iter().map(world).sum::<usize>() + self.maps.iter().map(LightMaps::bytes).sum::<usize>()
    }
}

/// Returns the memory that pictures of things need with their tables of chrome, beside the things themselves and the program.
pub(super) fn needed(scene: &Scene, lighting: &Lighting, shots: &[Shot], frames: usize) -> u64 {
    let pixels: usize = shots.iter().map(|shot| shot.camera.width() * shot.camera.height()).sum();
    // The picture, its samples, a sheet that it goes into, and what lies behind things that turn.
    let pictures = 2 + usize::from(shots.iter().any(|shot| shot.place.is_some())) + usize::from(frames > 1);
    // Maps are made before there are pictures, those of one world after those of another.
    let to_make = lighting.maps.iter().map(LightMaps::bytes_to_make).max().unwrap_or(0);
    (lighting.bytes() + scene.chrome_bytes() + to_make.max(pixels * pictures * size_of::<Rgba>())) as u64
}
