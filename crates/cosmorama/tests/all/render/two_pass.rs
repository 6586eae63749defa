//! Pictures by two passes, against the kernel that both compose and against directions.

use cosmorama::camera::View;
use cosmorama::filter::{Classic, Filter, FilterKind, FilterSettings, Kernel};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Resampler, picture};
use cosmorama::sphere::CubeFace;
use cosmorama::world::{Light, World};
use testkit::{
    cube, equirect, fisheye, light_by_direction, light_by_texel, omnimax, perspective, position_error, turned,
};

/// Angle of a view that is all but flat, in degrees.
const NARROW: f64 = 0.02;

/// Texels along a side of it.
const SIDE: usize = 128;

fn two_passes(world: &World, target: &View, light: &[Rgba]) -> Image<Rgba> {
    let kind = FilterKind::Classic(Classic::TwoPass);
    let filter = FilterSettings { kind, kernel: Kernel::ADAPTIVE, anti_ringing: false };
    Resampler { world, target, filter }.render(light)
}

fn composed(world: &World, target: &View, light: &[Rgba]) -> Image<Rgba> {
    let light = Light::new(world, light.to_vec()).expect("light of the world");
    let prepared = Classic::TwoPass.prepare(world, &light).expect("nothing loses precision");
    picture(&*prepared, target)
}

fn noise() -> (World, Vec<Rgba>) {
    let world = World::new([("narrow".to_owned(), perspective(SIDE, SIDE, NARROW, 0.0, 0.0, 0.0))]).expect("one view");
    let light = light_by_texel(&world, |_, i, j, _| {
        let value = ((i * 7919 + j * 104_729 + i * j * 31) % 997) as f32 / 996.0;
        Rgba::opaque(value, value, value)
    });
    (world, light)
}

/// Weights of the texels of a line, `shrink` of which are a pixel: the paper's Gaussian.
fn weights(pixel: usize, shrink: f64) -> Vec<f64> {
    let middle = (pixel as f64 + 0.5) * shrink;
    let square = |texel: usize| ((texel as f64 + 0.5 - middle) / shrink).powi(2);
    let weights: Vec<f64> =
        (0..SIDE).map(|texel| if square(texel) < 1.0 { (-2.0 * square(texel)).exp() } else { 0.0 }).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

#[test]
fn a_scaled_view_is_filtered_by_rows_and_by_columns() {
    let (world, light) = noise();
    for pixels in [16, 40] {
        let made = two_passes(&world, &perspective(pixels, pixels, NARROW, 0.0, 0.0, 0.0), &light);
        let lines: Vec<Vec<f64>> = (0..pixels).map(|pixel| weights(pixel, SIDE as f64 / pixels as f64)).collect();
        for (at, pixel) in made.pixels().iter().enumerate() {
            let (across, down) = (&lines[at % pixels], &lines[at / pixels]);
            let row = |j: usize| (0..SIDE).map(|i| across[i] * f64::from(light[j * SIDE + i].0[0])).sum::<f64>();
            let expected: f64 = (0..SIDE).map(|j| down[j] * row(j)).sum();
            assert!((f64::from(pixel.0[0]) - expected).abs() < 1e-4, "{pixels}, {at}: {} for {expected}", pixel.0[0]);
        }
    }
}

/// Turned by any angle, a flat view is what the composed kernel says: means of a column are those of each pixel.
#[test]
fn a_turned_view_is_the_composed_kernel() {
    const PIXELS: usize = 24;
    let (world, light) = noise();
    for roll in [0.0, 25.0, 44.0, 46.0, 100.0, 181.0, -70.0] {
        let target = perspective(PIXELS, PIXELS, 0.6 * NARROW, 0.0, 0.0, roll);
        let [made, expected] = [two_passes(&world, &target, &light), composed(&world, &target, &light)];
        for (at, (made, expected)) in made.pixels().iter().zip(expected.pixels()).enumerate() {
            assert!((made.0[0] - expected.0[0]).abs() < 1e-4, "{roll}°, {at}: {made:?} for {expected:?}");
        }
    }
}

/// Domes, an Omnimax frame and panoramas; the worlds they are of have edges, corners, poles and a seam.
fn conversions() -> Vec<(&'static str, World, View)> {
    let faces = || cube(&CubeFace::ALL, 64, 64);
    let panorama = || World::new([("all".to_owned(), equirect(256))]).expect("one view");
    vec![
        ("cube to dome", faces(), fisheye(96, 180.0).turned(turned([33.0, 20.0, 7.0]))),
        ("cube to frame", faces(), omnimax(120, 90)),
        ("cube to panorama", faces(), equirect(128)),
        ("panorama to dome", panorama(), fisheye(96, 200.0).turned(turned([170.0, 80.0, 12.0]))),
        ("panorama to face", panorama(), perspective(64, 64, 90.0, 180.0, 60.0, 30.0)),
        ("panorama to itself", panorama(), equirect(128).turned(turned([40.0, 50.0, 60.0]))),
    ]
}

#[test]
fn nothing_folds_over_and_no_edge_shows() {
    for (name, world, target) in conversions() {
        let light = light_by_direction(&world, |direction| direction.vector().as_vec3().to_array());
        let made = two_passes(&world, &target, &light);
        let (mut worst, mut pixels) = (0f64, 0);
        for j in 0..target.height() {
            for i in 0..target.width() {
                let Some(screen) = target.screen_pixel(i, j).filter(|screen| screen.coverage == 1.0) else { continue };
                worst = worst.max(position_error(&screen.footprint, made.pixels()[j * target.width() + i]));
                pixels += 1;
            }
        }
        // The most in a panorama, whose pixels beside the pole are far longer than wide.
        assert!(pixels > 3000 && worst < 0.6, "{name}: {worst} pixels off");
    }
}

#[test]
fn a_constant_world_stays_so_and_a_sun_keeps_its_shape() {
    for (name, world, target) in conversions() {
        let constant = vec![Rgba::opaque(0.25, 0.5, 2.0); world.texel_count()];
        for (at, pixel) in two_passes(&world, &target, &constant).pixels().iter().enumerate() {
            let expected = Rgba::opaque(0.25, 0.5, 2.0) * pixel.alpha();
            let error = (0..4).map(|k| (pixel.0[k] - expected.0[k]).abs()).fold(0.0, f32::max);
            assert!(error < 1e-6, "{name}, {at}: {pixel:?}");
        }
        let light = light_by_direction(&world, |direction| [if direction.vector().y > 0.97 { 250.0 } else { 0.25 }; 3]);
        let [made, composed] = [two_passes(&world, &target, &light), composed(&world, &target, &light)];
        let sum = |image: &Image<Rgba>| image.pixels().iter().map(|pixel| f64::from(pixel.0[0])).sum::<f64>();
        let ratio = sum(&made) / sum(&composed);
        assert!((ratio - 1.0).abs() < 1e-2, "{name}: {ratio} of the light");
    }
}
