use cosmorama::sphere::Direction;
use glam::DVec3;

use super::{seen, sky};
use crate::Radiance;

/// The sky of [`DemoWorld`](crate::DemoWorld) alone: clouds, a low sun, and hills on the horizon.
#[derive(Clone, Copy, Debug, Default)]
pub struct DemoSky;

impl Radiance for DemoSky {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        sky::light(direction.vector()).as_vec3().to_array()
    }
}

/// The arcade of [`DemoWorld`](crate::DemoWorld) before another sky, which does not change what lights it.
#[derive(Clone, Copy, Debug)]
pub struct DemoScenery<S> {
    /// The light of the sky.
    pub sky: S,
}

impl<S: Radiance> Radiance for DemoScenery<S> {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        let sky = |towards: DVec3| {
            let light = Direction::new(towards).map_or([0.0; 3], |towards| self.sky.radiance(towards));
            DVec3::from_array(light.map(f64::from))
        };
        seen(direction, &sky).as_vec3().to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DemoWorld;

    #[test]
    fn before_its_own_sky_the_scenery_is_the_demo_world() {
        for k in 0..200 {
            let turn = 0.7 * f64::from(k);
            let towards = DVec3::new(turn.cos(), 0.01 * f64::from(k - 100), turn.sin());
            let direction = Direction::new(towards).expect("a direction");
            let own = DemoWorld.radiance(direction);
            let same = DemoScenery { sky: DemoSky }.radiance(direction);
            assert!(own.iter().zip(same).all(|(a, b)| (a - b).abs() <= 1e-5 * (1.0 + a)), "{own:?} {same:?}");
        }
    }
}
