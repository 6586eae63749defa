use rayon::prelude::*;

use super::{PixelPoint, Source, View};
use crate::sphere::Direction;

/// Texels along a side of a picture that tell whether it overlaps another.
const ALONG_A_SIDE: usize = 64;

/// Where pictures overlap, a direction has a texel of each, and each counts for its part. So do the outermost texels of
/// cube faces whose samples lie on the edges: two faces hold them, or three.
pub(super) fn share(sources: &[Source], solid_angles: &mut [f32]) {
    let rims: Vec<Vec<Direction>> = sources.iter().map(|source| rim(&source.view)).collect();
    let sees = |view: usize, rim: usize| rims[rim].iter().any(|direction| sources[view].view.sees(*direction));
    for (index, source) in sources.iter().enumerate() {
        let overlaps = |&other: &usize| other != index && (sees(index, other) || sees(other, index));
        let others: Vec<&View> = (0..sources.len()).filter(overlaps).map(|other| &sources[other].view).collect();
        if others.is_empty() {
            continue;
        }
        let width = source.view.width();
        solid_angles[source.texels()].par_chunks_mut(width).enumerate().for_each(|(j, row)| {
            source.view.row_directions(j, 0..width, |i, direction| {
                let shared = others.iter().filter(|other| other.sees(direction)).count();
                row[i] /= (1 + shared) as f32;
            });
        });
    }
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
            let sum: f64 = cube(samples).solid_angles().iter().map(|angle| f64::from(*angle)).sum();
            assert!((sum / sphere - 1.0).abs() < 1e-3, "{samples:?}: {sum}");
        }
        let world = cube(SamplePositions::Edges);
        let angle = |i: usize, j: usize| world.sources()[0].view.texel_solid_angle(i, j) as f32;
        assert_eq!(world.solid_angles()[0], angle(0, 0) / 3.0);
        assert_eq!(world.solid_angles()[1], angle(1, 0) / 2.0);
        assert_eq!(world.solid_angles()[34], angle(1, 1));
    }
}
