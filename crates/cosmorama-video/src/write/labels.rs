//! Labels of streams, as containers hold them.

use serde_json::Value;

use super::Container;
use crate::labels::tag;
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

/// Names under which containers keep a title.
const TITLES: [&str; 3] = ["title", "name", "handler_name"];

impl Labelled {
    /// Returns arguments for the video, which ffmpeg gets without labels.
    pub(super) fn of_video(&self, container: Container) -> Vec<String> {
        let Labels { language, title, roles } = &self.labels;
        let language = language.as_ref().map(|language| format!("language={language}"));
        let title = title.as_ref().map(|title| format!("title={title}"));
        let mut arguments = metadata("v:0", language.into_iter().chain(title));
        if !roles.is_empty() {
            arguments.extend(["-disposition:v:0".to_owned(), format!("default+{}", roles.join("+"))]);
        }
        [arguments, self.beyond_copying("v:0", container)].concat()
    }

    /// Returns arguments for what the container would not keep of the stream at a place, such as `a:0`.
    pub(super) fn beyond_copying(&self, at: &str, container: Container) -> Vec<String> {
        let title = self.labels.title.as_ref().filter(|_| container.has_boxes());
        let title = title.map(|title| format!("handler_name={title}"));
        let language = self.labels.language.as_deref().and_then(|language| in_quicktime(language, container));
        metadata(at, title.into_iter().chain(language.map(|language| format!("language={language}"))))
    }

    /// Returns what a stream that was written has not kept, in words; `None` where it has all.
    pub(super) fn lost(&self, written: &Value, container: Container) -> Option<String> {
        let has = |names: &[&str], value: &str| names.iter().any(|name| tag(written, name) == Some(value));
        let language = self.labels.language.as_deref().filter(|language| {
            !has(&["language"], language)
                && in_quicktime(language, container).is_none_or(|other| !has(&["language"], other))
        });
        let title = self.labels.title.as_deref().filter(|title| !has(&TITLES, title));
        let kept = Labels::of(written).roles;
        let roles = self.labels.roles.iter().filter(|role| !kept.contains(role));
        let told = language.map(|language| format!("its language ({})", language.escape_debug()));
        let told = told.into_iter().chain(title.map(|title| format!("its title ({})", title.escape_debug())));
        let told: Vec<String> = told.chain(roles.map(|role| format!("its role ({role})"))).collect();
        (!told.is_empty()).then(|| told.join(", "))
    }
}

fn metadata(at: &str, values: impl Iterator<Item = String>) -> Vec<String> {
    values.flat_map(|value| [format!("-metadata:s:{at}"), value]).collect()
}

/// Returns the code that stands for a language in MOV, if it is another.
fn in_quicktime(language: &str, container: Container) -> Option<&'static str> {
    let (_, other) = QUICKTIME.iter().find(|(known, _)| container == Container::Mov && *known == language)?;
    Some(*other)
}
