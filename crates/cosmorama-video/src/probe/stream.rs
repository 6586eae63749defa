//! Stream of video in ffprobe's answer.

use std::path::Path;

use serde_json::Value;

use super::pixel_format::PixelFormat;
use super::{Announced, AnnouncedBy, Turn, VideoInfo};
use crate::colour::Axis;
use crate::{
    Bounds, ChromaPlace, ColourTags, ContentLight, HdrTags, Labels, MasteringDisplay, Ratio, SignalRange, SpatialTags,
    SphericalPose, SphericalProjection, StereoMode, VideoError,
};

/// Columns or rows of a video at most.
const LONGEST: u64 = 1 << 16;

/// Frames that a decoder keeps back at most.
const MOST_DELAY: u64 = 16;

/// A stream of video that can be read.
pub(super) struct Stream<'a> {
    value: &'a Value,
    index: u32,
    size: (usize, usize),
    format: PixelFormat,
    turn: Turn,
    rate: Ratio,
    is_variable: bool,
    time_base: Ratio,
}

/// Returns a text of an object; `None` where there is none.
pub(super) fn text<'a>(value: &'a Value, name: &str) -> Option<&'a str> {
    value[name].as_str()
}

pub(super) fn ratio(value: &Value, name: &str) -> Option<Ratio> {
    text(value, name).and_then(Ratio::parse)
}

impl<'a> Stream<'a> {
    /// Reads what must be known; the error says what cannot be.
    pub(super) fn read(path: &Path, value: &'a Value) -> Result<Self, VideoError> {
        let unsupported = |found: String, expected: &str| VideoError::Unsupported {
            path: path.to_owned(),
            found,
            expected: expected.to_owned(),
        };
        if [&value["width"], &value["height"]].into_iter().all(|side| side.as_u64() == Some(0)) {
            let reason = "no frame of it tells how large it is; it may end before its first key frame".to_owned();
            return Err(VideoError::NoVideo { path: path.to_owned(), reason });
        }
        let side = |name: &str| value[name].as_u64().filter(|side| (1..=LONGEST).contains(side));
        let (Some(width), Some(height)) = (side("width"), side("height")) else {
            let found = format!("its frames are of {}x{} pixels", value["width"], value["height"]);
            return Err(unsupported(found, "1 to 65536 columns and rows"));
        };
        let name = text(value, "pix_fmt").unwrap_or("unknown");
        let format = PixelFormat::of_name(name).ok_or_else(|| {
            unsupported(format!("its pixels are of the format {name}"), "YUV, RGB or grey integers of 8 to 16 bits")
        })?;
        let turn = turn(value).ok_or_else(|| {
            unsupported("its display matrix turns by no multiple of 90 degrees".to_owned(), "0, 90, 180 or 270 degrees")
        })?;
        let (shown, mean) = (ratio(value, "r_frame_rate"), ratio(value, "avg_frame_rate"));
        let Some(rate) = mean.or(shown) else {
            return Err(unsupported("it names no frame rate".to_owned(), "a rate, or times of frames"));
        };
        let Some(time_base) = ratio(value, "time_base") else {
            return Err(unsupported("its clock has no unit".to_owned(), "a time base"));
        };
        let index = value["index"].as_u64().and_then(|index| u32::try_from(index).ok()).unwrap_or(0);
        let is_variable = shown.is_some_and(|shown| shown != rate);
        let size = (width as usize, height as usize);
        Ok(Self { value, index, size, format, turn, rate, is_variable, time_base })
    }

    /// Returns the properties of a file with this stream; those of the file itself are to be added.
    pub(super) fn into_info(self, path: &Path, container: &str) -> VideoInfo {
        let Self { value, index, size, format, turn, rate, is_variable, time_base } = self;
        let pixel_format = text(value, "pix_fmt").unwrap_or_default().to_owned();
        let aspect = ratio(value, "sample_aspect_ratio").unwrap_or(Ratio::ONE);
        let interlaced = ["tt", "bb", "tb", "bt"];
        let (hdr, spatial) = side_data(&value["side_data_list"], size);
        VideoInfo {
            path: path.to_owned(),
            container: container.to_owned(),
            stream: index,
            codec: text(value, "codec_name").unwrap_or_default().to_owned(),
            coded_size: size,
            turn,
            pixel_aspect: if turn.is_transposed { aspect.inverse() } else { aspect },
            rate,
            is_variable,
            time_base,
            start: value["start_pts"].as_i64().unwrap_or(0),
            duration: duration(value),
            announced: announced(value),
            pixel_format,
            bits: format.bits,
            has_alpha: format.has_alpha,
            is_grey: format.is_grey,
            is_rgb: format.is_rgb,
            is_interlaced: text(value, "field_order").is_some_and(|order| interlaced.contains(&order)),
            colour: colour(value),
            hdr,
            spatial,
            labels: Labels::of(value),
            others: Vec::new(),
            chapters: 0,
            timecode: None,
            metadata: Vec::new(),
            cut: None,
            file_start: 0.0,
            early: 0,
            leading: 0,
            hides: false,
            is_open: false,
            left_out: 0,
            empty_places: Vec::new(),
            delay: delay(value),
            notes: Vec::new(),
        }
    }
}

/// Returns the frames that a decoder of the stream keeps back.
pub(super) fn delay(value: &Value) -> u64 {
    value["has_b_frames"].as_u64().unwrap_or(0).min(MOST_DELAY)
}

fn turn(value: &Value) -> Option<Turn> {
    let mut list = value["side_data_list"].as_array().into_iter().flatten();
    let found = list.find(|data| data["side_data_type"] == "Display Matrix");
    match (found, value["tags"]["rotate"].as_str()) {
        (Some(data), _) => match text(data, "displaymatrix") {
            Some(matrix) => Turn::of_matrix(matrix),
            None => Turn::of_degrees(data["rotation"].as_i64()?.checked_neg()?),
        },
        (None, Some(degrees)) => Turn::of_degrees(degrees.parse().ok()?),
        (None, None) => Some(Turn::default()),
    }
}

/// Returns the seconds of the stream: its own, or Matroska's tag such as `00:01:02.500000000`. As ffmpeg writes it, that is the time at
/// which the last frame ends, and the first may begin late, where the sound does before it. Statistics of mkvmerge count from the first frame.
fn duration(value: &Value) -> Option<f64> {
    let own = text(value, "duration").and_then(|seconds| seconds.parse().ok());
    let start = text(value, "start_time").and_then(|seconds| seconds.parse::<f64>().ok()).unwrap_or(0.0);
    let tag = || {
        let tags = value["tags"].as_object()?;
        let is_counted = tags.keys().any(|name| name.starts_with("_STATISTICS"));
        let (_, text) = tags.iter().find(|(name, _)| name.eq_ignore_ascii_case("duration"))?;
        let end =
            text.as_str()?.trim().split(':').try_fold(0.0, |sum, part| Some(sum * 60.0 + part.parse::<f64>().ok()?));
        Some(if is_counted { end? } else { end? - start })
    };
    // Of a cut file, Matroska's own is that of all streams together.
    tag().or(own).filter(|seconds: &f64| seconds.is_finite() && *seconds > 0.0)
}

/// Returns whether a tag is one of mkvmerge's statistics that counts here: the number of frames, or the program that counted.
pub(super) fn is_statistic(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    name.starts_with(FRAMES) || name.starts_with("_STATISTICS")
}

/// Beginning of the tag that counts frames; a language may follow.
const FRAMES: &str = "NUMBER_OF_FRAMES";

/// Returns the container's own count, or that of Matroska's statistics.
fn announced(value: &Value) -> Option<Announced> {
    let tags = value["tags"].as_object().into_iter().flatten();
    let counted = tags.filter(|(name, _)| name.to_ascii_uppercase().starts_with(FRAMES));
    let texts = text(value, "nb_frames").into_iter().chain(counted.filter_map(|(_, count)| count.as_str()));
    let frames = texts.filter_map(|count| count.trim().parse().ok()).find(|count| *count > 0)?;
    Some(Announced { frames, by: AnnouncedBy::Count })
}

fn colour(value: &Value) -> ColourTags {
    let number = |axis: Axis, name: &str| text(value, name).and_then(|name| axis.number(name));
    ColourTags {
        primaries: number(Axis::Primaries, "color_primaries"),
        transfer: number(Axis::Transfer, "color_transfer"),
        matrix: number(Axis::Matrix, "color_space"),
        range: match text(value, "color_range") {
            Some("tv") => Some(SignalRange::Narrow),
            Some("pc") => Some(SignalRange::Full),
            _ => None,
        },
        chroma: match text(value, "chroma_location") {
            Some("left") => Some(ChromaPlace::Left),
            Some("center") => Some(ChromaPlace::Centre),
            Some("topleft") => Some(ChromaPlace::TopLeft),
            _ => None,
        },
    }
}

/// Returns the tags of high dynamic range and of spherical video in a list of side data.
pub(super) fn side_data(list: &Value, size: (usize, usize)) -> (HdrTags, Option<SpatialTags>) {
    let (mut hdr, mut spatial) = (HdrTags::default(), None::<SpatialTags>);
    for data in list.as_array().into_iter().flatten() {
        match text(data, "side_data_type") {
            Some("Mastering display metadata") => hdr.mastering = mastering(data).or(hdr.mastering),
            Some("Content light level metadata") => hdr.light = light(data),
            Some("Stereo 3D") => spatial.get_or_insert_default().stereo = stereo(data),
            Some("Spherical Mapping") => {
                let tags = spatial.get_or_insert_default();
                tags.projection = projection(data, size);
                tags.pose = pose(data);
            }
            _ => {}
        }
    }
    (hdr, spatial)
}

fn mastering(data: &Value) -> Option<MasteringDisplay> {
    let part = |name: &str, unit: f64| {
        let (above, below) = text(data, name)?.split_once('/')?;
        let value = above.parse::<f64>().ok()? / below.parse::<f64>().ok()?;
        let units = (value / unit).round();
        (0.0..=f64::from(u32::MAX)).contains(&units).then_some(units as u32)
    };
    let pair = |x: &str, y: &str| {
        let short = |name: &str| u16::try_from(part(name, 0.00002)?).ok();
        Some([short(x)?, short(y)?])
    };
    Some(MasteringDisplay {
        red: pair("red_x", "red_y")?,
        green: pair("green_x", "green_y")?,
        blue: pair("blue_x", "blue_y")?,
        white: pair("white_point_x", "white_point_y")?,
        brightest: part("max_luminance", 0.0001)?,
        darkest: part("min_luminance", 0.0001)?,
    })
}

fn light(data: &Value) -> Option<ContentLight> {
    let level = |name: &str| u16::try_from(data[name].as_u64()?).ok();
    Some(ContentLight { brightest: level("max_content")?, mean: level("max_average")? })
}

fn stereo(data: &Value) -> Option<StereoMode> {
    // Where the right eye comes first, ffprobe says so in a field of its own.
    if data["inverted"].as_i64() == Some(1) {
        return None;
    }
    match text(data, "type") {
        Some("2D") => Some(StereoMode::Mono),
        Some("top and bottom") => Some(StereoMode::TopBottom),
        Some("side by side") => Some(StereoMode::LeftRight),
        _ => None,
    }
}

fn pose(data: &Value) -> SphericalPose {
    let degrees = |name: &str| data[name].as_f64().map_or(0, |degrees| (degrees * 65536.0).round() as i32);
    SphericalPose { yaw: degrees("yaw"), pitch: degrees("pitch"), roll: degrees("roll") }
}

fn projection(data: &Value, (width, height): (usize, usize)) -> Option<SphericalProjection> {
    let number = |name: &str| data[name].as_u64().unwrap_or(0);
    match text(data, "projection") {
        Some("equirectangular") => Some(SphericalProjection::Equirect(Bounds::default())),
        Some("tiled equirectangular") => {
            // Pixels of the whole panorama, of which the picture is a part.
            let part = |pixels: u64, all: u64| (pixels as f64 / all.max(1) as f64 * 4_294_967_296.0).round() as u32;
            let columns = number("bound_left").saturating_add(width as u64).saturating_add(number("bound_right"));
            let rows = number("bound_top").saturating_add(height as u64).saturating_add(number("bound_bottom"));
            Some(SphericalProjection::Equirect(Bounds {
                top: part(number("bound_top"), rows),
                bottom: part(number("bound_bottom"), rows),
                left: part(number("bound_left"), columns),
                right: part(number("bound_right"), columns),
            }))
        }
        Some("cubemap") => Some(SphericalProjection::Cubemap { layout: 0, padding: number("padding") as u32 }),
        Some(_) => Some(SphericalProjection::Mesh),
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn durations_of_matroska_are_those_of_the_frames() {
        let of = |start: &str, tags: Value| duration(&json!({ "start_time": start, "tags": tags }));
        let close = |found: Option<f64>| found.is_some_and(|seconds| (seconds - 2.0).abs() < 1e-9);
        assert!(close(of("0.000000", json!({ "DURATION": "00:00:02.000000000" }))));
        assert!(close(of("0.023000", json!({ "DURATION": "00:00:02.023000000" }))));
        let statistics = json!({ "DURATION": "00:00:02.000000000", "_STATISTICS_WRITING_APP": "mkvmerge" });
        assert!(close(of("0.500000", statistics)));
        assert!(close(duration(&json!({ "duration": "2.0", "start_time": "0.5" }))));
        assert!(close(duration(&json!({ "duration": "3.02", "tags": { "DURATION": "00:00:02.0" } }))));
        assert_eq!(of("3.0", json!({ "DURATION": "00:00:02.0" })), None);
    }
}
