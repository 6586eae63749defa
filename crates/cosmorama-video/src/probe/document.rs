//! Answer of ffprobe about a file.

use std::fs::File;
use std::path::Path;
use std::time::Duration;

use serde_json::Value;

use super::beginning::Beginning;
use super::container::{ASF, AVI, FLV, MXF, NUT, OGG, begins_anywhere, ends_with_its_file, is_boxes, is_matroska};
use super::first_frame::FirstFrame;
use super::packets::CodedStream;
use super::stream::{Stream, delay, is_statistic, ratio, text};
use super::timeline::Evenness;
use super::{Announced, AnnouncedBy, CutShort, OtherStream, Places, StreamKind, Timeline, VideoInfo, structure};
use crate::ffmpeg::Said;
use crate::labels::tag;
use crate::{Ffmpeg, Labels, SpatialTags, VideoError};

/// Time in which a file must be probed.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// Bytes of ffprobe's answer.
const ANSWER: usize = 16 << 20;

/// Options by which ffprobe looks for pictures for a minute, and not for five seconds: in a film that was cut out, they may begin long after
/// the sound.
const FAR: [&str; 4] = ["-analyzeduration", "60000000", "-probesize", "67108864"];

/// Frames in a second from which on a duration tells no number of them.
const FASTEST: f64 = 1e6;

impl Ffmpeg {
    /// Reads what a video is. One frame is decoded where only frames tell the tags of high dynamic range.
    ///
    /// # Errors
    /// When the file cannot be read, holds no video, or says impossible things of it.
    pub fn probe(&self, path: &Path) -> Result<VideoInfo, VideoError> {
        self.probed(path, None)
    }

    /// Reads what another of a file's videos is, by the number of its stream.
    pub(crate) fn probe_stream(&self, path: &Path, stream: u32) -> Result<VideoInfo, VideoError> {
        self.probed(path, Some(stream))
    }

    fn probed(&self, path: &Path, stream: Option<u32>) -> Result<VideoInfo, VideoError> {
        let cut = looked_at(path)?;
        let mut document = self.document(path, &[], cut)?;
        if streams(&document).iter().any(|stream| is_video(stream) && !is_seen(stream)) {
            document = self.document(path, &FAR, cut)?;
        }
        let no_video = || VideoError::NoVideo { path: path.to_owned(), reason: "it has no stream of video".to_owned() };
        let is_chosen = |found: &Value| {
            is_video(found) && stream.is_none_or(|index| found["index"].as_u64() == Some(u64::from(index)))
        };
        let number = streams(&document).iter().position(is_chosen).ok_or_else(no_video)?;
        let container = text(&document["format"], "format_name").unwrap_or_default().to_owned();
        let container = container.as_str();
        drop_copied_tags(&mut document, number, container);
        let tells_start = is_boxes(container) || (is_matroska(container) && cut.is_none());
        let beginning = self.beginning_of(path, container, &document["streams"][number], tells_start);
        if let Some(Beginning { start, .. }) = beginning.filter(|beginning| beginning.leading > 0 || !tells_start) {
            begin_at(&mut document["streams"][number], start, container);
        }
        let streams = streams(&document);
        let unknown = |error| match cut {
            Some(CutShort { expected, found }) => {
                VideoError::Cut { path: path.to_owned(), expected, found, is_described: false }
            }
            None => error,
        };
        let stream = Stream::read(path, &streams[number]).map_err(unknown)?;
        let format = &document["format"];
        let others = streams.iter().enumerate().filter(|(index, _)| *index != number);
        let mut others = others.map(|(_, stream)| other(stream)).collect::<Vec<_>>();
        let mut info = stream.into_info(path, container);
        if container == MXF {
            // They name its packages.
            let labels = others.iter_mut().map(|other| &mut other.labels).chain([&mut info.labels]);
            labels.for_each(|labels| labels.tags.clear());
        }
        info.begin(beginning);
        info.chapters = document["chapters"].as_array().map_or(0, Vec::len);
        info.file_start = text(format, "start_time").and_then(|time| time.parse().ok()).unwrap_or(0.0);
        if container == AVI {
            // Its frames are in the places at which they are decoded: their times count those that are kept back, and those of its sound do not.
            info.file_start += info.delay as f64 * info.time_base.to_f64();
        }
        info.metadata = metadata(format);
        info.timecode = timecode(&streams[number], streams, format);
        info.cut = cut;
        let alone = others.is_empty().then(|| text(format, "duration")).flatten();
        // FLV, NUT and Matroska count it from 0, and not from the first frame; ASF tells that of the longest stream; of bare streams, it is guessed.
        let counts_from_0 = [FLV, NUT].contains(&container) || is_matroska(container);
        let before = if counts_from_0 { info.start as f64 * info.time_base.to_f64() } else { 0.0 };
        info.duration = info.duration.or_else(|| Some(alone?.parse::<f64>().ok()? - before));
        info.duration = info.duration.filter(|_| (container != ASF || others.is_empty()) && !info.is_bare());
        info.others = others;
        info.announced = info.announced.or_else(|| announced_by_duration(&info));
        if cut.is_some() && ends_with_its_file(container) {
            info.announced = None;
        }
        self.complete(&mut info)?;
        Ok(info)
    }

    fn document(&self, path: &Path, arguments: &[&str], cut: Option<CutShort>) -> Result<Value, VideoError> {
        let shown = ["-of", "json", "-show_format", "-show_streams", "-show_chapters"];
        let said = self.ffprobe(path, &[arguments, &shown].concat(), ANSWER, PATIENCE)?;
        document(path, &said, cut)
    }

    /// Finds where a stream begins, if its container does not tell it, or frames before that are left out. What cannot be listed has nothing
    /// better than ffprobe's word.
    fn beginning_of(&self, path: &Path, container: &str, stream: &Value, tells_start: bool) -> Option<Beginning> {
        let delay = delay(stream);
        if tells_start && delay == 0 {
            return None;
        }
        let index = stream["index"].as_u64().and_then(|index| u32::try_from(index).ok())?;
        let codec = text(stream, "codec_name").unwrap_or_default();
        let coded = CodedStream { index, container, codec, delay };
        self.beginning(path, coded).ok().flatten()
    }

    /// Adds what only the file's boxes, or its first frame, tell.
    fn complete(&self, info: &mut VideoInfo) -> Result<(), VideoError> {
        // Matroska tells a rate, whatever the times of its frames, and so does Ogg, where Theora repeats frames by packets without a byte.
        if (is_matroska(&info.container) || info.container == OGG) && !info.is_variable {
            let evenness = self.evenness(info)?;
            info.is_variable = evenness != Evenness::Even;
            if let Evenness::Lacking(places) = evenness {
                info.empty_places = places;
            }
            // A duration tells no number of frames where their rate varies.
            let is_told = |told: &Announced| told.by == AnnouncedBy::Count || !info.is_variable;
            info.announced = info.announced.filter(is_told);
        }
        if is_boxes(&info.container) && info.cut.is_none() {
            self.count_lacking(info)?;
        }
        if info.container == AVI && info.cut.is_none() {
            self.count_places(info)?;
        }
        if is_boxes(&info.container) {
            match SpatialTags::read(&info.path) {
                Ok(tags) => info.spatial = tags.or(info.spatial),
                Err(error) => info.notes.push(format!("its spherical tags are not read: {error}")),
            }
        }
        if is_matroska(&info.container) {
            info.spatial = info.spatial.map(|told| told.exact_in_matroska(&info.path, info.coded_size));
        }
        // The messages of H.265 are in the stream itself, and containers need not repeat them.
        if info.colour.is_hdr() && info.hdr.mastering.is_none() {
            let frame = FirstFrame::read(self, info)?;
            info.hdr.mastering = frame.hdr.mastering;
            info.hdr.light = info.hdr.light.or(frame.hdr.light);
        }
        if begins_anywhere(&info.container) {
            info.early = self.early_frames(info)?;
        }
        if info.is_bare() {
            info.notes.push(format!(
                "it is a bare stream, of which no frame has a time; {} frames a second are taken; if it has others, give it them by ffmpeg \
                 -r RATE -i FILE -c copy FILE.mp4",
                info.rate
            ));
        }
        if info.colour.matrix.is_none() && !info.is_rgb && !info.is_grey {
            let name = crate::colour::Axis::Matrix.name(info.matrix());
            info.notes.push(format!("it names no matrix from YUV to RGB; by its size, {name} is taken"));
        }
        Ok(())
    }

    /// Corrects the number of frames that an MP4 announces: it counts none that are lacking before its last, and those that it hides.
    fn count_lacking(&self, info: &mut VideoInfo) -> Result<(), VideoError> {
        if let Some(Announced { frames, by: AnnouncedBy::Count }) = info.announced
            && info.delay > 0
            && (info.hides || !info.is_variable)
        {
            let frames = match info.is_variable {
                true => self.packet_times(info)?.len() as u64,
                false => frames.max(self.frames_by_time(info)?),
            };
            info.announced = Some(Announced { frames, by: AnnouncedBy::Count });
        }
        Ok(())
    }

    /// Corrects the number of frames that an AVI announces: it counts places for them. Those before the first frame may be empty; where the
    /// rate varies, others are, too. Its index tells which are lost instead.
    fn count_places(&self, info: &mut VideoInfo) -> Result<(), VideoError> {
        let late = u64::try_from(info.start).unwrap_or(0).saturating_sub(info.delay);
        if !info.is_variable && late == 0 {
            return Ok(());
        }
        let places = Places::read(&info.path, info.stream);
        if !info.is_variable && places.empty_before(info.start) + info.leading < late {
            return Ok(());
        }
        let times = self.packet_times(info)?;
        let even = Timeline::Even { start: info.start, time_base: info.time_base, rate: info.rate };
        let shown = match times.last() {
            Some(last) if !info.is_variable => even.frame(*last) + 1,
            _ => places.filled().saturating_sub(info.leading).max(times.len() as u64),
        };
        info.announced = info.announced.map(|told| Announced { frames: told.frames.min(shown), ..told });
        Ok(())
    }
}

/// Replaces the start of a stream by that of its first frame. Of a cut Matroska, ffprobe guesses it, or says none, where few are left; of
/// AVI and WMV it tells when that frame is decoded; of streams that begin between frames, the time of another.
fn begin_at(stream: &mut Value, first: i64, container: &str) {
    let Some(time_base) = ratio(stream, "time_base") else { return };
    let time = first as f64 * time_base.to_f64();
    let seconds = |stream: &Value, name| text(stream, name)?.parse::<f64>().ok();
    if let Some(duration) = seconds(stream, "duration").filter(|_| container != AVI) {
        let end = seconds(stream, "start_time").unwrap_or(0.0) + duration;
        stream["duration"] = Value::from((end - time).to_string());
    }
    stream["start_pts"] = Value::from(first);
    stream["start_time"] = Value::from(time.to_string());
}

/// Takes out of a stream's tags what ffmpeg copies from another file, which it cut: statistics of mkvmerge, and in other containers also
/// Matroska's tag of the duration.
fn drop_copied_tags(document: &mut Value, stream: usize, container: &str) {
    let is_copy = tag(&document["format"], "encoder").is_some_and(|encoder| encoder.starts_with("Lavf"));
    let is_copied = |name: &str| match is_matroska(container) {
        true => is_copy && is_statistic(name),
        false => is_statistic(name) || name.eq_ignore_ascii_case("duration"),
    };
    if let Some(tags) = document["streams"][stream]["tags"].as_object_mut() {
        tags.retain(|name, _| !is_copied(name));
    }
}

/// Looks at a file before ffprobe does: only files are read, and no pipe without a writer is waited for.
fn looked_at(path: &Path) -> Result<Option<CutShort>, VideoError> {
    let unread = |source| VideoError::Read { path: path.to_owned(), source };
    if !path.metadata().map_err(unread)?.is_file() {
        let found = "no file, but a folder, pipe or device".to_owned();
        let expected = "a file; pipes are read as Y4M, PAM or PFM".to_owned();
        return Err(VideoError::Unsupported { path: path.to_owned(), found, expected });
    }
    let mut file = File::open(path).map_err(unread)?;
    Ok(structure::cut(&mut file))
}

fn document(path: &Path, said: &Said, cut: Option<CutShort>) -> Result<Value, VideoError> {
    let parsed = serde_json::from_slice::<Value>(&said.stdout).ok();
    if let Some(document) = parsed.filter(|document| said.is_success && document["streams"].is_array()) {
        return Ok(document);
    }
    Err(match cut {
        Some(CutShort { expected, found }) => {
            VideoError::Cut { path: path.to_owned(), expected, found, is_described: false }
        }
        None => VideoError::NoVideo { path: path.to_owned(), reason: said.last_words() },
    })
}

fn streams(document: &Value) -> &[Value] {
    document["streams"].as_array().map(Vec::as_slice).unwrap_or_default()
}

/// Returns whether a stream is video, and not the picture of a cover.
fn is_video(stream: &Value) -> bool {
    let is_cover = stream["disposition"]["attached_pic"].as_i64() == Some(1);
    stream["codec_type"] == "video" && !is_cover
}

/// Returns whether ffprobe has seen a picture of the stream, or been told what they are.
fn is_seen(stream: &Value) -> bool {
    text(stream, "pix_fmt").is_some() && stream["width"].as_u64() != Some(0)
}

fn other(stream: &Value) -> OtherStream {
    let code = text(stream, "codec_tag_string").unwrap_or_default();
    let kind = match StreamKind::of(text(stream, "codec_type").unwrap_or_default()) {
        StreamKind::Data if code == "tmcd" => StreamKind::TimeCode,
        kind => kind,
    };
    // Of data, ffprobe knows few codecs, and the container's code, if it is one, tells more.
    let code = Some(code).filter(|code| kind == StreamKind::Data && !code.is_empty() && !code.contains('['));
    let number = |name: &str| stream[name].as_u64().and_then(|number| u32::try_from(number).ok()).unwrap_or(0);
    OtherStream {
        index: number("index"),
        kind,
        codec: code.or_else(|| text(stream, "codec_name")).unwrap_or_default().to_owned(),
        labels: Labels::of(stream),
        channels: number("channels"),
    }
}

fn timecode(video: &Value, streams: &[Value], format: &Value) -> Option<String> {
    let all = std::iter::once(video).chain(streams).chain([format]);
    all.filter_map(|value| tag(value, "timecode")).next().map(str::to_owned)
}

/// Names that containers write for themselves.
const OWN: [&str; 6] = ["major_brand", "minor_version", "compatible_brands", "encoder", "duration", "timecode"];

/// Names by which MXF tells its parts, and the program that wrote it.
const OF_MXF: [&str; 12] = [
    "application_platform",
    "company_name",
    "generation_uid",
    "material_package_umid",
    "modification_date",
    "operational_pattern_ul",
    "product_name",
    "product_uid",
    "product_version",
    "product_version_num",
    "toolkit_version_num",
    "uid",
];

fn metadata(format: &Value) -> Vec<(String, String)> {
    let of_container: &[&str] = if text(format, "format_name") == Some(MXF) { &OF_MXF } else { &[] };
    let is_own = |name: &str| OWN.iter().chain(of_container).any(|own| own.eq_ignore_ascii_case(name));
    let tags = format["tags"].as_object().into_iter().flatten();
    let texts = tags.filter_map(|(name, value)| Some((name.clone(), value.as_str()?.to_owned())));
    // AVI calls ffmpeg's encoder software.
    texts.filter(|(name, value)| !is_own(name) && !value.starts_with("Lavf")).collect()
}

fn announced_by_duration(info: &VideoInfo) -> Option<Announced> {
    // What Matroska tells beyond whole frames is the sound before the first.
    let part = if is_matroska(&info.container) { 0.25 } else { 0.5 };
    let frames = (info.duration? * info.rate.to_f64() + part).floor();
    let is_told = !info.is_variable && info.rate.to_f64() < FASTEST && (1.0..1e12).contains(&frames);
    is_told.then_some(Announced { frames: frames as u64, by: AnnouncedBy::Duration })
}
