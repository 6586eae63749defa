//! The demo world: an arcade under a glazed vault, late on a sunny afternoon.

mod eyepiece;
mod hall;
mod lettering;
mod noise;
mod painted_sky;
mod ray;
mod scenery;
mod sky;
mod solid;
mod thing;

use cosmorama::sphere::Direction;
use glam::DVec3;

pub use eyepiece::Eyepiece;
pub use painted_sky::PaintedSky;
pub use scenery::{DemoScenery, DemoSky};

use crate::Radiance;
use ray::{Hit, Part, Ray, Surface};

/// Height of the eyes above the ground, in metres.
const EYE_HEIGHT: f64 = 1.6;

/// The demo world, seen from a point between its columns. It has a checkered floor that reaches the horizon, an arcade
/// with a barrel vault of iron lattice, lamps on thin rods, a notice ahead that reads "COSMORAMA 1986", stepped
/// pyramids to the left and behind, a mirror ball to the right, a balloon, clouds and a low sun. Its many thin lines
/// and edges show aliasing and seams.
#[derive(Clone, Copy, Debug, Default)]
pub struct DemoWorld;

/// Parts of the world; cheap and near ones come first.
const PARTS: [&dyn Part; 9] = [
    &thing::ground::Ground,
    &thing::vault::Vault,
    &thing::colonnade::Colonnade,
    &thing::panel::Panel,
    &thing::lamps::Lamps,
    &thing::gazing_ball::GazingBall,
    &thing::balloon::Balloon,
    &thing::pyramid::Pyramid::LEFT,
    &thing::pyramid::Pyramid::BACK,
];

impl Radiance for DemoWorld {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        seen(direction, &sky::light).as_vec3().to_array()
    }
}

/// Returns the light from a direction, under a sky.
fn seen(direction: Direction, sky: &dyn Fn(DVec3) -> DVec3) -> DVec3 {
    let eye = Ray::new(DVec3::new(0.0, EYE_HEIGHT, 0.0), direction.vector());
    let (light, mirrored) = look(&eye, sky);
    // A mirror in a mirror is left dark: the work per ray stays bounded.
    mirrored.map_or(light, |(ray, share)| light + look(&ray, sky).0 * share)
}

/// Returns the light along a ray, and the mirrored ray with its share of the light.
fn look(ray: &Ray, sky: &dyn Fn(DVec3) -> DVec3) -> (DVec3, Option<(Ray, f64)>) {
    let Some(hit) = first_hit(ray) else { return (sky(ray.direction), None) };
    let point = ray.at(hit.distance);
    let clarity = sky::clarity(hit.distance);
    let light = shade(point, &hit) * clarity + sky::haze(ray.direction) * (1.0 - clarity);
    (light, mirrored(ray, point, &hit).map(|(onward, share)| (onward, share * clarity)))
}

fn first_hit(ray: &Ray) -> Option<Hit> {
    let (mut ray, mut nearest) = (*ray, None);
    for part in PARTS {
        if let Some(hit) = part.hit(&ray) {
            ray.reach = hit.distance;
            nearest = Some(hit);
        }
    }
    nearest
}

/// Returns the light that leaves a surface: its own glow, and the scattered light of sun and sky.
fn shade(point: DVec3, hit: &Hit) -> DVec3 {
    let Surface { albedo, glow, mirror } = hit.surface;
    let facing = hit.normal.dot(sky::SUN);
    let toward_sun = Ray::leaving(point, hit.normal, sky::SUN);
    let sun = if facing > 0.0 && !PARTS.iter().any(|part| part.hit(&toward_sun).is_some()) {
        sky::SUNLIGHT * facing
    } else {
        DVec3::ZERO
    };
    glow + albedo * (sun + sky::ambient(hit.normal)) * (1.0 - mirror)
}

/// Returns the mirrored ray and its share of light, which grows at grazing angles (Schlick's approximation).
fn mirrored(ray: &Ray, point: DVec3, hit: &Hit) -> Option<(Ray, f64)> {
    let mirror = hit.surface.mirror;
    if mirror <= 0.0 {
        return None;
    }
    let cosine = -ray.direction.dot(hit.normal);
    let share = mirror + (1.0 - mirror) * 0.6 * (1.0 - cosine).clamp(0.0, 1.0).powi(5);
    let onward = ray.direction + hit.normal * (2.0 * cosine);
    Some((Ray::leaving(point, hit.normal, onward), share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(right: f64, up: f64, back: f64) -> Option<Hit> {
        first_hit(&Ray::new(DVec3::new(0.0, EYE_HEIGHT, 0.0), DVec3::new(right, up, back).normalize()))
    }

    #[test]
    fn the_ground_is_below_and_nothing_but_sky_between_the_columns() {
        let ground = seen(0.0, -1.0, 0.0).expect("ground");
        assert!((ground.distance - EYE_HEIGHT).abs() < 1e-12 && ground.normal == DVec3::Y);
        assert!(seen(1.0, -0.001, 0.2).is_some_and(|horizon| horizon.normal == DVec3::Y));
        assert!(seen(1.0, 0.4, 0.0).is_none());
        assert!(seen(-1.0, 0.4, 0.0).is_none());
    }

    #[test]
    fn the_sun_shines_through_the_lattice_ahead_on_the_left() {
        assert!((sky::SUN.length() - 1.0).abs() < 1e-9);
        let light = DemoWorld.radiance(Direction::from_unit(sky::SUN));
        assert!(light[0] > 10.0, "{light:?}");
    }

    #[test]
    fn the_panel_reads_from_left_to_right() {
        // Along its chart the bars get finer to the right: more changes between ink and paper.
        let height = 3.55 - 0.80 - EYE_HEIGHT;
        let changes = |from: f64| {
            let light = |step: i32| {
                let right = from + 2.0 * f64::from(step) / 2000.0;
                Direction::new(DVec3::new(right, height, -7.6)).map_or(0.0, |d| DemoWorld.radiance(d)[0])
            };
            (0..2000).filter(|&step| (light(step) - light(step + 1)).abs() > 0.3).count()
        };
        let (left, right) = (changes(-2.05), changes(0.05));
        assert!(left > 30 && right > 2 * left, "{left} {right}");
    }
}
