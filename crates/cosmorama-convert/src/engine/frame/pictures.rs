use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

use cosmorama::camera::View;
use cosmorama::raster::{Encoder, FixedCodec, FixedLight, FramePool, Image, Rgba};
use cosmorama::render::{Continuation, Progress, Share, Stopped};
use cosmorama::world::Source;
use cosmorama_io::WriteOptions;

use crate::detect::FacePixels;
use crate::detect::pixels::light_of;
use crate::diagnostic::{BACKGROUND, Code, ConvertError, Diagnostic, Result, bail};
use crate::engine::frame::behind::Behind;
use crate::engine::frame::blur::FramePart;
use crate::engine::frame::fill::counted;
use crate::engine::frame::strips::KeptStrips;
use crate::engine::geometry::{arithmetic, balance_bytes, bytes_of_passes};
use crate::engine::unfiltered::formula;
use crate::engine::{
    BalancedLight, FrameLight, FurtherFiles, LayerPass, Levels, LightMaps, LightReport, Posed, Shares, Texels,
    WorldLight, Writer, WriterOptions, warnings,
};
use crate::input::InputView;
use crate::job::coverage::Coverage;
use crate::job::{ConvertJob, FrameNeeds, FrameOutputs, QueueDepth};
use crate::settings::{LightScale, LightSettings};
use crate::source::lock;
use crate::target::{Sheet, Target};

/// Makes the outputs of a job, frame by frame.
pub(crate) struct Engine<'a> {
    pub(super) job: &'a ConvertJob,
    /// Rows of each view from which pictures are made.
    rows: Range<usize>,
    /// Encoder from 15 bits to 8, for jobs with opaque 8-bit pictures in and out.
    pub(super) codec: Option<FixedCodec>,
    /// World behind the input.
    pub(super) behind: Option<Box<Behind<'a>>>,
    /// Pose of the last frame: of all frames where nothing moves.
    pub(super) posed: Mutex<Option<Arc<Posed>>>,
    /// Geometry of the strips of large pictures.
    pub(super) strips: KeptStrips,
    /// Diagnostics about the geometry that are not told yet.
    told: Mutex<Vec<Diagnostic>>,
    writer: Writer,
    /// Memory of a frame.
    pub(super) needs: FrameNeeds,
    /// Frames that may be in flight around the one that is filtered.
    queue_depth: QueueDepth,
    /// Pool of memory that frames hand on.
    pub(super) pool: Arc<FramePool>,
    /// Edges of the worlds, as far as something beyond them was asked for.
    pub(super) edges: Vec<OnceLock<Option<Continuation>>>,
    /// Figures of maps of light, by frame.
    lit: Mutex<Vec<LightReport>>,
}

/// State of a frame, or of a moment, while its pictures are made.
pub(super) struct Making<'a> {
    pub(super) layer: Layer,
    pub(super) shares: Shares<'a>,
}

/// Geometry of the input at one time, with that of the world behind it.
pub(super) struct Layer {
    /// Place of the frame among all.
    pub(super) place: usize,
    pub(super) posed: Arc<Posed>,
    pub(super) balanced: BalancedLight,
    pub(super) behind: Option<Box<Layer>>,
}

impl<'a> Engine<'a> {
    /// Prepares the geometry, on the threads that will render the frames.
    pub(crate) fn new(job: &'a ConvertJob, options: WriterOptions, progress: &dyn Progress) -> Result<Self, Stopped> {
        let behind = Behind::new(job, progress)?;
        let (is_moving, is_by_strips) = (job.movement.is_some(), job.is_by_strips());
        let (posed, mut told) = if is_moving {
            (None, Vec::new())
        } else {
            let is_repeated = job.outputs.are_many() && !is_by_strips;
            let first = Share { whole: progress, from: 0.0, to: if is_by_strips { 0.5 } else { 1.0 } };
            let (posed, told) = Posed::new(job, (None, job.target.views.clone(), is_repeated), &first)?;
            (Some(Arc::new(posed)), told)
        };
        let strips = match &posed {
            Some(posed) => {
                let rest = Share { whole: progress, from: 0.5, to: 1.0 };
                let (strips, further) = KeptStrips::new(job, &posed.geometry, &rest)?;
                told.extend(further);
                strips
            }
            None => KeptStrips::default(),
        };
        let geometry = match &posed {
            None if is_by_strips => balance_bytes(job) + bytes_of_passes(job),
            None => bytes_while_moving(job),
            Some(posed) if is_by_strips => posed.geometry.bytes() + strips.bytes() + bytes_of_passes(job),
            Some(posed) => posed.geometry.bytes(),
        };
        let needs = needs_of(job, posed.as_deref());
        let threads = rayon::current_num_threads();
        let frames = if job.outputs.go_on { usize::MAX } else { job.outputs.frames.len() };
        let mut queue_depth = job.memory.queue_depth(needs, (frames, job.target.files.len()), geometry, threads);
        if !job.layers.groups.is_empty() {
            // Further channels take the memory of many pictures, which was kept for one frame.
            queue_depth.written = 1;
        }
        let pool = Arc::new(FramePool::keeping(pool_bytes(job, needs, queue_depth)));
        let files = WriteOptions { pool: Arc::clone(&pool), ..options.files };
        let writer = Writer::new(&job.light, &job.layers.picture, WriterOptions { files, ..options });
        let (codec, posed, told) = (job.fixed_codec(), Mutex::new(posed), Mutex::new(told));
        let edges = job.worlds.iter().map(|_| OnceLock::new()).collect();
        let rows = job.rows_read().filter(|_| job.outputs.are_many());
        if let (Some((video, rows)), Some(videos)) = (&rows, job.files.videos()) {
            videos.expect_rows(video, rows.clone());
        }
        let rows = rows.map_or(0..usize::MAX, |(_, rows)| rows);
        Ok(Self {
            job,
            rows,
            codec,
            behind,
            posed,
            strips,
            told,
            writer,
            needs,
            queue_depth,
            pool,
            edges,
            lit: Mutex::default(),
        })
    }

    /// Adds diagnostics about geometry, each of which is told once.
    pub(super) fn will_tell(&self, found: Vec<Diagnostic>) {
        let mut told = lock(&self.told);
        for diagnostic in found {
            if !told.contains(&diagnostic) {
                told.push(diagnostic);
            }
        }
    }

    /// Takes the diagnostics about geometry, and about the world behind the input, that are not told yet.
    pub(crate) fn told(&self) -> Vec<Diagnostic> {
        let mut told = std::mem::take(&mut *lock(&self.told));
        told.extend(self.behind.iter().flat_map(|behind| behind.engine.told()));
        told
    }

    /// Returns the diagnostics about the light behind the input in all frames.
    pub(crate) fn tallied_behind(&self) -> Vec<Diagnostic> {
        self.behind.as_ref().map_or_else(Vec::new, |behind| behind.tallied())
    }

    /// Returns the geometry of a frame.
    pub(super) fn layer(&self, frame: &FrameOutputs, progress: &dyn Progress) -> Result<Layer> {
        let mut after = self.job.outputs.frames.iter().skip_while(|other| other.frame != frame.frame).skip(1);
        let frames = (frame.frame, after.next().map(|next| next.frame));
        self.layer_of(self.job.place(frame.frame), &|engine| engine.posed(frames, progress))
    }

    /// Returns the geometry of a moment of a frame's exposure, which is used once.
    pub(super) fn layer_at(&self, time: f64, frame: &FrameOutputs, progress: &dyn Progress) -> Result<Layer> {
        self.layer_of(self.job.place(frame.frame), &|engine| {
            let pose = engine.job.movement.as_ref().map(|movement| movement.pose(time));
            let views = engine.job.views_in(pose.as_ref())?;
            let made = Posed::new(engine.job, (pose, views, false), progress);
            made.map(|made| Arc::new(made.0)).map_err(|Stopped| engine.stopped())
        })
    }

    /// Returns the geometry of the input, and of what lies behind it, as `posed` gives it.
    fn layer_of(&self, place: usize, posed: &dyn Fn(&Engine) -> Result<Arc<Posed>>) -> Result<Layer> {
        let behind = self.behind.as_ref().map(|behind| behind.engine.layer_of(place, posed).map(Box::new));
        Ok(Layer { place, posed: posed(self)?, balanced: BalancedLight::default(), behind: behind.transpose()? })
    }

    /// Returns the number of worlds that a picture shows, one behind the other.
    pub(super) fn layers(&self) -> usize {
        1 + self.behind.as_ref().map_or(0, |behind| behind.engine.layers())
    }

    /// Returns the target's views in a frame, after which another one comes. They are kept, with their geometry, while the pose
    /// stays the same.
    fn posed(&self, (frame, next): (Option<u64>, Option<Option<u64>>), progress: &dyn Progress) -> Result<Arc<Posed>> {
        let pose = self.job.pose(frame);
        let mut last = lock(&self.posed);
        if let Some(posed) = last.as_ref().filter(|posed| posed.pose == pose) {
            return Ok(Arc::clone(posed));
        }
        // Never both at once.
        *last = None;
        let is_repeated = !self.job.is_by_strips() && next.is_some_and(|next| self.job.pose(next) == pose);
        let beginning = Share { whole: progress, from: 0.0, to: 0.0 };
        let views = self.job.views_in(pose.as_ref())?;
        let made = Posed::new(self.job, (pose, views, is_repeated), &beginning).map_err(|Stopped| self.stopped())?;
        let (posed, told) = (Arc::new(made.0), made.1);
        self.will_tell(told);
        *last = Some(Arc::clone(&posed));
        Ok(posed)
    }

    /// Returns how many frames may be read ahead and written behind the one that is filtered.
    pub(crate) fn queue_depth(&self) -> QueueDepth {
        self.queue_depth
    }

    /// Returns the pool of memory that frames hand on to those after them.
    pub(crate) fn pool(&self) -> &FramePool {
        &self.pool
    }

    /// Returns the figures of maps of light, in the order of frames.
    pub(crate) fn light_reports(&self) -> Vec<LightReport> {
        lock(&self.lit).clone()
    }

    /// Allocates the light of a frame.
    pub(crate) fn frame_light(&self) -> FrameLight {
        FrameLight::new(self.job, self.codec.is_some(), self.rows.clone())
    }

    /// Returns the writer of the pictures.
    pub(crate) fn writer(&self) -> &Writer {
        &self.writer
    }

    /// Returns a warning if the borders in this frame show that faces are clearly not as declared.
    pub(crate) fn continuity(&self, light: &FrameLight) -> Option<Diagnostic> {
        let given = self.job.input.faces.as_ref()?;
        // Of a stereo pair, the left eye's.
        let (views, sources) = (self.job.input.worlds.first()?.iter(), self.job.worlds.first()?.sources());
        let present = views.enumerate().filter(|(_, view)| view.present().is_some()).map(|(index, _)| index);
        let texels = |source: &Source| {
            let (width, first) = (source.view.width(), source.offset);
            move |i: usize, j: usize| light.texels().rgba(0, first + j * width + i)
        };
        let lights: Vec<_> = sources.iter().map(texels).collect();
        let size = |source: &Source| (source.view.width(), source.view.height());
        let pictures = sources.iter().zip(&lights).map(|(source, light)| FacePixels { size: size(source), light });
        let whole = || {
            let first = self.job.input.views().next().filter(|_| self.job.input.worlds.len() == 1)?;
            light_of(&*self.job.files, &first.files.path(self.job.outputs.frames.first()?.frame))
        };
        let told = given.warning(&present.zip(pictures).collect::<Vec<_>>(), whole)?;
        Some(Diagnostic::warning(Code::Arrangement, told))
    }

    /// Returns the warnings about the light of a frame.
    pub(crate) fn warnings(&self, frame: Option<u64>, light: &FrameLight) -> Vec<Diagnostic> {
        let tell = |(view, count): (&InputView, usize)| {
            let path = view.files.path(frame);
            let is_nan = counted(count, "is NaN and counts as missing", "are NaN and count as missing");
            let message = format!("{}: {is_nan}", path.display());
            Diagnostic::warning(Code::NotANumber, message).about(path.display())
        };
        // In a sequence, only the first frame is tested for suns, and for alpha that is nowhere full.
        let is_first = self.job.outputs.frames.first().is_some_and(|first| first.frame == frame);
        let suns = if is_first { warnings::suns(self.job, light) } else { None };
        let thin = if is_first { warnings::alpha(self.job, frame, light) } else { Vec::new() };
        let flat = |path: &Path| {
            let message = format!(
                "{}: transparent pixels, but the first frame has no alpha: they are laid over the background; to keep them \
                 transparent, give {BACKGROUND} transparent and a format with alpha",
                path.display()
            );
            Diagnostic::warning(Code::AlphaFlattened, message).about(path.display())
        };
        // What a still file lacks, it lacks in all frames.
        let is_new = |(view, _): &(&InputView, usize)| is_first || view.files.has_frames();
        self.incomplete(light)
            .filter(is_new)
            .map(tell)
            .chain(light.flattened().map(flat))
            .chain(thin)
            .chain(suns)
            .collect()
    }

    /// Visits the views with missing texels, and their number.
    pub(super) fn incomplete<'b>(&'b self, light: &'b FrameLight) -> impl Iterator<Item = (&'b InputView, usize)> {
        let views = self.job.input.present().zip(light.counts());
        views.map(|((view, ..), counts)| (view, counts.irregular.missing)).filter(|(_, count)| *count > 0)
    }

    /// Renders the pictures of a frame: filtered light over the background, with faces in their places.
    pub(crate) fn render(
        &self,
        frame: &FrameOutputs,
        light: &FrameLight,
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        if let Some(maps) = LightMaps::of(self.job, light.texels())? {
            return self.render_maps(frame, (light, &maps), progress);
        }
        if self.job.is_by_strips() {
            return self.strips(frame, light, progress);
        }
        if let Some(moments) = self.blur_of(frame)? {
            return self.render_blurred(FramePart { frame, strip: None }, (light, &moments), progress);
        }
        let layer = self.layer(frame, progress)?;
        let Target { views, files, .. } = &self.job.target;
        let sheets = frame.files.iter().flat_map(|(file, _)| files[*file].levels());
        let views: Vec<&View> = sheets.flat_map(|sheet| &sheet.pieces).map(|(index, _)| &views[*index].view).collect();
        let layers = &self.job.layers;
        // Once for the picture, with what is behind it, and once for each group of further channels.
        let times = if layers.leaves_picture_out() { 0 } else { self.layers() } + layers.groups.len();
        let all = views.iter().copied().cycle().take(views.len() * times);
        let mut making = Making { layer, shares: Shares::new(progress, all) };
        let mut picture = |(index, _): &(usize, PathBuf)| {
            if layers.leaves_picture_out() {
                return Ok(Levels::Light(Vec::new()));
            }
            let sheets: Vec<&Sheet> = files[*index].levels().collect();
            self.render_sheets(&sheets, (frame.frame, light), &mut making)
        };
        let pictures = frame.files.iter().map(&mut picture).collect::<Result<Vec<Levels>>>()?;
        if layers.is_plain() { Ok(pictures) } else { self.with_channels(frame, pictures, &mut making) }
    }

    /// Adds the further channels of a frame to its pictures.
    pub(super) fn with_channels(
        &self,
        frame: &FrameOutputs,
        pictures: Vec<Levels>,
        Making { layer, shares }: &mut Making,
    ) -> Result<Vec<Levels>> {
        let pass = LayerPass { job: self.job, posed: &layer.posed, pool: &self.pool };
        let sheets: Vec<&Sheet> = frame.files.iter().map(|(file, _)| &self.job.target.files[*file].sheet).collect();
        let made = pass.make(&FurtherFiles::new(self.job, frame.frame), &sheets, shares)?;
        let size = |(index, _): &(usize, PathBuf)| self.job.target.files[*index].sheet.size;
        let all = frame.files.iter().map(size).zip(pictures).zip(made);
        Ok(all.map(|((size, picture), planes)| self.writer.with_planes(picture, size, planes)).collect())
    }

    /// Makes the maps of light of a frame, and measures them.
    fn render_maps(
        &self,
        frame: &FrameOutputs,
        (light, maps): (&FrameLight, &LightMaps),
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let views = &self.job.target.views;
        let mut made: Vec<Image<Rgba>> = Vec::new();
        while made.len() < views.len() {
            made.push(maps.next(&made));
            if progress.advance(made.len() as f64 / views.len() as f64).is_break() {
                return Err(self.stopped());
            }
        }
        let scale = maps.scale(&mut made);
        if self.job.lighting.as_ref().is_some_and(LightSettings::fits) {
            self.writer.say(LightScale::remark(scale));
        }
        let measured: Vec<_> = views.iter().zip(&made).collect();
        let reports = LightReport::of(self.job, frame.frame, light.texels(), (&measured, scale));
        lock(&self.lit).extend(reports);
        let posed = self.layer(frame, progress)?.posed;
        frame.files.iter().map(|(file, _)| self.map_file((&posed, *file), &made)).collect()
    }

    /// Assembles the maps of light of a file.
    fn map_file(&self, (posed, file): (&Posed, usize), maps: &[Image<Rgba>]) -> Result<Levels> {
        let view = |index: usize| {
            let mut image = maps[index].clone();
            self.lay_background((posed, index), &mut image);
            Ok(image)
        };
        let picture = |sheet: &Sheet| sheet.assemble_in(&self.pool, self.job.light.background, view);
        Ok(Levels::Light(self.job.target.files[file].levels().map(picture).collect::<Result<_>>()?))
    }

    /// Renders sheets, whose pieces are views of the geometry in `making`.
    pub(super) fn render_sheets(
        &self,
        sheets: &[&Sheet],
        (frame, light): (Option<u64>, &FrameLight),
        making: &mut Making,
    ) -> Result<Levels> {
        if let (Texels::Fixed(worlds), Some(codec)) = (light.texels(), &self.codec) {
            let mut view = |index| self.codes(index, (worlds, codec), making);
            let picture = |sheet: &&Sheet| sheet.assemble_in(&self.pool, codec.background(), &mut view);
            return Ok(Levels::Codes(sheets.iter().map(picture).collect::<Result<_>>()?));
        }
        if let (Texels::Float(worlds), Some((encoder, background))) =
            (light.texels(), self.encoder_at_once(sheets, making))
        {
            let mut view = |index| self.samples(index, (worlds, encoder), making);
            let picture = |sheet: &&Sheet| sheet.assemble_in(&self.pool, background, &mut view);
            return Ok(Levels::Codes(sheets.iter().map(picture).collect::<Result<_>>()?));
        }
        let mut view = |index| self.render_view(index, (frame, light), making);
        let picture = |sheet: &&Sheet| sheet.assemble_in(&self.pool, self.job.light.background, &mut view);
        Ok(Levels::Light(sheets.iter().map(picture).collect::<Result<_>>()?))
    }

    /// Returns the encoder of sheets whose samples are made at once, without pictures of light, and those of the background: nothing else
    /// is done with its light, and each of its views has a plan.
    fn encoder_at_once(&self, sheets: &[&Sheet], making: &Making) -> Option<(&Encoder, [u8; 3])> {
        let (job, geometry) = (self.job, &making.layer.posed.geometry);
        let encoder = self.writer.encoder_alone().filter(|_| is_only_filtered(job))?;
        let background = encoder.rgb(job.light.background)?;
        let mut pieces = sheets.iter().flat_map(|sheet| &sheet.pieces);
        pieces.all(|(index, _)| geometry.encodes(*index, encoder)).then_some((encoder, background))
    }

    fn samples(
        &self,
        index: usize,
        (worlds, encoder): (&[Vec<Rgba>], &Encoder),
        making: &mut Making,
    ) -> Result<Image<[u8; 3]>> {
        let posed = &making.layer.posed;
        let target = &posed.views[index];
        let light = (&worlds[target.world(worlds.len())][..], self.job.light.background);
        let share = making.shares.next(&target.view);
        let made =
            posed.geometry.samples(index, self.job.resampler(target).watched(&share), light, encoder, &self.pool);
        made.map_err(|Stopped| self.stopped())
    }

    pub(super) fn codes(
        &self,
        index: usize,
        (worlds, codec): (&[FixedLight], &FixedCodec),
        making: &mut Making,
    ) -> Result<Image<[u8; 3]>> {
        let posed = &making.layer.posed;
        let target = &posed.views[index];
        let light = &worlds[target.world(worlds.len())];
        let share = making.shares.next(&target.view);
        let made = posed.geometry.codes(index, self.job.resampler(target).watched(&share), (light, codec), &self.pool);
        made.map_err(|Stopped| self.stopped())
    }

    pub(super) fn render_view(
        &self,
        index: usize,
        (frame, light): (Option<u64>, &FrameLight),
        Making { layer, shares }: &mut Making,
    ) -> Result<Image<Rgba>> {
        if self.is_solid() && self.is_complete(light) && !self.job.light.channels.has_alpha() {
            // A file without alpha shows everything in front of the background.
            return self.filtered(index, (light, self.job.light.background), layer, shares);
        }
        let mut image = self.layered(index, (frame, light), layer, shares)?;
        self.lay_background((&layer.posed, index), &mut image);
        Ok(image)
    }

    /// Renders a view of the target, with what lies behind it, over nothing.
    fn layered(
        &self,
        index: usize,
        (frame, light): (Option<u64>, &FrameLight),
        layer: &mut Layer,
        shares: &mut Shares,
    ) -> Result<Image<Rgba>> {
        let mut image = self.alone(index, (frame, light), layer, shares)?;
        let posed = Arc::clone(&layer.posed);
        if let (Some(behind), Some(layer)) = (&self.behind, &mut layer.behind) {
            behind.lay_under((&posed.views[index].view, &mut image), layer.place, |engine, light| {
                engine.layered(index, light, layer, shares)
            })?;
        }
        Ok(image)
    }

    /// Renders a view of the target, without what lies behind it, over nothing.
    pub(super) fn alone(
        &self,
        index: usize,
        (frame, light): (Option<u64>, &FrameLight),
        layer: &mut Layer,
        shares: &mut Shares,
    ) -> Result<Image<Rgba>> {
        let mut image = self.filtered(index, (light, Rgba::TRANSPARENT), layer, shares)?;
        self.close_holes((&layer.posed, index), (frame, light), &mut image)?;
        self.fill_unseen((&layer.posed, index), light, &mut image)?;
        self.thin(&mut image);
        Ok(image)
    }

    /// Filters a view of the target over a background.
    fn filtered(
        &self,
        index: usize,
        (light, background): (&FrameLight, Rgba),
        Layer { posed, balanced, .. }: &mut Layer,
        shares: &mut Shares,
    ) -> Result<Image<Rgba>> {
        let target = &posed.views[index];
        let share = shares.next(&target.view);
        if let Some(world) = self.job.formula() {
            let image = formula::light(world, &target.view, &self.job.light.working.primaries);
            return if share.advance(1.0).is_break() { Err(self.stopped()) } else { Ok(image) };
        }
        let Texels::Float(worlds) = light.texels() else { bail!("light of 8 bits where floats were expected") };
        let (resampler, place) = (self.job.resampler(target).watched(&share), target.world(worlds.len()));
        let tables = light.tables(self.job, place);
        let texels = WorldLight { texels: &worlds[place], tables, has_holes: self.has_holes(light) };
        let made = posed.geometry.light(index, resampler, texels, background, &self.pool, balanced);
        made.map_err(|Stopped| self.stopped())
    }

    /// Creates the error of a stopped frame, as if no frame were done: the caller knows how many are.
    pub(super) fn stopped(&self) -> ConvertError {
        ConvertError::Stopped { done: 0, frames: self.job.outputs.count() }
    }

    /// Returns whether nothing is seen through the input.
    pub(super) fn is_solid(&self) -> bool {
        self.behind.is_none() && self.job.opacity >= 1.0
    }

    /// Returns whether no texels are missing and every pixel has a view.
    pub(super) fn is_complete(&self, light: &FrameLight) -> bool {
        matches!(self.job.coverage, Coverage::Complete) && !self.has_holes(light)
    }

    /// Returns whether texels of opaque inputs are missing.
    pub(super) fn has_holes(&self, light: &FrameLight) -> bool {
        !self.job.light.input_alpha && self.incomplete(light).next().is_some()
    }
}

/// Returns the bytes of geometry that is kept while a moving camera stands still for several frames.
fn bytes_while_moving(job: &ConvertJob) -> u64 {
    let frames = &job.outputs.frames;
    let is_still = |pair: &[FrameOutputs]| job.pose(pair[0].frame) == job.pose(pair[1].frame);
    if !frames.windows(2).any(is_still) {
        return 0;
    }
    let arithmetic = arithmetic(job);
    let plans = job.target.views.iter().map(|target| job.resampler(target).plan_bytes_estimate(arithmetic) as u64);
    plans.sum::<u64>().min(job.memory.left_for_plan(job.frame_needs(), rayon::current_num_threads()))
}

/// Returns whether nothing is done with the light of frames but filtering and encoding it. Of formats that hold floats, texels may be
/// missing in any frame, and light may be brighter than samples hold, which is counted.
fn is_only_filtered(job: &ConvertJob) -> bool {
    let is_alone = job.layers().count() == 1 && job.opacity >= 1.0 && job.is_complete();
    let is_plain = job.layers.is_plain() && job.formula().is_none();
    job.input.holds_only_integers() && is_alone && is_plain && !job.is_blurred && !job.is_balance_asked_for()
}

/// Returns the memory of a frame. There are no pictures of light where samples are made at once.
fn needs_of(job: &ConvertJob, posed: Option<&Posed>) -> FrameNeeds {
    let encoder = Writer::encoder_alone_of(&job.light);
    let is_encoded = |(posed, encoder): (&Posed, &Encoder)| {
        (0..posed.views.len()).all(|index| posed.geometry.encodes(index, encoder))
    };
    let is_at_once = is_only_filtered(job) && posed.zip(encoder.as_ref()).is_some_and(is_encoded);
    if is_at_once { job.frame_needs_of_codes() } else { job.frame_needs() }
}

/// Returns how many bytes a pool may hold: as much as the frames in flight take, except their light, which has a buffer
/// of its own. It is 0 for a single picture, after which no other would use the memory.
fn pool_bytes(job: &ConvertJob, needs: FrameNeeds, queue_depth: QueueDepth) -> u64 {
    let FrameNeeds { light, prepared, .. } = needs;
    if job.outputs.are_many() { queue_depth.bytes.saturating_sub(light).saturating_sub(prepared) } else { 0 }
}
