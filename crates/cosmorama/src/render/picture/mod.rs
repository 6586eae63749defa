//! Pictures made without a plan: pixel by pixel, or by two passes.

pub(super) mod two_pass;

use rayon::prelude::*;

use crate::camera::View;
use crate::filter::Prepared;
use crate::raster::{Image, Rgba};

/// Makes a picture by any filter, pixel by pixel: the average of each footprint, times the part that the field of view
/// covers.
///
/// [`Resampler`](super::Resampler) makes the same pictures faster, by the filters of
/// [`FilterKind`](crate::filter::FilterKind). The two differ beside the edge of the target's field of view: there a
/// `Resampler` leaves out texels that no part of the field falls on.
pub fn picture(prepared: &dyn Prepared, target: &View) -> Image<Rgba> {
    let mut image = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
    image.pixels_mut().par_chunks_mut(target.width().max(1)).enumerate().for_each(|(j, row)| {
        fill_row(prepared, target, (j, row));
    });
    image
}

/// Makes the pixels of a row.
pub(super) fn fill_row(prepared: &dyn Prepared, target: &View, (j, row): (usize, &mut [Rgba])) {
    for (i, pixel) in row.iter_mut().enumerate() {
        if let Some(screen) = target.screen_pixel(i, j) {
            *pixel = prepared.average(&screen.footprint) * screen.coverage as f32;
        }
    }
}
