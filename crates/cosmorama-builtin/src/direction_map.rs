use cosmorama::camera::View;
use cosmorama::raster::Image;
use rayon::prelude::*;

/// A map of where each pixel of a view looks, for other programs to take our geometry from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DirectionMap {
    /// Whether it holds the footprint, too: how the direction changes from a pixel to the next.
    pub footprint: bool,
}

/// The numbers of a pixel: its direction, and its change for one pixel to the right and one down; x, y and z of each.
pub type DirectionPixel = [f32; 9];

/// Their names, in their order.
const CHANNELS: [&str; 9] =
    ["direction.X", "direction.Y", "direction.Z", "dx.X", "dx.Y", "dx.Z", "dy.X", "dy.Y", "dy.Z"];

impl DirectionMap {
    /// The names of the channels that it holds, in the order of a pixel's numbers.
    pub fn channels(self) -> &'static [&'static str] {
        if self.footprint { &CHANNELS } else { &CHANNELS[..3] }
    }

    /// Makes the map of a view: unit vectors in the world's frame (+X right, +Y up, −Z front) and their derivatives per
    /// pixel, in radians, at each pixel's middle. Pixels whose middle shows nothing are zero, which no direction is.
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
