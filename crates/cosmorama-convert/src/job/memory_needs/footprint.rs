//! Memory for the weights of single pixels that see much of the world.

use cosmorama::camera::View;

use super::size_of_view;

/// Rows of a picture that one thread makes.
const BAND_ROWS: usize = 32;

/// Columns and rows in which pixels are looked at, at most; in small pictures all are.
const ACROSS: usize = 64;

/// Part of the sphere that a pixel's footprint covers, for each steradian of the pixel: it is some forty times as large.
const FOOTPRINT: f64 = 3.2;

/// Bytes of a texel's weight, of its place, and of its indices in mirror images.
const WEIGHT: u64 = 36;

/// Returns the bytes of the weights of texels under a view's largest pixels, one for each thread, of so many texels all around.
pub(super) fn footprint_bytes(texels: u64, view: &View) -> u64 {
    let (width, height) = size_of_view(view);
    let some = |count: usize| (0..count.min(ACROSS)).map(move |index| index * count / count.min(ACROSS));
    let angles = some(height).flat_map(|j| some(width).map(move |i| view.texel_solid_angle(i, j)));
    let largest = angles.fold(0.0, f64::max);
    let part = (FOOTPRINT * largest).min(1.0);
    let threads = height.div_ceil(BAND_ROWS).min(rayon::current_num_threads());
    ((texels as f64 * part) as u64).saturating_mul(WEIGHT).saturating_mul(threads as u64)
}
