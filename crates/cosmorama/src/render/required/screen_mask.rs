use std::iter::repeat_n;

use rayon::prelude::*;

use crate::camera::{PixelPoint, View};
use crate::raster::{Image, Rgba};
use crate::world::World;

/// Light-independent state of a target's pixels: the part of each inside the field of view, and the part of that which
/// views of the world cover.
#[derive(Clone, Debug)]
pub struct ScreenMask {
    rows: Vec<Row>,
}

/// Row of a mask, as runs of equal pixels: but for a few edges, pixels lie inside or outside as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
struct Row(Vec<Run>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    pixel: MaskPixel,
    /// Column behind the last one.
    end: u32,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct MaskPixel {
    /// Part of the pixel inside the field of view.
    coverage: f32,
    /// Part of that which the world covers.
    seen: f32,
}

/// Sub-samples per side that measure a pixel in which the world ends.
const SUB_SAMPLES: usize = 16;

/// Rows of a mask that a thread makes from the centres of their pixels.
const BAND_ROWS: usize = 32;

impl ScreenMask {
    /// Makes the mask of a target in a world.
    pub fn new(world: &World, target: &View) -> Self {
        let bands = (0..target.height()).into_par_iter().step_by(BAND_ROWS);
        Self { rows: bands.flat_map_iter(|first| Self::band(world, target, first)).collect() }
    }

    /// Makes the rows of a band, whose first is given. Three rows of centres are held.
    fn band(world: &World, target: &View, first: usize) -> Vec<Row> {
        let (width, height) = (target.width(), target.height());
        let centres = |j: Option<usize>| -> Vec<MaskPixel> {
            let row = j.filter(|j| *j < height).into_iter();
            row.flat_map(|j| (0..width).map(move |i| MaskPixel::of_centre(world, target, (i, j)))).collect()
        };
        let mut near = [centres(first.checked_sub(1)), centres(Some(first)), Vec::new()];
        let mut rows = Vec::new();
        for j in first..height.min(first + BAND_ROWS) {
            near[2] = centres(Some(j + 1));
            rows.push(Row::of((0..width).map(|i| Self::pixel((world, target), &near, (i, j)))));
            near.rotate_left(1);
        }
        rows
    }

    /// Makes a pixel of a row, by the centres of the row above it, of its own and of the row below.
    fn pixel((world, target): (&World, &View), near: &[Vec<MaskPixel>; 3], (i, j): (usize, usize)) -> MaskPixel {
        let pixel = near[1][i];
        let columns = i.saturating_sub(1)..target.width().min(i + 2);
        // Where the world ends in a pixel, the centre of a neighbour lies on the other side.
        let mut neighbours = near.iter().filter_map(|row| row.get(columns.clone())).flatten();
        if pixel.coverage > 0.0 && neighbours.any(|other| other.coverage > 0.0 && other.seen != pixel.seen) {
            MaskPixel { seen: seen_part(world, target, (i, j)).unwrap_or(pixel.seen), ..pixel }
        } else {
            pixel
        }
    }

    /// Lays a colour where no view covers the pixels: see [`Self::fill_by`].
    ///
    /// # Panics
    /// When the picture has other rows than the mask's target.
    pub fn fill_unseen(&self, image: &mut Image<Rgba>, colour: Rgba) {
        self.fill_by(image, |_, _| colour);
    }

    /// Lays light, by column and row, where no view covers the pixels. Pixels in which the world ends keep their own as far
    /// as it is seen, so that its border is smooth. Those that a filter has left empty, since their centres are outside,
    /// take the mean of their neighbours inside.
    ///
    /// # Panics
    /// When the picture has other rows than the mask's target.
    pub fn fill_by(&self, image: &mut Image<Rgba>, light: impl Fn(usize, usize) -> Rgba + Sync) {
        let is_left = |(pixel, mask): (&Rgba, MaskPixel)| pixel.alpha() == 0.0 && mask.seen > 0.0 && mask.seen < 0.5;
        let pixels = self.rows.iter().flat_map(Row::pixels);
        let both = image.pixels().iter().zip(pixels).enumerate();
        let left: Vec<usize> = both.filter(|(_, both)| is_left(*both)).map(|(index, _)| index).collect();
        let taken: Vec<Rgba> = left.iter().map(|&index| self.mean_inside(image, index)).collect();
        left.iter().zip(taken).for_each(|(&index, mean)| image.pixels_mut()[index] = mean);
        self.rows_of(image).enumerate().for_each(|(j, (row, masks))| {
            for (i, (pixel, mask)) in row.iter_mut().zip(masks.pixels()).enumerate() {
                if mask.seen < 1.0 && mask.coverage > 0.0 {
                    *pixel = *pixel * mask.seen + light(i, j) * (mask.coverage * (1.0 - mask.seen));
                }
            }
        });
    }

    /// Returns the rows of a picture with those of the mask.
    fn rows_of<'a>(
        &'a self,
        image: &'a mut Image<Rgba>,
    ) -> impl IndexedParallelIterator<Item = (&'a mut [Rgba], &'a Row)> {
        assert_eq!(image.height(), self.rows.len(), "a picture of the mask's target");
        let width = image.width().max(1);
        image.pixels_mut().par_chunks_mut(width).zip(&self.rows)
    }

    /// Returns the mean of the pixels around one whose centres the world covers.
    fn mean_inside(&self, image: &Image<Rgba>, index: usize) -> Rgba {
        let place = (index % image.width(), index / image.width());
        let inside =
            places_around((image.width(), image.height()), place).filter(|&(i, j)| self.rows[j].at(i).seen >= 0.5);
        let (mut sum, mut count) = (Rgba::TRANSPARENT, 0.0);
        for (i, j) in inside {
            sum += *image.get(i, j);
            count += 1.0;
        }
        if count > 0.0 { sum * (1.0 / count) } else { sum }
    }

    /// Repairs pixels with missing (NaN) texels in opaque worlds. What is left of a pixel is scaled to full coverage. A
    /// pixel with next to nothing left takes its neighbours' mean, or `fill` if those have none. Returns the number
    /// filled.
    ///
    /// # Panics
    /// When the picture has other rows than the mask's target.
    pub fn close_holes(&self, image: &mut Image<Rgba>, fill: Rgba) -> usize {
        // Least part of a pixel that counts. Less is noise, which negative lobes leave beside a hole.
        const ENOUGH: f32 = 0.05;
        self.rows_of(image).for_each(|(row, masks)| {
            for (pixel, mask) in row.iter_mut().zip(masks.pixels()) {
                if pixel.alpha() > ENOUGH * mask.coverage {
                    *pixel = *pixel * (mask.coverage / pixel.alpha());
                } else if mask.is_shown() {
                    *pixel = Rgba::TRANSPARENT;
                }
            }
        });
        // Means are of what was there before, so that a row is filled when the next one has its own.
        let (mut empty, mut above) = (0, Vec::new());
        for j in 0..image.height() {
            let closed = self.closed(image, j);
            empty += self.lay(image, (j.saturating_sub(1), &above), fill);
            above = closed;
        }
        empty + self.lay(image, (image.height().saturating_sub(1), &above), fill)
    }

    /// Returns the columns of a row's holes, with the means of their neighbours.
    fn closed(&self, image: &Image<Rgba>, j: usize) -> Vec<(usize, Option<Rgba>)> {
        let masks = self.rows[j].pixels().enumerate();
        let holes = masks.filter(|(i, mask)| mask.is_shown() && image.get(*i, j).alpha() == 0.0);
        holes.map(|(i, _)| (i, mean_around(image, (i, j)))).collect()
    }

    /// Lays colours into the holes of a row, and another one where there is none. Returns the number of these.
    fn lay(&self, image: &mut Image<Rgba>, (j, closed): (usize, &[(usize, Option<Rgba>)]), fill: Rgba) -> usize {
        let width = image.width();
        for (i, colour) in closed {
            image.pixels_mut()[j * width + i] = colour.unwrap_or(fill) * self.rows[j].at(*i).coverage;
        }
        closed.iter().filter(|(_, colour)| colour.is_none()).count()
    }

    /// Lays a colour outside the field of view. It also goes behind the pixels that the edge cuts, as far as they lie
    /// outside.
    ///
    /// # Panics
    /// When the picture has other rows than the mask's target.
    pub fn surround(&self, image: &mut Image<Rgba>, colour: Rgba) {
        self.rows_of(image).for_each(|(row, masks)| {
            row.iter_mut().zip(masks.pixels()).for_each(|(pixel, mask)| *pixel += colour * (1.0 - mask.coverage));
        });
    }
}

impl Row {
    /// Joins equal pixels that lie side by side.
    fn of(pixels: impl Iterator<Item = MaskPixel>) -> Self {
        let mut runs: Vec<Run> = Vec::new();
        for (pixel, end) in pixels.zip(1..) {
            match runs.last_mut().filter(|run| run.pixel == pixel) {
                Some(run) => run.end = end,
                None => runs.push(Run { pixel, end }),
            }
        }
        runs.shrink_to_fit();
        Self(runs)
    }

    /// Returns the pixels one by one.
    fn pixels(&self) -> impl Iterator<Item = MaskPixel> {
        let starts = [0].into_iter().chain(self.0.iter().map(|run| run.end));
        self.0.iter().zip(starts).flat_map(|(run, start)| repeat_n(run.pixel, (run.end - start) as usize))
    }

    /// Returns the pixel in a column.
    fn at(&self, i: usize) -> MaskPixel {
        self.0[self.0.partition_point(|run| run.end as usize <= i)].pixel
    }
}

impl MaskPixel {
    /// Returns a pixel that is judged by its centre alone: the world covers all of it or nothing.
    fn of_centre(world: &World, target: &View, (i, j): (usize, usize)) -> Self {
        let Some(screen) = target.screen_pixel(i, j) else { return Self::default() };
        let is_seen = world.owner(screen.footprint.direction).is_some();
        Self { coverage: screen.coverage as f32, seen: if is_seen { 1.0 } else { 0.0 } }
    }

    /// Returns whether some of the pixel is in the field of view, and the world covers at least half of that.
    fn is_shown(self) -> bool {
        self.coverage > 0.0 && self.seen >= 0.5
    }
}

/// Returns the part of a pixel's field of view that the world covers; `None` where nothing of the field is sampled.
fn seen_part(world: &World, target: &View, (i, j): (usize, usize)) -> Option<f32> {
    let at = |pixel: usize, k: usize| pixel as f64 + (k as f64 + 0.5) / SUB_SAMPLES as f64;
    let samples =
        (0..SUB_SAMPLES * SUB_SAMPLES).map(|k| PixelPoint::new(at(i, k % SUB_SAMPLES), at(j, k / SUB_SAMPLES)));
    let (mut shown, mut seen) = (0_u32, 0_u32);
    for direction in samples.filter(|sample| target.shows(*sample)).filter_map(|sample| target.direction(sample)) {
        shown += 1;
        seen += u32::from(world.owner(direction).is_some());
    }
    (shown > 0).then(|| seen as f32 / shown as f32)
}

/// Visits a pixel and the eight around it.
fn around<P>(pixels: &[P], width: usize, place: (usize, usize)) -> impl Iterator<Item = &P> {
    places_around((width, pixels.len() / width.max(1)), place).map(move |(i, j)| &pixels[j * width + i])
}

/// Returns the place of a pixel and those of the eight around it, in a picture of this size.
fn places_around((width, height): (usize, usize), (i, j): (usize, usize)) -> impl Iterator<Item = (usize, usize)> {
    let columns = i.saturating_sub(1)..width.min(i + 2);
    (j.saturating_sub(1)..height.min(j + 2)).flat_map(move |j| columns.clone().map(move |i| (i, j)))
}

/// Returns the opaque mean of the eight pixels around one; `None` if there is nothing in them.
fn mean_around(image: &Image<Rgba>, place: (usize, usize)) -> Option<Rgba> {
    let mut sum = Rgba::TRANSPARENT;
    around(image.pixels(), image.width(), place).for_each(|pixel| sum += *pixel);
    (sum.alpha() > 0.0).then(|| sum * sum.alpha().recip())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, FisheyeCamera};
    use crate::sphere::{Angle, CubeFace, Orientation};

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
    fn the_world_ends_by_coverage() {
        // A square of 90° on the dome: 8 x 8 texels, and masks of other grids.
        let (world, _) = front_and_fisheye();
        for size in [31, 40, 97] {
            let dome = CameraModel::Fisheye(FisheyeCamera::default()).view(size, size).unwrap();
            let turned = Orientation::from_yaw_pitch_roll(
                Angle::from_degrees(3.0),
                Angle::from_degrees(-8.0),
                Angle::from_degrees(20.0),
            );
            let target = View { orientation: turned, ..dome };
            let mut image = Image::filled(size, size, Rgba::opaque(1.0, 1.0, 1.0));
            ScreenMask::new(&world, &target).fill_unseen(&mut image, Rgba::TRANSPARENT);
            let mut cut = 0;
            for (j, i) in (0..size).flat_map(|j| (0..size).map(move |i| (j, i))) {
                let Some(screen) = target.screen_pixel(i, j) else { continue };
                // Every pixel by many samples.
                let (mut shown, mut seen) = (0, 0);
                for (y, x) in (0..50).flat_map(|y| (0..50).map(move |x| (y, x))) {
                    let at = |pixel: usize, k: i32| pixel as f64 + (f64::from(k) + 0.5) / 50.0;
                    let Some(direction) = target.direction(PixelPoint::new(at(i, x), at(j, y))) else { continue };
                    shown += 1;
                    seen += usize::from(world.owner(direction).is_some());
                }
                let part = seen as f32 / shown as f32;
                let alpha = image.get(i, j).alpha();
                assert!(screen.coverage < 1.0 || (alpha - part).abs() < 0.04, "{i},{j} of {size}: {alpha}, not {part}");
                cut += usize::from(part > 0.05 && part < 0.95 && screen.coverage == 1.0);
            }
            assert!(cut > size, "{cut} pixels of {size} are cut");
        }
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
    fn a_mask_takes_little_memory() {
        let (world, _) = front_and_fisheye();
        for size in [40, 300] {
            let target = CameraModel::Fisheye(FisheyeCamera::default()).view(size, size).unwrap();
            let mask = ScreenMask::new(&world, &target);
            let runs: usize = mask.rows.iter().map(|row| row.0.len()).sum();
            assert!((size..12 * size).contains(&runs), "{runs} runs of {size}");
        }
        // A row says of each column what it was made of, whichever way it is asked.
        let pixel = |i: usize| MaskPixel { coverage: (i % 5 / 2) as f32, seen: 1.0 };
        let row = Row::of((0..23).map(pixel));
        assert!((0..23).all(|i| row.at(i) == pixel(i)) && row.pixels().eq((0..23).map(pixel)));
    }

    #[test]
    fn holes_in_every_row_are_closed_by_what_was_there_before() {
        let (world, target) = front_and_fisheye();
        let mask = ScreenMask::new(&world, &target);
        let mut image = Image::filled(40, 40, Rgba::TRANSPARENT);
        // One pixel closes those around it, and no others.
        image.pixels_mut()[20 * 40 + 20] = Rgba::opaque(0.5, 0.5, 0.5);
        let white = Rgba::opaque(1.0, 1.0, 1.0);
        let shown = mask.rows.iter().flat_map(Row::pixels).filter(|pixel| pixel.is_shown()).count();
        assert_eq!(mask.close_holes(&mut image, white), shown - 9);
        let closed = |i: usize, j: usize| image.get(i, j).0[0] == 0.5;
        let places = (0..40).flat_map(|j| (0..40).map(move |i| (i, j)));
        assert_eq!(places.filter(|&(i, j)| closed(i, j)).count(), 9);
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
