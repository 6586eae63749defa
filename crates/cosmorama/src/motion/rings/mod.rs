//! A view that turns about one axis while a shutter is open, rendered once.
//!
//! Seen from the axis, all directions of one latitude go the same way along their *ring*, and pixels see the same light one
//! after the other. So this light is sampled once: in a panorama whose poles are the axis, and each of whose samples is what
//! a pixel of the view would be there, of its own size and shape and by its own filter. Its rows are blurred by the shutter,
//! and each pixel is interpolated from them. Where interpolation cannot be trusted, the pixel is left to the caller.

mod cells;
mod taps;

use std::f64::consts::{FRAC_PI_2, TAU};

use fearless_simd::{Level, dispatch};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::marks::Marks;
use super::turning::{Turning, lattice};
use crate::camera::{CameraModel, EquirectCamera, PixelGrid, PixelPoint, View};
use crate::filter::{CrossSection, FilterKind, FilterSettings};
use crate::raster::{Image, Rgba};
use crate::render::{Progress, Resampler, Sampling, Stopped, Wanted};
use crate::sphere::{Direction, Orientation};
use crate::world::World;
use cells::{Cell, Cells, Frame, Pixel, SIDE};
use taps::{BEFORE, DIFFERENCE, Interpolation, OF_JUMP, REACH, Taps, Weights, blur};

/// As many times more samples are needed where a kernel is as wide as it is because texels are: it leaves some of their lattice.
const LATTICE: f64 = 1.75;

/// Part of a pixel that counts as the kernel's unit at least, there.
const NEAR: f64 = 0.95;

/// Part of the view's points for which this density is enough; elsewhere pixels are finer.
const MOST: f64 = 0.75;

/// Light of a shutter by the angle of the turn.
#[derive(Clone, Debug)]
pub(super) enum Profile {
    /// At some angles, each with a weight.
    Moments(Vec<(f64, f64)>),
    /// A Gaussian of this mean and standard deviation.
    Gaussian { mean: f64, deviation: f64 },
}

/// Greatest number of samples for each pixel of a view.
const MOST_SAMPLES: usize = 8;

/// Standard deviations after which a Gaussian ends.
const TAIL: f64 = 4.0;

impl Profile {
    /// Returns how many samples there are along a ring, and across rings, for the length of the kernel's unit. Along rings light is
    /// summed, which asks for less than interpolation across them. Ellipses are no more than near to what is seen.
    fn density(&self) -> [f64; 2] {
        match self {
            Self::Moments(_) => [1.25, 1.5],
            Self::Gaussian { .. } => [1.0, 1.25],
        }
    }

    /// Returns the taps for rows of so many samples per radian.
    fn taps(&self, density: f64) -> Taps {
        // What is seen under a positive angle about the axis lies to the left.
        match self {
            Self::Moments(moments) => {
                let offset = |(angle, weight): &(f64, f64)| (-angle * density, *weight);
                Taps::at(&moments.iter().map(offset).collect::<Vec<_>>())
            }
            Self::Gaussian { mean, deviation } => {
                // Half a sample, or less than the Gaussian itself, from one to the next.
                let count = (TAIL * (2.0 * deviation * density).max(4.0)).ceil();
                let offset = |k: i64| {
                    let x = TAIL * k as f64 / count;
                    (-(mean + x * deviation) * density, (-0.5 * x * x).exp())
                };
                Taps::at(&(-count as i64..=count as i64).map(offset).collect::<Vec<_>>())
            }
        }
    }
}

/// Light along the rings of a turning view.
pub(super) struct Rings<'a> {
    /// View whose pixels are sampled.
    lens: &'a View,
    resampler: (&'a World, FilterSettings),
    cells: Cells,
    /// Panorama about the axis.
    view: View,
    /// First column and first row of the panorama, counted in samples from the front.
    first: [i64; 2],
    is_whole_turn: bool,
    taps: Taps,
    interpolation: Interpolation,
    wanted: Wanted,
}

/// A picture, and which of its cells are left to be made otherwise.
pub(super) struct Swept {
    pub(super) image: Image<Rgba>,
    pub(super) left: Marks,
}

impl<'a> Rings<'a> {
    /// Prepares the rings of some views, which turn as `turning` says. `None` where the filter is none that can be sampled, or
    /// where there would be too many samples.
    pub(super) fn new(
        views: &'a [(View, f32)],
        turning: &Turning,
        profile: &Profile,
        resampler: (&'a World, FilterSettings),
    ) -> Option<Self> {
        let lens = &views[turning.middle].0;
        if !is_sampled(lens, resampler) {
            return None;
        }
        let frame = frame(lens, turning.axis, profile.density(), resampler)?;
        let taps = profile.taps(frame.density[0]);
        let cells = Cells::of(lens, &frame);
        let [least, most] = cells.bounds()?;
        let period = (TAU * frame.density[0]).round() as i64;
        let (after, reach) = (REACH as i64 - BEFORE, taps.last().max(-taps.first) + REACH as i64);
        let (left, right) = (least[0].floor() as i64 - reach, most[0].floor() as i64 + reach);
        let is_whole_turn = right - left >= period;
        let (left, right) = if is_whole_turn { (-period / 2, period - period / 2) } else { (left, right) };
        // Rows end at the poles.
        let pole = (FRAC_PI_2 * frame.density[1]).floor() as i64;
        let (top, bottom) =
            ((least[1].floor() as i64 - BEFORE).max(-pole), (most[1].floor() as i64 + after).min(pole + 1));
        let (width, height) = ((right - left) as usize, (bottom - top).max(1) as usize);
        if width.checked_mul(height)? > MOST_SAMPLES * lens.width() * lens.height() {
            return None;
        }
        let origin = PixelPoint::new(0.5 - left as f64, 0.5 - top as f64);
        let step = DVec2::new(frame.density[0].recip(), frame.density[1].recip());
        let view = View {
            orientation: frame.orientation,
            grid: PixelGrid::centred(width, height, origin, step),
            ..CameraModel::from(EquirectCamera::default()).view(width, height).ok()?
        };
        let mut rings = Self {
            lens,
            resampler,
            cells,
            view,
            first: [left, top],
            is_whole_turn,
            taps,
            interpolation: Interpolation::new(),
            wanted: Wanted::new([0, 0], |_| false),
        };
        rings.wanted = rings.needed();
        Some(rings)
    }

    /// Returns the patches of the panorama that any pixel needs.
    fn needed(&self) -> Wanted {
        let (width, height) = (self.view.width() as i64, self.view.height() as i64);
        let (across, down) = (self.view.width().div_ceil(SIDE), self.view.height().div_ceil(SIDE));
        let mut marks = vec![false; across * down];
        let (from, to) = (self.taps.first - BEFORE, self.taps.last() + REACH as i64 - BEFORE);
        for [least, most] in self.cells.cells.iter().filter_map(Cell::bounds) {
            let at = |place: f64, axis: usize| place.floor() as i64 - self.first[axis];
            let rows = (at(least[1], 1) - BEFORE).max(0)..(at(most[1], 1) + REACH as i64 - BEFORE).min(height);
            let columns = at(least[0], 0) + from..at(most[0], 0) + to;
            for row in (rows.start as usize / SIDE)..(rows.end.max(0) as usize).div_ceil(SIDE) {
                let mut column = columns.start;
                while column < columns.end {
                    let inside = if self.is_whole_turn { column.rem_euclid(width) } else { column.clamp(0, width - 1) };
                    marks[row * across + inside as usize / SIDE] = true;
                    // To the first column of the next patch, but not beyond the last column that is needed.
                    column += SIDE as i64 - inside % SIDE as i64;
                    if self.is_whole_turn && inside + SIDE as i64 > width {
                        column = column.min(columns.start + width * ((column - columns.start) / width + 1));
                    }
                }
            }
        }
        Wanted::new([self.view.width(), self.view.height()], |[i, j]| marks[j / SIDE * across + i / SIDE])
    }

    /// Renders the view. `tolerance` is the greatest lone jump between the two rings beside a pixel, by their seventh difference, at
    /// which it is kept: absolute for light up to 1, and relative to brighter light.
    pub(super) fn render(&self, texels: &[Rgba], tolerance: f32, progress: &dyn Progress) -> Result<Swept, Stopped> {
        let (world, filter) = self.resampler;
        let sampling = Sampling { wanted: Some(&self.wanted), lens: Some(self.lens) };
        let mut panorama = Resampler::new(world, &self.view).by(filter).render_sampled(sampling, texels, progress)?;
        self.blur(&mut panorama);
        Ok(self.look_up(&panorama, tolerance))
    }

    /// Blurs the rows of the panorama along themselves.
    fn blur(&self, panorama: &mut Image<Rgba>) {
        let (width, level) = (panorama.width(), Level::new());
        let before = -self.taps.first;
        let room = width + self.taps.weights.len() - 1;
        let rows = panorama.pixels_mut().par_chunks_mut(width).enumerate();
        rows.for_each_init(Vec::new, |padded: &mut Vec<Rgba>, (row, pixels)| {
            let is_wanted = |column: &usize| self.wanted.holds([*column, row]);
            let mut patches = (0..width).step_by(SIDE).filter(is_wanted);
            let Some(first) = patches.next() else { return };
            let end = (patches.next_back().unwrap_or(first) + SIDE).min(width);
            padded.clear();
            padded.extend((0..room as i64).map(|at| {
                let column = at - before;
                match usize::try_from(column) {
                    Ok(column) if column < width => pixels[column],
                    _ if self.is_whole_turn => pixels[column.rem_euclid(width as i64) as usize],
                    _ => Rgba::TRANSPARENT,
                }
            }));
            dispatch!(level, _simd => blur(&self.taps.weights, &padded[first..], &mut pixels[first..end]));
        });
    }

    /// Interpolates each pixel between the blurred rings.
    fn look_up(&self, panorama: &Image<Rgba>, tolerance: f32) -> Swept {
        let (width, height, level) = (self.lens.width(), self.lens.height(), Level::new());
        let mut image = Image::zeroed(width, height);
        let mut is_left = vec![false; self.cells.cells.len()];
        let across = self.cells.across;
        let bands = image.pixels_mut().par_chunks_mut(width * SIDE).zip(is_left.par_chunks_mut(across)).enumerate();
        bands.for_each(|(band, (pixels, is_left))| {
            let cells = &self.cells.cells[band * across..][..across];
            dispatch!(level, _simd => self.look_up_band(panorama, tolerance, cells, (pixels, is_left)));
        });
        Swept { image, left: with_neighbours(&is_left, across) }
    }

    #[inline(always)]
    fn look_up_band(
        &self,
        panorama: &Image<Rgba>,
        tolerance: f32,
        cells: &[Cell],
        (pixels, is_left): (&mut [Rgba], &mut [bool]),
    ) {
        let width = self.lens.width();
        for (row, pixels) in pixels.chunks_mut(width).enumerate() {
            let cells = cells.iter().zip(is_left.iter_mut()).zip(pixels.chunks_mut(SIDE));
            for ((cell, is_left), pixels) in cells.filter(|((_, is_left), _)| !**is_left) {
                for (into, pixel) in pixels.iter_mut().zip(cell.row(row)) {
                    let Some(pixel) = pixel else { continue };
                    match self.at(panorama, pixel.place, tolerance) {
                        Some(light) => *into = light * pixel.coverage,
                        None => *is_left = true,
                    }
                }
            }
        }
    }

    /// Interpolates the light at a place; `None` where it is not certain enough.
    #[inline(always)]
    fn at(&self, panorama: &Image<Rgba>, place: [f64; 2], tolerance: f32) -> Option<Rgba> {
        let floor = place.map(f64::floor);
        let [x, y] = [0, 1].map(|axis| floor[axis] as i64 - self.first[axis] - BEFORE);
        let (width, height) = (panorama.width(), panorama.height());
        let reach = REACH as i64;
        if y < 0 || y + reach > height as i64 {
            return None;
        }
        let is_inside = x >= 0 && x + reach <= width as i64;
        if !is_inside && !self.is_whole_turn {
            return None;
        }
        let [along, across] = [0, 1].map(|axis| self.interpolation.at(place[axis] - floor[axis]));
        let mut rings = [[0.0f32; 4]; REACH];
        for (k, ring) in rings.iter_mut().enumerate() {
            let row = panorama.row(y as usize + k);
            let samples: [Rgba; REACH] = if is_inside {
                *row[x as usize..].first_chunk()?
            } else {
                std::array::from_fn(|at| row[(x + at as i64).rem_euclid(width as i64) as usize])
            };
            *ring = sum(&along, &samples.map(|sample| sample.0));
        }
        let [light, difference] = [sum(&across, &rings), sum(&DIFFERENCE, &rings)];
        let most = tolerance * OF_JUMP;
        let is_certain = light.iter().zip(&difference).all(|(light, off)| off.abs() <= most * light.abs().max(1.0));
        is_certain.then_some(Rgba(light))
    }
}

/// Returns the weighted sum of lights.
#[inline(always)]
fn sum(weights: &Weights, lights: &[[f32; 4]; REACH]) -> [f32; 4] {
    let mut sum = [0.0f32; 4];
    for (weight, light) in weights.iter().zip(lights) {
        sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += weight * light);
    }
    sum
}

/// Marks the cells around those that are marked, too: where a streak is too bright for interpolation, so are its ends.
fn with_neighbours(is_marked: &[bool], across: usize) -> Marks {
    let down = is_marked.len() / across.max(1);
    let around = |at: usize, of: usize| at.saturating_sub(1)..(at + 2).min(of);
    let is_near = |at: usize| {
        let mut cells =
            around(at / across, down).flat_map(|j| around(at % across, across).map(move |i| j * across + i));
        cells.any(|cell| is_marked[cell])
    };
    Marks::new((0..is_marked.len()).map(is_near).collect(), across)
}

/// Part of a texel's width below which a pixel shows each jump of the clamp to the texels nearby.
const CLAMPED: f64 = 0.5;

/// Returns the greatest number of bytes that rings hold for each pixel of a view: none where its filter cannot be sampled.
pub(super) fn most_bytes_a_pixel(lens: &View, resampler: (&World, FilterSettings)) -> usize {
    if is_sampled(lens, resampler) { MOST_SAMPLES * size_of::<Rgba>() + size_of::<Option<Pixel>>() } else { 0 }
}

/// Returns whether a filter's pixels change smoothly from place to place, so that they can be interpolated.
fn is_sampled(lens: &View, (world, filter): (&World, FilterSettings)) -> bool {
    let is_smooth = |section: CrossSection| !matches!(section, CrossSection::Box | CrossSection::Tent);
    let pixel = lens.texel(PixelPoint::new(lens.width() as f64 / 2.0, lens.height() as f64 / 2.0));
    let side = pixel.map_or(0.0, |pixel| pixel.solid_angle().sqrt());
    let jumps = filter.anti_ringing && side < CLAMPED * world.texel_pitch();
    filter.kind == FilterKind::Ewa && is_smooth(filter.kernel.fine) && is_smooth(filter.kernel.coarse) && !jumps
}

/// Returns the frame about an axis with the density that a view's finest pixels need.
fn frame(lens: &View, axis: DVec3, density: [f64; 2], resampler: (&World, FilterSettings)) -> Option<Frame> {
    let middle = PixelPoint::new(lens.width() as f64 / 2.0, lens.height() as f64 / 2.0);
    let towards = lens.direction(middle).map_or(DVec3::ZERO, Direction::vector);
    let across = towards - axis * axis.dot(towards);
    // A view along the axis has no front of its own: what is left of it there is rounding.
    let front = if across.length() > 1e-6 { across.normalize() } else { axis.any_orthonormal_vector() };
    let [right, up, front] = [front.cross(axis), axis, front].map(Direction::from_unit);
    let orientation = Orientation::from_axes(right, up, front);
    let units: Vec<[f64; 2]> = lattice(lens).filter_map(|point| units(lens, point, axis, resampler)).collect();
    let [along, across] = [0, 1].map(|way| density[way] * usual(units.iter().map(|units| units[way])));
    let is_possible = along.is_finite() && across.is_finite() && across > 0.0;
    // A whole number of columns all the way round.
    let along = (TAU * along).ceil().max(1.0) / TAU;
    is_possible.then_some(Frame { orientation, density: [along, across] })
}

/// Returns the units that are enough for most points. Where more are needed, interpolation tells that it is not certain.
fn usual(units: impl Iterator<Item = f64>) -> f64 {
    let mut units: Vec<f64> = units.collect();
    units.sort_by(f64::total_cmp);
    units.get((units.len().saturating_sub(1) as f64 * MOST) as usize).copied().unwrap_or(0.0)
}

/// Returns how many of the kernel's units there are in a radian of longitude and of latitude, at a point of the view.
fn units(lens: &View, point: PixelPoint, axis: DVec3, (world, filter): (&World, FilterSettings)) -> Option<[f64; 2]> {
    let (seen, pixel) = (lens.direction(point)?, lens.texel(point)?);
    let direction = seen.vector();
    let along = direction.cross(axis);
    let (cosine, along) = (along.length(), along.try_normalize()?);
    let texel = world.owner(seen).and_then(|(view, at)| world.sources()[view].view.texel(at));
    // Length of the kernel's unit, in radians, or of what asks for more samples than that.
    let unit = |tangent: DVec3| {
        let pixels = pixel.pseudo_inverse(tangent).map_or(f64::INFINITY, DVec2::length);
        let texels = texel.and_then(|texel| texel.pseudo_inverse(tangent)).map_or(f64::INFINITY, DVec2::length);
        let unit = (filter.kernel.scale / pixels).max(filter.kernel.floor / texels);
        unit.min((unit / LATTICE).max(NEAR / pixels))
    };
    Some([cosine / unit(along), 1.0 / unit(along.cross(direction))])
}
