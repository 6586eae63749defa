use std::borrow::Cow;

use rayon::prelude::*;

use crate::camera::PixelPoint;
use crate::world::Source;

/// Side of a texel, in radians, from which on first-order solid angles are refined. Below, they are exact to 10⁻⁶.
const COARSE: f64 = 4e-3;

/// Returns the solid angle of each texel of a view.
///
/// The world's are of first order: the area at a texel's centre. Those of large texels are averaged over Gauss's four points.
pub(super) fn texel_angles(source: &Source) -> Cow<'_, [f32]> {
    if source.texel_pitch < COARSE {
        return Cow::Borrowed(&source.solid_angles);
    }
    let width = source.view.width();
    let mut angles = source.solid_angles.to_vec();
    angles.par_chunks_mut(width).enumerate().for_each(|(j, row)| {
        for (angle, refinement) in row.iter_mut().zip(refinements(source, j)).filter(|(angle, _)| **angle > 0.0) {
            *angle = (f64::from(*angle) * refinement) as f32;
        }
    });
    Cow::Owned(angles)
}

/// Returns, for each texel of row `j`, the mean of the solid angle at Gauss's points over that at the centre; 1 where a point
/// shows nothing.
fn refinements(source: &Source, j: usize) -> Vec<f64> {
    let PixelPoint { x, y } = PixelPoint::centre(0, j);
    let off = 0.5 / 3f64.sqrt();
    let corners = [(-off, -off), (off, -off), (-off, off), (off, off)];
    let mut sums = vec![0.0; source.view.width()];
    let add = |sum: &mut f64, angle: Option<f64>| *sum += angle.unwrap_or(f64::NAN);
    for (right, down) in corners {
        let first = PixelPoint::new(x + right, y + down);
        source.view.solid_angles_from(first, sums.len(), |i, angle| add(&mut sums[i], angle));
    }
    source.view.solid_angles_from(PixelPoint::new(x, y), sums.len(), |i, angle| {
        let refinement = sums[i] / 4.0 / angle.unwrap_or(f64::NAN);
        sums[i] = if refinement.is_finite() { refinement } else { 1.0 };
    });
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, Placement};
    use crate::world::{World, panorama};

    fn sphere(world: &World) -> f64 {
        world.sources().iter().flat_map(|source| texel_angles(source).into_owned()).map(f64::from).sum()
    }

    #[test]
    fn they_add_up_to_the_sphere() {
        let whole = 4.0 * std::f64::consts::PI;
        for (width, height) in [(32, 16), (64, 32), (512, 256)] {
            let world = World::new([("all".to_owned(), panorama(width, height))]).expect("a view");
            let found = sphere(&world) / whole;
            assert!((found - 1.0).abs() < 2e-6, "{width}x{height}: {found}");
        }
        for edge in [8, 64] {
            let face = Placement::new(CameraModel::CubeFace(CubeFaceCamera)).view(edge, edge).expect("a face");
            let world = World::new([("front".to_owned(), face)]).expect("a view");
            let found = 6.0 * sphere(&world) / whole;
            assert!((found - 1.0).abs() < 2e-6, "{edge}: {found}");
        }
    }
}
