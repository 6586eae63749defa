//! Averages of a world's light under lobes.

use std::f64::consts::PI;

use cosmorama::lighting::{AllTexels, LightTree, Lobe, LobeAverages, PreparedLight};
use cosmorama::prelude::*;
use cosmorama::world::WorldView;
use rayon::ThreadPoolBuilder;

fn lobes() -> Vec<Lobe> {
    let alphas = [0.05, 0.1, 0.25, 0.5, 1.0];
    let ggx = alphas.map(|alpha| Lobe::ggx(alpha).unwrap());
    let charlie = [0.1, 0.5, 1.0].map(|alpha| Lobe::charlie(alpha).unwrap());
    let phong = [1.0, 16.0, 200.0].map(|exponent| Lobe::phong(exponent).unwrap());
    let blinn = [8.0, 64.0].map(|exponent| Lobe::blinn(exponent).unwrap());
    [Lobe::LAMBERT].into_iter().chain(ggx).chain(charlie).chain(phong).chain(blinn).collect()
}

fn panorama(width: usize, light: impl Fn(usize, usize) -> [f32; 3]) -> (World, Light) {
    let picture = Image::from_fn(width, width / 2, |i, j| {
        let [red, green, blue] = light(i, j);
        Rgba::opaque(red, green, blue)
    });
    World::from_panorama(picture).unwrap()
}

/// A sky with clouds of all sizes, and a sun of two texels.
fn sky(width: usize) -> (World, Light) {
    panorama(width, |i, j| {
        let (x, y) = (i as f32 / width as f32, j as f32 / width as f32);
        let noise = ((i * 7919 + j * 104_729) % 1009) as f32 / 1009.0;
        let clouds = 0.5 + 0.4 * (25.0 * x + 9.0 * (7.0 * y).sin()).sin() * (31.0 * y).cos();
        let is_sun = j == width / 8 && (i == width / 3 || i == width / 3 + 1);
        let sun = if is_sun { 40_000.0 } else { 0.0 };
        [clouds + noise + sun, 0.5 * clouds + sun, 1.5 * y + 0.2 * noise + 0.8 * sun]
    })
}

fn target(width: usize) -> View {
    CameraModel::from(EquirectCamera::default()).view(width, width / 2).unwrap()
}

/// Largest and root mean square of relative differences.
fn difference(found: &[Rgba], expected: &[Rgba]) -> (f64, f64) {
    let pairs =
        found.iter().zip(expected).flat_map(|(a, b)| (0..3).map(|c| f64::from(a.0[c]) / f64::from(b.0[c]) - 1.0));
    let (mut worst, mut squares, mut count) = (0.0f64, 0.0, 0.0);
    for part in pairs {
        worst = worst.max(part.abs());
        squares += part * part;
        count += 1.0;
    }
    (worst, f64::sqrt(squares / count))
}

#[test]
fn a_white_furnace_is_white_under_every_lobe() {
    let (world, light) = panorama(64, |_, _| [1.0, 0.5, 2.0]);
    let (tree, all) = (LightTree::new(&world, &light).unwrap(), AllTexels::new(&world, &light).unwrap());
    let prepared = PreparedLight::new(&world, &light, &lobes()).unwrap();
    let axes: Vec<Direction> = Direction::spread(40).collect();
    for lobe in lobes() {
        for averages in [&tree as &dyn LobeAverages, &all, &prepared].map(|light| light.averages(&axes, &lobe)) {
            for Rgba([red, green, blue, alpha]) in averages {
                let near = |found: f32, expected: f32| (found / expected - 1.0).abs() < 1e-6;
                assert!(near(red, 1.0) && near(green, 0.5) && near(blue, 2.0) && near(alpha, 1.0), "{lobe:?}: {red}");
            }
        }
    }
}

#[test]
fn fast_averages_are_near_the_sum_of_all_texels() {
    let (world, light) = sky(256);
    let (tree, all) = (LightTree::new(&world, &light).unwrap(), AllTexels::new(&world, &light).unwrap());
    let prepared = PreparedLight::new(&world, &light, &lobes()).unwrap();
    for lobe in lobes() {
        let [by_tree, prepared, expected] =
            [&tree as &dyn LobeAverages, &prepared, &all].map(|light| light.picture(&target(64), &lobe, Rgba::BLACK));
        for found in [by_tree, prepared] {
            let (worst, rms) = difference(found.pixels(), expected.pixels());
            assert!(worst < 5e-3 && rms < 1e-3, "{lobe:?}: {worst:.1e}, {rms:.1e}");
            assert!(lobe != Lobe::LAMBERT || (worst < 1e-3 && rms < 1e-4), "{worst:.1e}, {rms:.1e}");
        }
    }
}

/// Light from a cube, tilted views and all, is that of its panorama.
#[test]
fn a_cube_sheds_the_light_of_its_panorama() {
    let face = |face: CubeFace| {
        let orientation = Orientation::from_yaw_pitch_roll(
            Angle::from_degrees(20.0),
            Angle::from_degrees(-35.0),
            Angle::from_degrees(50.0),
        );
        let orientation = face.orientation().within(orientation);
        let camera = Placement { orientation, ..Placement::new(CameraModel::from(CubeFaceCamera)) };
        (face.name().to_owned(), camera.view(200, 200).unwrap())
    };
    let world = World::new(CubeFace::ALL.map(face)).unwrap();
    let lamp = Direction::from_longitude_latitude(Angle::from_degrees(70.0), Angle::from_degrees(40.0));
    let light = Light::by_direction(&world, |direction| {
        let glow = (30.0 * (direction.dot(lamp) - 1.0)).exp() as f32;
        Rgba::opaque(0.1 + 400.0 * glow * glow * glow, 0.2 + glow, 0.3 + direction.vector().y as f32 * 0.3)
    });
    let all = AllTexels::new(&world, &light).unwrap();
    let lobes = [Lobe::LAMBERT, Lobe::ggx(0.08).unwrap(), Lobe::ggx(0.4).unwrap()];
    let prepared = PreparedLight::new(&world, &light, &lobes).unwrap();
    for lobe in lobes {
        let [found, expected] =
            [&prepared as &dyn LobeAverages, &all].map(|light| light.picture(&target(32), &lobe, Rgba::BLACK));
        let (worst, rms) = difference(found.pixels(), expected.pixels());
        assert!(worst < 3e-3 && rms < 3e-4, "{lobe:?}: {worst:.1e}, {rms:.1e}");
    }
}

/// The texel's light under a lobe is the lobe itself.
#[test]
fn one_texel_gives_the_lobe() {
    const SUN: f32 = 250_000.0;
    let width = 128;
    let at = [40, 22];
    let (world, light) = panorama(width, |i, j| if [i, j] == at { [SUN; 3] } else { [0.18; 3] });
    let lobes = [0.05, 0.1, 0.25, 0.5, 1.0].map(|alpha| Lobe::ggx(alpha).unwrap());
    let prepared = PreparedLight::new(&world, &light, &lobes).unwrap();
    let tree = LightTree::new(&world, &light).unwrap();
    let sun = target(width).direction(PixelPoint::centre(at[0], at[1])).unwrap();
    let angle = f64::from(world.sources()[0].solid_angles[at[1] * width + at[0]]);
    let energy = |image: &[Rgba], world: &World| -> f64 {
        image.iter().zip(world.solid_angles()).map(|(pixel, angle)| f64::from(pixel.0[0]) * f64::from(angle)).sum()
    };
    let before = energy(light.texels(), &world);
    let each = lobes.into_iter().zip([0.05, 0.1, 0.25, 0.5, 1.0]);
    // Blocks are summed in single precision: a step of the last digits of what is all but grey is no maximum.
    let by_tree = each.clone().skip(1).map(|case| (&tree as &dyn LobeAverages, case, 1e-5));
    for (averages, (lobe, alpha), rounding) in
        each.map(|case| (&prepared as &dyn LobeAverages, case, 0.0)).chain(by_tree)
    {
        let image = averages.picture(&target(width), &lobe, Rgba::BLACK);
        let after = energy(image.pixels(), &world) / before;
        assert!((after - 1.0).abs() < 1e-3, "{alpha}: energy {after}");
        let peak = f64::from(averages.average(sun, &lobe).0[0]);
        let expected = f64::from(SUN - 0.18) * angle * lobe.weight(1.0) / lobe.integral() + 0.18;
        assert!((peak / expected - 1.0).abs() < 0.01, "{alpha}: peak {peak}, not {expected}");
        assert_eq!(maxima(&image, rounding), 1, "{alpha}");
        assert!(image.pixels().iter().all(|pixel| pixel.0.iter().all(|channel| channel.is_finite())));
        // The sun is as high to the left as to the right.
        let (left, right) = (image.get(at[0] - 9, at[1]).0[0], image.get(at[0] + 9, at[1]).0[0]);
        assert!((left / right - 1.0).abs() < 5e-3, "{alpha}: {left}, {right}");
    }
}

/// Number of pixels that are brighter than all around them, by more than a part of that.
fn maxima(image: &Image<Rgba>, rounding: f32) -> usize {
    let (width, height) = (image.width(), image.height());
    let light = |i: usize, j: usize| image.get(i % width, j).0[0];
    let is_top = |i: usize, j: usize| {
        let mut around = (0..9).filter(|k| *k != 4).map(|k| (i + width + k % 3 - 1, (j + k / 3).saturating_sub(1)));
        around.all(|(column, row)| row >= height || light(i, j) > light(column, row) * (1.0 + rounding))
    };
    (1..height - 1).flat_map(|j| (0..width).map(move |i| (i, j))).filter(|(i, j)| is_top(*i, *j)).count()
}

#[test]
fn what_is_not_shown_is_transparent_or_filled() {
    let dome = CameraModel::from(FulldomeCamera::default());
    let (world, light) = World::from_lens(dome, Image::filled(128, 128, Rgba::opaque(1.0, 1.0, 1.0))).unwrap();
    let prepared = PreparedLight::new(&world, &light, &[Lobe::LAMBERT, Lobe::ggx(0.1).unwrap()]).unwrap();
    let (tree, all) = (LightTree::new(&world, &light).unwrap(), AllTexels::new(&world, &light).unwrap());
    for lit in [&tree as &dyn LobeAverages, &all, &prepared] {
        assert!(!lit.is_complete() && (lit.shown() / (2.0 * PI) - 1.0).abs() < 2e-3, "{}", lit.shown());
        let up = lit.average(Direction::UP, &Lobe::LAMBERT);
        assert!((up.0[0] - 1.0).abs() < 1e-3 && (up.alpha() - 1.0).abs() < 1e-3, "{up:?}");
        let level = lit.average(Direction::FRONT, &Lobe::LAMBERT);
        assert!((level.0[0] - 0.5).abs() < 1e-3 && (level.alpha() - 0.5).abs() < 1e-3, "{level:?}");
        assert!(lit.average(Direction::DOWN, &Lobe::ggx(0.1).unwrap()).alpha() < 1e-5);
        let filled = lit.picture(&target(16), &Lobe::LAMBERT, Rgba::opaque(1.0, 1.0, 1.0));
        assert!(filled.pixels().iter().all(|pixel| (pixel.0[0] - 1.0).abs() < 1e-3), "as if all were shown");
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let (world, light) = sky(128);
    let lobe = Lobe::ggx(0.2).unwrap();
    let made = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let tree = LightTree::new(&world, &light).unwrap().picture(&target(40), &lobe, Rgba::BLACK);
            let prepared = PreparedLight::new(&world, &light, &[lobe]).unwrap();
            let all = AllTexels::new(&world, &light).unwrap();
            (tree, [&prepared as &dyn LobeAverages, &all].map(|light| light.picture(&target(40), &lobe, Rgba::BLACK)))
        })
    };
    assert!(made(1) == made(3));
}

/// The largest step across edges and corners of faces is no more than inside faces, at every level of a chain.
#[test]
fn faces_meet() {
    let (world, light) = sky(128);
    let levels = [(0.0625, 32), (0.25, 16), (0.5625, 8), (1.0, 4)];
    let lobes = levels.map(|(alpha, _)| Lobe::ggx(alpha).unwrap());
    let light = PreparedLight::new(&world, &light, &lobes).unwrap();
    for (lobe, (alpha, edge)) in lobes.into_iter().zip(levels) {
        let face = |face: CubeFace| {
            let orientation = face.orientation();
            let camera = Placement { orientation, ..Placement::new(CameraModel::from(CubeFaceCamera)) };
            let view = camera.view(edge, edge).unwrap();
            let image = light.picture(&view, &lobe, Rgba::BLACK);
            (view, image)
        };
        let faces = CubeFace::ALL.map(face);
        let green = |image: &Image<Rgba>, i: usize, j: usize| f64::from(image.get(i, j).0[1]);
        let (mut inside, mut across) = (0.0f64, 0.0f64);
        for (view, image) in &faces {
            for k in 0..edge * edge {
                let (i, j) = (k % edge, k / edge);
                let here = green(image, i, j);
                inside = inside.max((here - green(image, (i + 1).min(edge - 1), j)).abs());
                inside = inside.max((here - green(image, i, (j + 1).min(edge - 1))).abs());
                for (x, y) in [(0, 1), (1, 0), (0, -1), (-1, 0)].map(|(x, y)| (i as i64 + x, j as i64 + y)) {
                    let is_inside = [x, y].iter().all(|at| (0..edge as i64).contains(at));
                    let beyond = PixelPoint::new(x as f64 + 0.5, y as f64 + 0.5);
                    let Some(direction) = view.direction(beyond).filter(|_| !is_inside) else { continue };
                    let other = faces.iter().find_map(|(view, image)| {
                        let pixel = view.pixel(direction).filter(|pixel| view.grid.contains(*pixel))?;
                        Some(green(image, pixel.x as usize, pixel.y as usize))
                    });
                    across = across.max((here - other.expect("a face beyond the edge")).abs());
                }
            }
        }
        assert!(across > 0.0 && across <= inside, "{alpha}: {across} across edges, {inside} inside");
    }
}

/// A world of views that overlap sheds no light twice.
#[test]
fn overlapping_views_count_once() {
    let (world, _) = panorama(64, |_, _| [1.0; 3]);
    let view = |name: &str| WorldView {
        name: name.to_owned(),
        view: world.sources()[0].view.clone(),
        blend: Default::default(),
        mask: None,
    };
    let twice = World::blended([view("a"), view("b")]).unwrap();
    let light = Light::by_direction(&twice, |_| Rgba::opaque(1.0, 1.0, 1.0));
    let shown = LightTree::new(&twice, &light).unwrap().shown();
    assert!((shown / (4.0 * PI) - 1.0).abs() < 1e-3, "{shown}");
}
