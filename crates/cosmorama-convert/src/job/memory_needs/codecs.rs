//! Memory that ffmpeg's codecs hold beside this program, which counts like its own.

use std::collections::BTreeSet;
use std::path::Path;

use crate::colour::Light;
use crate::diagnostic::{Result, VIDEO_ARGS};
use crate::input::Input;
use crate::job::backdrop::FoundBackdrop;
use crate::settings::Conversion;
use crate::source::memory_budget::human;
use crate::source::video::{MadeVideos, VideoPlan};
use crate::source::{Files, MemoryBudget};
use crate::target::Target;

impl MemoryBudget {
    /// Returns the budget that is left beside the codecs of the films that a conversion reads, in all its layers, and makes.
    ///
    /// # Errors
    /// When they alone hold more, or a film cannot be read.
    pub(crate) fn beside_films(
        self,
        (settings, target): (&Conversion, &Target),
        front: (&Input, &dyn Files),
        backdrop: Option<&FoundBackdrop>,
    ) -> Result<Self> {
        let (mut decoding, encoding) = (0_u64, encoding_bytes(settings, front.0, target));
        for (input, files) in backdrop.map_or_else(Vec::new, FoundBackdrop::inputs).into_iter().chain([front]) {
            decoding = decoding.saturating_add(decoding_bytes(input, files)?);
        }
        let output = Path::new(&settings.output);
        let is_prores = match &settings.video.codec {
            Some(codec) => codec == "prores",
            None => output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mov")),
        };
        let less = if is_prores { "" } else { "; ProRes in .mov holds less" };
        let why = || {
            let encoding = human(encoding);
            format!("; encoding is {encoding} of it{less}, and with {VIDEO_ARGS} '-preset …' it is not counted")
        };
        let why = if encoding > 0 { why() } else { String::new() };
        self.beside_codecs(decoding.saturating_add(encoding), &why)
    }
}

/// Returns the bytes that decoders of the films among the inputs hold, about. Each film has one.
fn decoding_bytes(input: &Input, files: &dyn Files) -> Result<u64> {
    let Some(videos) = files.videos() else { return Ok(0) };
    let films: BTreeSet<_> = input.present().filter_map(|(view, ..)| view.files.video()).collect();
    let mut bytes = 0_u64;
    for film in films {
        bytes = bytes.saturating_add(videos.memory(film)?);
    }
    Ok(bytes)
}

/// Returns the bytes that encoders of the films that are made hold, about. Where arguments decide on that, nothing is known.
fn encoding_bytes(settings: &Conversion, input: &Input, target: &Target) -> u64 {
    /// Parts of the names of arguments that decide how many frames an encoder holds, or which one it is.
    const DECIDING: [&str; 7] = ["preset", "tune", "lookahead", "params", "threads", "lag", "c:v"];
    let decides = |argument: &String| argument.starts_with('-') && DECIDING.iter().any(|part| argument.contains(part));
    if !target.format.is_video() || settings.video.arguments.iter().any(decides) {
        return 0;
    }
    // What is wrong with the light is told later, with all that decides it.
    let Ok(light) = Light::resolve(settings, input, target, None, &mut Vec::new()) else { return 0 };
    let films = target.files.iter().filter_map(|file| Some((file.files.video()?, file.sheet.size)));
    let plan = VideoPlan {
        settings: settings.video.clone(),
        to: None,
        depth: light.depth,
        channels: light.channels,
        transfer: light.transfer,
        primaries: light.working.primaries,
        frames: None,
        source: None,
    };
    films.map(|(film, size)| MadeVideos::memory(film, size, &plan)).fold(0, u64::saturating_add)
}
