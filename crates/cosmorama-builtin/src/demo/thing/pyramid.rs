use glam::DVec3;

use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};
use crate::demo::solid::{Ball, Cuboid};

/// Stairs on all four sides, with a golden ball on top.
pub(in crate::demo) struct Pyramid {
    /// Middle of its base.
    foot: DVec3,
    steps: u32,
    /// Height of a step; each is set back by twice this length.
    rise: f64,
}

impl Pyramid {
    /// A small pyramid nearby, to the left.
    pub(in crate::demo) const LEFT: Self = Self { foot: DVec3::new(-15.0, 0.0, -5.0), steps: 14, rise: 0.28 };
    /// A great pyramid behind the viewer, at the end of the arcade's axis.
    pub(in crate::demo) const BACK: Self = Self { foot: DVec3::new(0.0, 0.0, 62.0), steps: 16, rise: 0.9 };

    fn half_width(&self, step: u32) -> f64 {
        1.5 * self.rise * f64::from(self.steps - step) + self.rise
    }

    fn step(&self, step: u32) -> Cuboid {
        let (half, bottom) = (self.half_width(step), self.rise * f64::from(step));
        Cuboid {
            least: self.foot + DVec3::new(-half, bottom, -half),
            greatest: self.foot + DVec3::new(half, bottom + self.rise, half),
        }
    }

    fn ball(&self) -> Ball {
        let radius = 2.2 * self.rise;
        Ball { centre: self.foot + DVec3::Y * (self.rise * f64::from(self.steps) + radius), radius }
    }

    fn bounds(&self) -> Cuboid {
        let mut bounds = self.step(0);
        bounds.greatest.y = self.ball().centre.y + self.ball().radius;
        bounds
    }

    /// Returns the hit with a step, among those at the heights that the ray passes inside the bounds.
    fn stairs(&self, ray: &Ray, inside: (f64, f64)) -> Option<Hit> {
        let (from, to) = (ray.at(inside.0).y / self.rise, ray.at(inside.1).y / self.rise);
        // Casts saturate; the margin is for rounding.
        let (lowest, highest) = ((from.min(to) - 1e-6) as u32, (from.max(to) + 1e-6) as u32);
        (lowest..self.steps.min(highest + 1)).fold(None, |nearest, step| {
            let hit = self.step(step).entry(ray).map(|(distance, normal)| {
                let shade = if step % 2 == 0 { 1.0 } else { 0.86 };
                Hit { distance, normal, surface: Surface::matte(DVec3::new(0.70, 0.58, 0.42) * shade) }
            });
            nearer(nearest, hit)
        })
    }
}

impl Part for Pyramid {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        let inside = self.bounds().inside(ray)?;
        let gold = Surface { mirror: 0.35, ..Surface::matte(DVec3::new(0.85, 0.58, 0.18)) };
        let ball = self.ball().entry(ray).map(|(distance, normal)| Hit { distance, normal, surface: gold });
        nearer(self.stairs(ray, inside), ball)
    }
}
