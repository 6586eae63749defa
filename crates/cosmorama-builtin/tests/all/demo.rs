//! What holds for every direction of the demo world, and for pictures of it.

use cosmorama::camera::{CameraModel, CubeFaceCamera, Placement};
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::{Angle, CubeFace, Direction};
use cosmorama_builtin::{DemoWorld, Radiance, picture};
use glam::DVec3;
use proptest::prelude::*;

fn is_light(radiance: [f32; 3]) -> bool {
    radiance.iter().all(|channel| channel.is_finite() && *channel >= 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]
    #[test]
    fn light_is_finite_and_never_negative(longitude in -180.0..180.0_f64, latitude in -90.0..90.0_f64) {
        let direction = Direction::from_longitude_latitude(Angle::from_degrees(longitude), Angle::from_degrees(latitude));
        prop_assert!(is_light(DemoWorld.radiance(direction)));
    }
}

/// Directions along axes and planes, the horizon among them, where formulas divide by zero.
#[test]
fn light_is_finite_along_axes_and_planes() {
    const COMPONENTS: [f64; 11] = [-1.0, -0.5, -1e-9, -1e-300, -0.0, 0.0, 1e-300, 1e-9, 0.3, 0.5, 1.0];
    for x in COMPONENTS {
        for y in COMPONENTS {
            for z in COMPONENTS {
                if let Some(direction) = Direction::new(DVec3::new(x, y, z)) {
                    assert!(is_light(DemoWorld.radiance(direction)), "{direction:?}");
                }
            }
        }
    }
}

fn small_face(face: CubeFace, threads: usize) -> Image<Rgba> {
    const SIZE: usize = 48;
    let placement =
        Placement { orientation: face.orientation(), ..Placement::new(CameraModel::CubeFace(CubeFaceCamera)) };
    let view = placement.view(SIZE, SIZE).expect("a face");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| picture(&DemoWorld, &view))
}

#[test]
fn a_picture_does_not_depend_on_the_number_of_threads() {
    let alone = small_face(CubeFace::Front, 1);
    assert_eq!(alone, small_face(CubeFace::Front, 2));
    assert_eq!(alone, small_face(CubeFace::Front, 7));
}

/// No face is empty: each has bright and dark in it.
#[test]
fn there_is_something_to_see_on_every_face() {
    for face in CubeFace::ALL {
        let image = small_face(face, 2);
        let green = image.pixels().iter().map(|pixel| pixel.0[1]);
        let (least, greatest) = (green.clone().fold(f32::INFINITY, f32::min), green.fold(0.0, f32::max));
        assert!(least < 0.2 && greatest > 0.45, "{face}: {least} to {greatest}");
    }
}
