//! The one door: a world averaged over a footprint, by every filter.

use cosmorama::camera::{CameraModel, Covariance, Footprint, MirrorBallCamera, View};
use cosmorama::filter::{Classic, Filter, FilterKind, FilterSettings, PrepareError, Prepared};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Resampler, picture};
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::{Light, LightError, World};
use glam::DVec3;
use testkit::{cube, equirect, fisheye, light_by_texel, perspective, turned};

const KINDS: [FilterKind; 5] = [
    FilterKind::Ewa,
    FilterKind::EwaPyramid,
    FilterKind::Point,
    FilterKind::Bilinear,
    FilterKind::Reference { samples: 4 },
];

fn kinds() -> impl Iterator<Item = FilterKind> {
    KINDS.into_iter().chain(Classic::ALL.iter().copied().map(FilterKind::Classic))
}

fn filter(kind: FilterKind) -> FilterSettings {
    FilterSettings { kind, ..FilterSettings::DEFAULT }
}

fn one(view: View) -> World {
    World::new([("all".to_owned(), view)]).expect("one view")
}

/// Whole worlds and partial ones.
fn worlds() -> Vec<(&'static str, World)> {
    let lens = View { orientation: turned([10.0, -20.0, 30.0]), ..fisheye(300, 200.0) };
    let ball = CameraModel::MirrorBall(MirrorBallCamera::default()).view(300, 300).expect("a ball");
    vec![
        ("cube", cube(&CubeFace::ALL, 160, 160)),
        ("panorama", one(equirect(500))),
        ("fisheye", one(lens)),
        ("three faces", cube(&[CubeFace::Front, CubeFace::Right, CubeFace::Up], 160, 120)),
        ("ball", one(ball)),
    ]
}

/// Targets whose field of view ends nowhere inside their image, of one texel a pixel and of several.
fn targets() -> [View; 4] {
    let map = |width| View { orientation: turned([25.0, 40.0, 15.0]), ..equirect(width) };
    [perspective(90, 70, 80.0, 40.0, 30.0, 10.0), perspective(20, 16, 100.0, 20.0, 10.0, 5.0), map(300), map(60)]
}

/// Waves that are longer than a pixel of any target.
fn waves(direction: Direction) -> Rgba {
    let v = direction.vector();
    let of = |v: DVec3| (0.5 + 0.25 * (5.0 * v.x + 2.0 * v.y).sin() + 0.25 * (4.0 * v.z - 3.0 * v.y).cos()) as f32;
    Rgba::opaque(of(v), of(DVec3::new(v.y, v.z, v.x)), of(DVec3::new(v.z, v.x, v.y)))
}

fn noise(world: &World) -> Light {
    let texels = light_by_texel(world, |view, i, j, _| {
        let hash = (view * 1_000_003 + i * 7919 + j * 104_729).wrapping_mul(2_654_435_761) >> 7;
        let value = (hash % 1000) as f32 / 999.0;
        Rgba::opaque(value, value * value, 1.0 - value)
    });
    Light::new(world, texels).expect("a texel for each")
}

/// The greatest difference of any channel, and its root of the mean square, among the pixels that look where some view does: of
/// others a kernel reaches a last texel, or just not.
fn difference(world: &World, target: &View, a: &Image<Rgba>, b: &Image<Rgba>) -> [f64; 2] {
    let sees = |pixel: usize| {
        let screen = target.screen_pixel(pixel % target.width(), pixel / target.width());
        screen.is_some_and(|screen| world.owner(screen.footprint.direction).is_some())
    };
    let pairs = a.pixels().iter().zip(b.pixels()).enumerate().filter(|(at, _)| sees(*at)).map(|(_, pair)| pair);
    let each = pairs.flat_map(|(a, b)| (0..4).map(|c| f64::from((a.0[c] - b.0[c]).abs())));
    let (most, sum) = each.fold((0f64, 0f64), |(most, sum), d| (most.max(d), sum + d * d));
    [most, (sum / (4 * a.pixels().len()) as f64).sqrt()]
}

/// [`Resampler`] and `average` alone: the greatest difference, and the mean one.
fn check(light: impl Fn(&World) -> Light, kinds: &[FilterKind], bound: [f64; 2]) {
    for (name, world) in worlds() {
        let light = light(&world);
        for &kind in kinds {
            let prepared = filter(kind).prepare(&world, &light).expect("light of the world");
            for target in &targets() {
                let fast = Resampler { world: &world, target, filter: filter(kind) }.render(light.texels());
                let found = difference(&world, target, &fast, &picture(&*prepared, target));
                assert!(found[0] < bound[0] && found[1] < bound[1], "{name}, {kind:?}, {}: {found:?}", target.width());
            }
        }
    }
}

#[test]
fn a_picture_by_averages_alone_is_the_fast_one() {
    check(noise, &[FilterKind::Ewa, FilterKind::Point, FilterKind::Bilinear], [2e-3, 2e-4]);
}

/// Of a picture, levels are interpolated between points, and the reference knows where each sub-sample looks.
#[test]
fn where_a_picture_tells_more_than_footprints_it_differs_little() {
    let waves = |world: &World| Light::by_direction(world, waves);
    check(waves, &[FilterKind::EwaPyramid, FilterKind::Reference { samples: 4 }], [0.05, 2e-3]);
}

/// Directions all over, with footprints of all widths and shapes.
fn footprints() -> impl Iterator<Item = Footprint> {
    Direction::spread(400).enumerate().map(|(k, direction)| {
        let (right, up) = direction.vector().any_orthonormal_pair();
        let (sin, cos) = (k as f64).sin_cos();
        let width = 1e-4 * 1.03f64.powi(k as i32);
        Footprint::new(
            direction,
            (right * cos + up * sin) * width,
            (up * cos - right * sin) * width * [1.0, 0.1, 3.0][k % 3],
        )
    })
}

fn odd_footprints() -> Vec<Footprint> {
    let tangent = |v: DVec3, direction: Direction| Footprint::new(direction, v, DVec3::ZERO);
    Direction::spread(30)
        .flat_map(|at| {
            let (right, up) = at.vector().any_orthonormal_pair();
            [
                Footprint::point(at),
                tangent(right * 0.01, at),
                Footprint::new(at, right * 0.01 + up * 0.02, right * -0.02 - up * 0.04),
                tangent(up * 1e-12, at),
                Footprint::new(at, right * 100.0, up * 1e9),
                Footprint::new(at, right * 1e-9, up * 3.0),
                tangent(up * 1e9, at),
                // Sides that do not touch the sphere.
                Footprint::new(at, at.vector() * 2.0, up * 0.01),
                Footprint::new(at, at.vector() * 1e-7, at.vector() * -1e-3),
                Footprint::from_covariance(at, Covariance::round(at, 1e6)),
            ]
        })
        .collect()
}

#[test]
fn a_constant_world_stays_constant() {
    let colour = Rgba::opaque(0.3, 0.7, 12.0);
    for (name, world) in [("cube", cube(&CubeFace::ALL, 64, 64)), ("panorama", one(equirect(128)))] {
        let light = Light::by_direction(&world, |_| colour);
        for kind in kinds() {
            let prepared = filter(kind).prepare(&world, &light).expect("light of the world");
            let is_slow = matches!(kind, FilterKind::Reference { .. } | FilterKind::Classic(_));
            let least = if is_slow { 10 } else { 1 };
            for footprint in footprints().chain(odd_footprints()).step_by(least) {
                let pixel = prepared.average(&footprint);
                let error = (0..4).map(|c| (pixel.0[c] / colour.0[c] - 1.0).abs()).fold(0.0, f32::max);
                assert!(error < 1e-5, "{name}, {kind:?}: {pixel:?} of {footprint:?}");
                assert_eq!(prepared.covered(&footprint), 1.0, "{name}: {footprint:?}");
                assert_eq!(prepared.missing(&footprint), None);
            }
        }
    }
}

#[test]
fn what_is_no_footprint_sees_nothing() {
    let world = one(equirect(64));
    let light = Light::by_direction(&world, |_| Rgba::opaque(1.0, 1.0, 1.0));
    for kind in kinds() {
        let prepared = filter(kind).prepare(&world, &light).expect("light of the world");
        for wrong in [f64::NAN, f64::INFINITY] {
            for (dx, dy) in [(DVec3::X * wrong, DVec3::Y), (DVec3::X * 0.01, DVec3::splat(wrong))] {
                let footprint = Footprint::new(Direction::FRONT, dx, dy);
                assert_eq!(prepared.average(&footprint), Rgba::TRANSPARENT, "{kind:?}");
                assert_eq!(prepared.covered(&footprint), 0.0);
            }
        }
    }
}

/// A footprint as wide as may be has nearly the mean of the half of the world that it looks to.
#[test]
fn the_widest_footprint_is_half_the_world() {
    let world = cube(&CubeFace::ALL, 64, 64);
    let light = Light::by_direction(&world, waves);
    for kind in [FilterKind::Ewa, FilterKind::EwaPyramid] {
        let prepared = filter(kind).prepare(&world, &light).expect("light of the world");
        for direction in Direction::spread(20) {
            let found = prepared.average(&Footprint::from_covariance(direction, Covariance::round(direction, 1e3)));
            let (mut sum, mut weights) = ([0f64; 3], 0f64);
            for there in Direction::spread(20_000).filter(|there| there.dot(direction) > 0.0) {
                (0..3).for_each(|c| sum[c] += f64::from(waves(there).0[c]));
                weights += 1.0;
            }
            for (channel, sum) in found.0.iter().zip(sum) {
                let error = (f64::from(*channel) - sum / weights).abs();
                assert!(error < 0.03, "{kind:?}, {direction:?}: {error}");
            }
        }
    }
}

/// Where the sphere is all but flat, a Gaussian lobe blurs a wave as a Gaussian does: by exp(−σ²k²/2).
#[test]
fn a_lobe_blurs_as_its_covariance_says() {
    let world = cube(&CubeFace::ALL, 512, 512);
    let wave = 40.0;
    let light = Light::by_direction(&world, |d| {
        let value = (0.5 + 0.5 * (wave * d.vector().x).cos()) as f32;
        Rgba::opaque(value, value, value)
    });
    let gaussian = cosmorama::filter::CrossSection::Gaussian { alpha: 2.0, cutoff: 2.0 };
    let kernel = cosmorama::filter::Kernel::uniform(gaussian);
    let filter = FilterSettings { kernel, anti_ringing: false, ..FilterSettings::DEFAULT };
    for kind in [FilterKind::Ewa, FilterKind::EwaPyramid, FilterKind::Reference { samples: 16 }] {
        let prepared = FilterSettings { kind, ..filter }.prepare(&world, &light).expect("light of the world");
        for sigma in [0.01f64, 0.02, 0.03] {
            let lobe = Covariance::along(DVec3::X * sigma) + Covariance::along(DVec3::Y * 0.005);
            let found = prepared.average(&Footprint::from_covariance(Direction::FRONT, lobe)).0[0];
            let expected = 0.5 + 0.5 * (-0.5 * (sigma * wave).powi(2)).exp();
            assert!((f64::from(found) - expected).abs() < 0.01, "{kind:?}, {sigma}: {found}, not {expected}");
        }
    }
}

#[test]
fn what_no_view_shows_is_told() {
    let world = cube(&[CubeFace::Front], 32, 32);
    let light = Light::by_direction(&world, |_| Rgba::opaque(0.5, 0.5, 0.5));
    for kind in kinds() {
        let prepared = filter(kind).prepare(&world, &light).expect("light of the world");
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Footprint::new(
                Direction::from_unit(DVec3::new(sin, 0.0, -cos)),
                DVec3::new(cos, 0.0, sin) * 0.1,
                DVec3::Y * 0.1,
            )
        };
        let parts = [0.0, 45.0, 90.0, 180.0].map(|degrees| prepared.covered(&at(degrees)));
        assert_eq!(parts, [1.0, 0.5, 0.0, 0.0]);
        assert!(prepared.missing(&at(0.0)).is_none() && prepared.missing(&at(45.0)).is_some());
        assert_eq!(prepared.average(&at(180.0)), Rgba::TRANSPARENT, "{kind:?}");
        // Of a footprint that the edge cuts, what there is.
        let pixel = prepared.average(&at(44.9));
        assert!((0..3).all(|c| (pixel.0[c] - 0.5).abs() < 1e-4), "{kind:?}: {pixel:?}");
    }
}

#[test]
fn light_of_another_world_is_refused() {
    let (world, other) = (one(equirect(64)), one(equirect(32)));
    let light = Light::by_direction(&other, |_| Rgba::BLACK);
    for kind in kinds() {
        assert_eq!(filter(kind).prepare(&world, &light).err(), Some(PrepareError::Light(LightError::WrongViews)));
        let setup = filter(kind).setup(&world);
        let keeps = |classic| {
            use Classic::{MipMap, NearestMipMap, RepeatedIntegration, SummedArea};
            matches!(classic, MipMap | NearestMipMap | SummedArea | RepeatedIntegration(_))
        };
        let expected = match kind {
            FilterKind::EwaPyramid => true,
            FilterKind::Classic(classic) => keeps(classic),
            _ => false,
        };
        assert_eq!(setup.bytes > 0, expected, "{kind:?}");
    }
}

#[test]
fn threads_ask_side_by_side() {
    let world = cube(&CubeFace::ALL, 64, 64);
    let light = noise(&world);
    let prepared: Box<dyn Prepared> =
        filter(FilterKind::EwaPyramid).prepare(&world, &light).expect("light of the world");
    let all = || footprints().map(|footprint| prepared.average(&footprint)).collect::<Vec<_>>();
    let expected = all();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(all)).collect();
        threads.into_iter().for_each(|thread| assert!(thread.join().expect("no panic") == expected));
    });
}
