use rayon::prelude::*;

use crate::raster::Image;

/// Taps to each side: the bell of σ = 1 px is cut off at 4σ.
const RADIUS: usize = 4;

type Taps = [f32; 2 * RADIUS + 1];

/// Blurs a plane by a Gaussian of σ = 1 px; beyond its border the plane is mirrored, with the outermost pixel repeated.
pub(crate) fn blurred(plane: &Image<f32>) -> Image<f32> {
    let taps = taps();
    let (width, height) = (plane.width(), plane.height());
    let mut result = Image::filled(width, height, 0.0);
    result.pixels_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(j, row)| {
        let down = blurred_down(plane, j, &taps);
        blur_along(&down, row, &taps);
    });
    result
}

fn taps() -> Taps {
    let bell: [f64; 2 * RADIUS + 1] = std::array::from_fn(|k| (-0.5 * (k as f64 - RADIUS as f64).powi(2)).exp());
    let sum: f64 = bell.iter().sum();
    bell.map(|weight| (weight / sum) as f32)
}

/// Returns row `j` after the blur along columns, with its mirrored continuation at both ends.
fn blurred_down(plane: &Image<f32>, j: usize, taps: &Taps) -> Vec<f32> {
    let width = plane.width();
    let mut row = vec![0.0; width];
    for (k, weight) in taps.iter().enumerate() {
        let source = plane.row(mirrored(j + k, plane.height()));
        row.iter_mut().zip(source).for_each(|(sum, value)| *sum += weight * value);
    }
    (0..width + 2 * RADIUS).map(|i| row[mirrored(i, width)]).collect()
}

fn blur_along(extended: &[f32], row: &mut [f32], taps: &Taps) {
    for (value, around) in row.iter_mut().zip(extended.windows(taps.len())) {
        *value = around.iter().zip(taps).map(|(value, weight)| value * weight).sum();
    }
}

/// Returns the index below `length` to which `shifted − RADIUS` is mirrored: … 1 0 | 0 1 … n−1 | n−1 ….
fn mirrored(shifted: usize, length: usize) -> usize {
    let period = 2 * length as isize;
    let index = (shifted as isize - RADIUS as isize).rem_euclid(period);
    index.min(period - 1 - index) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_mirror_with_the_border_repeated() {
        let indices: Vec<_> = (0..11).map(|k| mirrored(k, 3)).collect();
        assert_eq!(indices, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
    }

    #[test]
    fn a_flat_plane_stays_flat_and_a_point_becomes_a_bell() {
        assert!(blurred(&Image::filled(5, 3, 0.5)).pixels().iter().all(|v| (v - 0.5).abs() < 1e-6));
        let point = Image::from_fn(21, 21, |i, j| if (i, j) == (10, 10) { 1.0 } else { 0.0 });
        let bell = blurred(&point);
        assert!((bell.get(10, 10) - 0.159_154).abs() < 1e-4);
        assert!((bell.get(11, 10) / bell.get(10, 10) - (-0.5_f32).exp()).abs() < 1e-6);
        assert_eq!(*bell.get(15, 10), 0.0);
    }
}
