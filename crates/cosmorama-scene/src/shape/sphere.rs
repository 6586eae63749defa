use std::f64::consts::{PI, TAU};

use cosmorama::filter::Wrap;
use cosmorama::sphere::Orientation;
use glam::{DVec2, DVec3};

use super::{Chart, Edge, Solid, Wall};
use crate::ray::{Normal, Ray};

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
    /// Orientation of pictures around it.
    pub orientation: Orientation,
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
    pub const fn new(centre: DVec3, radius: f64) -> Self {
        Self { centre, radius, orientation: Orientation::IDENTITY }
    }

    /// Returns the way in which pictures go on around a ball, by that across: they end at the poles.
    pub const fn wrap(across: Wrap) -> [Wrap; 2] {
        [across, Wrap::Clamp]
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
        Wall { met, normal: self.normal(&met), distance, part: 0, chart: None }
    }

    /// Returns the surface as a ray from outside first sees it, with its place on pictures.
    pub(crate) fn seen(&self, ray: &Ray) -> Option<Wall> {
        Some(self.seen_at(ray, self.meet(ray, 0.0)?))
    }

    /// Returns the surface where a ray meets it, at a distance, with its place on pictures.
    pub(super) fn seen_at(&self, ray: &Ray, distance: f64) -> Wall {
        let wall = self.wall_at(ray, distance);
        Wall { chart: Some(self.chart(&wall.normal)), ..wall }
    }

    /// Returns the place on a picture that goes around the ball by longitude and latitude: its middle faces +Z, its top
    /// is +Y, and u goes around towards +X, unless it is turned.
    fn chart(&self, normal: &Normal) -> Chart {
        /// Least distance from the axis, so that the poles are places, too.
        const NEAREST: f64 = 1e-9;
        let own = |vector: DVec3| self.orientation.vector_to_view(vector);
        let DVec3 { x, y, z } = own(normal.unit);
        let axis = x.hypot(z).max(NEAREST);
        let change =
            |turned: DVec3| DVec2::new((z * turned.x - x * turned.z) / (axis * axis * TAU), -turned.y / (axis * PI));
        let tangent = self.orientation.rotation() * DVec3::new(z, 0.0, -x).try_normalize().unwrap_or(DVec3::X);
        Chart {
            at: DVec2::new(0.5 + x.atan2(z) / TAU, axis.atan2(y) / PI),
            dx: change(own(normal.dx)),
            dy: change(own(normal.dy)),
            // A ball bends more than its perspective does.
            nearing: DVec2::ZERO,
            tangent,
            bitangent: normal.unit.cross(tangent),
        }
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
