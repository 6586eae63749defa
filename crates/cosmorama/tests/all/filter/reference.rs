//! The fast paths against the slow, obvious ones.

use cosmorama::camera::{Footprint, View};
use cosmorama::filter::{
    CrossSection, Filter, FilterKind, FilterSettings, Kernel, TextureDerivatives, WeightTable, ewa,
};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Arithmetic, Resampler};
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama::world::{Light, World};
use glam::DVec3;
use testkit::{cube, equirect, fisheye, light_by_direction, light_by_texel, omnimax, perspective};

fn render(world: &World, target: &View, filter: FilterSettings, light: &[Rgba]) -> Image<Rgba> {
    Resampler { world, target, filter }.render(light)
}

/// Something to see at every scale above a few texels, smooth, and different in every direction.
fn waves(direction: Direction) -> [f32; 3] {
    let d = direction.vector();
    let wave = |x: f64, y: f64| (0.5 + 0.25 * (x * 23.0).sin() + 0.25 * (y * 31.0 + x * 5.0).cos()) as f32;
    [wave(d.x, d.y), wave(d.y, d.z), wave(d.z, d.x)]
}

#[test]
fn gaussian_ewa_is_the_reference_at_parity() {
    let world = cube(&CubeFace::ALL, 256, 256);
    let light = light_by_direction(&world, |d| d.vector().to_array().map(|c| c as f32));
    let kernel = Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 });
    // Parity: 256 texels over two units of the face's plane are 128 a radian at its centre.
    let target = fisheye(402, 180.0);
    let fast = render(&world, &target, FilterSettings { kind: FilterKind::Ewa, kernel, anti_ringing: false }, &light);
    let judge = FilterSettings { kind: FilterKind::Reference { samples: 4 }, kernel, anti_ringing: false };
    let slow = render(&world, &target, judge, &light);
    let (mut sum, mut count) = (0f64, 0usize);
    for (a, b) in fast.pixels().iter().zip(slow.pixels()).filter(|(a, _)| a.alpha() > 0.0) {
        sum += (0..3).map(|c| f64::from(a.0[c] - b.0[c]).powi(2)).sum::<f64>();
        count += 3;
    }
    let rms = (sum / count as f64).sqrt();
    assert!(rms < 1e-3, "rms {rms}");
}

#[test]
fn the_paper_is_the_gather_where_one_view_suffices() {
    // A narrow view: all its texels have one solid angle, as the paper's have.
    let source = perspective(200, 160, 0.5, 0.0, 0.0, 0.0);
    let world = World::new([("view".to_owned(), source.clone())]).expect("one view");
    let light = light_by_texel(&world, |_, i, j, _| {
        let value = ((i * 37 + j * 101) % 29) as f32 / 29.0;
        Rgba::opaque(value, 1.0 - value, value * value)
    });
    let image = Image::new(200, 160, light.clone()).expect("as many texels as the view has");
    let kernel = Kernel { floor: 0.0, ..Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }) };
    let filter = FilterSettings { kind: FilterKind::Ewa, kernel, anti_ringing: false };
    let table = WeightTable::new(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }, 1 << 16);
    let target = perspective(40, 30, 0.4, 0.02, -0.01, 25.0);
    let found = render(&world, &target, filter, &light);
    for j in 0..30 {
        for i in 0..40 {
            let footprint = target.screen_pixel(i, j).expect("a view without a stop shows all").footprint;
            let (centre, columns) = source.texel_footprint(&footprint).expect("in front of the camera");
            let derivatives = TextureDerivatives {
                ux: columns.x_axis.x,
                vx: columns.x_axis.y,
                uy: columns.y_axis.x,
                vy: columns.y_axis.y,
            };
            let expected = ewa(&image, centre, derivatives, &table);
            for c in 0..4 {
                let error = (found.get(i, j).0[c] - expected.0[c]).abs();
                assert!(error < 1e-3, "({i}, {j}) channel {c}: {error}");
            }
        }
    }
}

#[test]
fn a_plan_gives_what_is_rendered_without() {
    // The small world comes pixel by pixel, the large one in windows.
    for (world, size) in [(cube(&CubeFace::ALL, 64, 60), 1), (cube(&CubeFace::ALL, 512, 480), 6)] {
        let light = light_by_direction(&world, waves);
        for kind in [FilterKind::Ewa, FilterKind::Point, FilterKind::Bilinear] {
            for target in [omnimax(197 * size, 143 * size), equirect(100 * size), fisheye(90 * size, 360.0)] {
                for anti_ringing in [true, false] {
                    let filter = FilterSettings { kind, anti_ringing, ..FilterSettings::DEFAULT };
                    let resampler = Resampler { world: &world, target: &target, filter };
                    let plan = resampler.plan(Arithmetic::Float).expect("these filters have plans");
                    let (kept, made) = (plan.apply(&light), resampler.render(&light));
                    let difference =
                        |(a, b): (&Rgba, &Rgba)| (0..4).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max);
                    let largest = kept.pixels().iter().zip(made.pixels()).map(difference).fold(0.0, f32::max);
                    assert!(largest < 1e-6, "{kind:?}: {largest}");
                }
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let world = cube(&CubeFace::ALL, 128, 128);
    let light = light_by_direction(&world, waves);
    let target = omnimax(393, 287);
    let render_with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| render(&world, &target, FilterSettings::DEFAULT, &light))
    };
    let one = render_with(1);
    assert!(one == render_with(2) && one == render_with(7));
}

#[test]
fn turning_world_and_view_together_changes_nothing() {
    let turn = Orientation::from_yaw_pitch_roll(
        Angle::from_degrees(31.0),
        Angle::from_degrees(-17.0),
        Angle::from_degrees(8.0),
    );
    let turned = |view: View| View { orientation: view.orientation.within(turn), ..view };
    let world = cube(&CubeFace::ALL, 128, 128);
    let turned_world =
        World::new(world.sources().iter().map(|source| (source.name.clone(), turned(source.view.clone()))))
            .expect("six faces");
    let light = light_by_direction(&world, waves);
    let target = perspective(160, 120, 100.0, 30.0, 25.0, 5.0);
    let still = render(&world, &target, FilterSettings::DEFAULT, &light);
    let moved = render(&turned_world, &turned(target), FilterSettings::DEFAULT, &light);
    for (a, b) in still.pixels().iter().zip(moved.pixels()) {
        assert!((0..4).all(|c| (a.0[c] - b.0[c]).abs() < 2e-4), "{a:?} is not {b:?}");
    }
}

#[test]
fn every_filter_sees_the_same_picture() {
    let world = cube(&CubeFace::ALL, 256, 256);
    let light = light_by_direction(&world, waves);
    let target = fisheye(300, 200.0);
    let judge = FilterSettings { kind: FilterKind::Reference { samples: 3 }, ..FilterSettings::DEFAULT };
    let reference = render(&world, &target, judge, &light);
    // The reference's kernel over bilinear sub-samples has a sharpness of its own: on these waves both others differ from
    // it by one hundredth of their contrast.
    for (kind, tolerance) in [(FilterKind::Ewa, 0.015), (FilterKind::Bilinear, 0.015), (FilterKind::Point, 0.1)] {
        let image = render(&world, &target, FilterSettings { kind, ..FilterSettings::DEFAULT }, &light);
        for (index, (a, b)) in image.pixels().iter().zip(reference.pixels()).enumerate() {
            let worst = (0..4).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max);
            assert!(worst < tolerance, "{kind:?} at pixel {index}: {worst}");
        }
    }
}

/// A kernel that takes pixels as circles does so for single footprints of every filter, as for pictures.
#[test]
fn round_kernels_take_one_footprint_as_a_circle() {
    let world = cube(&CubeFace::ALL, 256, 256);
    let light = Light::by_direction(&world, |direction| {
        let [red, green, blue] = waves(direction);
        Rgba::opaque(red, green, blue)
    });
    // Four times as wide as it is high.
    let long = Footprint::new(Direction::FRONT, DVec3::X * 0.2, DVec3::NEG_Y * 0.05);
    let kernel = Kernel { round: true, ..Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 2.0 }) };
    let average = |kind: FilterKind, footprint: &Footprint| {
        let filter = FilterSettings { kind, kernel, anti_ringing: false };
        filter.prepare(&world, &light).expect("a filter").average(footprint).0
    };
    let judge = FilterKind::Reference { samples: 16 };
    let (circle, slow) = (average(judge, &long.rounded()), average(judge, &long));
    for kind in [FilterKind::Ewa, FilterKind::EwaPyramid] {
        let found = average(kind, &long);
        for channel in 0..3 {
            assert!((slow[channel] - circle[channel]).abs() < 1e-6, "{slow:?}, not {circle:?}");
            assert!((slow[channel] - found[channel]).abs() < 5e-3, "{slow:?}, not {found:?} of {kind:?}");
        }
    }
}
