//! Labels of streams: what they are to people.

use serde_json::Value;

/// Labels of a stream.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// Language, such as `eng`.
    pub language: Option<String>,
    /// Title, such as `Commentary`. MP4 and MOV hold it as the name of the stream's handler.
    pub title: Option<String>,
    /// Whether players take the stream unless they are told another of its kind.
    pub is_default: bool,
    /// Roles, by ffmpeg's names for them, such as `forced` or `hearing_impaired`.
    pub roles: Vec<String>,
    /// Names and values of further tags.
    pub tags: Vec<(String, String)>,
}

/// Beginnings of the names of Matroska's statistics, behind which a language may stand.
const STATISTICS: [&str; 4] = ["_statistics", "bps", "duration", "number_of_"];

/// Names of tags that containers and their writers make of themselves, or that have places of their own.
const OF_CONTAINERS: [&str; 14] = [
    "alpha_mode",
    "creation_time",
    "encoder",
    "filename",
    "handler_name",
    "language",
    "mimetype",
    "name",
    "rotate",
    "stereo_mode",
    "timecode",
    "title",
    "variant_bitrate",
    "vendor_id",
];

impl Labels {
    /// Reads the labels of a stream in ffprobe's answer.
    pub(crate) fn of(stream: &Value) -> Self {
        let dispositions = stream["disposition"].as_object().into_iter().flatten();
        let so: Vec<&String> =
            dispositions.filter(|(_, is_so)| is_so.as_i64() == Some(1)).map(|(name, _)| name).collect();
        let tags = stream["tags"].as_object().into_iter().flatten();
        let tags = tags.filter(|(name, _)| !is_of_container(name));
        Self {
            language: tag(stream, "language").filter(|language| *language != "und").map(of_iso),
            title: title(stream).map(str::to_owned),
            is_default: so.iter().any(|name| *name == DEFAULT),
            roles: so.into_iter().filter(|name| !is_no_role(name)).cloned().collect(),
            tags: tags.filter_map(|(name, value)| Some((name.clone(), value.as_str()?.to_owned()))).collect(),
        }
    }
}

/// Disposition of a stream that players take first.
pub(crate) const DEFAULT: &str = "default";

fn is_no_role(disposition: &str) -> bool {
    [DEFAULT, "attached_pic", "timed_thumbnails", "still_image"].contains(&disposition)
}

fn is_of_container(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    OF_CONTAINERS.contains(&name.as_str()) || STATISTICS.iter().any(|beginning| name.starts_with(beginning))
}

/// Returns a title: that of Matroska, or the name of a handler that does not only say what it handles.
fn title(stream: &Value) -> Option<&str> {
    let handler = tag(stream, "handler_name").map(str::trim).filter(|name| {
        let is_usual = name.ends_with("Handler") || name.starts_with("Core Media") || name.starts_with("ISO Media");
        !is_usual && !name.is_empty()
    });
    tag(stream, "title").or_else(|| tag(stream, "name")).or(handler)
}

/// Returns the code of ISO 639-2 for a language, of which ffmpeg's list for QuickTime has a wrong one.
fn of_iso(language: &str) -> String {
    if language == "sve" { "swe".to_owned() } else { language.to_owned() }
}

/// Returns a tag, whose name Matroska writes in capitals.
pub(crate) fn tag<'a>(value: &'a Value, name: &str) -> Option<&'a str> {
    let tags = value["tags"].as_object()?;
    tags.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).and_then(|(_, value)| value.as_str())
}
