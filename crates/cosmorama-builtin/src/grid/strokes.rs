use cosmorama::sphere::Angle;
use cosmorama::world::Footprint;
use glam::DVec3;

use super::labels::HEIGHT;
use super::lines::fade;
use crate::compass::Compass;
use crate::pixel_window::{part_on_line, spread};

/// A straight stroke of a pen, short beside the sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) colour: DVec3,
    pub(super) from: DVec3,
    pub(super) to: DVec3,
}

/// Strokes, found by where they are: a table of fields of azimuth and elevation, each with the strokes near it.
#[derive(Clone, Debug)]
pub(super) struct Strokes {
    fields: Vec<Vec<Stroke>>,
}

/// Side of a field in degrees, and how many there are.
const FIELD: f64 = 5.0;
const COLUMNS: usize = 72;
const ROWS: usize = 36;

/// A stroke's width, in radians.
const WIDTH: f64 = Angle::from_degrees(HEIGHT / 8.0).radians();

/// Letters are shown from so many pixels a capital on, whole from the second number.
const LEGIBLE: (f64, f64) = (4.0, 6.0);

/// No pixel that shows letters sees further than this: four times the spread of the window.
const REACH: f64 = 4.0 * 0.5 * Angle::from_degrees(HEIGHT).radians() / LEGIBLE.0 + WIDTH;

impl Strokes {
    pub(super) fn new(strokes: Vec<Stroke>) -> Self {
        let mut fields = vec![Vec::new(); COLUMNS * ROWS];
        for (index, field) in fields.iter_mut().enumerate() {
            let (middle, radius) = bounds(index % COLUMNS, index / COLUMNS);
            field.extend(strokes.iter().filter(|stroke| stroke.is_within(middle, radius + REACH)));
        }
        Self { fields }
    }

    /// Draws the stroke that covers most of a pixel: those that meet are one line, not two on top of each other.
    pub(super) fn draw(&self, pixel: &Footprint, compass: &Compass, draw: &mut impl FnMut(DVec3, f64)) {
        let field = &self.fields[field(compass)];
        if field.is_empty() {
            return;
        }
        let step = pixel.jacobian.dx.length().max(pixel.jacobian.dy.length());
        let legible =
            if step > 0.0 { fade(Angle::from_degrees(HEIGHT).radians() / step, LEGIBLE.0, LEGIBLE.1) } else { 1.0 };
        if legible == 0.0 {
            return;
        }
        let parts = field.iter().map(|stroke| (stroke.colour, stroke.cover(pixel)));
        if let Some((colour, part)) = parts.max_by(|a, b| a.1.total_cmp(&b.1)) {
            draw(colour, legible * part);
        }
    }
}

fn field(compass: &Compass) -> usize {
    let cell = |degrees: f64, count: usize| ((degrees / FIELD) as usize).min(count - 1);
    let (azimuth, elevation) = (compass.azimuth.degrees() + 180.0, compass.elevation.degrees() + 90.0);
    cell(elevation, ROWS) * COLUMNS + cell(azimuth, COLUMNS)
}

/// The middle of a field, and how far its corners are from it at most.
fn bounds(column: usize, row: usize) -> (DVec3, f64) {
    let at = |column: f64, row: f64| {
        let (azimuth, elevation) = (column * FIELD - 180.0, row * FIELD - 90.0);
        let (azimuth, elevation) = (Angle::from_degrees(azimuth), Angle::from_degrees(elevation));
        cosmorama::sphere::Direction::from_longitude_latitude(azimuth, elevation).vector()
    };
    let (column, row) = (column as f64, row as f64);
    let middle = at(column + 0.5, row + 0.5);
    let corners = [at(column, row), at(column + 1.0, row), at(column, row + 1.0), at(column + 1.0, row + 1.0)];
    (middle, corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max))
}

impl Stroke {
    /// The point of the stroke that is nearest to another.
    fn nearest(&self, point: DVec3) -> DVec3 {
        let along = self.to - self.from;
        let length = along.length_squared();
        let part = if length > 0.0 { ((point - self.from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        self.from + along * part
    }

    fn is_within(&self, middle: DVec3, radius: f64) -> bool {
        self.nearest(middle).distance(middle) <= radius
    }

    /// The part of a pixel that the stroke covers, its ends round.
    fn cover(&self, pixel: &Footprint) -> f64 {
        let point = pixel.direction.vector();
        let aside = point - self.nearest(point);
        let distance = aside.length();
        if distance > REACH {
            return 0.0;
        }
        let across = (self.to - self.from).cross(point);
        let gradient = if distance > 0.1 * WIDTH { aside } else { across }.normalize_or_zero();
        part_on_line(distance, WIDTH / 2.0, spread(pixel, gradient))
    }
}
