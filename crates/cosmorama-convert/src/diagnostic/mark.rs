//! Marks that stand for settings in a text under construction: [`Message`](super::Message) separates them from the
//! rest.

use std::fmt::{Display, Formatter, Result, Write};

use super::Setting;

/// First mark, a character at the end of Unicode's last private plane, which no readable text contains. One mark for each
/// setting follows.
const FIRST: u32 = 0x10_ff00;

/// Formats a setting as its mark.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark(pub(crate) Setting);

impl Display for Mark {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_char(char::from_u32(FIRST + self.0 as u32).unwrap_or(char::REPLACEMENT_CHARACTER))
    }
}

/// Returns the setting that a mark stands for; `None` for other characters.
pub(super) fn setting(character: char) -> Option<Setting> {
    Setting::ALL.get(u32::from(character).checked_sub(FIRST)? as usize).copied()
}
