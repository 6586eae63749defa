use glam::DVec3;
use rayon::prelude::*;

use super::marks::{CELL, Marks};
use super::{LightSum, Moment, Shutter};
use crate::camera::{Covariance, Footprint, PixelPoint, View};
use crate::filter::{CrossSection, Ewa, Kernel, Prepared};
use crate::raster::{Image, Rgba};
use crate::sphere::Direction;

/// Exposure of a frame: the target's view at each of some moments while the shutter is open.
///
/// There are as many moments as the fastest pixel needs to go by no more than a quarter of a pixel from one to the next, or by
/// a 32nd of a texel where that is larger: then the pixels' kernels make an even streak. Where nothing moves there is one.
#[derive(Clone, Debug)]
pub struct Exposure {
    views: Vec<(View, f32)>,
    /// Variance of the shutter's time over that of the moments, which leave out the spread within each.
    spread: f64,
}

/// Length of a pixel's way from one moment to the next, in pixels. Kernels half a pixel apart make an even streak, too; but clamps to the
/// texels nearby give them edges: beside 1,024 moments the streak of a sun is off by 1/270 of its light with 0.3 pixels, and by 1/760 with a quarter.
const STEP: f64 = 1.0 / 4.0;

/// Least part of a texel that counts as a pixel: magnified texels have such edges, too.
const TEXEL: f64 = 0.125;

/// Part of a pixel below which nothing has moved.
const STILL: f64 = 1e-3;

/// Greatest number of moments: a streak of 256 pixels. Beyond it, steps are longer.
const MOST_MOMENTS: usize = 1024;

/// Pixels each way whose ways are measured.
const LATTICE: usize = 17;

impl Exposure {
    /// Kernel by which [`Exposure::ellipse`] averages: a Gaussian of half a pixel's standard deviation.
    pub const KERNEL: Kernel = Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 2.0 });

    /// Filter by which [`Exposure::ellipse`] averages.
    pub const FILTER: Ewa = Ewa { kernel: Self::KERNEL, anti_ringing: false };

    /// Number of moments by which the ways of pixels are measured, and from which an ellipse is made.
    pub const FEW: usize = 5;

    /// Returns how many moments an exposure needs, one where nothing moves. `views` are those at [`Exposure::FEW`] times that
    /// divide it evenly, its ends among them; `texel` is the width of the world's finest texels in radians.
    pub fn moments_needed(views: &[View], texel: f64) -> usize {
        let longest = longest_way(views, texel);
        if longest < STILL { 1 } else { ((longest / STEP).ceil() as usize).clamp(2, MOST_MOMENTS) }
    }

    /// Returns the exposure of a frame at given moments, each with the target's view then.
    pub fn of_moments(moments: &[(Moment, View)], shutter: &Shutter, frame: f64) -> Self {
        let variance = {
            let sum = |of: &dyn Fn(f64) -> f64| {
                moments.iter().map(|(moment, _)| moment.weight * of(moment.time - frame)).sum::<f64>()
            };
            sum(&|t| t * t) - sum(&|t| t).powi(2)
        };
        let whole = shutter.curve.variance() * shutter.fraction * shutter.fraction;
        let views = moments.iter().map(|(moment, view)| (view.clone(), moment.weight as f32)).collect();
        Self { views, spread: if variance > 0.0 { whole / variance } else { 0.0 } }
    }

    /// Divides the exposure of a frame into moments. `view` is the target's view at a time, always of one size;
    /// `texel` is the width of the world's finest texels in radians.
    pub fn of(view: impl Fn(f64) -> View, shutter: &Shutter, frame: f64, texel: f64) -> Self {
        let ends: Vec<View> = shutter.division(frame).into_iter().map(&view).collect();
        match Self::moments_needed(&ends, texel) {
            1 => Self { views: vec![(view(frame), 1.0)], spread: 0.0 },
            count => Self::at(&view, shutter, frame, count),
        }
    }

    /// Divides the exposure of a frame into a few moments, enough for [`Exposure::ellipse`].
    pub fn few(view: impl Fn(f64) -> View, shutter: &Shutter, frame: f64) -> Self {
        Self::at(&view, shutter, frame, Self::FEW)
    }

    fn at(view: &impl Fn(f64) -> View, shutter: &Shutter, frame: f64, count: usize) -> Self {
        let moments = shutter.moments(frame, count);
        let moments: Vec<_> = moments.into_iter().map(|moment| (moment, view(moment.time))).collect();
        Self::of_moments(&moments, shutter, frame)
    }

    /// Returns the views, each with the part of the light that it stands for.
    pub fn views(&self) -> &[(View, f32)] {
        &self.views
    }

    /// Returns whether nothing moves, so that there is one view.
    pub fn is_still(&self) -> bool {
        self.views.len() == 1
    }

    /// Averages the pictures of all moments, each made by `render`: motion blur by each pixel's own path. Light is
    /// linear and premultiplied.
    ///
    /// # Errors
    /// The first error of `render`.
    pub fn render<E>(&self, mut render: impl FnMut(&View) -> Result<Image<Rgba>, E>) -> Result<Image<Rgba>, E> {
        let (first, weight) = &self.views[0];
        let first = render(first)?;
        if self.is_still() {
            return Ok(first);
        }
        let mut sum = LightSum::new(first, *weight);
        for (view, weight) in &self.views[1..] {
            sum.add(&render(view)?, *weight);
        }
        Ok(sum.into_image())
    }

    /// Averages the world for each pixel once, over its footprint widened by the covariance of its path: the paper's
    /// approximation (Greene 1986, section 9). Streaks have soft ends, and ways are taken to be straight. `prepared` is a
    /// filter of [`Exposure::KERNEL`]: covariances add for Gaussians alone.
    pub fn ellipse(&self, prepared: &dyn Prepared) -> Image<Rgba> {
        let (middle, _) = &self.views[self.views.len() / 2];
        let mut image = Image::filled(middle.width(), middle.height(), Rgba::TRANSPARENT);
        image.pixels_mut().par_chunks_mut(middle.width().max(1)).enumerate().for_each(|(j, row)| {
            row.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = self.ellipse_at([i, j], prepared));
        });
        image
    }

    /// Averages the world for each pixel of the marked cells.
    pub(super) fn fill_by_ellipses(&self, image: &mut Image<Rgba>, marks: &Marks, prepared: &dyn Prepared) {
        let width = image.width();
        image.pixels_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(j, row)| {
            let marks = marks.row(j);
            for (i, pixel) in row.iter_mut().enumerate().filter(|(i, _)| marks[i / CELL]) {
                *pixel = self.ellipse_at([i, j], prepared);
            }
        });
    }

    /// Averages the world for one pixel.
    fn ellipse_at(&self, [i, j]: [usize; 2], prepared: &dyn Prepared) -> Rgba {
        let (middle, _) = &self.views[self.views.len() / 2];
        let Some(screen) = middle.screen_pixel(i, j) else { return Rgba::TRANSPARENT };
        prepared.average(&self.widened(&screen.footprint, PixelPoint::centre(i, j))) * screen.coverage as f32
    }

    /// Returns the variance of the shutter's time over that of the moments.
    pub(super) fn spread(&self) -> f64 {
        self.spread
    }

    /// Returns the footprint of a pixel over its way: about the mean direction, with the covariance of directions.
    fn widened(&self, footprint: &Footprint, pixel: PixelPoint) -> Footprint {
        let seen = || {
            let at = |(view, weight): &(View, f32)| Some((view.direction(pixel)?.vector(), f64::from(*weight)));
            self.views.iter().filter_map(at)
        };
        let sum: DVec3 = seen().map(|(direction, weight)| direction * weight).sum();
        let Some(mean) = Direction::new(sum) else { return *footprint };
        let path = seen().fold(Covariance::ZERO, |path, (direction, weight)| {
            let off = direction - mean.vector();
            let off = off - mean.vector() * mean.vector().dot(off);
            path + Covariance::along(off) * weight
        });
        Footprint::new(mean, footprint.jacobian.dx, footprint.jacobian.dy).widened_by(path * self.spread)
    }
}

/// Returns the length of the longest way of a pixel through the world, in pixels, or in texels where those are larger.
fn longest_way(views: &[View], texel: f64) -> f64 {
    let size = [views[0].width(), views[0].height()];
    let place = |k: usize, size: usize| size as f64 * k as f64 / (LATTICE - 1) as f64;
    let points =
        (0..LATTICE * LATTICE).map(|k| PixelPoint::new(place(k % LATTICE, size[0]), place(k / LATTICE, size[1])));
    points.filter_map(|point| way(views, point, texel)).fold(0.0, f64::max)
}

/// Returns the length of one point's way; `None` where it sees nothing.
fn way(views: &[View], point: PixelPoint, texel: f64) -> Option<f64> {
    let footprints: Vec<Footprint> = views.iter().map(|view| view.footprint(point)).collect::<Option<_>>()?;
    let unit = |footprint: &Footprint| {
        let jacobian = footprint.jacobian;
        // The minor axis, from the area and the major one, which is at most the root of the sum of squares.
        let major = (jacobian.dx.length_squared() + jacobian.dy.length_squared()).sqrt();
        let minor = if major > 0.0 { jacobian.solid_angle() / major } else { 0.0 };
        minor.max(TEXEL * texel)
    };
    let step = |pair: &[Footprint]| pair[0].direction.angle_to(pair[1].direction).radians() / unit(&pair[0]);
    Some(footprints.windows(2).map(step).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, FieldOfView, PerspectiveCamera};
    use crate::filter::Filter;
    use crate::motion::{Ramp, ShutterCurve, Turn};
    use crate::render::Resampler;
    use crate::sphere::Angle;
    use crate::world::World;

    /// Returns a world of fine waves, with a sun of 1000 beside the middle if it `has_sun`.
    fn world(has_sun: bool) -> (World, crate::world::Light) {
        let wave = |i: usize, j: usize| 0.5 + 0.5 * (i as f32 * 0.9).sin() * (j as f32 * 0.7).cos();
        let texel = |i: usize, j: usize| {
            let value = if has_sun && (i, j) == (262, 124) { 1000.0 } else { wave(i, j) };
            Rgba::opaque(value, 0.5 * value, 1.0 - value.min(1.0))
        };
        World::from_panorama(Image::from_fn(512, 256, texel)).expect("a world")
    }

    fn camera() -> View {
        CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(60.0))))
            .view(64, 48)
            .expect("a view")
    }

    /// Returns a pan with a roll, which takes the outermost pixels some eight pixels in a frame.
    fn turn() -> Turn {
        let angles = [Ramp { from: -6.0, to: 6.0 }, Ramp { from: -2.0, to: 2.0 }, Ramp { from: -10.0, to: 10.0 }];
        Turn { angles, fov: None, times: [0.0, 1.0], easing: Default::default() }
    }

    fn swept(exposure: &Exposure, world: &World, light: &crate::world::Light) -> Image<Rgba> {
        let render = |view: &View| Ok::<_, ()>(Resampler::new(world, view).render(light.texels()));
        exposure.render(render).expect("a picture")
    }

    fn exposure(shutter: &Shutter, texel: f64) -> Exposure {
        Exposure::of(|time| camera().turned(turn().pose(time).orientation), shutter, 0.5, texel)
    }

    #[test]
    fn streaks_equal_those_of_a_thousand_moments() {
        for (has_sun, curve) in [(false, ShutterCurve::Box), (true, ShutterCurve::Trapezoid)] {
            let (world, light) = world(has_sun);
            let shutter = Shutter { curve, ..Shutter::centred(0.8) };
            let exposure = exposure(&shutter, world.texel_pitch());
            let view = |time: f64| camera().turned(turn().pose(time).orientation);
            let many = Exposure::at(&view, &shutter, 0.5, 1024);
            let (found, expected) = (swept(&exposure, &world, &light), swept(&many, &world, &light));
            let peak = expected.pixels().iter().flat_map(|pixel| pixel.0).fold(1.0, f32::max);
            for (a, b) in found.pixels().iter().zip(expected.pixels()) {
                let error = (0..4).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max);
                assert!(error < peak / 500.0, "{a:?}, not {b:?}, of {} moments", exposure.views.len());
            }
            let energy = |image: &Image<Rgba>| image.pixels().iter().map(|pixel| f64::from(pixel.0[0])).sum::<f64>();
            assert!((energy(&found) / energy(&expected) - 1.0).abs() < 2e-3);
        }
    }

    #[test]
    fn nothing_moves_at_no_cost() {
        let (world, light) = world(false);
        let still = Exposure::of(|_| camera(), &Shutter::centred(1.0), 3.0, world.texel_pitch());
        assert!(still.is_still());
        assert_eq!(swept(&still, &world, &light), Resampler::new(&world, &camera()).render(light.texels()));
    }

    #[test]
    fn an_ellipse_has_the_streaks_place_and_length() {
        // A smooth blob, wide enough that soft ends of streaks do not show.
        let blob = |i: usize, j: usize| {
            let (x, y) = (i as f32 - 256.0, j as f32 - 128.0);
            (-(x * x + y * y) / 400.0).exp()
        };
        let texel = |i: usize, j: usize| Rgba::opaque(blob(i, j), blob(i, j), blob(i, j));
        let (world, light) = World::from_panorama(Image::from_fn(512, 256, texel)).expect("a world");
        let shutter = Shutter { phase: 0.0, ..Shutter::centred(0.6) };
        let swept = swept(&exposure(&shutter, world.texel_pitch()), &world, &light);
        let prepared = Exposure::FILTER.prepare(&world, &light).expect("a filter");
        let view = |time: f64| camera().turned(turn().pose(time).orientation);
        let ellipse = Exposure::few(view, &shutter, 0.5).ellipse(&*prepared);
        for (a, b) in swept.pixels().iter().zip(ellipse.pixels()) {
            assert!((a.0[0] - b.0[0]).abs() < 0.02, "{a:?}, not {b:?}");
        }
    }
}
