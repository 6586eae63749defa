use super::cap::Cap;
use crate::sphere::Direction;
use crate::world::{PixelPoint, PixelRect, View};

/// Pixels along a block's side.
const SIDE: usize = 16;

/// A square of a target's pixels that is judged as a whole where possible.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block(PixelRect);

impl Block {
    /// The blocks of a target, row by row.
    pub(super) fn all(target: &View) -> Vec<Self> {
        let (width, height) = (target.width(), target.height());
        let block = |left: usize, top: usize| {
            Self(PixelRect { left, top, right: (left + SIDE).min(width), bottom: (top + SIDE).min(height) })
        };
        let tops = (0..height).step_by(SIDE);
        tops.flat_map(|top| (0..width).step_by(SIDE).map(move |left| block(left, top))).collect()
    }

    /// Column and row of each of its pixels.
    pub(super) fn pixels(self) -> impl Iterator<Item = (usize, usize)> {
        let Self(rect) = self;
        (rect.top..rect.bottom).flat_map(move |j| (rect.left..rect.right).map(move |i| (i, j)))
    }

    /// Whether the frame ends here, or the field of view.
    pub(super) fn is_at_edge_of(&self, target: &View) -> bool {
        let Self(PixelRect { left, top, right, bottom }) = *self;
        let ends = left == 0 || top == 0 || right == target.width() || bottom == target.height();
        let hides = |(x, y): (usize, usize)| !target.stop_passes(PixelPoint::new(x as f64, y as f64));
        ends || [(left, top), (right, top), (left, bottom), (right, bottom)].into_iter().any(hides)
    }

    /// Whether the target's field stop surely hides all of the block.
    pub(super) fn is_hidden(&self, target: &View) -> bool {
        let (start, end) = (
            target.grid.to_plane(PixelPoint::new(self.0.left as f64, self.0.top as f64)),
            target.grid.to_plane(PixelPoint::new(self.0.right as f64, self.0.bottom as f64)),
        );
        let nearest = |a: f64, b: f64| if a * b <= 0.0 { 0.0 } else { a.abs().min(b.abs()) };
        let distance = nearest(start.x, end.x).hypot(nearest(start.y, end.y));
        let is_below = |side: Direction| self.cap(target).is_some_and(|cap| cap.is_below(side, target));
        target.stop.circle.is_some_and(|radius| distance > radius) || target.stop.half_space.is_some_and(is_below)
    }

    /// The cap that holds all directions of the block; `None` where part of it has none, or where it is wide.
    pub(super) fn cap(&self, target: &View) -> Option<Cap> {
        let (left, right) = (self.0.left as f64, self.0.right as f64);
        let (top, bottom) = (self.0.top as f64, self.0.bottom as f64);
        let centre = target.direction(PixelPoint::new((left + right) / 2.0, (top + bottom) / 2.0))?;
        let corner = |x, y| target.footprint(PixelPoint::new(x, y));
        Cap::around(centre, &[corner(left, top)?, corner(right, top)?, corner(left, bottom)?, corner(right, bottom)?])
    }
}
