use std::fmt::{Display, Formatter};

use super::Setting;
use super::mark::{self, Mark};

/// A readable text that refers to settings by value: a command line writes `--from`, Python would write `from_=`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Text in which each setting is a mark.
    text: String,
}

/// A part of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part<'a> {
    /// Plain text.
    Text(&'a str),
    /// A setting, which each caller writes in its own way.
    Setting(Setting),
}

impl Message {
    /// Returns its parts in order.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let mut rest = self.text.as_str();
        std::iter::from_fn(move || {
            let first = rest.chars().next()?;
            if let Some(setting) = mark::setting(first) {
                rest = &rest[first.len_utf8()..];
                return Some(Part::Setting(setting));
            }
            let end = rest.find(|character| mark::setting(character).is_some()).unwrap_or(rest.len());
            let (text, after) = rest.split_at(end);
            rest = after;
            Some(Part::Text(text))
        })
    }

    /// Writes the text with each setting as `name` gives it.
    pub fn render(&self, name: impl Fn(Setting) -> String) -> String {
        let written = |part| match part {
            Part::Text(text) => text.to_owned(),
            Part::Setting(setting) => name(setting),
        };
        self.parts().map(written).collect()
    }

    /// Prepends a text.
    #[must_use]
    pub fn after(&self, text: &str) -> Self {
        Self { text: format!("{text}{}", self.text) }
    }

    /// Replaces a setting, together with the text that joins it to its value, by other words.
    pub(crate) fn reworded(&self, setting: Mark, words: &str) -> Self {
        Self { text: self.text.replace(&format!("{setting} "), &format!("{words} ")) }
    }

    /// Returns the text with its marks, for use in another message.
    pub(crate) fn marked(&self) -> &str {
        &self.text
    }
}

impl From<String> for Message {
    fn from(text: String) -> Self {
        Self { text }
    }
}

impl From<&str> for Message {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

/// Writes the text with the settings' plain names.
impl Display for Message {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        self.parts().try_for_each(|part| match part {
            Part::Text(text) => f.write_str(text),
            Part::Setting(setting) => f.write_str(setting.name()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FROM, MISSING};
    use super::*;

    #[test]
    fn settings_are_told_from_text_and_written_by_the_caller() {
        let message = Message::from(format!("give {FROM} cube, or fill it with {MISSING}"));
        let parts: Vec<Part> = message.parts().collect();
        let expected = [
            Part::Text("give "),
            Part::Setting(Setting::From),
            Part::Text(" cube, or fill it with "),
            Part::Setting(Setting::Missing),
        ];
        assert_eq!(parts, expected);
        assert_eq!(message.to_string(), "give from cube, or fill it with missing");
        let python = message.render(|setting| format!("{}_=", setting.name()));
        assert_eq!(python, "give from_= cube, or fill it with missing_=");
        assert_eq!(message.reworded(FROM, "spec =").to_string(), "give spec = cube, or fill it with missing");
    }

    #[test]
    fn every_setting_has_a_mark_of_its_own() {
        for &setting in Setting::ALL {
            let message = Message::from(Mark(setting).to_string());
            assert_eq!(message.parts().collect::<Vec<_>>(), [Part::Setting(setting)]);
        }
    }
}
