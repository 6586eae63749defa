//! Filters of the literature, against one another and across the edges of views; `definitions.rs` holds each against its own.

use cosmorama::camera::{Footprint, PixelPoint, View};
use cosmorama::filter::{Classic, Filter};
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
