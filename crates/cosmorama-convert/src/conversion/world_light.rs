use std::collections::HashSet;
use std::ops::ControlFlow;
use std::path::PathBuf;

use cosmorama::lighting::{AllTexels, HarmonicBasis, Harmonics, Lobe, LobeAverages};
use cosmorama::raster::{Depth, Primaries, Rgba};
use cosmorama::world::{Light, World};
use rayon::ThreadPool;

use super::check::threads;
use super::run::light_of;
use crate::diagnostic::{Diagnostic, FRAMES, Outcome, Result, bail, usage};
use crate::engine::{Engine, FrameLight, Stages, Texels, light_of_unseen};
use crate::job::options::write_options;
use crate::job::{Content, ConvertJob, Purpose, files_read};
use crate::settings::{Conversion, LightNormalisation, LightSettings};

/// Picture whose format keeps all light: none is written.
const ANY_PICTURE: &str = "light.exr";

/// Light of one world, for what is no picture of it: its spherical harmonics, or things that it lights.
///
/// ```
/// use cosmorama_convert::Conversion;
/// use cosmorama::lighting::HarmonicBasis;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let sky = folder.path().join("sky.png").display().to_string();
/// let picture = Conversion::new("builtin:grid", &sky).to("equirect".parse()?).size("64".parse()?);
/// picture.check().result?.run(&mut cosmorama_convert::Quiet)?;
/// let light = Conversion::new(&sky, "").check_light().result?;
/// let (harmonics, _) = light.harmonics(2, HarmonicBasis::YUp)?;
/// assert_eq!(harmonics.coefficients().len(), 9);
/// # Ok(())
/// # }
/// ```
pub struct WorldLight {
    settings: Conversion,
    job: ConvertJob,
    pool: ThreadPool,
    files: HashSet<PathBuf>,
}

/// A world that has been read, of a stereo pair the left eye's.
#[derive(Debug)]
pub struct Radiance {
    /// Its views.
    pub world: World,
    /// Their light.
    pub light: Light,
    /// Light of directions that no view shows, if there are any.
    pub unseen: Option<Rgba>,
    /// Primaries of the light.
    pub primaries: Primaries,
    /// Diagnostics of the light.
    pub diagnostics: Vec<Diagnostic>,
}

impl Conversion {
    /// Checks the settings of an input whose light is wanted, not a picture of it: the output is not looked at.
    ///
    /// Only headers are read, and pixels only where nothing else tells the projection.
    pub fn check_light(self) -> Outcome<WorldLight> {
        let mut diagnostics = Vec::new();
        let light = LightSettings::map(Lobe::LAMBERT, LightNormalisation::Radiance);
        let output = ANY_PICTURE.to_owned();
        let settings = Self { output, depth: Some(Depth::Float), light: Some(light), ..self };
        Outcome { result: WorldLight::of(settings, &mut diagnostics), diagnostics }
    }
}

impl WorldLight {
    fn of(settings: Conversion, diagnostics: &mut Vec<Diagnostic>) -> Result<Self> {
        let content = Content::of(&settings)?;
        let pool = threads(settings.limits.threads)?;
        let job = pool.install(|| ConvertJob::resolve(&settings, (content, Purpose::Light), diagnostics))?;
        if job.outputs.frames.len() > 1 {
            return Err(usage(format!(
                "{} has {} frames, but one world is wanted; choose a frame, as in {FRAMES} {}",
                settings.input,
                job.outputs.frames.len(),
                job.outputs.frames[0].frame.unwrap_or_default()
            )));
        }
        let files = files_read(&job.input, &settings.geometry);
        Ok(Self { settings, job, pool, files })
    }

    /// Returns the files that are read, by their real paths.
    pub fn files(&self) -> &HashSet<PathBuf> {
        &self.files
    }

    /// Reads the light and sums its harmonics over all texels. Also returns what there is to say about the light.
    ///
    /// # Errors
    /// When a file cannot be read, its content contradicts its header, or there are no harmonics of this order.
    pub fn harmonics(&self, order: usize, basis: HarmonicBasis) -> Result<(Harmonics, Vec<Diagnostic>)> {
        self.pool.install(|| {
            let (light, diagnostics) = self.read()?;
            let (world, texels) = self.first(&light)?;
            let is_complete = AllTexels::of_texels(world, texels).is_complete();
            let unseen = light_of_unseen(&self.job, is_complete)?;
            match Harmonics::of_texels(world, (texels, unseen), order, basis) {
                Ok(harmonics) => Ok((harmonics, diagnostics)),
                Err(error) => Err(usage(format!("{error}"))),
            }
        })
    }

    /// Reads the light. What no view covers is filled as the settings say.
    ///
    /// # Errors
    /// When a file cannot be read, or its content contradicts its header.
    pub fn radiance(&self) -> Result<Radiance> {
        self.pool.install(|| {
            let (light, diagnostics) = self.read()?;
            let (world, texels) = self.first(&light)?;
            let is_complete = AllTexels::of_texels(world, texels).is_complete();
            let unseen = light_of_unseen(&self.job, is_complete)?;
            let unseen = (!is_complete).then_some(unseen);
            let Ok(light) = Light::new(world, texels.to_vec()) else { bail!("the light is not that of the views") };
            let primaries = self.job.light.working.primaries;
            Ok(Radiance { world: world.clone(), light, unseen, primaries, diagnostics })
        })
    }

    /// Reads the frame's files.
    fn read(&self) -> Result<(FrameLight, Vec<Diagnostic>)> {
        let Self { settings, job, .. } = self;
        let options = write_options(settings, job.target.format, &job.outputs, &job.light);
        let Ok(engine) = Engine::new(job, options, &|_: f64| ControlFlow::Continue(())) else {
            bail!("the light was not read: stopped")
        };
        let Some(frame) = job.outputs.frames.first() else { bail!("no frame to read") };
        let light = light_of(job, &engine, &Stages::default(), frame)?;
        let diagnostics = engine.warnings(frame.frame, &light).into_iter().chain(engine.continuity(&light)).collect();
        Ok((light, diagnostics))
    }

    /// Returns the world, of a stereo pair the left eye's, with its light.
    fn first<'a>(&'a self, light: &'a FrameLight) -> Result<(&'a World, &'a [Rgba])> {
        match (self.job.worlds.first(), light.texels()) {
            (Some(world), Texels::Float(lights)) => Ok((world, &lights[0])),
            _ => bail!("light of 8 bits where floats were expected"),
        }
    }
}
