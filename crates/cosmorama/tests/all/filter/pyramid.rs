//! `FilterKind::EwaPyramid`: EWA of few texels, however many a pixel holds.

use std::f64::consts::PI;

use cosmorama::camera::{CameraModel, MirrorBallCamera, View};
use cosmorama::explain::Report;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::{ColourChannel, Image, Rgba, Transfer};
use cosmorama::render::{Accuracy, Arithmetic, Needs, Resampler};
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::World;
use glam::DVec3;
use testkit::{
    cube, equirect, fisheye, light_by_direction, light_by_texel, omnimax, perspective, position_error, turned,
};

const PYRAMID: FilterSettings = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };

fn render(world: &World, target: &View, filter: FilterSettings, light: &[Rgba]) -> Image<Rgba> {
    Resampler { world, target, filter }.render(light)
}

fn panorama(width: usize) -> World {
    World::new([("panorama".to_owned(), equirect(width))]).expect("one view")
}

/// A dome of which a pixel holds so many texels, of `texels` a radian, turned so that seams and corners lie anywhere.
fn dome(texels: f64, shrink: f64) -> View {
    let size = (texels * PI / shrink).round() as usize;
    View { orientation: turned([20.0, 35.0, 10.0]), ..fisheye(size, 180.0) }
}

fn direction_colour(direction: Direction) -> [f32; 3] {
    direction.vector().to_array().map(|c| c as f32)
}

/// Pixels inside the field of view, with what they see.
fn inside<'a>(
    target: &'a View,
    image: &'a Image<Rgba>,
) -> impl Iterator<Item = (cosmorama::camera::Footprint, Rgba)> + 'a {
    image.pixels().iter().enumerate().filter_map(|(at, pixel)| {
        let screen = target.screen_pixel(at % target.width(), at / target.width())?;
        Some((screen.footprint, *pixel * (screen.coverage as f32).recip()))
    })
}

#[test]
fn positions_hold_at_every_shrink() {
    let worlds = [("cube", cube(&CubeFace::ALL, 512, 512), 256.0), ("panorama", panorama(1600), 1600.0 / (2.0 * PI))];
    for (name, world, texels) in &worlds {
        let light = light_by_direction(world, direction_colour);
        for shrink in [1.0, 2.7, 3.5, 5.0, 8.0, 13.0, 20.0] {
            let target = dome(*texels, shrink);
            let worst = |filter| {
                let image = render(world, &target, filter, &light);
                inside(&target, &image).map(|(footprint, pixel)| position_error(&footprint, pixel)).fold(0.0, f64::max)
            };
            let (exact, found) = (worst(FilterSettings::DEFAULT), worst(PYRAMID));
            assert!(found < 0.01, "{name}, {shrink} texels a pixel: {found} px, and {exact} by EWA");
        }
    }
}

#[test]
fn a_constant_world_stays_constant() {
    let colour = Rgba::opaque(0.3, 0.7, 12.0);
    for (world, texels) in [(cube(&CubeFace::ALL, 300, 300), 150.0), (panorama(1001), 1001.0 / (2.0 * PI))] {
        let light = vec![colour; world.texel_count()];
        for shrink in [0.5, 3.0, 7.0, 30.0] {
            let target = dome(texels, shrink);
            let image = render(&world, &target, PYRAMID, &light);
            for (_, pixel) in inside(&target, &image) {
                let error = (0..4).map(|c| (pixel.0[c] / colour.0[c] - 1.0).abs()).fold(0.0, f32::max);
                assert!(error < 2e-6, "{shrink} texels a pixel: {pixel:?}");
            }
        }
    }
}

#[test]
fn a_checkerboard_of_single_texels_becomes_grey() {
    let world = cube(&CubeFace::ALL, 2048, 2048);
    let light = light_by_texel(&world, |_, i, j, _| {
        let value = ((i + j) % 2) as f32;
        Rgba::opaque(value, value, value)
    });
    let srgb = |light: f64| 255.0 * Transfer::Srgb.encode(light, ColourChannel::Green);
    for size in [512, 160] {
        let target = fisheye(size, 180.0);
        let image = render(&world, &target, PYRAMID, &light);
        let values: Vec<f64> = inside(&target, &image).map(|(_, pixel)| srgb(f64::from(pixel.0[1]))).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        assert!(variance.sqrt() < 0.5, "{size}: standard deviation {} of 255", variance.sqrt());
        assert!((mean - srgb(0.5)).abs() < 0.5, "{size}: mean {mean}");
    }
}

#[test]
fn it_is_ewa_where_a_pixel_holds_one_texel() {
    let world = cube(&CubeFace::ALL, 128, 128);
    let light = light_by_texel(&world, |view, i, j, _| {
        let value = ((view * 7 + i * 13 + j * 5) % 17) as f32 / 17.0;
        Rgba::opaque(value, 1.0 - value, 0.5)
    });
    for target in [dome(64.0, 1.0), perspective(200, 150, 70.0, 30.0, 20.0, 5.0), equirect(360)] {
        let of = |filter| Resampler { world: &world, target: &target, filter };
        let exact = of(FilterSettings::DEFAULT).render(&light);
        assert!(of(PYRAMID).render(&light).pixels() == exact.pixels(), "{:?}", target.projection);
        let plan = of(PYRAMID).plan(Arithmetic::Float).expect("the geometry of a pyramid");
        assert!(plan.apply(&light).pixels() == exact.pixels(), "{:?}", target.projection);
        assert!(of(PYRAMID).plan(Arithmetic::Fixed).is_none());
        assert_eq!(of(PYRAMID).filter_bytes(), 0);
    }
}

#[test]
fn a_plan_makes_the_same_pixels() {
    for (world, texels) in [(cube(&CubeFace::ALL, 255, 255), 127.0), (panorama(900), 900.0 / (2.0 * PI))] {
        let light = light_by_direction(&world, |d| d.vector().to_array().map(|c| (20.0 * c).sin() as f32));
        // One that mirrors, and one that does not.
        for target in [fisheye(64, 180.0), dome(texels, 6.0)] {
            let resampler = Resampler { world: &world, target: &target, filter: PYRAMID };
            let plan = resampler.plan(Arithmetic::Float).expect("the geometry of a pyramid");
            assert!(plan.apply(&light).pixels() == resampler.render(&light).pixels());
            assert!(plan.bytes() > 0 && resampler.filter_bytes() > world.texel_count());
            let estimate = resampler.plan_bytes_estimate(Arithmetic::Float) as f64 / plan.bytes() as f64;
            assert!((0.3..3.0).contains(&estimate), "{estimate} of what the plan takes");
        }
    }
}

/// Waves that shrinking leaves standing.
fn waves(direction: Direction) -> [f32; 3] {
    let of = |v: DVec3| (0.5 + 0.25 * (9.0 * v.x + 2.0 * v.y).sin() + 0.25 * (8.0 * v.z - 3.0 * v.y).cos()) as f32;
    let v = direction.vector();
    [of(v), of(DVec3::new(v.y, v.z, v.x)), of(DVec3::new(v.z, v.x, v.y))]
}

#[test]
fn no_step_across_the_edges_of_faces() {
    let world = cube(&CubeFace::ALL, 400, 400);
    let light = light_by_direction(&world, waves);
    for shrink in [3.0, 4.5, 6.0] {
        let target = dome(200.0, shrink);
        let image = render(&world, &target, PYRAMID, &light);
        // By how much neighbours' errors differ, where one face ends and elsewhere.
        let mut steps = [0f32; 2];
        let error = |i: usize, j: usize| {
            let screen = target.screen_pixel(i, j).filter(|screen| screen.coverage == 1.0)?;
            let (owner, _) = world.owner(screen.footprint.direction)?;
            let expected = waves(screen.footprint.direction);
            Some((owner, std::array::from_fn::<f32, 3, _>(|c| image.row(j)[i].0[c] - expected[c])))
        };
        for (j, i) in (1..target.height()).flat_map(|j| (1..target.width()).map(move |i| (j, i))) {
            let Some((owner, here)) = error(i, j) else { continue };
            for (other, there) in [error(i - 1, j), error(i, j - 1)].into_iter().flatten() {
                let step = (0..3).map(|c| (here[c] - there[c]).abs()).fold(0.0, f32::max);
                let at = usize::from(other != owner);
                steps[at] = steps[at].max(step);
            }
        }
        assert!(steps[1] < 1.1 * steps[0] && steps[1] > 0.0, "{shrink}: {steps:?} inside faces and across their edges");
    }
}

/// Light that is another in each texel.
fn noise(world: &World) -> Vec<Rgba> {
    light_by_texel(world, |view, i, j, _| {
        let hash = (view * 1_000_003 + i * 7919 + j * 104_729).wrapping_mul(2_654_435_761) >> 7;
        let value = (hash % 1000) as f32 / 999.0;
        Rgba::opaque(value, value * value, 1.0 - value)
    })
}

/// Hard stripes of full contrast are the worst case, and the bounds lie just under what was measured for them; the scene of the
/// oracles is some 8 dB nearer (docs/quality.md).
#[test]
fn it_stays_near_to_ewa() {
    for (world, texels) in [(cube(&CubeFace::ALL, 1024, 1024), 512.0), (panorama(3000), 3000.0 / (2.0 * PI))] {
        let light = light_by_direction(&world, |d| stripes(d, 300.0));
        for (shrink, least) in [(2.0, 65.0), (4.0, 41.0), (8.0, 38.0), (40.0, 38.0)] {
            let target = dome(texels, shrink);
            let psnr = nearness_to_ewa(&world, &target, &light);
            println!("{shrink} texels a pixel: {psnr:.1} dB");
            assert!(psnr > least, "{shrink} texels a pixel: {psnr} dB");
        }
    }
}

/// Around what it hides a ball's texels are long and narrow, and others from one to the next.
#[test]
fn it_stays_near_to_ewa_behind_a_mirror_ball() {
    let ball = CameraModel::MirrorBall(MirrorBallCamera::default()).view(500, 500).expect("a ball");
    let world = World::new([("ball".to_owned(), ball)]).expect("one view");
    let light = light_by_direction(&world, |d| stripes(d, 20.0));
    for size in [16, 24, 32, 64] {
        let target = perspective(size, size, 90.0, 25.0, 15.0, 0.0);
        let psnr = nearness_to_ewa(&world, &target, &light);
        println!("{size}²: {psnr:.1} dB");
        assert!(psnr > 40.0, "{size}²: {psnr} dB");
    }
}

/// Stripes and fields of three sizes, the finest with so many radians of them in one.
fn stripes(direction: Direction, finest: f64) -> [f32; 3] {
    let v = direction.vector();
    let stripe = |frequency: f64, v: f64| f32::from(u8::from((frequency * v).sin() > 0.0));
    [stripe(finest, v.x + 0.1 * v.y), stripe(finest.min(60.0), v.y * v.z), stripe(17.0, v.z)]
}

/// Decibels between what a pyramid makes and what exact EWA does.
fn nearness_to_ewa(world: &World, target: &View, light: &[Rgba]) -> f64 {
    let [exact, found] = [FilterSettings::DEFAULT, PYRAMID].map(|filter| render(world, target, filter, light));
    let pairs = inside(target, &exact).zip(inside(target, &found));
    let (mut sum, mut count) = (0.0, 0);
    for ((_, a), (_, b)) in pairs {
        sum += (0..3).map(|c| f64::from(a.0[c] - b.0[c]).powi(2)).sum::<f64>();
        count += 3;
    }
    -10.0 * (sum / f64::from(count)).log10()
}

/// Texels a pixel at most, those of both levels together, in a camera's view of a cube. The finer level's kernel is an ellipse of
/// 2.8 texels' minor semi-axis at most, times its radius of 2: 99 texels where it is round, 171 at the corner of a cube, where
/// texels are √3 times as long as wide, and a quarter of that in the coarser level; across an edge both faces have some.
const MOST: usize = 400;

/// Texels a pixel at most, for a footprint of any shape: sixteen times as long as wide, 1576 texels and a quarter of that.
const MOST_OF_LONG: usize = 2000;

/// Beside a rim levels are two finer: sixteen times as many.
const MOST_AT_RIM: usize = 16 * MOST;

#[test]
fn a_pixel_takes_a_bounded_number_of_texels() {
    for shrink in [2.0, 4.4, 9.0, 40.0] {
        let world = cube(&CubeFace::ALL, 1024, 1024);
        let gathered = |target: &View, filter| Report::of(&world, target, &filter).gathered;
        let dome = dome(512.0, shrink);
        assert!(gathered(&dome, PYRAMID).most < MOST_AT_RIM, "{shrink}: {:?}", gathered(&dome, PYRAMID));
        // At its poles a panorama's pixels are long and thin.
        let map = equirect((PI * 512.0 / shrink).round() as usize * 2);
        assert!(gathered(&map, PYRAMID).most < MOST_OF_LONG, "{shrink}: {:?}", gathered(&map, PYRAMID));
        let size = (1024.0 / shrink).round() as usize;
        let camera = perspective(size, size, 90.0, 20.0, 35.0, 10.0);
        let found = gathered(&camera, PYRAMID);
        assert!(found.most < MOST, "{shrink}: {found:?}");
        if shrink > 8.0 {
            assert!(gathered(&camera, FilterSettings::DEFAULT).mean > 2.0 * found.mean);
        }
    }
}

#[test]
fn what_the_target_does_not_show_does_not_leak_in() {
    let world = cube(&CubeFace::ALL, 512, 512);
    let target = omnimax(160, 120);
    let grey = Rgba::opaque(0.5, 0.5, 0.5);
    let touches = |direction: Direction| target.sees(direction);
    // All that is more than a texel outside the field of view holds anything.
    let light = light_by_texel(&world, |_, _, _, direction| {
        let direction = direction.expect("faces look everywhere").vector();
        let pitch = 2.0 / 512.0;
        let around = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
        let near = around.iter().any(|by| touches(Direction::from_unit((direction + *by * 1.5 * pitch).normalize())));
        if near { grey } else { Rgba::opaque(1000.0, 0.0, 0.0) }
    });
    for filter in [FilterSettings::DEFAULT, PYRAMID] {
        let image = render(&world, &target, filter, &light);
        for (_, pixel) in inside(&target, &image) {
            assert!((0..3).all(|c| (pixel.0[c] - 0.5).abs() < 1e-5), "{:?}: {pixel:?}", filter.kind);
        }
    }
    let needs = |filter| Needs::of(&world, std::slice::from_ref(&target), &filter, Accuracy::Exact);
    for (all, exact) in needs(PYRAMID).views.iter().zip(needs(FilterSettings::DEFAULT).views) {
        assert_eq!(all.seen, exact.seen);
        assert!(exact.read.is_none_or(|read| all.read.is_some_and(|all| all.contains(&read))));
    }
}

#[test]
fn light_stays_within_that_of_the_texels() {
    let world = cube(&CubeFace::ALL, 512, 512);
    let sun = Direction::from_unit(DVec3::new(0.3, 0.2, -1.0).normalize());
    let light = light_by_direction(&world, |direction| {
        if direction.angle_to(sun).degrees() < 0.7 { [65000.0; 3] } else { [1.0, 1.2, 2.0] }
    });
    for shrink in [3.0, 5.0, 11.0] {
        let target = dome(256.0, shrink);
        let image = render(&world, &target, PYRAMID, &light);
        for (_, pixel) in inside(&target, &image) {
            for (value, least) in pixel.0.iter().zip([1.0, 1.2, 2.0]) {
                assert!((least * 0.99999..=65000.1).contains(value), "{shrink}: {pixel:?}");
            }
        }
    }
}

#[test]
fn missing_texels_leave_the_rest_as_it_is() {
    let world = cube(&CubeFace::ALL, 256, 256);
    let grey = Rgba::opaque(0.5, 0.5, 0.5);
    let light =
        light_by_texel(&world, |_, i, j, _| if (i / 2 + j / 2) % 5 == 0 { Rgba([f32::NAN; 4]).finite() } else { grey });
    let target = dome(128.0, 6.0);
    let image = render(&world, &target, PYRAMID, &light);
    for (_, pixel) in inside(&target, &image) {
        assert!(pixel.alpha() > 0.4 && pixel.alpha() <= 1.0, "{pixel:?}");
        assert!(pixel.unpremultiplied().iter().all(|c| (c - 0.5).abs() < 1e-5), "{pixel:?}");
    }
}

#[test]
fn threads_make_no_difference() {
    let world = cube(&CubeFace::ALL, 300, 300);
    let light = noise(&world);
    let target = dome(150.0, 5.0);
    let resampler = Resampler { world: &world, target: &target, filter: PYRAMID };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| resampler.render(&light))
    };
    let one = with(1);
    assert!([2, 7].into_iter().all(|threads| with(threads).pixels() == one.pixels()));
}
