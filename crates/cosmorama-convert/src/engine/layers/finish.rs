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
                row.iter_mut().for_each(|pixel| *pixel = distance(*pixel));
                if view.is_flat() {
                    view.row_planar_depths(j, |i, share| row[i].0[0] *= if is_far(row[i]) { 1.0 } else { share });
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

/// Least mean of the numbers that stand for nothing, where these are numbers. Infinity is counted as 1.
const NUMBER: f32 = 16384.0;

/// Returns the mean of the distances that count, if they are at least half of what a pixel sees; otherwise what stands for
/// nothing, if it sees some of that. Outside of the lens it is 0.
fn distance(Rgba([sum, counted, far, seen]): Rgba) -> Rgba {
    if counted > 0.0 && (far <= 0.0 || counted >= 0.5 * seen) {
        Rgba([sum / counted, 0.0, 0.0, 1.0])
    } else if far > 0.0 {
        let number = far / (seen - counted);
        Rgba([if number < NUMBER { f32::INFINITY } else { number }, 0.0, 1.0, 1.0])
    } else {
        Rgba::TRANSPARENT
    }
}

/// Returns whether a pixel sees nothing up to infinity.
fn is_far(Rgba([_, _, far, _]): Rgba) -> bool {
    far > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_distance_does_not_count() {
        let distance = |pixel| distance(Rgba(pixel)).0[0];
        assert_eq!(distance([6.0, 0.75, 0.25, 1.0]), 8.0);
        assert_eq!(distance([2.0, 0.25, 0.75, 1.0]), f32::INFINITY);
        assert_eq!(distance([2.0, 0.25, 0.75e10, 1.0]), 1e10, "as the renderer wrote it");
        assert_eq!(distance([2.0, 0.25, 0.0, 1.0]), 8.0, "beside NaN");
        assert_eq!(distance([4.0, 0.5, 0.0, 0.5]), 8.0, "at the rim of a lens");
        assert_eq!(distance([0.0; 4]), 0.0);
    }
}
