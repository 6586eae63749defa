//! What a conversion would do and cost, without doing it.

mod cost;

pub use cost::{CostedFiles, CostedMemory, SequenceCost};

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::explain;
use cosmorama::filter::FilterSettings;
use cosmorama::render::{Progress, Share};
use cosmorama::world::World;
use cosmorama_io::{Choice, FrameList};
use cosmorama_spec::Size;
use rayon::ThreadPool;

use super::advance::watched;
use super::check::threads;
use super::run::stopped;
use super::{Observer, Work};
use crate::diagnostic::{Code, Diagnostic, FROM, NEAREST, Outcome, Result, TO, TRAVEL, usage, usage_as};
use crate::input::spec_files::st_map::settled;
use crate::input::{Builtin, Input, InputView};
use crate::job::coverage::{check_pictures, whole_worlds};
use crate::job::files_read;
use crate::job::gaps::{Shot, find_gaps};
use crate::job::options::filter;
use crate::settings::{GeometrySettings, LimitSettings};
use crate::source::video::DamagedFrames;
use crate::source::{Access, ChosenFiles, DecodedPicture, Disk, Files, MemoryBudget, Name, wanted_frames};
use crate::target::{Movement, Picture, TargetView, aspect, time};

/// Settings of an explanation, possibly for an input that does not exist yet.
#[derive(Clone, Debug)]
pub struct ExplanationSettings {
    /// Input, if there is one.
    pub input: Option<Name>,
    /// Assumed size of the input, or of each face, if it does not exist yet. By default, as fine as the output at its centre.
    pub input_size: Option<Size>,
    /// Projections, size, orientation and filter. Of a moving camera, pictures are those of the first frame.
    pub geometry: GeometrySettings,
    /// Frames, of a moving camera or of the show whose costs are told; those of its path or of the input, unless given.
    pub frames: Option<FrameList>,
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
            frames: None,
            limits: LimitSettings::default(),
            files: Arc::new(Disk),
        }
    }
}

/// Explanation of a conversion, picture by picture.
pub struct Explanation {
    input: Input,
    pictures: Vec<Picture>,
    /// Movement of the camera, with the views that it moves.
    movement: Option<(Movement, Vec<TargetView>)>,
    /// Whether the input exists, so that it may lack something.
    has_input: bool,
    /// Frames that were asked for.
    asked_frames: Option<FrameList>,
    filter: FilterSettings,
    pub(super) memory: MemoryBudget,
    /// Files that are read, by their real paths.
    files: HashSet<PathBuf>,
    pub(super) pool: ThreadPool,
}

/// Explanation of a moving camera's path.
pub struct PathExplanation {
    /// Frames.
    pub frames: FrameList,
    /// Share of the world that is seen, and suitable sizes.
    pub report: explain::PathReport,
    /// Parts that the input lacks, with the frames that need them.
    pub gaps: Vec<String>,
    /// Views of each frame.
    pub views: Vec<Vec<View>>,
}

/// Input, pictures, movement and filter.
type Resolved = (Input, Vec<Picture>, Option<(Movement, Vec<TargetView>)>, FilterSettings);

impl ExplanationSettings {
    /// Finds the files and the pictures. The size of the output follows from an existing input; the size of an input
    /// that does not exist yet follows from the output.
    pub fn check(&self) -> Outcome<Explanation> {
        let mut diagnostics = Vec::new();
        let result = threads(self.limits.threads)
            .and_then(|pool| Ok((pool.install(|| self.resolve(&mut diagnostics))?, pool)))
            .map(|((input, pictures, movement, filter), pool)| Explanation {
                files: files_read((&input, None), &self.geometry),
                memory: MemoryBudget::new(self.limits.memory),
                has_input: self.input.is_some(),
                asked_frames: self.frames.clone(),
                input,
                pictures,
                movement,
                filter,
                pool,
            });
        Outcome { result, diagnostics }
    }

    fn resolve(&self, warnings: &mut Vec<Diagnostic>) -> Result<Resolved> {
        let memory = MemoryBudget::new(self.limits.memory);
        // A file without a picture, as of depth alone, can be converted, too.
        let choice = Choice { without_picture: true, ..Choice::default() };
        let files = ChosenFiles::new(Arc::clone(&self.files), choice, DamagedFrames::default());
        let access = Access { files: &files, memory, decoded: &DecodedPicture::default() };
        let geometry = &settled(&self.geometry, self.input.as_ref(), access, warnings)?;
        if geometry.to.is_none() {
            let example = format!("{TO} omnimax");
            return Err(usage_as(
                Code::MissingSetting,
                format!("{TO} is missing: say which projection the output is to have, as in {example}"),
            ));
        }
        let (mut input, mut pictures) = self.find(geometry, access, warnings)?;
        let movement = self.moved(geometry, (&mut input, &mut pictures), access, warnings)?;
        warnings.extend(input.diagnostics());
        warnings.extend(self.missing_frames(&input, access));
        warnings.extend(pictures.first().and_then(|picture| aspect::warning(geometry, &picture.view)));
        input.fit_eyes(pictures.iter().any(|picture| picture.eye.is_some()), warnings);
        input.narrow_to_files();
        let filter = filter(&self.geometry, warnings);
        Ok((input, pictures, movement, filter))
    }

    /// Returns a warning about frames that are asked for and do not exist. They may be made yet, so their cost is told, too.
    fn missing_frames(&self, input: &Input, access: Access) -> Option<Diagnostic> {
        let asked = self.frames.as_ref()?;
        let mut files = input.present().map(|(view, ..)| &view.files).filter(|files| files.has_frames());
        let missing = files.find_map(|files| wanted_frames::find(files, access.files, Some(asked)).err())?;
        (missing.code() == Code::NotFound).then(|| Diagnostic::warning(Code::NotFound, missing.message()))
    }

    /// Resolves the movement of the camera, and turns the pictures to its first frame.
    fn moved(
        &self,
        geometry: &GeometrySettings,
        (input, pictures): (&mut Input, &mut [Picture]),
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Option<(Movement, Vec<TargetView>)>> {
        let name = |picture: &Picture| picture.label().unwrap_or_else(|| "the output".to_owned());
        let target = |picture: &Picture| TargetView {
            name: name(picture),
            view: picture.view.clone(),
            eye: picture.eye,
            level: 0,
        };
        let targets: Vec<TargetView> = pictures.iter().map(target).collect();
        let frames = (&input.frames[..], self.frames.as_ref());
        let Some((movement, frames)) = Movement::resolve(geometry, &targets, frames, access, warnings)? else {
            return Ok(None);
        };
        let first = frames.first().copied().flatten().unwrap_or_default();
        let turned = movement.views(&targets, &movement.pose(time(first)))?;
        pictures.iter_mut().zip(turned).for_each(|(picture, target)| picture.view = target.view);
        input.frames = frames;
        Ok(Some((movement, targets)))
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
                let moves = geometry.camera.is_some() || geometry.in_path.is_some();
                let is_sequence = moves && Input::may_be_sequence(pattern);
                let wanted = self.frames.as_ref().filter(|_| is_sequence);
                let input = Input::find(pattern, from.as_ref(), wanted, access, warnings)?;
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

    /// Returns the input.
    pub(super) fn input(&self) -> &Input {
        &self.input
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
        check_pictures(&self.input, self.memory)?;
        self.pool.install(|| whole_worlds(&self.input))
    }

    /// Explains one of the pictures.
    pub fn report(&self, worlds: &[World], picture: &Picture) -> explain::Report {
        let world = &worlds[picture.world(worlds.len())];
        self.pool.install(|| explain::Report::of(world, &picture.view, &self.filter))
    }

    /// Returns whether the camera moves.
    pub fn moves(&self) -> bool {
        self.movement.is_some()
    }

    /// Explains the path of a moving camera; `None` where it stands still. An observer is told how far files are compared with what is needed
    /// of them.
    ///
    /// # Errors
    /// When its field of view goes beyond what the projection can show, or the observer ends it.
    pub fn path(&self, worlds: &[World], observer: &mut dyn Observer) -> Result<Option<PathExplanation>> {
        let Some((movement, targets)) = &self.movement else { return Ok(None) };
        let numbers: Vec<u64> = self.input.frames.iter().copied().flatten().collect();
        // Of two eyes, the left one's.
        let of_first = |target: &TargetView| target.world(worlds.len()) == 0;
        let views_of = |frame: &u64| -> Result<Vec<View>> {
            let views = movement.views(targets, &movement.pose(time(*frame)))?;
            Ok(views.into_iter().filter(of_first).map(|target| target.view).collect())
        };
        let views: Vec<Vec<View>> = numbers.iter().map(views_of).collect::<Result<_>>()?;
        let report = self.pool.install(|| explain::PathReport::of(&worlds[0], &views));
        let gaps = if self.has_input { self.gaps(worlds, (movement, targets), observer)? } else { Vec::new() };
        Ok(Some(PathExplanation { frames: FrameList::new(numbers), report, gaps, views }))
    }

    /// Computes the error of near things for a camera that leaves the place where the world was made, over a path or over the
    /// pictures of a camera that stands still.
    ///
    /// # Errors
    /// When the camera gets as far as the nearest thing.
    pub fn parallax(&self, path: Option<&PathExplanation>, travel: f64, nearest: f64) -> Result<explain::Parallax> {
        let still = || vec![self.pictures.iter().map(|picture| picture.view.clone()).collect()];
        let frames = path.map_or_else(still, |path| path.views.clone());
        explain::Parallax::of(&frames, travel, nearest).ok_or_else(|| {
            if travel < nearest {
                return usage("no picture shows anything; choose another camera");
            }
            usage(format!(
                "{TRAVEL} {travel} is not less than {NEAREST} {nearest}: the camera would pass the nearest thing, which no picture \
                 of a world can show; put what is near into a layer of its own"
            ))
        })
    }

    /// Finds what the input lacks for the frames of a moving camera.
    fn gaps(
        &self,
        worlds: &[World],
        (movement, targets): (&Movement, &[TargetView]),
        observer: &mut dyn Observer,
    ) -> Result<Vec<String>> {
        let shots = Shot::all(movement, targets, &self.input.frames)?;
        let count = worlds.len();
        let find = |progress: &dyn Progress| {
            let mut gaps = Vec::new();
            for (index, (views, world)) in self.input.worlds.iter().zip(worlds).enumerate() {
                let (mut views, mut warnings) = (views.clone(), Vec::new());
                let told = (&mut warnings, &Share::of(progress, (index, count)) as &dyn Progress);
                match find_gaps(&mut views, (world, index, count), &shots, &self.filter, told) {
                    Ok(found) => gaps.extend(found),
                    Err(error) => gaps.push(error.message().to_string()),
                }
                gaps.extend(warnings.iter().map(ToString::to_string));
            }
            gaps
        };
        watched(&self.pool, observer, Work::Path, find).ok_or_else(|| stopped((0, None)))
    }

    /// Returns the views that have no file yet.
    pub fn views_without_files(&self) -> impl Iterator<Item = &InputView> {
        self.input.views().filter(|view| view.window.is_none())
    }
}
