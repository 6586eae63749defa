use cosmorama::projection::{PlanePoint, PlaneRect, ProjectionKind};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::{FieldStop, OmnimaxFraming, PixelGrid, PixelPoint, View, World};
use glam::DVec2;

/// A face of the cube, 90° both ways whatever its pixels.
pub fn cube_face(face: CubeFace, width: usize, height: usize) -> View {
    let square = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
    View {
        projection: ProjectionKind::PERSPECTIVE,
        orientation: face.orientation(),
        grid: PixelGrid::spanning(width, height, square),
        stop: FieldStop::NONE,
    }
}

/// A world of some faces of one size.
pub fn cube(faces: &[CubeFace], width: usize, height: usize) -> World {
    let views = faces.iter().map(|&face| (face.name().to_owned(), cube_face(face, width, height)));
    World::new(views).expect("faces make a world")
}

/// An equidistant fisheye that fills a square frame.
pub fn fisheye(size: usize, fov: f64) -> View {
    let half = Angle::from_degrees(fov / 2.0).radians();
    View {
        projection: ProjectionKind::EQUIDISTANT,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::centred(size, size, middle(size, size), DVec2::splat(2.0 * half / size as f64)),
        stop: FieldStop::circle(half),
    }
}

/// An Omnimax frame with the paper's lower cut.
pub fn omnimax(width: usize, height: usize) -> View {
    View {
        projection: ProjectionKind::OMNIMAX,
        orientation: Orientation::IDENTITY,
        grid: OmnimaxFraming::Fit.grid(width, height, 1.0),
        stop: FieldStop::circle(1.0).with_lower(Angle::from_degrees(45.0)),
    }
}

/// A full panorama, twice as wide as high.
pub fn equirect(width: usize) -> View {
    use std::f64::consts::{FRAC_PI_2, PI};
    let sphere = PlaneRect { min: PlanePoint::new(-PI, -FRAC_PI_2), max: PlanePoint::new(PI, FRAC_PI_2) };
    View {
        projection: ProjectionKind::EQUIRECTANGULAR,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::spanning(width, width / 2, sphere),
        stop: FieldStop::NONE,
    }
}

/// A turned pinhole camera; angles in degrees, `fov` horizontal.
pub fn perspective(width: usize, height: usize, fov: f64, yaw: f64, pitch: f64, roll: f64) -> View {
    let step = 2.0 * Angle::from_degrees(fov / 2.0).tan() / width as f64;
    View {
        projection: ProjectionKind::PERSPECTIVE,
        orientation: turned([yaw, pitch, roll]),
        grid: PixelGrid::centred(width, height, middle(width, height), DVec2::splat(step)),
        stop: FieldStop::NONE,
    }
}

fn middle(width: usize, height: usize) -> PixelPoint {
    PixelPoint::new(width as f64 / 2.0, height as f64 / 2.0)
}

/// Yaw, pitch and roll in degrees.
pub fn turned(degrees: [f64; 3]) -> Orientation {
    let [yaw, pitch, roll] = degrees.map(Angle::from_degrees);
    Orientation::from_yaw_pitch_roll(yaw, pitch, roll)
}
