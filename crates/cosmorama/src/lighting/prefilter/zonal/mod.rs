mod bands;
mod gather;
mod grid;
mod legendre;
mod points;
mod transform;

use std::sync::OnceLock;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use self::bands::Bands;
use self::gather::{Taker, gather};
use self::grid::{Channels, Grid, GridSize};
use self::legendre::Parts;
use self::points::{BrightPoints, Point, Totals};
use self::transform::Spectrum;
use super::LitTexels;
use super::Lobe;
use super::averages::Normalisation;
use super::light_tree::packet::{LANES, Packet};
use super::lobe::{VisitWeight, Weight};
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::World;

/// The light of a world as spherical harmonics of high order, with the brightest texels apart.
///
/// A round lobe multiplies each band of harmonics by a number: zonal convolution. Harmonics are summed over all texels. Texels that
/// give suns and lamps are taken out first, and weighed one by one, so that what is left of higher bands is next to nothing.
pub(super) struct ZonalLight {
    spectrum: Spectrum,
    lobes: Vec<WideLobe>,
    bright: Vec<Point>,
    shown: f64,
    /// Light of every texel that is in neither ([`Totals::least`]).
    least: Channels,
    /// Whether sums may be negative, because some light is.
    has_negative: bool,
}

/// Grids that are held while light is gathered, at most: pieces that are merged, and the whole.
const GATHERED: usize = 5;

/// A lobe with its bands, and the light under it as soon as it is asked for.
struct WideLobe {
    lobe: Lobe,
    bands: Bands,
    light: OnceLock<Grid>,
}

impl WideLobe {
    /// Returns a lobe with its bands; `None` if it is too sharp.
    fn of(lobe: &Lobe) -> Option<Self> {
        Bands::of(lobe).map(|bands| Self { lobe: *lobe, bands, light: OnceLock::new() })
    }
}

impl ZonalLight {
    /// Gathers a world's light for those of some lobes that are wide enough; `None` if there are none.
    pub(super) fn of(lit: &LitTexels, lobes: &[Lobe]) -> Option<Self> {
        let lobes: Vec<WideLobe> = lobes.par_iter().filter_map(WideLobe::of).collect();
        let highest = lobes.iter().map(|lobe| lobe.bands.highest()).max()?;
        let totals = Totals::of(lit);
        let bright = BrightPoints::of(lit, &totals);
        let Totals { shown, least, has_negative, mean, .. } = totals;
        let grain = lobes.iter().map(|lobe| lobe.bands.grain()).fold(f64::INFINITY, f64::min);
        let size = GridSize::of(highest);
        let spectrum = Spectrum::of(size, &gather(lit, &bright, Taker { size, grain, mean, least }), highest);
        Some(Self { spectrum, lobes, bright: bright.points, shown, least, has_negative })
    }

    /// Returns about how many bytes grids and waves of a world's light take for some lobes.
    pub(super) fn bytes_for(world: &World, lobes: &[Lobe]) -> usize {
        let bands: Vec<usize> = lobes.par_iter().filter_map(Bands::of).map(|bands| bands.highest()).collect();
        let Some(most) = bands.iter().max() else { return 0 };
        let grid = |highest: &usize| 2 * GridSize::of(*highest).rows.pow(2) * size_of::<Channels>();
        // Pieces of upright panoramas have few rows in common: they are next to nothing.
        let is_by_rings = world.sources().iter().all(|source| source.view.upright_cylinder().is_some());
        let gathered = if is_by_rings { 0 } else { GATHERED * grid(most) };
        let waves = GridSize::of(*most).rows * (most + 1) * size_of::<Parts>();
        let spectrum = (most + 1).pow(2) / 2 * size_of::<Parts>();
        // Waves are made of the whole grid, and then the spectrum of them; later waves and the light under each lobe of the spectrum.
        let under: usize = bands.iter().map(grid).sum();
        gathered.max(spectrum + waves + grid(most) + under)
    }

    /// Returns whether bands hold the light under all of some lobes.
    pub(super) fn takes_all(lobes: &[Lobe]) -> bool {
        lobes.par_iter().all(|lobe| Bands::of(lobe).is_some())
    }

    /// Returns the solid angle in which something is shown.
    pub(super) fn shown(&self) -> f64 {
        self.shown
    }

    /// Returns the average under a lobe about each axis; `None` if the lobe is none of those that the light was gathered for.
    pub(super) fn averages(&self, axes: &[Direction], lobe: &Lobe) -> Option<Vec<Rgba>> {
        let WideLobe { bands, light, .. } = self.lobes.iter().find(|wide| wide.lobe == *lobe)?;
        let grid = light.get_or_init(|| self.spectrum.under(bands));
        let normalisation = Normalisation::of(self.shown);
        let mut averages = vec![Rgba::TRANSPARENT; axes.len()];
        averages.par_chunks_mut(LANES).zip(axes.par_chunks(LANES)).for_each(|(averages, axes)| {
            let packet = lobe.visit(Brighten { points: &self.bright, axes });
            for (lane, (average, axis)) in averages.iter_mut().zip(axes).enumerate() {
                let sums = self.sums(grid, *axis, packet.sums(lane));
                *average = normalisation.average(sums, lobe);
            }
        });
        Some(averages)
    }

    /// Adds what the bands hold to the sums over bright points.
    fn sums(&self, grid: &Grid, axis: Direction, mut sums: [f64; 4]) -> [f64; 4] {
        sums.iter_mut().zip(grid.value(axis)).for_each(|(sum, value)| *sum += f64::from(value));
        let [red, green, blue, shown] = sums;
        // Where nothing shines, bands that are left out leave traces of both signs.
        let light = [red, green, blue].map(|sum| if self.has_negative { sum } else { sum.max(0.0) });
        let shown = shown.max(0.0);
        let whole = |channel: usize| light[channel] + f64::from(self.least[channel]) * shown;
        [whole(0), whole(1), whole(2), shown]
    }
}

/// Sums bright points about some axes.
struct Brighten<'a> {
    points: &'a [Point],
    axes: &'a [Direction],
}

impl VisitWeight for Brighten<'_> {
    type Output = Packet;

    fn visit<W: Weight>(self, weight: W) -> Packet {
        let mut packet = Packet::of(self.axes);
        let level = Level::new();
        dispatch!(level, _simd => add_points(&mut packet, self.points, weight));
        packet
    }
}

#[inline(always)]
fn add_points<W: Weight>(packet: &mut Packet, points: &[Point], weight: W) {
    for Point { direction, light } in points {
        packet.add_texel(direction.vector().to_array().map(|part| part as f32), *light, weight);
    }
}
