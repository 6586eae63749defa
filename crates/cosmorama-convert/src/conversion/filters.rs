use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::compare::CompareError;
use cosmorama::filter::{Filter, FilterKind, FilterSettings, Kernel, SetupCost};
use cosmorama::laboratory::{Laboratory, Response, Row, busiest, sheet};
use cosmorama::lighting::Lobe;
use cosmorama::raster::{ColourMatrix, Depth, Image, Primaries, Rgba};
use cosmorama::render::{Progress, Share, Stopped};
use cosmorama_io::{Choice, Limits};
use cosmorama_spec::{FilterName, Missing};
use cpu_time::ProcessTime;

use super::world_light::WorldLight;
use super::{Observer, Radiance, Work, watched};
use crate::colour::InputTransfer;
use crate::diagnostic::{ConvertError, Diagnostic, Outcome, Result, SIZE, TO, usage};
use crate::input::Builtin;
use crate::input::spec_files::st_map::settled;
use crate::settings::{Conversion, LightNormalisation, LightSettings};
use crate::source::{Access, ChosenFiles, DecodedPicture, MemoryBudget, read};
use crate::target::Picture;

/// One conversion, checked, on which filters are to be measured.
pub struct FilterTrials {
    settings: Conversion,
    input: WorldLight,
    view: View,
    memory: MemoryBudget,
}

/// Measured properties of a filter on one conversion.
#[derive(Clone, Debug)]
pub struct FilterTrial {
    /// Filter.
    pub filter: FilterName,
    /// PSNR of linear light against the reference filter by the same kernel, in decibels: a Gaussian or a box, where the filter
    /// is made for that, and else the kernel of the settings. Infinite for that reference itself.
    pub to_reference: f64,
    /// PSNR of linear light against a direct render, in decibels.
    pub to_truth: Option<f64>,
    /// Aliasing and blur.
    pub response: Response,
    /// Processor seconds of the picture, summed over all threads, with the filter's preparation.
    pub cpu_seconds: f64,
    /// Processor seconds of the preparation alone.
    pub setup_seconds: f64,
    /// Cost of the preparation in texels and bytes.
    pub setup: SetupCost,
    /// Mean number of texels, or of entries of tables, that are read for a pixel.
    pub reads: f64,
}

/// Result of all trials.
pub struct FilterReport {
    /// Filters, in the order in which they were asked for.
    pub trials: Vec<FilterTrial>,
    /// Crops of the same places by each filter, side by side, in linear light. `None` of a picture that is too small for any.
    pub sheet: Option<Image<Rgba>>,
    /// Diagnostics of the input.
    pub diagnostics: Vec<Diagnostic>,
}

/// Places of which crops are shown.
const PLACES: usize = 4;

impl Conversion {
    /// Checks the settings of a conversion on which filters are to be compared: the output is not looked at.
    ///
    /// Only headers are read, and pixels only where nothing else tells the projection.
    pub fn check_filters(self) -> Outcome<FilterTrials> {
        let mut diagnostics = Vec::new();
        let result = self.filter_trials(&mut diagnostics);
        Outcome { result, diagnostics }
    }

    fn filter_trials(self, diagnostics: &mut Vec<Diagnostic>) -> Result<FilterTrials> {
        if Builtin::named(&self.input)?.is_some() {
            return Err(usage(format!(
                "{} is a formula: it has no texels to filter; convert it to a picture first",
                self.input
            )));
        }
        if self.geometry.to.is_none() {
            return Err(usage(format!(
                "{TO} is missing: say which projection the pictures are to have, as in {TO} omnimax"
            )));
        }
        // Read as light, all of it, in floats; parts that no view shows are left out of the figures.
        let light = LightSettings::map(Lobe::LAMBERT, LightNormalisation::Radiance);
        let settings =
            Self { depth: Some(Depth::Float), light: Some(light), missing: Missing::Fill(Rgba::TRANSPARENT), ..self };
        let input = WorldLight::of(settings.clone(), diagnostics)?;
        let memory = MemoryBudget::new(settings.limits.memory);
        let view = target(&settings, memory, input.pixels_per_radian())?;
        memory.check_picture((view.width(), view.height()))?;
        Ok(FilterTrials { settings, input, view, memory })
    }
}

/// Returns the one picture that is made.
fn target(settings: &Conversion, memory: MemoryBudget, parity: f64) -> Result<View> {
    let files = ChosenFiles::new(Arc::clone(&settings.files), Choice::default(), settings.video.damaged);
    let access = Access { files: &files, memory, decoded: &DecodedPicture::default() };
    let geometry = settled(&settings.geometry, Some(&settings.input), access, &mut Vec::new())?;
    match &Picture::all(&geometry, None, Some(parity))?[..] {
        [picture] => Ok(picture.view.clone()),
        several => Err(usage(format!(
            "{TO} makes {} pictures, but filters are compared on one; choose a projection of one picture, as in {TO} perspective:fov=90",
            several.len()
        ))),
    }
}

impl FilterTrials {
    /// Returns the files that are read, by their real paths.
    pub fn files(&self) -> &HashSet<PathBuf> {
        self.input.files()
    }

    /// Measures filters, while an observer is told how far it is.
    ///
    /// # Errors
    /// When a file cannot be read, the direct render has another size, a filter needs more memory than permitted, or the
    /// observer stops the work.
    pub fn run(
        &self,
        filters: &[FilterName],
        truth: Option<&Path>,
        observer: &mut dyn Observer,
    ) -> Result<FilterReport> {
        observer.begin(Some(1));
        let Radiance { world, light, primaries, diagnostics, .. } = self.input.radiance()?;
        let laboratory = Laboratory::bytes(&world, &self.view) as u64;
        let pixels = format!("; the picture has {}x{} pixels", self.view.width(), self.view.height());
        self.memory.allow(laboratory, "what filters are measured by", &pixels)?;
        let memory = self.memory.beside(laboratory);
        for filter in filters {
            self.filter(*filter).check(&world).map_err(|error| usage(format!("{filter}: {error}")))?;
            let bytes = self.filter(*filter).setup(&world).bytes as u64;
            memory.allow(bytes, &format!("the filter {filter}"), "; leave it out of those to compare")?;
        }
        let truth = truth.map(|file| self.truth(file, &primaries)).transpose()?;
        let measure = |progress: &dyn Progress| {
            let laboratory = Laboratory::new((&world, &light), &self.view);
            self.measure(&laboratory, (filters, truth.as_ref()), progress)
        };
        let done = watched(self.input.pool(), observer, Work::Filters, measure);
        let (trials, sheet) = done.ok_or(STOPPED)??;
        Ok(FilterReport { trials, sheet, diagnostics })
    }

    /// Returns a filter with the kernel of the settings.
    fn filter(&self, FilterName(kind): FilterName) -> FilterSettings {
        let (kernel, geometry) = (self.settings.geometry.kernel, &self.settings.geometry);
        FilterSettings {
            kind,
            kernel: kernel.kernel,
            anti_ringing: geometry.anti_ringing.unwrap_or(kernel.anti_ringing),
        }
    }

    /// Reads a direct render, in the primaries of the input.
    fn truth(&self, file: &Path, primaries: &Primaries) -> Result<Image<Rgba>> {
        let limits = Limits::memory(self.memory.bytes);
        let picture = read(&*self.settings.files, file, &limits)?;
        let transfer = InputTransfer::new(&self.settings.transfer, None).of(picture.image.depth(), &picture.metadata);
        let mut light = picture.image.to_light(&transfer);
        let own = picture.metadata.primaries.unwrap_or(Primaries::REC709);
        ColourMatrix::between(&own, primaries).convert(light.pixels_mut());
        let (size, view) = ((light.width(), light.height()), (self.view.width(), self.view.height()));
        if size != view {
            return Err(usage(format!(
                "{} has {}x{} pixels, but pictures of {}x{} are made; give {SIZE} {}x{}",
                file.display(),
                size.0,
                size.1,
                view.0,
                view.1,
                size.0,
                size.1
            )));
        }
        Ok(light)
    }

    fn measure(
        &self,
        laboratory: &Laboratory,
        (filters, truth): (&[FilterName], Option<&Image<Rgba>>),
        progress: &dyn Progress,
    ) -> Result<(Vec<FilterTrial>, Option<Image<Rgba>>)> {
        let tasks = filters.len() + 1;
        let share = |task: usize| {
            let at = |tasks_done: usize| tasks_done as f64 / tasks as f64;
            Share { whole: progress, from: at(task), to: at(task + 1) }
        };
        let own = self.filter(FilterName(FilterKind::Ewa));
        let mut references = References { laboratory, samples: laboratory.samples(), pictures: Vec::new() };
        let reference = references.of(&own, &share(0))?;
        let places = busiest(reference, |i, j| laboratory.is_whole(i, j), PLACES);
        let row = |label: &str, picture: &Image<Rgba>| Row::new(vec![label.to_owned()], picture, &places);
        let mut rows: Vec<Row> = truth.map(|truth| row("direct render", truth)).into_iter().collect();
        let is_shown = filters.iter().any(|filter| matches!(filter.0, FilterKind::Reference { .. }));
        rows.extend((!is_shown).then(|| row("reference", reference)));
        let mut trials = Vec::new();
        for (index, filter) in filters.iter().enumerate() {
            let (trial, picture) = self.trial(&mut references, *filter, truth, &share(index + 1))?;
            rows.push(Row::new(labels(&trial), &picture, &places));
            trials.push(trial);
        }
        Ok((trials, (!places.is_empty()).then(|| sheet(&rows))))
    }

    /// Measures one filter. Also returns its picture.
    fn trial(
        &self,
        references: &mut References,
        name: FilterName,
        truth: Option<&Image<Rgba>>,
        progress: &dyn Progress,
    ) -> Result<(FilterTrial, Image<Rgba>)> {
        let (filter, laboratory) = (self.filter(name), references.laboratory);
        let share = |from: f64, to: f64| Share { whole: progress, from, to };
        let start = ProcessTime::now();
        let prepared = filter.prepare(laboratory.world(), laboratory.light());
        let prepared = prepared.map_err(|error| usage(format!("{name}: {error}")))?;
        let (setup_seconds, reads) = (start.elapsed().as_secs_f64(), laboratory.reads(&*prepared));
        drop(prepared);
        let start = ProcessTime::now();
        let picture = laboratory.picture(&filter, &share(0.0, 0.4)).map_err(stopped)?;
        let cpu_seconds = start.elapsed().as_secs_f64();
        let response = laboratory.response(&filter, &share(0.4, 0.8)).map_err(stopped)?;
        let reference = references.of(&filter, &share(0.8, 1.0))?;
        let psnr = |to: &Image<Rgba>| laboratory.psnr(&picture, to).map_err(incomparable);
        let trial = FilterTrial {
            filter: name,
            to_reference: psnr(reference)?,
            to_truth: truth.map(psnr).transpose()?,
            response,
            cpu_seconds,
            setup_seconds,
            setup: filter.setup(laboratory.world()),
            reads,
        };
        Ok((trial, picture))
    }
}

/// Reference pictures by kernel, each made when the first filter with that kernel is judged.
struct References<'a> {
    laboratory: &'a Laboratory<'a>,
    /// Sub-samples along a pixel's side.
    samples: usize,
    pictures: Vec<(Kernel, Image<Rgba>)>,
}

impl References<'_> {
    /// Returns the reference by the kernel of a filter.
    fn of(&mut self, filter: &FilterSettings, progress: &dyn Progress) -> Result<&Image<Rgba>> {
        let judge = filter.judge(self.samples);
        let place = match self.pictures.iter().position(|(kernel, _)| *kernel == judge.kernel) {
            Some(place) => place,
            None => {
                let picture = self.laboratory.picture(&judge, progress).map_err(stopped)?;
                self.pictures.push((judge.kernel, picture));
                self.pictures.len() - 1
            }
        };
        Ok(&self.pictures[place].1)
    }
}

/// Error of work that the observer stopped.
const STOPPED: ConvertError = ConvertError::Stopped { done: 0, frames: Some(1) };

fn stopped(_: Stopped) -> ConvertError {
    STOPPED
}

fn incomparable(error: CompareError) -> ConvertError {
    usage(format!("filters cannot be compared: {error}"))
}

/// Returns the lines beside a filter's crops.
fn labels(trial: &FilterTrial) -> Vec<String> {
    let mut lines = vec![trial.filter.to_string()];
    lines.extend(trial.to_truth.map(|psnr| format!("direct {psnr:.2} dB")));
    lines.push(format!("reference {:.2} dB", trial.to_reference));
    lines.extend(trial.response.aliasing.map(|energy| format!("aliasing {energy:.1} dB")));
    lines.extend(trial.response.edge_width.map(|width| format!("edge {width:.2} px")));
    lines
}
