use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::filter::{Classic, Filter, FilterKind, FilterSettings, Kernel};
use cosmorama::lighting::PreparedLight;
use cosmorama::motion::{Exposure, Moment, Pose};
use cosmorama::raster::{Channels, Depth, FixedCodec, Rgba};
use cosmorama::render::{Accuracy, Arithmetic, Needs, Progress, Resampler, Share};
use cosmorama::world::World;
use cosmorama_builtin::BuiltinWorld;
use cosmorama_io::{Choice, Format, FrameList};
use cosmorama_spec::Missing;

use super::Content;
use super::backdrop::{FoundBackdrop, Front};
use super::gaps::Shot;
use super::memory_needs::{FrameNeeds, Held, gathered_bytes, is_large};
use super::options::{check_file_options, filter};
use crate::colour::{LayerPlan, Light, check_choice, check_labels, check_light};
use crate::detect::unless_damaged;
use crate::diagnostic::{Code, Diagnostic, FILTER, IN_PATH, MISSING, MOTION, PATH, Result, SCALE, SHUTTER, YAW, usage};
use crate::input::Input;
use crate::input::spec_files::st_map::settled;
use crate::job::coverage::{Coverage, check_pictures, whole_worlds};
use crate::job::origin::Origin;
use crate::job::outputs::turn::frames_beside_turn;
use crate::job::{Outputs, Space};
use crate::settings::{BlurMethod, Conversion, GeometrySettings, LightSettings};
use crate::source::{Access, ChosenFiles, DecodedPicture, Files, MemoryBudget};
use crate::target::{Movement, Target, TargetView, name_of_level, of_light, shape_warning, time, whole_chain};

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
    /// Movement of their camera, and of the input.
    pub(crate) movement: Option<Movement>,
    /// Whether a shutter blurs some frame, so that light is summed.
    pub(crate) is_blurred: bool,
    /// Whether the memory holds what renders the moments of a frame together.
    pub(crate) has_room_for_rings: bool,
    /// Filter.
    pub(crate) filter: FilterSettings,
    /// Transfer functions of both sides, and the outputs' channels and depth.
    pub(crate) light: Light,
    /// Further channels that the outputs get.
    pub(crate) layers: LayerPlan,
    /// Outputs to make, by frame.
    pub(crate) outputs: Outputs,
    /// Origin of its frames; `None` where outputs are to say nothing of it.
    pub(super) origin: Option<Origin>,
    /// Treatment of pixels that no view covers.
    pub(crate) coverage: Coverage,
    /// Map of light that is made instead of a picture.
    pub(crate) lighting: Option<LightSettings>,
    /// Source of its pixels.
    pub(super) content: Content,
    /// World behind the input.
    pub(crate) backdrop: Option<Box<ConvertJob>>,
    /// Whether it is itself behind another.
    pub(super) is_behind: bool,
    /// Whether it is behind one whose pictures are held whole.
    pub(super) is_behind_whole: bool,
    /// Factor of the input's light and its alpha.
    pub(crate) opacity: f32,
    /// Requested treatment of directions without light.
    pub(super) missing: Missing,
    /// Memory budget.
    pub(crate) memory: MemoryBudget,
    /// Bytes that a filter or light makes of the input, with copies of pictures.
    pub(crate) prepared: u64,
    /// Bytes of the weights of the texels under the largest pixels.
    pub(super) footprints: u64,
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

/// Format in whose range and sample types light is held that goes into no file: all of it fits.
const LIGHT: Format = Format::Exr;

/// Part of the memory, at most, that a picture decoded beforehand takes.
pub(super) const DECODED_PART: u64 = 8;

/// Returns whether a filter should keep light, which weights that depend on the light do not.
pub(crate) fn is_balanced(filter: &FilterSettings) -> bool {
    filter.kind == FilterKind::Ewa && filter.kernel == Kernel::LIGHT && !filter.anti_ringing
}

/// Returns whether a filter makes strips by themselves. The passes of two-pass run through whole columns, and each moment under a shutter
/// would have a balance of its own.
pub(crate) fn makes_strips(filter: &FilterSettings, has_shutter: bool) -> bool {
    filter.kind != FilterKind::Classic(Classic::TwoPass) && !(has_shutter && is_balanced(filter))
}

/// Returns whether pictures are made without all of them: those that are too large to be held, and maps, each of whose pixels stands for
/// itself. Maps of light are measured when they are made.
fn may_be_by_strips(
    (target, content): (&Target, Content),
    filter: &FilterSettings,
    (is_lit, has_shutter): (bool, bool),
) -> bool {
    match content {
        Content::StMap | Content::Directions(_) => true,
        Content::World | Content::Formula(_) => {
            is_large(target) && makes_strips(filter, has_shutter) && !is_lit && !target.format.is_video()
        }
    }
}

/// Returns the source of a conversion's files, which knows the parts and channels to read.
fn chosen(settings: &Conversion, content: Content) -> Arc<dyn Files> {
    let (part, channels) = (settings.part.clone(), settings.channels.clone());
    let is_exr = Format::of_name(Path::new(&settings.output)) == Some(Format::Exr);
    let without_picture = content == Content::World && is_exr && settings.light.is_none();
    let choice = Choice { part, channels, without_picture };
    let files = ChosenFiles::new(Arc::clone(&settings.files), choice, settings.video.damaged);
    Arc::new(files.ending_with(&settings.unfinished))
}

/// Resolves the movement of the camera and of the input, which gives a still input its frames.
fn move_camera(
    settings: &Conversion,
    geometry: &GeometrySettings,
    (input, target): (&mut Input, &Target),
    access: Access,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Option<Movement>> {
    if settings.light.is_some() && (geometry.camera.is_some() || geometry.in_path.is_some()) {
        return Err(usage(format!("maps of light have no camera that could move; leave {PATH} and {IN_PATH} out")));
    }
    let frames = (&input.frames[..], settings.frames.as_ref());
    let Some((movement, frames)) = Movement::resolve(geometry, &target.views, frames, access, warnings)? else {
        if geometry.blur.is_some() {
            let message = format!("{SHUTTER} has no effect: the camera stands still; {PATH} or {YAW} A..B moves it");
            warnings.push(Diagnostic::warning(Code::NoEffect, message));
        }
        return Ok(None);
    };
    input.frames = frames;
    Ok(Some(movement))
}

impl ConvertJob {
    /// Resolves the settings and checks everything that can be checked without decoding pixels.
    pub(crate) fn resolve(
        settings: &Conversion,
        (content, purpose): (Content, Purpose),
        (warnings, progress): (&mut Vec<Diagnostic>, &dyn Progress),
    ) -> Result<Self> {
        let memory = MemoryBudget::new(settings.limits.memory);
        let file = content.has_files().then_some(&settings.input);
        // Nothing is read for maps of places.
        let held = if settings.st_map { 0 } else { memory.bytes / DECODED_PART };
        let decoded = DecodedPicture::up_to(held);
        let files = chosen(settings, content);
        let access = Access { files: &*files, memory, decoded: &decoded };
        let mut geometry = settled(&settings.geometry, file, access, warnings)?;
        let mut output = settings.output.clone();
        let levels = settings.light.as_ref().map_or(1, |light| light.levels.len());
        if settings.light.is_some() && purpose == Purpose::Pictures {
            output = name_of_level(&output, 0);
            geometry = of_light(geometry, &output, levels);
        }
        let geometry = &geometry;
        // Mistakes in the settings themselves come first: they do not depend on any file.
        let format = match purpose {
            Purpose::Pictures => Target::check_names(&output, geometry)?,
            Purpose::Light => LIGHT,
        };
        check_file_options(settings, format)?;
        let mut backdrop = FoundBackdrop::find(settings, (content, geometry), memory, warnings)?;
        let frames_behind = backdrop.as_ref().map_or_else(Vec::new, |found| found.frames().to_vec());
        let mut input = content.input((settings, !frames_behind.is_empty()), geometry, access, warnings)?;
        if input.frames == [None] && !frames_behind.is_empty() {
            let wanted = |frames: &FrameList| frames.frames().iter().copied().map(Some).collect();
            input.frames = settings.frames.as_ref().map_or(frames_behind, wanted);
        }
        let parity = content.has_files().then(|| input.pixels_per_radian());
        let mut target = match purpose {
            Purpose::Pictures => Target::resolve(&output, geometry, parity)?,
            Purpose::Light => Target::none(LIGHT),
        };
        if settings.mips {
            target = target.with_mips(&settings.output, geometry)?;
        }
        let mut lighting = settings.light.clone();
        if let Some(light) = lighting.as_mut().filter(|_| levels > 1) {
            // The last level goes on, smaller and smaller.
            let last = light.levels[levels - 1];
            light.levels.resize(whole_chain(&settings.output, &target).unwrap_or(levels).max(levels), last);
            target = target.with_chain(&settings.output, geometry, light.levels.len())?;
        }
        let movement = move_camera(settings, geometry, (&mut input, &target), access, warnings)?;
        input.expect_frames(access)?;
        warnings.extend(input.diagnostics());
        check_choice(settings, &input, warnings)?;
        warnings.extend(shape_warning(geometry, &target));
        content.fit_eyes(&mut input, &target, warnings);
        let mut filter = if content.has_files() { filter(geometry, warnings) } else { FilterSettings::DEFAULT };
        if settings.light.is_some() {
            // The mirror level of a chain must keep the light of suns, and its faces must meet.
            let round = target.views.iter().all(|target| target.view.is_flat());
            filter = FilterSettings { kernel: Kernel { round, ..Kernel::LIGHT }, anti_ringing: false, ..filter };
        }
        // What nothing of the input covers shows the backdrop.
        let in_front = Missing::Fill(Rgba::TRANSPARENT);
        let mut memory = memory.beside_films((settings, &target), (&input, &*files), backdrop.as_ref())?;
        let backdrop = match backdrop.take() {
            None => None,
            Some(found) => {
                let frames = &input.frames[..];
                let (movement, filter) = (movement.as_ref(), filter);
                let needs = FrameNeeds::of(&input, &[], &target, Held::any()).of_many().least(&target);
                let own = memory.beside_frame(needs);
                let progress = &Share::of(progress, (0, 2));
                let front = Front { frames, target: &target, movement, filter, memory: own, progress };
                Some(found.resolve(&front, warnings)?)
            }
        };
        let behind = backdrop.as_ref().map(|job| &job.light);
        let mut light = Light::resolve(settings, &input, &target, behind, warnings)?;
        let layers = if content == Content::World && settings.light.is_none() {
            LayerPlan::resolve(settings, (&input, &target, &light), &mut filter, warnings)?
        } else {
            LayerPlan::default()
        };
        let kind = (lighting.is_some(), movement.as_ref().is_some_and(|movement| movement.blur.is_some()));
        let is_by_strips = may_be_by_strips((&target, content), &filter, kind);
        let backdrop = backdrop.map(|job| job.lie_behind(&light, is_by_strips)).transpose()?.map(|job| {
            let (job, left) = job.share(memory);
            memory = left;
            Box::new(job)
        });
        if content == Content::World && (settings.light.is_some() || purpose == Purpose::Light) {
            check_light(&input, "this needs")?;
        }
        check_labels(&filter, &input, (&light, target.format), warnings)?;
        if let (Missing::Continue(_), FilterKind::Labels(_)) = (settings.missing, filter.kind) {
            return Err(usage(format!(
                "{MISSING} {} would mix labels; give a colour or transparent",
                settings.missing
            )));
        }
        content.settle(settings, &target, &mut light, warnings)?;
        memory.check_outputs(&target, &light)?;
        let outputs = match purpose {
            Purpose::Pictures => Outputs::plan(settings, (&input, backdrop.as_deref()), &target)?,
            Purpose::Light => Outputs::none(settings, &input),
        };
        let missing = match settings.missing {
            _ if backdrop.is_some() => in_front,
            Missing::Fill(colour) => Missing::Fill(light.colour(colour)?),
            other => other,
        };
        let mut job = Self {
            files,
            input,
            worlds: Vec::new(),
            target,
            movement,
            is_blurred: false,
            has_room_for_rings: false,
            filter,
            light,
            layers,
            outputs,
            origin: None,
            coverage: Coverage::Complete,
            lighting,
            content,
            backdrop,
            is_behind: false,
            is_behind_whole: false,
            opacity: settings.opacity,
            missing,
            memory,
            prepared: 0,
            footprints: 0,
            decoded,
        };
        job.leave_finished(settings, purpose)?;
        warnings.extend(job.outputs.warnings());
        warnings.extend(frames_beside_turn(&job));
        warnings.extend(Space::of(&job, settings).warning(&job.outputs));
        job.check_scale()?;
        if content.has_files() {
            let first = job.input.frames.first().map_or_else(Vec::new, |frame| job.input.paths(*frame));
            let (files, frames, memory) = (Arc::clone(&job.files), job.input.frames.clone(), job.memory);
            let progress = &Share::of(progress, if job.backdrop.is_some() { (1, 2) } else { (0, 1) });
            job.cover(&frames, (warnings, progress))
                .map_err(|error| unless_damaged((&*files, memory), first, error))?;
        } else {
            job.memory.check_frame(job.frame_needs(), &job.input, &job.target)?;
        }
        job.find_blur(content, warnings)?;
        content.check_last(settings, format, job.light.depth, warnings)?;
        Ok(job)
    }

    /// Leaves out what an earlier run has finished, where that is asked for; else refuses to replace it unasked.
    fn leave_finished(&mut self, settings: &Conversion, purpose: Purpose) -> Result<()> {
        if purpose == Purpose::Light {
            return Ok(());
        }
        let has_frames = self.input.frames.iter().any(Option::is_some);
        // Of a stream, only its end would tell from what its frames were made.
        let is_live = self.input.is_live(&*self.files);
        let has_place = has_frames && !self.target.format.is_video() && !is_live;
        self.origin = has_place.then(|| Origin::of(self, settings));
        let mut outputs = std::mem::take(&mut self.outputs);
        let left = outputs.leave_finished(settings.existing, self);
        self.outputs = outputs;
        // Files that are there may tell how they were made, but new ones will not.
        self.origin = self.origin.take().filter(|_| !settings.strip);
        left
    }

    /// Returns words about how the files of a frame are made, which go into them.
    pub(crate) fn origin_of(&self, frame: Option<u64>) -> Result<Option<String>> {
        self.origin.as_ref().map_or(Ok(None), |origin| origin.of_frame(self, frame))
    }

    /// Refuses a scale that each frame would have of its own.
    fn check_scale(&self) -> Result<()> {
        let frames = self.outputs.frames.len();
        if frames > 1 && self.lighting.as_ref().is_some_and(LightSettings::fits) {
            return Err(usage(format!(
                "{SCALE} auto would scale each of {frames} frames by its own factor; give one for all, as in {SCALE} 0.25"
            )));
        }
        Ok(())
    }

    /// Checks that the input covers the output in these frames, and that memory suffices.
    pub(super) fn cover(&mut self, frames: &[Option<u64>], told: (&mut Vec<Diagnostic>, &dyn Progress)) -> Result<()> {
        let shots = match &self.movement {
            Some(movement) => Shot::all(movement, &self.target.views, frames)?,
            None => vec![Shot { frames: Vec::new(), views: self.target.views.clone() }],
        };
        let Self { input, filter, memory, .. } = self;
        check_pictures(input, *memory)?;
        input.narrow_to_files();
        let whole = whole_worlds(input)?;
        if self.lighting.is_some() {
            (self.coverage, self.worlds) = Coverage::of_sphere(input, whole, self.missing)?;
            return self.keep_for_light();
        }
        (self.coverage, self.worlds) = Coverage::check(input, whole, &shots, filter, self.missing, told)?;
        for world in &self.worlds {
            filter.check(world).map_err(|error| usage(format!("{FILTER}: {error}")))?;
        }
        self.footprints = self.footprint_bytes(&shots);
        self.memory.check_frame(self.frame_needs(), &self.input, &self.target)?;
        self.prepared = self.filter_bytes().max(self.table_bytes());
        let needs = self.frame_needs();
        self.memory.check_prepared(needs)?;
        let made = self.pixels_made();
        self.memory = self.memory.beside_channels(&mut self.layers, needs, (self.input.texels() as u64, made))?;
        Ok(())
    }

    /// Returns the bytes of what the filter computes of light once for all pictures: of each world, and of the further channels
    /// while they are filtered.
    fn table_bytes(&self) -> u64 {
        let times = 1 + u64::from(!self.layers.groups.is_empty());
        let worlds = self.worlds.iter().filter(|_| self.filter.has_tables());
        worlds.map(|world| self.filter.setup(world).bytes as u64 * times).fold(0, u64::saturating_add)
    }

    /// Checks that memory suffices for maps of light, with what is gathered for them.
    fn keep_for_light(&mut self) -> Result<()> {
        self.memory.check_frame(self.frame_needs(), &self.input, &self.target)?;
        let Some(lighting) = &self.lighting else { return Ok(()) };
        let sources = self.worlds.iter().flat_map(World::sources);
        let lobes = if lighting.exact { Vec::new() } else { lighting.lobes() };
        let has_narrow = PreparedLight::has_narrow(&lobes);
        let sources = sources.filter(|_| has_narrow);
        let blocks: u64 = sources.map(|source| gathered_bytes(&source.view)).fold(0, u64::saturating_add);
        let bands = self.worlds.iter().map(|world| PreparedLight::bytes_for(world, &lobes) as u64).sum::<u64>();
        // The map before, the one after, and all between; another where the error is measured.
        let copies = lighting.every.map_or(0, |every| every.frames.min(self.input.frames.len()) + 2);
        let pictures = self.frame_needs().pictures();
        // Maps are assembled to pictures when all are made.
        self.prepared = blocks.saturating_add(bands).saturating_add(pictures).saturating_add(self.table_bytes());
        self.memory.check_prepared(self.frame_needs())?;
        let maps = pictures.saturating_mul(copies as u64);
        self.prepared = self.prepared.saturating_add(maps);
        self.memory.check_maps(self.frame_needs(), maps)
    }

    /// Returns the formula that stands for files, if there is one.
    pub(crate) fn formula(&self) -> Option<BuiltinWorld> {
        self.content.formula()
    }

    /// Returns whether the pictures of a frame are encoded strip by strip, because they are too large to be held. Not where all of a picture
    /// must be there.
    pub(crate) fn is_by_strips(&self) -> bool {
        // Integers are samples, which are held for a format that is written as a whole.
        let is_of_use = self.target.format.takes_rows() || self.fixed_codec().is_none();
        let has_shutter = self.movement.as_ref().is_some_and(|movement| movement.blur.is_some());
        let kind = (self.lighting.is_some(), has_shutter);
        is_of_use && !self.is_behind_whole && may_be_by_strips((&self.target, self.content), &self.filter, kind)
    }

    /// Returns whether pixels of a strip depend on those beside it, whatever the light: where views end, neighbours decide what becomes of
    /// a pixel. What lies behind is cut in the same strips.
    pub(crate) fn strips_have_margins(&self) -> bool {
        self.is_behind || self.backdrop.is_some() || !self.is_complete()
    }

    /// Returns the codec of pictures that are filtered in integers; `None` unless all are opaque, of 8 bits, and fit 15-bit light.
    pub(crate) fn fixed_codec(&self) -> Option<FixedCodec> {
        let light = &self.light;
        let is_possible = Arithmetic::Fixed.has_plan_of(self.filter.kind)
            && self.lighting.is_none()
            && self.content.has_files()
            // The light of many moments is summed.
            && !self.is_blurred
            // A factor of the balance may raise a texel above white.
            && !self.is_balance_asked_for()
            && light.channels == Channels::Rgb
            && light.depth == Depth::Eight
            && light.background.alpha() >= 1.0
            && self.backdrop.is_none()
            && self.opacity >= 1.0
            && self.is_complete()
            && self.takes_integers();
        is_possible.then(|| FixedCodec::new(&light.transfer, light.background)).flatten()
    }

    /// Returns whether all inputs are opaque, of 8 bits, and fit 15-bit light.
    fn takes_integers(&self) -> bool {
        self.input.takes_integers(|header| {
            let colours = self.light.colours(header.channels, header.depth, &header.metadata);
            colours.conversion.is_none().then_some(colours.transfer)
        })
    }

    /// Returns whether a later run can keep outputs and make the others; a video is made whole or not at all.
    pub(crate) fn is_resumable(&self) -> bool {
        !self.target.format.is_video()
    }

    /// Returns whether the filter should keep light and can be balanced: `--kernel light` without anti-ringing, whose
    /// weights depend on the light.
    pub(crate) fn is_balance_asked_for(&self) -> bool {
        is_balanced(&self.filter)
    }

    /// Returns the rows of its only view, a video, from which all frames are made; `None` where others may be looked at, too.
    pub(crate) fn rows_read(&self) -> Option<(&Path, Range<usize>)> {
        let is_still = self.movement.is_none() && self.lighting.is_none() && self.layers.is_plain();
        let is_local = self.filter.kind == FilterKind::Ewa && !self.is_balance_asked_for() && self.is_complete();
        let mut present = self.input.present();
        let (Some((view, ..)), None, [world]) = (present.next(), present.next(), &self.worlds[..]) else { return None };
        let video = view.files.video().filter(|_| is_still && is_local && view.part.is_none())?;
        let targets: Vec<View> = self.target.views.iter().map(|target| target.view.clone()).collect();
        let needs = Needs::of(world, &targets, &self.filter, Accuracy::Bounds);
        let read = needs.views.first()?.read?;
        Some((video, read.top..read.bottom))
    }

    /// Returns whether the views cover every direction that is wanted.
    pub(crate) fn is_complete(&self) -> bool {
        matches!(self.coverage, Coverage::Complete)
    }

    /// Returns the camera's pose in a frame; `None` where it does not move.
    pub(crate) fn pose(&self, frame: Option<u64>) -> Option<Pose> {
        Some(self.movement.as_ref()?.pose(time(frame.unwrap_or_default())))
    }

    /// Returns the target's views in a pose.
    pub(crate) fn views_in(&self, pose: Option<&Pose>) -> Result<Vec<TargetView>> {
        match (&self.movement, pose) {
            (Some(movement), Some(pose)) => movement.views(&self.target.views, pose),
            _ => Ok(self.target.views.clone()),
        }
    }

    /// Finds out whether a shutter blurs any frame, and keeps memory for that.
    fn find_blur(&mut self, content: Content, warnings: &mut Vec<Diagnostic>) -> Result<()> {
        let Some(blur) = self.movement.as_ref().and_then(|movement| movement.blur) else { return Ok(()) };
        if matches!(content, Content::StMap | Content::Directions(_))
            || matches!(self.filter.kind, FilterKind::Labels(_))
        {
            let message =
                format!("{SHUTTER} has no effect: numbers are not blurred, and are those of the frame's own time");
            warnings.push(Diagnostic::warning(Code::NoEffect, message));
            return Ok(());
        }
        let has_formula = self.layers().skip(1).any(|job| job.formula().is_some());
        if (!content.has_files() || has_formula) && blur.method == BlurMethod::Ellipse {
            return Err(usage(format!("{MOTION} ellipse averages texels, but a formula has none; leave it out")));
        }
        for frame in self.input.frames.clone() {
            if let Some(moments) = self.moments(frame)? {
                self.is_blurred = true;
                if blur.method == BlurMethod::Ellipse && self.filter.kind != FilterKind::Ewa {
                    let message =
                        format!("{FILTER} has no effect on what {MOTION} ellipse blurs: that is averaged by ewa");
                    warnings.push(Diagnostic::warning(Code::NoEffect, message));
                }
                if !self.layers.groups.is_empty() && !self.layers.leaves_picture_out() {
                    let message = "channels beside the picture are not blurred, and are those of the frame's own time";
                    warnings.push(Diagnostic::warning(Code::NoEffect, message));
                }
                let sum = self.frame_needs().light_of_pictures();
                self.prepared = self.prepared.saturating_add(sum);
                self.memory.check_sum(self.frame_needs(), sum)?;
                self.keep_room_for_rings(blur.method, &moments)?;
                break;
            }
        }
        Ok(())
    }

    /// Returns the moments of a frame's exposure; `None` where nothing moves, or nothing is blurred.
    pub(crate) fn moments(&self, frame: Option<u64>) -> Result<Option<Vec<Moment>>> {
        let Some(blur) = self.movement.as_ref().and_then(|movement| movement.blur) else { return Ok(None) };
        let frame = time(frame.unwrap_or_default());
        let times = blur.shutter.division(frame);
        let needed = self.layers().map(|job| job.moments_needed(&times)).collect::<Result<Vec<_>>>()?;
        let count = match needed.into_iter().max().unwrap_or_default() {
            0 | 1 => return Ok(None),
            _ if blur.method == BlurMethod::Ellipse => Exposure::FEW,
            count => count,
        };
        Ok(Some(blur.shutter.moments(frame, count)))
    }

    /// Returns how many moments the fastest pixel needs, by the views at some times of an exposure.
    fn moments_needed(&self, times: &[f64]) -> Result<usize> {
        let Some(movement) = &self.movement else { return Ok(0) };
        let ends = movement.views_at(&self.target.views, times)?;
        let needed = |(index, target): (usize, &TargetView)| {
            let views: Vec<View> = ends.iter().map(|views| views[index].view.clone()).collect();
            let texel = self.worlds.get(target.world(self.worlds.len())).map_or(0.0, World::texel_pitch);
            Exposure::moments_needed(&views, texel)
        };
        Ok(self.target.views.iter().enumerate().map(needed).max().unwrap_or_default())
    }

    /// Returns the target's views at all moments of a frame's exposure, each with its part of the light; none where nothing is
    /// blurred.
    pub(crate) fn exposure(&self, frame: Option<u64>) -> Result<Vec<(Vec<TargetView>, f32)>> {
        let moments = if self.is_blurred { self.moments(frame)? } else { None };
        let exposed = |moment: &Moment| {
            let pose = self.movement.as_ref().map(|movement| movement.pose(moment.time));
            Ok((self.views_in(pose.as_ref())?, moment.weight as f32))
        };
        moments.iter().flatten().map(exposed).collect()
    }

    /// Returns the budgets of this backdrop and of the input before it: each has its own frame and half of what is left.
    pub(super) fn share(mut self, all: MemoryBudget) -> (Self, MemoryBudget) {
        let half = self.memory.beside_frame(self.frame_needs()).bytes / 2;
        self.memory = self.memory.beside(half);
        let left = all.beside(self.memory.bytes);
        (self, left)
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
            Missing::Error | Missing::Continue(_) => None,
            Missing::Fill(colour) => Some(colour),
        }
    }
}
