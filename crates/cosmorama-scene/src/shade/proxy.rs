use std::str::FromStr;

use cosmorama::camera::Footprint;
use glam::DVec3;

use crate::ray::{Ray, footprint_of};
use crate::shape::Sphere;

/// Walls that stand for a near world: a ray is met with them, and the world is looked up in the direction of that place
/// from its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proxy {
    /// The point from which the world's picture was taken.
    pub centre: DVec3,
    /// Form of the walls, around the centre.
    pub walls: Walls,
}

/// Form of walls around a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Walls {
    /// A ball, by its radius.
    Sphere(f64),
    /// A room, by its size along x, y and z.
    Box(DVec3),
}

/// Text form: `sphere:RADIUS` or `box:X,Y,Z`.
impl FromStr for Walls {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let size = |number: &str| number.trim().parse().ok().filter(|size: &f64| size.is_finite() && *size > 0.0);
        let sizes = |text: &str| text.split(',').map(size).collect::<Option<Vec<f64>>>();
        let walls = match text.split_once(':') {
            Some(("sphere", radius)) => size(radius).map(Self::Sphere),
            Some(("box", edges)) => {
                sizes(edges).and_then(|edges| edges.try_into().ok()).map(|edges: [f64; 3]| Self::Box(edges.into()))
            }
            _ => None,
        };
        walls.ok_or_else(|| {
            "expected box:X,Y,Z, a room's size, or sphere:RADIUS, all more than 0, as in box:8,3,6".to_owned()
        })
    }
}

impl Proxy {
    /// Returns the part of the world that a ray sees. One that starts beyond the walls sees the world far away.
    pub(crate) fn footprint(&self, ray: &Ray) -> Footprint {
        let Some((distance, normal)) = self.wall(ray) else { return ray.footprint() };
        let met = ray.met(distance, normal);
        let offset = met.origin - self.centre;
        let away = offset.length();
        footprint_of(offset / away, [met.dx.origin / away, met.dy.origin / away])
    }

    /// Returns the distance of the wall that a ray meets from inside, and the wall's normal.
    fn wall(&self, ray: &Ray) -> Option<(f64, DVec3)> {
        let offset = ray.origin - self.centre;
        match self.walls {
            Walls::Sphere(radius) => {
                let ball = Sphere::new(self.centre, radius);
                let distance = (offset.length() < radius).then(|| ball.meet(ray, 0.0))??;
                Some((distance, ball.normal_at(ray.at(distance))))
            }
            Walls::Box(edges) => {
                let half = 0.5 * edges;
                if offset.abs().cmpge(half).any() {
                    return None;
                }
                let wall = |axis: usize| {
                    let towards = ray.direction[axis].signum();
                    ((half[axis] * towards - offset[axis]) / ray.direction[axis], DVec3::AXES[axis] * towards)
                };
                (0..3).filter(|axis| ray.direction[*axis] != 0.0).map(wall).min_by(|a, b| a.0.total_cmp(&b.0))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::sphere::Direction;

    use super::*;
    use crate::ray::RayChange;

    const WALLS: [Walls; 2] = [Walls::Sphere(3.0), Walls::Box(DVec3::new(8.0, 3.0, 6.0))];

    fn ray(direction: Direction, origin: DVec3) -> Ray {
        let (right, up) = direction.vector().any_orthonormal_pair();
        let change = |turned: DVec3| RayChange { origin: turned * 0.3, direction: turned };
        Ray { origin, direction: direction.vector(), dx: change(right), dy: change(up) }
    }

    #[test]
    fn places_on_walls_are_those_of_their_formulas() {
        for walls in WALLS {
            let proxy = Proxy { centre: DVec3::new(0.5, -0.25, 1.0), walls };
            for direction in Direction::spread(300) {
                let start = DVec3::new(0.4, 0.3, -0.5);
                let seen = proxy.footprint(&ray(direction, proxy.centre + start)).direction.vector();
                // The place is on the line from the start, and on a wall.
                let across = start.cross(direction.vector());
                let scale = across.length() / seen.cross(direction.vector()).length();
                let place = seen * scale;
                assert!(
                    (place - start).cross(direction.vector()).length() < 1e-9
                        && (place - start).dot(direction.vector()) > 0.0
                );
                let on_wall = match walls {
                    Walls::Sphere(radius) => place.length() / radius,
                    Walls::Box(edges) => (place / (0.5 * edges)).abs().max_element(),
                };
                assert!((on_wall - 1.0).abs() < 1e-9, "{walls:?}: {place}");
            }
            let beyond = ray(Direction::UP, proxy.centre + DVec3::X * 5.0);
            assert_eq!(proxy.footprint(&beyond), beyond.footprint());
        }
    }

    #[test]
    fn derivatives_are_those_of_central_differences() {
        const STEP: f64 = 1e-6;
        for walls in WALLS {
            let proxy = Proxy { centre: DVec3::ZERO, walls };
            for direction in Direction::spread(300) {
                let ray = ray(direction, DVec3::new(0.4, 0.3, -0.5));
                let moved = |step: f64| {
                    let direction = (ray.direction + ray.dx.direction * step).normalize();
                    proxy.footprint(&Ray { origin: ray.origin + ray.dx.origin * step, direction, ..ray })
                };
                let [before, after] = [-STEP, STEP].map(|step| moved(step).direction.vector());
                let (found, expected) = (proxy.footprint(&ray).jacobian.dx, (after - before) / (2.0 * STEP));
                assert!(
                    (found - expected).length() < 1e-5 * (1.0 + expected.length()),
                    "{walls:?}: {found} for {expected}"
                );
            }
        }
    }

    #[test]
    fn walls_have_a_text_form() {
        assert_eq!("box:8,3,6".parse(), Ok(WALLS[1]));
        assert_eq!("sphere:3".parse(), Ok(WALLS[0]));
        for wrong in ["box:8,3", "box:8,3,-6", "sphere:nan", "room", "sphere:0"] {
            assert!(wrong.parse::<Walls>().is_err_and(|error| error.contains("box:X,Y,Z")), "{wrong}");
        }
    }
}
