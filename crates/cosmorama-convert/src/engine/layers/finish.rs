use cosmorama::camera::View;
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::Orientation;
use rayon::prelude::*;

use crate::colour::{LayerContent, LayerRules};
use crate::settings::NormalSpace;

/// Turns averages into numbers of the output: distances into its kind of depth, normals into its frame, with length one.
pub(super) fn finish((content, rules): (LayerContent, LayerRules), view: &View, image: &mut Image<Rgba>) {
    let width = view.width().max(1);
    match content {
        LayerContent::Depth => {
            image.pixels_mut().par_chunks_mut(width).enumerate().for_each(|(j, row)| {
                row.iter_mut().for_each(|pixel| pixel.0[0] = distance(*pixel));
                if view.is_flat() {
                    view.row_planar_depths(j, |i, share| row[i].0[0] *= share);
                }
            });
        }
        LayerContent::Normal => {
            let in_camera = rules.normals == NormalSpace::Camera;
            let frame = if in_camera { view.orientation } else { Orientation::IDENTITY };
            image.pixels_mut().par_iter_mut().for_each(|pixel| {
                let [x, y, z, _] = pixel.0;
                let normal = frame.normal_to_view([x, y, z]);
                *pixel = normal.map_or(Rgba::TRANSPARENT, |[x, y, z]| Rgba::opaque(x, y, z));
            });
        }
        LayerContent::Light | LayerContent::Numbers | LayerContent::Labels => {}
    }
}

/// Returns the mean of the distances that count, if they are at least half of what a pixel sees; otherwise infinity, if
/// some of what it sees is infinite. Outside of the lens it is 0.
fn distance(Rgba([sum, counted, far, seen]): Rgba) -> f32 {
    if counted > 0.0 && (far <= 0.0 || counted >= 0.5 * seen) {
        sum / counted
    } else if far > 0.0 {
        f32::INFINITY
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_distance_does_not_count() {
        assert_eq!(distance(Rgba([6.0, 0.75, 0.25, 1.0])), 8.0);
        assert_eq!(distance(Rgba([2.0, 0.25, 0.75, 1.0])), f32::INFINITY);
        assert_eq!(distance(Rgba([2.0, 0.25, 0.0, 1.0])), 8.0, "beside NaN");
        assert_eq!(distance(Rgba([4.0, 0.5, 0.0, 0.5])), 8.0, "at the rim of a lens");
        assert_eq!(distance(Rgba::TRANSPARENT), 0.0);
    }
}
