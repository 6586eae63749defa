use cosmorama::camera::Footprint;
use cosmorama::sphere::Angle;
use glam::DVec3;

use crate::compass::Compass;
use crate::pixel_window::{part_on_line, spread};

/// A straight stroke of a pen, short compared with the sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) colour: DVec3,
    pub(super) from: DVec3,
    pub(super) to: DVec3,
}

/// Strokes of letters, indexed by place: a table of fields of azimuth and elevation, each with the strokes near it.
#[derive(Clone, Debug)]
pub(super) struct Strokes {
    fields: Vec<Vec<Stroke>>,
    pen: Pen,
}

/// Properties of the pen, in radians.
#[derive(Clone, Copy, Debug)]
struct Pen {
    width: f64,
    /// Greatest distance from a stroke at which a pixel still shows it.
    reach: f64,
}

/// Side of a field in degrees, and number of fields.
const FIELD: f64 = 5.0;
const COLUMNS: usize = 72;
const ROWS: usize = 36;

/// Width of a stroke, in heights of capitals.
const WIDTH: f64 = 0.125;

impl Strokes {
    /// Indexes the strokes of letters with capitals of a height in degrees, for pictures in which that is at least
    /// `least_pixels`.
    pub(super) fn new(strokes: Vec<Stroke>, height: f64, least_pixels: f64) -> Self {
        let height = Angle::from_degrees(height).radians();
        let width = WIDTH * height;
        // Four times the spread of the window.
        let pen = Pen { width, reach: 4.0 * 0.5 * height / least_pixels + width };
        let mut fields = vec![Vec::new(); COLUMNS * ROWS];
        for (index, field) in fields.iter_mut().enumerate() {
            let (middle, radius) = bounds(index % COLUMNS, index / COLUMNS);
            field.extend(strokes.iter().filter(|stroke| stroke.is_within(middle, radius + pen.reach)));
        }
        Self { fields, pen }
    }

    /// Draws the stroke that covers most of a pixel: strokes that meet count once, not twice.
    pub(super) fn draw(&self, pixel: &Footprint, compass: &Compass, shown: f64, draw: &mut impl FnMut(DVec3, f64)) {
        let parts = self.fields[field(compass)].iter().map(|stroke| (stroke.colour, stroke.cover(self.pen, pixel)));
        if let Some((colour, part)) = parts.max_by(|a, b| a.1.total_cmp(&b.1)) {
            draw(colour, shown * part);
        }
    }
}

fn field(compass: &Compass) -> usize {
    let cell = |degrees: f64, count: usize| ((degrees / FIELD) as usize).min(count - 1);
    let (azimuth, elevation) = (compass.azimuth.degrees() + 180.0, compass.elevation.degrees() + 90.0);
    cell(elevation, ROWS) * COLUMNS + cell(azimuth, COLUMNS)
}

/// Returns the middle of a field, and the greatest distance of its corners from it.
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
    /// Returns the point of the stroke that is nearest to a point.
    fn nearest(&self, point: DVec3) -> DVec3 {
        let along = self.to - self.from;
        let length = along.length_squared();
        let part = if length > 0.0 { ((point - self.from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        self.from + along * part
    }

    fn is_within(&self, middle: DVec3, radius: f64) -> bool {
        self.nearest(middle).distance(middle) <= radius
    }

    /// Returns the fraction of a pixel that the stroke covers, with round ends.
    fn cover(&self, pen: Pen, pixel: &Footprint) -> f64 {
        let point = pixel.direction.vector();
        let aside = point - self.nearest(point);
        let distance = aside.length();
        if distance > pen.reach {
            return 0.0;
        }
        let across = (self.to - self.from).cross(point);
        let gradient = if distance > 0.1 * pen.width { aside } else { across }.normalize_or_zero();
        part_on_line(distance, pen.width / 2.0, spread(pixel, gradient))
    }
}
