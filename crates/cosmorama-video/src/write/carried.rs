//! Sound, subtitles, chapters and metadata of another video: copied where the container can hold them, else coded anew or left out,
//! which is said.

use std::ffi::OsString;

use super::labels::Labelled;
use super::{Carried, Container, FrameTimes, WriteSettings, timecode};
use crate::ffmpeg::{input_limits, url};
use crate::probe::is_boxes;
use crate::{OtherStream, StreamKind, Version, VideoInfo};

/// Arguments for what is copied.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// Arguments of the inputs behind the first.
    pub(super) input: Vec<OsString>,
    /// Arguments of the output.
    pub(super) output: Vec<String>,
    /// Labels of the video and of the streams that go along.
    pub(super) labelled: Vec<Labelled>,
    /// Whether boxes about the sound go along: between MP4 and MOV.
    pub(super) fields: bool,
    /// Statements on what is not copied.
    pub(super) notes: Vec<String>,
}

/// Answer to a stream that is to be copied.
enum Answer {
    Copy,
    /// Coded anew by this encoder.
    Code(&'static str),
    Leave,
}

/// Seconds in which nothing is seen or heard.
const INSTANT: f64 = 1e-3;

/// Seconds before a part from which on its film is read: sound may lie so long before the pictures of its time in the file.
const BEFORE: f64 = 5.0;

/// Seconds below which a shift is a rounding error.
const NOTHING: f64 = 1e-4;

/// Seconds below which nobody sees that subtitles come late.
const UNSEEN: f64 = 0.1;

/// First version of ffmpeg that leaves subtitles out by their times.
const DROPS: Version = Version { major: 5, minor: 0 };

/// Beginning of subtitles.
#[derive(Clone, Copy, PartialEq)]
enum Beginning {
    /// Beginning of sound and pictures.
    Along,
    /// Beginning of the file, an instant before the pictures.
    File,
    /// Beginning of the part, without subtitles that are shown before.
    Part,
}

/// Film and container that all streams share on their way.
struct Way<'a> {
    info: &'a VideoInfo,
    container: Container,
    /// Beginning of subtitles.
    beginning: Beginning,
    /// Seconds of the part.
    length: Option<f64>,
    version: Version,
}

impl Plan {
    pub(super) fn of(settings: &WriteSettings, container: Container, version: Version) -> Self {
        let Some(Carried { info, seconds }) = &settings.source else { return Self::default() };
        let mut plan = Self::default();
        // Seconds are counted from the first frame, by ffmpeg from the file's beginning.
        let first = info.start as f64 * info.time_base.to_f64() - info.file_start;
        let start = first + seconds.as_ref().map_or(0.0, |seconds| seconds.start);
        let is_later = start > NOTHING;
        if is_later {
            // Packets that begin before would be copied, from the last key frame of the pictures on.
            plan.output.extend(["-copypriorss".to_owned(), "0".to_owned()]);
        }
        if let Some(seconds) = seconds {
            let length = (seconds.end - seconds.start).max(0.0);
            // A chapter that begins at its very end would be empty.
            let shorter = (0.25 / settings.rate().to_f64()).min(2.0 * INSTANT);
            plan.output.extend(["-t".to_owned(), format!("{:.6}", length - shorter)]);
        }
        // Sound that is filtered or coded by the user's own arguments is not cut off by ours.
        let is_ours = !settings.arguments.iter().any(|word| filters_or_codes(word));
        let seek = if !is_ours {
            start
        } else if info.container == "mpeg" {
            // Program streams need not tell enough times to be found by.
            0.0
        } else {
            start - BEFORE
        };
        plan.add_input(info, start, seek);
        let beginning = if !is_later {
            Beginning::Along
        } else if start < UNSEEN {
            Beginning::File
        } else {
            Beginning::Part
        };
        let length = seconds.as_ref().map(|seconds| seconds.end - seconds.start);
        plan.add_streams(&Way { info, container, beginning, length, version });
        plan.fields = container.has_boxes() && is_boxes(&info.container);
        // They are taken from an instant later on, without one that ends where the part begins.
        let has_earlier = is_later && info.chapters > 0;
        let chapters = if has_earlier { plan.add_input(info, start + INSTANT, start) } else { 1 };
        plan.output.extend(["-map_metadata", "1", "-map_chapters", &chapters.to_string()].map(str::to_owned));
        for name in ["major_brand", "minor_version", "compatible_brands"] {
            plan.output.extend(["-metadata".to_owned(), format!("{name}=")]);
        }
        plan.add_timecode(settings);
        plan
    }

    fn add_streams(&mut self, way: &Way<'_>) {
        let Way { info, container, beginning, .. } = *way;
        let name = format!("stream {} (video, {})", info.stream, info.codec);
        let video = Labelled { name, kind: StreamKind::Video, labels: info.labels.clone() };
        self.output.extend(video.arguments("v:0", container));
        self.labelled.push(video);
        for stream in &info.others {
            // MOV keeps the names of its chapters in a stream.
            let are_chapters = stream.kind == StreamKind::Data && stream.codec == "text" && info.chapters > 0;
            if !are_chapters {
                self.add(stream, way);
            }
        }
        if beginning == Beginning::Part && self.count(StreamKind::Subtitle) > 0 {
            let note =
                "subtitles begin with the part: those that are shown before are left out, even where they stay on";
            self.notes.push(note.to_owned());
        }
    }

    /// Adds the file as an input whose times count from `start`, and which is read from the second `seek` on. Returns the input's number.
    fn add_input(&mut self, info: &VideoInfo, start: f64, seek: f64) -> usize {
        self.input.extend(input_limits().map(OsString::from));
        let seek = seek.max(0.0);
        if seek > NOTHING {
            self.input.extend(["-ss".to_owned(), format!("{seek:.6}")].map(OsString::from));
        }
        // Without a shift, ffmpeg counts transport streams from the first of the streams that it takes, and not of all.
        let shift = if start - seek > NOTHING { seek - start } else { 1e-6 };
        self.input.extend(["-itsoffset".to_owned(), format!("{shift:.6}")].map(OsString::from));
        self.input.extend([OsString::from("-i"), url(&info.path)]);
        self.input.iter().filter(|argument| *argument == "-i").count()
    }

    fn add(&mut self, stream: &OtherStream, way: &Way<'_>) {
        let Way { info, container, beginning, length, version } = *way;
        let name = format!("stream {} ({}, {})", stream.index, stream.kind.name(), stream.codec);
        let starts_with_part = stream.kind == StreamKind::Subtitle && beginning == Beginning::Part;
        let encoder = match answer(stream, container) {
            // It has a place of its own.
            _ if stream.kind == StreamKind::TimeCode => return,
            Answer::Code(_) if starts_with_part && version < DROPS => {
                return self.notes.push(format!(
                    "{name} is left out: ffmpeg {version} does not code it anew for {} without what comes before the part",
                    container.name()
                ));
            }
            Answer::Leave => {
                let reason = match stream.kind {
                    StreamKind::Video => "one video is written".to_owned(),
                    _ if stream.codec.is_empty() => "nobody knows its codec".to_owned(),
                    _ => format!("{} has no room for it", container.name()),
                };
                return self.notes.push(format!("{name} is left out: {reason}"));
            }
            Answer::Copy => "copy",
            Answer::Code(encoder) => {
                self.notes
                    .push(format!("{name} is coded anew by {encoder}: {} cannot hold it as it is", container.name()));
                encoder
            }
        };
        let at = match stream.kind {
            StreamKind::Audio => 'a',
            StreamKind::Attachment => 't',
            _ => 's',
        };
        let at = format!("{at}:{}", self.count(stream.kind));
        let input = match beginning {
            Beginning::File if stream.kind == StreamKind::Subtitle => self.add_input(info, 0.0, 0.0),
            _ => 1,
        };
        if stream.kind == StreamKind::Subtitle && version >= DROPS {
            self.drop_beside(&at, starts_with_part && encoder != "copy", length);
        }
        let map = format!("{input}:{}", stream.index);
        self.output.extend(["-map".to_owned(), map, format!("-c:{at}"), encoder.to_owned()]);
        if stream.kind == StreamKind::Audio && encoder != "copy" && beginning != Beginning::Along {
            self.output.extend([format!("-filter:{at}"), "atrim=start=0".to_owned()]);
        }
        if matches!(encoder, "aac" | "libopus") {
            self.output.extend([format!("-b:{at}"), format!("{}k", 96 * stream.channels.clamp(1, 16))]);
        }
        let labelled = Labelled { name, kind: stream.kind, labels: stream.labels.clone() };
        self.output.extend(labelled.arguments(&at, container));
        self.labelled.push(labelled);
    }

    fn count(&self, kind: StreamKind) -> usize {
        self.labelled.iter().filter(|stream| stream.kind == kind).count()
    }

    /// Returns the number of streams of sound in the output.
    pub(super) fn sounds(&self) -> usize {
        self.count(StreamKind::Audio)
    }

    /// Drops subtitles beside the part: of those that are shown before, ffmpeg would delay the pictures until then, and those behind would make
    /// the film longer.
    fn drop_beside(&mut self, at: &str, has_earlier: bool, length: Option<f64>) {
        let before = has_earlier.then(|| "lt(pts\\,0)".to_owned());
        let behind = length.map(|length| format!("gte(pts*tb\\,{length:.6})"));
        let beside: Vec<String> = before.into_iter().chain(behind).collect();
        if !beside.is_empty() {
            self.output.extend([format!("-bsf:{at}"), format!("noise=drop={}", beside.join("+"))]);
        }
    }

    fn add_timecode(&mut self, settings: &WriteSettings) {
        let Some(Carried { info, seconds }) = &settings.source else { return };
        let Some(code) = &info.timecode else { return };
        let start = seconds.as_ref().map_or(0.0, |seconds| seconds.start);
        let frames = (start * settings.rate().to_f64()).round().max(0.0) as u64;
        let is_even = matches!(settings.times, FrameTimes::Even { .. });
        match timecode::later(code, frames, settings.rate()).filter(|_| is_even) {
            Some(code) => self.output.extend(["-timecode".to_owned(), code]),
            None => self
                .notes
                .push(format!("the time code {} is left out: it is none of this frame rate", code.escape_debug())),
        }
    }
}

/// Returns whether an argument of the user's own filters streams, or chooses their coder.
fn filters_or_codes(word: &str) -> bool {
    word == "-c" || ["-c:", "-codec", "-acodec", "-af", "-filter"].iter().any(|option| word.starts_with(option))
}

fn answer(stream: &OtherStream, container: Container) -> Answer {
    match stream.kind {
        StreamKind::Audio => sound(&stream.codec, container),
        StreamKind::Subtitle => subtitle(&stream.codec, container),
        StreamKind::Attachment if container == Container::Matroska => Answer::Copy,
        StreamKind::Attachment | StreamKind::Video | StreamKind::TimeCode | StreamKind::Data => Answer::Leave,
    }
}

fn sound(codec: &str, container: Container) -> Answer {
    let is_raw = codec.starts_with("pcm_");
    match container {
        _ if codec.is_empty() => Answer::Leave,
        Container::Matroska => Answer::Copy,
        Container::WebM if matches!(codec, "opus" | "vorbis") => Answer::Copy,
        Container::WebM => Answer::Code("libopus"),
        Container::Mov if is_raw => Answer::Copy,
        // Without loss, where MP4 has no raw samples, and ffmpeg calls FLAC in it an experiment.
        Container::Mp4 if is_raw || codec == "flac" => Answer::Code("alac"),
        Container::Mp4 if codec == "opus" => Answer::Copy,
        _ if matches!(codec, "aac" | "mp3" | "mp2" | "ac3" | "eac3" | "alac") => Answer::Copy,
        Container::Mov => Answer::Code("pcm_s24le"),
        Container::Mp4 => Answer::Code("aac"),
    }
}

fn subtitle(codec: &str, container: Container) -> Answer {
    let is_text = matches!(codec, "mov_text" | "subrip" | "ass" | "ssa" | "webvtt" | "text");
    match (container, codec) {
        (Container::Mp4 | Container::Mov, "mov_text") | (Container::WebM, "webvtt") => Answer::Copy,
        (Container::Mp4 | Container::Mov, _) if is_text => Answer::Code("mov_text"),
        (Container::WebM, _) if is_text => Answer::Code("webvtt"),
        (Container::Matroska, "mov_text") => Answer::Code("srt"),
        (_, "") | (Container::Matroska, "eia_608") => Answer::Leave,
        (Container::Matroska, _) => Answer::Copy,
        _ => Answer::Leave,
    }
}
