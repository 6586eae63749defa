use cosmorama::camera::View;
use cosmorama::raster::Image;
use rayon::prelude::*;

/// A map of the direction of each pixel of a view, through which other programs can use our geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DirectionMap {
    /// Whether it also holds the footprint: the change of the direction from pixel to pixel.
    pub footprint: bool,
}

/// Values of a pixel: its direction, and the change for one pixel to the right and one down; x, y and z of each.
pub type DirectionPixel = [f32; 9];

/// Names of the values, in their order.
const CHANNELS: [&str; 9] =
    ["direction.X", "direction.Y", "direction.Z", "dx.X", "dx.Y", "dx.Z", "dy.X", "dy.Y", "dy.Z"];

impl DirectionMap {
    /// Returns the names of the channels, in the order of a pixel's values.
    pub fn channels(self) -> &'static [&'static str] {
        if self.footprint { &CHANNELS } else { &CHANNELS[..3] }
    }

    /// Computes the map of a view: unit vectors in the world's frame (+X right, +Y up, −Z front) at each pixel's
    /// centre, and their derivatives per pixel, in radians. Pixels whose centre shows nothing are zero, which no
    /// direction is.
    pub fn pixels(self, view: &View) -> Image<DirectionPixel> {
        let mut image = Image::filled(view.width(), view.height(), [0.0; 9]);
        image.pixels_mut().par_chunks_mut(view.width().max(1)).enumerate().for_each(|(j, row)| {
            for (i, numbers) in row.iter_mut().enumerate() {
                let Some(seen) = view.centre_footprint(i, j) else { continue };
                let vectors = [seen.direction.vector(), seen.jacobian.dx, seen.jacobian.dy];
                for (numbers, vector) in numbers.chunks_exact_mut(3).zip(vectors) {
                    numbers.copy_from_slice(&vector.as_vec3().to_array());
                }
            }
        });
        image
    }
}
