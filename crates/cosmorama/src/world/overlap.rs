use rayon::prelude::*;

use super::blend::{Presence, parts};
use super::{PixelPoint, PixelRect, Source, View};
use crate::sphere::Direction;

/// Texels along a side of a picture that tell whether it overlaps another.
const ALONG_A_SIDE: usize = 64;

/// Where pictures overlap, a direction has a texel of each, and each counts for its part: the outermost texels of cube
/// faces whose samples lie on the edges, and whatever photographs have in common. Says of each view which others overlap
/// it, and which of its texels count whole.
pub(super) fn share(sources: &mut [Source]) {
    let rims: Vec<Vec<Direction>> = sources.iter().map(|source| rim(&source.view)).collect();
    let sees = |view: usize, rim: usize| rims[rim].iter().any(|direction| sources[view].view.sees(*direction));
    let others: Vec<Vec<usize>> = (0..sources.len())
        .map(|index| {
            let overlaps = |&other: &usize| other != index && (sees(index, other) || sees(other, index));
            (0..sources.len()).filter(overlaps).collect()
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

/// Leaves each texel of a view its part; says which ones have less than all.
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

/// The largest rectangle with the same margin on all sides in which no texel is shared; an empty one if there is none.
pub(super) fn unshared(mut rect: PixelRect, width: usize, is_shared: &[bool]) -> PixelRect {
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

/// What some of the outermost texels see, those in the corners among them.
fn rim(view: &View) -> Vec<Direction> {
    let (last_column, last_row) = (view.width() - 1, view.height() - 1);
    let along = |last: usize| {
        let steps = last.clamp(1, ALONG_A_SIDE);
        (0..=steps).map(move |step| last * step / steps)
    };
    let level = along(last_column).flat_map(|i| [(i, 0), (i, last_row)]);
    let upright = along(last_row).flat_map(|j| [(0, j), (last_column, j)]);
    level.chain(upright).filter_map(|(i, j)| view.direction(PixelPoint::centre(i, j))).collect()
}

#[cfg(test)]
mod tests {
    use crate::sphere::CubeFace;
    use crate::world::{Frame, LayoutFaceFrame, Placement, SamplePositions, World};

    fn cube(samples: SamplePositions) -> World {
        let frame = Frame::LayoutFace(LayoutFaceFrame { samples, ..LayoutFaceFrame::default() });
        let view = |face: CubeFace| Placement { orientation: face.orientation(), ..Placement::new(frame) }.view(33, 33);
        World::new(CubeFace::ALL.map(|face| (face.to_string(), view(face).unwrap()))).unwrap()
    }

    #[test]
    fn texels_on_the_edges_of_a_cube_count_once() {
        let sphere = 4.0 * std::f64::consts::PI;
        for samples in [SamplePositions::Centres, SamplePositions::Edges] {
            let sum: f64 = cube(samples).solid_angles().map(f64::from).sum();
            assert!((sum / sphere - 1.0).abs() < 1e-3, "{samples:?}: {sum}");
        }
        let world = cube(SamplePositions::Edges);
        let angle = |i: usize, j: usize| world.sources()[0].view.texel_solid_angle(i, j) as f32;
        let is = |texel: usize, expected: f32| (world.sources()[0].solid_angles[texel] / expected - 1.0).abs() < 1e-6;
        assert!(is(0, angle(0, 0) / 3.0) && is(1, angle(1, 0) / 2.0) && is(34, angle(1, 1)));
    }
}
