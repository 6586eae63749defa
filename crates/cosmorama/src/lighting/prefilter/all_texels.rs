use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::averages::Normalisation;
use super::lobe::{VisitWeight, Weight};
use super::{LitTexels, Lobe, LobeAverages};
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Light, LightError, World};

/// The light of a world, to be summed texel by texel: the exact averages, in double precision.
///
/// The cost is that of every texel for every average. [`LightTree`](super::LightTree) is faster, and close.
pub struct AllTexels<'w> {
    lit: LitTexels<'w>,
    shown: f64,
}

/// Axes that are worked on together.
const LANES: usize = 8;

/// Axes for which a thread computes the directions of texels once.
const PIECE: usize = 256;

impl<'w> AllTexels<'w> {
    /// Prepares the sums over a world's light.
    ///
    /// # Errors
    /// When the light is not that of the world.
    pub fn new(world: &'w World, light: &'w Light) -> Result<Self, LightError> {
        Ok(Self::of(LitTexels::new(world, light)?))
    }

    /// Prepares the sums over texels.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of_texels(world: &'w World, texels: &'w [Rgba]) -> Self {
        Self::of(LitTexels::of_texels(world, texels))
    }

    fn of(lit: LitTexels<'w>) -> Self {
        let shown = lit.views().map(|view| {
            let texels = view.texels.iter().zip(view.angles);
            texels.map(|(texel, angle)| f64::from(texel.alpha()) * f64::from(*angle)).sum::<f64>()
        });
        let shown = shown.sum();
        Self { lit, shown }
    }

    /// Visits the rows of all views: the directions of texels that show something, with their light times solid angle.
    fn rows(&self, mut visit: impl FnMut(&[Texel])) {
        let mut row = Vec::new();
        for view in self.lit.views() {
            let (width, height) = view.size();
            for j in 0..height {
                row.clear();
                let (texels, angles) = view.row(j);
                view.source.view.row_directions(j, 0..width, |i, direction| {
                    let angle = f64::from(angles[i]);
                    if angle > 0.0 {
                        let light = texels[i].0.map(|light| f64::from(light) * angle);
                        row.push(Texel { direction: direction.vector().to_array(), light });
                    }
                });
                visit(&row);
            }
        }
    }
}

impl LobeAverages for AllTexels<'_> {
    fn shown(&self) -> f64 {
        self.shown
    }

    fn averages(&self, axes: &[Direction], lobe: &Lobe) -> Vec<Rgba> {
        let sums: Vec<Vec<[f64; 4]>> =
            axes.par_chunks(PIECE).map(|axes| lobe.visit(Sum { light: self, axes })).collect();
        let normalisation = Normalisation::of(self.shown);
        sums.into_iter().flatten().map(|sums| normalisation.average(sums, lobe)).collect()
    }
}

struct Texel {
    direction: [f64; 3],
    light: [f64; 4],
}

/// Sums over all texels for some axes.
struct Sum<'a> {
    light: &'a AllTexels<'a>,
    axes: &'a [Direction],
}

impl VisitWeight for Sum<'_> {
    type Output = Vec<[f64; 4]>;

    fn visit<W: Weight>(self, weight: W) -> Vec<[f64; 4]> {
        let mut packets: Vec<Packet> = self.axes.chunks(LANES).map(Packet::of).collect();
        let level = Level::new();
        self.light.rows(|row| {
            dispatch!(level, _simd => packets.iter_mut().for_each(|packet| packet.add(row, weight)));
        });
        let sums = packets.iter().flat_map(|packet| (0..LANES).map(|lane| packet.sums.map(|sums| sums[lane])));
        sums.take(self.axes.len()).collect()
    }
}

/// Axes that are worked on together, an axis a lane, with their sums.
struct Packet {
    axes: [[f64; LANES]; 3],
    sums: [[f64; LANES]; 4],
}

impl Packet {
    fn of(axes: &[Direction]) -> Self {
        let vector = |lane: usize| axes[lane.min(axes.len() - 1)].vector().to_array();
        let axes = std::array::from_fn(|k| std::array::from_fn(|lane| vector(lane)[k]));
        Self { axes, sums: [[0.0; LANES]; 4] }
    }

    #[inline(always)]
    fn add<W: Weight>(&mut self, row: &[Texel], weight: W) {
        let [x, y, z] = &self.axes;
        let mut sums = self.sums;
        for Texel { direction, light } in row {
            for lane in 0..LANES {
                let s = (x[lane] - direction[0]) * x[lane]
                    + (y[lane] - direction[1]) * y[lane]
                    + (z[lane] - direction[2]) * z[lane];
                let weight = weight.double(s);
                for channel in 0..4 {
                    sums[channel][lane] += weight * light[channel];
                }
            }
        }
        self.sums = sums;
    }
}
