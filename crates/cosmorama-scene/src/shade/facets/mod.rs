//! The lobe of microfacets, seen from any side, as a sum of prefiltered ones.

mod table;

use std::f64::consts::FRAC_PI_2;

use cosmorama::camera::Footprint;
use cosmorama::raster::Rgba;
use cosmorama::sphere::{Direction, DirectionJacobian};
use glam::{DMat3, DVec3};

use self::table::{ANGLES, LOBES};
use crate::material::Material;
use crate::ray::Ray;

/// α of the maps that a lobe is a sum of, as parts of its own.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// α up to which a lobe is taken as the one of a prefiltered map: what pixels see is wider. From twice that on it is a sum.
const SIMPLE: f64 = 1.0 / 64.0;

/// A prefiltered lobe that is a part of one of microfacets.
///
/// Light at l is reflected to v by D(h)·G(l, v)/(4 n·v), with the distribution D of Trowbridge and Reitz and the
/// height-correlated masking G of Smith (Heitz, *Understanding the masking-shadowing function in microfacet-based BRDFs*, 2014,
/// equations 71 and 99). A map has the lobe of n = v alone. Seen at a slant, that is as long as before along the plane of
/// incidence, and narrower across it by the cosine of the angle; it leans to the normal, and ends at the horizon. So it is a sum
/// of narrower ones along the plane, each of two halves.
#[derive(Clone, Copy, Debug)]
pub(super) struct LobePart {
    /// α of its map.
    pub(super) alpha: f64,
    weight: f64,
    /// Rotation in the plane of incidence, from the mirrored direction to its own.
    turn: DMat3,
}

/// Least α of a part: maps of narrower lobes take many seconds and much memory to make.
const NARROWEST: f64 = 1.0 / 80.0;

/// Spread, in units of α, up to which the two halves of a part are one.
const ONE: f64 = 0.02;

impl LobePart {
    /// Lists the parts of the lobe of a roughness α about a normal and the direction that a mirror would show. Their weights add
    /// up to one.
    fn of(alpha: f64, normal: DVec3, mirrored: DVec3) -> impl Iterator<Item = Self> {
        let angle = normal.dot(mirrored).clamp(-1.0, 1.0).acos();
        let axis = normal.cross(mirrored).try_normalize();
        let turned = move |shift: f64| {
            let shift = (shift * alpha).min(FRAC_PI_2 - angle);
            axis.map_or(DMat3::IDENTITY, |axis| DMat3::from_axis_angle(axis, shift))
        };
        let parts = PARTS.into_iter().zip(numbers(alpha, angle)).filter(|(_, [weight, ..])| *weight > 0.0);
        parts.flat_map(move |(part, [weight, shift, spread])| {
            let halves: &[f64] = if spread < ONE { &[0.0] } else { &[-1.0, 1.0] };
            let half = move |side: &f64| Self {
                alpha: part_of(alpha, part),
                weight: weight / halves.len() as f64,
                turn: turned(shift + side * spread),
            };
            halves.iter().map(half)
        })
    }

    /// Averages the light of the parts of a lobe.
    pub(super) fn sum(alpha: f64, normal: DVec3, mirrored: DVec3, light: impl Fn(&Self) -> Rgba) -> Rgba {
        let parts = Self::of(alpha, normal, mirrored);
        parts.fold(Rgba::TRANSPARENT, |sum, part| sum + light(&part) * part.weight as f32)
    }

    /// Lists the least and the greatest α of the maps that a material's lobes are sums of.
    pub(super) fn ranges(material: &Material) -> impl Iterator<Item = [f64; 2]> {
        let range = material.alphas();
        let is_sum = material.finish.is_some() && range.is_some_and(|[_, greatest]| greatest > SIMPLE);
        let count = if is_sum { PARTS.len() } else { 1 };
        range.into_iter().flat_map(move |[least, greatest]| {
            if least == greatest {
                return PARTS[..count].iter().map(|part| [part_of(least, *part); 2]).collect();
            }
            let narrowest = if is_sum { least.min(part_of(least.max(SIMPLE), PARTS[count - 1])) } else { least };
            vec![[narrowest, greatest]]
        })
    }

    /// Returns the part of the world that it sees about the mirrored footprint.
    pub(super) fn footprint(&self, mirrored: &Footprint) -> Footprint {
        let Footprint { direction, jacobian: DirectionJacobian { dx, dy } } = *mirrored;
        let direction = Direction::from_unit(self.turn * direction.vector());
        Footprint { direction, jacobian: DirectionJacobian { dx: self.turn * dx, dy: self.turn * dy } }
    }

    /// Returns the mirrored ray turned to its own direction.
    pub(super) fn ray(&self, mirrored: &Ray) -> Ray {
        mirrored.bent(&self.turn)
    }
}

/// Returns the α of the map of a part of a lobe.
fn part_of(alpha: f64, part: f64) -> f64 {
    (part * alpha).max(NARROWEST.min(alpha))
}

/// Looks up the parts of a lobe: the weight of each, its shift from the mirrored direction and its spread, in units of α.
fn numbers(alpha: f64, angle: f64) -> [[f64; 3]; PARTS.len()] {
    let row = (alpha / SIMPLE).log2();
    if row <= 0.0 {
        return table::SIMPLE;
    }
    let angle = angle.min(FRAC_PI_2).to_degrees();
    let column = ANGLES.partition_point(|known| *known <= angle).clamp(1, ANGLES.len() - 1) - 1;
    let right = ((angle - ANGLES[column]) / (ANGLES[column + 1] - ANGLES[column])).clamp(0.0, 1.0);
    let first = (row as usize).min(LOBES.len() - 1);
    let down = (row - first as f64).min(1.0);
    // Row 0 is the simple lobe, before those of the table.
    let lobe = |row: usize, column: usize| if row == 0 { table::SIMPLE } else { LOBES[row - 1][column] };
    std::array::from_fn(|part| {
        std::array::from_fn(|k| {
            let across = |row: usize| {
                let (from, to) = (lobe(row, column)[part][k], lobe(row, column + 1)[part][k]);
                from + (to - from) * right
            };
            across(first) + (across(first + 1) - across(first)) * down
        })
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use cosmorama::camera::{CameraModel, EquirectCamera, PixelPoint};
    use cosmorama::filter::FilterSettings;
    use cosmorama::raster::Image;
    use cosmorama::world::{Light, World};

    use super::*;
    use crate::material::Finish;
    use crate::scene::Scene;
    use crate::shade::{Detail, Gloss, LightMaps, Sky, Surroundings};

    const WIDTH: usize = 512;

    /// Returns the light of waves from a direction.
    fn waves(DVec3 { x, y, z }: DVec3) -> [f64; 3] {
        let wave = |phase: f64| 0.5 + 0.35 * phase.sin();
        [
            wave(9.0 * (x + 0.3 * y - 0.2 * z)),
            wave(11.0 * (0.2 * x + y + 0.4 * z)),
            wave(13.0 * (0.5 * y - 0.3 * x + z)),
        ]
    }

    /// Returns soft spots of light in three directions, from the front of the ball to its side.
    fn spots(direction: DVec3) -> [f64; 3] {
        let spot = |towards: DVec3| (60.0 * (direction.dot(towards.normalize()) - 1.0)).exp();
        [DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.3, 0.1, 1.0), DVec3::new(0.1, 1.0, -0.2)].map(spot)
    }

    /// Returns a panorama of light.
    fn panorama(light: fn(DVec3) -> [f64; 3]) -> (World, Light) {
        let view = CameraModel::from(EquirectCamera::default()).view(WIDTH, WIDTH / 2).expect("a panorama");
        let texel = |i, j| {
            let [red, green, blue] = light(view.direction(PixelPoint::centre(i, j)).expect("a direction").vector());
            Rgba::opaque(red as f32, green as f32, blue as f32)
        };
        World::from_panorama(Image::from_fn(WIDTH, WIDTH / 2, texel)).expect("a panorama")
    }

    /// Returns what facets reflect of light, as a part of what they reflect of a white world, by samples of the facets' normals
    /// h: light comes from 2(v·h)h − v, and counts by G·(v·h)/((n·v)(n·h)) (Walter et al., *Microfacet models for refraction*, 2007,
    /// equations 35, 36 and 41).
    fn by_samples(light: fn(DVec3) -> [f64; 3], alpha: f64, normal: DVec3, eye: DVec3) -> [f64; 3] {
        const SIDE: usize = 96;
        let smith = |cosine: f64| 0.5 * ((1.0 + alpha * alpha * (cosine.powi(-2) - 1.0)).sqrt() - 1.0);
        let (right, up) = normal.any_orthonormal_pair();
        let (mut sum, mut whole) = ([0.0; 3], 0.0);
        for k in 0..SIDE * SIDE {
            let [part, around] = [k % SIDE, k / SIDE].map(|k| (k as f64 + 0.5) / SIDE as f64);
            let (slope, (sin, cos)) = (alpha * (part / (1.0 - part)).sqrt(), (TAU * around).sin_cos());
            let half = (normal + (right * cos + up * sin) * slope).normalize();
            let towards = half * (2.0 * eye.dot(half)) - eye;
            let cosine = normal.dot(towards);
            if cosine > 0.0 {
                let masking = 1.0 / (1.0 + smith(cosine) + smith(normal.dot(eye)));
                let weight = masking * eye.dot(half) / normal.dot(half);
                let seen = light(towards);
                (0..3).for_each(|k| sum[k] += weight * seen[k]);
                whole += weight;
            }
        }
        sum.map(|sum| sum / whole)
    }

    /// A ball's reflections by a gloss, beside samples.
    struct Errors {
        mean_square: f64,
        /// Greatest difference of a channel from the samples, as a part of the brightest of them.
        greatest: f64,
    }

    /// Returns the errors of the lobe of facets, and of that of one map.
    fn errors(light: fn(DVec3) -> [f64; 3], alpha: f64) -> [Errors; 2] {
        const COUNT: usize = 150;
        let sky = panorama(light);
        let metal = Finish { metallic: 1.0, roughness: f64::sqrt(alpha), ..Finish::default() };
        let alpha = metal.roughness.powi(2);
        let scene = Scene::sphere(Material::of(metal));
        let maps = LightMaps::of(&scene, 0, Sky::new(&sky.0, &sky.1)).unwrap();
        let at = Surroundings::new(Sky::new(&sky.0, &sky.1), &maps, FilterSettings::DEFAULT).unwrap();
        let eye = DVec3::new(0.36, 0.48, 0.8);
        let (right, up) = eye.any_orthonormal_pair();
        let normal = |k: usize| {
            // Evenly over the disc that the eye sees.
            let (radius, (sin, cos)) = (((k as f64 + 0.5) / COUNT as f64).sqrt(), (2.399_963 * k as f64).sin_cos());
            (right * cos + up * sin) * radius + eye * (1.0 - radius * radius).sqrt()
        };
        let expected: Vec<[f64; 3]> = (0..COUNT).map(|k| by_samples(light, alpha, normal(k), eye)).collect();
        let brightest = [0, 1, 2].map(|c| expected.iter().map(|light| light[c]).fold(0.0, f64::max));
        [true, false].map(|is_of_facets| {
            let (mut squares, mut greatest) = (0.0, 0.0f64);
            for (k, expected) in expected.iter().enumerate() {
                let normal = normal(k);
                let gloss = if is_of_facets { Gloss::Facets(alpha, normal) } else { Gloss::World(alpha) };
                let mirrored = Direction::from_unit(normal * (2.0 * normal.dot(eye)) - eye);
                let found = at.reflection(gloss, &Footprint::point(mirrored), Detail::Pixel);
                for c in 0..3 {
                    let error = f64::from(found.0[c]) - expected[c];
                    squares += error * error;
                    greatest = greatest.max(error.abs() / brightest[c]);
                }
            }
            Errors { mean_square: squares / (3 * COUNT) as f64, greatest }
        })
    }

    #[test]
    fn lobes_are_those_of_facets() {
        for alpha in [0.05, 0.09, 0.2, 0.35, 0.6] {
            let [facets, one] = errors(waves, alpha).map(|errors| -10.0 * errors.mean_square.log10());
            assert!(facets > 44.0 && facets > one + 8.0, "α {alpha}: {facets} dB, {one} by one map");
        }
    }

    /// Compares soft spots of light: a part of the lobe that went aside would show each once more.
    #[test]
    fn spots_of_light_are_not_seen_twice() {
        for (alpha, bound) in [(0.06, 0.03), (0.12, 0.06), (0.25, 0.15), (0.5, 0.25), (0.7, 0.3), (1.0, 0.35)] {
            let [facets, one] = errors(spots, alpha);
            assert!(facets.greatest < bound && facets.mean_square < one.mean_square, "α {alpha}: {}", facets.greatest);
        }
    }

    #[test]
    fn weights_add_up_to_one_and_nothing_steps() {
        const STEP: f64 = 1e-4;
        for k in 0..2000 {
            let (alpha, angle) = ((-0.0035 * f64::from(k)).exp2(), 1.57 * f64::from(k * 37 % 1000) / 1000.0);
            let here = numbers(alpha, angle);
            let sum: f64 = here.iter().map(|[weight, ..]| weight).sum();
            assert!((sum - 1.0).abs() < 1e-9 && here.iter().all(|[weight, ..]| *weight >= 0.0), "α {alpha}, {angle}");
            for near in [numbers(alpha, angle + STEP), numbers(alpha * (1.0 + STEP), angle)] {
                let moved = here.iter().flatten().zip(near.iter().flatten()).map(|(a, b)| (a - b).abs());
                assert!(moved.fold(0.0, f64::max) < 0.01, "α {alpha}, {angle}: {here:?}, {near:?}");
            }
        }
        assert_eq!(numbers(0.01, 1.0), table::SIMPLE);
        assert_eq!(numbers(SIMPLE, 1.0), table::SIMPLE);
    }

    #[test]
    fn a_lobe_about_the_normal_is_round_and_none_is_below_the_surface() {
        for k in 0..1000 {
            let (alpha, angle) = ((-0.006 * f64::from(k)).exp2(), 1.57 * f64::from(k * 37 % 1000) / 1000.0);
            for [_, shift, spread] in numbers(alpha, 0.0) {
                assert!(shift == 0.0 && spread == 0.0, "α {alpha}");
            }
            let normal = DVec3::Z;
            let mirrored = DVec3::new(angle.sin(), 0.0, angle.cos());
            for part in LobePart::of(alpha, normal, mirrored) {
                assert!((part.turn * mirrored).z > -1e-9, "α {alpha}, {angle}: {part:?}");
            }
        }
    }
}
