//! Detection of the oval that Hammer's, Mollweide's and the sinusoidal map fill or touch.

use cosmorama::raster::{Image, Rgba};

use crate::detect::pixels::is_blank;
use crate::detect::pixels::{BLACK, BLOCK};

/// Squared distances from the middle, as fractions of the oval, that are just inside it at its four ends.
const INSIDE: std::ops::Range<f64> = 0.81..0.94;
/// Greatest distance of an end from an axis, as a fraction of the oval.
const END: f64 = 0.1;

/// Returns whether a picture twice as wide as high has one colour around an oval that fills it, and other colours at
/// the oval's ends. A panorama whose sky and ground have one colour does not qualify.
pub(crate) fn is_oval(codes: &Image<Rgba>) -> bool {
    let (width, height) = (codes.width(), codes.height());
    // Place of a pixel in an oval that is so many pixels larger on each side.
    let at = |i: usize, j: usize, larger: usize| {
        let part = |k: usize, size: usize| (2 * k + 1) as f64 - size as f64;
        (part(i, width) / (width + 2 * larger) as f64, part(j, height) / (height + 2 * larger) as f64)
    };
    let around = codes.uniformity(|i, j| {
        let (x, y) = at(i, j, BLOCK);
        x * x + y * y > 1.0
    });
    let Some(around) = around.filter(|around| width == 2 * height && is_blank(Some(*around))) else { return false };
    let is_alike = |pixel: &Rgba| pixel.0.iter().zip(around.colour.0).all(|(a, b)| (a - b).abs() <= BLACK);
    let mut ends = [[0_usize; 2]; 4];
    for (j, i) in (0..height).flat_map(|j| (0..width).map(move |i| (j, i))) {
        let (x, y) = at(i, j, 0);
        let end = match (x.abs() < END, y.abs() < END) {
            (true, false) => usize::from(y > 0.0),
            (false, true) => 2 + usize::from(x > 0.0),
            _ => continue,
        };
        if INSIDE.contains(&(x * x + y * y)) {
            ends[end][usize::from(is_alike(codes.get(i, j)))] += 1;
        }
    }
    ends.iter().all(|[other, alike]| other > alike)
}
