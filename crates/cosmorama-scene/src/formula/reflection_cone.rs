use std::sync::Arc;

use cosmorama::sphere::Angle;
use glam::{DVec3, dvec3};

use super::tube::{Ring, Tube};
use crate::material::{Finish, Material, Paint};
use crate::ray::{Normal, Ray, RayChange};
use crate::scene::{Object, Part, Scene};
use crate::shape::{Face, Mesh, Normals, Shape, Sphere};

/// Place of the eye, the middle of a pixel on the screen before it, and half of the pixel's side.
const EYE: DVec3 = dvec3(-3.4, 1.5, 0.6);
const PIXEL: DVec3 = dvec3(-1.883, 0.945, 0.193);
const HALF: f64 = 0.075;

/// Pixels around that one, to each side.
const AROUND: i32 = 1;

/// The mirror, and the length of what is shown of rays that leave it.
const BALL: Sphere = Sphere::new(dvec3(0.7, -0.3, -0.5), 1.0);
const LENGTH: f64 = 2.6;

/// Radius of lines.
const LINE: f64 = 0.014;

/// Parts of the drawing, by their numbers, with their colours.
const PARTS: [(&str, [f64; 3]); 4] = [
    ("screen", [0.35, 0.35, 0.38]),
    ("pixel", [0.02, 0.02, 0.02]),
    ("rays", [0.02, 0.12, 0.55]),
    ("cone", [0.75, 0.12, 0.02]),
];
const SCREEN: usize = 0;
const SQUARE: usize = 1;
const RAYS: usize = 2;
const CONE: usize = 3;

impl Scene {
    /// Returns Figure 1 of Greene 1986 as a thing to be looked at: rays from an eye through the corners of a pixel, which a
    /// ball reflects, and the cone that they bound.
    pub fn reflection_cone() -> Self {
        let corners = square(0, 0);
        let met = corners.map(|corner| reflected(EYE, corner));
        let ends = met.map(|ray| ray.at(LENGTH));
        let mut faces = Vec::new();
        for (a, b) in (-AROUND..=AROUND).flat_map(|a| (-AROUND..=AROUND).map(move |b| (a, b))) {
            faces.extend(outline(&square(a, b), SCREEN, 0.5 * LINE));
        }
        faces.extend(outline(&corners, SQUARE, 1.5 * LINE));
        faces.extend(outline(&ends, CONE, LINE));
        for (ray, end) in met.iter().zip(ends) {
            faces.extend(line([EYE, ray.origin], RAYS, LINE));
            faces.extend(line([ray.origin, end], CONE, LINE));
        }
        let normals = Normals { kept: false, crease: Angle::from_degrees(60.0) };
        let mesh = Mesh::new(faces, normals).expect("a surface of finite triangles");
        let part = |(name, colour): (&str, [f64; 3])| Part { name: name.to_owned(), material: matt(colour), world: 0 };
        let drawing = Object { shape: Shape::Mesh(Arc::new(mesh)), parts: PARTS.map(part).to_vec() };
        let ball = Object::sphere(BALL, matt([0.62, 0.66, 0.72])).named("surface".to_owned());
        let eye = Object::sphere(Sphere::new(EYE, 0.07), matt(PARTS[RAYS].1)).named("viewpoint".to_owned());
        Self { objects: vec![drawing, ball, eye] }
    }
}

fn matt(colour: [f64; 3]) -> Material {
    Material { specular: 0.0, ..Material::of(Finish::matt(Paint::plain(colour))) }
}

/// Returns the corners of a pixel of the screen, so many to the right and down from the one in the middle.
fn square(right: i32, down: i32) -> [DVec3; 4] {
    let ahead = (PIXEL - EYE).normalize();
    let across = ahead.cross(DVec3::Y).normalize();
    let upward = across.cross(ahead);
    let middle = PIXEL + (across * f64::from(right) - upward * f64::from(down)) * (2.0 * HALF);
    [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, y)| middle + (across * x + upward * y) * HALF)
}

/// Returns the ray that the ball reflects of one from the eye through a point.
fn reflected(eye: DVec3, through: DVec3) -> Ray {
    let still = RayChange { origin: DVec3::ZERO, direction: DVec3::ZERO };
    let ray = Ray { origin: eye, direction: (through - eye).normalize(), dx: still, dy: still };
    let distance = BALL.meet(&ray, 0.0).expect("a ray that meets the ball");
    let unit = (ray.at(distance) - BALL.centre).normalize();
    ray.met(distance, unit).reflected(&Normal { unit, dx: DVec3::ZERO, dy: DVec3::ZERO })
}

fn outline(corners: &[DVec3; 4], part: usize, radius: f64) -> Vec<Face> {
    (0..4).flat_map(|k| line([corners[k], corners[(k + 1) % 4]], part, radius)).collect()
}

fn line(ends: [DVec3; 2], part: usize, radius: f64) -> Vec<Face> {
    let rings = ends.map(|end| Ring::round(end, radius));
    let up = (ends[1] - ends[0]).any_orthogonal_vector();
    Tube { rings: &rings, up, steps: [40, 12] }.faces(part, |_, _| 0.0)
}
