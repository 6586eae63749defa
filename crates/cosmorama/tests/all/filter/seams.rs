//! No step where one view ends and another begins: across the edges and corners of the cube, at ±180° and at the poles.

use cosmorama::camera::View;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::Rgba;
use cosmorama::render::Resampler;
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::World;
use testkit::{cube, equirect, light_by_direction, omnimax, perspective, whole_worlds};

/// Waves of some forty texels: smooth enough that the filter itself changes next to nothing, so that what a wrong weight
/// adds at an edge would stand out.
fn detail(direction: Direction) -> [f32; 3] {
    let d = direction.vector();
    let wave = |x: f64, y: f64| (0.5 + 0.25 * (x * 19.0).sin() + 0.25 * (y * 15.0 + x * 9.0).cos()) as f32;
    [wave(d.x, d.y), wave(d.y, d.z), wave(d.z, d.x)]
}

/// No step on an edge is larger, of a contrast of one: an eighth of a code value of eight bits.
const STEP: f64 = 0.0005;

const JUDGE: FilterSettings = FilterSettings { kind: FilterKind::Reference { samples: 3 }, ..FilterSettings::DEFAULT };

/// Pixels beside an edge with which the edge itself is compared: the same texels, the same light, but no crossing.
const BESIDE: usize = 5;

/// Differences of neighbouring pixels' errors: beside edges, and across them. The error is the result less the
/// true light, so the world's own contrast does not count, only what the filter adds.
fn steps(
    world: &World,
    target: &View,
    filter: FilterSettings,
    on_edge: impl Fn(Direction, Direction) -> bool,
) -> [Steps; 2] {
    let light = light_by_direction(world, detail);
    let image = Resampler { world, target, filter }.render(&light);
    let direction = |i, j| target.screen_pixel(i, j).map(|screen| screen.footprint.direction);
    let error = |i: usize, j: usize, c: usize| {
        let truth = direction(i, j).map_or([0.0; 3], detail);
        f64::from(image.get(i, j).0[c] - truth[c])
    };
    let mut steps = [Steps::default(); 2];
    let crosses = |a: (usize, usize), b: (usize, usize)| {
        direction(a.0, a.1).zip(direction(b.0, b.1)).is_some_and(|(a, b)| on_edge(a, b))
    };
    for j in BESIDE..image.height() - BESIDE {
        for i in BESIDE..image.width() - BESIDE {
            let is_beside = crosses((i - BESIDE, j), (i + BESIDE, j)) || crosses((i, j - BESIDE), (i, j + BESIDE));
            for next in [(i + 1, j), (i, j + 1)] {
                let step = (0..3).map(|c| (error(i, j, c) - error(next.0, next.1, c)).abs()).fold(0.0, f64::max);
                let is_across = crosses((i, j), next);
                if is_across || is_beside {
                    steps[usize::from(is_across)].add(step);
                }
            }
        }
    }
    steps
}

#[derive(Clone, Copy, Debug, Default)]
struct Steps {
    largest: f64,
    squares: f64,
    count: usize,
}

impl Steps {
    fn add(&mut self, step: f64) {
        self.largest = self.largest.max(step);
        self.squares += step * step;
        self.count += 1;
    }

    /// Root of the mean square: the largest of so few is as chance has it.
    fn typical(&self) -> f64 {
        (self.squares / self.count as f64).sqrt()
    }
}

/// Across no edge does the filter's largest step stand out from those beside it, nor its typical one by more than the
/// reference's does.
fn assert_no_seam(world: &World, targets: &[(&str, View)], on_edge: impl Fn(Direction, Direction) -> bool + Copy) {
    for (name, target) in targets {
        let [beside, across] = steps(world, target, FilterSettings::DEFAULT, on_edge);
        assert!(across.largest > 0.0 && beside.largest > 0.0, "{name}: no edge in the picture");
        assert!(
            across.largest <= beside.largest && across.largest < STEP,
            "{name}: {across:?} across, {beside:?} beside"
        );
        let judge = steps(world, target, JUDGE, on_edge);
        let (seam, judged) = (across.typical() / beside.typical(), judge[1].typical() / judge[0].typical());
        assert!(seam <= judged, "{name}: the step across is {seam} of those beside, by the reference {judged}");
    }
}

#[test]
fn no_step_across_the_twelve_edges_and_the_corners() {
    let world = cube(&CubeFace::ALL, 256, 256);
    let mut targets = Vec::new();
    for yaw in [45.0, 135.0, -135.0, -45.0] {
        targets.push(("an upright edge", perspective(120, 90, 40.0, yaw, 0.0, 10.0)));
        targets.push(("an upper corner", perspective(120, 90, 40.0, yaw, 35.26, 0.0)));
        targets.push(("a lower corner", perspective(120, 90, 40.0, yaw, -35.26, 0.0)));
    }
    for yaw in [0.0, 90.0, 180.0, -90.0] {
        targets.push(("an upper edge", perspective(120, 90, 40.0, yaw, 45.0, 10.0)));
        targets.push(("a lower edge", perspective(120, 90, 40.0, yaw, -45.0, 10.0)));
    }
    assert_no_seam(&world, &targets, |a, b| CubeFace::of(a) != CubeFace::of(b));
}

#[test]
fn no_step_between_faces_of_different_sizes_beyond_the_coarser_one() {
    let sizes = [(256, 256), (200, 240), (256, 256), (320, 256), (256, 230), (256, 256)];
    let views = CubeFace::ALL.iter().zip(sizes);
    let views = views.map(|(&face, (w, h))| (face.name().to_owned(), testkit::cube_face(face, w, h)));
    let world = World::new(views).expect("six faces");
    let corner = perspective(160, 120, 40.0, 45.0, 35.26, 0.0);
    assert_no_seam(&world, &[("a corner", corner)], |a, b| CubeFace::of(a) != CubeFace::of(b));
}

#[test]
fn no_step_at_the_back_of_a_panorama() {
    let world = World::new([("panorama".to_owned(), equirect(1024))]).expect("one view");
    let behind = |a: Direction, b: Direction| {
        let (a, b) = (a.vector(), b.vector());
        a.z > 0.0 && b.z > 0.0 && (a.x < 0.0) != (b.x < 0.0)
    };
    assert_no_seam(&world, &[("the back", perspective(160, 120, 40.0, 180.0, 10.0, 3.0))], behind);
}

#[test]
fn no_step_where_the_edges_of_a_map_meet() {
    let behind = |a: Direction, b: Direction| {
        let (a, b) = (a.vector(), b.vector());
        a.z > 0.0 && b.z > 0.0 && (a.x < 0.0) != (b.x < 0.0)
    };
    let target = perspective(160, 120, 40.0, 180.0, 10.0, 3.0);
    for (name, map) in whole_worlds(512) {
        let world = World::new([(name.to_owned(), map)]).expect("one view");
        let [beside, across] = steps(&world, &target, FilterSettings::DEFAULT, behind).map(|steps| steps.largest);
        // The lattices of both sides do not match; where texels are coarse, that shows no more than the texels themselves.
        assert!(across > 0.0 && beside > 0.0, "{name}: no edge in the picture");
        assert!(across < STEP.max(1.5 * beside), "{name}: {across} across, {beside} beside");
    }
}

#[test]
fn no_step_around_the_poles_of_a_panorama_beyond_the_reference() {
    let world = World::new([("panorama".to_owned(), equirect(1024))]).expect("one view");
    let near_pole = |a: Direction, b: Direction| a.vector().y.abs().min(b.vector().y.abs()) > 0.999;
    for target in [perspective(160, 120, 40.0, 0.0, 90.0, 0.0), perspective(160, 120, 40.0, 77.0, -85.0, 0.0)] {
        let [around, reference] =
            [FilterSettings::DEFAULT, JUDGE].map(|filter| steps(&world, &target, filter, near_pole)[1].largest);
        assert!(around > 0.0 && around <= reference && around < STEP, "{around}, {reference} by the reference");
    }
}

#[test]
fn what_lies_outside_a_partial_face_never_leaks_in() {
    let world = cube(&CubeFace::ALL, 128, 128);
    let clean = light_by_direction(&world, detail);
    let target = testkit::omnimax(246, 180);
    let resampler = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT };
    let expected = resampler.render(&clean);
    // Whatever the field of view does not touch: 90.162° and a texel's diagonal around the axis, 45° below it.
    let mut soiled = clean.clone();
    for source in world.sources() {
        for (k, texel) in soiled[source.texels()].iter_mut().enumerate() {
            let pixel = cosmorama::camera::PixelPoint::centre(k % source.view.width(), k / source.view.width());
            let direction = source.view.direction(pixel).expect("a face is all directions");
            let below = direction.vector().y < direction.vector().z;
            let beyond = direction.angle_to(Direction::FRONT).degrees() > 90.162 + 45.0 / 128.0 * 1.5;
            if beyond || (below && source.name == "down") {
                *texel = Rgba([f32::NAN, 1e9, -1e9, 1.0]);
            }
        }
    }
    assert_eq!(resampler.render(&soiled), expected);
}

/// How far the error of a world whose colour is its direction jumps from a pixel to the next across the edge of a face, at the
/// most: zero where the edge cannot be told.
fn step_across(world: &World, light: &[Rgba], target: &View, filter: FilterSettings) -> f64 {
    let image = Resampler { world, target, filter }.render(light);
    let seen = |i, j| target.screen_pixel(i, j).filter(|screen| screen.coverage == 1.0);
    let error = |i, j| {
        let direction = seen(i, j)?.footprint.direction;
        let light = image.get(i, j).0;
        let error: [f64; 3] = std::array::from_fn(|c| f64::from(light[c]) - direction.vector()[c]);
        Some((CubeFace::of(direction), error))
    };
    let (mut largest, mut crossings) = (0f64, 0);
    for (i, j) in (6..image.height() - 6).flat_map(|j| (6..image.width() - 6).map(move |i| (i, j))) {
        let Some((face, here)) = error(i, j) else { continue };
        for (next, there) in [error(i + 1, j), error(i, j + 1)].into_iter().flatten() {
            if next != face {
                crossings += 1;
                largest = (0..3).map(|c| (here[c] - there[c]).abs()).fold(largest, f64::max);
            }
        }
    }
    assert!(crossings > 50, "the target shows the edge of a face");
    largest
}

#[test]
fn directions_step_across_edges_no_more_than_by_the_reference() {
    // Single precision holds a direction to 6e-8; what eight texels add may round to some of those.
    const ROUNDING: f64 = 1e-6;
    for size in [128, 256, 512] {
        let world = cube(&CubeFace::ALL, size, size);
        let light = light_by_direction(&world, |d| d.vector().to_array().map(|c| c as f32));
        let near = [
            perspective(120, 90, 40.0, 45.0, 0.0, 10.0),
            perspective(120, 90, 40.0, 45.0, 35.26, 0.0),
            perspective(160, 120, 20.0, 45.0, 10.0, 0.0),
        ];
        // Enlarged and reduced; what lies between, the near ones show.
        let wide = if size == 256 { [].as_slice() } else { &[omnimax(491, 359), equirect(512)] };
        for target in near.iter().chain(wide) {
            let reference = FilterSettings { kind: FilterKind::Reference { samples: 4 }, ..FilterSettings::DEFAULT };
            let [ours, reference] =
                [FilterSettings::DEFAULT, reference].map(|filter| step_across(&world, &light, target, filter));
            assert!(ours <= reference + ROUNDING, "{size}: {ours} is more than {reference}, {:?}", target.projection);
        }
    }
}
