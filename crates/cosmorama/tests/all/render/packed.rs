//! Pictures that overlap by construction, two fisheyes back to back and faces of more than 90°: nothing counts twice,
//! nothing is displaced, and one goes over into the other without an edge.

use cosmorama::camera::{CameraModel, FisheyeCamera, LayoutFaceCamera, Mirror, Placement, View};
use cosmorama::filter::FilterSettings;
use cosmorama::layout::{Arrangement, DualFisheye, DualLens, LensSide};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::{Blend, World, WorldView};
use testkit::{equirect, fisheye, light_by_direction, light_by_texel, perspective, position_error, turned};

/// Pixels by which a point of the world may be displaced.
const POSITION_PROMISE: f64 = 0.01;

/// Two circles of so many pixels, a little turned, as real cameras are; blended over all that both see.
fn dual_fisheye(edge: usize, field_of_view: [f64; 2]) -> World {
    let [front, back] = field_of_view
        .map(|degrees| FisheyeCamera { field_of_view: Angle::from_degrees(degrees), ..FisheyeCamera::default() });
    let dual = DualFisheye {
        arrangement: Arrangement::SideBySide,
        first: LensSide::Front,
        front: DualLens { frame: front, turned: Orientation::IDENTITY },
        back: DualLens { frame: back, turned: turned([0.7, -0.4, 91.0]) },
        feather: None,
    };
    let view = |lens: cosmorama::layout::PlacedLens| {
        let view = lens.placement.view(edge, edge).expect("a square");
        WorldView { name: lens.side.name().to_owned(), view, blend: dual.blend(), mask: None }
    };
    World::blended(dual.lenses(2 * edge, edge, Mirror::default()).expect("two halves").map(view)).expect("two views")
}

/// Faces that see so much both ways, blended over all that two see.
fn wide_cube(edge: usize, degrees: f64) -> World {
    let field_of_view = Angle::from_degrees(degrees);
    let frame = CameraModel::LayoutFace(LayoutFaceCamera { field_of_view, ..LayoutFaceCamera::default() });
    let blend = Blend { priority: 0, feather: field_of_view - LayoutFaceCamera::RIGHT_ANGLE };
    let view = |face: CubeFace| {
        let placement = Placement { orientation: face.orientation(), ..Placement::new(frame.clone()) };
        let view = placement.view(edge, edge).expect("a square");
        WorldView { name: face.name().to_owned(), view, blend, mask: None }
    };
    World::blended(CubeFace::ALL.map(view)).expect("six views")
}

fn worlds() -> [(&'static str, World); 5] {
    [
        ("dual fisheye", dual_fisheye(360, [195.0, 195.0])),
        ("dual fisheye, unequal", dual_fisheye(360, [190.0, 220.0])),
        ("faces of 100°", wide_cube(320, 100.0)),
        ("faces of 92°", wide_cube(320, 92.0)),
        ("faces of 110°", wide_cube(320, 110.0)),
    ]
}

/// Pictures across everything that overlaps, enlarged and reduced.
fn targets() -> [(&'static str, View); 5] {
    [
        ("panorama", equirect(400)),
        ("an edge, enlarged", perspective(160, 120, 30.0, 45.0, 10.0, 0.0)),
        ("a corner, enlarged", perspective(160, 120, 20.0, 45.0, 35.26, 7.0)),
        ("the rims", perspective(160, 120, 40.0, 90.0, -20.0, 0.0)),
        ("reduced", fisheye(64, 360.0)),
    ]
}

fn for_each_pixel(target: &View, mut visit: impl FnMut(usize, usize)) {
    (0..target.height()).for_each(|j| (0..target.width()).for_each(|i| visit(i, j)));
}

#[test]
fn every_direction_counts_once() {
    let sphere = 4.0 * std::f64::consts::PI;
    for (name, world) in worlds() {
        let sum: f64 = world.solid_angles().map(f64::from).sum();
        assert!((sum / sphere - 1.0).abs() < 2e-4, "{name}: {sum}");
    }
}

#[test]
fn a_constant_world_stays_constant() {
    let colour = Rgba::opaque(0.3, 1.7, 0.0004);
    for (name, world) in worlds() {
        let light = vec![colour; world.texel_count()];
        for (of, target) in targets() {
            let image = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
            for_each_pixel(&target, |i, j| {
                let Some(screen) = target.screen_pixel(i, j) else { return };
                for c in 0..4 {
                    let error = (image.get(i, j).0[c] / (colour.0[c] * screen.coverage as f32) - 1.0).abs();
                    assert!(error < 1e-6, "{name}, {of} at ({i}, {j}): {error}");
                }
            });
        }
    }
}

#[test]
fn directions_come_back_from_what_overlaps() {
    for (name, world) in worlds() {
        let light = light_by_direction(&world, |d| d.vector().to_array().map(|c| c as f32));
        for (of, target) in targets() {
            let image = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
            let mut worst = 0f64;
            for_each_pixel(&target, |i, j| {
                let Some(screen) = target.screen_pixel(i, j) else { return };
                // What a rim at 360° cuts is bent within itself.
                if screen.coverage == 1.0 && target.margin(screen.footprint.direction) > 0.2 {
                    worst = worst.max(position_error(&screen.footprint, *image.get(i, j)));
                }
            });
            println!("{name}, {of}: {worst:.4} px");
            assert!(worst < POSITION_PROMISE, "{name}, {of}: {worst} px");
        }
    }
}

/// Two lattices of texels do not share every kernel as their weights say: by so much, where views differ by one.
const RIPPLE: f32 = 0.03;

/// The largest difference between neighbours.
fn largest_step(image: &Image<Rgba>, target: &View) -> f32 {
    let mut largest = 0f32;
    for_each_pixel(target, |i, j| {
        let here = image.get(i, j).0[0];
        for (x, y) in [(i + 1, j), (i, j + 1)] {
            if x < target.width() && y < target.height() {
                largest = largest.max((image.get(x, y).0[0] - here).abs());
            }
        }
    });
    largest
}

#[test]
fn one_view_goes_over_into_the_other_without_an_edge() {
    // Each view has a brightness of its own: whatever edge there could be shows. The steepest place of the blend, in the
    // middle, has one and a half times the mean slope, which is that of the band over which it goes.
    let target = perspective(400, 300, 60.0, 67.0, 20.0, 10.0);
    let pixel = 60f64.to_radians() / 400.0 * 1.4;
    for (name, world, band) in [
        ("dual fisheye", dual_fisheye(360, [195.0, 195.0]), 13.0),
        ("faces of 100°", wide_cube(320, 100.0), 10.0),
        ("faces of 120°", wide_cube(320, 120.0), 30.0),
    ] {
        let light = light_by_texel(&world, |view, _, _, _| {
            let brightness = if view == 0 { 1.0 } else { 0.0 };
            Rgba::opaque(brightness, brightness, brightness)
        });
        let image = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
        let (step, allowed) = (largest_step(&image, &target), (1.5 * pixel / f64::to_radians(band)) as f32);
        println!("{name}: step {step:.4}, allowed {allowed:.4}");
        assert!(
            step > 0.2 * allowed && step < allowed + RIPPLE,
            "{name}: a step of {step}, where {allowed} is the slope"
        );
    }
}
