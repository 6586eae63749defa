use bytemuck::NoUninit;

use super::band::Band;
use super::span::{Corners, Run};
use super::symmetry::Mirrors;
use super::window_format::Format;
use crate::filter::taps::Taps;
use crate::render::apply::tile_writer::Canvas;
use crate::render::batch::window::Windows;
use crate::render::scan::Sink;
use crate::render::scan::tile::SIDE;
use crate::world::{TexelPlace, World};

/// Recorder of the geometry of a band's pixels.
pub(crate) struct Recorder<'a, F, O> {
    pub(crate) world: &'a World,
    pub(crate) mirrors: &'a Mirrors,
    pub(crate) band: &'a mut Band<F>,
    pub(crate) taps: Taps,
    /// Places of the texels of a single pixel.
    pub(crate) places: Vec<TexelPlace>,
    /// Receiver of windows that need no recording, and of bands that hold much.
    pub(crate) outlet: O,
}

/// Outlet of a recorder.
pub(crate) trait Outlet<F> {
    /// Makes the pixels of windows that have just been weighed; returns false if they are to be recorded.
    fn put_at_once(&mut self, pixel: [usize; 2], lanes: u8, windows: &Windows) -> bool;

    /// Takes a band that holds more than [`MANY`] texels, or more than [`NUMBERS`] of windows; may empty it.
    fn spill(&mut self, band: &mut Band<F>);
}

/// Outlet that only takes bands.
impl<F, P: FnMut(&mut Band<F>)> Outlet<F> for P {
    fn put_at_once(&mut self, _: [usize; 2], _: u8, _: &Windows) -> bool {
        false
    }

    fn spill(&mut self, band: &mut Band<F>) {
        self(band);
    }
}

/// Maker of pixels, from what is recorded of them or at once.
pub(crate) trait Maker<F, P: NoUninit>: Sync {
    /// Working memory of a thread.
    type Memory: Default;

    /// Makes the pixels of a band.
    fn fill(&self, band: &Band<F>, canvas: &mut Canvas<P>);

    /// Makes the pixels of windows that have just been weighed, from this one on, in the lanes whose bit is set. Returns
    /// false if they are to be recorded.
    fn put_at_once(
        &self,
        memory: &mut Self::Memory,
        pixels: ([usize; 2], u8),
        windows: &Windows,
        canvas: &mut Canvas<P>,
    ) -> bool;
}

/// Outlet into a picture.
pub(crate) struct Painter<'a, 'c, M: Maker<F, P>, F, P: NoUninit> {
    pub(crate) maker: &'a M,
    pub(crate) memory: &'a mut M::Memory,
    pub(crate) canvas: &'a mut Canvas<'c, P>,
}

impl<F: Format, P: NoUninit, M: Maker<F, P>> Outlet<F> for Painter<'_, '_, M, F, P> {
    fn put_at_once(&mut self, pixel: [usize; 2], lanes: u8, windows: &Windows) -> bool {
        self.maker.put_at_once(self.memory, (pixel, lanes), windows, self.canvas)
    }

    fn spill(&mut self, band: &mut Band<F>) {
        self.maker.fill(band, self.canvas);
        band.clear();
    }
}

/// Number of texels of single pixels, in all mirror images, above which a band is spilled: what a thread holds stays in
/// its cache. A small picture of a large world may have millions for each pixel.
const MANY: usize = 1 << 14;

/// Number of four-byte numbers of windows' weights above which a band is spilled; a pixel has up to a thousand.
const NUMBERS: usize = 1 << 16;

impl<F: Format, O: Outlet<F>> Sink for Recorder<'_, F, O> {
    fn pixel(&mut self, pixel: [usize; 2], coverage: f32, taps: &Taps) {
        self.single(pixel, coverage, taps);
    }

    fn windows(&mut self, pixel: [usize; 2], lanes: u8, windows: &Windows) {
        let lanes = lanes & windows.held();
        // No window lies wholly inside the view.
        if lanes == 0 || self.outlet.put_at_once(pixel, lanes, windows) {
            return;
        }
        if self.band.weights.len() > NUMBERS && self.band.open_group(pixel, windows.view()).is_empty() {
            self.outlet.spill(self.band);
        }
        let first = self.band.weights.len();
        let mut corners: Corners = std::array::from_fn(|lane| windows.corner(lane).filter(|_| lanes >> lane & 1 == 1));
        let group = self.band.open_group(pixel, windows.view());
        let (index, weights) = (group.len(), group.first().map_or(first, |run| run.weights as usize));
        if self.band.weights.keep(windows, &mut corners, index) {
            if let Some(run) = Run::new(windows, &corners, pixel, weights) {
                self.band.runs.push(run);
                return;
            }
            self.band.weights.truncate(first);
        }
        for lane in (0..SIDE).filter(|&lane| lanes >> lane & 1 == 1) {
            let mut taps = std::mem::take(&mut self.taps);
            windows.taps(lane, &mut taps);
            self.single([pixel[0] + lane, pixel[1]], 1.0, &taps);
            self.taps = taps;
        }
    }
}

impl<F, O: Outlet<F>> Recorder<'_, F, O> {
    /// Adds a single pixel, in all mirror images.
    fn single(&mut self, pixel: [usize; 2], coverage: f32, taps: &Taps) {
        self.band.singles.push((self.world, self.mirrors), pixel, coverage, taps, &mut self.places);
        if self.band.singles.texel_count() > MANY {
            self.outlet.spill(self.band);
        }
    }
}
