use cosmorama::filter::Texture;
use cosmorama::raster::Rgba;
use glam::{DVec2, DVec3};

use super::albedo_table::AlbedoTable;
use crate::material::{Chrome, Finish, Material, Paint};
use crate::ray::Normal;
use crate::shape::{Chart, Wall};

/// A material at a place, as the eye sees it: emissive + kd·D + ks·S, by colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<'a> {
    /// Normal of the dents and bumps.
    pub(crate) normal: Normal,
    pub(super) diffuse: DVec3,
    pub(super) specular: DVec3,
    pub(super) emissive: DVec3,
    pub(crate) gloss: Gloss<'a>,
}

/// Source of a surface's reflection.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Gloss<'a> {
    /// A table of colours by elevation.
    Chrome(&'a Chrome),
    /// The world, by a roughness α, under the lobe of a prefiltered map.
    World(f64),
    /// The world, by microfacets of a roughness α about a normal.
    Facets(f64, DVec3),
}

impl<'a> Gloss<'a> {
    /// Returns whether it shows a table, and not the world.
    pub(crate) fn is_chrome(self) -> bool {
        matches!(self, Self::Chrome(_))
    }

    /// Returns the angle by which it blurs the world, in radians: the lobe's α.
    pub(crate) fn blur(self) -> f64 {
        match self {
            Self::Chrome(_) => 0.0,
            Self::World(alpha) | Self::Facets(alpha, _) => alpha,
        }
    }

    /// Returns what all of a material reflects, about a normal that is yet to be given; `None` if that differs from place to place.
    pub(crate) fn of(material: &'a Material) -> Option<Self> {
        if let Some(chrome) = &material.chrome {
            return Some(Self::Chrome(chrome));
        }
        let alphas = material.alphas().filter(|[least, greatest]| least == greatest);
        let is_of_facets = material.finish.is_some();
        alphas.map(|[alpha, _]| if is_of_facets { Self::Facets(alpha, DVec3::Z) } else { Self::World(alpha) })
    }

    /// Returns the same reflection about another normal.
    #[must_use]
    pub(crate) fn about(self, normal: DVec3) -> Self {
        match self {
            Self::Facets(alpha, _) => Self::Facets(alpha, normal),
            Self::Chrome(_) | Self::World(_) => self,
        }
    }
}

impl<'a> Surface<'a> {
    /// Returns the part of light that it reflects, of the colour of which it reflects most.
    pub(crate) fn reflected(&self) -> f64 {
        self.specular.max_element()
    }

    /// Returns whether some light is scattered.
    pub(crate) fn is_matt(&self) -> bool {
        self.diffuse != DVec3::ZERO
    }

    /// Returns the surface where only a part of the light falls on it.
    #[must_use]
    pub(crate) fn shadowed(self, open: f64) -> Self {
        Self { diffuse: self.diffuse * open, ..self }
    }

    /// Returns a material where a ray meets it.
    pub(super) fn of(wall: &Wall, material: &'a Material, albedo: Option<&AlbedoTable>) -> Self {
        let (Some(finish), Some(albedo)) = (&material.finish, albedo) else {
            return Self {
                normal: wall.normal,
                diffuse: DVec3::splat(material.diffuse),
                specular: DVec3::splat(material.specular),
                emissive: DVec3::ZERO,
                gloss: material.chrome.as_ref().map_or(Gloss::World(material.alpha), Gloss::Chrome),
            };
        };
        let chart = wall.chart.as_ref();
        let (normal, unseen) = dented(finish, &wall.normal, chart);
        let base = painted(&finish.base, chart);
        let Rgba([_, rough, metal, _]) = looked_up(finish.metal_map.as_deref(), chart);
        let (roughness, metallic) =
            (finish.roughness * f64::from(rough), (finish.metallic * f64::from(metal)).clamp(0.0, 1.0));
        // Spreads of slopes add; α² is twice a slope's variance.
        let alpha = (roughness.powi(4) + unseen).sqrt().clamp(0.0, 1.0);
        let facing = normal.facing(&wall.met).unit;
        let [scale, bias] = albedo.at(-wall.met.direction.dot(facing), alpha);
        let insulator = finish.specular * (finish.insulator() * scale + bias);
        Self {
            normal,
            diffuse: base * ((1.0 - metallic) * (1.0 - insulator) * material.diffuse),
            specular: (DVec3::splat(insulator).lerp(base * scale + bias, metallic)) * material.specular,
            emissive: painted(&finish.emissive, chart),
            gloss: Gloss::Facets(alpha, facing),
        }
    }
}

/// Looks up a picture; white without one.
fn looked_up(map: Option<&Texture>, chart: Option<&Chart>) -> Rgba {
    map.zip(chart).map_or(Rgba([1.0; 4]), |(map, chart)| chart.average(map))
}

/// Returns the colour at a place. What the picture says of transparency does not count.
fn painted(paint: &Paint, chart: Option<&Chart>) -> DVec3 {
    let Rgba([red, green, blue, _]) = looked_up(paint.map.as_deref(), chart);
    DVec3::from_array(paint.colour) * DVec3::new(red.into(), green.into(), blue.into())
}

/// Returns the mean normal of the dents under a pixel, with its change from pixel to pixel, and the part of α² that dents make
/// within it.
fn dented(finish: &Finish, normal: &Normal, chart: Option<&Chart>) -> (Normal, f64) {
    let Some((map, chart)) = finish.normal_map.as_ref().zip(chart) else { return (*normal, 0.0) };
    let mean = |chart: &Chart| {
        let Rgba([x, y, z, _]) = chart.average(map.map());
        DVec3::new(x.into(), y.into(), z.into())
    };
    let placed = |dent: DVec3| (chart.tangent * dent.x + chart.bitangent * dent.y) * map.scale + normal.unit * dent.z;
    let sum = placed(mean(chart));
    let Some(unit) = sum.try_normalize() else { return (*normal, 0.0) };
    let change = |surface: DVec3, step: DVec2| {
        let turned = placed(mean(&chart.moved(0.5 * step)) - mean(&chart.moved(-0.5 * step))) / sum.length();
        surface + turned - unit * unit.dot(surface + turned)
    };
    let dented = Normal { unit, dx: change(normal.dx, DVec2::X), dy: change(normal.dy, DVec2::Y) };
    (dented, unseen(map.map(), chart, mean) * map.scale * map.scale)
}

/// Returns the variance of the normals under a pixel: a mean of unit vectors is shorter than one by half of that (M. Toksvig,
/// *Mipmapping normal maps*, 2005). Between texels the means are shorter, too, though the surface is smooth there: that does not
/// count, by the part of the pixel that a texel is.
fn unseen(map: &Texture, chart: &Chart, mean: impl Fn(&Chart) -> DVec3) -> f64 {
    let variance = |chart: &Chart| 2.0 * (1.0 - mean(chart).length());
    let texels = chart.texels(map);
    if texels <= 1.0 {
        return 0.0;
    }
    (variance(chart) - variance(&chart.scaled(texels.recip())) / (texels * texels)).max(0.0)
}

#[cfg(test)]
mod tests {
    use cosmorama::filter::Wrap;
    use cosmorama::raster::Image;

    use super::*;
    use crate::material::NormalMap;

    const SIDE: usize = 64;

    /// Returns a finish whose normals lean along u by an angle at each column, over 64 texels a unit.
    fn leaning(angle: impl Fn(usize) -> f64) -> Finish {
        let code = |part: f64| (0.5 + 0.5 * part) as f32;
        let texel = |i: usize, _| Rgba::opaque(code(angle(i).sin()), code(0.0), code(angle(i).cos()));
        let map = NormalMap::new(&Image::from_fn(SIDE, SIDE, texel), [Wrap::Repeat; 2], 1.0);
        Finish { normal_map: Some(map), ..Finish::default() }
    }

    /// Returns the chart of a pixel of so many texels.
    fn chart(at: f64, texels: f64) -> Chart {
        let step = texels / SIDE as f64;
        let (dx, dy) = (DVec2::X * step, DVec2::Y * step);
        let (tangent, bitangent) = (DVec3::X, DVec3::Y);
        Chart { at: DVec2::new(at, 0.4), dx, dy, nearing: DVec2::ZERO, tangent, bitangent }
    }

    const FLAT: Normal = Normal { unit: DVec3::Z, dx: DVec3::ZERO, dy: DVec3::ZERO };

    #[test]
    fn magnified_dents_are_smooth_and_bend_what_is_seen() {
        // Waves whose normals turn by 10° from texel to texel at most.
        let angle = |i: usize| 0.9 * (i as f64 * std::f64::consts::TAU / 32.0).sin();
        let finish = leaning(angle);
        for k in 0..40 {
            let at = 0.1 + 0.02 * f64::from(k);
            let (found, alpha) = dented(&finish, &FLAT, Some(&chart(at, 0.05)));
            assert!(alpha == 0.0, "{at}: {alpha}");
            let [left, right] = [-1.0, 1.0].map(|side| {
                let moved = chart(at + side * 0.025 / SIDE as f64, 0.05);
                dented(&finish, &FLAT, Some(&moved)).0.unit
            });
            assert!((found.dx - (right - left)).length() < 1e-4, "{at}: {} for {}", found.dx, right - left);
            assert!(found.dy.length() < 6e-4, "{at}: {}", found.dy);
        }
    }

    #[test]
    fn dents_within_a_pixel_are_rough() {
        let zigzag = leaning(|i| if i % 2 == 0 { 0.2 } else { -0.2 });
        let (found, alpha) = dented(&zigzag, &FLAT, Some(&chart(0.3, 8.0)));
        // The variance of two normals 0.4 apart, but for the part that a texel is of the pixel.
        let expected = 2.0 * (1.0 - 0.2f64.cos());
        assert!(alpha > 0.95 * expected && alpha < 1.05 * expected, "{alpha} for {expected}");
        assert!((found.unit - DVec3::Z).length() < 0.02 && found.dx.length() < 0.05, "{found:?}");
    }
}
