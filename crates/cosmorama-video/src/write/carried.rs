//! Sound, subtitles, chapters and metadata of another video: copied where the container can hold them, else coded anew or left out,
//! which is said.

use std::ffi::OsString;

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
    /// Number of streams of sound in the output.
    pub(super) sounds: usize,
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

/// Seconds below which a shift is a rounding error.
const NOTHING: f64 = 1e-4;

/// Seconds below which nobody sees that subtitles come late.
const UNSEEN: f64 = 0.1;

/// First version of ffmpeg that leaves subtitles out by their times.
const DROPS: Version = Version { major: 5, minor: 0 };

/// Place of subtitles that are coded anew.
#[derive(Clone, Copy)]
enum Recoded {
    /// They begin with the sound.
    Along,
    /// They begin with the file, an instant before the pictures.
    FromFile,
    /// They begin with the part, without those that are shown before.
    WithPart,
}

impl Plan {
    pub(super) fn of(settings: &WriteSettings, container: Container, version: Version) -> Self {
        let Some(Carried { info, seconds }) = &settings.source else { return Self::default() };
        let mut plan = Self::default();
        // Seconds are counted from the first frame, by ffmpeg from the file's beginning.
        let first = info.start as f64 * info.time_base.to_f64() - info.file_start;
        let start = first + seconds.as_ref().map_or(0.0, |seconds| seconds.start);
        plan.input.extend(input_limits().map(OsString::from));
        let is_later = start > NOTHING;
        if is_later {
            // Packets that begin before would be copied, from the last key frame of the pictures on.
            plan.output.extend(["-copypriorss".to_owned(), "0".to_owned()]);
            plan.input.extend(["-ss".to_owned(), format!("{start:.6}")].map(OsString::from));
        }
        if let Some(seconds) = seconds {
            let length = (seconds.end - seconds.start).max(0.0);
            plan.input.extend(["-t".to_owned(), format!("{length:.6}")].map(OsString::from));
            // Chapters that begin later are left out by the output's length alone; one that begins at its very end would be empty.
            let shorter = (0.25 / settings.rate().to_f64()).min(INSTANT);
            plan.output.extend(["-t".to_owned(), format!("{:.6}", length - shorter)]);
        }
        plan.input.extend([OsString::from("-i"), url(&info.path)]);
        let recoded = match seconds {
            _ if !is_later => Some(Recoded::Along),
            None if start < UNSEEN => Some(Recoded::FromFile),
            _ => (version >= DROPS).then_some(Recoded::WithPart),
        };
        for stream in &info.others {
            // MOV keeps the names of its chapters in a stream.
            let are_chapters = stream.codec == "bin_data" && info.chapters > 0;
            if !are_chapters {
                plan.add(stream, (info, container), recoded);
            }
        }
        plan.fields = container.has_boxes() && is_boxes(&info.container);
        // They are taken from an instant later on, without one that ends where the part begins.
        let has_earlier = is_later && info.chapters > 0;
        let chapters = if has_earlier { plan.add_input(info, Some(start + INSTANT)) } else { 1 };
        plan.output.extend(["-map_metadata", "1", "-map_chapters", &chapters.to_string()].map(str::to_owned));
        for name in ["major_brand", "minor_version", "compatible_brands"] {
            plan.output.extend(["-metadata".to_owned(), format!("{name}=")]);
        }
        plan.add_timecode(settings);
        plan
    }

    /// Adds the file once more, from some seconds on, and returns the input's number.
    fn add_input(&mut self, info: &VideoInfo, start: Option<f64>) -> usize {
        self.input.extend(input_limits().map(OsString::from));
        if let Some(start) = start {
            self.input.extend(["-ss".to_owned(), format!("{start:.6}")].map(OsString::from));
        }
        self.input.extend([OsString::from("-i"), url(&info.path)]);
        self.input.iter().filter(|argument| *argument == "-i").count()
    }

    fn add(&mut self, stream: &OtherStream, (info, container): (&VideoInfo, Container), recoded: Option<Recoded>) {
        let answer = match stream.kind {
            StreamKind::Audio => sound(&stream.codec, container),
            StreamKind::Subtitle => match subtitle(&stream.codec, container) {
                Answer::Code(_) if recoded.is_none() => Answer::Leave,
                answer => answer,
            },
            StreamKind::Video | StreamKind::Data => Answer::Leave,
        };
        let kind = match stream.kind {
            StreamKind::Audio => "sound",
            StreamKind::Subtitle => "subtitles",
            StreamKind::Video => "video",
            StreamKind::Data => "data",
        };
        let name = format!("stream {} ({kind}, {})", stream.index, stream.codec);
        let is_sound = stream.kind == StreamKind::Audio;
        let at = if is_sound { format!("a:{}", self.sounds) } else { format!("s:{}", self.subtitles()) };
        let encoder = match answer {
            // The time code has a place of its own.
            Answer::Leave if stream.kind == StreamKind::Data && stream.codec.is_empty() => return,
            Answer::Leave => {
                return self.notes.push(format!(
                    "{name} is left out: {} has no room for it, or not for a part of it",
                    container.name()
                ));
            }
            Answer::Copy => "copy",
            Answer::Code(encoder) => {
                self.notes
                    .push(format!("{name} is coded anew by {encoder}: {} cannot hold it as it is", container.name()));
                encoder
            }
        };
        let recoded = recoded.filter(|_| stream.kind == StreamKind::Subtitle && encoder != "copy");
        let input = match recoded {
            Some(Recoded::FromFile) => self.add_input(info, None),
            _ => 1,
        };
        if let Some(Recoded::WithPart) = recoded {
            // With those that are shown before, ffmpeg would delay the pictures until then.
            self.output.extend([format!("-bsf:{at}"), "noise=drop=lt(pts\\,0)".to_owned()]);
        }
        let map = format!("{input}:{}", stream.index);
        self.output.extend(["-map".to_owned(), map, format!("-c:{at}"), encoder.to_owned()]);
        if matches!(encoder, "aac" | "libopus") {
            self.output.extend([format!("-b:{at}"), format!("{}k", 96 * stream.channels.clamp(1, 16))]);
        }
        self.sounds += usize::from(is_sound);
    }

    fn subtitles(&self) -> usize {
        self.output.iter().filter(|argument| argument.starts_with("-c:s:")).count()
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

fn sound(codec: &str, container: Container) -> Answer {
    let is_raw = codec.starts_with("pcm_");
    match container {
        Container::Matroska => Answer::Copy,
        Container::WebM if matches!(codec, "opus" | "vorbis") => Answer::Copy,
        Container::WebM => Answer::Code("libopus"),
        Container::Mov if is_raw => Answer::Copy,
        // Without loss, where MP4 has no raw samples.
        Container::Mp4 if is_raw => Answer::Code("alac"),
        Container::Mp4 if matches!(codec, "opus" | "flac") => Answer::Copy,
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
        (Container::Matroska, "eia_608" | "") => Answer::Leave,
        (Container::Matroska, _) => Answer::Copy,
        _ => Answer::Leave,
    }
}
