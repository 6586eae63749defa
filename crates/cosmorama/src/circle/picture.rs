use std::f64::consts::TAU;

use glam::DVec2;

use super::Circle;
use super::rim::Brightness;
use crate::raster::{Image, Rgba};

/// Number of point triples that RANSAC tries.
const TRIALS: usize = 600;
/// Rays along which the rim is measured.
const RAYS: usize = 720;
/// Least fraction of the rim inside the frame that must be found on the circle.
const SEEN: f64 = 0.4;
/// Least fraction of the frame outside the circle that must be black; a flare may cover the rest.
const DARK: f64 = 0.85;
/// Greatest distance of a rim point from the circle, as a fraction of the frame's shorter side.
const TOLERANCE: f64 = 0.006;
/// Tolerance for discs with a ragged edge, as a fraction of the frame's shorter side.
const RAGGED: f64 = 0.03;
/// Least distance of a ragged disc's edge from the centre, as a fraction of its radius; a square's outline comes
/// nearer.
const ROUND: f64 = 0.75;
/// Least fraction of the frame outside the circle.
const AROUND: f64 = 0.02;

/// A circle found on black.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// A circle measured along its rim.
    Measured(Circle),
    /// A bright disc without a visible rim, as under a dark canopy: the circle encloses its light.
    Roughly(Circle),
}

impl Found {
    /// Returns the circle.
    pub fn circle(&self) -> Circle {
        let (Self::Measured(circle) | Self::Roughly(circle)) = self;
        *circle
    }
}

/// Finds the circle that a lens leaves on black, in an image of code values. `None` if there is none, for example
/// because the picture fills its frame.
///
/// Black along rows and columns mostly ends at points on the rim. The first guess is the circle through three of these
/// points that has most others on it (RANSAC). The rim is then measured to a fraction of a pixel, along rays from the
/// guessed centre. The circle is fitted to these measurements, with less weight for distant points.
pub fn find(codes: &Image<Rgba>) -> Option<Found> {
    let picture = Brightness::new(codes)?;
    let coarse = picture.coarse_rim();
    measure(&picture, &coarse).map(Found::Measured).or_else(|| outline(&picture, &coarse).map(Found::Roughly))
}

/// Measures a circle with a visible rim.
fn measure(picture: &Brightness<'_>, coarse: &[DVec2]) -> Option<Circle> {
    let (width, height) = picture.size();
    let least = width.min(height) as f64;
    let mut circle = guess(coarse, TOLERANCE * least, least)?;
    let mut points = Vec::new();
    for reach in [0.02 * least, 0.01 * least, 0.01 * least] {
        points = measured(picture, &circle, reach.max(6.0));
        circle = circle.fitted(&points)?;
    }
    let is_likely = circle.radius > 0.25 * least && circle.radius < 2.0 * least;
    (is_likely && seen(picture, &circle, &points) >= SEEN && is_on_black(picture, &circle, DARK)).then_some(circle)
}

/// Returns the circle around a bright disc with a ragged edge. It is centred on the disc, and holds nearly all of its
/// light.
fn outline(picture: &Brightness<'_>, coarse: &[DVec2]) -> Option<Circle> {
    let (width, height) = picture.size();
    let least = width.min(height) as f64;
    let middle = guess(coarse, RAGGED * least, least)?.fitted(coarse)?;
    let centre = DVec2::from(middle.centre);
    let mut distances: Vec<f64> = coarse.iter().map(|point| (*point - centre).length()).collect();
    distances.sort_by(f64::total_cmp);
    let quantile = |part: f64| distances[(part * (distances.len() - 1) as f64) as usize];
    let mut sectors = [false; 24];
    for point in coarse {
        let turn = (*point - centre).to_angle() / TAU + 0.5;
        sectors[((turn * 24.0) as usize).min(23)] = true;
    }
    let circle = Circle { radius: quantile(0.95), ..middle };
    let is_round = quantile(0.05) > ROUND * circle.radius && sectors.iter().filter(|seen| **seen).count() >= 22;
    (is_round && circle.radius > 0.25 * least && is_on_black(picture, &circle, 0.99)).then_some(circle)
}

fn guess(points: &[DVec2], tolerance: f64, least: f64) -> Option<Circle> {
    let mut state: u64 = 1986;
    let mut pick = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        points[(state >> 33) as usize % points.len()]
    };
    if points.len() < 12 {
        return None;
    }
    let trials = (0..TRIALS).filter_map(|_| Circle::through([pick(), pick(), pick()]));
    let plausible = trials.filter(|circle| circle.radius > 0.2 * least && circle.radius < 3.0 * least);
    let support = |circle: &Circle| points.iter().filter(|point| circle.beyond(**point).abs() < tolerance).count();
    plausible.map(|circle| (support(&circle), circle)).max_by_key(|(support, _)| *support).map(|(_, circle)| circle)
}

fn measured(picture: &Brightness<'_>, circle: &Circle, reach: f64) -> Vec<DVec2> {
    let centre = DVec2::from(circle.centre);
    rays().filter_map(|direction| picture.rim(centre, direction, circle.radius, reach)).collect()
}

fn rays() -> impl Iterator<Item = DVec2> {
    (0..RAYS).map(|k| DVec2::from_angle(TAU * k as f64 / RAYS as f64))
}

/// Returns the fraction of the rim inside the frame that was found on the circle.
fn seen(picture: &Brightness<'_>, circle: &Circle, points: &[DVec2]) -> f64 {
    let (width, height) = picture.size();
    let inside = |point: DVec2| point.x > 0.0 && point.y > 0.0 && point.x < width as f64 && point.y < height as f64;
    let on_rim = |direction: &DVec2| inside(DVec2::from(circle.centre) + circle.radius * *direction);
    let possible = rays().filter(on_rim).count();
    let tolerance = (0.003 * circle.radius).max(1.0);
    let found = points.iter().filter(|point| circle.beyond(**point).abs() < tolerance).count();
    // A short arc could belong to anything.
    if possible * 4 < RAYS { 0.0 } else { found as f64 / possible as f64 }
}

fn is_on_black(picture: &Brightness<'_>, circle: &Circle, dark: f64) -> bool {
    let (width, height) = picture.size();
    let margin = (0.01 * circle.radius).max(3.0);
    let (mut outside, mut black) = (0_usize, 0_usize);
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        if circle.beyond(DVec2::new(i as f64 + 0.5, j as f64 + 0.5)) > margin {
            outside += 1;
            black += usize::from(picture.is_black(i, j));
        }
    }
    outside as f64 >= AROUND * (width * height) as f64 && black as f64 >= dark * outside as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws a textured disc on black, box-filtered, with noise and optionally a flare across its rim.
    fn disc((width, height): (usize, usize), circle: Circle, noise: f64, flare: f64) -> Image<Rgba> {
        let mut state: u64 = 3;
        let mut chance = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
        };
        Image::from_fn(width, height, |i, j| {
            let mut covered = 0.0;
            for k in 0..64 {
                let (u, v) = (f64::from(k % 8) / 8.0 + 0.0625, f64::from(k / 8) / 8.0 + 0.0625);
                covered += f64::from(u8::from(circle.beyond(DVec2::new(i as f64 + u, j as f64 + v)) < 0.0)) / 64.0;
            }
            let texture = 0.55 + 0.3 * (0.05 * i as f64).sin() * (0.07 * j as f64).cos();
            let from_sun = DVec2::new(i as f64 - circle.centre.0 - circle.radius, j as f64 - circle.centre.1).length();
            let spill = flare * (-from_sun / (0.15 * circle.radius)).exp();
            let value = ((covered * texture + spill + noise * chance()).clamp(0.0, 1.0) * 255.0).round() / 255.0;
            Rgba::opaque(value as f32, value as f32, value as f32)
        })
    }

    fn error(found: Circle, true_one: Circle) -> f64 {
        let (dx, dy) = (found.centre.0 - true_one.centre.0, found.centre.1 - true_one.centre.1);
        dx.abs().max(dy.abs()).max((found.radius - true_one.radius).abs())
    }

    #[test]
    fn circles_are_found_to_a_tenth_of_a_pixel() {
        let whole = Circle { centre: (163.3, 118.8), radius: 101.4 };
        let cropped = Circle { centre: (158.7, 121.2), radius: 135.6 };
        for (circle, noise, flare, most) in [
            (whole, 0.0, 0.0, 0.05),
            (whole, 0.02, 0.0, 0.1),
            (whole, 0.01, 0.5, 0.3),
            (cropped, 0.0, 0.0, 0.05),
            (cropped, 0.02, 0.0, 0.1),
        ] {
            let Some(Found::Measured(found)) = find(&disc((320, 240), circle, noise, flare)) else {
                panic!("{circle:?}, noise {noise}, flare {flare}: no rim");
            };
            let error = error(found, circle);
            assert!(error <= most, "noise {noise}, flare {flare}: {found:?} is off by {error}");
        }
    }

    #[test]
    fn light_between_leaves_has_an_outline_only() {
        let circle = Circle { centre: (160.0, 118.0), radius: 100.0 };
        let leaves = |i: usize, j: usize| (i * 7919 + j * 104_729 + i * j * 31) % 23;
        let canopy = Image::from_fn(320, 240, |i, j| {
            let beyond = circle.beyond(DVec2::new(i as f64, j as f64)) / circle.radius;
            // Gaps are fewer towards the rim.
            let lit = beyond < 0.0 && (leaves(i / 2, j / 2) as f64) < -20.0 * beyond;
            if lit { Rgba::opaque(0.4, 0.5, 0.6) } else { Rgba::BLACK }
        });
        let Some(Found::Roughly(found)) = find(&canopy) else { panic!("an outline") };
        assert!(error(found, circle) < 12.0, "{found:?}");
    }

    #[test]
    fn what_has_no_circle_on_black_has_none() {
        let grey = |value: f64| Rgba::opaque(value as f32, value as f32, value as f32);
        let full = Image::from_fn(320, 240, |i, j| grey(0.5 + 0.4 * (0.1 * i as f64).sin() * (0.08 * j as f64).cos()));
        assert_eq!(find(&full), None);
        assert_eq!(find(&Image::filled(320, 240, Rgba::BLACK)), None);
        // A dark room with a lit window, and vignetting that does not reach black.
        let window = Image::from_fn(320, 240, |i, j| {
            grey(if (80..200).contains(&i) && (60..150).contains(&j) { 0.8 } else { 0.01 })
        });
        assert_eq!(find(&window), None);
        let vignette = Image::from_fn(320, 240, |i, j| {
            grey(0.9 - 0.6 * DVec2::new(i as f64 / 160.0 - 1.0, j as f64 / 160.0 - 0.75).length_squared())
        });
        assert_eq!(find(&vignette), None);
        assert_eq!(find(&Image::filled(4, 4, Rgba::BLACK)), None);
    }
}
