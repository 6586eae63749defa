//! How long the average of one footprint takes, in one thread: `cargo bench -p testkit --bench footprints`.
//!
//! The world is a cube of 2048² faces, whose light takes 400 MB: far more than any cache holds. *Scattered* footprints look in
//! directions drawn evenly over the sphere, each somewhere else than the one before, as a diffuse reflection does. *Beside each
//! other* they go along the rows of a picture of 512², two texels from one to the next, as pixels do.

use std::hint::black_box;

use cosmorama::camera::Footprint;
use cosmorama::filter::{Ewa, EwaPyramid, Filter, Prepared};
use cosmorama::raster::Rgba;
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::Light;
use testkit::cube;

/// Texels along a face's side.
const SIDE: usize = 2048;

/// Footprints that are drawn before the clock starts.
const COUNT: usize = 1 << 16;

/// Numbers from 0 to 1, evenly, always the same ones (Steele, Lea & Flood 2014, SplitMix64).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.next()
    }

    fn direction(&mut self) -> Direction {
        let (y, longitude) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let level = (1.0 - y * y).sqrt();
        Direction::from_unit(glam::DVec3::new(level * longitude.sin(), y, -level * longitude.cos()))
    }

    /// A footprint of these widths in radians, turned anyhow.
    fn footprint(&mut self, direction: Direction, widths: [f64; 2]) -> Footprint {
        let (right, up) = direction.vector().any_orthonormal_pair();
        let (sin, cos) = self.between(0.0, std::f64::consts::TAU).sin_cos();
        let (along, across) = (right * cos + up * sin, up * cos - right * sin);
        Footprint::new(direction, along * widths[0], across * widths[1])
    }
}

/// The mean texel of a face, in radians.
fn texel() -> f64 {
    (4.0 * std::f64::consts::PI / (6 * SIDE * SIDE) as f64).sqrt()
}

/// From one to four texels wide, each way by itself.
fn narrow(draw: &mut Draw) -> [f64; 2] {
    [draw.between(1.0, 4.0) * texel(), draw.between(1.0, 4.0) * texel()]
}

/// Of any width from a texel to half a turn, evenly in its logarithm, and up to four times as long.
fn any_width(draw: &mut Draw) -> [f64; 2] {
    let width = texel() * (draw.next() * (1.0 / texel()).ln()).exp();
    [width, width * draw.between(1.0, 4.0)]
}

fn scattered(widths: fn(&mut Draw) -> [f64; 2]) -> Vec<Footprint> {
    let mut draw = Draw(1);
    (0..COUNT)
        .map(|_| {
            let (direction, widths) = (draw.direction(), widths(&mut draw));
            draw.footprint(direction, widths)
        })
        .collect()
}

fn beside_each_other(widths: fn(&mut Draw) -> [f64; 2]) -> Vec<Footprint> {
    let mut draw = Draw(2);
    let (middle, side) = (Direction::spread(7).nth(2).unwrap_or(Direction::FRONT).vector(), 512);
    let (right, up) = middle.any_orthonormal_pair();
    (0..COUNT)
        .map(|k| {
            let [x, y] = [k % side, k / side].map(|at| (at as f64 - 256.0) * 2.0 * texel());
            let direction = Direction::from_unit((middle + right * x + up * y).normalize());
            let widths = widths(&mut draw);
            draw.footprint(direction, widths)
        })
        .collect()
}

/// Draws the two widths of a footprint.
type Widths = fn(&mut Draw) -> [f64; 2];


#[test]
fn timing() {
    let world = cube(&CubeFace::ALL, SIDE, SIDE);
    let light = Light::by_direction(&world, |direction| {
        let [x, y, z] = direction.vector().to_array().map(|c| (0.5 + 0.5 * (40.0 * c).sin()) as f32);
        Rgba::opaque(x, y, z)
    });
    let ewa = Ewa::default().prepare(&world, &light).expect("light of the world");
    let pyramid = EwaPyramid::default().prepare(&world, &light).expect("light of the world");
    let cases: [(&str, &dyn Prepared, Widths); 3] = [
        ("ewa of 1 to 4 texels", &*ewa, narrow),
        ("ewa-pyramid of 1 to 4 texels", &*pyramid, narrow),
        ("ewa-pyramid of any width", &*pyramid, any_width),
    ];
    for (name, prepared, widths) in cases {
        for (order, footprints) in [("scattered", scattered(widths)), ("beside each other", beside_each_other(widths))]
        {
            let mut times: Vec<f64> = Vec::new();
            for _ in 0..3 {
                for chunk in footprints.chunks(1024) {
                    let start = std::time::Instant::now();
                    for footprint in chunk {
                        black_box(prepared.average(black_box(footprint)));
                    }
                    times.push(start.elapsed().as_secs_f64() * 1e6 / chunk.len() as f64);
                }
            }
            times.sort_by(f64::total_cmp);
            println!("{name}, {order}: {:.2} best, {:.2} fifth, {:.2} median", times[0], times[times.len() / 5], times[times.len() / 2]);
        }
    }
}
