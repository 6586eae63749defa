use cosmorama::lighting::{AllTexels, LightFigures, LightTree, LobeAverages};
use cosmorama::raster::{Depth, Image, Rgba};
use cosmorama::world::World;

use crate::diagnostic::{MISSING, Result, bail};
use crate::engine::Texels;
use crate::job::ConvertJob;
use crate::settings::LightSettings;
use crate::target::TargetView;

/// Light of a frame, prepared to be averaged under lobes.
pub(crate) struct LightMaps<'a> {
    settings: &'a LightSettings,
    worlds: Vec<Box<dyn LobeAverages + 'a>>,
    /// Light of directions in which the worlds show nothing.
    unseen: Rgba,
}

impl<'a> LightMaps<'a> {
    /// Gathers the light of a frame; `None` if pictures are asked for, not maps of light.
    pub(crate) fn of(job: &'a ConvertJob, texels: &'a Texels) -> Result<Option<Self>> {
        let Some(settings) = &job.lighting else { return Ok(None) };
        let Texels::Float(lights) = texels else { bail!("light of 8 bits where floats were expected") };
        let averages = |(world, texels): (&'a _, &'a Vec<Rgba>)| -> Box<dyn LobeAverages + 'a> {
            if settings.exact {
                Box::new(AllTexels::of_texels(world, texels))
            } else {
                Box::new(LightTree::of_texels(world, texels))
            }
        };
        let worlds: Vec<_> = job.worlds.iter().zip(lights).map(averages).collect();
        let unseen = light_of_unseen(job, worlds.iter().all(|world| world.is_complete()))?;
        Ok(Some(Self { settings, worlds, unseen }))
    }

    /// Makes the map of a target view.
    pub(crate) fn view(&self, target: &TargetView) -> Image<Rgba> {
        let world = &self.worlds[target.world(self.worlds.len())];
        let mut image = world.picture(&target.view, &self.settings.lobe, self.unseen);
        let scale = self.settings.scale() as f32;
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = scaled(*pixel, scale));
        image
    }
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
    /// Light of the input; of a stereo pair, the left eye's.
    pub input: LightFigures,
    /// Light of the map, as radiance: what it was multiplied by is taken out.
    pub output: LightFigures,
    /// Samples of the map that its sample type cannot hold, and that are written as the largest it can.
    pub overflowed: usize,
}

impl LightReport {
    /// Measures the light of a frame and of its maps: the largest level of the left eye.
    pub(crate) fn of(
        job: &ConvertJob,
        frame: Option<u64>,
        texels: &Texels,
        maps: &[(&TargetView, &Image<Rgba>)],
    ) -> Option<Self> {
        let (settings, Texels::Float(lights)) = (job.lighting.as_ref()?, texels) else { return None };
        let size = maps.iter().map(|(target, _)| target.view.width()).max()?;
        let first = maps.iter().filter(|(target, _)| target.world(2) == 0 && target.view.width() == size);
        let views = first.clone().map(|(target, _)| (target.name.clone(), target.view.clone()));
        let world = World::new(views).ok()?;
        let scale = settings.scale().recip() as f32;
        let radiance: Vec<Rgba> =
            first.flat_map(|(_, image)| image.pixels()).map(|pixel| scaled(*pixel, scale)).collect();
        let most = match job.light.depth {
            Depth::Float => f32::MAX,
            Depth::Half => HALF,
            _ => 1.0,
        };
        let samples = maps.iter().flat_map(|(_, image)| image.pixels()).flat_map(|pixel| &pixel.0[..3]);
        Some(Self {
            frame,
            input: LightFigures::of(&job.worlds[0], &lights[0]),
            output: LightFigures::of(&world, &radiance),
            overflowed: samples.filter(|sample| **sample > most).count(),
        })
    }
}

/// Largest half float.
const HALF: f32 = 65504.0;

fn scaled(Rgba([red, green, blue, alpha]): Rgba, scale: f32) -> Rgba {
    Rgba([red * scale, green * scale, blue * scale, alpha])
}
