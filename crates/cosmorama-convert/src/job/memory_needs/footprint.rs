//! Memory for the weights of single pixels that see much of the world.

use cosmorama::camera::{PixelPoint, View};
use cosmorama::sphere::Direction;

use super::size_of_view;
use crate::input::Input;
use crate::source::memory_budget::area;

/// Rows of a picture that one thread makes.
const BAND_ROWS: usize = 32;

/// Columns and rows in which a picture's pixels are measured, at most; in small pictures all are.
const MEASURED: usize = 64;

/// Columns and rows of pixels under which texels are counted, at most. Footprints are wider than the steps between these.
const COUNTED: usize = 24;

/// Number of bunches of all texels, of which each view has one at least.
const BUNCHES: usize = 48 * 48;

/// Square of a footprint's radius in the tangent plane, for each steradian of its pixel: some 1.9 pixels.
const FOOTPRINT: f64 = 3.6;

/// Bytes of a texel's weight, of its place, and of its indices in mirror images, with the room into which their lists grow.
const WEIGHT: f64 = 90.0;

/// Bytes of weights that need no closer look: at a pole of a panorama, where texels crowd, they are a hundred times as many.
const FEW: f64 = (1 << 14) as f64;

/// Texels of an input, in bunches. They crowd around the poles of a panorama, so that a footprint there has more of them than
/// its part of the sphere.
pub(crate) struct Crowd {
    texels: f64,
    /// Directions of bunches, and the number of texels in each.
    bunches: Vec<(Direction, f64)>,
}

impl Crowd {
    /// Counts the texels of the files that are read.
    pub(crate) fn of(input: &Input) -> Self {
        let views = input.present().count();
        let across = (1..BUNCHES).take_while(|across| across * across * views <= BUNCHES).last().unwrap_or(1);
        let bunches = input.present().flat_map(|(.., view)| bunches(view, across)).collect();
        Self { texels: input.texels() as f64, bunches }
    }

    /// Returns the bytes of the weights of texels under the largest pixels of these views, one for each thread.
    pub(crate) fn footprint_bytes<'v>(&self, views: impl Iterator<Item = &'v View>) -> u64 {
        views.map(|view| self.bytes_of(view)).max().unwrap_or(0)
    }

    fn bytes_of(&self, view: &View) -> u64 {
        let threads = view.height().div_ceil(BAND_ROWS).min(rayon::current_num_threads());
        let square = |(i, j)| (FOOTPRINT * view.texel_solid_angle(i, j)).min(1.0);
        // A cap of a small radius is a quarter of its square of the sphere, where texels lie evenly.
        let even = self.texels * pixels(view, MEASURED).map(square).fold(0.0, f64::max) / 4.0;
        let count = |(i, j)| direction(view, i, j).map_or(0.0, |centre| self.count(centre, square((i, j))));
        let most = if even * WEIGHT < FEW { even } else { pixels(view, COUNTED).map(count).fold(even, f64::max) };
        ((most * WEIGHT) as u64).saturating_mul(threads as u64)
    }

    /// Returns the number of texels in a cap around a direction, whose shadow on the tangent plane has a radius of such a square: in half
    /// of the sphere at most, as filters see it.
    fn count(&self, centre: Direction, square: f64) -> f64 {
        let is_inside = |direction: &Direction| {
            let cosine = direction.dot(centre);
            cosine >= 0.0 && 1.0 - cosine * cosine <= square
        };
        self.bunches.iter().filter(|(direction, _)| is_inside(direction)).map(|(_, texels)| texels).sum()
    }
}

/// Returns the bunches of a view's texels, in so many columns and rows at most.
fn bunches(view: &View, across: usize) -> impl Iterator<Item = (Direction, f64)> {
    let (width, height) = size_of_view(view);
    let texels = area((width, height)) as f64 / (width.min(across) * height.min(across)) as f64;
    pixels(view, across).filter_map(move |(i, j)| Some((direction(view, i, j)?, texels)))
}

/// Returns evenly spread pixels of a view, in so many columns and rows at most.
fn pixels(view: &View, across: usize) -> impl Iterator<Item = (usize, usize)> {
    let some = move |count: usize| {
        let across = count.min(across);
        (0..across).map(move |index| (2 * index + 1) * count / (2 * across))
    };
    let (width, height) = size_of_view(view);
    some(height).flat_map(move |j| some(width).map(move |i| (i, j)))
}

fn direction(view: &View, i: usize, j: usize) -> Option<Direction> {
    view.direction(PixelPoint::centre(i, j))
}
