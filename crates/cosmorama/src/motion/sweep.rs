//! Pictures of all moments of an exposure together.

use std::ops::Range;

use rayon::prelude::*;

use super::marks::{CELL, Marks};
use super::rings::{Profile, Rings, Swept, most_bytes_a_pixel};
use super::turning::{Tolerance, Turning};
use super::{Exposure, LightSum};
use crate::camera::View;
use crate::filter::{Ewa, FilterKind, FilterSettings};
use crate::raster::{Image, Rgba};
use crate::render::{Progress, Resampler, Sampling, Share, Stopped, wanted};
use crate::world::World;

/// Least number of moments for which rings cost less than the moments' pictures.
const LEAST: usize = 16;

/// Deviations from a turn about one axis at which rings make the picture that moments make.
const TURN: Tolerance = Tolerance { place: 0.01, size: 0.01 };

/// Deviations at which ellipses are told by their rings: they are not exact either.
const ABOUT: Tolerance = Tolerance { place: 0.1, size: 0.1 };

/// Greatest lone jump between the two rings beside a pixel that is left to interpolation, of white or of the pixel's own light where
/// that is brighter. Half way between the rings it is off by half of that. A jump spread over two gaps counts an eighth.
const JUMP: f32 = 1.0 / 150.0;

impl Exposure {
    /// Renders the world through the open shutter: each pixel is the mean of what it sees on its way. What turns about one axis is
    /// made at once, and the rest moment by moment.
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn swept(
        &self,
        (world, filter): (&World, FilterSettings),
        texels: &[Rgba],
        progress: &dyn Progress,
    ) -> Result<Image<Rgba>, Stopped> {
        let views = self.views();
        let mut sum: Option<LightSum> = None;
        for part in parts(views, (world, filter), 0..views.len()) {
            let done = |index: usize| index as f64 / views.len() as f64;
            let share = Share { whole: progress, from: done(part.views.start), to: done(part.views.end) };
            let some = &views[part.views.clone()];
            let weight: f32 = some.iter().map(|(_, weight)| weight).sum();
            let rings = if part.has_rings { rings(some, (world, filter)) } else { None };
            let image = match rings {
                Some(rings) => by_rings(&rings, some, (world, filter), texels, &share)?,
                None => by_moments(some, (world, filter), texels, &share)?,
            };
            match &mut sum {
                Some(sum) => sum.add(&image, weight),
                None => sum = Some(LightSum::new(image, weight)),
            }
        }
        Ok(sum.map_or_else(|| Image::filled(0, 0, Rgba::TRANSPARENT), LightSum::into_image))
    }
}

impl Exposure {
    /// Averages the world for each pixel over its footprint and its path together, as [`Exposure::ellipse`] does, but for all
    /// pixels at once where the view turns about one axis. There ellipses follow the bends of their ways.
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn ellipses(&self, world: &World, texels: &[Rgba], progress: &dyn Progress) -> Result<Image<Rgba>, Stopped> {
        let prepared = Self::FILTER.of_texels(world, texels);
        let rings = Turning::of(self.views(), world.texel_pitch(), ABOUT).and_then(|turning| {
            let profile = self.gaussian(&turning.angles);
            let Ewa { kernel, anti_ringing } = Self::FILTER;
            let filter = FilterSettings { kind: FilterKind::Ewa, kernel, anti_ringing };
            Rings::new(self.views(), &turning, &profile, (world, filter))
        });
        let Some(rings) = rings else {
            let image = self.ellipse(&*prepared);
            return if progress.advance(1.0).is_break() { Err(Stopped) } else { Ok(image) };
        };
        // An ellipse is no more than near to what is seen, so that any interpolation is good enough.
        let Swept { mut image, left } = rings.render(texels, f32::INFINITY, progress)?;
        self.fill_by_ellipses(&mut image, &left, &*prepared);
        Ok(image)
    }

    /// Returns the greatest number of bytes that [`Exposure::swept`] and [`Exposure::ellipses`] hold beside pictures, for each pixel
    /// of a view: none where the filter is none that they sample.
    pub fn most_bytes_a_pixel(view: &View, resampler: (&World, FilterSettings)) -> usize {
        most_bytes_a_pixel(view, resampler)
    }

    /// Returns the Gaussian of the light over the angles of the views.
    fn gaussian(&self, angles: &[f64]) -> Profile {
        let sum = |of: &dyn Fn(f64) -> f64| {
            self.views().iter().zip(angles).map(|((_, weight), angle)| f64::from(*weight) * of(*angle)).sum::<f64>()
        };
        let mean = sum(&|angle| angle);
        let variance = (sum(&|angle| angle * angle) - mean * mean).max(0.0) * self.spread();
        Profile::Gaussian { mean, deviation: variance.sqrt() }
    }
}

/// Views that follow one another, and whether they have rings: whether they turn about one axis.
struct Part {
    views: Range<usize>,
    has_rings: bool,
}

/// Divides an exposure into parts that turn about one axis each, as far as that pays. Rings of one part are held at once.
fn parts(views: &[(View, f32)], resampler: (&World, FilterSettings), range: Range<usize>) -> Vec<Part> {
    if range.len() < LEAST {
        return vec![Part { views: range, has_rings: false }];
    }
    if rings(&views[range.clone()], resampler).is_some() {
        return vec![Part { views: range, has_rings: true }];
    }
    let middle = range.start + range.len() / 2;
    let mut halves = parts(views, resampler, range.start..middle);
    halves.extend(parts(views, resampler, middle..range.end));
    if halves.iter().any(|part| part.has_rings) { halves } else { vec![Part { views: range, has_rings: false }] }
}

/// Returns the rings of some views, if these turn about one axis.
fn rings<'a>(views: &'a [(View, f32)], resampler: (&'a World, FilterSettings)) -> Option<Rings<'a>> {
    let turning = Turning::of(views, resampler.0.texel_pitch(), TURN)?;
    let weights = views.iter().map(|(_, weight)| f64::from(*weight));
    let profile = Profile::Moments(turning.angles.iter().copied().zip(weights).collect());
    Rings::new(views, &turning, &profile, resampler)
}

/// Averages the pictures of some moments.
fn by_moments(
    views: &[(View, f32)],
    (world, filter): (&World, FilterSettings),
    texels: &[Rgba],
    progress: &dyn Progress,
) -> Result<Image<Rgba>, Stopped> {
    let total: f32 = views.iter().map(|(_, weight)| weight).sum();
    let mut sum: Option<LightSum> = None;
    for (index, (view, weight)) in views.iter().enumerate() {
        let done = |index: usize| index as f64 / views.len() as f64;
        let share = Share { whole: progress, from: done(index), to: done(index + 1) };
        let image = Resampler::new(world, view).by(filter).watched(&share).render(texels)?;
        match &mut sum {
            Some(sum) => sum.add(&image, weight / total),
            None => sum = Some(LightSum::new(image, weight / total)),
        }
    }
    Ok(sum.map_or_else(|| Image::filled(0, 0, Rgba::TRANSPARENT), LightSum::into_image))
}

/// Renders some views by their rings, and by moments where rings are not certain enough.
fn by_rings(
    rings: &Rings,
    views: &[(View, f32)],
    resampler: (&World, FilterSettings),
    texels: &[Rgba],
    progress: &dyn Progress,
) -> Result<Image<Rgba>, Stopped> {
    let beginning = Share { whole: progress, from: 0.0, to: 0.5 };
    let Swept { mut image, left } = rings.render(texels, JUMP, &beginning)?;
    if left.count() > 0 {
        fill(&mut image, &left, views, resampler, (texels, &Share { whole: progress, from: 0.5, to: 1.0 }))?;
    }
    if progress.advance(1.0).is_break() { Err(Stopped) } else { Ok(image) }
}

/// Fills the marked cells of a picture with the mean of some moments.
fn fill(
    image: &mut Image<Rgba>,
    marks: &Marks,
    views: &[(View, f32)],
    (world, filter): (&World, FilterSettings),
    (texels, progress): (&[Rgba], &dyn Progress),
) -> Result<(), Stopped> {
    let total: f32 = views.iter().map(|(_, weight)| weight).sum();
    let width = image.width().max(1);
    for (index, (view, weight)) in views.iter().enumerate() {
        let done = |index: usize| index as f64 / views.len() as f64;
        let share = Share { whole: progress, from: done(index), to: done(index + 1) };
        let resampler = Resampler { world, target: view, filter };
        let wanted = wanted(&resampler, |rect| marks.meet(rect));
        let made = resampler.render_sampled(Sampling::only(&wanted), texels, &share)?;
        let rows = image.pixels_mut().par_chunks_mut(width).zip(made.pixels().par_chunks(width)).enumerate();
        rows.for_each(|(j, (row, made))| {
            let cells = row.chunks_mut(CELL).zip(made.chunks(CELL)).zip(marks.row(j));
            for ((sums, made), _) in cells.filter(|(_, is_marked)| **is_marked) {
                for (sum, pixel) in sums.iter_mut().zip(made) {
                    let before = if index == 0 { Rgba::TRANSPARENT } else { *sum };
                    *sum = before + *pixel * (weight / total);
                }
            }
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::camera::{CameraModel, FieldOfView, FisheyeCamera, FulldomeCamera, PerspectiveCamera};
    use crate::motion::{Moment, Ramp, Shutter, ShutterCurve, Turn};
    use crate::sphere::Angle;
    use crate::world::Light;

    /// Returns a panorama of waves, with a sun of 1000 near the front if it `has_sun`.
    fn world(has_sun: bool) -> (World, Light) {
        let wave = |i: usize, j: usize| 0.5 + 0.4 * (i as f32 * 0.25).sin() * (j as f32 * 0.2).cos();
        let texel = |i: usize, j: usize| {
            let value = if has_sun && (i, j) == (1030, 500) { 1000.0 } else { wave(i, j) };
            Rgba::opaque(value, 0.5 * value, 1.0 - value.min(1.0))
        };
        World::from_panorama(Image::from_fn(2048, 1024, texel)).expect("a world")
    }

    fn camera() -> View {
        let wide = FieldOfView::Horizontal(Angle::from_degrees(12.5));
        CameraModel::from(PerspectiveCamera::new(wide)).view(96, 72).expect("a view")
    }

    /// Returns a turn by these angles of yaw, pitch and roll in a frame, past the front.
    fn turn(angles: [f64; 3]) -> Turn {
        let angles = angles.map(|angle| Ramp { from: -angle / 2.0, to: angle / 2.0 });
        Turn { angles, fov: None, times: [0.0, 1.0], easing: Default::default() }
    }

    fn exposure(view: impl Fn(f64) -> View, curve: ShutterCurve, moments: usize) -> Exposure {
        let shutter = Shutter { curve, ..Shutter::centred(1.0) };
        let moments: Vec<(Moment, View)> =
            shutter.moments(0.5, moments).into_iter().map(|moment| (moment, view(moment.time))).collect();
        Exposure::of_moments(&moments, &shutter, 0.5)
    }

    fn on(_: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn swept(exposure: &Exposure, world: &World, light: &Light) -> Image<Rgba> {
        exposure.swept((world, FilterSettings::DEFAULT), light.texels(), &on).expect("a picture")
    }

    /// Renders moments one by one.
    fn summed(exposure: &Exposure, world: &World, light: &Light) -> Image<Rgba> {
        let render = |view: &View| Ok::<_, ()>(Resampler::new(world, view).render(light.texels()));
        exposure.render(render).expect("a picture")
    }

    /// Returns the part of all cells of all moments that rings make alone.
    fn certain(exposure: &Exposure, world: &World, light: &Light) -> f64 {
        let views = exposure.views();
        let parts = parts(views, (world, FilterSettings::DEFAULT), 0..views.len());
        let certain = |part: &Part| {
            let rings = rings(&views[part.views.clone()], (world, FilterSettings::DEFAULT))?;
            let left = rings.render(light.texels(), JUMP, &on).expect("a picture").left;
            let certain = 1.0 - left.count() as f64 / (96 * 72 / 64) as f64;
            Some(certain * part.views.len() as f64 / views.len() as f64)
        };
        parts.iter().filter_map(certain).sum()
    }

    /// Returns the greatest difference of two pictures, and the brightest light.
    fn worst(a: &Image<Rgba>, b: &Image<Rgba>) -> (f32, f32) {
        let off = |a: &Rgba, b: &Rgba| (0..4).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max);
        let peak = b.pixels().iter().flat_map(|pixel| pixel.0).fold(1.0, f32::max);
        (a.pixels().iter().zip(b.pixels()).map(|(a, b)| off(a, b)).fold(0.0, f32::max), peak)
    }

    fn sum(image: &Image<Rgba>, of: impl Fn(f64, f64) -> f64) -> f64 {
        let width = image.width();
        let part = |(at, pixel): (usize, &Rgba)| {
            f64::from(pixel.0[0]) * of((at % width) as f64 + 0.5, (at / width) as f64 + 0.5)
        };
        image.pixels().iter().enumerate().map(part).sum()
    }

    #[test]
    fn turns_about_one_axis_are_seen_as_by_a_thousand_moments() {
        let cases = [
            ([2.5, 0.0, 0.0], ShutterCurve::Box),
            ([0.0, 2.0, 0.0], ShutterCurve::Trapezoid),
            ([1.5, 0.5, 3.0], ShutterCurve::Cosine),
            ([0.0, 0.0, 20.0], ShutterCurve::Box),
        ];
        for has_sun in [false, true] {
            let (world, light) = world(has_sun);
            for (angles, curve) in cases {
                let view = |time: f64| camera().turned(turn(angles).pose(time).orientation);
                let shutter = Shutter { curve, ..Shutter::centred(1.0) };
                let few = Exposure::of(view, &shutter, 0.5, world.texel_pitch());
                let (found, expected) =
                    (swept(&few, &world, &light), summed(&exposure(view, curve, 1024), &world, &light));
                let ((worst, peak), certain) = (worst(&found, &expected), certain(&few, &world, &light));
                assert!(worst < peak / 500.0, "{angles:?}, {curve:?}: {worst} of {peak}");
                assert!(certain > 0.5, "{angles:?}: {certain} by rings");
                let energy = sum(&found, |_, _| 1.0) / sum(&expected, |_, _| 1.0);
                assert!((energy - 1.0).abs() < 1e-3, "{angles:?}: {energy}");
            }
        }
    }

    #[test]
    fn edges_along_rings_are_seen_as_by_a_thousand_moments() {
        // Beside edges the clamp to the texels nearby jumps from ring to ring.
        let brick = |i: usize, j: usize| [0.02, 0.9, 0.35, 0.6][(j / 7 + 2 * (i / 211)) % 4];
        let texel = |i: usize, j: usize| Rgba::opaque(brick(i, j), 0.5 * brick(i, j), 1.0 - brick(i, j));
        let (world, light) = World::from_panorama(Image::from_fn(2048, 1024, texel)).expect("a world");
        let view = |time: f64| camera().turned(turn([2.5, 0.0, 0.0]).pose(time).orientation);
        let few = Exposure::of(view, &Shutter::centred(1.0), 0.5, world.texel_pitch());
        let expected = summed(&exposure(view, ShutterCurve::Box, 1024), &world, &light);
        let (worst, _) = worst(&swept(&few, &world, &light), &expected);
        assert!(worst < 1.0 / 500.0, "{worst}");
    }

    #[test]
    fn a_suns_streak_has_its_light_place_and_length() {
        let texel = |i: usize, j: usize| {
            if (i, j) == (1030, 500) { Rgba::opaque(1000.0, 1000.0, 1000.0) } else { Rgba::BLACK }
        };
        let (world, light) = World::from_panorama(Image::from_fn(2048, 1024, texel)).expect("a world");
        let view = |time: f64| camera().turned(turn([2.0, 1.0, 6.0]).pose(time).orientation);
        let found = swept(&exposure(view, ShutterCurve::Box, 60), &world, &light);
        let expected = summed(&exposure(view, ShutterCurve::Box, 1024), &world, &light);
        let energy = [&found, &expected].map(|image| sum(image, |_, _| 1.0));
        assert!((energy[0] / energy[1] - 1.0).abs() < 0.01, "{energy:?}");
        let moments = [&found, &expected].map(|image| {
            let all = sum(image, |_, _| 1.0);
            let [x, y] = [sum(image, |x, _| x) / all, sum(image, |_, y| y) / all];
            [x, y, (sum(image, |i, j| (i - x).powi(2) + (j - y).powi(2)) / all).sqrt()]
        });
        let [[x, y, length], [right_x, right_y, right]] = moments;
        assert!((x - right_x).hypot(y - right_y) < 0.05 && (length / right - 1.0).abs() < 0.01, "{moments:?}");
    }

    #[test]
    fn targets_and_sources_of_all_kinds_are_swept() {
        let lens = CameraModel::from(FisheyeCamera::default()).view(400, 400).expect("a lens");
        let fisheye = World::new([("lens".to_owned(), lens)]).expect("a world");
        let waves = |d: crate::sphere::Direction| {
            let wave = |x: f64| (0.5 + 0.4 * (40.0 * x).sin()) as f32;
            Rgba::opaque(wave(d.vector().x), wave(d.vector().y), 0.5)
        };
        let sky = World::new([("sky".to_owned(), crate::world::panorama(512, 256))]).expect("a world");
        let (fisheye_light, sky_light) = (Light::by_direction(&fisheye, waves), Light::by_direction(&sky, waves));
        let dome = CameraModel::from(FulldomeCamera::default()).view(64, 64).expect("a dome");
        let panorama = crate::world::panorama(96, 48);
        let wide = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(110.0))));
        let wide = wide.view(96, 48).expect("a view");
        for (name, target, world, light, angles) in [
            ("dome", &dome, &sky, &sky_light, [25.0, 0.0, 0.0]),
            ("panorama", &panorama, &sky, &sky_light, [30.0, 0.0, 0.0]),
            ("lens", &camera(), &fisheye, &fisheye_light, [5.0, 2.0, 0.0]),
            ("beyond the lens", &wide, &fisheye, &fisheye_light, [2.0, 1.0, 30.0]),
        ] {
            let view = |time: f64| target.turned(turn(angles).pose(time).orientation);
            let found = swept(&exposure(view, ShutterCurve::Box, 64), world, light);
            let expected = summed(&exposure(view, ShutterCurve::Box, 256), world, light);
            let (worst, peak) = worst(&found, &expected);
            assert!(worst < peak / 500.0, "{name}: {worst}");
        }
    }

    #[test]
    fn what_does_not_turn_about_one_axis_is_seen_moment_by_moment() {
        let (world, light) = world(false);
        let zoomed = |time: f64| {
            let wide = FieldOfView::Horizontal(Angle::from_degrees(12.5 + time));
            CameraModel::from(PerspectiveCamera::new(wide)).view(96, 72).expect("a view")
        };
        let few = exposure(zoomed, ShutterCurve::Box, 30);
        assert_eq!(certain(&few, &world, &light), 0.0);
        let render = |view: &View| Ok::<_, ()>(Resampler::new(&world, view).render(light.texels()));
        let (worst, _) = worst(&swept(&few, &world, &light), &few.render(render).expect("a picture"));
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn a_turn_that_changes_its_axis_is_divided_there() {
        let (world, light) = world(false);
        let view = |time: f64| {
            let before = turn([4.0, 0.0, 0.0]).pose(time.min(0.5)).orientation;
            camera().turned(turn([0.0, 3.0, 0.0]).pose(time.max(0.5)).orientation.within(before))
        };
        let few = exposure(view, ShutterCurve::Box, 64);
        let parts = parts(few.views(), (&world, FilterSettings::DEFAULT), 0..64);
        assert!(parts.iter().all(|part| part.has_rings) && parts.iter().any(|part| part.views.end == 32));
        let (worst, _) =
            worst(&swept(&few, &world, &light), &summed(&exposure(view, ShutterCurve::Box, 1024), &world, &light));
        assert!(worst < 1.0 / 500.0, "{worst}");
    }

    #[test]
    fn ellipses_at_once_are_those_of_single_pixels() {
        let (world, light) = world(false);
        let view = |time: f64| camera().turned(turn([2.0, 0.5, 5.0]).pose(time).orientation);
        let few = exposure(view, ShutterCurve::Box, Exposure::FEW);
        let found = few.ellipses(&world, light.texels(), &on).expect("a picture");
        let single = few.ellipse(&*Exposure::FILTER.of_texels(&world, light.texels()));
        let (worst, _) = worst(&found, &single);
        assert!(worst < 0.02, "{worst}");
    }
}
