use glam::DVec3;

use super::{Edge, Solid, Wall};
use crate::camera::{Normal, Ray};

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// Position of a ball relative to a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Meeting {
    /// The whole beam misses it.
    Missed,
    /// The whole beam meets it.
    Met,
    /// The outline crosses the beam.
    Crossed(Edge),
    /// The beam is too wide, compared with the ball, to tell more.
    Wide,
}

/// Part of a ball's radius below which its outline is taken as straight over a beam.
const STRAIGHT: f64 = 0.15;

/// Part of the radius by which a ray leaves the place where it starts.
const AWAY: f64 = 1e-9;

impl Solid for Sphere {
    fn next(&self, ray: &Ray) -> Option<Wall> {
        self.wall(ray, AWAY * self.radius)
    }
}

impl Sphere {
    /// Returns a ball.
    pub fn new(centre: DVec3, radius: f64) -> Self {
        Self { centre, radius }
    }

    /// Returns the distance at which a ray meets the ball, beyond a distance; `None` if it misses.
    pub fn meet(&self, ray: &Ray, beyond: f64) -> Option<f64> {
        let offset = ray.origin - self.centre;
        let along = offset.dot(ray.direction);
        // From the closest point: differences of squares of far centres would lose the small ball's digits.
        let aside = offset - ray.direction * along;
        let square = self.radius * self.radius - aside.length_squared();
        if square < 0.0 {
            return None;
        }
        let half = square.sqrt();
        [-along - half, -along + half].into_iter().find(|distance| *distance > beyond)
    }

    /// Returns the surface where a ray meets it, beyond a distance; `None` if it misses.
    pub(crate) fn wall(&self, ray: &Ray, beyond: f64) -> Option<Wall> {
        Some(self.wall_at(ray, self.meet(ray, beyond)?))
    }

    /// Returns the surface where a ray meets it, at a distance.
    pub(super) fn wall_at(&self, ray: &Ray, distance: f64) -> Wall {
        let met = ray.met(distance, self.normal_at(ray.at(distance)));
        Wall { met, normal: self.normal(&met), distance, part: 0 }
    }

    /// Returns the outward unit normal at a point of the surface.
    pub fn normal_at(&self, point: DVec3) -> DVec3 {
        (point - self.centre).normalize()
    }

    /// Returns the outward normal, with its change, of a ray that has met the ball. The curvature is exact: the normal
    /// turns by the way on the surface over the radius.
    pub fn normal(&self, met: &Ray) -> Normal {
        let unit = self.normal_at(met.origin);
        Normal { unit, dx: met.dx.origin / self.radius, dy: met.dy.origin / self.radius }
    }

    /// Tells how a beam, one pixel of a ray wide, meets the ball from outside.
    pub(crate) fn meeting(&self, ray: &Ray) -> Meeting {
        let offset = ray.origin - self.centre;
        let closest = -offset.dot(ray.direction);
        if offset.length_squared() <= self.radius * self.radius {
            return Meeting::Met;
        }
        let aside = offset + ray.direction * closest;
        let distance = aside.length();
        let [dx, dy] = ray.spread(closest.max(0.0));
        let reach = 0.5 * (dx.length() + dy.length());
        if closest <= 0.0 || distance - reach > self.radius {
            return Meeting::Missed;
        }
        if distance + reach < self.radius {
            return Meeting::Met;
        }
        if reach > STRAIGHT * self.radius {
            return Meeting::Wide;
        }
        let outward = aside / distance;
        // Seen from an eye, the outline is where rays touch, at the tangent's distance: there a pixel is a little larger.
        Meeting::Crossed(Edge { gap: distance - self.radius, slope: [outward.dot(dx), outward.dot(dy)] })
    }
}
