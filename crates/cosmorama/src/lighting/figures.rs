use rayon::prelude::*;

use super::bright_sources::brightness;
use super::texel_angles::texel_angles;
use crate::raster::Rgba;
use crate::world::{Source, World};

/// Figures of the light of a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightFigures {
    /// Mean radiance over the whole sphere, by colour. What the world does not show is dark.
    pub mean: [f64; 3],
    /// Largest channel.
    pub peak: f32,
    /// Part of all light that comes from suns and lamps: texels over [`World::SUN`] times as bright as the mean.
    pub suns: f64,
    /// Part of the sphere that is shown.
    pub shown: f64,
}

impl LightFigures {
    /// Measures the light of a world's texels.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of(world: &World, texels: &[Rgba]) -> Self {
        assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
        let views: Vec<&[Rgba]> = world.sources().iter().map(|source| &texels[source.texels()]).collect();
        Self::of_views(world, &views)
    }

    /// Measures the light of a world's views, each given by its texels.
    ///
    /// # Panics
    /// When there are not as many views, or texels of one, as the world has.
    pub fn of_views(world: &World, views: &[&[Rgba]]) -> Self {
        assert_eq!(views.len(), world.sources().len(), "light for each view");
        let each = || world.sources().iter().zip(views.iter().copied());
        let fits = |(source, texels): (&Source, &[Rgba])| source.texels().len() == texels.len();
        assert!(each().all(fits), "one texel of light for each texel of a view");
        let rows: Vec<Row> = each().flat_map(|(source, texels)| Row::all(source, texels)).collect();
        let whole = 4.0 * std::f64::consts::PI;
        let sum = |channel: usize| rows.iter().map(|row| row.sum[channel]).sum::<f64>();
        let light = [0, 1, 2].map(sum);
        let peak = rows.iter().fold(0.0f32, |peak, row| peak.max(row.peak));
        let suns = suns(each(), &rows);
        Self { mean: light.map(|light| light / whole), peak, suns, shown: sum(3) / whole }
    }

    /// Returns the figures of light that is brighter by a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { mean: self.mean.map(|light| light * factor), peak: (f64::from(self.peak) * factor) as f32, ..self }
    }
}

/// Returns the part of all light that comes from suns and lamps. Only rows that may have some are looked at again.
fn suns<'a>(views: impl Iterator<Item = (&'a Source, &'a [Rgba])>, rows: &[Row]) -> f64 {
    let (bright, angle): (f64, f64) =
        rows.iter().fold((0.0, 0.0), |(bright, angle), row| (bright + row.bright, angle + row.angle));
    if bright <= 0.0 {
        return 0.0;
    }
    let least = World::SUN * bright / angle;
    let (mut suns, mut rows) = (0.0, rows.iter());
    for (source, texels) in views {
        let (angles, width) = (texel_angles(source), source.view.width());
        let of_view = texels.chunks(width).zip(angles.chunks(width)).zip(rows.by_ref());
        for ((texels, angles), _) in of_view.filter(|(_, row)| f64::from(row.peak) > least) {
            let lights = texels.iter().zip(angles).map(|(texel, angle)| (brightness(*texel), f64::from(*angle)));
            suns += lights.filter(|(light, _)| *light > least).map(|(light, angle)| light * angle).sum::<f64>();
        }
    }
    suns / bright
}

/// Sums over a row of texels.
struct Row {
    /// Light and opacity times solid angle.
    sum: [f64; 4],
    /// Largest channel.
    peak: f32,
    /// Brightness times solid angle.
    bright: f64,
    /// Solid angle of all texels.
    angle: f64,
}

impl Row {
    fn all(source: &Source, texels: &[Rgba]) -> Vec<Self> {
        let angles = texel_angles(source);
        let width = source.view.width();
        texels
            .par_chunks(width)
            .zip(angles.par_chunks(width))
            .map(|(texels, angles)| Self::of(texels, angles))
            .collect()
    }

    fn of(texels: &[Rgba], angles: &[f32]) -> Self {
        let mut row = Self { sum: [0.0; 4], peak: 0.0, bright: 0.0, angle: 0.0 };
        for (texel, angle) in texels.iter().zip(angles) {
            let angle = f64::from(*angle);
            row.sum.iter_mut().zip(texel.0).for_each(|(sum, light)| *sum += f64::from(light) * angle);
            row.peak = texel.0[..3].iter().fold(row.peak, |peak, light| peak.max(*light));
            row.bright += brightness(*texel) * angle;
            row.angle += angle;
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::panorama;

    #[test]
    fn half_a_world_of_one_is_a_mean_of_a_half() {
        let world = World::new([("sky".to_owned(), panorama(200, 100))]).expect("one view");
        let texels: Vec<Rgba> =
            (0..20_000).map(|k| if k < 10_000 { Rgba::opaque(1.0, 0.0, 4.0) } else { Rgba::TRANSPARENT }).collect();
        let LightFigures { mean: [red, green, blue], peak, suns, shown } = LightFigures::of(&world, &texels);
        assert!((red - 0.5).abs() < 1e-4 && green == 0.0 && (blue - 2.0).abs() < 4e-4, "{red}, {blue}");
        assert!(peak == 4.0 && suns == 0.0 && (shown - 0.5).abs() < 1e-4);
        // Texels of a coarse world are measured as the others are.
        let world = World::new([("sky".to_owned(), panorama(64, 32))]).expect("one view");
        let lamp = |k: usize| Rgba::opaque(if k == 64 * 10 { 1.0 } else { 0.0 }, 0.0, 0.0);
        let figures = LightFigures::of(&world, &(0..64 * 32).map(lamp).collect::<Vec<_>>());
        assert!((figures.suns - 1.0).abs() < 1e-9, "{}", figures.suns);
        let brighter: Vec<Rgba> = (0..64 * 32).map(|k| Rgba(lamp(k).0.map(|sample| 4.0 * sample))).collect();
        let LightFigures { mean, peak, suns, .. } = figures.scaled(4.0);
        let expected = LightFigures::of(&world, &brighter);
        assert_eq!((mean, peak, suns), (expected.mean, expected.peak, expected.suns));
    }
}
