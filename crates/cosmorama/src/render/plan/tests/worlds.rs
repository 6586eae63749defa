//! Worlds and targets for tests of conversions, with and without mirror images.

use super::*;
use crate::camera::PixelGrid;
use crate::projection::{PlanePoint, PlaneRect};
use crate::sphere::Angle;

pub(crate) fn view(
    projection: ProjectionKind,
    size: (usize, usize),
    half: (f64, f64),
    orientation: Orientation,
) -> View {
    let rect = PlaneRect { min: PlanePoint::new(-half.0, -half.1), max: PlanePoint::new(half.0, half.1) };
    View { projection, orientation, grid: PixelGrid::spanning(size.0, size.1, rect), stop: FieldStop::NONE }
}

pub(crate) fn turned(yaw: f64, pitch: f64, roll: f64) -> Orientation {
    let [yaw, pitch, roll] = [yaw, pitch, roll].map(Angle::from_degrees);
    Orientation::from_yaw_pitch_roll(yaw, pitch, roll)
}

pub(crate) fn cube(faces: &[CubeFace], size: usize) -> World {
    let face = |face: CubeFace| view(ProjectionKind::PERSPECTIVE, (size, size), (1.0, 1.0), face.orientation());
    World::new(faces.iter().map(|&f| (f.name().to_owned(), face(f)))).expect("faces")
}

pub(crate) fn panorama(width: usize) -> World {
    let half = (std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
    let all = view(ProjectionKind::EQUIRECTANGULAR, (width, width / 2), half, Orientation::IDENTITY);
    World::new([("all".to_owned(), all)]).expect("a panorama")
}

pub(crate) fn dome(size: usize, orientation: Orientation) -> View {
    let dome = view(ProjectionKind::EQUIDISTANT, (size, size), (1.0, 1.0), orientation);
    View { stop: FieldStop::circle(1.0), ..dome }
}

/// Returns varied light in steps that 15 bits hold, with edges, dots and slopes.
pub(crate) fn light(world: &World) -> FixedLight {
    let mut light = FixedLight::black(world.view_sizes());
    for (k, texel) in light.texels_mut().enumerate() {
        let noise = |seed: usize| ((k * seed) as u32).wrapping_mul(2_654_435_761) >> 17;
        let smooth = (k % 300 * 100) as i16;
        *texel = [noise(1) as i16, if k % 11 == 0 { i16::MAX } else { smooth }, (noise(7) / 64) as i16, 0];
    }
    light
}

pub(crate) fn floats(light: &FixedLight) -> Vec<Rgba> {
    (0..light.len()).map(|texel| light.rgba(texel)).collect()
}

/// Returns conversions of all kinds, each with the number of mirror images.
pub(crate) fn conversions() -> Vec<(World, View, usize)> {
    let up = turned(0.0, 90.0, 0.0);
    let all = CubeFace::ALL;
    let half = (std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
    let panoramic = |size| view(ProjectionKind::EQUIRECTANGULAR, size, half, Orientation::IDENTITY);
    vec![
        (cube(&all, 150), dome(200, up), 8),
        // Windows of more texels than the small ones have, in patches.
        (cube(&all, 500), dome(200, up), 8),
        (cube(&all, 300), dome(62, up), 8),
        // Windows too large to be weighed in lanes.
        (cube(&all, 300), dome(30, up), 8),
        // Windows nearly as large, so many that bands are spilled; without and with mirror images.
        (
            cube(&[CubeFace::Front], 1200),
            view(ProjectionKind::PERSPECTIVE, (48, 48), (0.36, 0.36), turned(3.0, 2.0, 10.0)),
            1,
        ),
        (
            cube(&[CubeFace::Front], 1200),
            view(ProjectionKind::PERSPECTIVE, (48, 48), (0.36, 0.36), Orientation::IDENTITY),
            8,
        ),
        (cube(&[CubeFace::Front, CubeFace::Left, CubeFace::Right, CubeFace::Up], 120), omnimax(), 2),
        // Rows of light with padding, and no mirror image.
        (cube(&all, 140), dome(120, turned(20.0, 60.0, 5.0)), 1),
        (cube(&all, 100), dome(120, turned(0.0, 60.0, 0.0)), 2),
        (cube(&all, 100), dome(121, up), 1),
        (cube(&all, 64), panoramic((240, 120)), 4),
        (panorama(300), panoramic((400, 200)), 4),
        (panorama(300), view(ProjectionKind::PERSPECTIVE, (160, 90), (1.0, 0.6), Orientation::IDENTITY), 4),
        // Mirror images that are traversed one by one: two from left to right, and one of four.
        (
            cube(&all, 100),
            View { stop: FieldStop::NONE, ..view(ProjectionKind::EQUIDISTANT, (121, 120), (1.0, 0.9), up) },
            2,
        ),
        // Mirror images about the diagonals: of a view of a face and its neighbours, and of a size that is not a whole
        // number of patches.
        (cube(&all, 90), view(ProjectionKind::PERSPECTIVE, (150, 150), (1.3, 1.3), Orientation::IDENTITY), 8),
        (cube(&all, 90), dome(74, turned(90.0, 90.0, 0.0)), 8),
        // The upright edges of the faces lie along the diagonals, far into the picture, with many texels in each pixel.
        (cube(&all, 300), half_world(200), 8),
        (rolled(90), dome(106, up), 8),
        (quarters(100), view(ProjectionKind::PERSPECTIVE, (160, 90), (0.8, 0.45), Orientation::IDENTITY), 4),
    ]
}

/// Returns a dome of the upper half of the world.
fn half_world(size: usize) -> View {
    let quarter = std::f64::consts::FRAC_PI_2;
    let dome = view(ProjectionKind::EQUIDISTANT, (size, size), (quarter, quarter), turned(0.0, 90.0, 0.0));
    View { stop: FieldStop::circle(quarter), ..dome }
}

/// Returns a cube whose right face is upside down, and whose upper face lies on its side.
pub(crate) fn rolled(size: usize) -> World {
    let face = |face: CubeFace| {
        let upright = view(ProjectionKind::PERSPECTIVE, (size, size), (1.0, 1.0), face.orientation());
        let orientation = match face {
            CubeFace::Right => turned(90.0, 0.0, 180.0),
            CubeFace::Up => turned(90.0, 90.0, 0.0),
            _ => upright.orientation,
        };
        (face.name().to_owned(), View { orientation, ..upright })
    };
    World::new(CubeFace::ALL.map(face)).expect("six faces")
}

/// Returns the front face of a cube in four parts, one of them upside down.
pub(crate) fn quarters(size: usize) -> World {
    let part = |name: &str, [left, top]: [usize; 2], roll: f64| {
        let whole = view(ProjectionKind::PERSPECTIVE, (size, size), (1.0, 1.0), turned(0.0, 0.0, roll));
        let half = size / 2;
        let grid = whole.grid.window(half, half, (left * half) as f64, (top * half) as f64);
        (name.to_owned(), View { grid, ..whole })
    };
    let parts = [("a", [0, 0], 0.0), ("b", [1, 0], 0.0), ("c", [0, 1], 0.0), ("d", [0, 0], 180.0)];
    World::new(parts.map(|(name, at, roll)| part(name, at, roll))).expect("four views")
}

pub(crate) fn omnimax() -> View {
    let frame = view(ProjectionKind::OMNIMAX, (200, 146), (1.0, 0.73), Orientation::IDENTITY);
    View { stop: FieldStop::circle(1.0).with_lower(Angle::from_degrees(45.0)), ..frame }
}
