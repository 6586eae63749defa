use cosmorama::camera::{Footprint, PixelPoint};
use cosmorama::raster::Rgba;
use cosmorama::sphere::Direction;
use cosmorama::world::World;
use glam::DVec3;

/// Computes the light of a world from the direction of each texel's centre.
pub fn light_by_direction(world: &World, light: impl Fn(Direction) -> [f32; 3]) -> Vec<Rgba> {
    light_by_texel(world, |_, _, _, direction| {
        let [red, green, blue] = direction.map_or([0.0; 3], &light);
        Rgba::opaque(red, green, blue)
    })
}

/// Computes the light of a world from the view, column, row and direction of each texel's centre.
pub fn light_by_texel(world: &World, light: impl Fn(usize, usize, usize, Option<Direction>) -> Rgba) -> Vec<Rgba> {
    let mut texels = Vec::with_capacity(world.texel_count());
    for (index, source) in world.sources().iter().enumerate() {
        for j in 0..source.view.height() {
            for i in 0..source.view.width() {
                texels.push(light(index, i, j, source.view.direction(PixelPoint::centre(i, j))));
            }
        }
    }
    texels
}

/// Returns the displacement, in pixels, of the direction that a pixel's colour encodes from the pixel's own direction.
pub fn position_error(footprint: &Footprint, pixel: Rgba) -> f64 {
    let [x, y, z, _] = pixel.0.map(f64::from);
    let found = DVec3::new(x, y, z).normalize_or_zero();
    (found - footprint.direction.vector()).length() / footprint.jacobian.solid_angle().sqrt()
}
