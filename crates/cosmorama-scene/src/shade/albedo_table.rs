use cosmorama::lighting::{BrdfChannels, BrdfModel};
use cosmorama::raster::{Image, Rgba};

/// Split-sum table: what microfacets reflect of a white world, by angle of view and roughness.
#[derive(Debug)]
pub(super) struct AlbedoTable(Image<Rgba>);

/// Edge of the table. Straight lines between its cells differ from the integral by 0.01 at most, and by 0.001 away from
/// grazing views.
const EDGE: usize = 64;

impl AlbedoTable {
    /// Computes the table by quadrature.
    pub(super) fn new() -> Self {
        Self(BrdfModel::Ggx.table(EDGE, BrdfChannels::ScaleBias).expect("a table of a size in range"))
    }

    /// Returns the factor on what is reflected straight on, and what is added for what is reflected at grazing angles.
    pub(super) fn at(&self, n_dot_v: f64, alpha: f64) -> [f64; 2] {
        let cell = |part: f64| {
            let place = (part.clamp(0.0, 1.0) * EDGE as f64 - 0.5).clamp(0.0, (EDGE - 1) as f64);
            let first = (place as usize).min(EDGE - 2);
            (first, (place - first as f64) as f32)
        };
        let ((i, right), (j, down)) = (cell(n_dot_v), cell(alpha.sqrt()));
        let across = |j: usize| *self.0.get(i, j) * (1.0 - right) + *self.0.get(i + 1, j) * right;
        let Rgba([scale, bias, ..]) = across(j) * (1.0 - down) + across(j + 1) * down;
        [scale.into(), bias.into()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_between_are_those_of_the_integral() {
        let table = AlbedoTable::new();
        for k in 0..400 {
            let (n_dot_v, roughness) = (0.05 + 0.00237 * f64::from(k), 0.02 + 0.97 * f64::from(k * 37 % 400) / 400.0);
            let ([scale, bias], expected) =
                (table.at(n_dot_v, roughness * roughness), BrdfModel::Ggx.albedo(n_dot_v, roughness * roughness));
            let bound = if n_dot_v < 0.2 { 0.01 } else { 0.001 };
            let error = (scale - expected.scale).abs().max((bias - expected.bias).abs());
            assert!(error < bound, "n·v {n_dot_v}, roughness {roughness}: {error}");
        }
    }
}
