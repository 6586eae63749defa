use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ChildStdin;

use cosmorama::raster::EncodedImage;
use cosmorama_io::pending::{Pending, Unfinished};

use super::arguments;
use super::carried::Plan;
use super::codec::Encoder;
use super::command::Parts;
use super::feed::{Header, RawFormat, Stamp, write_frame};
use super::verify::Expected;
use super::{Codec, Container, FrameTimes, WriteSettings, Written};
use crate::ffmpeg::{Child, Log};
use crate::spatial::{sound_fields, write_sound_fields};
use crate::{Ffmpeg, SphericalProjection, VideoError};

/// Video in progress. Dropped without [`VideoWriter::finish`], it ends its ffmpeg and leaves nothing behind.
pub struct VideoWriter {
    ffmpeg: Ffmpeg,
    path: PathBuf,
    settings: WriteSettings,
    container: Container,
    encoder: &'static str,
    format: RawFormat,
    plan: Plan,
    // Fields are dropped in order: ffmpeg is ended before its file is removed.
    frames: Option<BufWriter<ChildStdin>>,
    child: Child,
    log: Log,
    pending: Pending,
    count: u64,
    last: Option<i64>,
}

impl std::fmt::Debug for VideoWriter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("VideoWriter").field("path", &self.path).field("count", &self.count).finish_non_exhaustive()
    }
}

/// Longest side of a picture that encoders are given: the greatest even number of 16 bits, as which MP4, ProRes and DNxHR hold sizes.
pub(super) const LONGEST: usize = 65534;

impl VideoWriter {
    /// Checks that a video can be made with these settings, before there is any frame of it.
    ///
    /// # Errors
    /// When the extension, the size, the settings or further arguments fit no codec, or the encoder is missing in this build of ffmpeg.
    /// The folder is not looked at.
    pub fn check(ffmpeg: &Ffmpeg, path: &Path, settings: &WriteSettings) -> Result<(), VideoError> {
        arguments::check(&settings.arguments)?;
        let (container, codec, encoder) = chosen(ffmpeg, path, settings)?;
        let plan = &Plan::default();
        let parts = Parts { settings, container, codec, encoder: &encoder, plan, output: path };
        check_block(path, settings, parts.format())
    }

    /// Starts to encode, under a temporary name in the output's folder.
    ///
    /// # Errors
    /// When the extension, the settings or further arguments fit no codec, the encoder is missing in this build of ffmpeg, or nothing
    /// can be written there.
    pub fn create(
        ffmpeg: &Ffmpeg,
        path: &Path,
        settings: WriteSettings,
        unfinished: &Unfinished,
    ) -> Result<Self, VideoError> {
        arguments::check(&settings.arguments)?;
        let ffmpeg = &ffmpeg.clone().ending_with(unfinished);
        let (container, codec, encoder) = chosen(ffmpeg, path, &settings)?;
        let plan = Plan::of(&settings, container, ffmpeg.version());
        let pending = Pending::create(path, unfinished)?;
        let output = pending.path();
        let parts = Parts { settings: &settings, container, codec, encoder: &encoder, plan: &plan, output };
        let format = parts.format();
        check_block(path, &settings, format)?;
        let mut child = Child::start(parts.command(ffmpeg), "ffmpeg", ffmpeg.unfinished())?;
        let log = Log::of(child.stderr());
        let stdin = child.stdin().ok_or_else(|| failed(io::ErrorKind::BrokenPipe.into()))?;
        let encoder = encoder.name;
        let frames = Some(BufWriter::with_capacity(1 << 16, stdin));
        let mut writer = Self {
            ffmpeg: ffmpeg.clone(),
            path: path.to_owned(),
            settings,
            container,
            encoder,
            format,
            plan,
            frames,
            child,
            log,
            pending,
            count: 0,
            last: None,
        };
        writer.begin()?;
        Ok(writer)
    }

    fn begin(&mut self) -> Result<(), VideoError> {
        // Boxes are written afterwards, by our own hand: ffmpeg calls them unofficial.
        let spatial = self.settings.spatial.as_ref().filter(|_| !self.container.has_boxes());
        let header = Header {
            size: self.settings.size,
            format: self.format,
            rate: self.settings.rate(),
            hdr: &self.settings.hdr,
            spatial,
        };
        let written =
            self.frames.as_mut().map_or_else(|| Err(io::ErrorKind::BrokenPipe.into()), |sink| header.write(sink));
        written.map_err(|error| self.broken(error))
    }

    /// Gives the next frame. `time` is its time in ticks for [`FrameTimes::Stamps`], and `None` for a constant rate.
    ///
    /// # Errors
    /// When the frame is of another size, depth or kind than the settings say, times do not increase, or ffmpeg has failed.
    pub fn write(&mut self, frame: &EncodedImage, time: Option<i64>) -> Result<(), VideoError> {
        self.check_frame(frame)?;
        let time = self.time(time)?;
        let tick = self.settings.tick();
        let written = match &mut self.frames {
            Some(sink) => write_frame(sink, frame, self.format, Stamp { time, tick }),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        };
        written.map_err(|error| self.broken(error))?;
        self.count += 1;
        self.last = Some(time);
        Ok(())
    }

    /// Waits for the encoder, checks that all frames arrived, adds spherical tags, and gives the file its name.
    ///
    /// # Errors
    /// When ffmpeg fails, frames are missing in what it wrote, or the file cannot be finished. Nothing is left behind then.
    pub fn finish(mut self) -> Result<Written, VideoError> {
        if let Some(expected) = self.settings.frames.filter(|expected| *expected != self.count) {
            let found = format!("{} frames", self.count);
            return Err(VideoError::NotAsGiven {
                path: self.path,
                found,
                expected: format!("{expected} were to come"),
            });
        }
        if self.count == 0 {
            let (found, expected) = ("no frame".to_owned(), "a video has at least one".to_owned());
            return Err(VideoError::NotAsGiven { path: self.path, found, expected });
        }
        let flushed = self.frames.take().map_or(Ok(()), |mut sink| sink.flush());
        flushed.map_err(|error| self.broken(error))?;
        let status = self.child.wait().map_err(failed)?;
        let complaint = self.log.rest();
        if !status.success() || complaint.as_deref().is_some_and(is_fatal) {
            return Err(self.failed_by(complaint));
        }
        // It reads the film whose sound it copies, too.
        let of =
            self.settings.source.as_ref().map(|source| format!(" of this film, or of {}", source.info.path.display()));
        let of = of.unwrap_or_default();
        self.plan.notes.extend(complaint.map(|text| format!("ffmpeg says{of}: {text}")));
        self.add_boxes()?;
        let is_ours = !self.settings.arguments.iter().any(|word| decides_what_goes_along(word));
        let is_whole = self.settings.source.as_ref().is_none_or(|source| source.seconds.is_none());
        let metadata = self.settings.source.as_ref().map(|source| source.info.metadata.as_slice());
        let expected = Expected {
            frames: self.count,
            size: self.settings.size,
            is_spherical: self.settings.spatial.is_some_and(|tags| tags.projection.is_some()),
            // Arguments of the user's own may leave sound out, and a part may be without.
            sounds: (self.settings.arguments.is_empty() && is_whole).then(|| self.plan.sounds()),
            container: self.container,
            labelled: if is_ours { &self.plan.labelled } else { &[] },
            metadata: metadata.filter(|_| is_ours).unwrap_or_default(),
        };
        let lost = expected.verify(&self.ffmpeg, self.pending.path(), &self.path)?;
        self.plan.notes.extend(lost);
        self.pending.finish()?;
        Ok(Written { path: self.path, frames: self.count, encoder: self.encoder.to_owned(), notes: self.plan.notes })
    }

    fn add_boxes(&mut self) -> Result<(), VideoError> {
        if !self.container.has_boxes() {
            return Ok(());
        }
        let written = self.pending.path();
        if let Some(tags) = &self.settings.spatial {
            tags.write(written)?;
        }
        let Some(source) = self.settings.source.as_ref().filter(|_| self.plan.fields && self.plan.sounds() > 0) else {
            return Ok(());
        };
        match sound_fields(&source.info.path) {
            Ok(fields) if fields.iter().any(Option::is_some) => write_sound_fields(written, &fields),
            Ok(_) => Ok(()),
            // For a tag, a finished video is not thrown away.
            Err(error) => {
                self.plan.notes.push(format!("tags of spatial sound do not go along: {error}"));
                Ok(())
            }
        }
    }

    fn time(&self, time: Option<i64>) -> Result<i64, VideoError> {
        let wrong = |found: String, expected: &str| self.wrong(found, expected.to_owned());
        match (self.settings.times, time) {
            (FrameTimes::Even { .. }, None) => Ok(self.count.cast_signed()),
            (FrameTimes::Even { .. }, Some(_)) => {
                Err(wrong("has a time".to_owned(), "none, since the rate is constant"))
            }
            (FrameTimes::Stamps { .. }, None) => Err(wrong("has no time".to_owned(), "one for each frame")),
            (FrameTimes::Stamps { .. }, Some(time)) => match self.last {
                Some(last) if time <= last => {
                    Err(wrong(format!("has the time {time}, after {last}"), "times that increase"))
                }
                None if time < 0 => Err(wrong(format!("has the time {time}"), "0 or more")),
                _ => Ok(time),
            },
        }
    }

    fn check_frame(&self, frame: &EncodedImage) -> Result<(), VideoError> {
        let (size, channels) = ((frame.width(), frame.height()), self.format.channels());
        let is_right = size == self.settings.size
            && frame.channels() == channels
            && !frame.depth().is_float()
            && (frame.depth().bytes() == 2) == self.format.is_deep();
        if is_right {
            return Ok(());
        }
        let found = format!("has {}x{} pixels, {}, depth {}", size.0, size.1, frame.channels(), frame.depth());
        let (width, height) = self.settings.size;
        let depth = if self.format.is_deep() { "10 to 16" } else { "8" };
        Err(self.wrong(found, format!("{width}x{height} pixels, {channels}, depth {depth}")))
    }

    fn wrong(&self, found: String, expected: String) -> VideoError {
        VideoError::WrongFrame { name: self.path.display().to_string(), frame: self.count, found, expected }
    }

    /// Returns the reason for a pipe that nobody reads any more, in ffmpeg's own words.
    fn broken(&mut self, error: io::Error) -> VideoError {
        self.frames = None;
        if error.kind() != io::ErrorKind::BrokenPipe {
            return failed(error);
        }
        let words = self.log.cause();
        self.failed_by(words)
    }

    /// Returns the error with ffmpeg's words, and with the user's own arguments, which may be what it complains of.
    fn failed_by(&mut self, words: Option<String>) -> VideoError {
        let mut ended = || self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
        let words = words.unwrap_or_else(|| format!("it says nothing, and ended with {}", ended()));
        let own = self.settings.arguments.join(" ");
        let reason = if own.is_empty() { words } else { format!("{words}; its further arguments were {own}") };
        VideoError::Encode { path: self.path.clone(), reason }
    }
}

/// Returns whether an argument of the user's own decides what goes along with the pictures.
fn decides_what_goes_along(word: &str) -> bool {
    ["-an", "-sn", "-dn"].contains(&word)
        || ["-map", "-metadata", "-disposition"].iter().any(|option| word.starts_with(option))
}

/// Returns whether a message means that the file is not whole, even where ffmpeg then ends with success.
fn is_fatal(text: &str) -> bool {
    let words = ["No space left", "Input/output error", "Error writing", "av_interleaved_write_frame", "Error muxing"];
    words.iter().any(|words| text.contains(words))
}

/// Chooses container and codec.
fn chosen(ffmpeg: &Ffmpeg, path: &Path, settings: &WriteSettings) -> Result<(Container, Codec, Encoder), VideoError> {
    let container = Container::of_path(path).ok_or_else(|| VideoError::UnknownContainer { path: path.to_owned() })?;
    check(path, settings)?;
    let (codec, encoder) = Codec::choose(ffmpeg, path, container, settings)?;
    Ok((container, codec, encoder))
}

fn check(path: &Path, settings: &WriteSettings) -> Result<(), VideoError> {
    let cannot = |found: String, expected: &str| VideoError::CannotHold {
        path: path.to_owned(),
        found,
        expected: expected.to_owned(),
    };
    let (width, height) = settings.size;
    if !(1..=LONGEST).contains(&width) || !(1..=LONGEST).contains(&height) {
        return Err(cannot(format!("frames of {width}x{height} pixels"), &format!("1 to {LONGEST} columns and rows")));
    }
    if settings.depth.is_float() {
        return Err(cannot(format!("frames of depth {}", settings.depth), "integers: depth 8, 10, 12 or 16"));
    }
    if settings.spatial.is_some_and(|tags| tags.projection == Some(SphericalProjection::Mesh)) {
        return Err(cannot("the tag of a mesh".to_owned(), "an equirectangular projection or a cube"));
    }
    Ok(())
}

/// Refuses frames that are longer than ffmpeg reads from the stream in which it gets them.
fn check_block(path: &Path, settings: &WriteSettings, format: RawFormat) -> Result<(), VideoError> {
    /// Bytes of a block, with its header, in ffmpeg's reader of Matroska.
    const LONGEST_BLOCK: usize = (1 << 28) - 16;
    let (width, height) = settings.size;
    let samples = width.saturating_mul(height).saturating_mul(format.channels().count());
    let bytes = samples.saturating_mul(if format.is_deep() { 2 } else { 1 });
    if bytes <= LONGEST_BLOCK {
        return Ok(());
    }
    Err(VideoError::CannotHold {
        path: path.to_owned(),
        found: format!("frames of {width}x{height} pixels with {bytes} bytes"),
        expected: format!(
            "at most {LONGEST_BLOCK} bytes, as of 9459x9459 pixels of 8 bits or 6688x6688 of more; write frames as files"
        ),
    })
}

fn failed(source: io::Error) -> VideoError {
    VideoError::Run { program: "ffmpeg".to_owned(), source }
}
