//! Pictures of a few pixels: a constant environment of one is usual in look development.

use cosmorama::camera::View;
use cosmorama::explain::Report;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::Rgba;
use cosmorama::render::Resampler;
use cosmorama::world::World;
use testkit::{Form, equirect, perspective};

const COLOUR: Rgba = Rgba::opaque(0.3, 1.7, 0.0004);

const SIZES: [(usize, usize); 7] = [(1, 1), (2, 1), (1, 2), (2, 2), (3, 2), (1, 5), (5, 1)];

const FILTERS: [FilterKind; 5] = [
    FilterKind::Ewa,
    FilterKind::EwaPyramid,
    FilterKind::Reference { samples: 2 },
    FilterKind::Bilinear,
    FilterKind::Point,
];

/// Every camera with every such size.
fn views() -> impl Iterator<Item = (String, View)> {
    Form::cameras().into_iter().flat_map(|(name, camera)| {
        SIZES.into_iter().filter_map(move |(width, height)| {
            Some((format!("{name} of {width}x{height}"), camera.view(width, height).ok()?))
        })
    })
}

fn world(view: View) -> Option<World> {
    World::new([("all".to_owned(), view)]).ok()
}

/// Renders a world of one colour, and checks that what it shows has that colour.
fn check(name: &str, world: &World, target: &View) {
    let light = vec![COLOUR; world.texel_count()];
    for kind in FILTERS {
        let filter = FilterSettings { kind, ..FilterSettings::DEFAULT };
        let image = Resampler { world, target, filter }.render(&light);
        for pixel in image.pixels() {
            let alpha = pixel.0[3];
            assert!((0.0..=1.0 + 1e-5).contains(&alpha), "{name}, {kind:?}: {pixel:?}");
            for c in 0..3 {
                let error = pixel.0[c] - COLOUR.0[c] * alpha;
                assert!(error.abs() <= 1e-5 * COLOUR.0[c], "{name}, {kind:?}: {pixel:?}");
            }
        }
    }
}

#[test]
fn a_world_of_a_few_pixels_stays_constant() {
    let targets = [equirect(12), perspective(7, 5, 90.0, 0.0, 0.0, 0.0), perspective(6, 6, 100.0, 20.0, 80.0, 10.0)];
    for (name, view) in views() {
        let Some(world) = world(view) else { continue };
        for target in &targets {
            check(&name, &world, target);
        }
    }
}

#[test]
fn a_picture_of_a_few_pixels_shows_a_constant_world() {
    let world = world(equirect(16)).unwrap();
    views().for_each(|(name, target)| check(&name, &world, &target));
}

#[test]
fn a_few_pixels_are_explained() {
    let target = perspective(7, 5, 90.0, 0.0, 0.0, 0.0);
    for (_, view) in views() {
        let Some(world) = world(view) else { continue };
        Report::of(&world, &target, &FilterSettings::DEFAULT);
    }
}

#[test]
fn one_texel_covers_the_whole_world() {
    let equirect = Form::cameras().into_iter().find(|(name, _)| *name == "equirect").unwrap().1;
    for (width, height) in SIZES {
        let world = world(equirect.view(width, height).unwrap()).unwrap();
        let light = vec![COLOUR; world.texel_count()];
        let target = perspective(7, 5, 90.0, 0.0, 0.0, 0.0);
        let image = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
        assert!(image.pixels().iter().all(|pixel| (pixel.0[3] - 1.0).abs() < 1e-5), "{width}x{height}");
    }
}
