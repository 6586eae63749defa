use glam::{DVec2, DVec3};

use crate::demo::hall;
use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};
use crate::demo::solid::{Ball, Drum, Row};

/// Gas globes on thin rods from the vault, two in every bay.
pub(in crate::demo) struct Lamps;

const ASIDE: f64 = 2.7;
const HEIGHT: f64 = 4.1;
const RADIUS: f64 = 0.17;

impl Part for Lamps {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        [-ASIDE, ASIDE].into_iter().fold(None, |nearest, x| {
            // In the middle of each bay.
            let first = hall::FIRST_COLUMN + hall::BAY / 2.0;
            let (bottom, top) = (HEIGHT - RADIUS, hall::vault_height(ASIDE));
            let row = Row { x, first, spacing: hall::BAY, count: hall::COLUMNS - 1, radius: RADIUS, bottom, top };
            row.passed(ray).fold(nearest, |nearest, z| nearer(nearest, lamp(ray, DVec2::new(x, z))))
        })
    }
}

fn lamp(ray: &Ray, axis: DVec2) -> Option<Hit> {
    let top = hall::vault_height(axis.x);
    Drum { axis, radius: RADIUS, bottom: HEIGHT - RADIUS, top }.heights(ray)?;
    let globe = Ball { centre: DVec3::new(axis.x, HEIGHT, axis.y), radius: RADIUS };
    let globe = globe.entry(ray).map(|(distance, normal)| {
        // Milk glass: brightest where seen square on.
        let glow = DVec3::new(1.7, 1.15, 0.58) * (0.45 + 0.55 * -normal.dot(ray.direction));
        Hit { distance, normal, surface: Surface { glow, ..Surface::matte(DVec3::splat(0.3)) } }
    });
    let rod = Drum { axis, radius: 0.014, bottom: HEIGHT, top };
    let cap = Drum { axis, radius: 0.07, bottom: HEIGHT + RADIUS - 0.02, top: HEIGHT + RADIUS + 0.06 };
    [rod, cap].into_iter().fold(globe, |nearest, drum| {
        let surface = Surface::matte(DVec3::new(0.30, 0.21, 0.08));
        nearer(nearest, drum.entry(ray).map(|(distance, normal)| Hit { distance, normal, surface }))
    })
}
