//! A grid for the alignment of projectors on a dome.

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

/// Lines of azimuth and elevation on black: strong ones every 10°, weak ones every 5°. The horizon is yellow, the line
/// to the front red; degrees stand beside the lines, and rings mark zenith and nadir. Azimuth is 0 at the front and
/// grows to the right.
///
/// Lines have a width in degrees, but never less than a pixel; where they would crowd, they fade. Where letters would
/// be too small to read, fewer and larger ones replace them, as far as [`Grid::width_for_letters`] permits.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Labels by scale, the finest first.
    labels: Vec<Strokes>,
}

/// Height of a capital, in pixels, at which letters begin to appear, and at which they are fully visible.
const LEGIBLE: (f64, f64) = (6.5, 7.0);

impl Grid {
    /// Returns the smallest width at which letters in the middle of this view's picture are legible; `None` if they already are.
    pub fn width_for_letters(view: &View) -> Option<usize> {
        let height = Angle::from_degrees(SCALES[SCALES.len() - 1].height).radians() * view.pixels_per_radian();
        (height < LEGIBLE.1).then(|| (view.width() as f64 * LEGIBLE.1 / height).ceil() as usize)
    }

    /// Creates the grid with all its labels.
    pub fn new() -> Self {
        let strokes = |scale: &Scale| Strokes::new(labels::all(scale), scale.height, LEGIBLE.0);
        Self { labels: SCALES.iter().map(strokes).collect() }
    }

    /// Draws the finest letters that are legible.
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
