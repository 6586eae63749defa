use cosmorama::camera::Footprint;
use cosmorama::sphere::Direction;
use glam::{DMat3, DVec2, DVec3};

/// A ray with its derivatives along the screen: the beam that a pixel sees (Igehy 1999).
///
/// Reflection, refraction and the way to a surface carry the derivatives along. What leaves the last surface is a
/// [`Footprint`] of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// A point of the ray.
    pub origin: DVec3,
    /// Unit vector along the ray.
    pub direction: DVec3,
    /// Change for one pixel to the right.
    pub dx: RayChange,
    /// Change for one pixel down.
    pub dy: RayChange,
}

/// Change of a ray for a step of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayChange {
    /// Change of the origin.
    pub origin: DVec3,
    /// Change of the direction.
    pub direction: DVec3,
}

/// A surface's unit normal with its derivatives along the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    /// Unit normal.
    pub unit: DVec3,
    /// Change for one pixel to the right.
    pub dx: DVec3,
    /// Change for one pixel down.
    pub dy: DVec3,
}

impl Normal {
    /// Returns the normal of the other side.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { unit: -self.unit, dx: -self.dx, dy: -self.dy }
    }

    /// Returns the normal bent back until it just faces a ray, if it leans away from it: smooth normals do so at outlines.
    ///
    /// That is N − (D·N + ε)D, made a unit vector, with its derivatives.
    #[must_use]
    pub(crate) fn leaning_back(self, ray: &Ray) -> Self {
        /// Cosine between the normal and the way back.
        const LEAST: f64 = 1e-3;
        let (direction, slope) = (ray.direction, self.unit.dot(ray.direction) + LEAST);
        if slope <= 0.0 {
            return self;
        }
        let bent = self.unit - direction * slope;
        let length = bent.length();
        let unit = bent / length;
        let change = |turned: DVec3, moved: DVec3| {
            let steeper = turned.dot(direction) + self.unit.dot(moved);
            let change = turned - moved * slope - direction * steeper;
            (change - unit * unit.dot(change)) / length
        };
        Self { unit, dx: change(self.dx, ray.dx.direction), dy: change(self.dy, ray.dy.direction) }
    }

    /// Returns the normal of the side that a ray comes from.
    #[must_use]
    pub fn facing(self, ray: &Ray) -> Self {
        if self.unit.dot(ray.direction) > 0.0 { self.reversed() } else { self }
    }

    /// Returns the footprint of the directions that the surface faces.
    pub fn footprint(&self) -> Footprint {
        Footprint::new(Direction::from_unit(self.unit), self.dx, self.dy)
    }
}

impl Ray {
    /// Returns the point at a distance.
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }

    /// Returns the ray of a pixel whose side is this part of the whole pixel's.
    #[must_use]
    pub fn scaled(self, part: f64) -> Self {
        let scaled = |change: RayChange| RayChange { origin: change.origin * part, direction: change.direction * part };
        Self { dx: scaled(self.dx), dy: scaled(self.dy), ..self }
    }

    /// Returns the ray in another frame.
    #[must_use]
    pub(crate) fn turned(&self, turn: &DMat3) -> Self {
        let change =
            |change: RayChange| RayChange { origin: *turn * change.origin, direction: *turn * change.direction };
        Self {
            origin: *turn * self.origin,
            direction: *turn * self.direction,
            dx: change(self.dx),
            dy: change(self.dy),
        }
    }

    /// Returns the ray whose direction is turned, with its changes, about the point that it comes from.
    #[must_use]
    pub(crate) fn bent(&self, turn: &DMat3) -> Self {
        let bent = |change: RayChange| RayChange { direction: *turn * change.direction, ..change };
        Self { direction: *turn * self.direction, dx: bent(self.dx), dy: bent(self.dy), ..*self }
    }

    /// Returns the changes of the point at a distance, with the distance kept.
    pub fn spread(&self, distance: f64) -> [DVec3; 2] {
        [self.dx, self.dy].map(|change| change.origin + change.direction * distance)
    }

    /// Returns the change of a plane's nearness, one over the distance along the ray, for one pixel to the right and down, as a
    /// part of it. Of rays from one point, the directions D + dD·s meet the plane at 1/(D·N + dD·N s).
    pub fn nearing(&self, normal: DVec3) -> DVec2 {
        let changes = DVec2::new(self.dx.direction.dot(normal), self.dy.direction.dot(normal));
        changes / self.direction.dot(normal)
    }

    /// Returns the ray as it meets a surface: its origin, and its changes, lie on the surface.
    ///
    /// With P' = P + tD the distance changes by dt = −((dP + t dD)·N)/(D·N) (Igehy 1999, equations 10 to 12).
    #[must_use]
    pub fn met(&self, distance: f64, normal: DVec3) -> Self {
        let slope = self.direction.dot(normal);
        let onto = |change: RayChange| {
            let moved = change.origin + change.direction * distance;
            RayChange { origin: moved - self.direction * (moved.dot(normal) / slope), direction: change.direction }
        };
        Self { origin: self.at(distance), direction: self.direction, dx: onto(self.dx), dy: onto(self.dy) }
    }

    /// Returns the mirrored ray of a ray that has met a surface: D − 2(D·N)N, with its derivatives (Igehy 1999,
    /// equations 14 and 15).
    #[must_use]
    pub fn reflected(&self, normal: &Normal) -> Self {
        let cosine = self.direction.dot(normal.unit);
        let mirrored = |change: RayChange, turned: DVec3| {
            let slope = change.direction.dot(normal.unit) + self.direction.dot(turned);
            let direction = change.direction - 2.0 * (cosine * turned + slope * normal.unit);
            RayChange { direction, ..change }
        };
        Self {
            origin: self.origin,
            direction: self.direction - 2.0 * cosine * normal.unit,
            dx: mirrored(self.dx, normal.dx),
            dy: mirrored(self.dy, normal.dy),
        }
    }

    /// Returns the refracted ray of a ray that has met a surface, by Snell's law; `None` where all light is reflected.
    ///
    /// `ratio` is the index before the surface over the index behind it; the normal faces the ray. The direction is
    /// ηD + μN with μ = η cos i − cos t (Igehy 1999, equations 16 to 19).
    #[must_use]
    pub fn refracted(&self, normal: &Normal, ratio: f64) -> Option<Self> {
        let incident = -self.direction.dot(normal.unit);
        let square = 1.0 - ratio * ratio * (1.0 - incident * incident);
        if square <= 0.0 {
            return None;
        }
        let transmitted = square.sqrt();
        let along = ratio * incident - transmitted;
        let bent = |change: RayChange, turned: DVec3| {
            let slope = -(change.direction.dot(normal.unit) + self.direction.dot(turned));
            let along_slope = (ratio - ratio * ratio * incident / transmitted) * slope;
            RayChange { direction: change.direction * ratio + turned * along + normal.unit * along_slope, ..change }
        };
        Some(Self {
            origin: self.origin,
            direction: (self.direction * ratio + normal.unit * along).normalize(),
            dx: bent(self.dx, normal.dx),
            dy: bent(self.dy, normal.dy),
        })
    }

    /// Returns the part of the world that the ray sees, if nothing is in its way.
    pub fn footprint(&self) -> Footprint {
        footprint_of(self.direction, [self.dx.direction, self.dy.direction])
    }

    /// Returns the longest change of the direction, in radians per pixel.
    pub fn widest(&self) -> f64 {
        self.dx.direction.length_squared().max(self.dy.direction.length_squared()).sqrt()
    }
}

/// Returns the part of the world about a direction; a point of it where the changes have no end, as those of a ray that only
/// touches a surface.
pub(crate) fn footprint_of(direction: DVec3, [dx, dy]: [DVec3; 2]) -> Footprint {
    let direction = Direction::from_unit(direction);
    if (dx.length_squared() + dy.length_squared()).is_finite() {
        Footprint::new(direction, dx, dy)
    } else {
        Footprint::point(direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Sphere;

    /// Returns the ray of a pinhole at a place of the screen, with its derivatives there.
    fn ray(x: f64, y: f64) -> Ray {
        let eye = DVec3::new(0.3, -0.2, 4.0);
        let towards = |x: f64, y: f64| DVec3::new(x, -y, -1.0).normalize();
        let (h, direction) = (1e-6, towards(x, y));
        let change = |a: DVec3, b: DVec3| RayChange { origin: DVec3::ZERO, direction: (a - b) / (2.0 * h) };
        Ray {
            origin: eye,
            direction,
            dx: change(towards(x + h, y), towards(x - h, y)),
            dy: change(towards(x, y + h), towards(x, y - h)),
        }
    }

    /// Returns a ray as it leaves a ball of glass: in, reflected inside once, and out.
    fn through(ray: &Ray) -> Option<Ray> {
        let ball = Sphere::new(DVec3::new(0.1, 0.0, 0.0), 1.0);
        let (inside, ratio) = (1e-9, 1.5);
        let met = ray.met(ball.meet(ray, 0.0)?, ball.normal_at(ray.at(ball.meet(ray, 0.0)?)));
        let entered = met.refracted(&ball.normal(&met), 1.0 / ratio)?;
        let distance = ball.meet(&entered, inside)?;
        let met = entered.met(distance, ball.normal_at(entered.at(distance)));
        let turned = met.reflected(&ball.normal(&met).facing(&met));
        let distance = ball.meet(&turned, inside)?;
        let met = turned.met(distance, ball.normal_at(turned.at(distance)));
        met.refracted(&ball.normal(&met).facing(&met), ratio)
    }

    #[test]
    fn derivatives_are_those_of_central_differences() {
        let h = 1e-5;
        let mut count = 0;
        for k in 0..200 {
            let (x, y) = (-0.2 + 0.002 * f64::from(k), 0.13 * (f64::from(k) * 0.7).sin());
            let (Some(found), Some(left), Some(right)) =
                (through(&ray(x, y)), through(&ray(x - h, y)), through(&ray(x + h, y)))
            else {
                continue;
            };
            let expected = (right.direction - left.direction) / (2.0 * h);
            let error = (found.dx.direction - expected).length() / (1.0 + expected.length());
            assert!(error < 1e-5, "({x}, {y}): {:?} for {expected:?}", found.dx.direction);
            let moved = (right.origin - left.origin) / (2.0 * h);
            assert!((found.dx.origin - moved).length() < 1e-5 * (1.0 + moved.length()), "({x}, {y})");
            count += 1;
        }
        assert!(count > 100, "{count} rays meet the ball");
    }

    #[test]
    fn normals_that_lean_away_just_face_the_ray() {
        let (here, h) = (ray(0.1, 0.05), 1e-6);
        let lean = |x: f64| DVec3::new(0.8 + x, 0.3, -0.4 + 0.2 * x).normalize();
        let normal = |x: f64| Normal { unit: lean(x), dx: (lean(x + h) - lean(x - h)) / (2.0 * h), dy: DVec3::ZERO };
        let bent = normal(0.0).leaning_back(&here);
        assert!(normal(0.0).unit.dot(here.direction) > 0.1);
        let slope = bent.unit.dot(here.direction);
        assert!(slope < 0.0 && slope > -2e-3 && (bent.unit.length() - 1.0).abs() < 1e-12, "{slope}");
        let [left, right] = [-h, h].map(|x| normal(x).leaning_back(&ray(0.1 + x, 0.05)).unit);
        let expected = (right - left) / (2.0 * h);
        assert!((bent.dx - expected).length() < 1e-6, "{} for {expected}", bent.dx);
        let facing = Normal { unit: -here.direction, ..bent };
        assert_eq!(facing.leaning_back(&here), facing);
    }

    #[test]
    fn rays_that_touch_see_a_point_of_the_world() {
        let met = ray(0.1, 0.2).met(3.0, DVec3::Z.cross(ray(0.1, 0.2).direction).normalize());
        let still = Normal { unit: DVec3::Z, dx: met.dx.origin / 0.0, dy: DVec3::ZERO };
        let seen = met.reflected(&still).footprint();
        assert_eq!(seen, Footprint::point(seen.direction));
    }

    #[test]
    fn steep_rays_inside_glass_do_not_leave_it() {
        let normal = Normal { unit: DVec3::Z, dx: DVec3::ZERO, dy: DVec3::ZERO };
        let still = RayChange { origin: DVec3::ZERO, direction: DVec3::ZERO };
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Ray { origin: DVec3::ZERO, direction: DVec3::new(sin, 0.0, -cos), dx: still, dy: still }
        };
        // The critical angle of glass is asin(1/1.5) = 41.81°.
        assert!(at(41.8).refracted(&normal, 1.5).is_some() && at(41.9).refracted(&normal, 1.5).is_none());
        let bent = at(30.0).refracted(&normal, 1.5).expect("below the critical angle").direction;
        assert!((bent.x - 0.75).abs() < 1e-12 && (bent.length() - 1.0).abs() < 1e-12);
    }
}
