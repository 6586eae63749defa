//! Worlds behind the input's alpha.

use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::filter::FilterSettings;
use cosmorama::raster::{Channels, Rgba};
use cosmorama::render::Progress;
use cosmorama_io::{Choice, FrameList};
use cosmorama_spec::{FrameMap, Missing};

use super::convert_job::DECODED_PART;
use super::{Content, ConvertJob, FrameNeeds, Held, Outputs};
use crate::colour::{LayerPlan, Light};
use crate::diagnostic::{BACKDROP, BACKDROP_FRAMES, BACKDROP_FROM, Diagnostic, FROM, Result, ST_MAP, bail, usage};
use crate::input::Input;
use crate::input::spec_files::st_map::settled;
use crate::job::coverage::Coverage;
use crate::settings::{Conversion, GeometrySettings};
use crate::source::{Access, ChosenFiles, DecodedPicture, Files, MemoryBudget};
use crate::target::{Movement, Target};

/// A world behind the input, whose files are found.
pub(crate) struct FoundBackdrop {
    /// Settings of a conversion of it alone.
    settings: Conversion,
    content: Content,
    files: Arc<dyn Files>,
    decoded: DecodedPicture,
    input: Input,
    rule: FrameMap,
    /// Frames that a still input has before it.
    frames: Vec<Option<u64>>,
    /// World behind it.
    further: Option<Box<Self>>,
}

/// Parts of the conversion that a world behind its input shares.
pub(crate) struct Front<'a> {
    /// Frames to make.
    pub(crate) frames: &'a [Option<u64>],
    pub(crate) target: &'a Target,
    pub(crate) movement: Option<&'a Movement>,
    pub(crate) filter: FilterSettings,
    /// Memory that the input leaves.
    pub(crate) memory: MemoryBudget,
    /// Receives how far its files are compared with what is needed of them.
    pub(crate) progress: &'a dyn Progress,
}

impl FoundBackdrop {
    /// Finds and probes the files of the backdrop, if there is one.
    pub(crate) fn find(
        settings: &Conversion,
        (content, geometry): (Content, &GeometrySettings),
        memory: MemoryBudget,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Option<Self>> {
        let Some(backdrop) = &settings.backdrop else { return Ok(None) };
        let name = &backdrop.input;
        let refusal = match content {
            Content::World if settings.light.is_none() => None,
            Content::World => Some("a map of light has none".to_owned()),
            Content::StMap => Some(format!("{ST_MAP} tells places in one input")),
            Content::Formula(_) | Content::Directions(_) => Some(format!("{} hides all of it", settings.input)),
        };
        if let Some(why) = refusal {
            return Err(usage(format!("{BACKDROP} {name} lies behind pictures with alpha, but {why}; leave it out")));
        }
        let settings = Conversion {
            input: name.clone(),
            backdrop: backdrop.behind.as_deref().cloned(),
            opacity: backdrop.opacity,
            geometry: GeometrySettings {
                from: backdrop.from.clone(),
                in_path: backdrop.in_path.clone(),
                ..geometry.clone()
            },
            channels: Vec::new(),
            part: None,
            // Metadata are those of the input.
            strip: true,
            ..settings.clone()
        };
        let content = Content::of(&settings)?;
        if let Content::Directions(_) = content {
            return Err(usage(format!("{BACKDROP} {name}: these are numbers, not light; give a picture of a world")));
        }
        let files = ChosenFiles::new(Arc::clone(&settings.files), Choice::default(), settings.video.damaged);
        let files: Arc<dyn Files> = Arc::new(files.ending_with(&settings.unfinished));
        let decoded = DecodedPicture::up_to(memory.bytes / DECODED_PART);
        let access = Access { files: &*files, memory, decoded: &decoded };
        let mut said = Vec::new();
        let found = Self::input(&settings, content, access, &mut said);
        let from = BACKDROP_FROM.to_string();
        warnings.extend(said.into_iter().map(|diagnostic| {
            let message = diagnostic.message.reworded(FROM, &from);
            Diagnostic { message, ..diagnostic }
        }));
        let (geometry, input) = found.map_err(|error| error.reworded(FROM, &from))?;
        let settings = Conversion { geometry, ..settings };
        let further = Self::find(&settings, (content, &settings.geometry), memory, warnings)?.map(Box::new);
        let rule = backdrop.frames;
        let mut frames = frames_before(&input, rule);
        if frames.is_empty() && settings.geometry.in_path.is_some() {
            let geometry = GeometrySettings { camera: None, blur: None, ..settings.geometry.clone() };
            let moved = Movement::resolve(&geometry, &[], (&[None], settings.frames.as_ref()), access, warnings)?;
            frames = moved.map_or_else(Vec::new, |(_, frames)| frames);
        }
        if let (true, Some(further)) = (frames.is_empty(), &further) {
            frames.clone_from(&further.frames);
        }
        Ok(Some(Self { settings, content, files, decoded, input, rule, frames, further }))
    }

    fn input(
        settings: &Conversion,
        content: Content,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(GeometrySettings, Input)> {
        if !content.has_files() {
            if settings.geometry.from.is_some() {
                return Err(usage(format!("{FROM} cannot be given for {}: it is a formula", settings.input)));
            }
            return Ok((settings.geometry.clone(), Input::none()));
        }
        let geometry = settled(&settings.geometry, Some(&settings.input), access, warnings)?;
        let input = Input::find(&settings.input, geometry.from.as_ref(), None, access, warnings)?;
        warnings.extend(input.diagnostics());
        Ok((geometry, input))
    }

    /// Returns the inputs of this backdrop and of those behind it, with the sources of their files.
    pub(super) fn inputs(&self) -> Vec<(&Input, &dyn Files)> {
        let mut inputs = self.further.as_deref().map_or_else(Vec::new, Self::inputs);
        inputs.push((&self.input, &*self.files));
        inputs
    }

    /// Returns the frames that a still input has before this backdrop; none where nothing moves.
    pub(crate) fn frames(&self) -> &[Option<u64>] {
        &self.frames
    }

    /// Resolves the backdrop of a conversion, and checks that it covers what the output shows.
    pub(crate) fn resolve(self, front: &Front, warnings: &mut Vec<Diagnostic>) -> Result<ConvertJob> {
        let frames = self.frames_of(front.frames)?;
        let Self { settings, content, files, decoded, mut input, further, .. } = self;
        input.frames = frames;
        content.fit_eyes(&mut input, front.target, warnings);
        let access = Access { files: &*files, memory: front.memory, decoded: &decoded };
        input.expect_frames(access)?;
        let movement = if settings.geometry.in_path.is_some() {
            let frames = (front.frames, None);
            let moved = Movement::resolve(&settings.geometry, &front.target.views, frames, access, warnings)?;
            input.beside.extend(settings.geometry.pose_files());
            moved.map(|(movement, _)| movement)
        } else {
            front.movement.and_then(Movement::of_camera)
        };
        let mut memory = front.memory;
        let backdrop = match further {
            None => None,
            Some(found) => {
                let needs = FrameNeeds::of(&input, &[], front.target, Held::any()).of_many().least(front.target);
                let own = memory.beside_frame(needs);
                let job = found.resolve(&Front { memory: own, ..*front }, warnings)?;
                let (job, left) = job.share(memory);
                memory = left;
                Some(Box::new(job))
            }
        };
        let behind = backdrop.as_ref().map(|job| &job.light);
        let light = Light::resolve(&settings, &input, front.target, behind, warnings)?;
        let missing = match settings.missing {
            _ if backdrop.is_some() => Missing::Fill(Rgba::TRANSPARENT),
            Missing::Fill(colour) => Missing::Fill(light.colour(colour)?),
            other => other,
        };
        let mut job = ConvertJob {
            files,
            worlds: Vec::new(),
            target: front.target.clone(),
            movement,
            is_blurred: false,
            has_room_for_rings: false,
            filter: front.filter,
            light,
            layers: LayerPlan::default(),
            outputs: Outputs::none(&settings, &input),
            origin: None,
            coverage: Coverage::Complete,
            lighting: None,
            content,
            backdrop,
            is_behind: true,
            is_behind_whole: false,
            opacity: settings.opacity,
            missing,
            memory,
            prepared: 0,
            footprints: 0,
            decoded,
            input,
        };
        if content.has_files() {
            job.cover(front.frames, (warnings, front.progress))
                .map_err(|error| error.after(&format!("{BACKDROP} {}: ", settings.input)))?;
        }
        Ok(job)
    }

    /// Returns the backdrop's frame for each frame of the output.
    fn frames_of(&self, frames: &[Option<u64>]) -> Result<Vec<Option<u64>>> {
        let own: Vec<u64> = self.input.frames.iter().copied().flatten().collect();
        let (Some(first), Some(last)) = (own.iter().min(), own.iter().max()) else {
            return Ok(vec![None; frames.len()]);
        };
        let name = &self.settings.input;
        if frames == [None] {
            return Err(usage(format!(
                "{BACKDROP} {name} has frames, but the output has none; give one of them, as in {BACKDROP} {}",
                self.input.paths(Some(*first)).first().map_or_else(String::new, |path| path.display().to_string())
            )));
        }
        let numbers = frames.iter().copied().flatten();
        let found: Vec<Option<u64>> = numbers.clone().map(|frame| self.rule.frame(frame, &own)).collect();
        let without: Vec<u64> =
            numbers.zip(&found).filter(|(_, found)| found.is_none()).map(|(frame, _)| frame).collect();
        if without.is_empty() {
            return Ok(found);
        }
        let plural = if without.len() == 1 { "frame" } else { "frames" };
        bail!(
            NotFound: "{BACKDROP} {name} has frames {first} to {last}, but none for {plural} {}; add them, or give \
                       {BACKDROP_FRAMES} hold, loop or a number to add, as +12",
            FrameList::new(without)
        )
    }
}

/// Returns the frames that a still input has before a sequence; none before a still one.
fn frames_before(input: &Input, rule: FrameMap) -> Vec<Option<u64>> {
    let before = |frame: &u64| Some(i64::try_from(*frame).ok()? - rule.offset).filter(|frame| *frame >= 0);
    input.frames.iter().flatten().filter_map(before).map(|frame| Some(frame.unsigned_abs())).collect()
}

impl ConvertJob {
    /// Takes the light of the conversion whose input lies before this one, and checks that memory suffices if the pictures of that are held
    /// whole.
    pub(crate) fn lie_behind(mut self, front: &Light, is_by_strips: bool) -> Result<Self> {
        self.light.working = front.working.clone();
        (self.light.channels, self.light.background) = (Channels::Rgba, Rgba::TRANSPARENT);
        self.is_behind_whole = !is_by_strips;
        self.memory.check_frame(self.frame_needs(), &self.input, &self.target)?;
        let further = self.backdrop.take().map(|further| further.lie_behind(front, is_by_strips));
        self.backdrop = further.transpose()?.map(Box::new);
        Ok(self)
    }

    /// Returns the files of a frame, of the backdrop, too.
    pub(crate) fn paths(&self, frame: Option<u64>) -> Vec<PathBuf> {
        let place = self.place(frame);
        let behind = self.layers().skip(1).flat_map(|job| job.input.paths(job.input.frames[place]));
        self.input.paths(frame).into_iter().chain(behind).collect()
    }

    /// Visits it and all that is behind it.
    pub(crate) fn layers(&self) -> impl Iterator<Item = &Self> {
        std::iter::successors(Some(self), |job| job.backdrop.as_deref())
    }

    /// Returns the place of a frame among all of them. What is behind has its own frame at the same place.
    pub(crate) fn place(&self, frame: Option<u64>) -> usize {
        self.input.frames.iter().position(|other| *other == frame).unwrap_or_default()
    }
}
