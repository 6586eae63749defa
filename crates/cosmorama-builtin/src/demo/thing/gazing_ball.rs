use glam::{DVec2, DVec3};

use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};
use crate::demo::solid::{Ball, Cuboid, Drum};

/// A ball of silvered glass on a pedestal, to the right, which mirrors the whole world.
pub(in crate::demo) struct GazingBall;

const AXIS: DVec2 = DVec2::new(8.6, -1.4);
const BALL: Ball = Ball { centre: DVec3::new(AXIS.x, 2.45, AXIS.y), radius: 1.35 };
/// Bounding box of ball and pedestal, for the many rays that miss them.
const BOUNDS: Cuboid = Cuboid {
    least: DVec3::new(AXIS.x - BALL.radius, 0.0, AXIS.y - BALL.radius),
    greatest: DVec3::new(AXIS.x + BALL.radius, BALL.centre.y + BALL.radius, AXIS.y + BALL.radius),
};
const PEDESTAL: [Drum; 3] = [
    Drum { axis: AXIS, radius: 1.3, bottom: 0.0, top: 0.25 },
    Drum { axis: AXIS, radius: 0.8, bottom: 0.25, top: 0.95 },
    Drum { axis: AXIS, radius: 1.0, bottom: 0.95, top: 1.2 },
];

impl Part for GazingBall {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        BOUNDS.inside(ray)?;
        let silver = Surface { mirror: 0.82, ..Surface::matte(DVec3::new(0.5, 0.55, 0.6)) };
        let stone = Surface::matte(DVec3::new(0.62, 0.58, 0.52));
        let ball = BALL.entry(ray).map(|(distance, normal)| Hit { distance, normal, surface: silver });
        PEDESTAL.iter().fold(ball, |nearest, drum| {
            nearer(nearest, drum.entry(ray).map(|(distance, normal)| Hit { distance, normal, surface: stone }))
        })
    }
}
