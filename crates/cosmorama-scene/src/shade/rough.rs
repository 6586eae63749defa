use cosmorama::camera::Footprint;
use cosmorama::filter::Prepared;
use cosmorama::lighting::SMOOTHEST;
use cosmorama::raster::Rgba;

/// Roughnesses of a scene, of which maps of the world's light are made beforehand.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Alphas {
    /// Roughnesses of whole materials.
    pub(super) exact: Vec<f64>,
    /// Roughnesses between which those of pictures lie.
    pub(super) chain: Vec<f64>,
    /// Whether some of the world is reflected without a map.
    pub(super) mirror: bool,
}

/// Number of roughnesses of a whole chain: α is 1, and then less by √2 each time.
const CHAIN: usize = 13;

/// Number of maps that a roughness between them takes.
const TAKEN: usize = 4;

impl Alphas {
    /// Collects the roughnesses of materials, by the least and the greatest α of each.
    pub(super) fn of(ranges: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut alphas = Self::default();
        let mut needed = [false; CHAIN];
        for [least, greatest] in ranges {
            if least < greatest {
                alphas.mirror |= least < alpha(CHAIN - 1);
                let (from, to) = (window(place(greatest), 0, CHAIN), window(place(least), 0, CHAIN));
                needed[from..to + TAKEN].fill(true);
            } else if least < SMOOTHEST {
                alphas.mirror = true;
            } else {
                alphas.exact.push(least);
            }
        }
        alphas.exact.sort_by(f64::total_cmp);
        alphas.exact.dedup();
        alphas.chain = (0..CHAIN).filter(|k| needed[*k]).map(alpha).collect();
        alphas
    }

    /// Returns whether there are maps for a range.
    pub(super) fn hold(&self, [least, greatest]: [f64; 2]) -> bool {
        if least == greatest {
            return least < SMOOTHEST || self.exact.contains(&least);
        }
        let needed = Self::of([[least, greatest]].into_iter());
        needed.chain.iter().all(|alpha| self.chain.contains(alpha))
    }
}

/// Returns the roughness at a place of the chain.
fn alpha(place: usize) -> f64 {
    (-0.5 * place as f64).exp2()
}

/// Returns the place of a roughness on the chain.
fn place(alpha: f64) -> f64 {
    (-2.0 * alpha.log2()).clamp(0.0, (CHAIN - 1) as f64)
}

/// Returns the first of the maps around a place, of `count` of them from `first` on.
fn window(place: f64, first: usize, count: usize) -> usize {
    (place as usize).saturating_sub(1).clamp(first, first + count.saturating_sub(TAKEN))
}

/// Maps of the world's light by roughness, ready to be asked.
pub(super) struct RoughLight<'a> {
    /// For whole materials: α and its map.
    pub(super) exact: Vec<(f64, Box<dyn Prepared + 'a>)>,
    /// From rough to smooth, a part of a chain without gaps.
    pub(super) chain: Vec<(f64, Box<dyn Prepared + 'a>)>,
}

impl RoughLight<'_> {
    /// Averages the world's light under a roughness. `mirror` returns what a mirror shows.
    ///
    /// Between the maps of a chain it is a cubic of log α through four of them. The light of a sun is proportional to
    /// α⁻²: the cubic differs from that by 0.6 % at most, where a straight line would by 6 %.
    pub(super) fn average(&self, wanted: f64, footprint: &Footprint, mirror: impl Fn() -> Rgba) -> Rgba {
        if wanted < SMOOTHEST {
            return mirror();
        }
        if let Some((_, map)) = self.exact.iter().find(|(alpha, _)| *alpha == wanted) {
            return map.average(footprint);
        }
        let Some((roughest, _)) = self.chain.first() else { return mirror() };
        let first = place(*roughest).round() as usize;
        let at = place(wanted).clamp(first as f64, (first + self.chain.len() - 1) as f64);
        let start = window(at, first, self.chain.len());
        let taken = start..(start + TAKEN).min(first + self.chain.len());
        let part = ((wanted - SMOOTHEST) / (alpha(CHAIN - 1) - SMOOTHEST)).min(1.0) as f32;
        let mut sum = if part < 1.0 { mirror() * (1.0 - part) } else { Rgba::TRANSPARENT };
        for k in taken.clone() {
            let others = taken.clone().filter(|other| *other != k);
            let weight: f64 = others.map(|other| (at - other as f64) / (k as f64 - other as f64)).product();
            if weight != 0.0 {
                sum += self.chain[k - first].1.average(footprint) * (weight as f32 * part);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use cosmorama::filter::{FilterSettings, Texture, Wrap};
    use cosmorama::lighting::{AllTexels, Lobe, LobeAverages};
    use cosmorama::raster::{Image, Transfer};
    use cosmorama::sphere::Direction;
    use cosmorama::world::{Light, World};
    use cosmorama_io::{Limits, read};

    use super::*;
    use crate::material::{Finish, Material};
    use crate::scene::Scene;
    use crate::shade::{Detail, Gloss, LightMaps, Sky, Surroundings};

    #[test]
    fn ranges_ask_for_the_maps_around_them() {
        let of = |ranges: &[[f64; 2]]| Alphas::of(ranges.iter().copied());
        assert_eq!(of(&[[0.3, 0.3], [0.0, 0.0]]), Alphas { exact: vec![0.3], chain: vec![], mirror: true });
        let narrow = of(&[[0.26, 0.34]]);
        assert_eq!(narrow.chain, [2, 3, 4, 5].map(alpha));
        assert!(!narrow.mirror && narrow.hold([0.27, 0.3]) && !narrow.hold([0.3, 0.3]) && !narrow.hold([0.1, 0.3]));
        let all = of(&[[0.0, 1.0]]);
        assert!(all.mirror && all.chain.len() == CHAIN && all.hold([0.1, 0.2]));
    }

    /// Returns metal whose roughness is a picture of these two.
    fn spotted(roughnesses: [f32; 2]) -> Material {
        let picture = Image::from_fn(2, 1, |i, _| Rgba::opaque(0.0, roughnesses[i], 1.0));
        let metal_map = Some(Arc::new(Texture::new(picture, [Wrap::Repeat; 2])));
        Material::of(Finish { metallic: 1.0, roughness: 1.0, metal_map, ..Finish::default() })
    }

    /// Returns the greatest differences of a chain at an α, as parts of the light: from a map of its own, and from the sum over all
    /// texels.
    fn errors((world, light): &(World, Light), wanted: f64, chain: &Material) -> [f32; 2] {
        let (sky, rough) = (Sky::new(world, light), Material { alpha: wanted, ..Material::MIRROR });
        let [between, own] =
            [chain, &rough].map(|material| LightMaps::of(&Scene::sphere(material.clone()), 0, sky).unwrap());
        let [between, own] =
            [&between, &own].map(|maps| Surroundings::new(sky, maps, FilterSettings::DEFAULT).unwrap());
        let (brute, lobe) = (AllTexels::new(world, light).unwrap(), Lobe::ggx(wanted).unwrap());
        let mut errors = [0.0f32; 2];
        for direction in Direction::spread(60) {
            let look =
                |at: &Surroundings| at.reflection(Gloss::World(wanted), &Footprint::point(direction), Detail::Pixel);
            let found = look(&between);
            for (error, expected) in errors.iter_mut().zip([look(&own), brute.average(direction, &lobe)]) {
                (0..3).for_each(|k| *error = error.max((found.0[k] / expected.0[k] - 1.0).abs()));
            }
        }
        errors
    }

    #[test]
    fn a_roughness_between_maps_is_that_of_a_map_of_its_own_and_of_all_texels() {
        for name in ["polyhaven_adams_place_bridge_1k.hdr", "polyhaven_noon_grass_1k.hdr", "blender_sunset.exr"] {
            let Some(folder) = testkit::shared("data/equirect_hdr") else { return };
            let image = read(folder.join(name), &Limits::NONE).unwrap().image.to_light(&Transfer::Linear);
            let sky = World::from_panorama(image).unwrap();
            // The smoother one has a coarser map for its size, whether of its own or not.
            for (wanted, chain, bound) in [(0.3, spotted([0.5, 0.6]), 0.03), (0.11, spotted([0.25, 0.5]), 0.06)] {
                let [map, brute] = errors(&sky, wanted, &chain);
                assert!(map < 0.02 && brute < bound, "{name}, α {wanted}: {map}, {brute}");
            }
        }
    }
}
