use cosmorama::filter::{Filter, FilterSettings};
use cosmorama::raster::Rgba;
use cosmorama_convert::Radiance;
use cosmorama_scene::{LightMaps, Scene};

use super::camera::Shot;
use super::output::Output;

/// Bytes of a texel under which things are lit: its light, its solid angle, and its part of blocks of light.
const LIT: usize = size_of::<Rgba>() + size_of::<f32>() + 11;

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
        let prepared = |light: &Radiance| self.filter.setup(&light.world).bytes;
        let maps = self.maps.iter().map(LightMaps::bytes).sum::<usize>();
        self.lit_bytes() + self.worlds.iter().map(prepared).sum::<usize>() + maps
    }

    /// Returns the memory in which maps are made, those of one world after those of another.
    fn bytes_to_make(&self) -> usize {
        self.lit_bytes() + self.maps.iter().map(LightMaps::bytes_to_make).max().unwrap_or(0)
    }
}

/// Returns the memory that pictures of things need with their tables of chrome, beside the things themselves and the program.
pub(super) fn needed(scene: &Scene, lighting: &Lighting, shots: &[Shot], (frames, output): (usize, &Output)) -> u64 {
    let pixels = |shot: &Shot| shot.camera.width() * shot.camera.height();
    let (largest, all) = (shots.iter().map(pixels).max().unwrap_or(0), shots.iter().map(pixels).sum::<usize>());
    // The picture, a sheet that it goes into, and what lies behind things that turn.
    let is_sheet = shots.iter().any(|shot| shot.place.is_some());
    let pictures = largest + if is_sheet { all } else { 0 } + if frames > 1 { all } else { 0 };
    let width = shots.iter().map(|shot| shot.place.as_ref().map_or(shot.camera.width(), |place| place.of.0)).max();
    let shaded = lighting.bytes() + scene.chrome_bytes() + pictures * size_of::<Rgba>();
    let shaded = shaded as u64 + output.bytes(all, width.unwrap_or(0));
    shaded.max(lighting.bytes_to_make() as u64)
}
