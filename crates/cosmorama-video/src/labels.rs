//! Labels of streams: what they are to people.

use serde_json::Value;

/// Labels of a stream.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// Language, such as `eng`.
    pub language: Option<String>,
    /// Title, such as `Commentary`.
    pub title: Option<String>,
    /// Roles, by ffmpeg's names for them, such as `forced` or `hearing_impaired`. That a player takes a stream first is none.
    pub roles: Vec<String>,
}

impl Labels {
    /// Reads the labels of a stream in ffprobe's answer.
    pub(crate) fn of(stream: &Value) -> Self {
        let roles = stream["disposition"].as_object().into_iter().flatten();
        let roles = roles.filter(|(name, is_so)| is_so.as_i64() == Some(1) && !is_no_role(name));
        Self {
            language: tag(stream, "language").filter(|language| *language != "und").map(str::to_owned),
            title: tag(stream, "title").map(str::to_owned),
            roles: roles.map(|(name, _)| name.clone()).collect(),
        }
    }
}

fn is_no_role(disposition: &str) -> bool {
    ["default", "attached_pic", "timed_thumbnails", "still_image"].contains(&disposition)
}

/// Returns a tag, whose name Matroska writes in capitals.
pub(crate) fn tag<'a>(value: &'a Value, name: &str) -> Option<&'a str> {
    let tags = value["tags"].as_object()?;
    tags.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).and_then(|(_, value)| value.as_str())
}
