use glam::DVec3;

/// A line from a point, along which light is looked for.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Ray {
    pub(in crate::demo) origin: DVec3,
    /// Unit vector.
    pub(in crate::demo) direction: DVec3,
    /// One over each component of the direction, for the many slabs that a ray is tested against.
    pub(in crate::demo) inverse: DVec3,
    /// What is farther does not count: something nearer is known already, or the air hides it.
    pub(in crate::demo) reach: f64,
}

impl Ray {
    /// How far the air lets one see, in metres.
    const FARTHEST: f64 = 1e5;

    /// A ray that starts in the open.
    pub(in crate::demo) fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, inverse: direction.recip(), reach: Self::FARTHEST }
    }

    /// Whether a distance is ahead and within reach; not so for NaN.
    pub(in crate::demo) fn reaches(&self, distance: f64) -> bool {
        distance > 0.0 && distance < self.reach
    }

    /// The point at a distance.
    pub(in crate::demo) fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }

    /// A ray that leaves a surface, started a little above it lest it meet the surface itself.
    pub(in crate::demo) fn leaving(point: DVec3, normal: DVec3, direction: DVec3) -> Self {
        const CLEARANCE: f64 = 1e-5;
        Self::new(point + normal * CLEARANCE, direction)
    }
}

/// What a surface does with light.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Surface {
    /// Part of the light that is scattered to all sides.
    pub(in crate::demo) albedo: DVec3,
    /// Light of its own.
    pub(in crate::demo) glow: DVec3,
    /// Part of the light that is mirrored when seen square on.
    pub(in crate::demo) mirror: f64,
}

impl Surface {
    /// A surface without gloss or glow.
    pub(in crate::demo) const fn matte(albedo: DVec3) -> Self {
        Self { albedo, glow: DVec3::ZERO, mirror: 0.0 }
    }
}

/// Where a ray meets a part of the world.
#[derive(Clone, Copy, Debug)]
pub(in crate::demo) struct Hit {
    pub(in crate::demo) distance: f64,
    /// Unit vector, on the side from which the ray came.
    pub(in crate::demo) normal: DVec3,
    pub(in crate::demo) surface: Surface,
}

/// The nearer of two hits.
pub(in crate::demo) fn nearer(a: Option<Hit>, b: Option<Hit>) -> Option<Hit> {
    match (a, b) {
        (Some(first), Some(second)) => Some(if second.distance < first.distance { second } else { first }),
        (first, second) => first.or(second),
    }
}

/// A thing in the world.
pub(in crate::demo) trait Part: Sync {
    /// The first meeting of the ray with this part, ahead of the ray's origin and within its reach.
    fn hit(&self, ray: &Ray) -> Option<Hit>;
}
