//! Filters of Table 1 of Greene & Heckbert 1986, beside EWA: each as its own paper has it, over a footprint of a world.
//!
//! They are slow and plain, and serve to be compared. Each averages one footprint after the other, across the edges of
//! views as far as its method goes.

mod blinn_newell;
mod catmull;
mod ewa_integer;
mod ewa_paper;
mod feibush_levoy_cook;
mod gangnet;
mod prefiltered;
mod region;
mod screen_kernel;
mod two_pass;

pub use prefiltered::MipChoice;

use std::ops::RangeInclusive;

use super::Kernel;
use super::ewa_pyramid::Levels;
use super::traits::{Filter, PrepareError, Prepared, SetupCost};
use crate::raster::Rgba;
use crate::world::{Light, World};
use prefiltered::{PreparedIntegrals, PreparedMipMap, PreparedSummedArea, bits_of};
use region::{Weighed, Weighing};
use screen_kernel::ScreenKernel;

/// A filter of the literature that EWA is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Classic {
    /// Squares averaged beforehand, on levels of a pyramid (Dungan, Stenger & Sutty 1978; Williams 1983).
    MipMap(MipChoice),
    /// Rectangles by a table of sums (Crow 1984).
    SummedArea,
    /// Smooth splines over an upright box, by differences in a picture that is integrated `order` times (Perlin; Heckbert
    /// 1986).
    RepeatedIntegration {
        /// Number of boxes that are applied, of [`Classic::ORDERS`]: 1 is a rectangle, 2 a pyramid, 3 nearly a Gaussian.
        order: u32,
    },
    /// Exact areas under the pixel's parallelogram, evenly weighted (Catmull 1974).
    Catmull,
    /// A pyramid over the parallelogram of the pixels around (Blinn & Newell 1976).
    BlinnNewell,
    /// Texels mapped to the screen, and weighed there by a round kernel (Feibush, Levoy & Cook 1980).
    FeibushLevoyCook,
    /// Samples of the screen mapped to the texels, in a round kernel (Gangnet, Perny & Coueignoux 1982).
    Gangnet,
    /// Two passes of one dimension each, along the rows and along the columns (Catmull & Smith 1980).
    TwoPass,
    /// EWA as printed, with a Gaussian and finite differences (Greene & Heckbert 1986).
    EwaPaper,
    /// EWA in integers, as the paper proposes.
    EwaInteger,
}

impl Classic {
    /// Orders of repeated integration.
    pub const ORDERS: RangeInclusive<u32> = 1..=4;

    /// Usual order of repeated integration.
    pub const USUAL_ORDER: u32 = 2;

    /// All filters, in the order of the paper's table; repeated integration is of its usual order.
    pub const ALL: [Self; 11] = [
        Self::MipMap(MipChoice::Nearest),
        Self::MipMap(MipChoice::Trilinear),
        Self::SummedArea,
        Self::RepeatedIntegration { order: Self::USUAL_ORDER },
        Self::Catmull,
        Self::BlinnNewell,
        Self::FeibushLevoyCook,
        Self::Gangnet,
        Self::TwoPass,
        Self::EwaPaper,
        Self::EwaInteger,
    ];

    /// Bits that must be kept of the brightest texel's light, times its solid angle.
    pub(crate) const LEAST_BITS: u32 = 24;

    /// Checks that the filter loses no precision over a world.
    ///
    /// # Errors
    /// For repeated integration of an order that there is not, or over a view that is too large for its order.
    pub fn check(self, world: &World) -> Result<(), PrepareError> {
        let Self::RepeatedIntegration { order } = self else { return Ok(()) };
        if !Self::ORDERS.contains(&order) {
            return Err(PrepareError::NoSuchOrder { found: order });
        }
        let lost = world.sources().iter().find(|source| bits_of(source, order) < Self::LEAST_BITS);
        lost.map_or(Ok(()), |source| {
            Err(PrepareError::LosesPrecision {
                order,
                size: [source.columns(), source.view.height()],
                bits: bits_of(source, order),
            })
        })
    }

    /// A kernel that reaches all texels that any of the filters reads for a pixel: the coarser of two levels has texels of
    /// two pixels, and is interpolated over one more.
    pub(crate) const REACH: Kernel = Kernel { scale: 2.0, ..Kernel::ADAPTIVE };

    /// Prepares the filter for texels in the order of a world's light, all of them finite.
    pub(crate) fn of_texels<'w>(self, world: &'w World, light: &'w [Rgba]) -> Box<dyn Prepared + 'w> {
        let kernel = ScreenKernel::new;
        match self {
            Self::MipMap(choice) => Box::new(PreparedMipMap { levels: Levels::new(world, light), choice }),
            Self::SummedArea => Box::new(PreparedSummedArea::new(world, light)),
            Self::RepeatedIntegration { order } => Box::new(PreparedIntegrals::new(world, light, order)),
            Self::TwoPass => over(world, light, two_pass::TwoPass(kernel())),
            Self::Catmull => over(world, light, catmull::Catmull),
            Self::BlinnNewell => over(world, light, blinn_newell::BlinnNewell),
            Self::FeibushLevoyCook => over(world, light, feibush_levoy_cook::FeibushLevoyCook(kernel())),
            Self::Gangnet => over(world, light, gangnet::Gangnet(kernel())),
            Self::EwaPaper => over(world, light, ewa_paper::EwaPaper(kernel())),
            Self::EwaInteger => over(world, light, ewa_integer::EwaInteger::new(&kernel())),
        }
    }
}

impl Filter for Classic {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        self.check(world)?;
        Ok(self.of_texels(world, light.texels()))
    }

    fn setup(&self, world: &World) -> SetupCost {
        let texels = world.texel_count();
        match self {
            Self::MipMap(_) => SetupCost { texels, bytes: Levels::bytes(world) },
            Self::SummedArea => SetupCost { texels, bytes: PreparedSummedArea::bytes(world) },
            Self::RepeatedIntegration { order } => SetupCost { texels, bytes: PreparedIntegrals::bytes(world, *order) },
            Self::Catmull
            | Self::BlinnNewell
            | Self::FeibushLevoyCook
            | Self::Gangnet
            | Self::TwoPass
            | Self::EwaPaper
            | Self::EwaInteger => SetupCost::default(),
        }
    }
}

fn over<'w, W: Weighing + 'w>(world: &'w World, light: &'w [Rgba], weighing: W) -> Box<dyn Prepared + 'w> {
    Box::new(Weighed { world, light, weighing })
}
