//! Views that the tests convert from and to.
#![allow(dead_code)]

use cosmorama::projection::{PlanePoint, PlaneRect, ProjectionKind};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::{FieldStop, OmnimaxFraming, PixelGrid, PixelPoint, View, World};
use glam::DVec2;

pub(crate) fn face(width: usize, height: usize, face: CubeFace) -> View {
    let square = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
    View {
        projection: ProjectionKind::PERSPECTIVE,
        orientation: face.orientation(),
        grid: PixelGrid::spanning(width, height, square),
        stop: FieldStop::NONE,
    }
}

pub(crate) fn cube_of(width: usize, height: usize, faces: &[CubeFace]) -> World {
    World::new(faces.iter().map(|&of| (of.name().to_string(), face(width, height, of)))).expect("a world")
}

pub(crate) fn cube(size: usize) -> World {
    cube_of(size, size, &CubeFace::ALL)
}

pub(crate) fn omnimax(width: usize, height: usize) -> View {
    View {
        projection: ProjectionKind::OMNIMAX,
        orientation: Orientation::IDENTITY,
        grid: OmnimaxFraming::Fit.grid(width, height, 1.0),
        stop: FieldStop::circle(1.0).with_lower(Angle::from_degrees(45.0)),
    }
}

pub(crate) fn fisheye(size: usize, fov: f64) -> View {
    let half = fov.to_radians() / 2.0;
    let centre = PixelPoint::new(size as f64 / 2.0, size as f64 / 2.0);
    View {
        projection: ProjectionKind::EQUIDISTANT,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::centred(size, size, centre, DVec2::splat(2.0 * half / size as f64)),
        stop: FieldStop::circle(half),
    }
}

pub(crate) fn perspective(width: usize, height: usize, fov: f64, [yaw, pitch, roll]: [f64; 3]) -> View {
    let step = 2.0 * (fov.to_radians() / 2.0).tan() / width as f64;
    let centre = PixelPoint::new(width as f64 / 2.0, height as f64 / 2.0);
    View {
        projection: ProjectionKind::PERSPECTIVE,
        orientation: turned([yaw, pitch, roll]),
        grid: PixelGrid::centred(width, height, centre, DVec2::splat(step)),
        stop: FieldStop::NONE,
    }
}

pub(crate) fn equirect(width: usize) -> View {
    use std::f64::consts::{FRAC_PI_2, PI};
    let all = PlaneRect { min: PlanePoint::new(-PI, -FRAC_PI_2), max: PlanePoint::new(PI, FRAC_PI_2) };
    View {
        projection: ProjectionKind::EQUIRECTANGULAR,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::spanning(width, width / 2, all),
        stop: FieldStop::NONE,
    }
}

pub(crate) fn turned([yaw, pitch, roll]: [f64; 3]) -> Orientation {
    let degrees = Angle::from_degrees;
    Orientation::from_yaw_pitch_roll(degrees(yaw), degrees(pitch), degrees(roll))
}
