use cosmorama::filter::{Filter, FilterSettings};
use cosmorama::raster::Rgba;
use cosmorama_convert::Radiance;

use super::camera::Shot;

/// Bytes of a texel under which things are lit: its light, its solid angle, and its part of blocks of light.
const LIT: usize = size_of::<Rgba>() + size_of::<f32>() + 11;

/// Bytes of the cube of the world on which wide parts of pixels are seen, with the weights by which it is made.
const CUBE: usize = 16 << 20;

/// Returns the memory that pictures of things need, beside the things themselves and the program.
pub(super) fn needed(lights: &[Radiance], shots: &[Shot], frames: usize, filter: FilterSettings) -> u64 {
    let lit = |light: &Radiance| light.world.texel_count() * LIT + CUBE + filter.setup(&light.world).bytes;
    let lit = lights.iter().map(lit).sum::<usize>();
    let pixels: usize = shots.iter().map(|shot| shot.camera.width() * shot.camera.height()).sum();
    // The picture, its samples, a sheet that it goes into, and what lies behind things that turn.
    let pictures = 2 + usize::from(shots.iter().any(|shot| shot.place.is_some())) + usize::from(frames > 1);
    (lit + pixels * pictures * size_of::<Rgba>()) as u64
}
