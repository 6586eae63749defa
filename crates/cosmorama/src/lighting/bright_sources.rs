use crate::raster::Rgba;
use crate::world::World;

impl World {
    /// Multiple of a world's mean light above which a texel counts as a sun or lamp. Such texels fill less than a
    /// hundredth of the sphere.
    pub const SUN: f64 = 100.0;

    /// Returns the fraction of all light, radiance times solid angle, from texels over [`World::SUN`] times as bright
    /// as the mean. To keep a world's light, a filter must count them exactly. `light` returns the light of a texel, by
    /// its index in the world's buffer.
    pub fn light_of_suns(&self, light: impl Fn(usize) -> Rgba) -> f64 {
        let lights = || {
            let texels = self.solid_angles().enumerate();
            texels.map(|(texel, angle)| (brightness(light(texel)), f64::from(angle))).filter(|(_, angle)| *angle > 0.0)
        };
        let (all, sphere) = lights().fold((0.0, 0.0), |(all, sphere), (l, angle)| (all + l * angle, sphere + angle));
        if all <= 0.0 {
            return 0.0;
        }
        let least = Self::SUN * all / sphere;
        let suns: f64 = lights().filter(|(l, _)| *l > least).map(|(l, angle)| l * angle).sum();
        suns / all
    }
}

/// Returns the mean of the channels; 0 for missing texels.
pub(super) fn brightness(light: Rgba) -> f64 {
    let [red, green, blue, _] = light.0.map(f64::from);
    ((red + green + blue) / 3.0).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::panorama;

    #[test]
    fn suns_are_what_is_bright_and_small() {
        let world = World::new([("sky".to_owned(), panorama(200, 100))]).expect("one view");
        let sky = |sun: f32| world.light_of_suns(|texel| Rgba::opaque(0.5, if texel == 9900 { sun } else { 0.5 }, 0.5));
        // One texel on the horizon is 1/12732 of the sphere.
        assert_eq!(sky(100.0), 0.0);
        let part = sky(38_200.0);
        assert!((part - 2.0 / 3.0).abs() < 0.01, "{part}");
        assert_eq!(world.light_of_suns(|_| Rgba::opaque(0.0, 0.0, 0.0)), 0.0);
        assert_eq!(world.light_of_suns(|_| Rgba([f32::NAN; 4])), 0.0);
    }
}
