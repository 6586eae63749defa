use rayon::prelude::*;

use crate::camera::{FieldStop, PixelPoint, View};
use crate::sphere::{Direction, Orientation};

/// Pixels along a cell's side.
pub(super) const SIDE: usize = 8;

/// Greatest error of an interpolated place, in samples.
const ERROR: f64 = 1.0 / 64.0;

/// Frame about an axis, with a density of samples: a place is a longitude and a latitude, counted in samples to the right and
/// down from the front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Orientation whose up is the axis.
    pub(super) orientation: Orientation,
    /// Samples per radian of longitude, and of latitude.
    pub(super) density: [f64; 2],
}

/// Places of a target's pixels, in cells of 8 × 8.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    pub(super) across: usize,
    pub(super) cells: Vec<Cell>,
}

/// Places of the pixels of a cell.
#[derive(Clone, Debug)]
pub(super) enum Cell {
    /// Interpolated between those of the first pixels of this cell, the next, the one below, and that after it. All pixels are
    /// whole.
    Even([[f64; 2]; 4]),
    /// Computed one by one, row by row; `None` for pixels that show nothing.
    Single(Box<[Option<Pixel>; SIDE * SIDE]>),
}

/// A pixel: its place, and the part of it inside the field of view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    pub(super) place: [f64; 2],
    pub(super) coverage: f32,
}

impl Frame {
    pub(super) fn place(&self, direction: Direction) -> [f64; 2] {
        let seen = self.orientation.to_view(direction).vector();
        let (longitude, latitude) = (seen.x.atan2(-seen.z), seen.y.clamp(-1.0, 1.0).asin());
        [longitude * self.density[0], -latitude * self.density[1]]
    }
}

impl Cells {
    /// Finds the places of all pixels of a view.
    pub(super) fn of(view: &View, frame: &Frame) -> Self {
        let (across, down) = (view.width().div_ceil(SIDE), view.height().div_ceil(SIDE));
        let cell = |at: usize| Cell::of((view, frame), [at % across * SIDE, at / across * SIDE]);
        Self { across, cells: (0..across * down).into_par_iter().map(cell).collect() }
    }

    /// Returns the least and the greatest coordinates of all places.
    pub(super) fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        self.cells.iter().filter_map(Cell::bounds).reduce(|a, b| joined(a, b))
    }
}

impl Cell {
    fn of((view, frame): (&View, &Frame), [left, top]: [usize; 2]) -> Self {
        Self::even((view, frame), [left, top]).unwrap_or_else(|| {
            let pixel = |at: usize| {
                let (i, j) = (left + at % SIDE, top + at / SIDE);
                let screen = if i < view.width() && j < view.height() { view.screen_pixel(i, j) } else { None }?;
                Some(Pixel { place: frame.place(screen.footprint.direction), coverage: screen.coverage as f32 })
            };
            Self::Single(Box::new(std::array::from_fn(pixel)))
        })
    }

    /// Returns the cell with this first pixel, if places are almost linear in it, and nothing ends there.
    fn even((view, frame): (&View, &Frame), [left, top]: [usize; 2]) -> Option<Self> {
        let side = SIDE as f64;
        let point = |x: f64, y: f64| PixelPoint::new(left as f64 + 0.5 + x * side, top as f64 + 0.5 + y * side);
        if view.stop != FieldStop::NONE {
            // From a pixel beside the cell on: the stop is almost straight along it.
            let around = [(-0.2, -0.2), (1.2, -0.2), (-0.2, 1.2), (1.2, 1.2)];
            if !around.iter().all(|&(x, y)| view.stop_passes(point(x, y))) {
                return None;
            }
        }
        let place = |x: f64, y: f64| Some(frame.place(view.direction(point(x, y))?));
        let corners = [place(0.0, 0.0)?, place(1.0, 0.0)?, place(0.0, 1.0)?, place(1.0, 1.0)?];
        for (x, y) in [(0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (1.0, 0.5), (0.5, 1.0)] {
            let (exact, near) = (place(x, y)?, between(&corners, x, y));
            if (exact[0] - near[0]).abs() > ERROR || (exact[1] - near[1]).abs() > ERROR {
                return None;
            }
        }
        Some(Self::Even(corners))
    }

    /// Returns a pixel of the cell; `None` if it shows nothing.
    #[inline(always)]
    pub(super) fn pixel(&self, column: usize, row: usize) -> Option<Pixel> {
        match self {
            Self::Even(corners) => {
                let place = between(corners, column as f64 / SIDE as f64, row as f64 / SIDE as f64);
                Some(Pixel { place, coverage: 1.0 })
            }
            Self::Single(pixels) => pixels[row * SIDE + column],
        }
    }

    /// Returns the least and the greatest coordinates of its places.
    pub(super) fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let of = |places: &mut dyn Iterator<Item = [f64; 2]>| places.map(|place| [place; 2]).reduce(joined);
        match self {
            Self::Even(corners) => of(&mut corners.iter().copied()),
            Self::Single(pixels) => of(&mut pixels.iter().flatten().map(|pixel| pixel.place)),
        }
    }
}

/// Interpolates between the corners of a cell.
#[inline(always)]
fn between(corners: &[[f64; 2]; 4], x: f64, y: f64) -> [f64; 2] {
    [0, 1].map(|axis| {
        let [a, b, c, d] = corners.map(|corner| corner[axis]);
        let (above, below) = (a + (b - a) * x, c + (d - c) * x);
        above + (below - above) * y
    })
}

fn joined([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[a[0].min(c[0]), a[1].min(c[1])], [b[0].max(d[0]), b[1].max(d[1])]]
}
