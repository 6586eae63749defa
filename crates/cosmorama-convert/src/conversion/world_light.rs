use std::collections::HashSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use cosmorama::lighting::{
    AllTexels, ColourTable, HarmonicAccuracy, HarmonicBasis, HarmonicFunctions, HarmonicWindow, Harmonics,
    LightFigures, Lobe, LobeAverages, Suns, TableAngle,
};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Primaries, Rgba, Transfer};
use cosmorama::sphere::{Direction, Orientation};
use cosmorama::world::{Light, World};
use cosmorama_io::{EnvMap, Format, Metadata, WriteOptions, write};
use rayon::ThreadPool;

use super::check::threads;
use super::run::light_of;
use crate::diagnostic::{Code, Diagnostic, FRAMES, Outcome, Result, TO, bail, usage};
use crate::engine::warnings::Tally;
use crate::engine::{Engine, FrameLight, Stages, Texels, WriterOptions, light_of_unseen};
use crate::job::options::write_options;
use crate::job::{Content, ConvertJob, Purpose, files_read};
use crate::settings::{Conversion, LightNormalisation, LightSettings};

/// Light of one world, for what is no picture of it: harmonics, a table of its colours, its suns, or things that it lights.
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
/// let (found, _) = light.harmonics((2, HarmonicBasis::YUp), None)?;
/// assert_eq!(found.harmonics.coefficients().len(), 9);
/// assert!(found.accuracy.irradiance.rms_error < found.accuracy.radiance.rms_error);
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

/// Harmonics of a world's radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldHarmonics {
    /// Coefficients.
    pub harmonics: Harmonics,
    /// Part of the light that they miss.
    pub accuracy: HarmonicAccuracy,
    /// Mean of their radiance over the sphere.
    pub mean: [f64; 3],
    /// Figures of the light itself.
    pub light: LightFigures,
}

/// Suns and lamps of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldSuns {
    /// Suns and lamps, brightest first.
    pub suns: Suns,
    /// Figures of the light itself.
    pub light: LightFigures,
    /// Figures of the light without them, before any sample is cut.
    pub left: LightFigures,
    /// Samples of the picture without them that are cut, because they are brighter than its file can say.
    pub overflowed: usize,
}

/// Colours of a world by one angle.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldTable {
    /// Colours.
    pub table: ColourTable,
    /// Figures of the light itself.
    pub light: LightFigures,
}

impl Conversion {
    /// Checks the settings of an input whose light is wanted, not a picture of it: the output is not looked at.
    ///
    /// Only headers are read, and pixels only where nothing else tells the projection.
    pub fn check_light(self) -> Outcome<WorldLight> {
        let mut diagnostics = Vec::new();
        let light = LightSettings::map(Lobe::LAMBERT, LightNormalisation::Radiance);
        let settings = Self { depth: Some(Depth::Float), light: Some(light), ..self };
        Outcome { result: WorldLight::of(settings, &mut diagnostics), diagnostics }
    }
}

impl WorldLight {
    pub(super) fn of(settings: Conversion, diagnostics: &mut Vec<Diagnostic>) -> Result<Self> {
        let content = Content::of(&settings)?;
        let pool = threads(settings.limits.threads)?;
        let resolve =
            || ConvertJob::resolve(&settings, (content, Purpose::Light), (diagnostics, &|_| ControlFlow::Continue(())));
        let job = pool.install(resolve)?;
        if job.outputs.are_many() {
            let count = job.outputs.count().map_or("any number of".to_owned(), |count| count.to_string());
            return Err(usage(format!(
                "{} has {count} frames, but one world is wanted; choose a frame, as in {FRAMES} {}",
                settings.input,
                job.outputs.frames[0].frame.unwrap_or_default()
            )));
        }
        let files = files_read((&job.input, None), &settings.geometry);
        Ok(Self { settings, job, pool, files })
    }

    /// Returns the threads that read it.
    pub(super) fn pool(&self) -> &ThreadPool {
        &self.pool
    }

    /// Returns its pixels per radian, of the finest view.
    pub(super) fn pixels_per_radian(&self) -> f64 {
        self.job.input.pixels_per_radian()
    }

    /// Returns the files that are read, by their real paths.
    pub fn files(&self) -> &HashSet<PathBuf> {
        &self.files
    }

    /// Reads the light and sums its harmonics over all texels, weakened by a window if one is given. Also returns what there is to say
    /// about the light.
    ///
    /// # Errors
    /// When a file cannot be read, its content contradicts its header, or there are no harmonics of this order.
    pub fn harmonics(
        &self,
        (order, basis): (usize, HarmonicBasis),
        window: Option<HarmonicWindow>,
    ) -> Result<(WorldHarmonics, Vec<Diagnostic>)> {
        self.pool.install(|| {
            let (light, diagnostics) = self.read()?;
            let (world, shown) = self.shown(&light)?;
            let exact = Harmonics::of_texels(world, shown, order, basis).map_err(|error| usage(format!("{error}")))?;
            let harmonics = window.map_or_else(|| exact.clone(), |window| exact.windowed(window));
            let accuracy = HarmonicAccuracy::of(world, shown, &exact, &harmonics);
            // The function of order 0 is the same everywhere, and the means of all others are 0.
            let constant = HarmonicFunctions::new(0, basis).at(Direction::FRONT)[0];
            let mean = harmonics.coefficients()[0].map(|light| constant * light);
            Ok((WorldHarmonics { harmonics, accuracy, mean, light: LightFigures::of(world, shown.0) }, diagnostics))
        })
    }

    /// Averages the light by one angle, over bands of equal width. Also returns what there is to say about the light.
    ///
    /// # Errors
    /// When a file cannot be read, its content contradicts its header, or there is no table of so many colours.
    pub fn colour_table(&self, axes: (TableAngle, Orientation), count: usize) -> Result<(WorldTable, Vec<Diagnostic>)> {
        self.pool.install(|| {
            let (light, diagnostics) = self.read()?;
            let (world, shown) = self.shown(&light)?;
            match ColourTable::of_texels(world, shown, axes, count) {
                Ok(table) => Ok((WorldTable { table, light: LightFigures::of(world, shown.0) }, diagnostics)),
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
            let texels = light.into_floats().into_iter().next().unwrap_or_default();
            let Ok(light) = Light::new(world, texels) else { bail!("the light is not that of the views") };
            let primaries = self.job.light.working.primaries;
            Ok(Radiance { world: world.clone(), light, unseen, primaries, diagnostics })
        })
    }

    /// Checks that a picture without suns can be written to a file.
    ///
    /// # Errors
    /// When the input is more than one picture, or the file's extension is that of no picture.
    pub fn check_picture(&self, path: &Path) -> Result<()> {
        let views: usize = self.job.worlds.iter().map(|world| world.sources().len()).sum();
        if path.to_string_lossy().contains(FACE) {
            return Err(usage(format!(
                "{} has {FACE}, but light is taken out of single pictures; name one file, and make faces of it with convert",
                path.display()
            )));
        }
        if views != 1 {
            return Err(usage(format!(
                "{} has {views} views, and light is taken out of single pictures; make one of it first, with convert and {TO} equirect",
                self.settings.input
            )));
        }
        let format = path.extension().and_then(|extension| Format::of_extension(&extension.to_string_lossy()));
        match format {
            Some(format) if format != Format::Exr && self.job.input.envmap() == Some(EnvMap::LatLong) => {
                Err(usage(format!(
                    "{} is {format}, but only OpenEXR can say that samples lie on the edges, as those of {} do; name the picture .exr",
                    path.display(),
                    self.settings.input
                )))
            }
            Some(format) if !format.is_cube_map() => Ok(()),
            _ => Err(usage(format!("{}: name the picture .exr, .hdr, .png or .tif", path.display()))),
        }
    }

    /// Finds suns and lamps, and writes the picture without them to a file if one is given. Also returns what there is to say about
    /// the light.
    ///
    /// # Errors
    /// When a file cannot be read, its content contradicts its header, or the picture cannot be written.
    pub fn suns(&self, without: Option<&Path>) -> Result<(WorldSuns, Vec<Diagnostic>)> {
        self.pool.install(|| {
            let (light, mut diagnostics) = self.read()?;
            let (world, texels) = self.first(&light)?;
            let figures = LightFigures::of(world, texels);
            if figures.shown <= 0.0 {
                bail!(NotANumber: "{}: no pixel is a number; render it again", self.settings.input);
            }
            let suns = Suns::find(world, texels);
            let left = suns.without(texels);
            let mut found = WorldSuns { light: figures, left: LightFigures::of(world, &left), suns, overflowed: 0 };
            if let Some(path) = without {
                self.check_picture(path)?;
                found.overflowed = self.write(path, (world, left))?;
                diagnostics.extend(too_bright(path, found.overflowed));
            }
            Ok((found, diagnostics))
        })
    }

    /// Writes the light of a single picture. Returns the number of samples that are cut.
    fn write(&self, path: &Path, (world, texels): (&World, Vec<Rgba>)) -> Result<usize> {
        let view = &world.sources()[0].view;
        let format = Format::from_extension(path)?;
        let depth = format.depths().last().copied().unwrap_or(Depth::Eight);
        let transfer = if depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
        let is_opaque = texels.iter().all(|texel| texel.alpha() >= 1.0);
        let channels = format.nearest_channels(if is_opaque { Channels::Rgb } else { Channels::Rgba });
        let most = |texel: &Rgba| ROUNDING * depth.most() * texel.alpha();
        let cut = |texel: &Rgba| texel.0[..3].iter().filter(|light| **light > most(texel)).count();
        let overflowed = texels.iter().map(cut).sum();
        let Ok(image) = Image::new(view.width(), view.height(), texels) else {
            bail!("light of another size than its view")
        };
        let encoded = EncodedImage::encode(&image, channels, depth, &transfer);
        let envmap = self.job.input.envmap();
        let options = write_options(&self.settings, format, &self.job.outputs, &self.job.light);
        let metadata = Metadata { transfer: Some(transfer), envmap, remarks: Vec::new(), ..options.metadata };
        write(path, &encoded, &WriteOptions { metadata, ..options })?;
        Ok(overflowed)
    }

    /// Returns the first world with its light, and the light of what it does not show.
    fn shown<'a>(&'a self, light: &'a FrameLight) -> Result<(&'a World, (&'a [Rgba], Rgba))> {
        let (world, texels) = self.first(light)?;
        let is_complete = AllTexels::of_texels(world, texels).is_complete();
        Ok((world, (texels, light_of_unseen(&self.job, is_complete)?)))
    }

    /// Reads the frame's files.
    fn read(&self) -> Result<(FrameLight, Vec<Diagnostic>)> {
        let Self { settings, job, .. } = self;
        let files = write_options(settings, job.target.format, &job.outputs, &job.light);
        let options = WriterOptions { files, ..WriterOptions::default() };
        let Ok(engine) = Engine::new(job, options, &|_: f64| ControlFlow::Continue(())) else {
            bail!("the light was not read: stopped")
        };
        let Some(frame) = job.outputs.frames.first() else { bail!("no frame to read") };
        let light = light_of(job, &engine, &Stages::default(), frame)?;
        let mut tally = Tally::default();
        tally.add(job, frame.frame, &light);
        let told = engine.warnings(frame.frame, &light).into_iter().chain(engine.continuity(&light));
        let diagnostics = told.chain(tally.warnings(job)).collect();
        Ok((light, diagnostics))
    }

    /// Returns the world, of a stereo pair the left eye's, with its light.
    fn first<'a, 'l>(&'a self, light: &'l FrameLight) -> Result<(&'a World, &'l [Rgba])> {
        match (self.job.worlds.first(), light.texels()) {
            (Some(world), Texels::Float(lights)) => Ok((world, &lights[0])),
            _ => bail!("light of 8 bits where floats were expected"),
        }
    }
}

/// Part of the brightest code that rounding forgives.
const ROUNDING: f32 = 1.002;

/// Place in a name where those of faces stand.
const FACE: &str = "{face}";

/// Returns the warning about light that a picture's samples cannot hold.
fn too_bright(path: &Path, samples: usize) -> Option<Diagnostic> {
    let path = path.display();
    let are = if samples == 1 { "sample is" } else { "samples are" };
    let message =
        format!("{path}: {samples} {are} brighter than it can say, and cut to white; write OpenEXR or Radiance");
    (samples > 0).then(|| Diagnostic::warning(Code::TooBright, message).about(&path))
}
