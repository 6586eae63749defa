//! Spherical harmonics of a world's light.

use std::f64::consts::PI;

use cosmorama::lighting::{
    AllTexels, HarmonicBasis, HarmonicFunctions, HarmonicWindow, Harmonics, HarmonicsError, Lobe, LobeAverages,
};
use cosmorama::prelude::*;
use rayon::ThreadPoolBuilder;

const BASES: [HarmonicBasis; 2] = [HarmonicBasis::ZUp, HarmonicBasis::YUp];

fn near(found: f64, expected: f64, most: f64, what: &str) {
    assert!((found - expected).abs() <= most, "{what}: {found}, expected {expected}");
}

fn panorama(width: usize, light: impl Fn(Direction) -> [f32; 3]) -> (World, Light) {
    let view = CameraModel::from(EquirectCamera::default()).view(width, width / 2).unwrap();
    let picture = Image::from_fn(width, width / 2, |i, j| {
        let [red, green, blue] = light(view.direction(PixelPoint::centre(i, j)).unwrap());
        Rgba::opaque(red, green, blue)
    });
    World::from_panorama(picture).unwrap()
}

/// Soft light from three sides, one for each colour.
fn soft(direction: Direction) -> [f32; 3] {
    [Direction::UP, Direction::RIGHT, Direction::FRONT].map(|axis| (1.5 * direction.dot(axis)).exp() as f32)
}

/// A sky with details, and a sun in one spot.
fn sunny(direction: Direction) -> [f32; 3] {
    let [x, y, z] = direction.vector().to_array();
    let sun = if direction.angle_to(Direction::spread(40).nth(9).unwrap()).degrees() < 4.0 { 5000.0 } else { 0.0 };
    [0.5 + 0.4 * (20.0 * x).sin() + sun, 1.0 + 0.5 * (9.0 * y + z).cos() + sun, 0.2 + z * z + sun]
        .map(|light| light as f32)
}

#[test]
fn a_constant_world_has_one_coefficient() {
    let (world, light) = panorama(256, |_| [1.0, 0.5, 2.0]);
    for basis in BASES {
        let radiance = Harmonics::new(&world, &light, 3, basis).unwrap();
        let irradiance = radiance.irradiance();
        assert_eq!((radiance.order(), radiance.basis(), radiance.coefficients().len()), (3, basis, 16));
        for (channel, expected) in [1.0, 0.5, 2.0].into_iter().enumerate() {
            near(radiance.coefficients()[0][channel], 2.0 * PI.sqrt() * expected, 1e-9, "L00");
            let rest = radiance.coefficients()[1..].iter().map(|light| light[channel].abs()).fold(0.0, f64::max);
            // Texels are a little coarse for the higher bands.
            near(rest, 0.0, 2e-3, "others");
            near(irradiance.at(Direction::UP)[channel], PI * expected, 1e-3, "E");
        }
    }
}

#[test]
fn coefficients_are_the_sums_over_all_texels() {
    let (world, light) = panorama(128, sunny);
    let view = CameraModel::from(EquirectCamera::default()).view(128, 64).unwrap();
    for basis in BASES {
        let found = Harmonics::new(&world, &light, 10, basis).unwrap();
        let functions = HarmonicFunctions::new(10, basis);
        let (mut sums, mut sphere) = (vec![[0.0; 3]; functions.count()], 0.0);
        for (texel, light) in light.texels().iter().enumerate() {
            let (i, j) = (texel % 128, texel / 128);
            // The exact area of a texel of a panorama.
            let edge = |j: usize| (PI * j as f64 / 64.0).cos();
            let angle = 2.0 * PI / 128.0 * (edge(j) - edge(j + 1));
            sphere += angle;
            let values = functions.at(view.direction(PixelPoint::centre(i, j)).unwrap());
            for (sum, value) in sums.iter_mut().zip(values) {
                (0..3).for_each(|channel| sum[channel] += value * angle * f64::from(light.0[channel]));
            }
        }
        near(sphere, 4.0 * PI, 1e-12, "sphere");
        let most = sums.iter().flatten().fold(0.0f64, |most, sum| most.max(sum.abs()));
        for (found, expected) in found.coefficients().iter().flatten().zip(sums.iter().flatten()) {
            near(*found, *expected, 1e-6 * most, "coefficient");
        }
    }
}

#[test]
fn irradiance_is_the_exact_diffuse_light_of_a_smooth_world() {
    let (world, light) = panorama(512, soft);
    let all = AllTexels::new(&world, &light).unwrap();
    for (order, basis) in [(8, HarmonicBasis::ZUp), (10, HarmonicBasis::YUp)] {
        let irradiance = Harmonics::new(&world, &light, order, basis).unwrap().irradiance();
        let axes: Vec<Direction> = Direction::spread(60).collect();
        for (axis, exact) in axes.iter().zip(all.averages(&axes, &Lobe::LAMBERT)) {
            for (channel, found) in irradiance.at(*axis).into_iter().enumerate() {
                near(found / (PI * f64::from(exact.0[channel])), 1.0, 1e-4, "E");
            }
        }
    }
}

#[test]
fn a_turn_about_the_pole_mixes_pairs_only() {
    const COLUMNS: usize = 11;
    let (world, light) = panorama(128, sunny);
    let moved = Image::from_fn(128, 64, |i, j| light.texels()[j * 128 + (i + 128 - COLUMNS) % 128]);
    let (turned, turned_light) = World::from_panorama(moved).unwrap();
    let before = Harmonics::new(&world, &light, 6, HarmonicBasis::YUp).unwrap();
    let after = Harmonics::new(&turned, &turned_light, 6, HarmonicBasis::YUp).unwrap();
    let angle = 2.0 * PI * COLUMNS as f64 / 128.0;
    let at = |harmonics: &Harmonics, place: usize| harmonics.coefficients()[place][0];
    let most = before.coefficients().iter().fold(0.0f64, |most, light| most.max(light[0].abs()));
    for l in 0..=6 {
        let middle = l * l + l;
        near(at(&after, middle), at(&before, middle), 1e-6 * most, "m = 0");
        for m in 1..=l {
            let (sin, cos) = (m as f64 * angle).sin_cos();
            let (even, odd) = (at(&before, middle + m), at(&before, middle - m));
            near(at(&after, middle + m), cos * even + sin * odd, 1e-6 * most, "m > 0");
            near(at(&after, middle - m), cos * odd - sin * even, 1e-6 * most, "m < 0");
        }
    }
}

#[test]
fn bases_agree_on_the_light() {
    let (world, light) = panorama(512, soft);
    let [own, up] = BASES.map(|basis| Harmonics::new(&world, &light, 10, basis).unwrap());
    for direction in Direction::spread(50) {
        for channel in 0..3 {
            let expected = f64::from(soft(direction)[channel]);
            near(own.at(direction)[channel], expected, 2e-3, "radiance");
            near(up.at(direction)[channel], own.at(direction)[channel], 1e-9, "basis");
        }
    }
    // Light from the right is +x, from above +y of the world and +z of its pole, from the front −z and +y.
    let first = |harmonics: &Harmonics, channel: usize| [1, 2, 3].map(|k| harmonics.coefficients()[k][channel]);
    for (channel, [y, z, x], [pole_y, pole_z, pole_x]) in
        (0..3).map(|channel| (channel, first(&own, channel), first(&up, channel)))
    {
        let (own, up) = ([x, y, z], [pole_x, pole_y, pole_z]);
        let expected = [([0, 1, 0], [0, 0, 1]), ([1, 0, 0], [1, 0, 0]), ([0, 0, -1], [0, 1, 0])][channel];
        let sign = |light: f64| if light.abs() < 1e-6 { 0 } else { light.signum() as i32 };
        assert_eq!((own.map(sign), up.map(sign)), expected, "{channel}");
    }
}

#[test]
fn what_is_not_shown_has_its_own_light() {
    let (world, _) = panorama(128, |_| [1.0; 3]);
    let half: Vec<Rgba> =
        (0..128 * 64).map(|k| if k < 128 * 32 { Rgba::opaque(1.0, 1.0, 1.0) } else { Rgba::TRANSPARENT }).collect();
    let white = Rgba::opaque(1.0, 1.0, 1.0);
    let of = |unseen| Harmonics::of_texels(&world, (&half, unseen), 4, HarmonicBasis::YUp).unwrap();
    let (dark, filled) = (of(Rgba::TRANSPARENT), of(white));
    near(dark.coefficients()[0][0], PI.sqrt(), 1e-4, "half the sphere");
    // ∫ Y10 over the upper half.
    near(dark.coefficients()[2][0], 0.488603 * PI, 1e-3, "from above");
    near(filled.coefficients()[0][0], 2.0 * PI.sqrt(), 1e-9, "all the sphere");
    filled.coefficients()[1..].iter().for_each(|light| near(light[0], 0.0, 1e-9, "constant"));
}

#[test]
fn threads_do_not_matter() {
    let (world, light) = panorama(128, sunny);
    let with = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Harmonics::new(&world, &light, 10, HarmonicBasis::ZUp).unwrap())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn windows_weaken_bands_and_high_orders_are_refused() {
    let (world, light) = panorama(64, sunny);
    let plain = Harmonics::new(&world, &light, 4, HarmonicBasis::ZUp).unwrap();
    let windowed = plain.windowed(HarmonicWindow::Hanning { width: 4.0 });
    for (k, factor) in [(0, 1.0), (2, 0.5 + 0.125f64.sqrt()), (6, 0.5), (20, 0.0)] {
        near(windowed.coefficients()[k][1], factor * plain.coefficients()[k][1], 1e-9, "Hanning");
    }
    let refused = Harmonics::new(&world, &light, 11, HarmonicBasis::ZUp).unwrap_err();
    assert!(refused == HarmonicsError::Order(11) && refused.to_string().contains("outside 0 to 10"), "{refused}");
}
