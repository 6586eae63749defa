//! Commands that make what the demo makes: it runs them and prints them.

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use cosmorama::filter::FilterKind;
use cosmorama_convert::{Conversion, Existing};
use cosmorama_spec::{FilterName, Size};

use super::faces::{FRAME, Faces};
use crate::args::ProgressStyle;
use crate::args::convert::LimitArgs;
use crate::console::Console;
use crate::verbs::{convert, tell_made};

/// Makes the Omnimax frame of the faces, as the command does that is printed.
pub(in crate::verbs) fn omnimax(
    faces: &Faces,
    (output, filter): (&Path, FilterKind),
    (limits, progress): (&LimitArgs, ProgressStyle),
    console: &Console,
) -> Result<()> {
    let start = Instant::now();
    let (input, output_name) = (faces.pattern().display().to_string(), output.display().to_string());
    let (from, size) = (faces.spec(), Size { width: FRAME.0, height: Some(FRAME.1) });
    let mut words: Vec<String> = ["cosmorama", "convert", &input, &output_name, "--from", &from.to_string()]
        .into_iter()
        .chain(["--to", "omnimax", "--size", &size.to_string()])
        .map(quoted)
        .collect();
    if filter == FilterKind::Point {
        words.extend(["--filter", "point"].map(str::to_owned));
    }
    let mut conversion = Conversion::new(&input, &output_name)
        .from(from)
        .to("omnimax".parse()?)
        .size(size)
        .filter(FilterName(filter))
        .existing(Existing::Replace);
    conversion.limits = limits.clone().into();
    convert::convert(conversion, progress, console)?;
    tell_made(console, output, "the Omnimax frame", start)?;
    console.print(&format!("  {} -y\n", words.join(" ")))
}

/// Quotes a word for a shell.
pub(super) fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./:=,+".contains(letter);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
