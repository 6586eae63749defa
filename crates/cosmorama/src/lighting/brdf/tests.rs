use std::f64::consts::PI;

use super::charlie::CharlieQuadrature;
use super::ggx::GgxQuadrature;
use super::*;
use crate::raster::Rgba;

const EDGE: usize = 1000;

/// Integrates over directions of light, in another way than the tables: 1000 × 1000 of them, crowded towards the horizon, in
/// Walter's and Heitz's terms for D and G2.
fn by_light(model: BrdfModel, n_dot_v: f64, alpha: f64) -> Albedo {
    let sin_v = (1.0 - n_dot_v * n_dot_v).sqrt();
    let lambda = |cos: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - cos * cos) / (cos * cos)).sqrt() - 1.0);
    let mut sum = Albedo { scale: 0.0, bias: 0.0 };
    for i in 0..EDGE {
        // Light at the mirror direction is sharpest: nodes crowd there, as well as at the horizon.
        let x = (i as f64 + 0.5) / EDGE as f64;
        let cos = x * x;
        let sin = (1.0 - cos * cos).sqrt();
        for k in 0..EDGE {
            let p = (k as f64 + 0.5) / EDGE as f64;
            let phi = PI * p * p;
            // To the left: the view is on the right.
            let (hx, hy, hz) = (sin_v - sin * phi.cos(), sin * phi.sin(), n_dot_v + cos);
            let length = (hx * hx + hy * hy + hz * hz).sqrt();
            let n_dot_h = hz / length;
            let v_dot_h = (hx * sin_v + hz * n_dot_v) / length;
            let sin_squared = (hx * hx + hy * hy) / (length * length);
            let reflected = match model {
                BrdfModel::Ggx => {
                    let d = alpha * alpha / (PI * (n_dot_h * n_dot_h * (alpha * alpha - 1.0) + 1.0).powi(2));
                    d / (1.0 + lambda(n_dot_v) + lambda(cos)) / (4.0 * n_dot_v)
                }
                BrdfModel::Charlie => {
                    let d = (2.0 + 1.0 / alpha) * sin_squared.powf(0.5 / alpha) / (2.0 * PI);
                    d * cos / (4.0 * (cos + n_dot_v - cos * n_dot_v))
                }
            };
            // dω = dcos dφ, of both sides.
            let part = 2.0 * reflected * (2.0 * x) * (2.0 * PI * p) / (EDGE * EDGE) as f64;
            let grazing = if model == BrdfModel::Ggx { (1.0 - v_dot_h).powi(5) } else { 0.0 };
            sum.scale += part * (1.0 - grazing);
            sum.bias += part * grazing;
        }
    }
    sum
}

#[test]
fn cells_are_those_of_a_million_points() {
    let cells = [(0.05, 0.5), (0.3, 0.25), (0.7, 0.16), (0.95, 1.0), (0.02, 0.9), (0.5, 0.09)];
    for model in [BrdfModel::Ggx, BrdfModel::Charlie] {
        for (n_dot_v, alpha) in cells {
            let (found, expected) = (model.albedo(n_dot_v, alpha), by_light(model, n_dot_v, alpha));
            let off = (found.scale - expected.scale).abs().max((found.bias - expected.bias).abs());
            assert!(off < 1e-5, "{model:?} {n_dot_v} {alpha}: {found:?}, expected {expected:?}, off by {off:.1e}");
        }
    }
}

/// Compares with finer rules of the same kind, where a million points of light would not be enough.
#[test]
fn more_nodes_change_nothing() {
    let fine = (GgxQuadrature::new(64, 160), CharlieQuadrature::new(64, 200));
    for size in [128.0, 4096.0] {
        for n_dot_v in [0.5 / size, 1.5 / size, 0.02, 0.1, 0.5, 0.9, 1.0 - 0.5 / size] {
            for rough in [0.5 / size, 2.5 / size, 0.02, 0.05, 0.1, 0.2, 0.35, 0.8, 1.0] {
                let alpha: f64 = rough * rough;
                let (found, expected) = (BrdfModel::Ggx.albedo(n_dot_v, alpha), fine.0.albedo(n_dot_v, alpha));
                let off = (found.scale - expected.scale).abs().max((found.bias - expected.bias).abs());
                assert!(off < 1e-5, "GGX {n_dot_v} {rough}: {found:?}, expected {expected:?}");
                assert!(found.total() < 1.0 + 1e-6 && found.scale > -1e-6, "{n_dot_v} {rough}: {found:?}");
                let (found, expected) =
                    (BrdfModel::Charlie.albedo(n_dot_v, alpha).scale, fine.1.albedo(n_dot_v, alpha));
                // Cloth is brighter than white at grazing angles.
                assert!(
                    (found - expected).abs() < 1e-5 * expected.max(1.0),
                    "Charlie {n_dot_v} {rough}: {found}, expected {expected}"
                );
            }
        }
    }
}

#[test]
fn tables_have_their_cells_where_they_should() {
    let table = BrdfModel::Ggx.table(8, BrdfChannels::ScaleBias).expect("a size");
    let albedo = BrdfModel::Ggx.albedo(2.5 / 8.0, (5.5f64 / 8.0).powi(2));
    assert_eq!(*table.get(2, 5), Rgba::opaque(albedo.scale as f32, albedo.bias as f32, 0.0));
    let other = BrdfModel::Ggx.table(8, BrdfChannels::Multiscatter).expect("a size");
    assert_eq!(*other.get(2, 5), Rgba::opaque(albedo.bias as f32, albedo.total() as f32, 0.0));
    assert_eq!(BrdfModel::Ggx.table(0, BrdfChannels::ScaleBias).unwrap_err(), BrdfError::Size(0));
    assert_eq!(BrdfModel::Charlie.table(8, BrdfChannels::Multiscatter).unwrap_err(), BrdfError::Cloth);
}
