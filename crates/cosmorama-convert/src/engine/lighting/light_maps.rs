use std::sync::OnceLock;

use cosmorama::filter::ClassicTables;
use cosmorama::lighting::{AllTexels, LightFigures, Lobe, LobeAverages, PreparedLight};
use cosmorama::raster::{Image, Rgba};
use cosmorama::world::World;

use crate::diagnostic::{MISSING, Result, bail};
use crate::engine::Texels;
use crate::job::ConvertJob;
use crate::settings::{LightLevel, LightScale, LightSettings};
use crate::target::TargetView;

/// Light of a frame, prepared to be averaged under lobes.
pub(crate) struct LightMaps<'a> {
    job: &'a ConvertJob,
    settings: &'a LightSettings,
    texels: &'a [Vec<Rgba>],
    worlds: Vec<Box<dyn LobeAverages + 'a>>,
    /// Tables that the filter of mirrors makes of each world's light once for all pictures, as soon as one asks for them.
    tables: Vec<OnceLock<Option<ClassicTables>>>,
    /// Light of directions in which the worlds show nothing.
    unseen: Rgba,
}

impl<'a> LightMaps<'a> {
    /// Gathers the light of a frame; `None` if pictures are asked for, not maps of light.
    pub(crate) fn of(job: &'a ConvertJob, texels: &'a Texels) -> Result<Option<Self>> {
        let Some(settings) = &job.lighting else { return Ok(None) };
        let Texels::Float(lights) = texels else { bail!("light of 8 bits where floats were expected") };
        let lobes = settings.lobes();
        let averages = |(world, texels): (&'a _, &'a Vec<Rgba>)| -> Box<dyn LobeAverages + 'a> {
            if settings.exact {
                Box::new(AllTexels::of_texels(world, texels))
            } else {
                Box::new(PreparedLight::of_texels(world, texels, &lobes))
            }
        };
        let worlds: Vec<_> = job.worlds.iter().zip(lights).map(averages).collect();
        let unseen = light_of_unseen(job, worlds.iter().all(|world| world.is_complete()))?;
        let tables = vec![OnceLock::new(); worlds.len()];
        Ok(Some(Self { job, settings, texels: lights, worlds, tables, unseen }))
    }

    /// Makes the map of the target view that follows those that are `made`.
    pub(crate) fn next(&self, made: &[Image<Rgba>]) -> Image<Rgba> {
        let views = &self.job.target.views;
        let target = &views[made.len()];
        match self.settings.levels[target.level] {
            LightLevel::Lobe(lobe) => self.under(target, &lobe),
            LightLevel::Mirror => self.mirrored(target),
            // All levels have the same number of views.
            LightLevel::Halved => halved(&made[made.len() - views.len() / self.settings.levels.len()]),
        }
    }

    fn under(&self, target: &TargetView, lobe: &Lobe) -> Image<Rgba> {
        let world = &self.worlds[target.world(self.worlds.len())];
        let mut image = world.picture(&target.view, lobe, self.unseen);
        let scale = self.settings.factor() as f32;
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = scaled(*pixel, scale));
        image
    }

    /// Brings maps to the scale that is asked for, and returns it.
    pub(crate) fn scale(&self, made: &mut [Image<Rgba>]) -> f64 {
        let scale = match self.settings.scale {
            LightScale::Factor(factor) => factor,
            LightScale::Fitting => {
                let samples = made.iter().flat_map(|image| image.pixels()).flat_map(|pixel| &pixel.0[..3]);
                let peak = f64::from(samples.fold(0.0, |peak: f32, sample| peak.max(*sample)));
                let most = f64::from(self.job.light.depth.most());
                if peak > most { (most / peak).log2().floor().exp2() } else { 1.0 }
            }
        };
        if scale != 1.0 {
            let pixels = made.iter_mut().flat_map(|image| image.pixels_mut());
            pixels.for_each(|pixel| *pixel = scaled(*pixel, scale as f32));
        }
        scale
    }

    fn mirrored(&self, target: &TargetView) -> Image<Rgba> {
        let (job, place) = (self.job, target.world(self.texels.len()));
        let texels = &self.texels[place];
        let tables = self.tables[place].get_or_init(|| job.filter.tables(&job.worlds[place], texels)).as_ref();
        job.resampler(target).render_by(tables, texels, self.unseen)
    }
}

/// Returns an image of half the size: the means of two by two pixels.
fn halved(image: &Image<Rgba>) -> Image<Rgba> {
    let half = |pixels: usize| (pixels / 2).max(1);
    let (width, height) = (image.width(), image.height());
    Image::from_fn(half(width), half(height), |i, j| {
        let pixel = |x: usize, y: usize| *image.get((2 * i + x).min(width - 1), (2 * j + y).min(height - 1));
        (pixel(0, 0) + pixel(1, 0) + pixel(0, 1) + pixel(1, 1)) * 0.25
    })
}

/// Returns the light of directions in which a frame's worlds show nothing. Where there should be none, it is an error.
pub(crate) fn light_of_unseen(job: &ConvertJob, is_complete: bool) -> Result<Rgba> {
    let unseen = job.fill_for_missing();
    if unseen.is_none() && !job.light.input_alpha && !is_complete {
        bail!(
            NotANumber: "missing pixels (NaN) leave more than a thousandth of the sphere without light; render them again, or \
             fill the gaps with {MISSING} COLOR or {MISSING} transparent"
        );
    }
    Ok(unseen.unwrap_or(Rgba::TRANSPARENT))
}

/// Light that went into a map, and light that came out.
#[derive(Clone, Debug, PartialEq)]
pub struct LightReport {
    /// Frame; `None` for a still.
    pub frame: Option<u64>,
    /// Level of a chain, from 0.
    pub level: usize,
    /// Roughness α of the level, if its lobe has one; 0 for a mirror.
    pub alpha: Option<f64>,
    /// Light of the input; of a stereo pair, the left eye's.
    pub input: LightFigures,
    /// Light of the map as radiance, without the factors of the map's unit and scale.
    pub output: LightFigures,
    /// Factor by which the map's light is written.
    pub scale: f64,
    /// Samples of the map that its sample type cannot hold, and that are written as the largest it can.
    pub overflowed: usize,
}

impl LightReport {
    /// Measures the light of a frame and of its maps: each level, of the left eye.
    pub(crate) fn of(
        job: &ConvertJob,
        frame: Option<u64>,
        texels: &Texels,
        (maps, factor): (&[(&TargetView, &Image<Rgba>)], f64),
    ) -> Vec<Self> {
        let (Some(settings), Texels::Float(lights)) = (&job.lighting, texels) else { return Vec::new() };
        let input = LightFigures::of(&job.worlds[0], &lights[0]);
        let level = |(level, kind): (usize, &LightLevel)| {
            let of_level: Vec<_> = maps.iter().filter(|(target, _)| target.level == level).collect();
            let first = || of_level.iter().filter(|(target, _)| target.world(2) == 0);
            let world = World::new(first().map(|(target, _)| (target.name.clone(), target.view.clone()))).ok()?;
            let views: Vec<&[Rgba]> = first().map(|(_, image)| image.pixels()).collect();
            let alpha = match kind {
                LightLevel::Mirror => Some(0.0),
                LightLevel::Lobe(lobe) => lobe.alpha(),
                LightLevel::Halved => None,
            };
            let output = LightFigures::of_views(&world, &views).scaled((settings.factor() * factor).recip());
            let overflowed = overflowed(job, of_level.iter().map(|(_, image)| *image));
            Some(Self { frame, level, alpha, input, output, scale: factor, overflowed })
        };
        settings.levels.iter().enumerate().filter_map(level).collect()
    }
}

/// Counts the samples that the output's sample type cannot hold.
fn overflowed<'a>(job: &ConvertJob, images: impl Iterator<Item = &'a Image<Rgba>>) -> usize {
    let most = job.light.depth.most();
    let samples = images.flat_map(|image| image.pixels()).flat_map(|pixel| &pixel.0[..3]);
    samples.filter(|sample| **sample > most).count()
}

fn scaled(Rgba([red, green, blue, alpha]): Rgba, scale: f32) -> Rgba {
    Rgba([red * scale, green * scale, blue * scale, alpha])
}
