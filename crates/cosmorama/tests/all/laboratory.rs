//! The filter laboratory, on filters whose aliasing and blur are known.

use std::ops::ControlFlow;

use cosmorama::filter::{Classic, CrossSection, Filter, FilterKind, FilterSettings};
use cosmorama::laboratory::figures::{circles, cone, kernel, paraboloid};
use cosmorama::laboratory::{CROP, Laboratory, Response, Row, busiest, sheet};
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama::world::{Light, World};
use testkit::{cube, equirect, omnimax, perspective};

fn filter(kind: FilterKind) -> FilterSettings {
    FilterSettings { kind, ..FilterSettings::DEFAULT }
}

fn response(world: &World, size: usize, kind: FilterKind) -> Response {
    let light = Light::by_direction(world, |_| Rgba::BLACK);
    let target = perspective(size, size, 40.0, 10.0, 20.0, 30.0);
    let laboratory = Laboratory::new((world, &light), &target);
    laboratory.response(&filter(kind), &|_: f64| ControlFlow::Continue(())).expect("not stopped")
}

/// Four texels a pixel or more.
fn fine() -> World {
    cube(&CubeFace::ALL, 2048, 2048)
}

#[test]
fn what_picks_single_texels_keeps_all_that_it_should_lose() {
    let found = response(&fine(), 200, FilterKind::Point);
    let aliasing = found.aliasing.expect("more texels than pixels");
    assert!(aliasing.abs() < 0.2, "{aliasing} dB");
    // An edge is as sharp as a texel: 0.8 of a quarter of a pixel, and two bins around.
    assert!(found.edge_width.expect("edges") < 0.4, "{found:?}");
}

/// A box is the pixel itself: an edge takes 0.8 of its width along its sides, and somewhat more across corners.
#[test]
fn a_box_blurs_by_a_pixel_and_lets_some_aliasing_through() {
    let found = response(&fine(), 200, FilterKind::Classic(Classic::Catmull));
    let (width, aliasing) = (found.edge_width.expect("edges"), found.aliasing.expect("more texels than pixels"));
    assert!((0.75..0.95).contains(&width), "{width} px");
    assert!((-14.0..-6.0).contains(&aliasing), "{aliasing} dB");
}

/// The paper's Gaussian leaves exp(−π² f²/2) of a frequency: less than a box, for more blur.
#[test]
fn the_papers_gaussian_aliases_less_than_a_box_and_blurs_more() {
    let [paper, catmull] = [Classic::EwaPaper, Classic::Catmull].map(|classic| {
        let found = response(&fine(), 200, FilterKind::Classic(classic));
        (found.aliasing.expect("more texels than pixels"), found.edge_width.expect("edges"))
    });
    assert!(paper.0 < catmull.0 - 2.0 && paper.1 > catmull.1, "{paper:?}, and {catmull:?} by a box");
}

#[test]
fn coarse_texels_hold_nothing_that_could_alias() {
    let world = cube(&CubeFace::ALL, 128, 128);
    assert_eq!(response(&world, 200, FilterKind::Point).aliasing, None);
}

#[test]
fn texels_are_counted() {
    let world = cube(&CubeFace::ALL, 512, 512);
    let light = Light::by_direction(&world, |_| Rgba::BLACK);
    let target = perspective(64, 64, 40.0, 10.0, 20.0, 30.0);
    let laboratory = Laboratory::new((&world, &light), &target);
    let reads = |kind| laboratory.reads(&*filter(kind).prepare(&world, &light).expect("light of the world"));
    assert_eq!(reads(FilterKind::Point), 1.0);
    // Beside the edge of a face, some of the four are looked up in the other.
    assert!((4.0..4.1).contains(&reads(FilterKind::Bilinear)));
    // 256 texels a radian at the middle of a face, and twice as many at its corners; 88 pixels: 2.9 to 5 texels a pixel's
    // side. A square of side s, in any orientation, touches s² + 8 s/π + 1 texels: 17 to 39.
    let catmull = reads(FilterKind::Classic(Classic::Catmull));
    assert!((17.0..39.0).contains(&catmull), "{catmull}");
    assert!(reads(FilterKind::Reference { samples: 4 }) > 4.0 * 16.0);
}

#[test]
fn crops_are_of_the_busiest_places_and_lie_side_by_side() {
    let busy = |i: usize, j: usize| (200..260).contains(&i) && (70..120).contains(&j);
    let picture = Image::from_fn(400, 300, |i, j| {
        let value = if busy(i, j) { (i % 2) as f32 } else { 0.5 };
        Rgba::opaque(value, value, value)
    });
    let places = busiest(&picture, |_, _| true, 2);
    assert_eq!((places.len(), places[0]), (2, (192, 64)));
    assert!(busiest(&picture, |i, _| i < 100, 4).iter().all(|&(left, _)| left + CROP <= 100));
    let row = || Row::new(vec!["a filter".to_owned()], &picture, &places);
    let (one, two) = (sheet(&[row()]), sheet(&[row(), row()]));
    assert!(one.width() == two.width() && two.height() > one.height() + 2 * CROP - 1);
    assert!(one.pixels().iter().all(|pixel| pixel.alpha() == 1.0));
}

/// As the paper says: a cone over 3/8 of the world in one of Mercator's maps, and on five faces of a cube.
#[test]
fn a_wide_reflection_cone_touches_five_faces() {
    let half_angle = Angle::from_radians(0.25f64.acos());
    let degrees = Angle::from_degrees;
    let axis = Orientation::from_yaw_pitch_roll(degrees(25.0), degrees(65.0), degrees(0.0)).to_world(Direction::FRONT);
    let (svg, touched) = cone(&cube(&CubeFace::ALL, 64, 64), axis, half_angle);
    assert!(touched == 5 && svg.contains("37.5 % of the world"), "{touched}");
    let map = World::new([("map".to_owned(), equirect(128))]).expect("one view");
    assert_eq!(cone(&map, axis, half_angle).1, 1);
}

/// Each has what it is of, more than once: circles, dots, contours, a curve.
#[test]
fn figures_are_drawings() {
    let (world, target) = (cube(&CubeFace::ALL, 256, 256), omnimax(400, 292));
    let gaussian = CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 };
    let q = paraboloid(&world, &target, (70, 120)).expect("inside the frame");
    // Four contours, and a dot for each of 17 × 13 texels; a circle and its dot for each of some 25 × 18 pixels, of which the
    // frame's rim cuts corners.
    for (svg, shape, [least, most]) in [
        (q, "<ellipse", [4 + 17 * 13, 4 + 17 * 13]),
        (circles(&target), "<ellipse", [2 * 250, 2 * 26 * 19]),
        // Two axes' ticks with their numbers, both axes' names, the title, and the curve.
        (kernel(gaussian, "exp(-2 r²)"), "<path", [12, 60]),
    ] {
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"), "{svg}");
        let count = svg.matches(shape).count();
        assert!((least..=most).contains(&count), "{count} times {shape}");
    }
    // The curve has all its points.
    let curve = kernel(gaussian, "exp(-2 r²)");
    assert!(curve.split("<path").any(|path| path.matches('L').count() == 400), "{curve}");
    assert_eq!(paraboloid(&world, &target, (0, 0)), None, "outside the frame");
}

/// As many as a pixel is long, twice: none of its texels is missed.
#[test]
fn the_reference_takes_two_samples_a_texel() {
    let light = |world: &World| Light::by_direction(world, |_| Rgba::BLACK);
    let target = perspective(64, 64, 40.0, 10.0, 20.0, 30.0);
    for (side, [least, most]) in [(64, [4, 4]), (512, [7, 14]), (2048, [32, 32])] {
        let world = cube(&CubeFace::ALL, side, side);
        let samples = Laboratory::new((&world, &light(&world)), &target).samples();
        assert!((least..=most).contains(&samples), "{side}: {samples}");
    }
}
