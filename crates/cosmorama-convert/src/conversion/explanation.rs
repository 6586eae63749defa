use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::explain;
use cosmorama::filter::FilterSettings;
use cosmorama::world::World;
use cosmorama_spec::Size;
use rayon::ThreadPool;

use super::check::threads;
use crate::diagnostic::{Code, Diagnostic, FROM, Outcome, Result, TO, usage, usage_as};
use crate::input::spec_files::st_map::settled;
use crate::input::{Builtin, Input, InputView};
use crate::job::coverage::whole_worlds;
use crate::job::files_read;
use crate::job::options::filter;
use crate::settings::{GeometrySettings, LimitSettings};
use crate::source::{Access, DecodedPicture, Disk, Files, MemoryBudget};
use crate::target::{Picture, aspect};

/// Settings of an explanation, possibly for an input that does not exist yet.
#[derive(Clone, Debug)]
pub struct ExplanationSettings {
    /// Input, if there is one.
    pub input: Option<String>,
    /// Assumed size of the input, or of each face, if it does not exist yet. By default, as fine as the output at its centre.
    pub input_size: Option<Size>,
    /// Projections, size, orientation and filter.
    pub geometry: GeometrySettings,
    /// Limits of threads and memory.
    pub limits: LimitSettings,
    /// Source of the bytes of inputs; disk by default.
    pub files: Arc<dyn Files>,
}

impl Default for ExplanationSettings {
    fn default() -> Self {
        Self {
            input: None,
            input_size: None,
            geometry: GeometrySettings::default(),
            limits: LimitSettings::default(),
            files: Arc::new(Disk),
        }
    }
}

/// Explanation of a conversion, picture by picture.
pub struct Explanation {
    input: Input,
    pictures: Vec<Picture>,
    filter: FilterSettings,
    memory: MemoryBudget,
    /// Files that are read, by their real paths.
    files: HashSet<PathBuf>,
    pool: ThreadPool,
}

impl ExplanationSettings {
    /// Finds the files and the pictures. The size of the output follows from an existing input; the size of an input
    /// that does not exist yet follows from the output.
    pub fn check(&self) -> Outcome<Explanation> {
        let mut diagnostics = Vec::new();
        let result = threads(self.limits.threads)
            .and_then(|pool| Ok((pool.install(|| self.resolve(&mut diagnostics))?, pool)))
            .map(|((input, pictures, filter), pool)| Explanation {
                files: files_read(&input, &self.geometry),
                memory: MemoryBudget::new(self.limits.memory),
                input,
                pictures,
                filter,
                pool,
            });
        Outcome { result, diagnostics }
    }

    fn resolve(&self, warnings: &mut Vec<Diagnostic>) -> Result<(Input, Vec<Picture>, FilterSettings)> {
        let memory = MemoryBudget::new(self.limits.memory);
        let access = Access { files: &*self.files, memory, decoded: &DecodedPicture::default() };
        let geometry = &settled(&self.geometry, self.input.as_deref(), access, warnings)?;
        if geometry.to.is_none() {
            let example = format!("{TO} omnimax");
            return Err(usage_as(
                Code::MissingSetting,
                format!("{TO} is missing: say which projection the output is to have, as in {example}"),
            ));
        }
        let (mut input, pictures) = self.find(geometry, access, warnings)?;
        warnings.extend(input.diagnostics());
        warnings.extend(pictures.first().and_then(|picture| aspect::warning(geometry, &picture.view)));
        input.fit_eyes(pictures.iter().any(|picture| picture.eye.is_some()), warnings);
        let filter = filter(&self.geometry, warnings);
        Ok((input, pictures, filter))
    }

    fn find(
        &self,
        geometry: &GeometrySettings,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(Input, Vec<Picture>)> {
        match (&self.input, &geometry.from) {
            (Some(pattern), _) if Builtin::named(pattern)?.is_some() => Err(usage(format!(
                "{pattern} is a formula: nothing is resampled, so there is nothing to explain; for its picture in a projection, \
                 explain {FROM} SPEC"
            ))),
            (Some(pattern), from) => {
                let input = Input::find(pattern, from.as_ref(), None, access, warnings)?;
                let pictures = Picture::all(geometry, None, Some(input.pixels_per_radian()))?;
                Ok((input, pictures))
            }
            (None, Some(from)) => {
                let own = match self.input_size {
                    Some(_) => Some(Input::planned(from, self.input_size, 0.0)?.pixels_per_radian()),
                    None => None,
                };
                let pictures = Picture::all(geometry, None, own)?;
                let centre = pictures.first().map_or(1.0, |picture| picture.view.pixels_per_radian());
                Ok((Input::planned(from, self.input_size, centre)?, pictures))
            }
            (None, None) => {
                Err(usage_as(Code::MissingSetting, format!("give an input, or {FROM} for one that does not exist yet")))
            }
        }
    }
}

impl Explanation {
    /// Returns the pictures that would be made.
    pub fn pictures(&self) -> &[Picture] {
        &self.pictures
    }

    /// Returns the files that are read, by their real paths.
    pub fn files(&self) -> &HashSet<PathBuf> {
        &self.files
    }

    /// Computes the worlds of whole pictures, even if files are missing: one, or one for each eye.
    ///
    /// # Errors
    /// When they or the pictures need more memory than permitted, or the views do not make a world.
    pub fn worlds(&self) -> Result<Vec<World>> {
        self.memory.check_sizes(self.pictures.iter().map(|picture| (picture.view.width(), picture.view.height())))?;
        self.pool.install(|| whole_worlds(&self.input, self.memory))
    }

    /// Explains one of the pictures.
    pub fn report(&self, worlds: &[World], picture: &Picture) -> explain::Report {
        let world = &worlds[picture.world(worlds.len())];
        self.pool.install(|| explain::Report::of(world, &picture.view, &self.filter))
    }

    /// Returns the views that have no file yet.
    pub fn views_without_files(&self) -> impl Iterator<Item = &InputView> {
        self.input.views().filter(|view| view.window.is_none())
    }
}
