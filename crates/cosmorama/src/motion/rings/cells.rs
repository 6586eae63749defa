use rayon::prelude::*;

use crate::camera::{FieldStop, PixelPoint, View};
use crate::sphere::{Direction, Orientation};

/// Pixels along a cell's side.
pub(super) const SIDE: usize = 8;

/// Greatest error of an interpolated place, in samples.
const ERROR: f64 = 1.0 / 1024.0;

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
    /// Quadratic, through those of the first pixels of this cell and its neighbours to the right and below, and those half way
    /// between them, row by row. All pixels are whole.
    Even([[[f64; 2]; 3]; 3]),
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
        self.cells.iter().filter_map(Cell::bounds).reduce(joined)
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
        let mut knots = [[[0.0; 2]; 3]; 3];
        for (k, knot) in knots.as_flattened_mut().iter_mut().enumerate() {
            *knot = place((k % 3) as f64 / 2.0, (k / 3) as f64 / 2.0)?;
        }
        for (x, y) in [(0.2, 0.2), (0.8, 0.2), (0.2, 0.8), (0.8, 0.8)] {
            let (exact, near) = (place(x, y)?, quadratic(&knots.map(|row| quadratic(&row, x)), y));
            if (exact[0] - near[0]).abs() > ERROR || (exact[1] - near[1]).abs() > ERROR {
                return None;
            }
        }
        Some(Self::Even(knots))
    }

    /// Returns the pixels of a row of the cell; `None` for those that show nothing.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> [Option<Pixel>; SIDE] {
        match self {
            Self::Even(knots) => {
                let y = row as f64 / SIDE as f64;
                let across = [0, 1, 2].map(|column| quadratic(&[0, 1, 2].map(|row| knots[row][column]), y));
                let place = |column: usize| quadratic(&across, column as f64 / SIDE as f64);
                std::array::from_fn(|column| Some(Pixel { place: place(column), coverage: 1.0 }))
            }
            Self::Single(pixels) => std::array::from_fn(|column| pixels[row * SIDE + column]),
        }
    }

    /// Returns the least and the greatest coordinates of its places.
    pub(super) fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let of = |places: &mut dyn Iterator<Item = [f64; 2]>| places.map(|place| [place; 2]).reduce(joined);
        match self {
            // Between its points, a quadratic goes beyond them by an eighth of its second difference at most, in each direction.
            Self::Even(knots) => {
                let bend =
                    |[a, b, c]: [[f64; 2]; 3]| [0, 1].map(|axis| (a[axis] - 2.0 * b[axis] + c[axis]).abs() / 4.0);
                let bends = [0, 1, 2].map(|k| [bend(knots[k]), bend(knots.map(|row| row[k]))]);
                let most = [0, 1].map(|axis| bends.as_flattened().iter().map(|bend| bend[axis]).fold(0.0, f64::max));
                let wide = |&[x, y]: &[f64; 2]| [[x - most[0], y - most[1]], [x + most[0], y + most[1]]];
                knots.as_flattened().iter().map(wide).reduce(joined)
            }
            Self::Single(pixels) => of(&mut pixels.iter().flatten().map(|pixel| pixel.place)),
        }
    }
}

/// Returns the quadratic through three places, from the first (0) by the middle one to the last (1).
#[inline(always)]
fn quadratic(places: &[[f64; 2]; 3], t: f64) -> [f64; 2] {
    let weights = [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
    [0, 1].map(|axis| weights.iter().zip(places).map(|(weight, place)| weight * place[axis]).sum())
}

fn joined([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[a[0].min(c[0]), a[1].min(c[1])], [b[0].max(d[0]), b[1].max(d[1])]]
}
