mod block;
pub(super) mod packet;
mod pyramid;

use std::f64::consts::PI;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use self::packet::{LANES, Packet, Tolerance};
use self::pyramid::{Place, Pyramid, SIDE};
use super::averages::Normalisation;
use super::lobe::{VisitWeight, Weight};
use super::{LitTexels, LitView, Lobe, LobeAverages};
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Light, LightError, World};

/// The light of a world, gathered in blocks of texels and blocks of blocks, to be averaged under lobes.
///
/// A block is known by its light, the mean place of that, and its spread. A lobe that hardly bends over a block takes it as a
/// whole; others take its parts, down to single texels (J. Barnes and P. Hut, *A hierarchical O(N log N) force-calculation
/// algorithm*, Nature 324, 1986). Nothing is drawn at random: a sun in one texel gives the lobe's own smooth shape.
///
/// ```
/// use cosmorama::lighting::{LightTree, Lobe, LobeAverages};
/// use cosmorama::prelude::*;
///
/// let sky = Image::filled(64, 32, Rgba::opaque(1.0, 1.0, 1.0));
/// let (world, light) = World::from_panorama(sky)?;
/// let tree = LightTree::new(&world, &light)?;
/// let radiance = tree.average(Direction::UP, &Lobe::LAMBERT);
/// assert!((radiance.0[0] - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct LightTree<'w> {
    lit: LitTexels<'w>,
    pyramids: Vec<Pyramid>,
    shown: f64,
    /// Mean radiance, all colours added.
    mean: f32,
    tolerance: f64,
}

/// Part of a block's weight that its second-order term may be. What is neglected is of third order, and cancels between blocks.
const TOLERANCE: f64 = 0.025;

/// Weight, over that far from the axis, below which none counts as small.
const FLOOR: f32 = 0.2;

/// Part of the mean weight that is taken for that far from the axis, of lobes that have hardly any there.
const LEAST: f32 = 0.05;

impl<'w> LightTree<'w> {
    /// Gathers the light of a world.
    ///
    /// # Errors
    /// When the light is not that of the world.
    pub fn new(world: &'w World, light: &'w Light) -> Result<Self, LightError> {
        Ok(Self::of(LitTexels::new(world, light)?))
    }

    /// Gathers the light of a world's texels.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of_texels(world: &'w World, texels: &'w [Rgba]) -> Self {
        Self::of(LitTexels::of_texels(world, texels))
    }

    pub(super) fn of(lit: LitTexels<'w>) -> Self {
        let pyramids: Vec<Pyramid> = lit.views().map(Pyramid::new).collect();
        let tops = || pyramids.iter().map(|pyramid| pyramid.block(pyramid.top()));
        let shown: f64 = tops().map(|top| f64::from(top.shown)).sum();
        let light: f64 = tops().map(|top| f64::from(top.brightness() * top.shown)).sum();
        let mean = if shown > 0.0 { (light / shown) as f32 } else { 0.0 };
        Self { lit, pyramids, shown, mean, tolerance: TOLERANCE }
    }

    /// Sets the part of a block's weight that its second-order term may be (0.025). The less, the nearer, and the slower.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance: tolerance.max(0.0), ..self }
    }
}

impl LobeAverages for LightTree<'_> {
    fn shown(&self) -> f64 {
        self.shown
    }

    fn averages(&self, axes: &[Direction], lobe: &Lobe) -> Vec<Rgba> {
        let normalisation = Normalisation::of(self.shown);
        let mut averages = vec![Rgba::TRANSPARENT; axes.len()];
        averages.par_chunks_mut(LANES).zip(axes.par_chunks(LANES)).for_each(|(averages, axes)| {
            let packet = lobe.visit(Gather { tree: self, lobe, axes });
            for (lane, average) in averages.iter_mut().enumerate() {
                *average = normalisation.average(packet.sums(lane), lobe);
            }
        });
        averages
    }
}

/// Gathers the light about some axes.
struct Gather<'a> {
    tree: &'a LightTree<'a>,
    lobe: &'a Lobe,
    axes: &'a [Direction],
}

impl VisitWeight for Gather<'_> {
    type Output = Packet;

    fn visit<W: Weight>(self, weight: W) -> Packet {
        let level = Level::new();
        let mut packet = Packet::of(self.axes);
        dispatch!(level, _simd => self.gather(&mut packet, weight));
        packet
    }
}

/// Returns the weight that a lobe has far from its axis, but not less than a part of its mean over the sphere.
fn far_weight<W: Weight>(lobe: &Lobe, weight: W) -> f32 {
    let mean = (lobe.integral() / (4.0 * PI)) as f32;
    weight.kink().clamp(LEAST * mean, mean)
}

impl Gather<'_> {
    #[inline(always)]
    fn gather<W: Weight>(&self, packet: &mut Packet, weight: W) {
        let tolerance = Tolerance {
            part: self.tree.tolerance as f32,
            mean: self.tree.mean,
            floor: FLOOR * far_weight(self.lobe, weight),
        };
        let mut open: Vec<Place> = Vec::new();
        for (view, pyramid) in self.tree.pyramids.iter().enumerate() {
            open.push(pyramid.top());
            while let Some(place) = open.pop() {
                let block = pyramid.block(place);
                if !block.shows() || packet.add_block(block, weight, tolerance) {
                    continue;
                }
                if place.level > 0 {
                    open.extend(pyramid.parts(place));
                } else {
                    self.gather_texels(packet, (self.tree.lit.view(view), place), weight);
                }
            }
        }
    }

    #[inline(always)]
    fn gather_texels<W: Weight>(&self, packet: &mut Packet, (view, place): (LitView, Place), weight: W) {
        let (width, height) = view.size();
        let (left, top) = (place.column * SIDE, place.row * SIDE);
        for j in top..(top + SIDE).min(height) {
            let (texels, angles) = view.row(j);
            view.source.view.row_directions(j, left..(left + SIDE).min(width), |i, direction| {
                let angle = angles[i];
                if angle > 0.0 {
                    let light = texels[i].0.map(|channel| channel * angle);
                    packet.add_texel(direction.vector().to_array().map(|part| part as f32), light, weight);
                }
            });
        }
    }
}
