use std::ops::Range;

use glam::{DVec2, DVec3};

use super::ray::Ray;

/// Entry of a ray into a solid: distance and outward normal. Rays that start inside a solid do not hit it.
pub(in crate::demo) type Entry = (f64, DVec3);

/// A ball.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Ball {
    pub(in crate::demo) centre: DVec3,
    pub(in crate::demo) radius: f64,
}

impl Ball {
    pub(in crate::demo) fn entry(&self, ray: &Ray) -> Option<Entry> {
        let from_centre = ray.origin - self.centre;
        let half_b = from_centre.dot(ray.direction);
        let discriminant = half_b * half_b - (from_centre.length_squared() - self.radius * self.radius);
        if half_b >= 0.0 || discriminant <= 0.0 {
            return None;
        }
        let distance = -half_b - discriminant.sqrt();
        ray.reaches(distance).then(|| (distance, (from_centre + ray.direction * distance) / self.radius))
    }
}

/// A box aligned with the axes.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Cuboid {
    pub(in crate::demo) least: DVec3,
    pub(in crate::demo) greatest: DVec3,
}

impl Cuboid {
    /// Returns the range of distances at which the ray is inside the box: a quick test for its contents.
    pub(in crate::demo) fn inside(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (enter, leave, _) = self.span(ray);
        let (enter, leave) = (enter.max(0.0), leave.min(ray.reach));
        (enter < leave).then_some((enter, leave))
    }

    pub(in crate::demo) fn entry(&self, ray: &Ray) -> Option<Entry> {
        let (enter, leave, axis) = self.span(ray);
        if enter >= leave || !ray.reaches(enter) {
            return None;
        }
        let mut normal = DVec3::ZERO;
        normal[axis] = -ray.direction[axis].signum();
        Some((enter, normal))
    }

    /// Returns the distances at which the ray's line enters and leaves, and the axis of the face where it enters.
    fn span(&self, ray: &Ray) -> (f64, f64, usize) {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut axis = 0;
        for candidate in 0..3 {
            let (near, far) =
                slab(ray.origin[candidate], ray.inverse[candidate], self.least[candidate], self.greatest[candidate]);
            if near > enter {
                (enter, axis) = (near, candidate);
            }
            leave = leave.min(far);
        }
        (enter, leave, axis)
    }
}

/// An upright cylinder with top and bottom.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Drum {
    /// x and z of the cylinder's axis.
    pub(in crate::demo) axis: DVec2,
    pub(in crate::demo) radius: f64,
    pub(in crate::demo) bottom: f64,
    pub(in crate::demo) top: f64,
}

impl Drum {
    pub(in crate::demo) fn entry(&self, ray: &Ray) -> Option<Entry> {
        let (side_in, side_out) = self.side(ray)?;
        let (lid_in, lid_out) = slab(ray.origin.y, ray.inverse.y, self.bottom, self.top);
        let enter = side_in.max(lid_in);
        if enter >= side_out.min(lid_out) || !ray.reaches(enter) {
            return None;
        }
        if lid_in > side_in {
            return Some((enter, DVec3::new(0.0, -ray.direction.y.signum(), 0.0)));
        }
        let outward = (ray.at(enter) - DVec3::new(self.axis.x, 0.0, self.axis.y)) / self.radius;
        Some((enter, DVec3::new(outward.x, 0.0, outward.z)))
    }

    /// Returns the range of heights of the ray inside: a quick test for the drum's contents.
    pub(in crate::demo) fn heights(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (side_in, side_out) = self.side(ray)?;
        let (lid_in, lid_out) = slab(ray.origin.y, ray.inverse.y, self.bottom, self.top);
        let (enter, leave) = (side_in.max(lid_in).max(0.0), side_out.min(lid_out).min(ray.reach));
        let (a, b) = (ray.at(enter).y, ray.at(leave).y);
        (enter < leave).then_some((a.min(b), a.max(b)))
    }

    /// Returns the distances at which the ray's line enters and leaves the infinite cylinder.
    fn side(&self, ray: &Ray) -> Option<(f64, f64)> {
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
        Some(((-half_b - root) / a, (-half_b + root) / a))
    }
}

/// Returns the distances at which a ray enters and leaves the slab between two planes, along one axis. For a ray
/// parallel to the planes the inverse is infinite, and so are the distances, as required.
fn slab(origin: f64, inverse: f64, least: f64, greatest: f64) -> (f64, f64) {
    let (a, b) = ((least - origin) * inverse, (greatest - origin) * inverse);
    (a.min(b), a.max(b))
}

/// A row of equal objects along z, of which a ray tests only those that it passes.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Row {
    /// x of the row.
    pub(in crate::demo) x: f64,
    /// z of the first object, the one furthest to the front.
    pub(in crate::demo) first: f64,
    pub(in crate::demo) spacing: f64,
    pub(in crate::demo) count: usize,
    /// Greatest radius of an object about its axis.
    pub(in crate::demo) radius: f64,
    /// Lowest height of an object.
    pub(in crate::demo) bottom: f64,
    /// Greatest height of an object.
    pub(in crate::demo) top: f64,
}

impl Row {
    /// Visits the z of each object that the ray may hit.
    pub(in crate::demo) fn passed(&self, ray: &Ray) -> impl Iterator<Item = f64> + use<> {
        let (first, spacing) = (self.first, self.spacing);
        self.indices(ray).map(move |i| first + spacing * i as f64)
    }

    fn indices(&self, ray: &Ray) -> Range<usize> {
        let across = slab(ray.origin.x, ray.inverse.x, self.x - self.radius, self.x + self.radius);
        let height = slab(ray.origin.y, ray.inverse.y, self.bottom, self.top);
        // Bounds are kept finite, longer than any row, so that a ray along the row is no special case.
        let enter = across.0.max(height.0).max(0.0);
        let leave = across.1.min(height.1).min(ray.reach).min(1e3);
        if enter >= leave {
            return 0..0;
        }
        let (from, to) = (ray.at(enter).z, ray.at(leave).z);
        let nearest = (from.min(to) - self.radius - self.first) / self.spacing;
        let farthest = (from.max(to) + self.radius - self.first) / self.spacing;
        if farthest < 0.0 {
            return 0..0;
        }
        // Casts round toward zero and saturate: at most one thing too many at the near end.
        nearest as usize..(farthest as usize + 1).min(self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_are_entered_at_their_near_side() {
        let forward = Ray::new(DVec3::new(0.0, 1.0, 0.0), DVec3::NEG_Z);
        let ball = Ball { centre: DVec3::new(0.0, 1.0, -5.0), radius: 2.0 };
        assert_eq!(ball.entry(&forward), Some((3.0, DVec3::Z)));
        let drum = Drum { axis: DVec2::new(0.0, -5.0), radius: 1.0, bottom: 0.0, top: 2.0 };
        assert_eq!(drum.entry(&forward), Some((4.0, DVec3::Z)));
        let cuboid = Cuboid { least: DVec3::new(-1.0, 0.0, -6.0), greatest: DVec3::new(1.0, 2.0, -4.0) };
        assert_eq!(cuboid.entry(&forward), Some((4.0, DVec3::Z)));
    }

    #[test]
    fn a_drum_is_entered_through_its_lid() {
        let drum = Drum { axis: DVec2::ZERO, radius: 1.0, bottom: -2.0, top: -1.0 };
        let down = Ray::new(DVec3::ZERO, DVec3::NEG_Y);
        assert_eq!(drum.entry(&down), Some((1.0, DVec3::Y)));
    }

    #[test]
    fn a_row_names_what_a_ray_passes() {
        let row = Row { x: 2.0, first: -10.0, spacing: 5.0, count: 5, radius: 0.5, bottom: -1.0, top: 1.0 };
        let passed = |x: f64, y: f64, z: f64| {
            row.passed(&Ray::new(DVec3::ZERO, DVec3::new(x, y, z).normalize())).collect::<Vec<_>>()
        };
        assert!(passed(2.0, 0.0, -5.0).contains(&-5.0));
        assert!(passed(2.0, 0.0, -5.0).len() <= 2);
        assert!(passed(-2.0, 0.0, -5.0).is_empty());
        assert!(passed(0.0, 0.0, -1.0).is_empty());
        assert!(passed(2.0, 5.0, -5.0).is_empty());
    }
}
