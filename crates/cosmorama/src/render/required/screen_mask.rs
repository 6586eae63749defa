use rayon::prelude::*;

use crate::camera::View;
use crate::raster::{Image, Rgba};
use crate::world::World;

/// Light-independent state of a target's pixels: the part of each inside the field of view, and whether any view covers
/// its direction.
#[derive(Clone, Debug)]
pub struct ScreenMask {
    pixels: Vec<MaskPixel>,
}

#[derive(Clone, Copy, Debug, Default)]
struct MaskPixel {
    coverage: f32,
    unseen: bool,
}

impl ScreenMask {
    /// Makes the mask of a target in a world.
    pub fn new(world: &World, target: &View) -> Self {
        let width = target.width();
        let mut pixels = vec![MaskPixel::default(); width * target.height()];
        pixels.par_chunks_mut(width.max(1)).enumerate().for_each(|(j, row)| {
            for (i, pixel) in row.iter_mut().enumerate() {
                let Some(screen) = target.screen_pixel(i, j) else { continue };
                let direction = screen.footprint.direction;
                let unseen = world.owner(direction).is_none();
                *pixel = MaskPixel { coverage: screen.coverage as f32, unseen };
            }
        });
        Self { pixels }
    }

    /// Fills the pixels whose direction no view covers with a colour.
    pub fn fill_unseen(&self, image: &mut Image<Rgba>, colour: Rgba) {
        for (pixel, mask) in image.pixels_mut().iter_mut().zip(&self.pixels) {
            if mask.unseen {
                *pixel = colour * mask.coverage;
            }
        }
    }

    /// Repairs pixels with missing (NaN) texels in opaque worlds. What is left of a pixel is scaled to full coverage. A
    /// pixel with next to nothing left takes its neighbours' mean, or `fill` if those have none. Returns the number
    /// filled.
    pub fn close_holes(&self, image: &mut Image<Rgba>, fill: Rgba) -> usize {
        // Least part of a pixel that counts. Less is noise, which negative lobes leave beside a hole.
        const ENOUGH: f32 = 0.05;
        let mut holes = Vec::new();
        for (index, (pixel, mask)) in image.pixels_mut().iter_mut().zip(&self.pixels).enumerate() {
            if pixel.alpha() > ENOUGH * mask.coverage {
                *pixel = *pixel * (mask.coverage / pixel.alpha());
            } else if mask.coverage > 0.0 && !mask.unseen {
                *pixel = Rgba::TRANSPARENT;
                holes.push(index);
            }
        }
        let closed: Vec<Option<Rgba>> = holes.iter().map(|&index| mean_around(image, index)).collect();
        for (&index, colour) in holes.iter().zip(&closed) {
            image.pixels_mut()[index] = colour.unwrap_or(fill) * self.pixels[index].coverage;
        }
        closed.iter().filter(|colour| colour.is_none()).count()
    }

    /// Lays a colour outside the field of view. It also goes behind the pixels that the edge cuts, as far as they lie
    /// outside.
    pub fn surround(&self, image: &mut Image<Rgba>, colour: Rgba) {
        for (pixel, mask) in image.pixels_mut().iter_mut().zip(&self.pixels) {
            *pixel += colour * (1.0 - mask.coverage);
        }
    }
}

/// Returns the opaque mean of the eight pixels around one; `None` if there is nothing in them.
fn mean_around(image: &Image<Rgba>, index: usize) -> Option<Rgba> {
    let (i, j) = (index % image.width(), index / image.width());
    let mut sum = Rgba::TRANSPARENT;
    for row in j.saturating_sub(1)..image.height().min(j + 2) {
        for column in i.saturating_sub(1)..image.width().min(i + 2) {
            sum += *image.get(column, row);
        }
    }
    (sum.alpha() > 0.0).then(|| sum * sum.alpha().recip())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, FisheyeCamera};
    use crate::sphere::CubeFace;

    fn front_and_fisheye() -> (World, View) {
        let front = CameraModel::CubeFace(CubeFaceCamera).view(8, 8).unwrap();
        let world = World::new([(CubeFace::Front.name().to_owned(), front)]).unwrap();
        (world, CameraModel::Fisheye(FisheyeCamera::default()).view(40, 40).unwrap())
    }

    #[test]
    fn what_no_view_sees_is_filled_inside_the_lens_only() {
        let (world, target) = front_and_fisheye();
        let mut image = Image::filled(40, 40, Rgba::BLACK);
        let red = Rgba::opaque(1.0, 0.0, 0.0);
        ScreenMask::new(&world, &target).fill_unseen(&mut image, red);
        assert_eq!(*image.get(20, 20), Rgba::BLACK);
        assert_eq!(*image.get(2, 20), red);
        assert_eq!(*image.get(0, 0), Rgba::BLACK);
    }

    #[test]
    fn holes_close_as_far_as_there_is_anything() {
        let (world, target) = front_and_fisheye();
        let mut image = Image::filled(40, 40, Rgba([0.25, 0.25, 0.25, 0.5]));
        // A single hole, holding what negative lobes leave, and one of nine pixels.
        image.pixels_mut()[20 * 40 + 20] = Rgba([3.0, 0.0, 0.0, 0.001]);
        for index in [15, 16, 17].into_iter().flat_map(|j| [22, 23, 24].map(|i| j * 40 + i)) {
            image.pixels_mut()[index] = Rgba::TRANSPARENT;
        }
        let white = Rgba::opaque(1.0, 1.0, 1.0);
        assert_eq!(ScreenMask::new(&world, &target).close_holes(&mut image, white), 1);
        let grey = Rgba::opaque(0.5, 0.5, 0.5);
        assert_eq!([*image.get(21, 20), *image.get(20, 20), *image.get(22, 15)], [grey; 3]);
        assert_eq!(*image.get(23, 16), white);
    }

    #[test]
    fn the_surroundings_complete_the_rim() {
        let (world, target) = front_and_fisheye();
        let mask = ScreenMask::new(&world, &target);
        let mut image = Image::filled(40, 40, Rgba::TRANSPARENT);
        mask.fill_unseen(&mut image, Rgba::BLACK);
        mask.close_holes(&mut image, Rgba::BLACK);
        mask.surround(&mut image, Rgba::BLACK);
        assert!(image.pixels().iter().all(|pixel| (pixel.alpha() - 1.0).abs() < 1e-6));
    }
}
