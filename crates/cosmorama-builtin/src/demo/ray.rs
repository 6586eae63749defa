use glam::DVec3;

/// A ray from a point.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Ray {
    pub(in crate::demo) origin: DVec3,
    /// Direction, a unit vector.
    pub(in crate::demo) direction: DVec3,
    /// Reciprocal of each component of the direction, for tests against slabs.
    pub(in crate::demo) inverse: DVec3,
    /// Distance beyond which hits do not count: something nearer is known, or haze hides them.
    pub(in crate::demo) reach: f64,
}

impl Ray {
    /// Greatest visible distance through the haze, in metres.
    const FARTHEST: f64 = 1e5;

    /// Creates a ray that starts in the open.
    pub(in crate::demo) fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, inverse: direction.recip(), reach: Self::FARTHEST }
    }

    /// Returns whether a distance is ahead and within reach; false for NaN.
    pub(in crate::demo) fn reaches(&self, distance: f64) -> bool {
        distance > 0.0 && distance < self.reach
    }

    /// Returns the point at a distance.
    pub(in crate::demo) fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }

    /// Creates a ray that leaves a surface. It starts a little above, so that it does not hit the surface itself.
    pub(in crate::demo) fn leaving(point: DVec3, normal: DVec3, direction: DVec3) -> Self {
        const CLEARANCE: f64 = 1e-5;
        Self::new(point + normal * CLEARANCE, direction)
    }
}

/// Optical properties of a surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Surface {
    /// Fraction of light that is scattered in all directions.
    pub(in crate::demo) albedo: DVec3,
    /// Emitted light.
    pub(in crate::demo) glow: DVec3,
    /// Fraction of light that is mirrored at normal incidence.
    pub(in crate::demo) mirror: f64,
}

impl Surface {
    /// Creates a surface without gloss or glow.
    pub(in crate::demo) const fn matte(albedo: DVec3) -> Self {
        Self { albedo, glow: DVec3::ZERO, mirror: 0.0 }
    }
}

/// Intersection of a ray with a part of the world.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Hit {
    pub(in crate::demo) distance: f64,
    /// Unit normal on the side from which the ray came.
    pub(in crate::demo) normal: DVec3,
    pub(in crate::demo) surface: Surface,
}

/// Returns the nearer of two hits.
pub(in crate::demo) fn nearer(a: Option<Hit>, b: Option<Hit>) -> Option<Hit> {
    match (a, b) {
        (Some(first), Some(second)) => Some(if second.distance < first.distance { second } else { first }),
        (first, second) => first.or(second),
    }
}

/// A part of the demo world.
pub(in crate::demo) trait Part: Sync {
    /// Returns the first intersection of the ray with this part, ahead of its origin and within its reach.
    fn hit(&self, ray: &Ray) -> Option<Hit>;
}
