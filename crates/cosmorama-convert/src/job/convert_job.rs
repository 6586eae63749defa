use std::path::Path;
use std::sync::Arc;

use cosmorama::filter::{FilterSettings, Kernel};
use cosmorama::lighting::PreparedLight;
use cosmorama::raster::Rgba;
use cosmorama::render::Resampler;
use cosmorama::world::World;
use cosmorama_io::{Choice, Format};
use cosmorama_spec::Missing;

use super::Content;
use super::memory_needs::gathered_bytes;
use super::options::{check_file_options, filter};
use crate::colour::{LayerPlan, Light, check_choice, check_labels};
use crate::detect::unless_damaged;
use crate::diagnostic::{Diagnostic, Result};
use crate::input::Input;
use crate::input::spec_files::st_map::settled;
use crate::job::Outputs;
use crate::job::coverage::{Coverage, whole_worlds};
use crate::settings::{Conversion, LightSettings};
use crate::source::{Access, ChosenFiles, DecodedPicture, Files, MemoryBudget};
use crate::target::{Target, TargetView, name_of_level, of_light, shape_warning};

/// A conversion, ready to run.
pub(crate) struct ConvertJob {
    /// Source of the bytes of inputs.
    pub(crate) files: Arc<dyn Files>,
    /// Input; empty for a formula.
    pub(crate) input: Input,
    /// Geometry of the input: one world, or one for each eye.
    pub(crate) worlds: Vec<World>,
    /// Pictures to make.
    pub(crate) target: Target,
    /// Filter.
    pub(crate) filter: FilterSettings,
    /// Transfer functions of both sides, and the outputs' channels and depth.
    pub(crate) light: Light,
    /// Further channels that the outputs get.
    pub(crate) layers: LayerPlan,
    /// Outputs to make, by frame.
    pub(crate) outputs: Outputs,
    /// Treatment of pixels that no view covers.
    pub(crate) coverage: Coverage,
    /// Map of light that is made instead of a picture.
    pub(crate) lighting: Option<LightSettings>,
    /// Requested treatment of directions without light.
    missing: Missing,
    /// Memory budget.
    pub(crate) memory: MemoryBudget,
    /// A picture that has been decoded to see what it is.
    pub(crate) decoded: DecodedPicture,
}

/// Purpose of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Pictures, in files.
    Pictures,
    /// The light of the input alone: nothing is written.
    Light,
}

/// Part of the memory, at most, that a picture decoded beforehand takes.
const DECODED_PART: u64 = 8;

/// Returns the source of a conversion's files, which knows the parts and channels to read.
fn chosen(settings: &Conversion, content: Content) -> Arc<dyn Files> {
    let (part, channels) = (settings.part.clone(), settings.channels.clone());
    let is_exr = Format::from_extension(Path::new(&settings.output)).is_ok_and(|format| format == Format::Exr);
    let without_picture = content == Content::World && is_exr && settings.light.is_none();
    Arc::new(ChosenFiles { files: Arc::clone(&settings.files), choice: Choice { part, channels, without_picture } })
}

impl ConvertJob {
    /// Resolves the settings and checks everything that can be checked without decoding pixels.
    pub(crate) fn resolve(
        settings: &Conversion,
        (content, purpose): (Content, Purpose),
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let memory = MemoryBudget::new(settings.limits.memory);
        let file = content.has_files().then_some(settings.input.as_str());
        let decoded = DecodedPicture::up_to(memory.bytes / DECODED_PART);
        let files = chosen(settings, content);
        let access = Access { files: &*files, memory, decoded: &decoded };
        let mut geometry = settled(&settings.geometry, file, access, warnings)?;
        let mut output = settings.output.clone();
        let levels = settings.light.as_ref().map_or(1, |light| light.levels.len());
        if settings.light.is_some() {
            output = name_of_level(&output, 0);
            geometry = of_light(geometry, &output, levels);
        }
        let geometry = &geometry;
        // Mistakes in the settings themselves come first: they do not depend on any file.
        let format = Target::check_names(&output, geometry)?;
        check_file_options(settings, format)?;
        let mut input = content.input(settings, geometry, access, warnings)?;
        let parity = content.has_files().then(|| input.pixels_per_radian());
        let mut target = Target::resolve(&output, geometry, parity)?;
        if settings.mips {
            target = target.with_mips(&settings.output, geometry)?;
        }
        if levels > 1 {
            target = target.with_chain(&settings.output, geometry, levels)?;
        }
        warnings.extend(input.diagnostics());
        check_choice(settings, &input, warnings)?;
        warnings.extend(shape_warning(geometry, &target));
        content.fit_eyes(&mut input, &target, warnings);
        let mut filter = if content.has_files() { filter(geometry, warnings) } else { FilterSettings::DEFAULT };
        if settings.light.is_some() {
            // The mirror level of a chain must keep the light of suns.
            filter = FilterSettings { kernel: Kernel::LIGHT, anti_ringing: false, ..filter };
        }
        let mut light = Light::resolve(settings, &input, &target, warnings)?;
        let layers = if content == Content::World && settings.light.is_none() {
            LayerPlan::resolve(settings, (&input, &target, &light), &mut filter, warnings)?
        } else {
            LayerPlan::default()
        };
        check_labels(&filter, &input, &light, target.format)?;
        content.settle(settings, &target, &mut light, warnings)?;
        memory.check_outputs(&target)?;
        let outputs = match purpose {
            Purpose::Pictures => Outputs::plan(settings, &input, &target, (&light, &layers), memory)?,
            Purpose::Light => Outputs::none(&input),
        };
        warnings.extend(outputs.warning());
        let missing = match settings.missing {
            Missing::Fill(colour) => Missing::Fill(light.working.colour(colour)),
            Missing::Error => Missing::Error,
        };
        let mut job = Self {
            files,
            input,
            worlds: Vec::new(),
            target,
            filter,
            light,
            layers,
            outputs,
            coverage: Coverage::Complete,
            lighting: settings.light.clone(),
            missing,
            memory,
            decoded,
        };
        if content.has_files() {
            let first = job.input.frames.first().map_or_else(Vec::new, |frame| job.input.paths(*frame));
            let files = Arc::clone(&job.files);
            job.cover(warnings).map_err(|error| unless_damaged(&*files, first, error))?;
        }
        content.check_last(settings, format, job.light.depth, warnings)?;
        Ok(job)
    }

    /// Checks that the input covers the output, and that memory suffices.
    fn cover(&mut self, warnings: &mut Vec<Diagnostic>) -> Result<()> {
        let Self { input, target, filter, memory, .. } = self;
        let whole = whole_worlds(input, *memory)?;
        if let Some(lighting) = &self.lighting {
            let (coverage, worlds) = Coverage::of_sphere(input, whole, self.missing)?;
            memory.check_frame(input, target)?;
            let blocks: u64 = worlds.iter().flat_map(World::sources).map(|source| gathered_bytes(&source.view)).sum();
            let bands = PreparedLight::bytes_for(&lighting.lobes()) as u64 * worlds.len() as u64;
            self.memory = memory.beside_levels(blocks.saturating_add(bands), input, target)?;
            (self.coverage, self.worlds) = (coverage, worlds);
            return Ok(());
        }
        let (coverage, worlds) = Coverage::check(input, whole, target, filter, self.missing, warnings)?;
        memory.check_frame(input, target)?;
        let levels = target.views.iter().map(|view| {
            let world = &worlds[view.world(worlds.len())];
            Resampler { world, target: &view.view, filter: *filter }.level_bytes() as u64
        });
        let memory = memory.beside_levels(levels.max().unwrap_or(0), input, target)?;
        self.memory = memory.beside_channels(&mut self.layers, input, target)?;
        (self.coverage, self.worlds) = (coverage, worlds);
        Ok(())
    }

    /// Returns the resampler for one of the target's views.
    pub(crate) fn resampler<'a>(&'a self, target: &'a TargetView) -> Resampler<'a> {
        Resampler { world: self.world(target), target: &target.view, filter: self.filter }
    }

    /// Returns the world that a target shows.
    pub(crate) fn world(&self, target: &TargetView) -> &World {
        &self.worlds[target.world(self.worlds.len())]
    }

    /// Returns the fill colour of pixels without light; `None` if they are an error.
    pub(crate) fn fill_for_missing(&self) -> Option<Rgba> {
        match self.missing {
            Missing::Error => None,
            Missing::Fill(colour) => Some(colour),
        }
    }
}
