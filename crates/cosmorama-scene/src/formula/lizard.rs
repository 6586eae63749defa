use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use cosmorama::sphere::Angle;
use glam::DVec3;

use super::tube::{Ring, Tube};
use crate::material::{Finish, Material, Paint};
use crate::scene::{Object, Part, Scene};
use crate::shape::{Face, Mesh, Normals, Placing, Shape, Sphere};

/// Axis of the body from the tip of the tail to the snout, along x, with its extents sideways and upward. The ground is at
/// y = 0, the belly near x = 0.
const BODY: [([f64; 3], [f64; 2]); 15] = [
    ([-1.85, 0.05, 0.62], [0.006, 0.006]),
    ([-1.58, 0.05, 0.60], [0.028, 0.028]),
    ([-1.30, 0.07, 0.47], [0.050, 0.050]),
    ([-1.02, 0.11, 0.27], [0.080, 0.085]),
    ([-0.74, 0.19, 0.09], [0.125, 0.140]),
    ([-0.46, 0.30, -0.02], [0.185, 0.200]),
    ([-0.18, 0.37, -0.05], [0.260, 0.245]),
    ([0.10, 0.40, -0.03], [0.290, 0.255]),
    ([0.36, 0.42, 0.02], [0.245, 0.220]),
    ([0.60, 0.47, 0.06], [0.165, 0.155]),
    ([0.80, 0.54, 0.09], [0.125, 0.120]),
    ([1.00, 0.59, 0.14], [0.165, 0.125]),
    ([1.20, 0.56, 0.21], [0.125, 0.085]),
    ([1.37, 0.52, 0.27], [0.070, 0.050]),
    ([1.44, 0.51, 0.30], [0.004, 0.004]),
];

/// Rows of scales along the body, and scales around it.
const ROWS: f64 = 40.0;
const AROUND: f64 = 10.0;

/// Height of scales, as a part of the body's radius.
const RELIEF: f64 = 0.04;

/// Legs on the far side: the axis from the body to the foot.
const FORE_LEG: [[f64; 3]; 4] = [[0.40, 0.38, -0.12], [0.47, 0.36, -0.38], [0.40, 0.16, -0.47], [0.52, 0.035, -0.54]];
const HIND_LEG: [[f64; 3]; 4] =
    [[-0.34, 0.33, -0.12], [-0.22, 0.36, -0.40], [-0.42, 0.17, -0.48], [-0.30, 0.035, -0.57]];
const LEG: [f64; 4] = [0.125, 0.095, 0.060, 0.050];

/// Plates along the back: their number, and the parts of the body between which they stand.
const PLATES: usize = 17;
const BACK: [f64; 2] = [0.20, 0.68];

/// Eyes, and their radius.
const EYES: [[f64; 3]; 2] = [[1.08, 0.665, 0.26], [1.13, 0.665, 0.065]];
const EYE: f64 = 0.042;

/// Numbers of the mesh's parts.
const SKIN: usize = 0;
const STONE: usize = 1;

impl Scene {
    /// Returns an armoured lizard with a sail of plates along its back, on an oval slab of stone, whose parts are named
    /// `lizard`, `slab` and `eye`. It is 3.3 long, looks along x, and stands where it is placed.
    pub fn lizard(skin: Material, slab: Material, placing: &Placing) -> Self {
        let faces: Vec<Face> = [body(), plates(), legs(), stone()].concat();
        let normals = Normals { kept: false, crease: Angle::from_degrees(50.0) };
        let mesh = Mesh::new(faces, normals).expect("a surface of finite triangles").placed(placing);
        let part =
            |name: &str, material: &Material| Part { name: name.to_owned(), material: material.clone(), world: 0 };
        let lizard =
            Object { shape: Shape::Mesh(Arc::new(mesh)), parts: vec![part("lizard", &skin), part("slab", &slab)] };
        let dark = Material::of(Finish { base: Paint::plain([0.0; 3]), ..Finish::default() });
        let eye = |at: [f64; 3]| {
            let sphere = Sphere::new(placing.point(at.into()), placing.scale * EYE);
            Object::sphere(sphere, dark.clone()).named("eye".to_owned())
        };
        Self { objects: std::iter::once(lizard).chain(EYES.map(eye)).collect() }
    }
}

fn rings() -> [Ring; 15] {
    BODY.map(|(at, radii)| Ring { at: at.into(), radii })
}

fn body() -> Vec<Face> {
    let tube = Tube { rings: &rings(), up: DVec3::Y, steps: [ROWS as usize * 8, 10 * AROUND as usize] };
    tube.faces(SKIN, |place, turn| {
        // Each second row of scales is half a scale further around.
        let scale = 0.5 + 0.5 * (PI * ROWS * place).cos() * (TAU * AROUND * turn).cos();
        let upward = 0.5 + 0.5 * (TAU * turn).sin();
        RELIEF * scale * scale * (0.25 + 0.75 * upward)
    })
}

fn plates() -> Vec<Face> {
    let rings = rings();
    let spine = Tube { rings: &rings, up: DVec3::Y, steps: [1, 1] };
    let plate = |k: usize| {
        let part = (k as f64 + 0.5) / PLATES as f64;
        let Ring { at, radii } = spine.ring(BACK[0] + (BACK[1] - BACK[0]) * part);
        let height = 0.08 + 0.30 * (PI * part).sin();
        let root = at + DVec3::Y * (0.85 * radii[1]);
        let wide = 0.045 + 0.03 * (PI * part).sin();
        let ring = |up: f64, size: f64| Ring {
            at: root + DVec3::new(-0.25 * up, up, 0.0) * height,
            radii: [0.22 * wide * size, wide * size],
        };
        let rings = [ring(0.0, 0.8), ring(0.4, 1.25), ring(0.8, 0.75), ring(1.15, 0.0)];
        Tube { rings: &rings, up: DVec3::X, steps: [14, 16] }.faces(SKIN, |_, _| 0.0)
    };
    (0..PLATES).flat_map(plate).collect()
}

fn legs() -> Vec<Face> {
    let near = |leg: [[f64; 3]; 4], step: f64| leg.map(|[x, y, z]| [x + step * (0.3 - z), y, -z]);
    // The legs of each pair are in the middle of a step.
    let legs = [FORE_LEG, near(FORE_LEG, -0.28), HIND_LEG, near(HIND_LEG, 0.24)];
    legs.into_iter().flat_map(leg).collect()
}

fn leg(axis: [[f64; 3]; 4]) -> Vec<Face> {
    let rings: Vec<Ring> = axis.iter().zip(LEG).map(|(at, radius)| Ring::round((*at).into(), radius)).collect();
    let scales = |place: f64, turn: f64| 0.06 * (0.5 + 0.5 * (PI * 18.0 * place).cos() * (TAU * 7.0 * turn).cos());
    let foot = DVec3::from_array(axis[3]);
    let toe = |aside: f64| {
        let tip = foot + DVec3::new(0.17 - aside.abs() * 0.25, -0.02, aside + 0.04 * foot.z.signum());
        let rings = [Ring::round(foot, 0.035), Ring::round(foot.lerp(tip, 0.5), 0.028), Ring::round(tip, 0.006)];
        Tube { rings: &rings, up: DVec3::Y, steps: [10, 10] }.faces(SKIN, |_, _| 0.0)
    };
    let toes = [-0.11, 0.0, 0.11].into_iter().flat_map(toe);
    Tube { rings: &rings, up: DVec3::X, steps: [90, 42] }.faces(SKIN, scales).into_iter().chain(toes).collect()
}

/// Makes an oval disc whose upper side is the ground.
fn stone() -> Vec<Face> {
    let ring = |y: f64, part: f64| Ring { at: DVec3::new(-0.2, y, 0.05), radii: [0.95 * part, 1.85 * part] };
    // Its axis rises everywhere, so that it has a direction.
    let rings = [(-0.16, 1.0), (-0.11, 1.0), (-0.06, 1.0), (-0.02, 1.0), (-0.006, 0.97), (-0.003, 0.9), (0.0, 0.4)];
    let rings = rings.map(|(y, part)| ring(y, part));
    Tube { rings: &rings, up: DVec3::X, steps: [48, 96] }.faces(STONE, |_, _| 0.0)
}
