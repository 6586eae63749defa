//! How long the demo's four faces take: the front one whole and the front halves of left, right and up,
//! which is what an Omnimax frame needs.
//!
//! `time cargo run --release -p cosmorama-builtin --example speed`

use std::time::Instant;

use cosmorama::sphere::{CubeFace, Direction};
use cosmorama_builtin::{DemoWorld, Supersampling, render};
use glam::DVec3;

const FACE: usize = 1024;

/// Face, and the rectangle of it: left, top, width, height.
const NEEDED: [(CubeFace, [usize; 4]); 4] = [
    (CubeFace::Front, [0, 0, FACE, FACE]),
    (CubeFace::Right, [0, 0, FACE / 2, FACE]),
    (CubeFace::Left, [FACE / 2, 0, FACE / 2, FACE]),
    (CubeFace::Up, [0, FACE / 2, FACE, FACE / 2]),
];

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    for (face, [left, top, width, height]) in NEEDED {
        let start = Instant::now();
        let unproject = |x: f64, y: f64| {
            let (right, up) = (x + left as f64, y + top as f64);
            let on_plane = DVec3::new(2.0 * right / FACE as f64 - 1.0, 1.0 - 2.0 * up / FACE as f64, -1.0);
            Direction::new(on_plane).map(|direction| face.orientation().to_world(direction))
        };
        let image = render(&DemoWorld, width, height, unproject, Supersampling::default());
        println!("{face}: {} pixels in {:.2} s", image.pixels().len(), start.elapsed().as_secs_f64());
    }
}
