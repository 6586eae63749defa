use std::io;
use std::path::{Path, PathBuf};

use cosmorama::raster::{Channels, Depth};
use thiserror::Error;

use crate::Format;

/// Why a file cannot be read, written or found. Each message names the file, what was found, what was expected
/// and what to do.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IoError {
    /// A file or folder cannot be opened.
    #[error("cannot open {}: {source}", path.display())]
    Open {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An extension belongs to no format that can be written.
    #[error("{}: {}", path.display(), unnamed(path))]
    UnknownExtension {
        /// The file to write.
        path: PathBuf,
    },
    /// The first bytes of a file belong to no format.
    #[error("{}: not an image of a known format (PNG, JPEG, TIFF, Radiance HDR, OpenEXR, KTX or DDS; TGA is known by its extension .tga)", path.display())]
    UnknownContent {
        /// The file read.
        path: PathBuf,
    },
    /// A file has no bytes: often what is left of a program that was interrupted, or of a full disk.
    #[error("{}: an empty file (0 bytes), where an image was expected; make it again", path.display())]
    Empty {
        /// The file read.
        path: PathBuf,
    },
    /// A file breaks the rules of its format, or ends too early.
    #[error("{}: damaged or truncated {format} file ({reason}); make it again", path.display())]
    Damaged {
        /// The file read.
        path: PathBuf,
        /// Its format.
        format: Format,
        /// What the decoder found.
        reason: String,
    },
    /// A file is in order, but of a kind that is not read.
    #[error("{}: this {format} file holds {found}; expected {expected}; convert it first", path.display())]
    Unsupported {
        /// The file read.
        path: PathBuf,
        /// Its format.
        format: Format,
        /// What it holds.
        found: String,
        /// What could be read.
        expected: &'static str,
    },
    /// The pixels that a file declares do not fit into the memory allowed.
    #[error(
        "{}: {width}x{height} pixels, {channels}, depth {depth}, need {needed} bytes, \
         but only {limit} may be used; if the file is right, raise --memory",
        path.display()
    )]
    TooLarge {
        /// The file read.
        path: PathBuf,
        /// Columns declared.
        width: u64,
        /// Rows declared.
        height: u64,
        /// Channels declared.
        channels: Channels,
        /// Depth declared.
        depth: Depth,
        /// Bytes of all samples.
        needed: u128,
        /// Bytes allowed.
        limit: u64,
    },
    /// A format cannot hold what is to be written.
    #[error("{}: {format} cannot hold {found}; it can hold {expected}", path.display())]
    CannotHold {
        /// The file to write.
        path: PathBuf,
        /// Its format.
        format: Format,
        /// What was to be written.
        found: String,
        /// What the format holds.
        expected: String,
    },
    /// A file cannot be written: nothing was left behind.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file to write.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A face pattern has no `{face}` or `%c` in it.
    #[error(
        "{pattern}: no {{face}} or %c in this pattern; put one where the face's name stands, as in faces/{{face}}.png"
    )]
    NotAFacePattern {
        /// The pattern.
        pattern: String,
    },
    /// No naming preset finds a file.
    #[error("{pattern}: no face found in {}; tried {tried}", folder.display())]
    NoFaces {
        /// The pattern.
        pattern: String,
        /// Where files were looked for.
        folder: PathBuf,
        /// The names tried.
        tried: String,
    },
    /// Some faces of a cube have no files, where all six are needed.
    #[error("{}: no such file, where a face of a cube was expected; missing faces: {missing}", path.display())]
    MissingFaces {
        /// Where the file of the first missing face was expected.
        path: PathBuf,
        /// Names of the missing faces.
        missing: String,
    },
    /// Where a face should be there is a folder, and no file is found.
    #[error("{}: a folder, where the file of a face was expected; write which file in it, as in {pattern}/{{face}}.png", path.display())]
    FaceIsFolder {
        /// The pattern.
        pattern: String,
        /// The folder.
        path: PathBuf,
    },
    /// Two naming presets find files and disagree about them.
    #[error(
        "{pattern}: the files fit two namings: {first} ({first_faces}) and {second} ({second_faces}); \
         say which with naming={first} or naming={second}"
    )]
    AmbiguousNaming {
        /// The pattern.
        pattern: String,
        /// One preset.
        first: &'static str,
        /// What it makes of the files.
        first_faces: String,
        /// Another preset.
        second: &'static str,
        /// What that one makes of them.
        second_faces: String,
    },
    /// A sequence has no frames at all.
    #[error("{pattern}: no frame found in {}; {}", folder.display(), expected_frames(example, found.as_deref()))]
    NoFrames {
        /// The pattern.
        pattern: String,
        /// Where frames were looked for.
        folder: PathBuf,
        /// Name of frame 1.
        example: String,
        /// The longest sequence that the folder does hold.
        found: Option<String>,
    },
    /// Frames of a sequence are missing.
    #[error(
        "{pattern}: {} missing: {missing}; the first that exists is {}, the last {}; make {}, or choose others with \
         --frames",
        counted(*count), existing.0, existing.1, if *count == 1 { "it" } else { "them" }
    )]
    MissingFrames {
        /// The pattern.
        pattern: String,
        /// How many.
        count: usize,
        /// All of them, as a list that `--frames` understands.
        missing: String,
        /// The first and the last that exist.
        existing: (u64, u64),
    },
}

/// How the names of a sequence should be, and how those are that are there.
fn expected_frames(example: &str, found: Option<&str>) -> String {
    let expected = format!("expected names like {example}");
    found.map_or_else(|| expected.clone(), |found| format!("{expected}, but there are {found}; write that pattern"))
}

/// What to do about a file name that has no extension of a format.
fn unnamed(path: &Path) -> String {
    let is_folder = path.is_dir() || path.as_os_str().to_string_lossy().ends_with('/');
    let extensions = Format::extensions();
    if is_folder {
        let file = path.join("out.png");
        return format!("a folder, where a file name was expected; write one in it, as in {}", file.display());
    }
    format!("the extension names no format; use one of {extensions}")
}

/// How many frames.
fn counted(count: usize) -> String {
    if count == 1 { "1 frame is".to_owned() } else { format!("{count} frames are") }
}

/// Parts of decoders' messages on a file that ends too early.
const SHORT: [&str; 6] = [
    "failed to fill whole buffer",
    "reference to missing bytes",
    "Not enough bytes",
    "unexpected end of file",
    "unexpected EOF",
    "Unexpected end of",
];

impl IoError {
    pub(crate) fn open(path: &Path, source: io::Error) -> Self {
        Self::Open { path: path.to_owned(), source }
    }

    pub(crate) fn damaged(path: &Path, format: Format, reason: impl ToString) -> Self {
        let reason = reason.to_string();
        // What decoders say when bytes run out, each in its own words.
        let is_short = SHORT.iter().any(|words| reason.contains(words));
        let reason = if is_short { "it ends too early".to_owned() } else { reason };
        Self::Damaged { path: path.to_owned(), format, reason }
    }

    pub(crate) fn write(path: &Path, reason: impl ToString) -> Self {
        Self::Write { path: path.to_owned(), reason: reason.to_string() }
    }

    pub(crate) fn unsupported(path: &Path, format: Format, found: impl ToString, expected: &'static str) -> Self {
        Self::Unsupported { path: path.to_owned(), format, found: found.to_string(), expected }
    }
}
