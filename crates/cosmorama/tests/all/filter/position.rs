//! Worlds with closed-form answers: constant, and coloured by direction.

use cosmorama::camera::{CameraModel, EquirectCamera, SamplePositions, ScreenPixel, View};
use cosmorama::filter::{CrossSection, FilterKind, FilterSettings, Kernel};
use cosmorama::raster::Rgba;
use cosmorama::render::Resampler;
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use testkit::{
    cube, equirect, fisheye, light_by_direction, omnimax, partial_worlds, perspective, position_error, power,
    whole_worlds,
};

/// Pixels by which a point of the world may be displaced; the promise is 0.01.
const POSITION_TOLERANCE: f64 = 0.005;

/// Of all pixels that count, those that a lens's rim cuts too.
fn worst_position_error(
    world: &World,
    target: &View,
    filter: FilterSettings,
    counts: impl Fn(&ScreenPixel) -> bool,
) -> f64 {
    let light = light_by_direction(world, |d| d.vector().to_array().map(|c| c as f32));
    let image = Resampler { world, target, filter }.render(&light);
    let mut worst = 0f64;
    for j in 0..image.height() {
        for i in 0..image.width() {
            let Some(screen) = target.screen_pixel(i, j) else { continue };
            if counts(&screen) {
                worst = worst.max(position_error(&screen.footprint, *image.get(i, j)));
            }
        }
    }
    worst
}

#[test]
fn directions_come_back_from_cube_faces() {
    let world = cube(&CubeFace::ALL, 512, 512);
    let targets = [
        ("omnimax", omnimax(983, 718)),
        ("fisheye", fisheye(512, 220.0)),
        ("panorama", equirect(1024)),
        ("reduced", fisheye(128, 180.0)),
        ("an edge, enlarged", perspective(320, 240, 20.0, 45.0, 10.0, 0.0)),
        ("a corner, enlarged", perspective(320, 240, 20.0, 45.0, 35.0, 7.0)),
        ("a corner, seven times enlarged", perspective(320, 240, 8.0, -135.0, -35.26, 30.0)),
    ];
    for (name, target) in targets {
        let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |_| true);
        assert!(error < POSITION_TOLERANCE, "{name}: {error} px");
    }
}

/// A row of texels on the very pole.
#[test]
fn directions_come_back_at_poles_with_samples_on_the_edges() {
    let frame = CameraModel::Equirect(EquirectCamera { samples: SamplePositions::Edges, ..EquirectCamera::default() });
    let panorama = |width| frame.view(width, width / 2).expect("a size");
    for (from, to) in [(1024, 1024), (512, 512), (1024, 500), (1024, 100), (300, 1024)] {
        let world = World::new([("panorama".to_owned(), panorama(from))]).expect("one view");
        let (target, light) = (panorama(to), light_by_direction(&world, |d| d.vector().to_array().map(|c| c as f32)));
        let image = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
        for (j, i) in (0..image.height()).flat_map(|j| (0..image.width()).map(move |i| (j, i))) {
            let screen = target.screen_pixel(i, j).expect("a panorama looks everywhere");
            let Rgba([x, y, z, _]) = *image.get(i, j);
            let here = screen.footprint.direction.vector();
            // What is averaged over a wide pixel gets shorter; that is no displacement.
            let off = glam::DVec3::new(x.into(), y.into(), z.into()).reject_from_normalized(here);
            // Rows are apart by this everywhere; at the pole a pixel has no width to measure by.
            let error = off.length() / screen.footprint.jacobian.dy.length();
            assert!(error < 2.0 * POSITION_TOLERANCE, "{from} to {to}: {error} px at {i}, {j}");
        }
    }
}

/// Where a lens's field touches an edge of the cube, the face beyond is not needed, and not there.
#[test]
fn directions_come_back_where_a_field_touches_faces_that_are_not_there() {
    let four = [CubeFace::Front, CubeFace::Left, CubeFace::Right, CubeFace::Up];
    for (name, faces, edge, target) in [
        ("omnimax", &four[..], 256, omnimax(983, 718)),
        ("omnimax, enlarged", &four[..], 256, omnimax(1966, 1436)),
        ("a fisheye inside one face", &four[..1], 256, fisheye(601, 90.0)),
    ] {
        let error = worst_position_error(&cube(faces, edge, edge), &target, FilterSettings::DEFAULT, |_| true);
        println!("{name}: {error:.4} px");
        assert!(error < 2.0 * POSITION_TOLERANCE, "{name}: {error} px");
    }
}

/// A large texel's negative lobe must not outweigh the small ones beside it, and half a large texel from the edge there must
/// be some on its other side.
#[test]
fn directions_come_back_where_faces_of_different_sizes_meet() {
    let targets = [
        ("omnimax", omnimax(983, 718)),
        ("omnimax, enlarged", omnimax(1966, 1436)),
        ("an edge", perspective(320, 240, 60.0, 45.0, 10.0, 0.0)),
        ("a corner", perspective(320, 240, 60.0, 45.0, 35.0, 7.0)),
        ("an edge, enlarged eight times", perspective(320, 240, 7.0, 45.0, 10.0, 0.0)),
        ("a corner, enlarged eight times", perspective(320, 240, 7.0, 45.0, 35.26, 7.0)),
    ];
    for (front, others) in [(512, 256), (128, 512), (2048, 128), (128, 1024)] {
        let world = World::new(CubeFace::ALL.map(|face| {
            let size = if face == CubeFace::Front { front } else { others };
            (face.name().to_owned(), testkit::cube_face(face, size, size))
        }));
        let world = world.expect("six faces");
        for (name, target) in &targets {
            let error = worst_position_error(&world, target, FilterSettings::DEFAULT, |_| true);
            println!("{name}, {front} beside {others}: {error}");
            assert!(error < POSITION_TOLERANCE, "{name}, {front} beside {others}: {error} px");
        }
    }
}

/// Texels that are long one way meet texels that are long the other way; those under a pixel may all lie to one side of it.
#[test]
fn directions_come_back_from_faces_whose_texels_are_not_square() {
    for (width, height) in [(1024, 256), (256, 1024), (512, 256)] {
        let world = cube(&CubeFace::ALL, width, height);
        for (name, target) in [
            ("omnimax", omnimax(983, 718)),
            ("omnimax, enlarged", omnimax(1966, 1436)),
            ("an edge, enlarged", perspective(320, 240, 20.0, 45.0, 10.0, 0.0)),
            ("an upper edge, enlarged", perspective(320, 240, 20.0, 5.0, 45.0, 0.0)),
            ("a corner, enlarged", perspective(320, 240, 8.0, -135.0, -35.26, 30.0)),
        ] {
            let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |_| true);
            assert!(error < POSITION_TOLERANCE, "{name} from {width}x{height}: {error} px");
        }
    }
}

/// On the sphere rows and columns of texels are curves, whose texels are not where a linear mapping has them.
#[test]
fn directions_come_back_from_small_worlds() {
    let panorama = World::new([("panorama".to_owned(), equirect(200))]).expect("one view");
    let faces = cube(&CubeFace::ALL, 64, 64);
    let ball = World::new([("fisheye".to_owned(), fisheye(256, 360.0))]).expect("one view");
    for (name, world, target) in [
        ("omnimax from a panorama", &panorama, omnimax(600, 438)),
        ("fisheye from a panorama", &panorama, fisheye(600, 220.0)),
        ("omnimax from faces", &faces, omnimax(600, 438)),
        ("a camera in a fisheye", &ball, perspective(320, 240, 60.0, 20.0, 10.0, 0.0)),
    ] {
        let error = worst_position_error(world, &target, FilterSettings::DEFAULT, |_| true);
        assert!(error < POSITION_TOLERANCE, "{name}: {error} px");
    }
}

/// At a pole the texels of the last row lie all around, and within the pixel.
#[test]
fn directions_come_back_from_panorama_to_panorama() {
    for (from, to) in [(1024, 430), (1024, 614), (1000, 1000), (1024, 700), (512, 1024), (700, 300), (600, 1366)] {
        let world = World::new([("panorama".to_owned(), equirect(from))]).expect("one view");
        let error = worst_position_error(&world, &equirect(to), FilterSettings::DEFAULT, |_| true);
        assert!(error < POSITION_TOLERANCE, "{from} to {to}: {error} px");
    }
}

#[test]
fn directions_come_back_from_a_panorama() {
    let world = World::new([("panorama".to_owned(), equirect(1024))]).expect("one view");
    let targets = [
        ("front", perspective(320, 240, 60.0, 0.0, 0.0, 0.0)),
        ("the seam", perspective(320, 240, 60.0, 180.0, 20.0, 0.0)),
        ("the upper pole", perspective(320, 240, 90.0, 0.0, 90.0, 0.0)),
        ("the lower pole", perspective(321, 241, 90.0, 30.0, -80.0, 0.0)),
        ("the lower pole, enlarged", perspective(321, 241, 5.0, 30.0, -89.0, 0.0)),
        ("reduced", fisheye(128, 360.0)),
    ];
    for (name, target) in targets {
        let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |_| true);
        assert!(error < POSITION_TOLERANCE, "{name}: {error} px");
    }
}

/// At the rim the last texels that count may lie half a texel before the pixel.
#[test]
fn directions_come_back_at_the_rim_of_a_lens() {
    let panorama = World::new([("panorama".to_owned(), equirect(2048))]).expect("one view");
    let faces = cube(&CubeFace::ALL, 512, 512);
    for (name, target) in [
        ("fisheye of 180°", fisheye(1024, 180.0)),
        ("fisheye of 180°, enlarged", fisheye(2048, 180.0)),
        ("fisheye of 220°", fisheye(1024, 220.0)),
        ("fisheye of 220°, reduced", fisheye(600, 220.0)),
        ("omnimax", omnimax(983, 718)),
        ("omnimax, enlarged", omnimax(1966, 1436)),
    ] {
        for (world, from) in [(&panorama, "a panorama"), (&faces, "faces")] {
            let error = worst_position_error(world, &target, FilterSettings::DEFAULT, |_| true);
            assert!(error < POSITION_TOLERANCE, "{name} from {from}: {error} px");
        }
    }
}

#[test]
fn directions_come_back_from_a_fisheye() {
    let world = World::new([("fisheye".to_owned(), fisheye(1024, 360.0))]).expect("one view");
    for (name, target) in [
        ("front", perspective(320, 240, 60.0, 0.0, 0.0, 0.0)),
        ("side", perspective(320, 240, 60.0, 90.0, 30.0, 0.0)),
        ("behind, beside the rim", perspective(320, 240, 60.0, 140.0, 0.0, 0.0)),
    ] {
        let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |_| true);
        assert!(error < POSITION_TOLERANCE, "{name}: {error} px");
    }
}

/// What is promised of any projection, in pixels.
const POSITION_PROMISE: f64 = 0.01;

/// Nearer to a rim than so many pixels a pixel is bent within itself: its mean direction is not that of its centre. So is
/// one that a steep rim cuts.
const BENT: f64 = 16.0;

#[test]
fn directions_come_back_in_every_projection() {
    let world = cube(&CubeFace::ALL, 384, 384);
    for (name, target) in whole_worlds(384).into_iter().chain(partial_worlds(384)) {
        let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |screen| {
            let jacobian = &screen.footprint.jacobian;
            let margin = target.margin(screen.footprint.direction);
            screen.coverage == 1.0 && margin > BENT * jacobian.dx.length().max(jacobian.dy.length())
        });
        assert!(error < POSITION_PROMISE, "{name}: {error} px in {:?}", target.projection);
    }
}

#[test]
fn directions_come_back_from_every_projection() {
    for (name, source) in whole_worlds(512) {
        let world = World::new([(name.to_owned(), source)]).expect("one view");
        // Away from the rim: a ball's is ahead.
        let yaw = if name == "mirror ball" { 210.0 } else { 30.0 };
        let target = perspective(160, 120, 60.0, yaw, 20.0, 0.0);
        let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |_| true);
        assert!(error < POSITION_PROMISE, "from {name}: {error} px");
    }
}

/// Where both ends of an oval map meet, their lattices mirror each other, and each is sheared.
#[test]
fn directions_come_back_where_the_ends_of_an_oval_map_meet() {
    for (name, source) in whole_worlds(512) {
        if !["hammer", "mollweide", "sinusoidal"].contains(&name) {
            continue;
        }
        let world = World::new([(name.to_owned(), source)]).expect("one view");
        for pitch in [0.0, 30.0, 57.0, -65.0] {
            let target = perspective(16, 16, 1.6, 180.3, pitch, 7.0);
            let error = worst_position_error(&world, &target, FilterSettings::DEFAULT, |_| true);
            println!("from {name}, {pitch}° up: {error}");
            assert!(error < POSITION_PROMISE, "from {name}, {pitch}° up: {error} px");
        }
    }
}

/// A quarter of a turn from the seam, what is seen here lies edge on beyond it.
#[test]
fn directions_come_back_far_from_the_seam_of_an_oval_map() {
    for (name, source) in whole_worlds(768).into_iter().filter(|(name, _)| *name == "mollweide") {
        let world = World::new([(name.to_owned(), source)]).expect("one view");
        let error = worst_position_error(&world, &equirect(256), FilterSettings::DEFAULT, |_| true);
        println!("from {name}: {error}");
        assert!(error < POSITION_PROMISE, "from {name}: {error} px");
    }
}

#[test]
fn light_is_kept_from_projection_to_projection() {
    let cube = cube(&CubeFace::ALL, 256, 256);
    let light = light_by_direction(&cube, |d| {
        let v = d.vector();
        [1.0 + 0.5 * v.x as f32, 1.0 + (9.0 * v.y).sin() as f32, 1.0 + (7.0 * v.z + 5.0 * v.x).cos() as f32]
    });
    let before = power(&cube, &light);
    for (name, target) in whole_worlds(400) {
        let image = Resampler { world: &cube, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
        let world = World::new([(name.to_owned(), target)]).expect("one view");
        // A pixel that an edge cuts is dark by the part that it lacks; its light is that of the rest.
        let whole: Vec<Rgba> =
            image.pixels().iter().map(|p| if p.alpha() > 0.0 { *p * p.alpha().recip() } else { *p }).collect();
        let after = power(&world, &whole);
        for c in 0..3 {
            assert!((after[c] / before[c] - 1.0).abs() < 0.002, "{name}: {after:?}, not {before:?}");
        }
    }
}

#[test]
fn a_constant_world_stays_constant() {
    let colour = Rgba::opaque(0.3, 1.7, 0.0004);
    let cross_sections = [
        Kernel::ADAPTIVE,
        Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }),
        Kernel::uniform(CrossSection::JincJinc { lobes: 3, blur: 1.0 }),
        Kernel::uniform(CrossSection::Box),
    ];
    let world = cube(&CubeFace::ALL, 96, 80);
    let light = vec![colour; world.texel_count()];
    for kernel in cross_sections {
        for kind in [FilterKind::Ewa, FilterKind::Bilinear, FilterKind::Point, FilterKind::Reference { samples: 3 }] {
            // A pixel of the reference takes as long as hundreds of others; rims, poles and a corner are in few of them, too.
            let side = if matches!(kind, FilterKind::Reference { .. }) { 32 } else { 64 };
            for anti_ringing in [false, true] {
                let filter = FilterSettings { kind, kernel, anti_ringing };
                let corner = perspective(side, side * 3 / 4, 10.0, 45.0, 35.0, 0.0);
                for target in [fisheye(side, 360.0), equirect(24), corner] {
                    let image = Resampler { world: &world, target: &target, filter }.render(&light);
                    for (index, pixel) in image.pixels().iter().enumerate() {
                        let (i, j) = (index % image.width(), index / image.width());
                        let Some(screen) = target.screen_pixel(i, j) else { continue };
                        for c in 0..4 {
                            let expected = colour.0[c] * screen.coverage as f32;
                            let error = (pixel.0[c] - expected).abs() / colour.0[c];
                            assert!(error < 1e-6, "{filter:?} at ({i}, {j}): {error}");
                        }
                    }
                }
            }
        }
    }
}
