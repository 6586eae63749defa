use crate::raster::Rgba;
use crate::world::World;

/// Figures of the light of a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightFigures {
    /// Mean radiance over the whole sphere, by colour. What the world does not show is dark.
    pub mean: [f64; 3],
    /// Largest channel.
    pub peak: f32,
    /// Part of all light that comes from suns and lamps: texels over [`World::SUN`] times as bright as the mean.
    pub suns: f64,
    /// Part of the sphere that is shown.
    pub shown: f64,
}

impl LightFigures {
    /// Measures the light of a world's texels.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of(world: &World, texels: &[Rgba]) -> Self {
        assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
        let whole = 4.0 * std::f64::consts::PI;
        let (mut mean, mut shown, mut peak) = ([0.0; 3], 0.0, 0.0f32);
        for (texel, angle) in texels.iter().zip(world.solid_angles()) {
            let [red, green, blue, alpha] = texel.0;
            let part = f64::from(angle) / whole;
            mean.iter_mut().zip([red, green, blue]).for_each(|(mean, light)| *mean += f64::from(light) * part);
            shown += f64::from(alpha) * part;
            peak = peak.max(red).max(green).max(blue);
        }
        Self { mean, peak, suns: world.light_of_suns(|texel| texels[texel]), shown }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::panorama;

    #[test]
    fn half_a_world_of_one_is_a_mean_of_a_half() {
        let world = World::new([("sky".to_owned(), panorama(200, 100))]).expect("one view");
        let texels: Vec<Rgba> =
            (0..20_000).map(|k| if k < 10_000 { Rgba::opaque(1.0, 0.0, 4.0) } else { Rgba::TRANSPARENT }).collect();
        let LightFigures { mean: [red, green, blue], peak, suns, shown } = LightFigures::of(&world, &texels);
        assert!((red - 0.5).abs() < 1e-4 && green == 0.0 && (blue - 2.0).abs() < 4e-4, "{red}, {blue}");
        assert!(peak == 4.0 && suns == 0.0 && (shown - 0.5).abs() < 1e-4);
    }
}
