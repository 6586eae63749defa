use std::ops::Range;

/// Level of SIMD instructions that lanes use, found once for all of them.
pub(crate) use fearless_simd::Level;

use crate::filter::taps::{Tap, Taps};
use crate::render::scan::patch::Patch;
use crate::render::scan::tile::{LARGEST, SIDE};

/// Number of texels that fit at first. Memory grows when larger windows come.
pub(crate) const ROOM: usize = 256;

/// Magnitude of weights.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Size {
    /// Largest magnitude of a weight.
    pub(crate) largest: f32,
    /// Sum of all magnitudes of a window, in the lane in which it is greatest.
    pub(crate) sum: f32,
}

/// [`SIDE`] neighbouring pixels of a row, each with a window of texels wholly inside one view. All windows have one
/// size, and the weights of each add to one.
#[derive(Clone, Debug)]
pub(crate) struct Windows {
    level: Level,
    width: usize,
    height: usize,
    /// Index of the view that holds the texels.
    view: usize,
    /// Columns of the view in which windows may lie.
    within: Range<u32>,
    /// Index of the view's first texel in the world's buffer, and the distance from one row to the next.
    offset: usize,
    stride: usize,
    /// Column and row of each window's first texel.
    corners: [[u32; 2]; SIDE],
    /// Bits of the windows that lie wholly inside the view. Corners and weights of the others are not valid.
    held: u8,
    pub(crate) weights: Vec<[f32; SIDE]>,
    /// Magnitude of the weights.
    pub(crate) size: Size,
    /// Bits of the lanes in which a texel lies under the pixel.
    pub(crate) under: Vec<u8>,
}

impl Windows {
    /// Makes empty windows.
    pub(crate) fn new(level: Level) -> Self {
        Self {
            level,
            width: 0,
            height: 0,
            view: 0,
            within: 0..0,
            offset: 0,
            stride: 0,
            corners: [[0; 2]; SIDE],
            held: 0,
            weights: vec![[0.0; SIDE]; ROOM],
            size: Size::default(),
            under: vec![0; ROOM],
        }
    }

    /// Returns the level of SIMD instructions that fills the windows.
    pub(crate) fn level(&self) -> Level {
        self.level
    }

    /// Returns whether this lane's window lies inside the view, so that its weights are valid.
    pub(crate) fn holds(&self, lane: usize) -> bool {
        self.held >> lane & 1 == 1
    }

    /// Returns the bits of all lanes whose windows lie inside the view.
    pub(crate) fn held(&self) -> u8 {
        self.held
    }

    /// Returns the column and row of a lane's first texel, if its window is held.
    pub(crate) fn corner(&self, lane: usize) -> Option<[u32; 2]> {
        self.holds(lane).then_some(self.corners[lane])
    }

    /// Returns the index of the view that holds the texels.
    pub(crate) fn view(&self) -> usize {
        self.view
    }

    /// Returns the columns of the view within which all held windows lie.
    pub(crate) fn columns_within(&self) -> Range<u32> {
        self.within.clone()
    }

    /// Returns the number of texels across a window.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of texels down a window.
    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// Returns the weights of all texels of the windows, row by row, a lane for each window.
    pub(crate) fn weights(&self) -> &[[f32; SIDE]] {
        &self.weights[..self.width * self.height]
    }

    /// Returns the magnitude of the weights.
    pub(crate) fn size(&self) -> Size {
        self.size
    }

    /// Returns the bits of the lanes in which each texel lies under its pixel.
    pub(crate) fn under(&self) -> &[u8] {
        &self.under[..self.width * self.height]
    }

    /// Returns the weights of all texels, each with its lanes under the pixel.
    pub(crate) fn texels(&self) -> impl Iterator<Item = (&[f32; SIDE], &u8)> + Clone {
        self.weights().iter().zip(self.under())
    }

    /// Returns the rows in which some window has texels under its pixel, and those between.
    pub(crate) fn rows_under(&self) -> Range<usize> {
        let holds = |row: &usize| self.under[row * self.width..][..self.width].iter().any(|&lanes| lanes != 0);
        let first = (0..self.height).find(holds).unwrap_or(0);
        first..(first..self.height).rev().find(holds).map_or(first, |last| last + 1)
    }

    /// Converts a lane's window to a list of taps.
    pub(crate) fn taps(&self, lane: usize, taps: &mut Taps) {
        taps.clear();
        let Some([left, top]) = self.corner(lane) else { return };
        let first = self.offset + top as usize * self.stride + left as usize;
        let texel = |at: usize| (first + at / self.width * self.stride + at % self.width) as u32;
        let used = self.texels().enumerate().filter(|(_, (weights, _))| weights[lane] != 0.0);
        let settled = used
            .map(|(at, (weights, under))| (under >> lane & 1 == 1, Tap { texel: texel(at), weight: weights[lane] }));
        taps.fill(settled.clone(), settled.clone().count(), settled.filter(|(is_under, _)| *is_under).count());
    }

    /// Places windows of a size, given how far their first texels lie from the patch's origin. Returns whether any is
    /// inside the view.
    pub(crate) fn place(&mut self, patch: &Patch, first: &[[i32; SIDE]; 2], [width, height]: [usize; 2]) -> bool {
        let source = patch.source;
        let whole = &source.whole;
        (self.width, self.height) = (width, height);
        self.within = whole.left as u32..whole.right as u32;
        (self.view, self.offset, self.stride) = (patch.view, source.offset, source.view.width());
        let (columns, rows) = (places(whole.left..whole.right, width), places(whole.top..whole.bottom, height));
        self.held = 0;
        for (lane, corner) in self.corners.iter_mut().enumerate() {
            let [left, top] = [0, 1].map(|axis| patch.origin[axis] + i64::from(first[axis][lane]));
            self.held |= u8::from(columns.contains(&left) & rows.contains(&top)) << lane;
            *corner = [left as u32, top as u32];
        }
        if width * height > LARGEST {
            self.held = 0;
        }
        self.held != 0
    }

    /// Makes room for windows of this number of texels.
    pub(crate) fn make_room(&mut self, texels: usize) {
        if self.weights.len() < texels {
            self.weights.resize(texels, [0.0; SIDE]);
            self.under.resize(texels, 0);
        }
    }
}

/// Returns the positions at which something of this length may begin within a range.
fn places(range: Range<usize>, length: usize) -> Range<i64> {
    range.start as i64..range.end as i64 - length as i64 + 1
}
