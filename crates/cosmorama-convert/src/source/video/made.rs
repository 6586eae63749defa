//! Videos that are made: pictures come in any order from many threads, and go to the encoder in the order of frames.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cosmorama::raster::{Depth, EncodedImage, FramePool};
use cosmorama_io::IoError;
use cosmorama_io::pending::Unfinished;
use cosmorama_spec::FrameRate;
use cosmorama_video::{
    Carried, Codec, ColourTags, Container, Ffmpeg, FrameTimes, Ratio, Timeline, VideoError, VideoInfo, VideoWriter,
    WriteSettings,
};

use super::raw::{RawWriter, aside, foreign};
use super::{DamagedFrames, PictureSink, RawKind, VideoPlan, Videos, described};
use crate::diagnostic::{Code, ConvertError, Diagnostic, FPS, FRAMES, Result, SIZE, VIDEO_CODEC, usage, usage_as};

/// Videos that a conversion makes.
#[derive(Debug, Default)]
pub(crate) struct MadeVideos {
    all: Vec<(PathBuf, MadeVideo)>,
}

/// A video in progress.
#[derive(Debug)]
struct MadeVideo {
    times: Vec<i64>,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    writer: Option<Encoder>,
    /// Number of frames that the encoder has.
    given: usize,
    /// Pictures that came before their turn.
    early: BTreeMap<usize, EncodedImage>,
    /// Places of frames that are left out.
    left_out: BTreeSet<usize>,
}

/// Encoder of a video.
#[derive(Debug)]
enum Encoder {
    Film(Box<VideoWriter>),
    Raw(Box<RawWriter>),
}

/// Video among the inputs, with the numbers of the frames that are shown.
#[derive(Clone, Copy, Debug)]
struct Shown<'a> {
    info: &'a VideoInfo,
    frames: &'a [u64],
    /// Times of its frames, if the rate varies.
    timeline: Option<&'a Timeline>,
}

/// Rate of a video when nothing else tells one.
const USUAL: FrameRate = FrameRate { frames: 30, seconds: 1 };

/// Returns the codec of a video, by its name unless one is chosen.
fn codec_of(path: &Path, chosen: Option<&str>, is_deep: bool) -> Option<Codec> {
    let usual = || Some(Codec::usual(Container::of_path(path)?, is_deep));
    chosen.map_or_else(usual, Codec::of_name)
}

impl MadeVideos {
    /// Checks the settings of videos of these sizes before anything is read for them.
    pub(crate) fn check(
        outputs: &[(PathBuf, (usize, usize))],
        plan: &VideoPlan,
        videos: Option<&Videos>,
    ) -> Result<()> {
        codec(plan)?;
        let films = || outputs.iter().filter(|(path, _)| RawKind::of(path).is_none());
        if let Some((path, _)) = films().find(|(path, _)| Container::of_path(path).is_none()) {
            return Err(unfit(VideoError::UnknownContainer { path: path.clone() }));
        }
        if films().next().is_none() {
            return Ok(());
        }
        let ffmpeg = found_ffmpeg(videos)?;
        for (path, size) in films() {
            VideoWriter::check(&ffmpeg, path, &settings(plan, *size)?).map_err(unfit)?;
        }
        Ok(())
    }

    /// Returns whether a video keeps alpha, by its name and the codec that is chosen: ProRes, FFV1 and, of 8 bits, VP9.
    pub(crate) fn holds_alpha(path: &Path, codec: Option<&str>, is_deep: bool) -> bool {
        match RawKind::of(path) {
            Some(kind) => kind == RawKind::Pam,
            None => codec_of(path, codec, is_deep).is_some_and(|codec| codec.holds_alpha(is_deep)),
        }
    }

    /// Returns the bytes of memory that ffmpeg holds to make a video of frames of a size, about.
    pub(crate) fn memory(path: &Path, size: (usize, usize), plan: &VideoPlan) -> u64 {
        let is_deep = plan.depth != Depth::Eight || ColourTags::of(&plan.primaries, &plan.transfer).is_hdr();
        let holds =
            |codec: &Codec| Container::of_path(path).is_some_and(|container| container.codecs().contains(codec));
        let codec = codec_of(path, plan.settings.codec.as_deref(), is_deep).filter(holds);
        codec.map_or(0, |codec| codec.encoding_bytes(size, is_deep, plan.channels.has_alpha()))
    }

    /// Returns the bytes of a video in hundredths of those of its samples, about: those of rendered pictures with some noise.
    pub(crate) fn percent(path: &Path, codec: Option<&str>) -> u64 {
        let coded = codec_of(path, codec, false).filter(|_| RawKind::of(path).is_none());
        coded.map_or(100, |codec| match codec {
            Codec::H264 | Codec::Hevc | Codec::Av1 | Codec::Vp9 => 10,
            Codec::ProRes | Codec::DnxHr => 25,
            Codec::Ffv1 => 65,
        })
    }

    /// Starts the encoders of videos of these sizes.
    pub(crate) fn start(
        outputs: &[(PathBuf, (usize, usize))],
        (plan, videos): (&VideoPlan, Option<&Videos>),
        (sink, unfinished): (Option<&PictureSink>, &Unfinished),
        told: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        if outputs.is_empty() {
            return Ok(Self::default());
        }
        let (mut info, mut rate) = (None, plan.settings.rate);
        if let (Some(shown), Some(videos)) = (&plan.source, videos) {
            info = videos.info(&shown.video)?;
            rate = rate.or(videos.rate(&shown.video)?);
        }
        // At another rate, frames do not keep their times, and no sound goes along.
        let has_times = |info: &&VideoInfo| info.is_variable && rate.is_none_or(|rate| ratio(rate) == info.rate);
        let timeline = info.as_ref().filter(has_times).map(|info| timeline(videos, info)).transpose()?;
        let frames = plan.source.as_ref().map(|source| &source.frames[..]);
        let source =
            info.as_ref().zip(frames).map(|(info, frames)| Shown { info, frames, timeline: timeline.as_ref() });
        // Netpbm's streams name no rate.
        let is_netpbm = |path: &Path| matches!(RawKind::of(path), Some(RawKind::Pam | RawKind::Pfm));
        let names_rate = outputs.iter().any(|(path, _)| !is_netpbm(path));
        let (times, stamps) = times((rate, plan, names_rate), source, told);
        let mut all = Vec::new();
        for (path, size) in outputs {
            let state =
                |writer| State { writer: Some(writer), given: 0, early: BTreeMap::new(), left_out: BTreeSet::new() };
            if let Some(kind) = RawKind::of(path) {
                let writer = RawWriter::create(kind, path, (*size, plan.depth, rate_of(times)), (sink, unfinished))?;
                let video = MadeVideo { times: Vec::new(), state: Mutex::new(state(Encoder::Raw(Box::new(writer)))) };
                all.push((path.clone(), video));
                continue;
            }
            let ffmpeg = found_ffmpeg(videos)?;
            let common = settings(plan, *size)?;
            let is_hdr = common.colour.is_hdr();
            let settings = WriteSettings {
                times,
                hdr: source.map(|source| source.info.hdr).filter(|_| is_hdr).unwrap_or_default(),
                source: carried(source, times, told),
                ..common
            };
            let writer = VideoWriter::create(&ffmpeg, path, settings, unfinished).map_err(foreign)?;
            let video = MadeVideo { times: stamps.clone(), state: Mutex::new(state(Encoder::Film(Box::new(writer)))) };
            all.push((path.clone(), video));
        }
        Ok(Self { all })
    }

    /// Returns whether an output is one of the videos.
    pub(crate) fn holds(&self, path: &Path) -> bool {
        self.all.iter().any(|(other, _)| other == path)
    }

    /// Gives the picture of a frame to a video, by the frame's place among all. Its memory goes to a pool.
    pub(crate) fn put(&self, path: &Path, place: usize, image: EncodedImage, pool: &FramePool) -> Result<(), IoError> {
        let Some((_, video)) = self.all.iter().find(|(other, _)| other == path) else { return Ok(()) };
        video.put(path, (place, image), pool).map_err(foreign)
    }

    /// Leaves a frame out of all videos.
    pub(crate) fn leave_out(&self, place: usize, pool: &FramePool) -> Result<(), IoError> {
        self.all.iter().try_for_each(|(path, video)| video.leave_out(path, place, pool)).map_err(foreign)
    }

    /// Waits for the encoders. The videos then appear under their names. Returns notes about what they could not hold.
    pub(crate) fn finish(&self) -> Result<Vec<Diagnostic>, IoError> {
        let mut told = Vec::new();
        for (path, video) in &self.all {
            let Some(writer) = video.state().writer.take() else { continue };
            let notes = writer.finish().map_err(foreign)?;
            let path = path.display();
            told.extend(
                notes
                    .iter()
                    .map(|note| Diagnostic::warning(Code::MetadataLost, format!("{path}: {note}")).about(&path)),
            );
        }
        Ok(told)
    }
}

impl MadeVideo {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes a picture. Threads wait here for the encoder, which waits for no thread. Pictures that come early are as many as are in
    /// flight.
    fn put(&self, path: &Path, (place, image): (usize, EncodedImage), pool: &FramePool) -> Result<(), VideoError> {
        let mut state = self.state();
        state.early.insert(place, image);
        self.write(path, &mut state, pool)
    }

    /// Leaves a frame out.
    fn leave_out(&self, path: &Path, place: usize, pool: &FramePool) -> Result<(), VideoError> {
        let mut state = self.state();
        state.left_out.insert(place);
        self.write(path, &mut state, pool)
    }

    /// Gives the encoder the pictures whose turn it is.
    fn write(&self, path: &Path, state: &mut State, pool: &FramePool) -> Result<(), VideoError> {
        loop {
            let given = state.given;
            let image = state.early.remove(&given);
            if image.is_none() && !state.left_out.contains(&given) {
                return Ok(());
            }
            state.given += 1;
            let (Some(image), Some(writer)) = (image, &mut state.writer) else { continue };
            writer.write(path, &image, self.times.get(given).copied())?;
            pool.give(image.into_samples());
        }
    }
}

impl Encoder {
    fn write(&mut self, path: &Path, image: &EncodedImage, time: Option<i64>) -> Result<(), VideoError> {
        match self {
            Self::Film(writer) => aside(|| writer.write(image, time), &path.display().to_string()),
            Self::Raw(writer) => writer.write(image, &path.display().to_string()),
        }
    }

    /// Finishes the file, and returns notes about what it cannot hold.
    fn finish(self) -> Result<Vec<String>, VideoError> {
        match self {
            Self::Film(writer) => Ok(writer.finish()?.notes),
            Self::Raw(writer) => writer.finish().map(|()| Vec::new()),
        }
    }
}

impl Shown<'_> {
    /// Returns the part of the video that is shown, in seconds from its first frame; `None` for all of it.
    fn part(&self) -> Option<Range<f64>> {
        let (first, last) = (*self.frames.first()?, *self.frames.last()?);
        let announced = self.info.announced.map(|announced| announced.frames);
        let count = self.timeline.and_then(Timeline::frames).or(announced);
        let is_all = first == 0 && count.is_some_and(|count| last + 1 >= count);
        (!is_all).then(|| self.seconds(first)..self.seconds(last + 1))
    }

    /// Returns when a frame begins, or the last one ends.
    fn seconds(&self, frame: u64) -> f64 {
        let even = 1.0 / self.info.rate.to_f64();
        let Some(timeline) = self.timeline else { return frame as f64 * even };
        let since = |time: i64| (time - timeline.time(0).unwrap_or_default()) as f64 * timeline.time_base().to_f64();
        match (timeline.time(frame), timeline.frames().and_then(|count| timeline.time(count - 1))) {
            (Some(time), _) => since(time),
            // How long the last frame is shown, nothing tells.
            (None, last) => last.map_or(0.0, since) + even,
        }
    }
}

/// Finds the installed programs, if the videos that are read have not.
fn found_ffmpeg(videos: Option<&Videos>) -> Result<Arc<Ffmpeg>> {
    match videos {
        Some(videos) => Ok(videos.ffmpeg()?),
        None => Ok(Arc::new(Ffmpeg::find().map_err(foreign)?)),
    }
}

/// Finds the times of a video's frames.
fn timeline(videos: Option<&Videos>, info: &VideoInfo) -> Result<Timeline> {
    Ok(found_ffmpeg(videos)?.timeline(info).map_err(foreign)?)
}

fn rate_of(times: FrameTimes) -> Ratio {
    match times {
        FrameTimes::Even { rate } | FrameTimes::Stamps { rate, .. } => rate,
    }
}

fn ratio(rate: FrameRate) -> Ratio {
    Ratio::new(rate.frames.into(), rate.seconds.into()).unwrap_or(Ratio::ONE)
}

/// Returns the settings of a video that do not depend on a source.
fn settings(plan: &VideoPlan, size: (usize, usize)) -> Result<WriteSettings> {
    Ok(WriteSettings {
        depth: plan.depth,
        has_alpha: plan.channels.has_alpha(),
        colour: ColourTags::of(&plan.primaries, &plan.transfer),
        spatial: described::tags(plan.to.as_ref(), size),
        codec: codec(plan)?,
        arguments: plan.settings.arguments.clone(),
        frames: plan.frames.filter(|_| plan.settings.damaged != DamagedFrames::Skip),
        ..WriteSettings::new(size, Ratio::ONE)
    })
}

/// Returns the error about settings by which no video can be made, with what to change.
fn unfit(error: VideoError) -> ConvertError {
    match &error {
        VideoError::UnfitSize { .. } => {
            usage_as(Code::OutputFormat, format!("{error}; give such a {SIZE}, or another {VIDEO_CODEC}"))
        }
        VideoError::UnknownContainer { .. } | VideoError::CannotHold { .. } => {
            usage_as(Code::OutputFormat, error.to_string())
        }
        VideoError::UnfitArgument { .. } => usage(error.to_string()),
        _ => foreign(error).into(),
    }
}

fn codec(plan: &VideoPlan) -> Result<Option<Codec>> {
    let Some(name) = &plan.settings.codec else { return Ok(None) };
    let known = || Codec::ALL.map(Codec::name).join(", ");
    let codec = Codec::of_name(name);
    codec.map(Some).ok_or_else(|| usage(format!("{VIDEO_CODEC} {name}: no such codec; choose one of {}", known())))
}

/// Returns the times of the frames, as settings and, of a variable rate, one by one.
fn times(
    (rate, plan, names_rate): (Option<FrameRate>, &VideoPlan, bool),
    source: Option<Shown>,
    told: &mut Vec<Diagnostic>,
) -> (FrameTimes, Vec<i64>) {
    let even = |rate: FrameRate| FrameTimes::Even { rate: ratio(rate) };
    if let Some(rate) = rate {
        return (even(rate), Vec::new());
    }
    let Some(Shown { info, frames, timeline }) = source else {
        if names_rate && plan.frames != Some(1) {
            let message = format!(
                "the video gets {USUAL} frames a second, since nothing tells its rate; give another with {FPS}"
            );
            told.push(Diagnostic::warning(Code::FrameRate, message));
        }
        return (even(USUAL), Vec::new());
    };
    let is_forward = frames.windows(2).all(|pair| pair[0] < pair[1]);
    if let Some(timeline) = timeline.filter(|_| is_forward) {
        let stamps: Option<Vec<i64>> = frames.iter().map(|frame| timeline.time(*frame)).collect();
        if let (Timeline::Listed { time_base, .. }, Some(stamps)) = (timeline, stamps) {
            let message = format!(
                "{}: the frame rate varies, and each frame keeps its time; {FPS} gives the video an even rate",
                info.path.display()
            );
            told.push(Diagnostic::note(Code::FrameRate, message));
            let first = stamps.first().copied().unwrap_or_default();
            let stamps = stamps.iter().map(|time| time - first).collect();
            return (FrameTimes::Stamps { time_base: *time_base, rate: info.rate }, stamps);
        }
    }
    (FrameTimes::Even { rate: info.rate }, Vec::new())
}

/// Returns what a video takes over of its source. Sound goes along if frames follow each other as they did.
fn carried(source: Option<Shown>, times: FrameTimes, told: &mut Vec<Diagnostic>) -> Option<Carried> {
    let Shown { info, frames, .. } = source?;
    let follows = |pair: &[u64]| pair[1] == pair[0] + 1;
    let why = if info.cut.is_some() {
        Some("the file is cut".to_owned())
    } else if !frames.windows(2).all(follows) {
        Some(format!("{FRAMES} leaves out frames between others"))
    } else {
        (rate_of(times) != info.rate).then(|| format!("{FPS} is another rate than its own, {}", info.rate))
    };
    if let Some(why) = why {
        if !info.others.is_empty() {
            let message = format!("{}: its sound and subtitles are left out, since {why}", info.path.display());
            told.push(Diagnostic::warning(Code::MetadataLost, message));
        }
        return None;
    }
    Some(Carried { info: info.clone(), seconds: source?.part() })
}
