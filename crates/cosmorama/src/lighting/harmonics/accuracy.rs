use std::f64::consts::PI;

use rayon::prelude::*;

use super::coefficients::Harmonics;
use crate::lighting::prefilter::{Lobe, LobeAverages, PreparedLight};
use crate::lighting::texel_angles::texel_angles;
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::World;

/// Part of a world's light that its harmonics miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarmonicAccuracy {
    /// Of the radiance.
    pub radiance: SeriesAccuracy,
    /// Of the irradiance.
    pub irradiance: SeriesAccuracy,
}

/// Likeness of a sum of functions and the light that it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesAccuracy {
    /// Root mean square of the difference over that of the light, all colours together.
    pub rms_error: f64,
    /// Least value of any colour, negative where the sum overshoots.
    pub least: f64,
    /// Part of the sphere in which a colour is negative.
    pub negative: f64,
}

/// Directions that are looked at: some three degrees from one another, less than bands of order 10 are wide.
const DIRECTIONS: usize = 4096;

impl HarmonicAccuracy {
    /// Measures radiance, weakened by a window or not, against the light of a world's texels. The second colour is the light of what
    /// the world does not show.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of(world: &World, (texels, unseen): (&[Rgba], Rgba), exact: &Harmonics, written: &Harmonics) -> Self {
        let all = power(world, (texels, unseen));
        let missed = exact.coefficients().iter().zip(written.coefficients()).flat_map(|(exact, written)| {
            // |L − Σ c Y|² is |L|² − 2 Σ e c + Σ c², for coefficients e of the light.
            [0, 1, 2].map(|channel: usize| written[channel] * (written[channel] - 2.0 * exact[channel]))
        });
        let missed = all + missed.sum::<f64>();
        let directions: Vec<Direction> = Direction::spread(DIRECTIONS).collect();
        let radiance = values(written, &directions);
        let irradiance = values(&written.irradiance(), &directions);
        let truth = PreparedLight::of_texels(world, texels, &[Lobe::LAMBERT]).averages(&directions, &Lobe::LAMBERT);
        let truth: Vec<[f64; 3]> = truth.into_iter().map(|light| lit(light.over(unseen))).collect();
        Self {
            radiance: SeriesAccuracy::of(ratio(missed, all), &radiance),
            // Averages of black are rounding residues. No share of them means anything.
            irradiance: SeriesAccuracy::of(if all > 0.0 { difference(&irradiance, &truth) } else { 0.0 }, &irradiance),
        }
    }
}

impl SeriesAccuracy {
    fn of(squares: f64, values: &[[f64; 3]]) -> Self {
        let least = |light: &[f64; 3]| light.iter().copied().fold(f64::INFINITY, f64::min);
        let negative = values.iter().filter(|light| least(light) < 0.0).count();
        Self {
            rms_error: squares.sqrt(),
            least: values.iter().map(least).fold(f64::INFINITY, f64::min),
            negative: negative as f64 / values.len() as f64,
        }
    }
}

/// Returns E of an average under Lambert's cosine.
fn lit(Rgba([red, green, blue, _]): Rgba) -> [f64; 3] {
    [red, green, blue].map(|light| PI * f64::from(light))
}

fn values(harmonics: &Harmonics, directions: &[Direction]) -> Vec<[f64; 3]> {
    let functions = harmonics.functions();
    directions.par_iter().map(|direction| harmonics.sum(&functions, *direction)).collect()
}

/// Returns the mean square of differences over that of the truth.
fn difference(found: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let square = |light: f64| light * light;
    let both = || found.iter().flatten().zip(truth.iter().flatten());
    ratio(both().map(|(found, truth)| square(found - truth)).sum(), both().map(|(_, truth)| square(*truth)).sum())
}

/// Returns the share of a sum of squares in another, 0 of nothing.
fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { (part / whole).max(0.0) } else { 0.0 }
}

/// Integrates the square of the light over the sphere, all colours together.
fn power(world: &World, (texels, unseen): (&[Rgba], Rgba)) -> f64 {
    assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
    let square = |light: Rgba| light.0[..3].iter().map(|light| f64::from(*light).powi(2)).sum::<f64>();
    let (mut power, mut shown) = (0.0, 0.0);
    for source in world.sources() {
        let (angles, width) = (texel_angles(source), source.view.width());
        let texels = texels[source.texels()].par_chunks(width);
        let row = |(texels, angles): (&[Rgba], &[f32])| {
            let parts = texels.iter().zip(angles).map(|(texel, angle)| (*texel, f64::from(*angle)));
            parts.fold([0.0; 2], |[power, shown], (texel, angle)| {
                [power + square(texel) * angle, shown + f64::from(texel.0[3]) * angle]
            })
        };
        let rows: Vec<[f64; 2]> = texels.zip(angles.par_chunks(width)).map(row).collect();
        power += rows.iter().map(|[power, _]| power).sum::<f64>();
        shown += rows.iter().map(|[_, shown]| shown).sum::<f64>();
    }
    power + square(unseen) * (4.0 * PI - shown).max(0.0)
}
