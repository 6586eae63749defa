//! Filters of the literature, against one another and across the edges of views; `definitions.rs` holds each against its own.

use cosmorama::camera::{Footprint, PixelPoint};
use cosmorama::filter::{Classic, CrossSection, Filter, FilterKind, FilterSettings, Kernel};
use cosmorama::raster::Rgba;
use cosmorama::render::Resampler;
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::{Light, World};
use glam::{DMat2, DVec2, DVec3};
use testkit::{cube, equirect, light_by_texel, perspective};

use super::narrow::{Pixel, grey, narrow, noise_at};

/// Pixels of one texel to fifteen.
fn pixels() -> impl Iterator<Item = Pixel> {
    Pixel::all().flat_map(|pixel| [0.6, 1.0, 1.8].map(|scale| Pixel { sides: pixel.sides * scale, ..pixel }))
}

/// All three weigh by one table over the squared distance on the screen.
#[test]
fn feibush_levoy_cook_and_both_printed_ewas_agree() {
    let world = narrow();
    let light = grey(&world, noise_at);
    let [flc, paper, integer] = [Classic::FeibushLevoyCook, Classic::EwaPaper, Classic::EwaInteger]
        .map(|classic| classic.prepare(&world, &light).expect("light of the world"));
    for pixel in pixels() {
        let footprint = pixel.footprint(&world.sources()[0].view);
        let [flc, paper, integer] = [&flc, &paper, &integer].map(|filter| f64::from(filter.average(&footprint).0[0]));
        assert!((flc - paper).abs() < 1e-5, "{pixel:?}: {flc} and {paper}");
        assert!((integer - paper).abs() < 1.0 / 255.0, "{pixel:?}: {integer} and {paper}");
    }
}

/// Where the mapping is affine and a pixel holds many texels, all filters with one kernel are the reference with that.
#[test]
fn filters_with_one_kernel_converge_to_the_reference() {
    const WAVE: f64 = 160.0;
    let world = narrow();
    let light =
        grey(&world, |i, j| 0.5 + 0.5 * (std::f64::consts::TAU * (0.8 * i as f64 + 0.6 * j as f64) / WAVE).sin());
    // Wide, so that the lattice of texels does not show at its edge, and from a long table.
    let gaussian = Kernel { entries: 1 << 16, ..Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 2.5 }) };
    let kinds = [Classic::EwaPaper, Classic::EwaInteger, Classic::FeibushLevoyCook, Classic::Gangnet, Classic::Catmull];
    for kind in kinds.map(FilterKind::Classic).into_iter().chain([FilterKind::Ewa]) {
        let filter = FilterSettings { kind, kernel: gaussian, anti_ringing: false };
        let [found, judge] = [filter, filter.judge(8)].map(|filter| filter.prepare(&world, &light).expect("its light"));
        for k in 0..6 {
            let angle = 0.9 * f64::from(k);
            let sides = DMat2::from_cols(DVec2::from_angle(angle) * 12.0, DVec2::from_angle(angle + 1.3) * 9.0);
            let middle = DVec2::new(60.3 + 1.7 * f64::from(k), 66.9 - 1.3 * f64::from(k));
            let footprint = Pixel { middle, sides }.footprint(&world.sources()[0].view);
            let [found, judge] = [&found, &judge].map(|filter| f64::from(filter.average(&footprint).0[0]));
            assert!((found - judge).abs() < 1e-4, "{kind:?}, {k}: {found} for {judge}");
        }
    }
}

/// A kernel's weights, by the place on the screen.
type Shape = fn(DVec2) -> f64;

/// Shrunk four and eight times across edges and corners of a cube, filters are the sums of all texels by solid angle and by
/// where each lies on the screen. Each face has its own brightness, and noise.
#[test]
fn across_edges_filters_are_sums_by_solid_angle() {
    let world = cube(&CubeFace::ALL, 64, 64);
    let texels = light_by_texel(&world, |view, i, j, _| {
        let value = (0.25 * noise_at(i + 64 * view, j) + 0.75 * [0.0, 1.0, 0.3, 0.8, 0.5, 0.1][view]) as f32;
        Rgba::opaque(value, value, value)
    });
    let light = Light::new(&world, texels).expect("a texel for each");
    let round: Shape = |at| if at.length_squared() < 1.0 { (-2.0 * at.length_squared()).exp() } else { 0.0 };
    let square: Shape = |at| f64::from(u8::from(at.abs().max_element() < 0.5));
    let pyramid: Shape = |at| (1.0 - at.x.abs()).max(0.0) * (1.0 - at.y.abs()).max(0.0);
    let mut are_near = true;
    // Derivatives are those of the middle: over a pixel of a tenth or a fifth of a radian, a face's mapping bends.
    for (classic, shape, bounds) in [
        (Classic::FeibushLevoyCook, round, [0.002, 0.002]),
        (Classic::EwaPaper, round, [0.02, 0.03]),
        (Classic::EwaInteger, round, [0.02, 0.03]),
        (Classic::Gangnet, round, [0.002, 0.002]),
        (Classic::Catmull, square, [0.01, 0.04]),
        (Classic::BlinnNewell, pyramid, [0.02, 0.03]),
    ] {
        let prepared = classic.prepare(&world, &light).expect("light of the world");
        for (shrink, bound) in [4.0, 8.0].into_iter().zip(bounds) {
            let error = |footprint: Footprint| {
                let (mut sum, mut weights) = (0.0, 0.0);
                for (texel, there, solid_angle) in parts_of_texels(&world, footprint.direction) {
                    let weight = shape(on_screen(&footprint, there)) * solid_angle;
                    sum += weight * f64::from(light.texels()[texel].0[0]);
                    weights += weight;
                }
                (f64::from(prepared.average(&footprint).0[0]) - sum / weights).abs()
            };
            let greatest = across_edges(shrink / 32.0).map(error).fold(0.0, f64::max);
            println!("{classic:?}, shrunk {shrink} times: {greatest:.4}");
            are_near &= greatest < bound;
        }
    }
    assert!(are_near, "some filter is farther from its sum than it may be");
}

/// Offset on the plane that touches the sphere in a footprint's middle, in pixels.
fn on_screen(footprint: &Footprint, there: DVec3) -> DVec2 {
    let middle = footprint.direction.vector();
    footprint.jacobian.pseudo_inverse(there / there.dot(middle) - middle).expect("an area")
}

/// Footprints of a width in radians on edges, at corners and beside them.
fn across_edges(width: f64) -> impl Iterator<Item = Footprint> {
    let places = [[1.0, 0.1, 1.0], [1.0, -0.4, 0.93], [-0.95, 1.0, 0.2], [1.0, 1.0, 1.0], [-1.0, 0.9, -0.97]];
    places.into_iter().enumerate().map(move |(k, place)| {
        let direction = Direction::new(DVec3::from_array(place)).expect("no zero");
        let (right, up) = direction.vector().any_orthonormal_pair();
        let (sin, cos) = (0.7 * k as f64).sin_cos();
        Footprint::new(direction, (right * cos + up * sin) * width, (up * cos - right * sin) * (0.8 * width))
    })
}

/// Parts of all texels near a direction: the texel, a direction in it, and its solid angle there.
fn parts_of_texels(world: &World, near: Direction) -> Vec<(usize, DVec3, f64)> {
    const PARTS: usize = 4;
    let mut parts = Vec::new();
    for source in world.sources() {
        let (width, height) = (source.view.width(), source.view.height());
        for texel in 0..width * height {
            let part = |k: usize, at: usize| at as f64 + (k as f64 + 0.5) / PARTS as f64;
            let (i, j) = (texel % width, texel / width);
            for k in 0..PARTS * PARTS {
                let at = PixelPoint::new(part(k % PARTS, i), part(k / PARTS, j));
                let direction = source.view.direction(at).expect("a pinhole shows all");
                if direction.dot(near) > 0.8 {
                    let solid_angle = f64::from(source.solid_angles[texel]) / (PARTS * PARTS) as f64;
                    parts.push((source.offset + texel, direction.vector(), solid_angle));
                }
            }
        }
    }
    parts
}

/// At a pole a footprint reaches all around, as far to one side of its middle as to the other.
#[test]
fn footprints_at_a_pole_are_centred() {
    let world = World::new([("all".to_owned(), equirect(64))]).expect("one view");
    for k in 0..12 {
        let (sin, cos) = (0.55 * f64::from(k)).sin_cos();
        let direction = Direction::new(DVec3::new(0.02 * sin, 1.0, 0.02 * cos)).expect("no zero");
        // As much brighter at one side of the meridian as it is darker at the other.
        let light = Light::by_direction(&world, |there| {
            let v = there.vector();
            let value = (0.5 + 0.5 * (v.x * cos - v.z * sin) / v.x.hypot(v.z)) as f32;
            Rgba::opaque(value, value, value)
        });
        let (right, up) = direction.vector().any_orthonormal_pair();
        let footprint = Footprint::new(direction, right * 0.15, up * 0.15);
        for classic in [Classic::FeibushLevoyCook, Classic::EwaPaper, Classic::EwaInteger, Classic::BlinnNewell] {
            let found = classic.prepare(&world, &light).expect("light of the world").average(&footprint).0[0];
            assert!((found - 0.5).abs() < 0.04, "{classic:?}, {k}: {found}");
        }
    }
}

/// Footprints as thin, as long and as far away as may be: integers keep up with floats.
#[test]
fn integers_hold_the_most_extreme_footprints() {
    let world = World::new([("all".to_owned(), equirect(256))]).expect("one view");
    let light = Light::by_direction(&world, |direction| {
        let value = (0.5 + 0.25 * direction.vector().x + 0.25 * direction.vector().y) as f32;
        Rgba::opaque(value, value, value)
    });
    let [paper, integer] = [Classic::EwaPaper, Classic::EwaInteger]
        .map(|classic| classic.prepare(&world, &light).expect("light of the world"));
    for (k, direction) in Direction::spread(60).chain([Direction::UP, Direction::DOWN]).enumerate() {
        let (right, up) = direction.vector().any_orthonormal_pair();
        for (long, short) in [(3.0, 3.0), (3.0, 1e-3), (1e-6, 1e-6), (1e-2, 3.0), (0.3, 1e-5)] {
            let footprint = Footprint::new(direction, right * long, up * short);
            let [paper, integer] = [&paper, &integer].map(|filter| f64::from(filter.average(&footprint).0[0]));
            assert!((paper - integer).abs() < 2.0 / 255.0, "{k}, {long}, {short}: {integer} for {paper}");
        }
    }
}

/// A smooth world shows no step where views meet, by whatever filter.
#[test]
fn edges_of_views_do_not_show() {
    let world = cube(&CubeFace::ALL, 64, 64);
    let light = Light::by_direction(&world, |direction| {
        let [x, y, z] = direction.vector().to_array().map(|at| (0.5 + 0.5 * at) as f32);
        Rgba::opaque(x, y, z)
    });
    let target = perspective(96, 64, 100.0, 45.0, 30.0, 20.0);
    for &classic in Classic::ALL {
        let prepared = classic.prepare(&world, &light).expect("light of the world");
        // A texel is 0.02 wide; squares of the coarser of two levels, or of the nearest, are four times as wide.
        let bound = if matches!(classic, Classic::MipMap | Classic::NearestMipMap) { 0.05 } else { 0.012 };
        for (j, i) in (0..64).flat_map(|j| (0..96).map(move |i| (j, i))) {
            let footprint = target.footprint(PixelPoint::centre(i, j)).expect("a pinhole shows all");
            let found = prepared.average(&footprint);
            let expected = footprint.direction.vector().to_array().map(|at| 0.5 + 0.5 * at);
            let error = (0..3).map(|c| (f64::from(found.0[c]) - expected[c]).abs()).fold(0.0, f64::max);
            assert!(error < bound, "{classic:?} at ({i}, {j}): {error}");
        }
    }
}

/// Makes the faces of a cube from black light by the tables of white light: a picture that made tables anew would be black.
#[test]
fn whole_pictures_are_made_of_tables_that_were_made_before() {
    let world = narrow();
    let [black, white] = [0.0, 1.0].map(|value| grey(&world, |_, _| value));
    for classic in Classic::ALL {
        let filter = FilterSettings { kind: FilterKind::Classic(*classic), ..FilterSettings::DEFAULT };
        let tables = filter.tables(&world, white.texels());
        assert_eq!(tables.is_some(), filter.has_tables(), "{classic:?}");
        let view = perspective(4, 4, 0.005, 0.0, 0.0, 0.0);
        let resampler = Resampler::new(&world, &view).by(filter);
        let made = resampler.render_by(tables.as_ref(), white.texels(), Rgba::BLACK);
        assert_eq!(made.pixels(), resampler.render_over(white.texels(), Rgba::BLACK).pixels(), "{classic:?}");
        if matches!(classic, Classic::SummedArea | Classic::RepeatedIntegration(_)) {
            let made = resampler.render_by(tables.as_ref(), black.texels(), Rgba::BLACK);
            assert!(made.pixels().iter().all(|pixel| (pixel.0[0] - 1.0).abs() < 1e-3), "{classic:?}");
        }
    }
}
