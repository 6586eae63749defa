use super::band::Band;
use super::span::{Corners, Run};
use super::symmetry::Mirrors;
use super::window_format::Format;
use crate::filter::taps::Taps;
use crate::render::batch::window::Windows;
use crate::render::scan::Sink;
use crate::render::scan::tile::SIDE;
use crate::world::{TexelPlace, World};

/// Recorder of the geometry of a band's pixels.
pub(crate) struct Recorder<'a, F, P> {
    pub(crate) world: &'a World,
    pub(crate) mirrors: &'a Mirrors,
    pub(crate) band: &'a mut Band<F>,
    pub(crate) taps: Taps,
    /// Places of the texels of a single pixel.
    pub(crate) places: Vec<TexelPlace>,
    /// Handler of a band that holds more than [`MANY`] texels, or more than [`NUMBERS`] of windows.
    pub(crate) spill: P,
}

/// Number of texels of single pixels, in all mirror images, above which a band is spilled. A small picture of a large
/// world may have millions for each pixel.
const MANY: usize = 1 << 17;

/// Number of four-byte numbers of windows' weights above which a band is spilled; a pixel has up to a thousand.
const NUMBERS: usize = 1 << 20;

impl<F: Format, P: FnMut(&mut Band<F>)> Sink for Recorder<'_, F, P> {
    fn pixel(&mut self, pixel: [usize; 2], coverage: f32, taps: &Taps) {
        self.single(pixel, coverage, taps);
    }

    fn windows(&mut self, pixel: [usize; 2], lanes: u8, windows: &Windows) {
        let lanes = lanes & windows.held();
        // No window lies wholly inside the view.
        if lanes == 0 {
            return;
        }
        if self.band.weights.len() > NUMBERS && self.band.open_group(pixel, windows.view()).is_empty() {
            (self.spill)(self.band);
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

impl<F, P: FnMut(&mut Band<F>)> Recorder<'_, F, P> {
    /// Adds a single pixel, in all mirror images.
    fn single(&mut self, pixel: [usize; 2], coverage: f32, taps: &Taps) {
        self.band.singles.push((self.world, self.mirrors), pixel, coverage, taps, &mut self.places);
        if self.band.singles.texel_count() > MANY {
            (self.spill)(self.band);
        }
    }
}
