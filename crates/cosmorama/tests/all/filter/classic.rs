//! Filters of the literature, each against what its paper defines, where a view's mapping is all but affine.

use cosmorama::camera::{Footprint, PixelPoint, View};
use cosmorama::filter::{Classic, Filter, MipChoice, Prepared};
use cosmorama::raster::Rgba;
use cosmorama::sphere::CubeFace;
use cosmorama::world::{Light, World};
use glam::DVec2;
use testkit::{cube, light_by_texel, perspective};

const SIDE: usize = 128;

/// A view so narrow that its mapping is affine to 10⁻⁵, as a world.
fn narrow() -> World {
    World::new([("narrow".to_owned(), perspective(SIDE, SIDE, 0.5, 0.0, 0.0, 0.0))]).expect("one view")
}

fn noise_at(i: usize, j: usize) -> f64 {
    ((i * 7919 + j * 104_729 + i * j * 31) % 997) as f64 / 996.0
}

fn noise(world: &World) -> Light {
    let texels = light_by_texel(world, |_, i, j, _| {
        let value = noise_at(i, j) as f32;
        Rgba::opaque(value, value, value)
    });
    Light::new(world, texels).expect("a texel for each")
}

/// Returns the footprint at a place of the image whose derivatives are these, in texels.
fn footprint(view: &View, place: PixelPoint, [x, y]: [DVec2; 2]) -> Footprint {
    let here = view.footprint(place).expect("inside");
    let along = |texels: DVec2| here.jacobian.dx * texels.x + here.jacobian.dy * texels.y;
    Footprint::new(here.direction, along(x), along(y))
}

/// Places and derivatives all over the image.
fn cases() -> impl Iterator<Item = (PixelPoint, [DVec2; 2])> {
    (0..24).map(|k| {
        let place = PixelPoint::new(40.0 + 1.93 * f64::from(k), 88.0 - 2.17 * f64::from(k));
        let angle = 0.7 * f64::from(k);
        let (long, short) = (1.5 + f64::from(k % 6), 1.2 + 0.4 * f64::from(k % 4));
        (place, [DVec2::from_angle(angle) * long, DVec2::from_angle(angle + 1.3) * short])
    })
}

fn average(classic: Classic, of: impl Fn(&dyn Prepared, &View, &Light)) {
    let world = narrow();
    let light = noise(&world);
    let prepared = classic.prepare(&world, &light).expect("light of the world");
    of(&*prepared, &world.sources()[0].view, &light);
}

/// Averages the texels under many points of the screen, by weight.
fn sampled(place: PixelPoint, [x, y]: [DVec2; 2], reach: f64, weight: impl Fn(f64, f64) -> f64) -> f64 {
    const COUNT: usize = 800;
    let at = |k: usize| ((k as f64 + 0.5) / COUNT as f64 * 2.0 - 1.0) * reach;
    let (mut sum, mut weights) = (0.0, 0.0);
    for (s, t) in (0..COUNT).flat_map(|i| (0..COUNT).map(move |j| (at(i), at(j)))) {
        let texel = DVec2::new(place.x, place.y) + x * s + y * t;
        sum += weight(s, t) * noise_at(texel.x as usize, texel.y as usize);
        weights += weight(s, t);
    }
    sum / weights
}

#[test]
fn catmull_is_the_mean_of_the_parallelogram() {
    average(Classic::Catmull, |prepared, view, _| {
        for (place, sides) in cases() {
            let found = f64::from(prepared.average(&footprint(view, place, sides)).0[0]);
            let expected = sampled(place, sides, 0.5, |_, _| 1.0);
            assert!((found - expected).abs() < 2e-3, "{place:?}, {sides:?}: {found} for {expected}");
        }
    });
}

#[test]
fn summed_area_is_the_mean_of_the_rectangle_around() {
    average(Classic::SummedArea, |prepared, view, _| {
        for (place, sides) in cases() {
            let found = f64::from(prepared.average(&footprint(view, place, sides)).0[0]);
            let half = (sides[0].abs() + sides[1].abs()).max(DVec2::ONE);
            let rectangle = [DVec2::new(half.x, 0.0), DVec2::new(0.0, half.y)];
            let expected = sampled(place, rectangle, 0.5, |_, _| 1.0);
            assert!((found - expected).abs() < 2e-3, "{place:?}, {sides:?}: {found} for {expected}");
        }
    });
}

#[test]
fn a_level_of_a_mip_map_is_a_mean_of_squares() {
    for choice in [MipChoice::Nearest, MipChoice::Trilinear] {
        average(Classic::MipMap(choice), |prepared, view, _| {
            // In the middle of a texel of level 3, with derivatives of 8 texels: exactly that texel.
            let sides = [DVec2::new(8.0, 0.0), DVec2::new(0.0, 3.0)];
            let found = f64::from(prepared.average(&footprint(view, PixelPoint::new(44.0, 60.0), sides)).0[0]);
            let square = (0..64).map(|k| noise_at(40 + k % 8, 56 + k / 8)).sum::<f64>() / 64.0;
            assert!((found - square).abs() < 1e-4, "{choice:?}: {found} for {square}");
        });
    }
}

/// An impulse shows the weight of its texel: a tent along each side of the parallelogram.
#[test]
fn blinn_and_newell_weigh_by_a_pyramid() {
    let world = narrow();
    let view = &world.sources()[0].view;
    let impulse = [64, 60];
    let texels =
        light_by_texel(&world, |_, i, j, _| if [i, j] == impulse { Rgba::opaque(1.0, 1.0, 1.0) } else { Rgba::BLACK });
    let light = Light::new(&world, texels).expect("a texel for each");
    let prepared = Classic::BlinnNewell.prepare(&world, &light).expect("light of the world");
    let sides = [DVec2::new(6.0, 1.0), DVec2::new(-2.0, 5.0)];
    for (dx, dy) in [(0.0, 0.0), (1.3, 0.4), (-2.0, 3.1), (4.0, -1.0), (-7.0, 2.0)] {
        let place = PixelPoint::new(64.5 + dx, 60.5 + dy);
        let weight = |i: usize, j: usize| {
            let offset = DVec2::new(i as f64 + 0.5 - place.x, j as f64 + 0.5 - place.y);
            let determinant = sides[0].perp_dot(sides[1]);
            let (s, t) = (offset.perp_dot(sides[1]) / determinant, sides[0].perp_dot(offset) / determinant);
            (1.0 - s.abs()).max(0.0) * (1.0 - t.abs()).max(0.0)
        };
        let whole: f64 = (0..SIDE * SIDE).map(|k| weight(k % SIDE, k / SIDE)).sum();
        let found = f64::from(prepared.average(&footprint(view, place, sides)).0[0]);
        let expected = weight(impulse[0], impulse[1]) / whole;
        assert!((found - expected).abs() < 1e-5, "({dx}, {dy}): {found} for {expected}");
    }
}

/// All three weigh by one table over the squared distance on the screen.
#[test]
fn feibush_levoy_cook_and_both_printed_ewas_agree() {
    let world = narrow();
    let light = noise(&world);
    let [flc, paper, integer] = [Classic::FeibushLevoyCook, Classic::EwaPaper, Classic::EwaInteger]
        .map(|classic| classic.prepare(&world, &light).expect("light of the world"));
    for (place, sides) in cases().flat_map(|(place, [x, y])| [1.0, 2.5].map(|scale| (place, [x * scale, y * scale]))) {
        let footprint = footprint(&world.sources()[0].view, place, sides);
        let [flc, paper, integer] = [&flc, &paper, &integer].map(|filter| f64::from(filter.average(&footprint).0[0]));
        assert!((flc - paper).abs() < 1e-4, "{place:?}, {sides:?}: {flc} and {paper}");
        assert!((integer - paper).abs() < 1.0 / 255.0, "{place:?}, {sides:?}: {integer} and {paper}");
    }
}

#[test]
fn gangnet_is_a_round_kernel_of_interpolated_samples() {
    average(Classic::Gangnet, |prepared, view, _| {
        for (place, sides) in cases() {
            let sides = sides.map(|side| side * 4.0);
            let found = f64::from(prepared.average(&footprint(view, place, sides)).0[0]);
            let gaussian = |s: f64, t: f64| if s * s + t * t < 1.0 { (-2.0 * (s * s + t * t)).exp() } else { 0.0 };
            let expected = sampled(place, sides, 1.0, gaussian);
            assert!((found - expected).abs() < 0.02, "{place:?}, {sides:?}: {found} for {expected}");
        }
    });
}

/// A smooth world shows no step where views meet, by whatever filter.
#[test]
fn edges_of_views_do_not_show() {
    let world = cube(&CubeFace::ALL, 64, 64);
    let light = Light::by_direction(&world, |direction| {
        let [x, y, z] = direction.vector().to_array().map(|at| (0.5 + 0.5 * at) as f32);
        Rgba::opaque(x, y, z)
    });
    let target = perspective(96, 64, 100.0, 45.0, 30.0, 20.0);
    for classic in Classic::ALL {
        let prepared = classic.prepare(&world, &light).expect("light of the world");
        // A texel is 0.02 wide; squares of the coarser of two levels, or of the nearest, are four times as wide.
        let bound = if matches!(classic, Classic::MipMap(_)) { 0.05 } else { 0.012 };
        for (j, i) in (0..64).flat_map(|j| (0..96).map(move |i| (j, i))) {
            let footprint = target.footprint(PixelPoint::centre(i, j)).expect("a pinhole shows all");
            let found = prepared.average(&footprint);
            let expected = footprint.direction.vector().to_array().map(|at| 0.5 + 0.5 * at);
            let error = (0..3).map(|c| (f64::from(found.0[c]) - expected[c]).abs()).fold(0.0, f64::max);
            assert!(error < bound, "{classic:?} at ({i}, {j}): {error}");
        }
    }
}
