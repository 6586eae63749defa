use glam::DVec3;
use rayon::prelude::*;

use super::Source;
use super::blend::{Presence, parts};
use super::search::view_index::{Near, ViewIndex};
use crate::camera::{PixelPoint, PixelRect, View};
use crate::projection::PlanePoint;
use crate::sphere::Direction;

/// Number of texels along a side of a picture that are tested for overlap.
const ALONG_A_SIDE: usize = 64;

/// Number of points around a field stop that are tested for overlap.
const AROUND_A_STOP: usize = 256;

/// Distance of these points inside the field stop, as a safeguard against rounding: a fraction of its radius, or
/// radians.
const INSIDE_A_STOP: f64 = 1e-6;

/// Reduces the solid angles of texels where pictures overlap, such as the outermost texels of cube faces with samples
/// on the edges, or the common parts of photographs. Each texel then counts for its share of the direction. Also
/// records which views overlap each view, and which of its texels are not shared. Of many views, an index tells those that lie near.
pub(crate) fn share(sources: &mut [Source], index: Option<&ViewIndex>) {
    let rims: Vec<Vec<Direction>> = sources.iter().map(|source| rim(&source.view)).collect();
    let meets = |a: usize, b: usize| sources[a].meets(&sources[b]);
    let sees = |view: usize, rim: usize| rims[rim].iter().any(|direction| sources[view].view.sees(*direction));
    let near = |view: usize| match index.zip(sources[view].cone) {
        Some((index, cone)) => index.near(cone.middle(), cone.reach()),
        None => Near::All(0..sources.len()),
    };
    let others: Vec<Vec<usize>> = (0..sources.len())
        .into_par_iter()
        .map(|index| {
            let overlaps =
                |&other: &usize| other != index && meets(index, other) && (sees(index, other) || sees(other, index));
            near(index).filter(overlaps).collect()
        })
        .collect();
    for (source, others) in sources.iter_mut().zip(others) {
        source.others = others;
    }
    for index in 0..sources.len() {
        if !sources[index].others.is_empty() {
            let mut solid_angles = sources[index].solid_angles.clone();
            let is_shared = share_texels(sources, index, solid_angles.make_mut());
            sources[index].solid_angles = solid_angles;
            sources[index].whole = unshared(sources[index].whole, sources[index].view.width(), &is_shared);
        }
    }
}

/// Multiplies each texel of a view by its share, and returns which texels are shared.
fn share_texels(sources: &[Source], index: usize, solid_angles: &mut [f32]) -> Vec<bool> {
    let source = &sources[index];
    let width = source.view.width();
    let mut is_shared = vec![false; source.texels().len()];
    let rows = solid_angles.par_chunks_mut(width).zip(is_shared.par_chunks_mut(width));
    rows.enumerate().for_each(|(j, (angles, is_shared))| {
        let mut present = Vec::new();
        source.view.row_directions(j, 0..width, |i, direction| {
            present.clear();
            present.extend(source.others.iter().filter_map(|&at| Presence::of(at, &sources[at], direction)));
            if !present.is_empty() && angles[i] > 0.0 {
                present.push(Presence::at(index, source, PixelPoint::centre(i, j)));
                let part = parts(&present)[present.len() - 1];
                angles[i] *= part as f32;
                is_shared[i] = part < 1.0;
            }
        });
    });
    is_shared
}

/// Returns the largest rectangle, with the same margin on all sides, in which no texel is shared; it may be empty.
pub(crate) fn unshared(mut rect: PixelRect, width: usize, is_shared: &[bool]) -> PixelRect {
    while rect.left < rect.right && rect.top < rect.bottom {
        let row = |j: usize| is_shared[j * width + rect.left..j * width + rect.right].contains(&true);
        let sides = |j: usize| is_shared[j * width + rect.left] || is_shared[j * width + rect.right - 1];
        if !row(rect.top) && !row(rect.bottom - 1) && !(rect.top..rect.bottom).any(sides) {
            if (rect.top..rect.bottom).any(row) {
                // An island inside: no rectangle is worth looking for.
                break;
            }
            return rect;
        }
        rect = PixelRect { left: rect.left + 1, top: rect.top + 1, right: rect.right - 1, bottom: rect.bottom - 1 };
    }
    PixelRect { right: rect.left, bottom: rect.top, ..rect }
}

/// Returns directions along the rim of the visible part of a view. Two views overlap where part of the rim of one is in
/// the other.
fn rim(view: &View) -> Vec<Direction> {
    let mut rim = image_border(view);
    rim.extend(circle_rim(view));
    rim.extend(half_space_rim(view));
    rim
}

/// Returns the directions of some of the outermost texels, corners included.
fn image_border(view: &View) -> Vec<Direction> {
    let (last_column, last_row) = (view.width() - 1, view.height() - 1);
    let along = |last: usize| {
        let steps = last.clamp(1, ALONG_A_SIDE);
        (0..=steps).map(move |step| last * step / steps)
    };
    let level = along(last_column).flat_map(|i| [(i, 0), (i, last_row)]);
    let upright = along(last_row).flat_map(|j| [(0, j), (last_column, j)]);
    level.chain(upright).filter_map(|(i, j)| view.direction(PixelPoint::centre(i, j))).collect()
}

/// Returns directions just inside the limiting circle, which may lie well inside the image.
fn circle_rim(view: &View) -> Vec<Direction> {
    let Some(radius) = view.stop.circle else { return Vec::new() };
    let radius = radius * (1.0 - INSIDE_A_STOP);
    let points = around().map(|(cos, sin)| view.grid.to_pixel(PlanePoint::new(radius * cos, radius * sin)));
    points.filter(|pixel| view.shows(*pixel)).filter_map(|pixel| view.direction(pixel)).collect()
}

/// Returns directions just on the visible side of the limiting great circle.
fn half_space_rim(view: &View) -> Vec<Direction> {
    let Some(side) = view.stop.half_space.map(Direction::vector) else { return Vec::new() };
    let (across, along) = side.any_orthonormal_pair();
    let inside = |(cos, sin): (f64, f64)| -> DVec3 { cos * across + sin * along + INSIDE_A_STOP * side };
    let directions = around().filter_map(|at| Direction::new(inside(at)));
    directions.map(|direction| view.orientation.to_world(direction)).filter(|direction| view.sees(*direction)).collect()
}

/// Returns cosine and sine of angles all the way round.
fn around() -> impl Iterator<Item = (f64, f64)> {
    (0..AROUND_A_STOP).map(|step| {
        let (sin, cos) = (std::f64::consts::TAU * step as f64 / AROUND_A_STOP as f64).sin_cos();
        (cos, sin)
    })
}

#[cfg(test)]
mod tests {
    use crate::camera::{
        CameraModel, FisheyeCamera, LayoutFaceCamera, LensCircle, OmnimaxCamera, Placement, SamplePositions,
    };
    use crate::sphere::{Angle, CubeFace, Orientation};
    use crate::world::World;

    const SPHERE: f64 = 4.0 * std::f64::consts::PI;

    fn whole(world: &World) -> f64 {
        world.solid_angles().map(f64::from).sum()
    }

    fn cube(samples: SamplePositions) -> World {
        let frame = CameraModel::LayoutFace(LayoutFaceCamera { samples, ..LayoutFaceCamera::default() });
        let view = |face: CubeFace| {
            Placement { orientation: face.orientation(), ..Placement::new(frame.clone()) }.view(33, 33)
        };
        World::new(CubeFace::ALL.map(|face| (face.to_string(), view(face).unwrap()))).unwrap()
    }

    #[test]
    fn texels_on_the_edges_of_a_cube_count_once() {
        for samples in [SamplePositions::Centres, SamplePositions::Edges] {
            let sum = whole(&cube(samples));
            assert!((sum / SPHERE - 1.0).abs() < 1e-3, "{samples:?}: {sum}");
        }
        let world = cube(SamplePositions::Edges);
        let angle = |i: usize, j: usize| world.sources()[0].view.texel_solid_angle(i, j) as f32;
        let is = |texel: usize, expected: f32| (world.sources()[0].solid_angles[texel] / expected - 1.0).abs() < 1e-6;
        assert!(is(0, angle(0, 0) / 3.0) && is(1, angle(1, 0) / 2.0) && is(34, angle(1, 1)));
    }

    /// Makes a world of two pictures, one ahead and one behind.
    fn back_to_back(frame: CameraModel, size: usize) -> World {
        let turned = |degrees: f64| {
            let yaw = Angle::from_degrees(degrees);
            Orientation::from_yaw_pitch_roll(yaw, Angle::from_degrees(0.0), Angle::from_degrees(0.0))
        };
        let view =
            |degrees: f64| Placement { orientation: turned(degrees), ..Placement::new(frame.clone()) }.view(size, size);
        World::new([("ahead".to_owned(), view(0.0).unwrap()), ("behind".to_owned(), view(180.0).unwrap())]).unwrap()
    }

    #[test]
    fn what_two_lenses_share_counts_once_however_small_their_circles_are() {
        for radius in [99.0, 80.0, 50.0, 45.0, 30.0] {
            let circle = LensCircle { radius: Some(radius), ..LensCircle::FITTED };
            let frame = FisheyeCamera { field_of_view: Angle::from_degrees(200.0), circle, ..FisheyeCamera::default() };
            let sum = whole(&back_to_back(CameraModel::Fisheye(frame), 200));
            assert!((sum / SPHERE - 1.0).abs() < 0.01, "radius {radius}: {sum}");
        }
    }

    #[test]
    fn the_rim_goes_along_what_stops_the_field_of_view() {
        let circle = LensCircle { radius: Some(20.0), ..LensCircle::FITTED };
        let view = CameraModel::Omnimax(OmnimaxCamera { circle, ..OmnimaxCamera::default() }).view(300, 300).unwrap();
        let cut = view.stop.half_space.expect("a lower cut");
        let on_the_cut = super::rim(&view).into_iter().filter(|rim| cut.dot(*rim).abs() < 1e-5).count();
        assert!(on_the_cut > 50, "{on_the_cut}");
    }
}
