use cosmorama::lighting::{BrdfChannels, BrdfModel};
use cosmorama::raster::Rgba;
use rayon::prelude::*;

/// Split-sum table: what microfacets reflect of a white world, by angle of view and roughness.
#[derive(Debug)]
pub(super) struct AlbedoTable {
    /// Number of the first row that there is, of the smoothest surface.
    first: usize,
    /// Scale and bias, by angle of view.
    rows: Vec<Vec<[f32; 2]>>,
}

/// Edge of the whole table. Straight lines between its cells differ from the integral by 0.01 at most, and by 0.001 away from
/// grazing views.
const EDGE: usize = 64;

/// Rows up to which each cell is computed by itself.
const FEW: usize = 16;

impl AlbedoTable {
    /// Computes the rows for all roughnesses α from one to another, by quadrature.
    pub(super) fn new(alphas: [f64; 2]) -> Self {
        let [first, last] = alphas.map(row);
        let rows = first..=last + 1;
        if last - first >= FEW {
            let whole = BrdfModel::Ggx.table(EDGE, BrdfChannels::ScaleBias).expect("a table of a size in range");
            let row = |j: usize| whole.row(j).iter().map(|Rgba([scale, bias, ..])| [*scale, *bias]).collect();
            return Self { first, rows: rows.map(row).collect() };
        }
        let centre = |k: usize| (k as f64 + 0.5) / EDGE as f64;
        let cell = |i: usize, j: usize| {
            let albedo = BrdfModel::Ggx.albedo(centre(i), centre(j) * centre(j));
            [albedo.scale as f32, albedo.bias as f32]
        };
        let row = |j: usize| (0..EDGE).map(|i| cell(i, j)).collect();
        Self { first, rows: rows.into_par_iter().map(row).collect() }
    }

    /// Returns whether it has all roughnesses from one to another.
    pub(super) fn holds(&self, alphas: [f64; 2]) -> bool {
        let [first, last] = alphas.map(row);
        self.first <= first && last + 1 < self.first + self.rows.len()
    }

    /// Returns the factor on what is reflected straight on, and what is added for what is reflected at grazing angles.
    pub(super) fn at(&self, n_dot_v: f64, alpha: f64) -> [f64; 2] {
        let ((i, right), (j, down)) = (cell(n_dot_v), cell(alpha.sqrt()));
        let j = j.clamp(self.first, self.first + self.rows.len() - 2) - self.first;
        let between = |a: f32, b: f32, part: f32| a * (1.0 - part) + b * part;
        std::array::from_fn(|k| {
            let across = |j: usize| between(self.rows[j][i][k], self.rows[j][i + 1][k], right);
            between(across(j), across(j + 1), down).into()
        })
    }
}

/// Returns the cell before a place from 0 to 1, and the part of the way to the next.
fn cell(part: f64) -> (usize, f32) {
    let place = (part.clamp(0.0, 1.0) * EDGE as f64 - 0.5).clamp(0.0, (EDGE - 1) as f64);
    let first = (place as usize).min(EDGE - 2);
    (first, (place - first as f64) as f32)
}

/// Returns the row before a roughness α.
fn row(alpha: f64) -> usize {
    cell(alpha.sqrt()).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_between_are_those_of_the_integral() {
        let table = AlbedoTable::new([0.0, 1.0]);
        for k in 0..400 {
            let (n_dot_v, roughness) = (0.05 + 0.00237 * f64::from(k), 0.02 + 0.97 * f64::from(k * 37 % 400) / 400.0);
            let ([scale, bias], expected) =
                (table.at(n_dot_v, roughness * roughness), BrdfModel::Ggx.albedo(n_dot_v, roughness * roughness));
            let bound = if n_dot_v < 0.2 { 0.01 } else { 0.001 };
            let error = (scale - expected.scale).abs().max((bias - expected.bias).abs());
            assert!(error < bound, "n·v {n_dot_v}, roughness {roughness}: {error}");
        }
    }

    #[test]
    fn a_part_of_the_table_is_as_the_whole() {
        let (part, whole) = (AlbedoTable::new([0.09, 0.12]), AlbedoTable::new([0.0, 1.0]));
        assert!(part.rows.len() < 6 && part.holds([0.1, 0.11]) && !part.holds([0.0, 0.1]) && !part.holds([0.1, 0.3]));
        for k in 0..100 {
            let (n_dot_v, alpha) = (0.01 * f64::from(k), 0.09 + 0.0003 * f64::from(k));
            assert_eq!(part.at(n_dot_v, alpha), whole.at(n_dot_v, alpha), "{n_dot_v}, {alpha}");
        }
    }
}
