//! Chroma planes with fewer samples than luma: filled up, and thinned out.

use super::Subsampling;

/// Samples of a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane<'a> {
    pub(super) samples: &'a [f32],
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Plane<'_> {
    fn row(&self, row: usize) -> &[f32] {
        let row = row.min(self.height - 1);
        &self.samples[row * self.width..(row + 1) * self.width]
    }

    /// Fills a row of as many samples as luma has: the nearest two, weighed by their distance.
    pub(super) fn fill_row(&self, subsampling: Subsampling, j: usize, filled: &mut [f32], mixed: &mut Vec<f32>) {
        mixed.clear();
        match subsampling {
            Subsampling::Jpeg420 | Subsampling::Mpeg420 => {
                // Rows of chroma lie between two of luma: a quarter of a row from the nearer one.
                let other = if j.is_multiple_of(2) { (j / 2).saturating_sub(1) } else { j / 2 + 1 };
                let pairs = self.row(j / 2).iter().zip(self.row(other));
                mixed.extend(pairs.map(|(near, far)| 0.75 * near + 0.25 * far));
            }
            _ => mixed.extend(self.row(j)),
        }
        let at = |i: usize| mixed[i.min(mixed.len() - 1)];
        for (i, value) in filled.iter_mut().enumerate() {
            *value = match subsampling {
                Subsampling::Jpeg420 => {
                    let other = if i.is_multiple_of(2) { (i / 2).saturating_sub(1) } else { i / 2 + 1 };
                    0.75 * at(i / 2) + 0.25 * at(other)
                }
                Subsampling::Mpeg420 | Subsampling::C422 if i.is_multiple_of(2) => at(i / 2),
                Subsampling::Mpeg420 | Subsampling::C422 => 0.5 * (at(i / 2) + at(i / 2 + 1)),
                _ => at(i),
            };
        }
    }

    /// Returns the sample of a thinner plane: the mean of those around its place.
    pub(super) fn thinned(&self, subsampling: Subsampling, i: usize, j: usize) -> f32 {
        let rows = match subsampling {
            Subsampling::Jpeg420 | Subsampling::Mpeg420 => [2 * j, 2 * j + 1],
            _ => [j, j],
        };
        let of_row = |row: usize| {
            let row = self.row(row);
            let at = |i: usize| row[i.min(self.width - 1)];
            match subsampling {
                Subsampling::Jpeg420 => 0.5 * (at(2 * i) + at(2 * i + 1)),
                Subsampling::Mpeg420 | Subsampling::C422 => {
                    0.25 * (at((2 * i).saturating_sub(1)) + 2.0 * at(2 * i) + at(2 * i + 1))
                }
                _ => at(i),
            }
        };
        0.5 * (of_row(rows[0]) + of_row(rows[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // A ramp keeps its values through both, but for the border.
    #[test]
    fn places_of_samples_are_kept() {
        let (width, height) = (16, 12);
        let ramp = |i: f32, j: f32| 3.0 * i + 5.0 * j;
        let all: Vec<f32> = (0..width * height).map(|at| ramp((at % width) as f32, (at / width) as f32)).collect();
        let plane = Plane { samples: &all, width, height };
        for subsampling in [Subsampling::Jpeg420, Subsampling::Mpeg420, Subsampling::C422, Subsampling::C444] {
            let columns = if subsampling == Subsampling::C444 { width } else { width / 2 };
            let rows = if matches!(subsampling, Subsampling::C422 | Subsampling::C444) { height } else { height / 2 };
            let thin: Vec<f32> =
                (0..columns * rows).map(|at| plane.thinned(subsampling, at % columns, at / columns)).collect();
            let thin = Plane { samples: &thin, width: columns, height: rows };
            let (mut filled, mut mixed) = (vec![0.0; width], Vec::new());
            for j in 2..height - 2 {
                thin.fill_row(subsampling, j, &mut filled, &mut mixed);
                for (i, found) in filled.iter().enumerate().take(width - 3).skip(3) {
                    let expected = ramp(i as f32, j as f32);
                    assert!((found - expected).abs() < 1e-4, "{subsampling:?} {i} {j}: {} {expected}", found);
                }
            }
        }
    }
}
