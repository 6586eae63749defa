//! Memory that ffmpeg holds beside this program, which counts like its own.

use std::collections::BTreeSet;

use super::checks::SMALL;
use crate::colour::Light;
use crate::diagnostic::{Result, VIDEO_ARGS, VIDEO_CODEC};
use crate::input::Input;
use crate::settings::Conversion;
use crate::source::memory_budget::human;
use crate::source::video::MadeVideos;
use crate::source::{Files, MemoryBudget};
use crate::target::Target;

impl MemoryBudget {
    /// Returns the budget that is left beside ffmpeg, which decodes the films among the inputs of layers and encodes those that are made. A
    /// limit of addresses is each program's own, and one for small pictures is for nothing else.
    ///
    /// # Errors
    /// When ffmpeg alone holds more, or a film cannot be read.
    pub(crate) fn beside_coders<'a>(
        self,
        layers: impl Iterator<Item = (&'a Input, &'a dyn Files)>,
        settings: &Conversion,
        made: (&Target, &Light),
    ) -> Result<Self> {
        if self.is_of_addresses || self.bytes < SMALL {
            return Ok(self);
        }
        let (mut decoding, encoding) = (0_u64, encoding_bytes(settings, made));
        for (input, files) in layers {
            decoding = decoding.saturating_add(decoding_bytes(input, files)?);
        }
        let less = format!("; {VIDEO_CODEC} prores holds less, and with {VIDEO_ARGS} an encoder is not counted");
        let why = if encoding > 0 { format!("; encoding is {} of it{less}", human(encoding)) } else { String::new() };
        let coders = decoding.saturating_add(encoding);
        self.allow(coders, "ffmpeg, which reads and makes films,", &why)?;
        Ok(self.beside_ffmpeg(coders))
    }
}

/// Returns the bytes that ffmpeg holds for the films among the inputs, about, each decoded by one of its own.
fn decoding_bytes(input: &Input, files: &dyn Files) -> Result<u64> {
    let Some(videos) = files.videos() else { return Ok(0) };
    let films: BTreeSet<_> = input.present().filter_map(|(view, ..)| view.files.video()).collect();
    let mut bytes = 0_u64;
    for film in films {
        bytes = bytes.saturating_add(videos.memory(film)?);
    }
    Ok(bytes)
}

/// Returns the bytes that ffmpeg holds for the films that are made, about. Of encoders with arguments of their own, nothing is known.
fn encoding_bytes(settings: &Conversion, (target, light): (&Target, &Light)) -> u64 {
    if !settings.video.arguments.is_empty() {
        return 0;
    }
    let films = target.files.iter().filter_map(|file| Some((file.files.video()?, file.sheet.size)));
    let codec = settings.video.codec.as_deref();
    films.map(|(film, size)| MadeVideos::memory(film, codec, size, light)).fold(0, u64::saturating_add)
}
