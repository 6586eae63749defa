//! The rim of a lens: nothing leaks in over it, and nothing rings there.

use cosmorama::camera::{PixelPoint, View};
use cosmorama::filter::FilterSettings;
use cosmorama::raster::Rgba;
use cosmorama::render::Resampler;
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::World;
use testkit::{cube, equirect, fisheye, light_by_texel, omnimax};

fn worlds() -> [World; 2] {
    [World::new([("panorama".to_owned(), equirect(512))]).expect("one view"), cube(&CubeFace::ALL, 128, 120)]
}

fn targets() -> [View; 4] {
    [fisheye(256, 180.0), fisheye(509, 180.0), fisheye(200, 100.0), omnimax(491, 359)]
}

/// Whether a part of the target's field of view falls upon a texel.
fn is_seen(target: &View, source: &View, i: usize, j: usize) -> bool {
    const STEPS: [f64; 7] = [0.001, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999];
    STEPS.iter().any(|y| {
        STEPS.iter().any(|x| {
            let direction = source.direction(PixelPoint::new(i as f64 + x, j as f64 + y));
            direction.and_then(|direction| target.pixel(direction)).is_some_and(|pixel| target.stop_passes(pixel))
        })
    })
}

#[test]
fn what_the_field_does_not_fall_upon_may_hold_anything() {
    for world in worlds() {
        for target in targets() {
            let picture = |i: usize, j: usize| Rgba::opaque((i % 7) as f32, (j % 5) as f32, ((i + j) % 2) as f32);
            let clean = light_by_texel(&world, |_, i, j, _| picture(i, j));
            let spoilt = light_by_texel(&world, |view, i, j, _| {
                let seen = is_seen(&target, &world.sources()[view].view, i, j);
                if seen { picture(i, j) } else { Rgba([1e6; 4]) }
            });
            let [clean, spoilt] = [clean, spoilt].map(|light| {
                Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light)
            });
            assert!(clean == spoilt);
        }
    }
}

#[test]
fn suns_dots_and_steps_do_not_ring_at_the_rim() {
    /// Hash of a texel, so that suns lie everywhere along the rim.
    fn hash(i: usize, j: usize) -> usize {
        (i.wrapping_mul(2_654_435_761) ^ j.wrapping_mul(40_503)).wrapping_mul(2_246_822_519) >> 7
    }
    type Picture = fn(usize, usize) -> f32;
    let pictures: [(&str, f32, f32, Picture); 4] = [
        ("suns", 0.3, 1e5, |i, j| if hash(i, j).is_multiple_of(97) { 1e5 } else { 0.3 }),
        ("dots", 0.1, 0.9, |i, j| if hash(i, j).is_multiple_of(97) { 0.1 } else { 0.9 }),
        ("steps", 0.2, 1.0, |i, j| if (i / 5 + j / 7).is_multiple_of(2) { 1.0 } else { 0.2 }),
        ("flares", 0.25, 1.1e5, |i, j| {
            let (x, y) = ((i % 16) as f32 - 7.3, (j % 16) as f32 - 8.1);
            0.25 + 1e5 * (-x * x - y * y).exp()
        }),
    ];
    for world in worlds() {
        for target in targets() {
            for (name, least, greatest, picture) in pictures {
                let light = light_by_texel(&world, |_, i, j, _| Rgba::opaque(picture(i, j), 0.0, 0.0));
                let image =
                    Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
                for (index, pixel) in image.pixels().iter().enumerate() {
                    let (i, j) = (index % image.width(), index / image.width());
                    let Some(screen) = target.screen_pixel(i, j) else { continue };
                    let value = pixel.0[0] / screen.coverage as f32;
                    let within = (least * 0.999..=greatest * 1.001).contains(&value);
                    assert!(within, "{name}: {value} at ({i}, {j}), coverage {}", screen.coverage);
                }
            }
        }
    }
}

/// Samples a side that a texel of an antialiased picture is averaged from, as a renderer does.
const SAMPLES: usize = 4;

/// A picture as a renderer makes it: the average over each texel.
fn rendered(world: &World, picture: impl Fn(Direction) -> f32) -> Vec<Rgba> {
    light_by_texel(world, |view, i, j, _| {
        let view = &world.sources()[view].view;
        let at = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let samples = (0..SAMPLES * SAMPLES).map(|k| {
            let point = PixelPoint::new(i as f64 + at(k % SAMPLES), j as f64 + at(k / SAMPLES));
            picture(view.direction(point).expect("panoramas and faces look everywhere"))
        });
        let grey = samples.sum::<f32>() / (SAMPLES * SAMPLES) as f32;
        Rgba::opaque(grey, grey, grey)
    })
}

/// A renderer smooths an edge over a texel or two: three of them in a row may lie as on a slope.
#[test]
fn antialiased_stripes_edges_and_suns_do_not_ring_at_the_rim() {
    const RANGE: std::ops::RangeInclusive<f32> = 0.2..=1.0;
    /// Whether a direction is bright, given how wide stripes are, in radians.
    type Picture = fn(Direction, f64) -> bool;
    let pictures: [(&str, Picture); 5] = [
        ("rings", |d, width| band(d.angle_to(Direction::FRONT).radians(), width)),
        ("upright stripes", |d, width| band(d.vector().x, width)),
        ("slanting stripes", |d, width| band(d.dot(Direction::FRONT) * 0.6 + d.vector().y * 0.8, width)),
        ("checks", |d, width| band(d.vector().x, width) != band(d.vector().y, width)),
        ("suns", |d, width| d.vector().to_array().iter().all(|c| (c / width / 4.0).fract().abs() < 0.3)),
    ];
    let targets = [fisheye(509, 180.0), fisheye(300, 220.0), omnimax(491, 359)];
    for (world, texel) in worlds().iter().zip([std::f64::consts::TAU / 512.0, std::f64::consts::FRAC_PI_2 / 124.0]) {
        for ((name, picture), width) in pictures.iter().flat_map(|p| [2.3, 3.3].map(|width| (p, width))) {
            let is_bright = |direction| picture(direction, width * texel);
            let light = rendered(world, |d| if is_bright(d) { *RANGE.end() } else { *RANGE.start() });
            for target in &targets {
                let image = Resampler { world, target, filter: FilterSettings::DEFAULT }.render(&light);
                for (index, pixel) in image.pixels().iter().enumerate() {
                    let (i, j) = (index % image.width(), index / image.width());
                    let Some(screen) = target.screen_pixel(i, j) else { continue };
                    let value = pixel.0[0] / screen.coverage as f32;
                    let is_within = (RANGE.start() * 0.9999..=RANGE.end() * 1.0001).contains(&value);
                    assert!(is_within, "{name} {width} texels wide: {value} at ({i}, {j}) in {:?}", target.projection);
                }
            }
        }
    }
}

/// Whether a coordinate lies in every other band.
fn band(x: f64, width: f64) -> bool {
    ((x / width).floor() as i64).rem_euclid(2) == 0
}
