use cosmorama::raster::Rgba;
use cosmorama::world::{Light, World};

/// A world with its light, and the light of directions in which it shows nothing.
#[derive(Clone, Copy, Debug)]
pub struct Sky<'a> {
    /// Its views.
    pub world: &'a World,
    /// Their light.
    pub light: &'a Light,
    /// Light of directions that no view shows, premultiplied; `None` if there are no such directions.
    pub unseen: Option<Rgba>,
}

impl<'a> Sky<'a> {
    /// Returns a world that shows all directions.
    pub fn new(world: &'a World, light: &'a Light) -> Self {
        Self { world, light, unseen: None }
    }

    /// Returns the mean of the light that is seen, of all channels.
    pub(crate) fn mean(&self) -> f64 {
        let (mut sum, mut whole) = (0.0, 0.0);
        for (texel, angle) in self.light.texels().iter().zip(self.world.solid_angles()) {
            let angle = f64::from(angle);
            sum += angle * f64::from(texel.0[0] + texel.0[1] + texel.0[2]);
            whole += 3.0 * angle;
        }
        if whole > 0.0 { sum / whole } else { 0.0 }
    }
}
