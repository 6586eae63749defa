use super::*;
use crate::camera::{FieldStop, PixelGrid, View};
use crate::filter::taps::average;
use crate::filter::{CrossSection, FilterSettings, Kernel};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::raster::{ColourChannel, Image, Rgba, Transfer};
use crate::sphere::{Angle, CubeFace, Orientation};
use crate::world::{Source, World, panorama};

/// A sink for tests: it collects the weight of each texel for each pixel, and counts the pixels that arrived as windows.
struct Collector {
    width: usize,
    weights: Vec<Vec<(u32, f32)>>,
    in_windows: usize,
}

impl Sink for Collector {
    fn pixel(&mut self, [column, row]: [usize; 2], _: f32, taps: &Taps) {
        self.weights[row * self.width + column] = taps.as_slice().iter().map(|tap| (tap.texel, tap.weight)).collect();
    }

    fn windows(&mut self, [column, row]: [usize; 2], lanes: u8, windows: &Windows) {
        let mut taps = Taps::default();
        for lane in (0..SIDE).filter(|&lane| lanes >> lane & 1 == 1 && windows.holds(lane)) {
            windows.taps(lane, &mut taps);
            self.pixel([column + lane, row], 1.0, &taps);
            self.in_windows += 1;
        }
    }
}

fn view(projection: ProjectionKind, size: (usize, usize), half: (f64, f64), orientation: Orientation) -> View {
    let rect = PlaneRect { min: PlanePoint::new(-half.0, -half.1), max: PlanePoint::new(half.0, half.1) };
    View { projection, orientation, grid: PixelGrid::spanning(size.0, size.1, rect), stop: FieldStop::NONE }
}

fn cube(size: usize) -> World {
    let face = |face: CubeFace| view(ProjectionKind::PERSPECTIVE, (size, size), (1.0, 1.0), face.orientation());
    World::new(CubeFace::ALL.map(|f| (f.name().to_owned(), face(f)))).expect("six faces")
}

fn sky(width: usize) -> World {
    World::new([("all".to_owned(), panorama(width, width / 2))]).expect("a panorama")
}

fn targets() -> [View; 3] {
    let turned = Orientation::from_yaw_pitch_roll(
        Angle::from_degrees(31.0),
        Angle::from_degrees(-17.0),
        Angle::from_degrees(8.0),
    );
    let circle = FieldStop::circle(1.0).with_lower(Angle::from_degrees(45.0));
    [
        View { stop: circle, ..view(ProjectionKind::OMNIMAX, (600, 600), (1.0, 1.0), turned) },
        view(ProjectionKind::PERSPECTIVE, (501, 303), (1.1, 0.7), turned),
        view(ProjectionKind::EQUIRECTANGULAR, (900, 470), (2.9, 1.5), turned),
    ]
}

fn whole(target: &View) -> Area {
    Area { columns: target.width(), rows: 0..target.height(), skips_left_of_diagonal: false }
}

fn collect(scan: &mut Scan, target: &View) -> Collector {
    let weights = vec![Vec::new(); target.width() * target.height()];
    let mut collector = Collector { width: target.width(), weights, in_windows: 0 };
    scan.pixels(&whole(target), &mut collector);
    collector
}

/// Checks that windows have the weights of single pixels, and returns how many pixels came in windows.
fn check_windows(world: &World, target: &View, kernel: Kernel) -> usize {
    let resampler = Resampler { world, target, filter: FilterSettings { kernel, ..FilterSettings::DEFAULT } };
    let table = KernelTable::new(&kernel);
    let fast = collect(&mut Scan::new((&resampler, Sampling::default()), &table, Level::new()), target);
    let slow = collect(
        &mut Scan { weigher: None, ..Scan::new((&resampler, Sampling::default()), &table, Level::new()) },
        target,
    );
    let mut differences = Vec::new();
    for (fast, slow) in fast.weights.iter().zip(&slow.weights) {
        let largest = slow.iter().fold(0f32, |largest, (_, weight)| largest.max(weight.abs()));
        let bound = 1e-3f32.min(3e-3 * largest);
        differences.clear();
        differences.extend(fast.iter().copied().chain(slow.iter().map(|&(texel, weight)| (texel, -weight))));
        differences.sort_by_key(|&(texel, _)| texel);
        for of_texel in differences.chunk_by(|a, b| a.0 == b.0) {
            let difference = of_texel.iter().map(|(_, weight)| weight).sum::<f32>().abs();
            assert!(difference < bound, "{:?}: weights differ by {difference}, over {bound}", target.projection);
        }
    }
    fast.in_windows
}

#[test]
fn windows_weigh_as_single_pixels_do() {
    for world in [cube(256), cube(700), sky(1200)] {
        for target in &targets() {
            let in_windows = check_windows(&world, target, Kernel::ADAPTIVE);
            assert!(3 * in_windows > target.width() * target.height(), "{in_windows} pixels in windows");
        }
    }
}

/// Returns the share of pixels that came in windows, on targets shrunk by this factor, after the same check.
fn share_in_windows(world: &World, shrink: usize) -> f64 {
    let shares = targets().map(|target| {
        let target = View { grid: target.grid.squeezed((shrink, shrink)), ..target };
        check_windows(world, &target, Kernel::ADAPTIVE) as f64 / (target.width() * target.height()) as f64
    });
    shares.iter().sum::<f64>() / shares.len() as f64
}

/// Tests up to a thousand texels in a window, and patches so wide that each of their pixels is measured.
#[test]
fn windows_weigh_alike_however_many_texels_a_pixel_holds() {
    let (cube, sky) = (cube(700), sky(1500));
    for (world, shrink, least) in [(&cube, 3, 0.55), (&sky, 3, 0.75), (&sky, 5, 0.65), (&sky, 10, 0.1)] {
        let share = share_in_windows(world, shrink);
        assert!(share > least, "{share} of pixels in windows, {shrink} times as small");
    }
}

/// Tests lenses, balls and maps, whose texels bend otherwise than those of a cube.
#[test]
fn windows_weigh_alike_whatever_shows_the_world() {
    use std::f64::consts::PI;
    let round = |projection, half| {
        let square = view(projection, (1000, 1000), (half, half), Orientation::IDENTITY);
        View { stop: FieldStop::circle(half), ..square }
    };
    let map = view(ProjectionKind::EQUAL_AREA_CYLINDER, (1400, 446), (PI, 1.0), Orientation::IDENTITY);
    let (lens, ball) = (round(ProjectionKind::EQUIDISTANT, PI), round(ProjectionKind::MIRROR_BALL, 1.0));
    for (source, least) in [(lens, 0.6), (ball, 0.2), (map, 0.1)] {
        let world = World::new([("all".to_owned(), source.clone())]).expect("a view");
        let shares = targets().map(|target| {
            let target = View { grid: target.grid.squeezed((4, 4)), ..target };
            check_windows(&world, &target, Kernel::ADAPTIVE) as f64 / (target.width() * target.height()) as f64
        });
        assert!(shares.iter().sum::<f64>() > 3.0 * least, "of pixels in windows, {:?}: {shares:?}", source.projection);
    }
}

#[test]
fn windows_of_one_cubic_that_is_not_centred_do_too() {
    let (world, kernel) = (cube(256), Kernel::uniform(CrossSection::MITCHELL));
    for target in &targets() {
        let in_windows = check_windows(&world, target, kernel);
        assert!(3 * in_windows > target.width() * target.height(), "{in_windows} pixels in windows");
    }
}

/// Tests a Gaussian over a panorama and over faces, from few texels in a pixel to hundreds.
#[test]
fn windows_of_the_kernel_that_keeps_light_do_too() {
    let face = |face: CubeFace, size| view(ProjectionKind::PERSPECTIVE, (size, size), (1.0, 1.0), face.orientation());
    for (world, size, least) in [(sky(1024), 128, 0.5), (sky(1024), 512, 0.5), (cube(256), 128, 0.0)] {
        for target in [CubeFace::Up, CubeFace::Front, CubeFace::Back].map(|at| face(at, size)) {
            let share = check_windows(&world, &target, Kernel::LIGHT) as f64 / (size * size) as f64;
            assert!(share > least, "{share} of {size}² pixels in windows");
        }
    }
}

/// Tests the poles of an equal-area map and the rim of a ball, where texels are measured from side to side. Away from
/// there, patches hold.
#[test]
fn windows_weigh_alike_where_a_rim_is_steep() {
    let ball = View {
        stop: FieldStop::circle(1.0),
        ..view(ProjectionKind::MIRROR_BALL, (600, 600), (1.0, 1.0), Orientation::IDENTITY)
    };
    assert!(3 * check_windows(&cube(256), &ball, Kernel::ADAPTIVE) > ball.width() * ball.height());
    let half = (std::f64::consts::PI, 1.0);
    let map = view(ProjectionKind::EQUAL_AREA_CYLINDER, (1200, 382), half, Orientation::IDENTITY);
    let world = World::new([("map".to_owned(), map)]).expect("a map");
    for target in &targets() {
        assert!(4 * check_windows(&world, target, Kernel::ADAPTIVE) > target.width() * target.height());
    }
}

/// Returns a fisheye with this half angle, in radians, that looks at the middle of a face.
fn fisheye(size: usize, half: f64) -> View {
    let stop = FieldStop::circle(half);
    View { stop, ..view(ProjectionKind::EQUIDISTANT, (size, size), (half, half), Orientation::IDENTITY) }
}

#[test]
fn only_pixels_that_the_rim_is_near_come_by_themselves() {
    let target = fisheye(400, 0.5);
    let in_windows = check_windows(&cube(512), &target, Kernel::ADAPTIVE);
    let away_from_rim = std::f64::consts::PI * 195f64.powi(2);
    assert!(in_windows as f64 > away_from_rim, "{in_windows} pixels in windows, {away_from_rim} away from the rim");
}

#[test]
fn nothing_is_seen_outside_a_field_that_is_narrower_than_a_texel() {
    check_windows(&cube(64), &fisheye(100, 0.01), Kernel::ADAPTIVE);
}

#[test]
fn what_the_lower_cut_hides_is_passed_over_and_no_more() {
    let (world, turned) = (cube(64), targets()[0].orientation);
    let projections = [ProjectionKind::OMNIMAX, ProjectionKind::EQUIDISTANT];
    for (projection, size) in projections.into_iter().flat_map(|lens| [40, 201, 600].map(|size| (lens.clone(), size))) {
        let (mut hidden, mut passed) = (0, 0);
        for lower in [-30.0, 0.0, 20.0, 45.0, 70.0] {
            let stop = FieldStop::circle(1.0).with_lower(Angle::from_degrees(lower));
            let target = View { stop, ..view(projection.clone(), (size, size), (1.0, 1.0), turned) };
            let resampler = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT };
            let table = KernelTable::new(&resampler.filter.kernel);
            let mut scan = Scan::new((&resampler, Sampling::default()), &table, Level::new());
            let rows = (0..size).step_by(SIDE);
            for first @ [left, top] in rows.flat_map(|j| (0..size).step_by(SIDE).map(move |i| [i, j])) {
                let rect = PixelRect { left, top, right: left + SIDE, bottom: top + SIDE };
                let mut pixels = (top..top + SIDE).flat_map(|j| (left..left + SIDE).map(move |i| (i, j)));
                let shows = pixels.any(|(i, j)| target.screen_pixel(i, j).is_some());
                let is_cut_off = scan.is_cut_off(first);
                assert!(!(shows && is_cut_off), "{projection:?}, {size}, {lower}: {first:?}");
                let is_below = !shows && !target.outline_hides(rect);
                hidden += usize::from(is_below);
                passed += usize::from(is_below && is_cut_off);
            }
        }
        assert!(size < 600 || 10 * passed > 9 * hidden, "{projection:?}: {passed} of {hidden} patches");
    }
}

/// Receiver that makes pixels of lists of taps, one by one.
struct Averages<'a> {
    texels: &'a [Rgba],
    image: Image<Rgba>,
}

impl Sink for Averages<'_> {
    fn pixel(&mut self, [column, row]: [usize; 2], coverage: f32, taps: &Taps) {
        let at = row * self.image.width() + column;
        self.image.pixels_mut()[at] = average(taps.list(), |texel| self.texels[texel as usize], true) * coverage;
    }

    fn windows(&mut self, _: [usize; 2], _: u8, _: &Windows) {
        unreachable!("no windows were asked for");
    }
}

/// Returns grey waves some texels long, and steps between them.
fn grey(world: &World) -> Vec<Rgba> {
    let light = |source: &Source| {
        let width = source.view.width();
        let texel = move |at: usize| {
            let (x, y) = (at % width, at / width);
            let light =
                0.2 + 0.08 * (x as f32 / 3.0).sin() * (y as f32 / 4.0).cos() + 0.1 * ((x / 37 + y / 23) % 2) as f32;
            Rgba::opaque(light, 0.7 * light, 2.0 * light)
        };
        (0..width * source.view.height()).map(texel)
    };
    world.sources().iter().flat_map(light).collect()
}

/// Tests light in single precision, by interpolated geometry, for files of 16 bits and of half floats.
#[test]
fn deep_pictures_are_what_each_pixel_makes_by_itself_in_double_precision() {
    for world in [cube(256), cube(700), sky(1200)] {
        let texels = grey(&world);
        for target in &targets() {
            let resampler = Resampler { world: &world, target, filter: FilterSettings::DEFAULT };
            let table = KernelTable::new(&resampler.filter.kernel);
            let image = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
            let mut exact = Averages { texels: &texels, image };
            let mut scan = Scan { weigher: None, ..Scan::new((&resampler, Sampling::default()), &table, Level::new()) };
            scan.pixels(&whole(target), &mut exact);
            let made = resampler.render(&texels);
            let whole = made.pixels().iter().zip(exact.image.pixels()).filter(|(_, exact)| exact.alpha() == 1.0);
            let pairs = || whole.clone().flat_map(|(made, exact)| (0..3).map(|c| (made.0[c], exact.0[c])));
            let rms = |of: &dyn Fn(f32) -> f64| {
                let sum: f64 = pairs().map(|(made, exact)| (of(made) - of(exact)).powi(2)).sum();
                (sum / pairs().count() as f64).sqrt()
            };
            let code = |light: f32| 65535.0 * Transfer::Srgb.encode(f64::from(light), ColourChannel::Green);
            let codes = rms(&code);
            assert!(codes < 2.0, "{:?}: {codes} codes of 16 bits", target.projection);
            // Mid-grey lies between an eighth and a quarter, where halves are 2⁻¹³ apart.
            let halves = rms(&|light| f64::from(light) / 2f64.powi(-13));
            assert!(halves < 0.5, "{:?}: {halves} steps of half floats", target.projection);
        }
    }
}

#[test]
fn round_footprints_keep_their_size() {
    // In single precision the minor axis of some circles comes out longer than the major one.
    let world = sky(1024);
    for width in [430, 616] {
        check_windows(&world, &panorama(width, width / 2), Kernel::ADAPTIVE);
    }
}
