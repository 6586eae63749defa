use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use glam::DVec3;

use super::bright_sources::brightness;
use super::texel_angles::texel_angles;
use crate::camera::PixelPoint;
use crate::raster::Rgba;
use crate::sphere::{Angle, Direction};
use crate::world::World;

/// Sun or lamp of a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Middle of its light.
    pub direction: Direction,
    /// Solid angle of its texels, in steradians.
    pub solid_angle: f64,
    /// Light that falls on a surface that faces it, by colour: its radiance above what is behind it, times solid angle.
    pub irradiance: [f64; 3],
    /// Part of all light of the world.
    pub share: f64,
    /// Largest channel.
    pub peak: f32,
}

/// Suns and lamps of a world, and what is behind them.
///
/// A sun is all connected texels over [`Suns::EDGE`] times as bright as the mean, if one of them is over [`World::SUN`] times as bright.
/// Behind it, light goes on from the texels around: each counts by the inverse square of its distance (D. Shepard, *A two-dimensional
/// interpolation function for irregularly-spaced data*, ACM 1968).
///
/// ```
/// use cosmorama::lighting::Suns;
/// use cosmorama::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let sky = Image::from_fn(64, 32, |i, j| if (i, j) == (40, 9) { Rgba::opaque(9e3, 9e3, 9e3) } else { Rgba::BLACK });
/// let (world, light) = World::from_panorama(sky)?;
/// let suns = Suns::find(&world, light.texels());
/// assert_eq!(suns.all().len(), 1);
/// assert!(suns.without(light.texels()).iter().all(|texel| texel.0[0] == 0.0));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Suns {
    all: Vec<Sun>,
    /// Texels of suns with the light behind them.
    behind: Vec<(usize, Rgba)>,
}

impl Sun {
    /// Returns the radius of a disc of its solid angle.
    pub fn radius(&self) -> Angle {
        Angle::from_radians((1.0 - (self.solid_angle / (2.0 * PI)).min(2.0)).acos())
    }

    /// Returns its mean radiance above what is behind it, by colour.
    pub fn radiance(&self) -> [f64; 3] {
        self.irradiance.map(|light| light / self.solid_angle)
    }
}

impl Suns {
    /// Multiple of the mean down to which texels belong to a sun.
    pub const EDGE: f64 = 16.0;

    /// Finds the suns of a world's texels, brightest first.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn find(world: &World, texels: &[Rgba]) -> Self {
        assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
        let lit = Lit::of(world, texels);
        let mean = lit.mean;
        let bright = lit.brighter_than(Self::EDGE * mean);
        if mean <= 0.0 || bright.is_empty() {
            return Self { all: Vec::new(), behind: Vec::new() };
        }
        let cells =
            Cells { side: CELL * world.sources().iter().fold(0.0, |most: f64, source| most.max(source.texel_pitch)) };
        let clusters = cells.clusters(&bright);
        let is_sun =
            |cluster: &Vec<Lamp>| cluster.iter().any(|lamp| brightness(texels[lamp.texel]) > World::SUN * mean);
        let clusters: Vec<Vec<Lamp>> = clusters.into_iter().filter(is_sun).collect();
        let rings = cells.rings(&clusters, &lit);
        let mut suns: Vec<(Sun, Vec<(usize, Rgba)>)> =
            clusters.iter().zip(&rings).map(|(cluster, ring)| lit.sun(cluster, ring)).collect();
        let order = |sun: &Sun| sun.irradiance.iter().sum::<f64>();
        suns.sort_by(|(a, _), (b, _)| order(b).total_cmp(&order(a)));
        let (all, behind): (Vec<_>, Vec<_>) = suns.into_iter().unzip();
        Self { all, behind: behind.into_iter().flatten().collect() }
    }

    /// Returns the suns, brightest first.
    pub fn all(&self) -> &[Sun] {
        &self.all
    }

    /// Puts the light behind the suns in their place. The light that is taken out is that of [`Sun::irradiance`].
    pub fn without(&self, texels: &[Rgba]) -> Vec<Rgba> {
        let mut texels = texels.to_vec();
        self.behind.iter().for_each(|(texel, light)| texels[*texel] = *light);
        texels
    }
}

/// Side of a cell, in texels: texels of neighbouring cells belong together.
const CELL: f64 = 1.5;

/// Groups of texels around a sun at most.
const GROUPS: usize = 96;

/// Bright texel.
#[derive(Clone, Copy)]
struct Lamp {
    texel: usize,
    direction: Direction,
    angle: f64,
}

/// Light around a sun: a direction and its colour.
type Ring = Vec<(DVec3, [f64; 4])>;

/// Texels of a world with their light.
struct Lit<'w> {
    world: &'w World,
    texels: &'w [Rgba],
    angles: Vec<f32>,
    /// Brightness times solid angle of all, and that over what is shown.
    total: f64,
    mean: f64,
}

impl<'w> Lit<'w> {
    fn of(world: &'w World, texels: &'w [Rgba]) -> Self {
        let angles: Vec<f32> = world.sources().iter().flat_map(|source| texel_angles(source).into_owned()).collect();
        let both = texels.iter().zip(&angles).map(|(texel, angle)| (brightness(*texel), f64::from(*angle)));
        let (total, sphere) =
            both.fold((0.0, 0.0), |(sum, sphere), (light, angle)| (sum + light * angle, sphere + angle));
        Self { world, texels, angles, total, mean: if sphere > 0.0 { total / sphere } else { 0.0 } }
    }

    fn brighter_than(&self, least: f64) -> Vec<Lamp> {
        let mut bright = Vec::new();
        self.visit(|texel| brightness(self.texels[texel]) > least, |lamp| bright.push(lamp));
        bright
    }

    /// Visits the texels that a test chooses.
    fn visit(&self, chosen: impl Fn(usize) -> bool, mut visit: impl FnMut(Lamp)) {
        for source in self.world.sources() {
            let width = source.view.width();
            for texel in source.texels().filter(|texel| self.angles[*texel] > 0.0 && chosen(*texel)) {
                let place = texel - source.offset;
                let centre = PixelPoint::centre(place % width, place / width);
                if let Some(direction) = source.view.direction(centre) {
                    visit(Lamp { texel, direction, angle: f64::from(self.angles[texel]) });
                }
            }
        }
    }

    /// Returns a sun of texels, with the light behind each.
    fn sun(&self, cluster: &[Lamp], ring: &Ring) -> (Sun, Vec<(usize, Rgba)>) {
        let mut irradiance = [0.0; 3];
        let (mut middle, mut solid_angle, mut peak, mut behind) = (DVec3::ZERO, 0.0, 0.0f32, Vec::new());
        for lamp in cluster {
            let light = self.texels[lamp.texel];
            let hidden = interpolated(ring, lamp.direction, light);
            for (sum, (light, hidden)) in irradiance.iter_mut().zip(light.0.iter().zip(hidden.0)) {
                *sum += f64::from(light - hidden) * lamp.angle;
            }
            middle += lamp.direction.vector() * brightness(light) * lamp.angle;
            solid_angle += lamp.angle;
            peak = light.0[..3].iter().fold(peak, |peak, light| peak.max(*light));
            behind.push((lamp.texel, hidden));
        }
        let share = irradiance.iter().sum::<f64>() / 3.0 / self.total;
        let direction = Direction::new(middle).unwrap_or(cluster[0].direction);
        (Sun { direction, solid_angle, irradiance, share, peak }, behind)
    }
}

/// Returns the light behind a texel: no channel is more than what the texel has.
fn interpolated(ring: &Ring, direction: Direction, light: Rgba) -> Rgba {
    let mut sum = [0.0; 4];
    let mut weights = 0.0;
    for (place, colour) in ring {
        let weight = 1.0 / place.distance_squared(direction.vector()).max(1e-12);
        weights += weight;
        sum.iter_mut().zip(colour).for_each(|(sum, light)| *sum += weight * light);
    }
    if weights == 0.0 {
        return Rgba([0.0, 0.0, 0.0, light.0[3]]);
    }
    let behind = [0, 1, 2].map(|channel: usize| ((sum[channel] / weights) as f32).min(light.0[channel]));
    Rgba([behind[0], behind[1], behind[2], light.0[3]])
}

/// Cube of space, by its place in each axis.
type Cell = [i32; 3];

/// Cubes of space in which directions end.
struct Cells {
    side: f64,
}

impl Cells {
    fn of(&self, direction: Direction) -> Cell {
        direction.vector().to_array().map(|coordinate| (coordinate / self.side).floor() as i32)
    }

    /// Parts texels into those of connected cells.
    fn clusters(&self, bright: &[Lamp]) -> Vec<Vec<Lamp>> {
        let mut cells: BTreeMap<Cell, Vec<Lamp>> = BTreeMap::new();
        for lamp in bright {
            cells.entry(self.of(lamp.direction)).or_default().push(*lamp);
        }
        let mut clusters = Vec::new();
        while let Some((first, lamps)) = cells.pop_first() {
            let (mut cluster, mut open) = (lamps, vec![first]);
            while let Some(cell) = open.pop() {
                for near in neighbours(cell) {
                    if let Some(lamps) = cells.remove(&near) {
                        cluster.extend(lamps);
                        open.push(near);
                    }
                }
            }
            clusters.push(cluster);
        }
        clusters
    }

    /// Gathers the texels around each cluster that belong to none.
    fn rings(&self, clusters: &[Vec<Lamp>], lit: &Lit<'_>) -> Vec<Ring> {
        let mut owners: BTreeMap<Cell, BTreeSet<usize>> = BTreeMap::new();
        for (index, cluster) in clusters.iter().enumerate() {
            let cells: BTreeSet<Cell> = cluster.iter().map(|lamp| self.of(lamp.direction)).collect();
            // Two cells out, so that there is a texel on each side.
            let near: BTreeSet<Cell> = cells.into_iter().flat_map(neighbours).collect();
            for cell in near.into_iter().flat_map(neighbours) {
                owners.entry(cell).or_default().insert(index);
            }
        }
        let suns: BTreeSet<usize> = clusters.iter().flatten().map(|lamp| lamp.texel).collect();
        let mut around = vec![Vec::new(); clusters.len()];
        lit.visit(
            |texel| !suns.contains(&texel),
            |lamp| {
                for index in owners.get(&self.of(lamp.direction)).into_iter().flatten() {
                    around[*index].push(lamp);
                }
            },
        );
        around.iter().zip(clusters).map(|(around, cluster)| grouped(around, cluster, lit.texels)).collect()
    }
}

/// Returns the cells around one, itself among them.
fn neighbours([x, y, z]: Cell) -> impl Iterator<Item = Cell> {
    (0..27).map(move |k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1])
}

/// Averages the texels around a cluster in groups of like bearing, so that a large sun has no more of them than a small one.
fn grouped(around: &[Lamp], cluster: &[Lamp], texels: &[Rgba]) -> Ring {
    let middle = cluster.iter().map(|lamp| lamp.direction.vector()).sum::<DVec3>().normalize_or(DVec3::Z);
    let (right, up) = middle.any_orthonormal_pair();
    let bearing = |lamp: &Lamp| lamp.direction.vector().dot(up).atan2(lamp.direction.vector().dot(right));
    let mut around = around.to_vec();
    around.sort_by(|a, b| bearing(a).total_cmp(&bearing(b)).then(a.texel.cmp(&b.texel)));
    let size = around.len().div_ceil(GROUPS).max(1);
    let group = |lamps: &[Lamp]| {
        let (mut place, mut light, mut angle) = (DVec3::ZERO, [0.0; 4], 0.0);
        for lamp in lamps {
            place += lamp.direction.vector() * lamp.angle;
            angle += lamp.angle;
            light.iter_mut().zip(texels[lamp.texel].0).for_each(|(sum, light)| *sum += f64::from(light) * lamp.angle);
        }
        (place / angle, light.map(|light| light / angle))
    };
    around.chunks(size).map(group).collect()
}
