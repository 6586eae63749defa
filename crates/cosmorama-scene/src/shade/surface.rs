use cosmorama::filter::Texture;
use cosmorama::raster::Rgba;
use glam::DVec3;

use super::albedo_table::AlbedoTable;
use crate::material::{Finish, Material, Paint};
use crate::ray::Normal;
use crate::shape::{Chart, Wall};

/// A material at a place, as the eye sees it: emissive + kd·D + ks·S, by colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Normal of the dents and bumps.
    pub(crate) normal: Normal,
    pub(super) diffuse: DVec3,
    pub(super) specular: DVec3,
    pub(super) emissive: DVec3,
    pub(crate) gloss: Gloss,
}

/// Source of a surface's reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Gloss {
    /// A table of colours by elevation.
    Chrome,
    /// The world, by a roughness α.
    World(f64),
}

impl Gloss {
    /// Returns the angle by which it blurs the world, in radians: the lobe's α.
    pub(crate) fn blur(self) -> f64 {
        match self {
            Self::Chrome => 0.0,
            Self::World(alpha) => alpha,
        }
    }

    /// Returns what all of a material reflects; `None` if that differs from place to place.
    pub(crate) fn of(material: &Material) -> Option<Self> {
        if material.chrome {
            return Some(Self::Chrome);
        }
        material.alphas().filter(|[least, greatest]| least == greatest).map(|[alpha, _]| Self::World(alpha))
    }
}

impl Surface {
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
    pub(super) fn of(wall: &Wall, material: &Material, albedo: Option<&AlbedoTable>) -> Self {
        let (Some(finish), Some(albedo)) = (&material.finish, albedo) else {
            return Self {
                normal: wall.normal,
                diffuse: DVec3::splat(material.diffuse),
                specular: DVec3::splat(material.specular),
                emissive: DVec3::ZERO,
                gloss: if material.chrome { Gloss::Chrome } else { Gloss::World(material.alpha) },
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
        let [scale, bias] = albedo.at(-wall.met.direction.dot(normal.facing(&wall.met).unit), alpha);
        let insulator = finish.specular * (finish.insulator() * scale + bias);
        Self {
            normal,
            diffuse: base * ((1.0 - metallic) * (1.0 - insulator) * material.diffuse),
            specular: (DVec3::splat(insulator).lerp(base * scale + bias, metallic)) * material.specular,
            emissive: painted(&finish.emissive, chart),
            gloss: Gloss::World(alpha),
        }
    }
}

/// Looks up a picture; white without one.
fn looked_up(map: Option<&Texture>, chart: Option<&Chart>) -> Rgba {
    map.zip(chart).map_or(Rgba([1.0; 4]), |(map, chart)| chart.average(map))
}

fn painted(paint: &Paint, chart: Option<&Chart>) -> DVec3 {
    let map = looked_up(paint.map.as_deref(), chart).unpremultiplied().map(f64::from);
    DVec3::from_array(paint.colour) * DVec3::from_array(map)
}

/// Returns the mean normal of the dents under a pixel, and the part of α² that they make within it: a mean of unit
/// vectors is shorter than one by half of their variance (M. Toksvig, *Mipmapping normal maps*, 2005).
fn dented(finish: &Finish, normal: &Normal, chart: Option<&Chart>) -> (Normal, f64) {
    let Some((map, chart)) = finish.normal_map.as_ref().zip(chart) else { return (*normal, 0.0) };
    let Rgba([x, y, z, _]) = chart.average(map.map());
    let mean = DVec3::new(x.into(), y.into(), z.into());
    let sideways = (chart.tangent * mean.x + chart.bitangent * mean.y) * map.scale;
    let unit = (sideways + normal.unit * mean.z).try_normalize().unwrap_or(normal.unit);
    let variance = 2.0 * (1.0 - mean.length()).max(0.0) * map.scale * map.scale;
    (Normal { unit, ..*normal }, variance)
}
