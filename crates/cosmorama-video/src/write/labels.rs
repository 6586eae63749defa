//! Labels of streams, as containers hold them.

use serde_json::Value;

use super::Container;
use crate::labels::DEFAULT;
use crate::{Labels, StreamKind};

/// Languages for which QuickTime's list, as ffmpeg has it, holds another code than this one of ISO 639-2.
const QUICKTIME: [(&str, &str); 20] = [
    ("bod", "tib"),
    ("cym", "wel"),
    ("cze", "ces"),
    ("deu", "ger"),
    ("ell", "gre"),
    ("eus", "baq"),
    ("fas", "per"),
    ("fre", "fra"),
    ("hye", "arm"),
    ("isl", "ice"),
    ("kat", "geo"),
    ("mkd", "mac"),
    ("msa", "may"),
    ("mya", "bur"),
    ("nld", "dut"),
    ("rum", "ron"),
    ("slo", "slk"),
    ("sqi", "alb"),
    ("swe", "sve"),
    ("zho", "chi"),
];

/// Stream whose labels go along.
#[derive(Clone, Debug)]
pub(super) struct Labelled {
    /// Name of the stream that they are of, for messages.
    pub(super) name: String,
    pub(super) kind: StreamKind,
    pub(super) labels: Labels,
}

/// Roles that ffmpeg takes from MP4 along with others.
const ALONG: [(&str, &str); 2] = [("captions", "hearing_impaired"), ("descriptions", "visual_impaired")];

/// Bytes of the name of a handler in MOV, which are counted by one byte.
const LONGEST_HANDLER: usize = 255;

/// Bytes of a name with its value, and number of tags, that are passed on: arguments of a program have limits. What is not is told in the end.
const LONGEST_VALUE: usize = 4096;
const MOST_TAGS: usize = 100;

/// Letters of a title, and names of tags, that a message repeats.
const REPEATED: usize = 60;
const NAMED: usize = 8;

impl Labelled {
    /// Returns arguments for the labels of the stream at a place, such as `a:0`.
    pub(super) fn arguments(&self, at: &str, container: Container) -> Vec<String> {
        let Labels { language, title, is_default, roles, tags } = &self.labels;
        let language = language.as_deref().map(|language| format!("language={}", in_container(language, container)));
        let title = title.as_ref().filter(|title| container != Container::Mov || title.len() <= LONGEST_HANDLER);
        let name = if container.has_boxes() { "handler_name" } else { "title" };
        let title = title.map(|title| format!("{name}={title}"));
        // Of other streams, which it copies, ffmpeg knows them.
        let tags = tags.iter().filter(|_| self.kind == StreamKind::Video).take(MOST_TAGS);
        let tags = tags.map(|(name, value)| format!("{name}={value}"));
        let metadata = language.into_iter().chain(title).chain(tags);
        let metadata = metadata.filter(|value| value.len() <= LONGEST_VALUE && !value.contains('\0'));
        let mut arguments: Vec<String> = metadata.flat_map(|value| [format!("-metadata:s:{at}"), value]).collect();
        if self.kind != StreamKind::Attachment {
            let default = is_default.then_some(DEFAULT);
            let all: Vec<&str> = default.into_iter().chain(roles.iter().map(String::as_str)).collect();
            let all = if all.is_empty() { "0".to_owned() } else { all.join("+") };
            arguments.extend([format!("-disposition:{at}"), all]);
        }
        arguments
    }

    /// Returns what a stream that was written has not kept, in words; `None` where it has all.
    pub(super) fn lost(&self, written: &Value, container: Container) -> Option<String> {
        let Labels { language, title, roles, tags, .. } = &self.labels;
        let found = Labels::of(written);
        let mut lost = Vec::new();
        if let Some(language) =
            language.as_deref().filter(|language| !is_language(found.language.as_deref(), language, container))
        {
            let instead = found.language.map_or_else(String::new, |other| format!("; it has {}", other.escape_debug()));
            lost.push(format!("its language ({}{instead})", language.escape_debug()));
        }
        if let Some(title) = title.as_ref().filter(|title| found.title.as_ref() != Some(title)) {
            lost.push(format!("its title ({})", beginning(title)));
        }
        let is_along =
            |role: &str| ALONG.iter().any(|(along, of)| *along == role && roles.iter().any(|other| other == of));
        let roles = roles.iter().filter(|role| !found.roles.contains(role) && !is_along(role));
        lost.extend(roles.map(|role| format!("its role ({role})")));
        lost.extend(lost_tags(tags, written).map(|names| format!("its tags ({names})")));
        (!lost.is_empty()).then(|| lost.join(", "))
    }
}

/// Returns the names of tags that are not among those that were written; `None` where all are.
pub(super) fn lost_tags(tags: &[(String, String)], written: &Value) -> Option<String> {
    let kept = || written["tags"].as_object().into_iter().flatten();
    // Containers have names of their own for them, and ways to write places.
    let is_kept = |name: &str, value: &str| {
        kept().any(|(kept, text)| kept.eq_ignore_ascii_case(name) || text.as_str() == Some(value))
    };
    let lost = tags.iter().filter(|(name, value)| !is_kept(name, value));
    let lost: Vec<&str> = lost.map(|(name, _)| name.as_str()).collect();
    let mut names: Vec<String> = lost.iter().take(NAMED).map(|name| beginning(name)).collect();
    if lost.len() > NAMED {
        names.push(format!("{} more", lost.len() - NAMED));
    }
    (!names.is_empty()).then(|| names.join(", "))
}

/// Returns the first letters of a text, for a message.
fn beginning(text: &str) -> String {
    let rest = if text.chars().nth(REPEATED).is_some() { "…" } else { "" };
    format!("{}{rest}", text.chars().take(REPEATED).collect::<String>().escape_debug())
}

fn is_language(found: Option<&str>, language: &str, container: Container) -> bool {
    found.is_some_and(|found| {
        found == language || (found == in_container(language, container) && !language.contains('-'))
    })
}

/// Returns the code that stands for a language in a container. MP4 and MOV hold none of regions.
fn in_container(language: &str, container: Container) -> &str {
    if !container.has_boxes() {
        return language;
    }
    let language = language.split('-').next().unwrap_or(language);
    let other = QUICKTIME.iter().find(|(known, _)| container == Container::Mov && *known == language);
    other.map_or(language, |(_, other)| other)
}
