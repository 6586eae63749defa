use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray as BoxRay, RayHit};
use obvhs::{Boundable, BvhBuildParams};

use super::super::{Hit, Sphere};
use crate::ray::Ray;

/// Corners of a triangle.
pub(super) type Corners = [DVec3; 3];

/// Triangles in a tree of boxes. Boxes are in single precision, a little larger than what they hold; triangles are met in
/// double precision.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    boxes: CwBvh,
    /// Triangles, in the order of the leaves.
    corners: Vec<Corners>,
    /// Ball around all. Boxes are in its units.
    ball: Sphere,
}

/// Room around a box, in radii of the whole, for what single precision rounds: some 10 units of its last place.
const ROOM: f32 = 2e-6;

/// A triangle's box.
struct Boxed(Aabb);

impl Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Tree {
    /// Builds the tree of some triangles, at least one. Returns their order in it, too.
    pub(super) fn new(corners: &[Corners]) -> (Self, Vec<u32>) {
        let ball = ball_around(corners);
        let local = |point: DVec3| ((point - ball.centre) / ball.radius).as_vec3a();
        let boxed = |corners: &Corners| {
            let Aabb { min, max } = Aabb::from_points(&corners.map(local));
            Boxed(Aabb::new(min - Vec3A::splat(ROOM), max + Vec3A::splat(ROOM)))
        };
        let boxes: Vec<Boxed> = corners.iter().map(boxed).collect();
        let mut boxes = build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut Default::default());
        let order = std::mem::take(&mut boxes.primitive_indices);
        let corners = order.iter().map(|k| corners[*k as usize]).collect();
        (Self { boxes, corners, ball }, order)
    }

    /// Returns the ball around all triangles.
    pub(super) fn ball(&self) -> &Sphere {
        &self.ball
    }

    /// Returns the corners of a triangle, by its place in the tree.
    pub(super) fn corners(&self, face: usize) -> &Corners {
        &self.corners[face]
    }

    /// Turns a triangle round, by its place in the tree.
    pub(super) fn turn(&mut self, face: usize) {
        self.corners[face].swap(1, 2);
    }

    /// Calls `visit` with each triangle that a ray meets.
    pub(super) fn each_met(&self, ray: &Ray, mut visit: impl FnMut(usize)) {
        let Some(start) = self.start(ray) else { return };
        self.boxes.ray_traverse(self.local(ray, start), &mut RayHit::none(), |_, face| {
            if meet(ray, &self.corners[face]).is_some_and(|(distance, _)| distance > 0.0) {
                visit(face);
            }
            f32::INFINITY
        });
    }

    /// Returns whether a ray meets any triangle beyond a distance.
    pub(super) fn is_met(&self, ray: &Ray, beyond: f64) -> bool {
        let Some(start) = self.start(ray) else { return false };
        let is_hit = |face: usize| meet(ray, &self.corners[face]).is_some_and(|(distance, _)| distance > beyond);
        // Any distance of the ray's length is a hit, which ends the search.
        let is_missed = |_: &BoxRay, face: usize| if is_hit(face) { 0.0 } else { f32::INFINITY };
        !self.boxes.ray_traverse_miss(self.local(ray, start), is_missed)
    }

    /// Returns the first of some triangles that a ray meets beyond a distance.
    pub(super) fn meet(&self, ray: &Ray, beyond: f64, is_wanted: impl Fn(usize) -> bool) -> Option<Hit> {
        let start = self.start(ray)?;
        let mut nearest: Option<Hit> = None;
        self.boxes.ray_traverse(self.local(ray, start), &mut RayHit::none(), |_, face| {
            let most = nearest.as_ref().map_or(f64::INFINITY, |hit| hit.distance);
            let hit = meet(ray, &self.corners[face]).filter(|(distance, _)| *distance > beyond && *distance < most);
            let Some((distance, weights)) = hit.filter(|_| is_wanted(face)) else { return f32::INFINITY };
            nearest = Some(Hit { distance, face, weights });
            (distance / self.ball.radius - start) as f32 + ROOM
        });
        nearest
    }

    /// Returns the distance, in radii of the ball, to where a ray comes near it; `None` if it passes by.
    fn start(&self, ray: &Ray) -> Option<f64> {
        /// Radii before the ray's closest point, and greatest distance of that.
        const BEFORE: f64 = 1.5;
        const NEAR: f64 = 1.0 + 1e-9;
        let offset = (self.ball.centre - ray.origin) / self.ball.radius;
        let closest = offset.dot(ray.direction);
        let aside = offset - ray.direction * closest;
        let is_near = aside.length_squared() <= NEAR && (closest >= 0.0 || offset.length_squared() <= NEAR);
        is_near.then(|| (closest - BEFORE).max(0.0))
    }

    /// Returns a ray in the units of the boxes, from a distance in them.
    fn local(&self, ray: &Ray, start: f64) -> BoxRay {
        let origin = (ray.origin - self.ball.centre) / self.ball.radius + ray.direction * start;
        BoxRay::new_inf(origin.as_vec3a(), ray.direction.as_vec3a())
    }
}

/// Returns a ball around triangles: its centre is that of their box.
fn ball_around(corners: &[Corners]) -> Sphere {
    let points = || corners.iter().flatten();
    let low = points().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let centre = 0.5 * low + 0.5 * high;
    Sphere::new(centre, points().map(|point| point.distance(centre)).fold(0.0, f64::max))
}

/// Returns the distance at which a ray meets a triangle, and the weights of its second and third corners there.
///
/// The signs of the triple products D·(B × C) tell the side of each edge. Neighbours compute the same product with the other
/// sign, bit by bit, so that no ray slips between them.
fn meet(ray: &Ray, corners: &Corners) -> Option<(f64, [f64; 2])> {
    let [a, b, c] = corners.map(|corner| corner - ray.origin);
    let sides = [b.cross(c), c.cross(a), a.cross(b)].map(|normal| normal.dot(ray.direction));
    let is_inside = sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
    let sum = sides[0] + sides[1] + sides[2];
    if !is_inside || sum == 0.0 {
        return None;
    }
    let [first, second, third] = sides.map(|side| side / sum);
    Some(((a * first + b * second + c * third).dot(ray.direction), [second, third]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::RayChange;

    const STILL: RayChange = RayChange { origin: DVec3::ZERO, direction: DVec3::ZERO };

    /// Numbers that look like chance, from −1 to 1.
    fn chance(seed: usize) -> f64 {
        let wave = (seed as f64 * 12.9898).sin() * 43_758.545_3;
        2.0 * (wave - wave.floor()) - 1.0
    }

    fn point(seed: usize) -> DVec3 {
        DVec3::new(chance(3 * seed), chance(3 * seed + 1), chance(3 * seed + 2))
    }

    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        for (scale, away) in [(1.0, 0.5), (1e-3, 2e3), (1e4, -7.0)] {
            let triangle = |k: usize| [0, 1, 2].map(|c| (point(k) + 0.2 * point(9000 + 3 * k + c)) * scale + away);
            let corners: Vec<Corners> = (0..500).map(triangle).collect();
            let (tree, _) = Tree::new(&corners);
            let mut count = 0;
            for k in 0..2000 {
                let origin = point(70_000 + k) * 3.0 * scale + away;
                let target = point(90_000 + k) * scale + away;
                let ray = Ray { origin, direction: (target - origin).normalize(), dx: STILL, dy: STILL };
                let all = tree.corners.iter().filter_map(|corners| meet(&ray, corners)).map(|(distance, _)| distance);
                let expected = all.filter(|distance| *distance > 0.0).reduce(f64::min);
                let found = tree.meet(&ray, 0.0, |_| true).map(|hit| hit.distance);
                assert_eq!(found, expected, "ray {k}");
                assert_eq!(tree.is_met(&ray, 0.0), expected.is_some(), "ray {k}");
                count += usize::from(found.is_some());
            }
            assert!(count > 500, "{count} rays meet something");
        }
    }

    #[test]
    fn no_ray_slips_between_neighbours() {
        // A fan of triangles around a point that is no round number, met at the point and along its edges.
        let (middle, eye) = (DVec3::new(0.1, 0.7, -0.3), DVec3::new(0.3, -0.2, 3.1));
        let rim = |k: usize| middle + DVec3::new((k as f64 * 0.7).cos(), (k as f64 * 0.7).sin(), 0.1 * chance(k));
        let corners: Vec<Corners> = (0..10).map(|k| [middle, rim(k), rim(k + 1)]).collect();
        let (tree, _) = Tree::new(&corners);
        for k in 0..3000 {
            let target = middle.lerp(rim(k % 9), 0.3 * (chance(k) + 1.0));
            let direction = (target - eye).normalize();
            assert!(tree.is_met(&Ray { origin: eye, direction, dx: STILL, dy: STILL }, 0.0), "ray {k}");
        }
    }
}
