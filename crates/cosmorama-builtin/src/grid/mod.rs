//! The grid by which projectors are aligned on a dome.

mod labels;
mod lines;
mod strokes;

use cosmorama::camera::{Footprint, View};
use cosmorama::sphere::{Angle, Direction, DirectionJacobian};
use glam::DVec3;

use crate::compass::Compass;
use crate::{Average, Radiance};
use labels::{SCALES, Scale};
use strokes::Strokes;

/// Lines of azimuth and elevation on black: strong ones every 10°, weak ones every 5°, the horizon yellow, the line to the
/// front red, degrees beside them, marks at the zenith and the nadir. Azimuth is 0 at the front and grows to the right.
///
/// Lines have their width in degrees, but are never thinner than a pixel; where they would crowd, they fade. Where letters
/// would be too small to read, fewer and larger ones stand in their place, as far as [`Grid::width_for_letters`] allows.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The finest first.
    labels: Vec<Strokes>,
}

/// Letters are shown from so many pixels a capital on, whole from the second number.
const LEGIBLE: (f64, f64) = (6.5, 7.0);

impl Grid {
    /// Where a picture is too coarse for any letters in its middle: the width from which on it has some.
    pub fn width_for_letters(view: &View) -> Option<usize> {
        let height = Angle::from_degrees(SCALES[SCALES.len() - 1].height).radians() * view.pixels_per_radian();
        (height < LEGIBLE.1).then(|| (view.width() as f64 * LEGIBLE.1 / height).ceil() as usize)
    }

    /// The grid, its letters laid out.
    pub fn new() -> Self {
        let strokes = |scale: &Scale| Strokes::new(labels::all(scale), scale.height, LEGIBLE.0);
        Self { labels: SCALES.iter().map(strokes).collect() }
    }

    /// Draws the finest letters that can be read.
    fn draw_labels(&self, pixel: &Footprint, compass: &Compass, draw: &mut impl FnMut(DVec3, f64)) {
        let step = pixel.jacobian.dx.length().max(pixel.jacobian.dy.length());
        let mut left = 1.0;
        for (scale, strokes) in SCALES.iter().zip(&self.labels) {
            let pixels = Angle::from_degrees(scale.height).radians() / step;
            let shown = left * if step > 0.0 { lines::fade(pixels, LEGIBLE.0, LEGIBLE.1) } else { 1.0 };
            if shown > 0.0 {
                strokes.draw(pixel, compass, shown, draw);
            }
            left -= shown;
            if left <= 0.0 {
                return;
            }
        }
    }

    fn light(&self, pixel: &Footprint) -> [f32; 3] {
        let mut light = DVec3::ZERO;
        let mut draw = |colour: DVec3, part: f64| light = light.lerp(colour, part);
        let compass = Compass::of(pixel.direction);
        lines::draw(pixel, &compass, &mut draw);
        lines::draw_marks(pixel, &mut draw);
        self.draw_labels(pixel, &compass, &mut draw);
        light.as_vec3().to_array()
    }
}

impl Default for Grid {
    fn default() -> Self {
        Self::new()
    }
}

impl Radiance for Grid {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        self.light(&Footprint { direction, jacobian: DirectionJacobian { dx: DVec3::ZERO, dy: DVec3::ZERO } })
    }

    fn average(&self, pixel: &Footprint) -> Average {
        Average::Known(self.light(pixel))
    }
}
