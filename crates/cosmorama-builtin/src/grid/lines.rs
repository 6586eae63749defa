use cosmorama::camera::Footprint;
use cosmorama::sphere::{Angle, Direction};
use glam::DVec3;

use crate::compass::Compass;
use crate::pixel_window::{part_on_line, pitch, spread};

/// Style of a line.
struct Pen {
    colour: DVec3,
    /// Width in degrees.
    width: f64,
}

/// Lines at the multiples of an angle.
struct Family {
    pen: Pen,
    /// Degrees between lines, and between those lines that another style draws.
    every: f64,
    except: f64,
    /// Elevation, above and below, at which lines of azimuth end because they come too close.
    until: f64,
}

/// Styles from weak to strong; later ones cover earlier ones.
const AZIMUTHS: [Family; 3] = [
    Family { pen: Pen { colour: DVec3::new(0.02, 0.16, 0.05), width: 0.06 }, every: 5.0, except: 10.0, until: 70.0 },
    Family { pen: Pen { colour: DVec3::new(0.06, 0.55, 0.14), width: 0.1 }, every: 10.0, except: 30.0, until: 80.0 },
    Family { pen: Pen { colour: DVec3::new(0.06, 0.55, 0.14), width: 0.1 }, every: 30.0, except: 90.0, until: 85.0 },
];
const ELEVATIONS: [Family; 2] = [
    Family { pen: Pen { colour: DVec3::new(0.01, 0.12, 0.22), width: 0.06 }, every: 5.0, except: 10.0, until: 90.0 },
    Family { pen: Pen { colour: DVec3::new(0.03, 0.4, 0.75), width: 0.1 }, every: 10.0, except: 180.0, until: 90.0 },
];
/// Style of the meridians to the right, the back and the left, which extend to the poles.
const MERIDIAN: Pen = Pen { colour: DVec3::new(0.2, 0.9, 0.3), width: 0.15 };
const FRONT: DVec3 = DVec3::new(1.0, 0.08, 0.04);
const HORIZON: Pen = Pen { colour: DVec3::new(1.0, 0.6, 0.02), width: 0.25 };
/// Style of the rings around zenith and nadir.
const MARK: Pen = Pen { colour: FRONT, width: 0.15 };
const MARK_RADIUS: Angle = Angle::from_degrees(1.0);

/// Least width of a line in pixels.
const LEAST_WIDTH: f64 = 1.0;

/// Draws the lines on a pixel: for each a colour, and the fraction of the pixel that it covers.
pub(super) fn draw(pixel: &Footprint, compass: &Compass, draw: &mut impl FnMut(DVec3, f64)) {
    let elevation = compass.elevation.degrees();
    if let Some(gradient) = compass.azimuth_gradient() {
        let azimuths = AZIMUTHS.iter().filter(|family| elevation.abs() <= family.until);
        azimuths.for_each(|family| {
            draw(family.pen.colour, family.nearest(pixel, compass.azimuth, compass.cosine, gradient))
        });
    }
    if let Some(gradient) = compass.elevation_gradient() {
        ELEVATIONS
            .iter()
            .for_each(|family| draw(family.pen.colour, family.nearest(pixel, compass.elevation, 1.0, gradient)));
    }
    // The great circles to the right and left and to the front and back: even at the poles.
    draw(MERIDIAN.colour, MERIDIAN.great_circle(pixel, DVec3::Z));
    let to_front = pixel.direction.vector().z < 0.0;
    draw(if to_front { FRONT } else { MERIDIAN.colour }, MERIDIAN.great_circle(pixel, DVec3::X));
    draw(HORIZON.colour, HORIZON.great_circle(pixel, DVec3::Y));
}

/// Draws rings around the zenith and the nadir.
pub(super) fn draw_marks(pixel: &Footprint, draw: &mut impl FnMut(DVec3, f64)) {
    for pole in [Direction::UP, Direction::DOWN] {
        if pixel.direction.dot(pole) > 0.99 {
            let away = pixel.direction.angle_to(pole) - MARK_RADIUS;
            let outwards = (pixel.direction.vector() * pixel.direction.dot(pole) - pole.vector()).normalize_or_zero();
            draw(MARK.colour, MARK.line(pixel, away.radians().abs(), outwards));
        }
    }
}

impl Family {
    /// Returns the fraction of a pixel on the nearest line. Each radian of `angle` is `scale` radians of the sphere.
    fn nearest(&self, pixel: &Footprint, angle: Angle, scale: f64, gradient: DVec3) -> f64 {
        let every = Angle::from_degrees(self.every).radians();
        let multiple = (angle.radians() / every).round();
        if multiple.rem_euclid((self.except / self.every).round()) == 0.0 {
            return 0.0;
        }
        let away = (angle.radians() - multiple * every).abs() * scale;
        let gradient = gradient * scale;
        let pixels_apart = every * scale / pitch(pixel, gradient);
        self.pen.line(pixel, away, gradient) * fade(pixels_apart, 3.0, 7.0)
    }
}

impl Pen {
    /// Returns the fraction of a pixel on the great circle perpendicular to `pole`.
    fn great_circle(&self, pixel: &Footprint, pole: DVec3) -> f64 {
        let direction = pixel.direction.vector();
        let sine = direction.dot(pole);
        self.line(pixel, sine.abs(), pole - direction * sine)
    }

    /// Returns the fraction of a pixel on a line, given the distance to the line's middle in radians and its gradient.
    fn line(&self, pixel: &Footprint, distance: f64, gradient: DVec3) -> f64 {
        let half_width =
            (Angle::from_degrees(self.width).radians() / 2.0).max(LEAST_WIDTH / 2.0 * pitch(pixel, gradient));
        part_on_line(distance, half_width, spread(pixel, gradient))
    }
}

/// Returns a linear ramp from 0 at `nothing` to 1 at `all`.
pub(super) fn fade(value: f64, nothing: f64, all: f64) -> f64 {
    ((value - nothing) / (all - nothing)).clamp(0.0, 1.0)
}
