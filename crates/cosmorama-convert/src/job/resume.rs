use std::path::{Path, PathBuf};

use cosmorama_io::{Choice, Format, FrameList, IoError, Limits, Metadata, check_chosen, open, probe_chosen};
use rayon::prelude::*;

use crate::colour::{LayerPlan, Light};
use crate::diagnostic::{
    Code, ConvertError, DAMAGED, Diagnostic, FRAMES, MEMORY, OVERWRITE, RESUME, Result, failed_as, failure,
};
use crate::job::origin::{DAMAGED_ORIGIN, are_of_one_version, damage_of, differences, is_damaged};
use crate::job::{ConvertJob, FrameOutputs};
use crate::source::video::{DamagedFrames, FrameName, Videos};
use crate::source::{MemoryBudget, Stamp};
use crate::target::{Movement, TargetFile};

/// An output whose place holds something else than `--resume` expects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remade {
    /// Path of the output.
    pub output: PathBuf,
    /// Description of what was found there.
    pub reason: String,
}

/// Findings in the places of outputs.
#[derive(Debug, Default)]
pub(crate) struct Resumed {
    /// Outputs that are made again.
    pub(crate) remade: Vec<Remade>,
    /// Number of outputs that are kept although they do not say how they were made.
    pub(crate) untold: usize,
    /// Outputs that were made otherwise.
    otherwise: Vec<Otherwise>,
}

/// A whole picture by other settings, or from other inputs.
#[derive(Debug)]
struct Otherwise {
    frame: Option<u64>,
    path: PathBuf,
    /// Parts in which these differ.
    parts: Vec<String>,
}

/// Content in the place of an output.
enum Found {
    Nothing,
    /// The complete output.
    Complete {
        /// Whether it says how it was made.
        tells_how: bool,
    },
    /// Something else, in words.
    Other(String),
    /// A whole picture by other settings, or from other inputs; the parts in which these differ.
    Otherwise(Vec<String>),
    /// Error of a picture that does not fit into memory.
    TooLarge(IoError),
}

/// Expectation of an output.
#[derive(Clone, Copy)]
struct Expected<'a> {
    target: &'a TargetFile,
    light: &'a Light,
    layers: &'a LayerPlan,
    /// Words about how the frame is made.
    origin: Option<&'a str>,
    /// Answer to damaged frames of films.
    damaged: DamagedFrames,
    memory: MemoryBudget,
}

impl Resumed {
    /// Removes from each frame the outputs that are complete. Returns the others whose places hold something else.
    ///
    /// # Errors
    /// When an output was made by other settings, or from other inputs.
    pub(crate) fn find(frames: &mut [FrameOutputs], job: &ConvertJob) -> Result<Self> {
        // As many outputs at once as fit into memory when decoded.
        let bytes = |size| job.light.file_bytes(size).saturating_add(job.layers.file_bytes(size));
        let largest = job.target.files.iter().map(|file| bytes(file.sheet.size)).max().unwrap_or(0);
        let at_once = (job.memory.bytes / largest.max(1)).clamp(1, frames.len().max(1) as u64) as usize;
        let mut all = Self::default();
        for some in frames.chunks_mut(at_once) {
            let of = |frame: &mut FrameOutputs| Self::of(frame, job);
            // All of them, so that the first in order is told of, whichever thread is the fastest.
            let found: Vec<Result<Self>> = some.par_iter_mut().map(of).collect();
            for of_frame in found {
                let Self { remade, untold, otherwise } = of_frame?;
                all.remade.extend(remade);
                all.untold += untold;
                all.otherwise.extend(otherwise);
            }
        }
        let is_turn = job.movement.as_ref().is_some_and(Movement::is_turn);
        otherwise(&all.otherwise, is_turn).map_or(Ok(all), Err)
    }

    fn of(frame: &mut FrameOutputs, job: &ConvertJob) -> Result<Self> {
        // What reads inputs, so only where there is something to compare with.
        let exists = frame.files.iter().any(|(_, path)| path.exists());
        let origin = if exists { job.origin_of(frame.frame)? } else { None };
        let (light, layers) = (&job.light, &job.layers);
        let (mut found, mut left) = (Self::default(), Vec::new());
        for (index, path) in std::mem::take(&mut frame.files) {
            let expected = Expected {
                target: &job.target.files[index],
                light,
                layers,
                origin: origin.as_deref(),
                damaged: job.files.videos().map_or_else(DamagedFrames::default, Videos::answer),
                memory: job.memory,
            };
            match Found::at(&path, expected) {
                Found::Nothing => left.push((index, path)),
                Found::Complete { tells_how: false } => match newer_input(job, frame.frame, &path) {
                    Some(input) => {
                        let reason = format!("older than its input {}", input.display());
                        found.remade.push(Remade { output: path.clone(), reason });
                        left.push((index, path));
                    }
                    None => found.untold += 1,
                },
                Found::Complete { tells_how: true } => {}
                Found::Other(reason) => {
                    found.remade.push(Remade { output: path.clone(), reason });
                    left.push((index, path));
                }
                Found::Otherwise(parts) => found.otherwise.push(Otherwise { frame: frame.frame, path, parts }),
                Found::TooLarge(error) => {
                    let advice = format!(
                        "to see whether it is whole for {RESUME}, raise {MEMORY}; or make all again with {OVERWRITE}"
                    );
                    return Err(failure!(Memory: "{error}; {advice}"));
                }
            }
        }
        frame.files = left;
        Ok(found)
    }

    /// Returns the warning about outputs that are kept although they do not say how they were made.
    pub(crate) fn warning(&self) -> Option<Diagnostic> {
        let outputs = if self.untold == 1 { "1 output is".to_owned() } else { format!("{} outputs are", self.untold) };
        let message = format!(
            "{RESUME}: {outputs} kept by size, samples and date alone: no word in the file says how it was made, by this version; if that \
             was by other settings or from other inputs, {OVERWRITE} makes all anew"
        );
        (self.untold > 0).then(|| Diagnostic::warning(Code::Remade, message))
    }
}

impl Remade {
    /// Returns the warning about outputs that are made again; `None` if there are none.
    pub(crate) fn warning(all: &[Self]) -> Option<Diagnostic> {
        const SHOWN: usize = 5;
        let mut shown: Vec<String> =
            all.iter().take(SHOWN).map(|one| format!("{} ({})", one.output.display(), one.reason)).collect();
        if all.len() > SHOWN {
            shown.push("…".to_owned());
        }
        let count = if all.len() == 1 { "1 output is".to_owned() } else { format!("{} outputs are", all.len()) };
        (!all.is_empty()).then(|| {
            let shown = shown.join(", ");
            let message = format!("{RESUME}: {count} not what this conversion makes and will be made again: {shown}");
            Diagnostic::warning(Code::Remade, message)
        })
    }
}

impl Found {
    /// Examines the place of an output. Outputs appear whole, so a readable image of the right size and kind is
    /// complete.
    fn at(path: &Path, expected: Expected<'_>) -> Self {
        let Expected { target, light, layers, memory, .. } = expected;
        let Ok(found) = path.metadata() else { return Self::Nothing };
        // Reading something other than a file, such as a pipe, might wait for ever.
        if !found.is_file() {
            return Self::Other("not a regular file".to_owned());
        }
        let choice = Choice { without_picture: layers.leaves_picture_out(), ..Choice::default() };
        let header = match open(path).and_then(|file| probe_chosen(file, path, &choice)) {
            Ok(header) => header,
            Err(error) => return Self::unreadable(error),
        };
        if header.metadata.origin.as_deref().is_some_and(is_damaged) {
            return Self::Other(format!("damaged {}: {DAMAGED_ORIGIN}", header.format));
        }
        if let Some(parts) = Self::made_otherwise(&header.metadata, expected) {
            return Self::Otherwise(parts);
        }
        let size = |(width, height): &(usize, usize)| format!("{width}x{height}");
        let format = Format::of_name(path).unwrap_or(header.format);
        let told: Vec<String> = [
            instead(&header.format, &format, ToString::to_string),
            instead(&(header.width, header.height), &target.sheet.size, size),
            instead(&header.channels, &light.channels, ToString::to_string).filter(|_| !choice.without_picture),
            instead(&header.depth, &light.depth, |depth| format!("depth {depth}")).filter(|_| !choice.without_picture),
            (!layers.are_in(&header)).then(|| "other channels beside the picture's".to_owned()),
            (light.is_stripped() && header.metadata.origin.is_some())
                .then(|| "with words about how it was made".to_owned()),
        ]
        .into_iter()
        .flatten()
        .collect();
        // A picture of another size need not be decoded, and takes no memory.
        if !told.is_empty() {
            return Self::Other(told.join(", "));
        }
        let bytes = light.file_bytes(target.sheet.size).saturating_add(layers.file_bytes(target.sheet.size));
        let limits = Limits::memory(bytes.min(memory.bytes));
        match open(path).and_then(|file| check_chosen(file, path, &limits, &choice)) {
            Ok(()) => Self::Complete { tells_how: Self::tells_how(&header.metadata, expected) },
            Err(error @ IoError::TooLarge { .. }) => Self::TooLarge(error),
            Err(error) => Self::unreadable(error),
        }
    }

    /// Returns the parts in which a picture was made otherwise, by what its file says. One that says nothing may be of another
    /// program, or of a format that has no room for it: it is judged by its size and samples.
    fn made_otherwise(metadata: &Metadata, Expected { origin, damaged, .. }: Expected<'_>) -> Option<Vec<String>> {
        let found = metadata.origin.as_deref()?;
        let mut parts = differences(found, origin?);
        let is_refused = parts.is_empty() && damage_of(found).is_some_and(|damage| !damaged.accepts(damage));
        parts.extend(is_refused.then(|| "damage".to_owned()));
        (!parts.is_empty()).then_some(parts)
    }

    /// Returns whether a picture's file says how it was made, in words that can be compared.
    fn tells_how(metadata: &Metadata, Expected { origin, .. }: Expected<'_>) -> bool {
        metadata.origin.as_deref().zip(origin).is_some_and(|(found, expected)| are_of_one_version(found, expected))
    }

    fn unreadable(error: IoError) -> Self {
        // The message names the file already, and the file is made again without advice.
        Self::Other(match error {
            IoError::Damaged { format, reason, .. } => format!("damaged or truncated {format}: {reason}"),
            IoError::UnknownContent { .. } => "not an image of a known format".to_owned(),
            IoError::Empty { .. } => "an empty file".to_owned(),
            IoError::Open { source, .. } => source.to_string(),
            other => other.to_string(),
        })
    }
}

/// Returns an input of a frame that was changed after its output was made, as far as clocks tell.
fn newer_input(job: &ConvertJob, frame: Option<u64>, output: &Path) -> Option<PathBuf> {
    let made = Stamp::of(output)?;
    let place = job.place(frame);
    job.layers().find_map(|layer| {
        let paths = layer.input.paths(*layer.input.frames.get(place)?);
        let mut paths = paths.iter().chain(&layer.input.beside).map(|path| FrameName::file(path));
        paths.find(|path| layer.files.stamp(path).is_some_and(|input| made.is_before(input)))
    })
}

/// Returns the error about outputs that were made by other settings, or from other inputs, if there are any. Some frames of a turn are not
/// to be had alone.
fn otherwise(all: &[Otherwise], is_turn: bool) -> Option<ConvertError> {
    let Otherwise { path, parts, .. } = all.first()?;
    let told = parts.iter().map(|part| match part.as_str() {
        "geometry" => "geometry (projections, size or orientation)".to_owned(),
        "pose" => "poses (orientation, path, turn or shutter)".to_owned(),
        "filter" => "filter settings".to_owned(),
        "colour" => "colours, samples or layers".to_owned(),
        "damage" => format!("answers to damaged frames ({DAMAGED})"),
        _ => "inputs".to_owned(),
    });
    let told = told.collect::<Vec<_>>().join("; other ");
    let frames = FrameList::new(all.iter().filter_map(|one| one.frame)).to_string();
    if all.iter().all(|one| one.parts == ["damage"]) {
        let message = format!(
            "{RESUME}: {} was made of a film's damaged frame, by another {DAMAGED}; give the one that made it, or remove frames {frames} and go on",
            path.display()
        );
        return Some(failed_as(Code::Remade, message));
    }
    let (others, these, named) = if all.len() == 1 {
        (String::new(), "it", "frame")
    } else {
        let more = all.len() - 1;
        let others = format!(", and {more} more {} made otherwise", if more == 1 { "was" } else { "were" });
        (others, "these", "frames")
    };
    let again = if is_turn {
        format!(
            "make all again with {OVERWRITE}, or remove {named} {frames} and go on with {RESUME}: {FRAMES} {frames} alone would be \
             another turn"
        )
    } else {
        format!("make {these} again with {FRAMES} {frames} {OVERWRITE}")
    };
    Some(failed_as(
        Code::Remade,
        format!(
            "{RESUME}: {} was made with other {told}{others}; give what made it, name other outputs, or {again}",
            path.display()
        ),
    ))
}

/// Describes a finding that differs from the expectation.
fn instead<T: PartialEq>(found: &T, expected: &T, words: impl Fn(&T) -> String) -> Option<String> {
    (found != expected).then(|| format!("{} instead of {}", words(found), words(expected)))
}
