//! Marks that stand for settings in a text under construction: [`Message`](super::Message) separates them from the
//! rest.

use std::fmt::{Display, Formatter, Result, Write};

use super::Setting;

/// First mark, a noncharacter of Unicode, which no readable text contains. One mark for each setting follows.
const FIRST: u32 = 0xfdd0;

/// Formats a setting as its mark.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark(pub(crate) Setting);

impl Display for Mark {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let place = Setting::ALL.iter().position(|setting| *setting == self.0).unwrap_or_default();
        f.write_char(char::from_u32(FIRST + place as u32).unwrap_or(char::REPLACEMENT_CHARACTER))
    }
}

/// Returns the setting that a mark stands for; `None` for other characters.
pub(super) fn setting(character: char) -> Option<Setting> {
    Setting::ALL.get(u32::from(character).checked_sub(FIRST)? as usize).copied()
}

pub(crate) const FROM: Mark = Mark(Setting::From);
pub(crate) const TO: Mark = Mark(Setting::To);
pub(crate) const SIZE: Mark = Mark(Setting::Size);
pub(crate) const YAW: Mark = Mark(Setting::Yaw);
pub(crate) const PITCH: Mark = Mark(Setting::Pitch);
pub(crate) const ROLL: Mark = Mark(Setting::Roll);
pub(crate) const FILTER: Mark = Mark(Setting::Filter);
pub(crate) const KERNEL: Mark = Mark(Setting::Kernel);
pub(crate) const ANTI_RINGING: Mark = Mark(Setting::AntiRinging);
pub(crate) const TRANSFER: Mark = Mark(Setting::Transfer);
pub(crate) const IN_TRANSFER: Mark = Mark(Setting::InTransfer);
pub(crate) const OUT_TRANSFER: Mark = Mark(Setting::OutTransfer);
pub(crate) const PRIMARIES: Mark = Mark(Setting::Primaries);
pub(crate) const IN_PRIMARIES: Mark = Mark(Setting::InPrimaries);
pub(crate) const IGNORE_PROFILE: Mark = Mark(Setting::IgnoreProfile);
pub(crate) const DEPTH: Mark = Mark(Setting::Depth);
pub(crate) const BACKGROUND: Mark = Mark(Setting::Background);
pub(crate) const MISSING: Mark = Mark(Setting::Missing);
pub(crate) const FRAMES: Mark = Mark(Setting::Frames);
pub(crate) const OVERWRITE: Mark = Mark(Setting::Overwrite);
pub(crate) const RESUME: Mark = Mark(Setting::Resume);
pub(crate) const MIPS: Mark = Mark(Setting::Mips);
pub(crate) const LEVELS: Mark = Mark(Setting::Levels);
pub(crate) const QUALITY: Mark = Mark(Setting::Quality);
pub(crate) const COMPRESSION: Mark = Mark(Setting::Compression);
pub(crate) const STRIP: Mark = Mark(Setting::Strip);
pub(crate) const MEMORY: Mark = Mark(Setting::Memory);
pub(crate) const PART: Mark = Mark(Setting::Part);
pub(crate) const CHANNELS: Mark = Mark(Setting::Channels);
pub(crate) const DEPTH_KIND: Mark = Mark(Setting::DepthKind);
pub(crate) const NORMALS: Mark = Mark(Setting::Normals);
pub(crate) const ST_MAP: Mark = Mark(Setting::StMap);
