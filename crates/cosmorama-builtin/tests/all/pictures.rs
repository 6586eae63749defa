//! What pictures of the built-in worlds show, against closed forms and against many samples.

use cosmorama::camera::{
    CameraModel, CubeFaceCamera, EquirectCamera, FisheyeCamera, FulldomeCamera, OmnimaxCamera, PixelPoint, Placement,
    View,
};
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama_builtin::{BuiltinWorld, Checker, Grid, Radiance, picture};

fn dome(size: usize) -> View {
    CameraModel::Fulldome(FulldomeCamera::default()).view(size, size).unwrap()
}

fn panorama(height: usize) -> View {
    CameraModel::Equirect(EquirectCamera::default()).view(2 * height, height).unwrap()
}

fn face(face: CubeFace, size: usize) -> View {
    let placement =
        Placement { orientation: face.orientation(), ..Placement::new(CameraModel::CubeFace(CubeFaceCamera)) };
    placement.view(size, size).unwrap()
}

fn views() -> [View; 5] {
    [
        dome(200),
        panorama(100),
        face(CubeFace::Up, 90),
        face(CubeFace::Left, 90),
        CameraModel::Omnimax(OmnimaxCamera::default()).view(196, 144).unwrap(),
    ]
}

fn looking_at(azimuth: f64, elevation: f64) -> Direction {
    Direction::from_longitude_latitude(Angle::from_degrees(azimuth), Angle::from_degrees(elevation))
}

#[test]
fn directions_are_exact_at_pixel_centres() {
    for view in views() {
        let image = BuiltinWorld::Directions.picture(&view);
        for (j, i) in (0..view.height()).flat_map(|j| (0..view.width()).map(move |i| (j, i))) {
            let pixel = image.get(i, j);
            if view.screen_pixel(i, j).is_some_and(|screen| screen.coverage == 1.0) {
                let vector = view.direction(PixelPoint::centre(i, j)).unwrap().vector();
                let expected = vector.to_array().map(|component| (component / 2.0 + 0.5) as f32);
                assert_eq!(*pixel, Rgba::opaque(expected[0], expected[1], expected[2]), "{i}, {j}");
            }
        }
    }
}

#[test]
fn half_of_the_checker_is_white() {
    for height in [18, 64, 181] {
        let view = panorama(height);
        let image = BuiltinWorld::Checker.picture(&view);
        let (mut light, mut sphere) = (0.0, 0.0);
        for j in 0..view.height() {
            for i in 0..view.width() {
                let solid_angle = view.texel_solid_angle(i, j);
                light += solid_angle * f64::from(image.get(i, j).0[0]);
                sphere += solid_angle;
            }
        }
        assert!((light / sphere - 0.5).abs() < 1e-3, "{height}: {}", light / sphere);
    }
}

/// A pixel by brute force: samples in a wide square, weighted by the window.
fn weighed(world: &impl Radiance, view: &View, i: usize, j: usize) -> [f64; 3] {
    const SIDE: usize = 80;
    const REACH: f64 = 2.0;
    let (mut sum, mut weights) = ([0.0; 3], 0.0);
    for (b, a) in (0..SIDE).flat_map(|b| (0..SIDE).map(move |a| (b, a))) {
        // Turned a little, so that edges along the pixels do not fall between two columns.
        let offset =
            |k: usize, fine: usize| ((k as f64 + (fine as f64 + 0.5) / SIDE as f64) / SIDE as f64 * 2.0 - 1.0) * REACH;
        let (x, y) = (offset(a, b), offset(b, SIDE - 1 - a));
        let at = PixelPoint::new(i as f64 + 0.5 + x, j as f64 + 0.5 + y);
        let Some(direction) = view.direction(at) else { continue };
        let weight = (-2.0 * (x * x + y * y)).exp();
        weights += weight;
        for (sum, light) in sum.iter_mut().zip(world.radiance(direction)) {
            *sum += weight * f64::from(light);
        }
    }
    sum.map(|sum| sum / weights)
}

/// The greatest and the mean difference of a picture from brute force, over some of its whole pixels.
fn difference(world: &impl Radiance, view: &View) -> (f64, f64) {
    let image = picture(world, view);
    let (mut greatest, mut sum, mut count) = (0f64, 0.0, 0);
    for (j, i) in (0..view.height()).step_by(9).flat_map(|j| (0..view.width()).step_by(5).map(move |i| (j, i))) {
        if view.screen_pixel(i, j).is_some_and(|screen| screen.coverage == 1.0) {
            let expected = weighed(world, view, i, j);
            let found = image.get(i, j).0;
            let difference = (0..3).map(|c| (f64::from(found[c]) - expected[c]).abs()).fold(0.0, f64::max);
            greatest = greatest.max(difference);
            sum += difference;
            count += 1;
        }
    }
    (greatest, sum / f64::from(count))
}

#[test]
fn the_checker_is_what_samples_say() {
    for view in views() {
        let (greatest, mean) = difference(&Checker, &view);
        assert!(greatest < 0.06 && mean < 0.004, "{greatest} {mean}");
    }
}

/// Where lines are wider than pixels: there a line is at its place in degrees, as wide as in the point samples.
#[test]
fn the_grid_is_what_samples_say() {
    let view = |yaw: f64, pitch: f64| {
        let orientation =
            Orientation::from_yaw_pitch_roll(Angle::from_degrees(yaw), Angle::from_degrees(pitch), Angle::ZERO);
        let frame = FisheyeCamera { field_of_view: Angle::from_degrees(6.0), ..FisheyeCamera::default() };
        Placement { orientation, ..Placement::new(CameraModel::Fisheye(frame)) }.view(150, 150).unwrap()
    };
    let grid = Grid::new();
    for (yaw, pitch) in [(0.0, 0.0), (180.0, 3.0), (-31.0, 47.0), (0.0, 89.0), (90.0, -78.0)] {
        let (greatest, mean) = difference(&grid, &view(yaw, pitch));
        assert!(greatest < 0.3 && mean < 0.003, "{yaw} {pitch}: {greatest} {mean}");
    }
}

fn light_at(image: &Image<Rgba>, view: &View, direction: Direction) -> [f32; 3] {
    let pixel = view.pixel(direction).unwrap();
    let [red, green, blue, _] = image.get(pixel.x as usize, pixel.y as usize).0;
    [red, green, blue]
}

#[test]
fn lines_and_labels_are_where_they_belong() {
    let view = dome(1024);
    let image = BuiltinWorld::Grid.picture(&view);
    let light = |azimuth: f64, elevation: f64| light_at(&image, &view, looking_at(azimuth, elevation));
    let is_bright = |[red, green, blue]: [f32; 3]| red.max(green).max(blue) > 0.3;
    assert!(is_bright(light(10.0, 35.5)) && is_bright(light(-50.0, 12.5)), "azimuth");
    assert!(is_bright(light(13.0, 20.0)) && is_bright(light(-166.0, 70.0)), "elevation");
    let [red, green, _] = light(0.0, 33.0);
    assert!(red > 3.0 * green, "the line to the front is red");
    assert_eq!(light(17.0, 32.0), [0.0; 3], "between lines it is black");
    // Letters: within their box some pixels are bright, beside it none.
    let brightest = |from: f64, to: f64, bottom: f64| {
        let steps = (0..60).flat_map(|a| (0..20).map(move |b| (f64::from(a) / 60.0, f64::from(b) / 20.0)));
        let lights = steps.map(|(s, t)| light(from + s * (to - from), bottom + t * 1.2));
        lights.fold(0f32, |most, [red, green, blue]| most.max(red.max(green).max(blue)))
    };
    assert!(brightest(30.9, 34.0, 30.6) > 0.5, "30° is written beside its line");
    assert!(brightest(20.9, 24.0, 30.6) < 0.05, "only every third line has degrees of elevation");
}

#[test]
fn rings_end_in_grey_where_pixels_end() {
    let view = dome(512);
    let image = BuiltinWorld::ZonePlate.picture(&view);
    let light = |azimuth: f64, elevation: f64| light_at(&image, &view, looking_at(azimuth, elevation))[0];
    assert!(light(0.0, 89.9) > 0.95);
    // 2.84 pixels a degree, so 1.42 cycles at most: at 8° from the axis.
    assert!((0..300).all(|k| light(1.2 * f64::from(k), 75.0) == 0.5));
    let near: Vec<f32> = (0..60).map(|k| light(45.0, 90.0 - 0.1 * f64::from(k))).collect();
    assert!(near.iter().any(|light| *light < 0.1));
}

#[test]
fn pictures_do_not_depend_on_the_number_of_threads() {
    for world in BuiltinWorld::ALL {
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| world.picture(&dome(96)))
        };
        let alone = with(1);
        assert!(alone == with(2) && alone == with(5), "{}", world.name());
    }
}

#[test]
fn the_rim_cuts_pixels_as_it_does_in_conversions() {
    let view = dome(61);
    for world in BuiltinWorld::ALL {
        let image = world.picture(&view);
        for (j, i) in (0..61).flat_map(|j| (0..61).map(move |i| (j, i))) {
            let coverage = view.screen_pixel(i, j).map_or(0.0, |pixel| pixel.coverage as f32);
            let pixel = image.get(i, j);
            assert_eq!(pixel.alpha(), coverage);
            assert!(pixel.0.iter().all(|channel| channel.is_finite() && *channel >= 0.0));
        }
    }
}
