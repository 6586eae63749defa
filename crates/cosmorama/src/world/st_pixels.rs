use rayon::prelude::*;

use super::World;
use crate::camera::{Canvas, View};
use crate::raster::Image;
use crate::sphere::Direction;

/// A pixel of an st map: s to the right, t up, and the fraction of the pixel that shows something.
pub type StPixel = [f32; 3];

/// A pixel of an st map that shows nothing: a place outside the picture.
pub const ST_NOWHERE: StPixel = [-1.0, -1.0, 0.0];

impl World {
    /// Returns the place in one image at which each pixel of a target looks. `canvases` gives the part of that image
    /// that each view is.
    pub fn st_pixels(&self, target: &View, canvases: &[Canvas]) -> Image<StPixel> {
        let mut image = Image::filled(target.width(), target.height(), ST_NOWHERE);
        image.pixels_mut().par_chunks_mut(target.width()).enumerate().for_each(|(j, row)| {
            for (i, numbers) in row.iter_mut().enumerate() {
                let Some(pixel) = target.screen_pixel(i, j) else { continue };
                if let Some([s, t]) = self.place_in(canvases, pixel.footprint.direction) {
                    *numbers = [s as f32, t as f32, pixel.coverage as f32];
                }
            }
        });
        image
    }

    /// Returns the place of a direction in the whole image, from (0, 0) at its lower left corner to (1, 1).
    fn place_in(&self, canvases: &[Canvas], direction: Direction) -> Option<[f64; 2]> {
        let (index, pixel) = self.owner(direction)?;
        let Canvas { width, height, left, top } = canvases.get(index)?;
        let (x, y) = (pixel.x + *left as f64, pixel.y + *top as f64);
        Some([x / *width as f64, 1.0 - y / *height as f64])
    }
}
