use crate::camera::{PixelPoint, PixelRect, View};
use crate::filter::gather::cap::Cap;
use crate::sphere::Direction;

/// Number of pixels along the side of the largest blocks.
const LARGEST: usize = 128;

/// Number of pixels along the side of the smallest blocks.
const SMALLEST: usize = 8;

/// A square of a target's pixels that is examined as a whole where possible, else in parts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    /// Part of the square that lies in the target.
    rect: PixelRect,
    /// Number of pixels along the square's side.
    side: usize,
}

impl Block {
    /// Returns the largest blocks of a target, row by row.
    pub(crate) fn largest(target: &View) -> Vec<Self> {
        let all = PixelRect { left: 0, top: 0, right: target.width(), bottom: target.height() };
        Self::within(all, LARGEST).collect()
    }

    /// Returns the blocks of half the side that make up this one; `None` for a smallest block.
    pub(crate) fn parts(self) -> Option<impl Iterator<Item = Self>> {
        (self.side > SMALLEST).then(|| Self::within(self.rect, self.side / 2))
    }

    fn within(rect: PixelRect, side: usize) -> impl Iterator<Item = Self> {
        let PixelRect { left, top, right, bottom } = rect;
        let block = move |left: usize, top: usize| {
            let rect = PixelRect { left, top, right: (left + side).min(right), bottom: (top + side).min(bottom) };
            Self { rect, side }
        };
        (top..bottom).step_by(side).flat_map(move |top| (left..right).step_by(side).map(move |left| block(left, top)))
    }

    /// Returns the column and row of each pixel.
    pub(crate) fn pixels(self) -> impl Iterator<Item = (usize, usize)> {
        let rect = self.rect;
        (rect.top..rect.bottom).flat_map(move |j| (rect.left..rect.right).map(move |i| (i, j)))
    }

    /// Returns the column and row of a pixel in the middle.
    pub(crate) fn middle(&self) -> (usize, usize) {
        (self.rect.left.midpoint(self.rect.right), self.rect.top.midpoint(self.rect.bottom))
    }

    /// Returns whether the picture ends at the block, or so near that the block's cap may be partly outside.
    pub(crate) fn is_near_border_of(&self, target: &View) -> bool {
        self.has_border_within(self.side / 2, target)
    }

    /// Returns whether the picture ends less than this many pixels away.
    fn has_border_within(&self, pixels: usize, target: &View) -> bool {
        let PixelRect { left, top, right, bottom } = self.rect;
        left < pixels || top < pixels || right + pixels > target.width() || bottom + pixels > target.height()
    }

    /// Returns whether the picture or the field of view ends at the block.
    pub(crate) fn is_at_edge_of(&self, target: &View) -> bool {
        let PixelRect { left, top, right, bottom } = self.rect;
        let hides = |(x, y): (usize, usize)| !target.stop_passes(PixelPoint::new(x as f64, y as f64));
        self.has_border_within(1, target)
            || [(left, top), (right, top), (left, bottom), (right, bottom)].into_iter().any(hides)
    }

    /// Returns whether the target's field stop surely hides all of the block.
    pub(crate) fn is_hidden(&self, target: &View) -> bool {
        let is_below = |side: Direction| self.cap(target).is_some_and(|cap| cap.is_below(side, target));
        target.outline_hides(self.rect) || target.stop.half_space.is_some_and(is_below)
    }

    /// Returns the cap that holds all directions of the block. `None` where part of it has none, or where the cap would
    /// be wide.
    pub(crate) fn cap(&self, target: &View) -> Option<Cap> {
        let (left, right) = (self.rect.left as f64, self.rect.right as f64);
        let (top, bottom) = (self.rect.top as f64, self.rect.bottom as f64);
        let centre = target.direction(PixelPoint::new((left + right) / 2.0, (top + bottom) / 2.0))?;
        let corner = |x, y| target.footprint(PixelPoint::new(x, y));
        Cap::around(centre, &[corner(left, top)?, corner(right, top)?, corner(left, bottom)?, corner(right, bottom)?])
    }
}
