//! What a conversion needs: exact rectangles, against the filter itself.

use cosmorama::camera::{PixelRect, View};
use cosmorama::filter::{CrossSection, FilterKind, FilterSettings, Kernel};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Accuracy, Arithmetic, Need, Needs, Plan, Resampler};
use cosmorama::sphere::CubeFace;
use cosmorama::world::{Source, World};
use testkit::{cube, equirect, fisheye, omnimax, perspective, turned, whole_worlds};

fn rect(left: usize, top: usize, right: usize, bottom: usize) -> Option<PixelRect> {
    Some(PixelRect { left, top, right, bottom })
}

fn needs(world: &World, target: View) -> Needs {
    Needs::of(world, &[target], &FilterSettings::DEFAULT, Accuracy::Exact)
}

fn bounds(world: &World, target: View, filter: &FilterSettings) -> Needs {
    Needs::of(world, &[target], filter, Accuracy::Bounds)
}

fn need_of(needs: &Needs, name: &str) -> (Option<PixelRect>, Option<PixelRect>) {
    let need = needs.views.iter().find(|need| need.name == name).expect("a view of this name");
    (need.seen, need.read)
}

#[test]
fn omnimax_needs_a_little_more_than_half_of_the_side_faces() {
    let needs = needs(&cube(&CubeFace::ALL, 1024, 1024), omnimax(1966, 1436));
    assert_eq!(need_of(&needs, "front").0, rect(0, 0, 1024, 1024));
    // φ(1) = 90.162°: 1.45 texels past the middle of a 1024 face (512·tan 0.162° = 1.449).
    assert_eq!(need_of(&needs, "left").0, rect(510, 0, 1024, 1024));
    assert_eq!(need_of(&needs, "right").0, rect(0, 0, 514, 1024));
    assert_eq!(need_of(&needs, "up").0, rect(0, 510, 1024, 1024));
    assert_eq!(need_of(&needs, "back"), (None, None));
    assert_eq!(need_of(&needs, "down").0, None);
    assert_eq!(needs.uncovered, None);
}

#[test]
fn rectangles_are_those_of_the_plain_scan() {
    // Beside large texels a kernel is wide among small ones, too.
    let mixed = World::new(CubeFace::ALL.map(|face| {
        let size = if face == CubeFace::Front { 96 } else { 12 };
        (face.name().to_owned(), testkit::cube_face(face, size, size))
    }));
    let worlds = [cube(&CubeFace::ALL, 96, 96), cube(&CubeFace::ALL, 96, 80), mixed.expect("six faces")];
    let tilted = View { orientation: turned([25.0, -70.0, 15.0]), ..fisheye(150, 220.0) };
    let targets =
        [omnimax(200, 146), tilted, equirect(160), perspective(160, 120, 70.0, 40.0, 20.0, 5.0), fisheye(7, 360.0)];
    for world in worlds {
        for target in &targets {
            assert_eq!(needs(&world, target.clone()).views, plain_scan(&world, target), "{target:?}");
        }
    }
    let panorama = World::new([("panorama".to_string(), equirect(256))]).expect("a world");
    for target in targets {
        assert_eq!(needs(&panorama, target.clone()).views, plain_scan(&panorama, &target), "{target:?}");
    }
}

#[test]
fn at_most_so_much_is_read_and_exactly_so_much_is_seen() {
    let panorama = World::new([("panorama".to_string(), equirect(256))]).expect("a world");
    let dome = World::new([("dome".to_string(), fisheye(128, 180.0))]).expect("a world");
    let five = cube(&CubeFace::ALL[1..], 64, 64);
    let mut unseen = 0;
    for world in [panorama, dome, five] {
        for target in [omnimax(200, 146), equirect(160), perspective(160, 120, 70.0, 40.0, 20.0, 5.0)] {
            let (exact, most) =
                (needs(&world, target.clone()), bounds(&world, target.clone(), &FilterSettings::DEFAULT));
            let seen = Needs::of(&world, std::slice::from_ref(&target), &FilterSettings::DEFAULT, Accuracy::Seen);
            assert_eq!((exact.uncovered, exact.uncovered), (most.uncovered, seen.uncovered), "{target:?}");
            for (exact, found) in exact.views.iter().zip(&seen.views) {
                assert_eq!(exact.seen, found.seen, "{target:?}");
                let holds = |read| found.read.is_some_and(|found| found.contains(&read));
                assert!(exact.read.is_none_or(holds), "{exact:?} is not in {found:?}");
            }
            for (exact, most) in exact.views.iter().zip(&most.views) {
                assert_eq!(exact.seen, most.seen, "{target:?}");
                let holds = |read| most.read.is_some_and(|most| most.contains(&read));
                assert!(exact.read.is_none_or(holds), "{exact:?} is not in {most:?}");
                // Of views that show no pixel's direction, exactly so much.
                assert!(exact.seen.is_some() || exact == most, "{exact:?} is not {most:?}: {target:?}");
                unseen += usize::from(exact.seen.is_none());
            }
        }
    }
    assert!(unseen > 0);
}

#[test]
fn what_is_within_reach_of_a_cube_holds_what_is_read() {
    for size in [(64, 64), (96, 80), (700, 700)] {
        let world = cube(&CubeFace::ALL, size.0, size.1);
        let tilted = View { orientation: turned([25.0, -70.0, 15.0]), ..fisheye(150, 220.0) };
        let front = perspective(128, 128, 90.0, 0.0, 0.0, 0.0);
        let turned = perspective(160, 120, 70.0, 40.0, 20.0, 5.0);
        for target in [omnimax(200, 146), omnimax(983, 718), tilted, front, turned, equirect(160), fisheye(300, 180.0)]
        {
            check_reach(&world, target, &FilterSettings::DEFAULT);
        }
    }
}

#[test]
fn what_does_not_matter_is_not_looked_for() {
    let world = cube(&CubeFace::ALL, 700, 700);
    let (mut open, mut read) = (0, 0);
    for yaw in 0..12 {
        let target = [perspective(40, 30, 85.0, 7.0 * f64::from(yaw), 4.0, 2.0)];
        let settled = Needs::of(&world, &target, &FilterSettings::DEFAULT, Accuracy::Bounds);
        for place in 0..settled.views.len() {
            let found = Needs::bounds(&world, &target, &FilterSettings::DEFAULT, |at, _| at == place);
            assert_eq!(found.views[place], settled.views[place]);
            for (found, settled) in found.views.iter().zip(&settled.views) {
                assert_eq!(found.seen, settled.seen);
                assert!(settled.read.is_none_or(|read| found.read.is_some_and(|found| found.contains(&read))));
                open += usize::from(found.read.is_some() && settled.read.is_none());
                read += usize::from(found.read.is_some());
            }
        }
    }
    assert!(0 < open && open < read, "{open} of {read}");
}

/// What is found from blocks holds what each pixel needs.
fn check_reach(world: &World, target: View, filter: &FilterSettings) {
    let exact = Needs::of(world, std::slice::from_ref(&target), filter, Accuracy::Exact);
    let quick = bounds(world, target.clone(), filter);
    assert_eq!(exact.uncovered, quick.uncovered, "{target:?}");
    for (exact, quick) in exact.views.iter().zip(&quick.views) {
        let holds = |read| quick.read.is_some_and(|quick| quick.contains(&read));
        assert!(exact.read.is_none_or(holds), "{exact:?} is not in {quick:?}: {filter:?}, {target:?}");
        assert_eq!(exact.seen.is_some(), quick.seen.is_some(), "{exact:?}, {quick:?}: {target:?}");
        let is_seen = |seen| exact.seen.is_some_and(|exact| exact.contains(&seen));
        assert!(quick.seen.is_none_or(is_seen), "{quick:?} is not in {exact:?}: {target:?}");
    }
}

/// Maps that end without a stop, crease or have a steep rim, turned so that their edges cross faces.
#[test]
fn what_is_within_reach_holds_what_any_map_reads_by_any_filter() {
    let kinds = [FilterKind::Ewa, FilterKind::EwaPyramid, FilterKind::Point, FilterKind::Bilinear];
    let world = cube(&CubeFace::ALL, 96, 80);
    for (_, map) in whole_worlds(72) {
        for orientation in [map.orientation, turned([25.0, -70.0, 15.0])] {
            for kind in kinds {
                check_reach(
                    &world,
                    View { orientation, ..map.clone() },
                    &FilterSettings { kind, ..FilterSettings::DEFAULT },
                );
            }
        }
    }
}

/// Finds needs from pictures alone: a texel is read if its light changes the picture, and seen if point sampling shows it.
fn plain_scan(world: &World, target: &View) -> Vec<Need> {
    let plan_of = |kind| {
        let filter = FilterSettings { kind, anti_ringing: false, ..FilterSettings::DEFAULT };
        Resampler { world, target, filter }.plan(Arithmetic::Float).expect("a filter with a plan")
    };
    let (point, ewa) = (plan_of(FilterKind::Point), plan_of(FilterKind::Ewa));
    let need = |source: &Source| Need {
        name: source.name.clone(),
        seen: lit_bounds(world, source, &point),
        read: lit_bounds(world, source, &ewa),
    };
    world.sources().iter().map(need).collect()
}

fn lit_bounds(world: &World, source: &Source, plan: &Plan) -> Option<PixelRect> {
    let shows = |lit: &dyn Fn(usize, usize) -> bool| {
        let mut texels = vec![Rgba::TRANSPARENT; world.texel_count()];
        for (k, texel) in texels[source.texels()].iter_mut().enumerate() {
            *texel = Rgba([f32::from(u8::from(lit(k % source.view.width(), k / source.view.width()))); 4]);
        }
        plan.apply(&texels).pixels().iter().any(|pixel| pixel.0[0] != 0.0)
    };
    // The least t for which the texels with `along < t` show in the picture.
    let least = |size: usize, lit: &dyn Fn(usize, usize, usize) -> bool| {
        let (mut dark, mut light) = (0, size);
        while light - dark > 1 {
            let middle = (dark + light) / 2;
            if shows(&|i, j| lit(i, j, middle)) { light = middle } else { dark = middle }
        }
        light
    };
    let (width, height) = (source.view.width(), source.view.height());
    shows(&|_, _| true).then(|| PixelRect {
        left: least(width, &|i, _, t| i < t) - 1,
        top: least(height, &|_, j, t| j < t) - 1,
        right: width + 1 - least(width, &|i, _, t| width - 1 - i < t),
        bottom: height + 1 - least(height, &|_, j, t| height - 1 - j < t),
    })
}

#[test]
fn light_outside_what_is_read_changes_no_byte() {
    let world = cube(&CubeFace::ALL, 128, 96);
    let noise = |k: usize| ((k * 7919) % 1009) as f32 / 1009.0;
    let clean: Vec<Rgba> =
        (0..world.texel_count()).map(|k| Rgba::opaque(noise(k), noise(k + 1), noise(k + 2))).collect();
    let gaussian =
        Kernel { scale: 0.6, floor: 0.75, ..Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }) };
    let kinds = [
        FilterSettings::DEFAULT,
        FilterSettings { kernel: gaussian, ..FilterSettings::DEFAULT },
        FilterSettings { kind: FilterKind::Point, ..FilterSettings::DEFAULT },
        FilterSettings { kind: FilterKind::Bilinear, ..FilterSettings::DEFAULT },
        FilterSettings { kind: FilterKind::Reference { samples: 3 }, ..FilterSettings::DEFAULT },
    ];
    for target in [omnimax(246, 180), perspective(90, 70, 60.0, 30.0, 35.0, 10.0)] {
        for filter in kinds {
            let needs = Needs::of(&world, std::slice::from_ref(&target), &filter, Accuracy::Exact);
            let mut dirty = clean.clone();
            for (source, need) in world.sources().iter().zip(&needs.views) {
                let width = source.view.width();
                for (k, texel) in dirty[source.texels()].iter_mut().enumerate() {
                    let (i, j) = (k % width, k / width);
                    if !need.read.is_some_and(|r| (r.left..r.right).contains(&i) && (r.top..r.bottom).contains(&j)) {
                        *texel = Rgba([f32::NAN; 4]);
                    }
                }
            }
            let resampler = Resampler { world: &world, target: &target, filter };
            let bits = |image: Image<Rgba>| {
                image.into_pixels().into_iter().flat_map(|p| p.0.map(f32::to_bits)).collect::<Vec<_>>()
            };
            assert!(bits(resampler.render(&clean)) == bits(resampler.render(&dirty)), "{filter:?} {target:?}");
        }
    }
}

#[test]
fn a_perspective_target_needs_the_middle_of_one_face() {
    let needs = needs(&cube(&CubeFace::ALL, 1000, 1000), perspective(640, 480, 45.0, 0.0, 0.0, 0.0));
    // tan 22.5° = 0.41421: 207.1 texels to both sides of 500, times 3/4 up and down.
    assert_eq!(need_of(&needs, "front").0, rect(293, 344, 707, 656));
    let read = need_of(&needs, "front").1.expect("a rectangle");
    assert!(read.left < 293 && read.left >= 290 && read.bottom > 656 && read.bottom <= 659, "{read}");
    for name in ["left", "right", "up", "down", "back"] {
        assert_eq!(need_of(&needs, name), (None, None), "{name}");
    }
}

#[test]
fn directions_that_nothing_covers_are_counted() {
    let world = cube(&[CubeFace::Front], 64, 64);
    let target = perspective(100, 100, 90.0, 45.0, 0.0, 0.0);
    let uncovered = needs(&world, target).uncovered.expect("half of the picture");
    // The front face's right edge stands upright at 45°, in the picture's middle; above and below it shows less still.
    assert!(uncovered.pixels >= 5000, "{uncovered:?}");
    let (yaw, pitch) = uncovered.direction.longitude_latitude();
    assert_eq!((uncovered.target, uncovered.row), (0, 0));
    assert!((0.0..90.0).contains(&yaw.degrees()) && pitch.degrees() > 0.0);
    // At yaw 45° the picture goes up and down to 45°, the face only to 35°: a part to the left of that lacks, too.
    let ((left, right), (low, high)) = (uncovered.extent.yaws(), uncovered.extent.pitches());
    assert_eq!((right, low, high), (90, -45, 45), "{}", uncovered.extent);
    assert!((0..45).contains(&left), "{left}");
    assert_eq!(needs_of_two(&world).map(|found| found.target), Some(1));
}

fn needs_of_two(world: &World) -> Option<cosmorama::render::Uncovered> {
    let covered = perspective(40, 40, 60.0, 0.0, 0.0, 0.0);
    let beside = perspective(40, 40, 60.0, 60.0, 0.0, 0.0);
    Needs::of(world, &[covered, beside], &FilterSettings::DEFAULT, Accuracy::Exact).uncovered
}
