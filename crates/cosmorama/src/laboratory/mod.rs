//! The filter laboratory: filters on one conversion, measured by error, aliasing, blur and cost.
//!
//! PSNR alone mixes two faults. A filter that lets through what a picture cannot hold (aliasing) may score as well as one
//! that takes away what it could (blur). So [`Laboratory`] measures both apart, on a test pattern in the target's own
//! pixels, and shows what they look like by crops side by side.

mod crops;
mod edge_spread;
pub mod figures;
mod pattern;
mod sheet;
mod zone_plate;

use crate::camera::{Footprint, View};
use crate::compare::{CompareError, Mask, linear_difference};
use crate::filter::{FilterSettings, Prepared, semi_axes};
use crate::raster::{Image, Rgba};
use crate::render::{Progress, Resampler, Stopped};
use crate::world::{Light, World};

pub use crops::{CROP, Crop, busiest};
pub use sheet::{Row, sheet};

use pattern::{Pattern, Probe};

/// One conversion on which filters are measured.
pub struct Laboratory<'a> {
    world: &'a World,
    light: &'a Light,
    target: &'a View,
    /// Pixels that are whole.
    whole: Mask,
    /// Light of the test pattern.
    pattern: Light,
    /// Pixels of the test pattern that are measured.
    probes: Vec<Probe>,
}

/// Response of a filter to the test pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Energy that is left of gratings of up to one cycle a pixel that a picture cannot hold, of more than half a cycle a pixel
    /// along rows or along columns, in decibels relative to the gratings' own: 0 is all of it. `None` where the texels hold no such
    /// gratings: a pixel must have more than one texel each way.
    pub aliasing: Option<f64>,
    /// Width in pixels over which an edge goes from 10 % to 90 %. `None` where the picture is too small for edges, or an
    /// edge takes over six pixels to either side.
    pub edge_width: Option<f64>,
}

impl<'a> Laboratory<'a> {
    /// Prepares a conversion: makes the test pattern, and finds the pixels that count.
    pub fn new((world, light): (&'a World, &'a Light), target: &'a View) -> Self {
        let is_whole = |i, j| target.screen_pixel(i, j).is_some_and(|pixel| pixel.coverage == 1.0);
        let whole = Mask::from_fn(target.width(), target.height(), is_whole);
        let pattern = Pattern::over(target);
        let probes = pattern.probes(world, &whole);
        Self { world, light, target, whole, pattern: pattern.light(world), probes }
    }

    /// Returns the bytes that a conversion takes beside the world, its light and the pictures.
    pub fn bytes(world: &World, target: &View) -> usize {
        world.texel_count() * size_of::<Rgba>() + target.width() * target.height() * size_of::<Probe>()
    }

    /// Makes the picture by a filter.
    ///
    /// # Errors
    /// If the work is stopped.
    pub fn picture(&self, filter: &FilterSettings, progress: &dyn Progress) -> Result<Image<Rgba>, Stopped> {
        self.render(filter, self.light, progress)
    }

    /// Measures aliasing and blur of a filter.
    ///
    /// # Errors
    /// If the work is stopped.
    pub fn response(&self, filter: &FilterSettings, progress: &dyn Progress) -> Result<Response, Stopped> {
        let image = self.render(filter, &self.pattern, progress)?;
        Ok(Response {
            aliasing: zone_plate::aliasing(&self.probes, &image),
            edge_width: edge_spread::width(&self.probes, &image),
        })
    }

    /// Returns the mean number of texels, or of entries of tables, that a filter reads for a pixel, over a grid of pixels.
    pub fn reads(&self, prepared: &dyn Prepared) -> f64 {
        let footprints: Vec<Footprint> = self.footprints().collect();
        let sum: usize = footprints.iter().map(|footprint| prepared.reads(footprint)).sum();
        sum as f64 / footprints.len().max(1) as f64
    }

    /// Returns a number of sub-samples along a pixel's side for the reference: two for each texel of the longest pixel of a
    /// grid, so that none is missed, but at least 4 and at most 32.
    pub fn samples(&self) -> usize {
        let texels = |footprint: Footprint| {
            let (view, _) = self.world.owner(footprint.direction)?;
            let (_, jacobian) = self.world.sources()[view].view.texel_footprint(&footprint)?;
            Some(semi_axes(jacobian)[0])
        };
        let longest = self.footprints().filter_map(texels).fold(0.0, f64::max);
        ((2.0 * longest).ceil() as usize).clamp(4, 32)
    }

    /// Returns the footprints of a grid of pixels.
    fn footprints(&self) -> impl Iterator<Item = Footprint> {
        /// Pixels along a side of the grid.
        const SIDE: usize = 32;
        let at = |k: usize, size: usize| (2 * k + 1) * size / (2 * SIDE);
        let pixels =
            (0..SIDE * SIDE).map(move |k| (at(k % SIDE, self.target.width()), at(k / SIDE, self.target.height())));
        pixels.filter_map(|(i, j)| Some(self.target.screen_pixel(i, j)?.footprint))
    }

    /// Returns the world.
    pub fn world(&self) -> &World {
        self.world
    }

    /// Returns the world's light.
    pub fn light(&self) -> &Light {
        self.light
    }

    /// Returns the PSNR of linear light between two pictures, over whole pixels.
    ///
    /// # Errors
    /// When a picture has another size than the target, or no pixel is whole.
    pub fn psnr(&self, picture: &Image<Rgba>, to: &Image<Rgba>) -> Result<f64, CompareError> {
        Ok(linear_difference(picture, to, &self.whole)?.psnr)
    }

    /// Returns whether a pixel is whole.
    pub fn is_whole(&self, i: usize, j: usize) -> bool {
        self.whole.row(j)[i]
    }

    fn render(&self, filter: &FilterSettings, light: &Light, progress: &dyn Progress) -> Result<Image<Rgba>, Stopped> {
        Resampler { world: self.world, target: self.target, filter: *filter }.watched(progress).render(light.texels())
    }
}
