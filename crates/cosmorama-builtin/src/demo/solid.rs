use glam::{DVec2, DVec3};

use super::ray::Ray;

/// Where a ray enters a solid: distance and outward normal. Rays that start inside a solid do not meet it.
pub(super) type Entry = (f64, DVec3);

/// A ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) centre: DVec3,
    pub(super) radius: f64,
}

impl Ball {
    pub(super) fn entry(&self, ray: &Ray) -> Option<Entry> {
        let from_centre = ray.origin - self.centre;
        let half_b = from_centre.dot(ray.direction);
        let discriminant = half_b * half_b - (from_centre.length_squared() - self.radius * self.radius);
        if half_b >= 0.0 || discriminant <= 0.0 {
            return None;
        }
        let distance = -half_b - discriminant.sqrt();
        (distance > 0.0).then(|| (distance, (from_centre + ray.direction * distance) / self.radius))
    }
}

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cuboid {
    pub(super) least: DVec3,
    pub(super) greatest: DVec3,
}

impl Cuboid {
    /// Whether the ray meets the box or starts inside it: the quick test for what the box surrounds.
    pub(super) fn touches(&self, ray: &Ray) -> bool {
        let (enter, leave, _) = self.span(ray);
        enter < leave && leave > 0.0
    }

    pub(super) fn entry(&self, ray: &Ray) -> Option<Entry> {
        let (enter, leave, axis) = self.span(ray);
        if enter >= leave || enter <= 0.0 {
            return None;
        }
        let mut normal = DVec3::ZERO;
        normal[axis] = -ray.direction[axis].signum();
        Some((enter, normal))
    }

    /// Distances at which the ray's line enters and leaves, and the axis along which it enters.
    fn span(&self, ray: &Ray) -> (f64, f64, usize) {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut axis = 0;
        for candidate in 0..3 {
            let (near, far) =
                slab(ray.origin[candidate], ray.direction[candidate], self.least[candidate], self.greatest[candidate]);
            if near > enter {
                (enter, axis) = (near, candidate);
            }
            leave = leave.min(far);
        }
        (enter, leave, axis)
    }
}

/// An upright cylinder with a floor and a lid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drum {
    /// x and z of its axis.
    pub(super) axis: DVec2,
    pub(super) radius: f64,
    pub(super) bottom: f64,
    pub(super) top: f64,
}

impl Drum {
    pub(super) fn entry(&self, ray: &Ray) -> Option<Entry> {
        let from_axis = DVec2::new(ray.origin.x, ray.origin.z) - self.axis;
        let across = DVec2::new(ray.direction.x, ray.direction.z);
        // A vertical ray would divide by zero; this is far below what changes any other ray.
        let a = across.length_squared().max(1e-24);
        let half_b = from_axis.dot(across);
        let discriminant = half_b * half_b - a * (from_axis.length_squared() - self.radius * self.radius);
        if discriminant <= 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let (side_in, side_out) = ((-half_b - root) / a, (-half_b + root) / a);
        let (lid_in, lid_out) = slab(ray.origin.y, ray.direction.y, self.bottom, self.top);
        let enter = side_in.max(lid_in);
        if enter >= side_out.min(lid_out) || enter <= 0.0 {
            return None;
        }
        if lid_in > side_in {
            return Some((enter, DVec3::new(0.0, -ray.direction.y.signum(), 0.0)));
        }
        let outward = (from_axis + across * enter) / self.radius;
        Some((enter, DVec3::new(outward.x, 0.0, outward.y)))
    }
}

/// Distances at which a ray enters and leaves the slab between two planes, along one axis. A ray along the
/// planes divides by zero, which gives the infinities that are wanted.
fn slab(origin: f64, direction: f64, least: f64, greatest: f64) -> (f64, f64) {
    let (a, b) = ((least - origin) / direction, (greatest - origin) / direction);
    (a.min(b), a.max(b))
}

/// Equal things in a row along z, so that a ray tests only those that it passes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Where the row stands.
    pub(super) x: f64,
    /// z of the first thing, the one furthest to the front.
    pub(super) first: f64,
    pub(super) spacing: f64,
    pub(super) count: usize,
    /// No thing is wider than this about its axis.
    pub(super) reach: f64,
}

impl Row {
    /// z of each thing that the ray may meet.
    pub(super) fn passed(&self, ray: &Ray) -> impl Iterator<Item = f64> + use<> {
        let (enter, leave) = slab(ray.origin.x, ray.direction.x, self.x - self.reach, self.x + self.reach);
        // Finite bounds: longer than any row, so that a ray along the row is no special case.
        let (enter, leave) = (enter.clamp(0.0, 1e3), leave.clamp(0.0, 1e3));
        let (from, to) = (ray.at(enter).z, ray.at(leave).z);
        let index = |z: f64| (z - self.first) / self.spacing;
        let margin = self.reach / self.spacing;
        let start = (index(from.min(to)) - margin).ceil().max(0.0) as usize;
        // As casts of floats saturate, a row that is passed in front ends at zero.
        let end = if enter < leave { ((index(from.max(to)) + margin).floor() + 1.0) as usize } else { 0 };
        let (first, spacing) = (self.first, self.spacing);
        (start..end.min(self.count)).map(move |i| first + spacing * i as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALONG_Z: Ray = Ray { origin: DVec3::new(0.0, 1.0, 0.0), direction: DVec3::NEG_Z };

    #[test]
    fn solids_are_entered_at_their_near_side() {
        let ball = Ball { centre: DVec3::new(0.0, 1.0, -5.0), radius: 2.0 };
        assert_eq!(ball.entry(&ALONG_Z), Some((3.0, DVec3::Z)));
        let drum = Drum { axis: DVec2::new(0.0, -5.0), radius: 1.0, bottom: 0.0, top: 2.0 };
        assert_eq!(drum.entry(&ALONG_Z), Some((4.0, DVec3::Z)));
        let cuboid = Cuboid { least: DVec3::new(-1.0, 0.0, -6.0), greatest: DVec3::new(1.0, 2.0, -4.0) };
        assert_eq!(cuboid.entry(&ALONG_Z), Some((4.0, DVec3::Z)));
    }

    #[test]
    fn a_drum_is_entered_through_its_lid() {
        let drum = Drum { axis: DVec2::ZERO, radius: 1.0, bottom: -2.0, top: -1.0 };
        let down = Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Y };
        assert_eq!(drum.entry(&down), Some((1.0, DVec3::Y)));
    }

    #[test]
    fn a_row_names_what_a_ray_passes() {
        let row = Row { x: 2.0, first: -10.0, spacing: 5.0, count: 5, reach: 0.5 };
        let toward = |x: f64, z: f64| Ray { origin: DVec3::ZERO, direction: DVec3::new(x, 0.0, z).normalize() };
        assert_eq!(row.passed(&toward(2.0, -5.0)).collect::<Vec<_>>(), [-5.0]);
        assert_eq!(row.passed(&toward(-2.0, -5.0)).count(), 0);
        assert_eq!(row.passed(&toward(0.0, -1.0)).count(), 0);
    }
}
